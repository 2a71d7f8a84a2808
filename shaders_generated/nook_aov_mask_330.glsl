// Made by: nook emit --methods aov-mask --glsl 330
// Version: nook 0.1.0
// SPDX-License-Identifier: MIT
//
// Draws the static ambient occlusion volumes of a file that `nook volumes` wrote over the depth and normals of a frame: visibility of
// static surfaces, 1 where open. Four stages are in this one file. It has no #version: include it after yours, and define one of these
// first:
//   #define NOOK_VERTEX    vertex stage of the volumes; with NOOK_PRISMS for files of --layout prisms
//   #define NOOK_FRAGMENT  fragment stage of the volumes; one depth read per fragment
//   #define NOOK_RESOLVE   fragment stage over the picture, from the sums of the volumes to visibility; no depth reads
//   #define NOOK_SPARSE    only where Camera::every is above 1: fragment stage over the whole picture, which interpolates the visibility
//                          of the drawn pixels, nook_cells, and discards pixels for which they are no good; at most 51 depth reads
// Each stage has its main(). nook_volumes.h reads the file, nook_volumes_draw.h fills the uniform block and the clusters of a frame.
// Both headers come with nook, are MIT, and have no dependencies.
//
// Once: nook_volumes::Volumes::open. Upload corners() and polygons(): buffer textures nook_corners (RGBA16UI) and
// nook_polygons (RG32UI). With prisms, vertices() as well, as the attribute nook_point (location 1, four GL_UNSIGNED_SHORT, 8 bytes
// apart), and indices() as elements (GL_UNSIGNED_SHORT).
// Every frame: nook_volumes::Frame::set; its block is the uniform block NookVolumes; Frame::seen of every cluster makes the buffer
// texture nook_clusters (RGBA32UI, four texels a cluster).
//
// Drawing, for each cluster i with Frame::inSight:
//   glVertexAttribI1i(0, i);
//   glDrawArrays(GL_TRIANGLES, 12 * first_corner, 12 * corner_count); // or, with prisms:
//   glDrawElementsBaseVertex(GL_TRIANGLES, index_count, GL_UNSIGNED_SHORT, 2 * first_index, first_vertex);
// or all in one call of glMultiDrawArraysIndirect (OpenGL 4.3), where nook_cluster (location 0) is an attribute with divisor 1 of the
// numbers 0, 1, 2 ..., and i the base instance.
// States: depth test against the depth buffer of the frame, no depth writes; depth clamp; front faces counter-clockwise (clockwise where
// Frame::mirrored). Clusters that do not contain the eye: cull back faces, depth test "less or equal". Clusters that do
// (Frame::holdsEye): cull front faces, depth test "greater or equal"; reversed depth has the opposite tests. With EXT_depth_bounds_test
// and one call per cluster, glDepthBoundsEXT with Frame::depthBounds skips fragments of volumes that float between the eye and a surface.
// Fewer fragments: define NOOK_CHOOSE_FACES for the vertex stage and draw all clusters in sight twice, first with the states of clusters
// that do not contain the eye and nook_faces = 1, then with the other states and nook_faces = 2. Each volume is then drawn by the faces,
// front or back, that seem to cover fewer pixels without any effect; to decide, the vertex stage reads two depths per corner of the
// polygon (NOOK_DEPTH). This is only for files with nook_volumes::kExactBounds: other volumes are cut off where they may still occlude
// a little, and which part is lost depends on the faces.
// Target: unsigned integers, R32UI, RG32UI or RGBA32UI for up to 32, 64 and 128 directions, a second RGBA32UI for more; cleared to 0;
// no blending, but glEnable(GL_COLOR_LOGIC_OP), glLogicOp(GL_OR). The resolve stage reads them as nook_sums and nook_more_sums.
// With Camera::every above 1 only one pixel of every x every is drawn: the target has ceil(width / every) columns and
// ceil(height / every) rows, and its depth buffer holds the depths of those pixels. nook_depths and nook_normals always are those of the
// whole picture. After NOOK_RESOLVE, fill the whole picture, whose target has a stencil buffer:
//   1. Clear the stencil to 0. Draw NOOK_SPARSE with the same block; it sets the stencil to 1 where it draws (GL_ALWAYS, GL_REPLACE).
//   2. It discards about a tenth of the pixels: thin objects, edges, sharp creases. Draw these where the stencil is 0 (GL_EQUAL,
//      GL_KEEP): the volumes into a target of the size of the picture, with the block of a Frame whose Camera::every is 1
//      (nook_clusters stays as it is), then NOOK_RESOLVE into the picture of step 1.
// Together with a screen-space method, take min(this visibility, that one): then an occluder that both see counts once.
#if __VERSION__ < 330
#error nook: this module needs #version 330 or later
#endif
#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// The uniform block, nook_volumes::Block of nook_volumes_draw.h, which Frame::set fills.
layout(std140) uniform NookVolumes
{
	vec2 size; // width, height in pixels
	vec2 pixel_size;
	vec2 across_x; // turns NDC x back into view-space x: 1 / P[0][0], P[2][0] / P[0][0] of the projection P[column][row]
	vec2 across_y; // the same for y; the first is negated where row 0 of the pixels lies at NDC y = -1
	vec2 aside;    // the shift of an off-centre orthographic projection: -P[3][0] / P[0][0], -P[3][1] / P[1][1]
	float w_slope; // clip-space w at a depth d is w_slope * d + w_start
	float w_start;
	vec2 origin;   // first pixel of the picture in its textures
	float far_end; // what the depth buffer holds at the far plane: 1, or 0 where depth is reversed
	int cell;      // only one pixel of cell x cell is drawn
	vec4 depth;    // device depth back to linear depth: (x + y * t) / (z + w * t), where t = abs(stored value - far_end)
	float depth_step; // a stored depth may be off by depth_step * w * w + depth_share * depth, which is its rounding
	float depth_share;
	float position_error; // rounding of the stored positions, metres
	float radius;         // how far a volume reaches from its polygon, metres
	mat4 clip;            // to clip space, from positions relative to the eye along the axes of the world
	vec4 right;           // axes of view space in the world
	vec4 up;
	vec4 back;
	vec4 curve[9];      // 33 knots of the curve from summed occlusion to occlusion
	vec4 slope;         // an oblique near plane: what x and y of NDC add to both parts of the fraction in depth
	float plane_bias;   // a receiver closer to the plane of a polygon than this is not occluded by it, metres
	float exact_bounds; // 1: volumes have their exact bounds, 0: their corners are limited in length
	float sum_range;    // summed occlusion at the last knot of the curve
} nook;

#ifdef NOOK_VERTEX

// Buffer textures: corners (RGBA16UI) and polygons (RG32UI) of the file, and the clusters of this frame (RGBA32UI).
uniform usamplerBuffer nook_corners;
uniform usamplerBuffer nook_polygons;
uniform usamplerBuffer nook_clusters;

uvec4 nookPackedCorner(int i)
{
	return texelFetch(nook_corners, i);
}
uvec2 nookPackedPolygon(int i)
{
	return texelFetch(nook_polygons, i).xy;
}
uvec4 nookSeenCluster(int i, int texel)
{
	return texelFetch(nook_clusters, 4 * i + texel);
}

// The polygon of a volume, from the vertex stage to the fragment stage.
flat out ivec4 nook_polygon; // first corner, number of corners, 1 where it occludes on both sides, extent (nookShare)
flat out vec4 nook_front;    // unit normal of its front, alpha
flat out vec3 nook_offset;   // a corner relative to the eye is nook_offset + nook_step * (stored integers)
flat out vec3 nook_step;

// Extent of the volume as shares of nook.radius: along the normal of its polygon (x) and beyond the edges (y).
vec2 nookShare()
{
	float height = float(nook_polygon.w & 255) / 128.0;
	return vec2(height, height * float(nook_polygon.w >> 8) / 8.0);
}

// The upper 12 bits of each component: the product of two of them is exact.
vec3 nookHead(vec3 a)
{
	return vec3(uintBitsToFloat(floatBitsToUint(a.x) & 0xfffff000u), uintBitsToFloat(floatBitsToUint(a.y) & 0xfffff000u),
		uintBitsToFloat(floatBitsToUint(a.z) & 0xfffff000u));
}

// a * b - c * d for numbers in two parts (the upper bits and the rest), accurate to 2^-36 of the larger product. Swapping a
// with c and b with d gives exactly the negative.
float nookProducts(vec2 a, vec2 b, vec2 c, vec2 d)
{
	float low = (a.x * b.y + a.y * b.x + a.y * b.y) - (c.x * d.y + c.y * d.x + c.y * d.y);
	return (a.x * b.x - c.x * d.x) + low;
}

// Cross product whose direction is accurate even where it nearly cancels.
vec3 nookCross(vec3 a, vec3 b)
{
	vec3 ha = nookHead(a);
	vec3 hb = nookHead(b);
	vec3 la = a - ha;
	vec3 lb = b - hb;
	vec2 ax = vec2(ha.x, la.x);
	vec2 ay = vec2(ha.y, la.y);
	vec2 az = vec2(ha.z, la.z);
	vec2 bx = vec2(hb.x, lb.x);
	vec2 by = vec2(hb.y, lb.y);
	vec2 bz = vec2(hb.z, lb.z);
	return vec3(nookProducts(ay, bz, az, by), nookProducts(az, bx, ax, bz), nookProducts(ax, by, ay, bx));
}

#ifdef NOOK_CHOOSE_FACES

uniform int nook_faces; // 1: keeps volumes that are drawn by their front faces, 2: by their back faces, 0: keeps all

#ifndef NOOK_DEPTH // linear depth: distance along the view direction, > 0, metres; NOOK_SKY or more without a surface
uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
#ifndef NOOK_NORMAL // unit normal in view space: x to the right, y up, z toward the camera
uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) texelFetch(nook_normals, pixel, 0).xyz
#endif

float nookDepth(ivec2 pixel)
{
	return NOOK_DEPTH(pixel);
}
vec3 nookNormal(ivec2 pixel)
{
	return NOOK_NORMAL(pixel);
}

// Vertex stage: decides which volumes are drawn by their front faces, and which by their back faces. Front faces also cover
// pixels whose surface lies behind the whole volume, back faces also those whose surface lies in front of it. Neither occludes
// these surfaces, so the better choice is the one that covers fewer of them.

// Is the surface in the picture behind a point (1), before it (-1), or is that unknown (0)? The point is relative to the eye,
// along the axes of the world.
int nookSurfaceAt(vec3 point)
{
	float depth = -dot(nook.back.xyz, point);
	float w = nook.w_slope * depth + nook.w_start;
	if (w <= 0.0 || depth <= 0.0)
	{
		return 0;
	}
	// The inverse of nookPosition.
	float x = (dot(nook.right.xyz, point) - depth * nook.across_x.y - nook.aside.x) / (w * nook.across_x.x);
	float y = (dot(nook.up.xyz, point) - depth * nook.across_y.y - nook.aside.y) / (w * nook.across_y.x);
	vec2 place = clamp(vec2(x + 1.0, 1.0 - y) * 0.5, 0.0, 1.0) * nook.size + nook.origin;
	return nookDepth(ivec2(min(place, nook.size + nook.origin - 1.0))) > depth ? 1 : -1;
}

// Is the volume better drawn by its back faces? Requires nookSetPolygon. Yes where the eye may be in the volume, because it
// then has no front faces before the eye; otherwise the surfaces at points halfway between the centre of the volume and its
// corners decide, two for each corner of the polygon.
bool nookBackFaces()
{
	int first = nook_polygon.x;
	int count = nook_polygon.y;
	vec3 front = nook_front.xyz;
	float reach = nook.radius * nookShare().x;
	float side = nook.radius * nookShare().y;
	float low = nook_polygon.z > 0 ? -reach : 0.0;
	vec3 a = nook_offset + nook_step * vec3(nookPackedCorner(first + count - 1).xyz);
	float slack = 1e-3 * reach + 1e-5 * length(a);
	float height = -dot(front, a);
	bool outside = height > reach + slack || height < low - slack;
	vec3 middle = vec3(0.0);
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nook_offset + nook_step * vec3(nookPackedCorner(first + i).xyz);
		vec3 inward = cross(front, b - a);
		outside = outside || dot(a, inward) > (side + slack) * length(inward);
		middle += b / float(count);
		a = b;
	}
	if (!outside)
	{
		return true;
	}
	vec3 upper = front * (0.25 * (reach - low));
	vec3 centre = middle + front * (0.5 * (reach + low));
	int behind = 0;
	for (int i = 0; i < count; ++i)
	{
		vec3 out_of = nook_offset + nook_step * vec3(nookPackedCorner(first + i).xyz) - middle;
		vec3 point = centre + out_of * (0.5 + 0.5 * side / max(length(out_of), 1e-30));
		behind += nookSurfaceAt(point - upper) + nookSurfaceAt(point + upper);
	}
	return behind > 0;
}

// Does nook_faces ask for the volume of this polygon?
bool nookIsAsked()
{
	return nook_faces == 0 || nookBackFaces() == (nook_faces == 2);
}
#endif // NOOK_CHOOSE_FACES

// Vertex stage of the volumes: from the integers of the file to a vertex of the volume of a polygon (AOV section 5.2).

// Unit normal of the front of a polygon, from its area vector.
vec3 nookFrontOf(int first, int count)
{
	vec3 start = vec3(nookPackedCorner(first).xyz);
	vec3 before = nook_step * (vec3(nookPackedCorner(first + 1).xyz) - start);
	vec3 sum = vec3(0.0);
	for (int i = 2; i < count; ++i)
	{
		vec3 after = nook_step * (vec3(nookPackedCorner(first + i).xyz) - start);
		sum += nookCross(before, after);
		before = after;
	}
	float most = max(max(abs(sum.x), abs(sum.y)), max(abs(sum.z), 1e-37));
	return normalize(sum / most);
}

// How far a corner moves outward in the plane of the polygon, between an arriving and a leaving edge, which are unit vectors
// (AOV eqs. 9 to 11 in closed form); limited to `most`.
vec3 nookExtension(vec3 arriving, vec3 leaving, vec3 front, float reach, float most)
{
	float cosine = dot(arriving, leaving);
	if (cosine >= 0.0)
	{
		return cross(arriving + leaving, front) * (reach / (1.0 + cosine));
	}
	vec3 outward = arriving - leaving;
	float size = length(outward);
	float sine = dot(nookCross(arriving, leaving), front);
	return outward / size * (sine > reach * size / most ? reach * size / sine : most);
}

// How far the volume of a one-sided polygon begins behind its plane, metres: receivers there may be lifted into the volume.
float nookBehind()
{
	return 1.01 * (nook.plane_bias + nook.position_error);
}

// Corner i of the volume in its lower ring (ring 0) or its upper one (ring 1).
vec3 nookPrismPoint(int i, int ring)
{
	int first = nook_polygon.x;
	int count = nook_polygon.y;
	vec3 front = nook_front.xyz;
	vec3 here = vec3(nookPackedCorner(first + i).xyz);
	vec3 arriving = normalize(nook_step * (here - vec3(nookPackedCorner(first + (i + count - 1) % count).xyz)));
	vec3 leaving = normalize(nook_step * (vec3(nookPackedCorner(first + (i + 1) % count).xyz) - here));
	vec2 goes = nook.radius * nookShare();
	float reach = goes.y;
	float most = 2.0 * reach; // the clamp of AOV
	if (nook.exact_bounds > 0.5)
	{
		float longest = 4.0 * reach;
		vec3 before = vec3(nookPackedCorner(first + count - 1).xyz);
		for (int k = 0; k < count; ++k)
		{
			vec3 after = vec3(nookPackedCorner(first + k).xyz);
			longest = max(longest, length(nook_step * (after - before)));
			before = after;
		}
		most = 64.0 * longest;
	}
	float height = ring > 0 ? goes.x : nook_polygon.z > 0 ? -goes.x : -nookBehind();
	return nook_offset + nook_step * here + nookExtension(arriving, leaving, front, reach, most) + height * front;
}

// Fetches what all vertices of a polygon share. polygon: its number in the cluster.
void nookSetPolygon(int cluster, int polygon)
{
	uvec4 first = nookSeenCluster(cluster, 0);
	uvec4 second = nookSeenCluster(cluster, 1);
	nook_offset = uintBitsToFloat(first.xyz);
	nook_step = uintBitsToFloat(second.xyz);
	uvec2 own = nookPackedPolygon(int(first.w) + polygon);
	int reaches = 128 - int((own.y >> 9) & 127u) + 256 * (8 - int((own.y >> 5) & 7u));
	nook_polygon = ivec4(int(own.x), int(own.y & 31u), int((own.y >> 8) & 1u), reaches);
	nook_front = vec4(nookFrontOf(nook_polygon.x, nook_polygon.y), float(own.y >> 16) / 65535.0);
}

// Layout polygons. Each corner has twelve vertices: two triangles of the side that its edge makes, one triangle of the lower
// face and one of the upper face.
void nookPolygonVertex(int cluster, int vertex)
{
	int corner = vertex / 12;
	int part = vertex % 12;
	nookSetPolygon(cluster, int(nookPackedCorner(corner).w));
#ifdef NOOK_CHOOSE_FACES
	if (!nookIsAsked())
	{
		gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside the picture, as all vertices of this polygon: nothing is drawn
		return;
	}
#endif
	int i = corner - nook_polygon.x;
	int next = i + 1 < nook_polygon.y ? i + 1 : 0;
	int at = part == 6 || part == 9 ? 0 : part == 0 || part == 3 || part == 5 || part == 8 || part == 10 ? i : next;
	int ring = part == 2 || part == 4 || part == 5 || part > 8 ? 1 : 0;
	gl_Position = nook.clip * vec4(nookPrismPoint(at, ring), 1.0);
}

// Layout prisms: a vertex of the file.
void nookPrismVertex(int cluster, uvec4 point)
{
	nookSetPolygon(cluster, int(point.w));
#ifdef NOOK_CHOOSE_FACES
	if (!nookIsAsked())
	{
		gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside the picture, as all vertices of this polygon: nothing is drawn
		return;
	}
#endif
	vec3 offset = uintBitsToFloat(nookSeenCluster(cluster, 2).xyz);
	vec3 step = uintBitsToFloat(nookSeenCluster(cluster, 3).xyz);
	vec3 at = offset + step * vec3(point.xyz);
	vec3 corner = nook_offset + nook_step * vec3(nookPackedCorner(nook_polygon.x).xyz);
	bool lower = nook_polygon.z == 0 && dot(nook_front.xyz, at - corner) < 0.5 * nook.radius * nookShare().x;
	gl_Position = nook.clip * vec4(at - (lower ? nookBehind() : 0.0) * nook_front.xyz, 1.0);
}

layout(location = 0) in int nook_cluster; // number of the cluster, the same for all its vertices
#ifdef NOOK_PRISMS
layout(location = 1) in uvec4 nook_point; // a vertex of the file
#endif

void main()
{
#ifdef NOOK_PRISMS
	nookPrismVertex(nook_cluster, nook_point);
#else
	nookPolygonVertex(nook_cluster, gl_VertexID);
#endif
}
#endif // NOOK_VERTEX

#ifdef NOOK_FRAGMENT

// Buffer textures: corners (RGBA16UI) and polygons (RG32UI) of the file, and the clusters of this frame (RGBA32UI).
uniform usamplerBuffer nook_corners;
uniform usamplerBuffer nook_polygons;
uniform usamplerBuffer nook_clusters;

uvec4 nookPackedCorner(int i)
{
	return texelFetch(nook_corners, i);
}
uvec2 nookPackedPolygon(int i)
{
	return texelFetch(nook_polygons, i).xy;
}
uvec4 nookSeenCluster(int i, int texel)
{
	return texelFetch(nook_clusters, 4 * i + texel);
}

// The polygon of a volume, from the vertex stage to the fragment stage.
flat in ivec4 nook_polygon; // first corner, number of corners, 1 where it occludes on both sides, extent (nookShare)
flat in vec4 nook_front;    // unit normal of its front, alpha
flat in vec3 nook_offset;   // a corner relative to the eye is nook_offset + nook_step * (stored integers)
flat in vec3 nook_step;

// Extent of the volume as shares of nook.radius: along the normal of its polygon (x) and beyond the edges (y).
vec2 nookShare()
{
	float height = float(nook_polygon.w & 255) / 128.0;
	return vec2(height, height * float(nook_polygon.w >> 8) / 8.0);
}

#ifndef NOOK_DEPTH // linear depth: distance along the view direction, > 0, metres; NOOK_SKY or more without a surface
uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
#ifndef NOOK_NORMAL // unit normal in view space: x to the right, y up, z toward the camera
uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) texelFetch(nook_normals, pixel, 0).xyz
#endif

float nookDepth(ivec2 pixel)
{
	return NOOK_DEPTH(pixel);
}
vec3 nookNormal(ivec2 pixel)
{
	return NOOK_NORMAL(pixel);
}

vec3 nook_base;  // nook_offset relative to the receiver, which is the surface that the pixel shows
float nook_bias; // metres: a receiver closer to the plane of a polygon is not occluded by it
vec3 nookCorner(int i);

// View-space position of the surface that a pixel shows, from its depth. With NDC x and y of the pixel and clip-space w at that
// depth, this is the inverse of the projection.
vec3 nookPosition(ivec2 pixel, float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	float ndc_x = (float(pixel.x) + 0.5f - nook.origin.x) * nook.pixel_size.x * 2.0f - 1.0f;
	float ndc_y = 1.0f - (float(pixel.y) + 0.5f - nook.origin.y) * nook.pixel_size.y * 2.0f;
	return vec3(ndc_x * w * nook.across_x.x + depth * nook.across_x.y + nook.aside.x,
				ndc_y * w * nook.across_y.x + depth * nook.across_y.y + nook.aside.y, -depth);
}

// By how much rounding may have changed a depth, in the unit of the depth. A step of a depth buffer grows with the square of w:
// nook.depth_step is half a step at w = 1, nook.depth_share is the rounding in proportion to the depth.
float nookDepthError(float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	return nook.depth_step * w * w + nook.depth_share * abs(depth);
}

// Height of the receiver above the polygon, whose unit normal is `front`, in metres; below 0 behind it.
float nookHeight(vec3 front)
{
	return -dot(front, nookCorner(0));
}

// By how many metres to move a receiver along `front` before it is evaluated. A receiver in the plane of the polygon, to within
// `bias`, lies either on the polygon, which faces the same way and must not occlude it, or on another surface that meets the
// polygon in a crease, where it would show as a bright dot: that one is moved just out of the plane. facing: cosine between the
// normal of the receiver and `front`.
float nookLift(float height, float two_sided, float bias, float facing)
{
	if (abs(height) > bias || abs(facing) > 0.7f)
	{
		return 0.0f;
	}
	float out_of = two_sided > 0.5f && height < 0.0f ? -1.01f * bias : 1.01f * bias;
	return out_of - height;
}

// Does a polygon whose volume extends `reach` metres (delta in AOV) reach a receiver at `height`: in front of it, or with
// two_sided on both sides. A receiver within `bias` of the plane is not reached, so that no surface occludes itself, whatever
// its normals are.
bool nookReaches(float height, float two_sided, float reach, float bias)
{
	float up = two_sided > 0.5f ? abs(height) : height;
	return up > bias && up < reach;
}

// The falloff without alpha (AOV eqs. 5 and 8), in [0, 1]; 0 outside the volume. height: distance from the plane. share: the
// volume ends where the factor of a side falls below 1 - share; the height is checked by nookReaches.
float nookFalloff(int count, vec3 front, float height, float reach, float share)
{
	float least = 1.0f - share;
	float g = clamp(1.0f - height / reach, 0.0f, 1.0f);
	vec3 a = nookCorner(count - 1);
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nookCorner(i);
		vec3 inward = cross(front, b - a); // AOV eq. 7
		float squared = dot(inward, inward);
		if (squared > 0.0f)
		{
			float side = clamp(1.0f - dot(a, inward) / (sqrt(squared) * reach), 0.0f, 1.0f);
			g = side < least ? 0.0f : g * side;
		}
		a = b;
	}
	return g;
}

const vec4 nook_directions[128] = vec4[128](
	vec4(6.25e-02, 0e+00, 9.9804497e-01, 3.90625e-03),
	vec4(-7.9822525e-02, 7.312397e-02, 9.9412334e-01, 2.8453624e-01),
	vec4(1.2218117e-02, -1.3921914e-01, 9.901862e-01, 5.6516623e-01),
	vec4(1.0061112e-01, 1.3122939e-01, 9.8623335e-01, 8.457962e-01),
	vec4(-1.8463378e-01, -3.2659117e-02, 9.822646e-01, 1.2642625e-01),
	vec4(1.7490123e-01, -1.1125785e-01, 9.7827977e-01, 4.0705624e-01),
	vec4(-5.850104e-02, 2.1762095e-01, 9.7427857e-01, 6.8768626e-01),
	vec4(-1.11567825e-01, -2.1481706e-01, 9.702609e-01, 9.6831626e-01),
	vec4(2.4205756e-01, 8.839903e-02, 9.662266e-01, 2.4894625e-01),
	vec4(-2.5182056e-01, 1.0394786e-01, 9.6217525e-01, 5.2957624e-01),
	vec4(1.2139415e-01, -2.5941223e-01, 9.581069e-01, 8.1020623e-01),
	vec4(8.970719e-02, 2.8600064e-01, 9.540211e-01, 9.083625e-02),
	vec4(-2.703785e-01, -1.5668987e-01, 9.4991773e-01, 3.7146625e-01),
	vec4(3.1718478e-01, -6.973218e-02, 9.457966e-01, 6.520963e-01),
	vec4(-1.9357292e-01, 2.7533758e-01, 9.416574e-01, 9.3272626e-01),
	vec4(-4.4719826e-02, -3.4509984e-01, 9.375e-01, 2.1335626e-01),
	vec4(2.7453586e-01, 2.3137914e-01, 9.3332404e-01, 4.9398625e-01),
	vec4(-3.6943924e-01, 1.5277472e-02, 9.291293e-01, 7.7461624e-01),
	vec4(2.6947758e-01, -2.6816615e-01, 9.2491555e-01, 5.524625e-02),
	vec4(-1.8029094e-02, 3.8989577e-01, 9.206825e-01, 3.3587626e-01),
	vec4(-2.5640878e-01, -3.072634e-01, 9.164299e-01, 6.165063e-01),
	vec4(4.061798e-01, 5.4650918e-02, 9.121575e-01, 8.971363e-01),
	vec4(-3.441553e-01, 2.3945431e-01, 9.078649e-01, 1.7776625e-01),
	vec4(9.404303e-02, -4.1803068e-01, 9.03552e-01, 4.5839626e-01),
	vec4(2.1751663e-01, 3.7959552e-01, 8.9921844e-01, 7.3902625e-01),
	vec4(-4.252242e-01, -1.3565812e-01, 8.9486384e-01, 1.965625e-02),
	vec4(4.130512e-01, -1.9084013e-01, 8.904879e-01, 3.0028626e-01),
	vec4(-1.789441e-01, 4.275778e-01, 8.8609046e-01, 5.809162e-01),
	vec4(-1.5970367e-01, -4.4401687e-01, 8.81671e-01, 8.615463e-01),
	vec4(4.2495432e-01, 2.2334407e-01, 8.772293e-01, 1.4217626e-01),
	vec4(-4.7201732e-01, 1.2442225e-01, 8.72765e-01, 4.2280626e-01),
	vec4(2.682979e-01, -4.1726488e-01, 8.682777e-01, 7.0343626e-01),
	vec4(8.5347146e-02, 4.966106e-01, 8.637672e-01, 9.8406625e-01),
	vec4(-4.044706e-01, -3.1324476e-01, 8.5923296e-01, 2.6469624e-01),
	vec4(5.173914e-01, -4.2864818e-02, 8.5467464e-01, 5.4532623e-01),
	vec4(-3.5762653e-01, 3.8658378e-01, 8.5009193e-01, 8.259562e-01),
	vec4(2.6050012e-03, -5.339939e-01, 8.454843e-01, 1.0658625e-01),
	vec4(3.636685e-01, 4.0089145e-01, 8.408515e-01, 3.8721624e-01),
	vec4(-5.4609495e-01, -5.0611954e-02, 8.36193e-01, 6.6784626e-01),
	vec4(4.4249845e-01, -3.3584055e-01, 8.315084e-01, 9.4847625e-01),
	vec4(-1.00678265e-01, 5.534168e-01, 8.267973e-01, 2.2910625e-01),
	vec4(-3.0326673e-01, -4.819212e-01, 8.2205915e-01, 5.0973624e-01),
	vec4(5.5572945e-01, 1.523024e-01, 8.172935e-01, 7.9036623e-01),
	vec4(-5.1865256e-01, 2.6616395e-01, 8.125e-01, 7.099625e-02),
	vec4(2.0496316e-01, -5.528529e-01, 8.07678e-01, 3.5162625e-01),
	vec4(2.2479735e-01, 5.522091e-01, 8.0282706e-01, 6.3225627e-01),
	vec4(-5.4465884e-01, -2.58124e-01, 7.979466e-01, 9.1288626e-01),
	vec4(5.821351e-01, -1.7947847e-01, 7.930361e-01, 1.9351625e-01),
	vec4(-3.1123766e-01, 5.310719e-01, 7.88095e-01, 4.7414625e-01),
	vec4(-1.3056248e-01, -6.080067e-01, 7.831228e-01, 7.5477624e-01),
	vec4(5.120707e-01, 3.6375105e-01, 7.781187e-01, 3.540625e-02),
	vec4(-6.294363e-01, 7.8445435e-02, 7.730823e-01, 3.1603625e-01),
	vec4(4.1511005e-01, -4.8768833e-01, 7.680129e-01, 5.966663e-01),
	vec4(2.3560727e-02, 6.4607555e-01, 7.629097e-01, 8.7729627e-01),
	vec4(-4.5801213e-01, -4.6476462e-01, 7.577722e-01, 1.5792625e-01),
	vec4(6.576193e-01, 3.362452e-02, 7.5259966e-01, 4.3855625e-01),
	vec4(-5.121738e-01, 4.231835e-01, 7.473913e-01, 7.1918625e-01),
	vec4(9.261354e-02, -6.6380835e-01, 7.421464e-01, 9.9981624e-01),
	vec4(3.8339674e-01, 5.5681074e-01, 7.3686415e-01, 2.8044626e-01),
	vec4(-6.6443217e-01, -1.5288429e-01, 7.315437e-01, 5.610762e-01),
	vec4(5.981676e-01, -3.3889785e-01, 7.2618437e-01, 8.417063e-01),
	vec4(-2.1389407e-01, 6.5933156e-01, 7.2078514e-01, 1.2233625e-01),
	vec4(-2.8998244e-01, -6.3576055e-01, 7.153452e-01, 4.0296626e-01),
	vec4(6.4839983e-01, 2.7508432e-01, 7.0986354e-01, 6.8359625e-01),
	vec4(-6.69134e-01, 2.3699354e-01, 7.043392e-01, 9.6422625e-01),
	vec4(3.3588564e-01, -6.31585e-01, 6.9877124e-01, 2.4485625e-01),
	vec4(1.8031883e-01, 6.978656e-01, 6.931585e-01, 5.2548623e-01),
	vec4(-6.0889006e-01, -3.9572296e-01, 6.875e-01, 8.061162e-01),
	vec4(7.215699e-01, -1.20387495e-01, 6.817945e-01, 8.674625e-02),
	vec4(-4.5402077e-01, 5.8037394e-01, 6.760409e-01, 3.6737624e-01),
	vec4(-5.7666615e-02, -7.3990256e-01, 6.7023784e-01, 6.4800626e-01),
	vec4(5.461513e-01, 5.1020837e-01, 6.643841e-01, 9.2863625e-01),
	vec4(-7.5256383e-01, -7.342692e-03, 6.584784e-01, 2.0926625e-01),
	vec4(5.6372505e-01, -5.0639194e-01, 6.5251917e-01, 4.8989624e-01),
	vec4(-7.410954e-02, 7.5930166e-01, 6.46505e-01, 7.7052623e-01),
	vec4(-4.6132013e-01, -6.1402565e-01, 6.4043444e-01, 5.115625e-02),
	vec4(7.599146e-01, 1.420778e-01, 6.343057e-01, 3.3178625e-01),
	vec4(-6.605852e-01, 4.1121277e-01, 6.281172e-01, 6.1241627e-01),
	vec4(2.106709e-01, -7.542539e-01, 6.218671e-01, 8.9304626e-01),
	vec4(3.5639766e-01, 7.029043e-01, 6.155536e-01, 1.7367625e-01),
	vec4(-7.4222606e-01, -2.792968e-01, 6.0917467e-01, 4.5430624e-01),
	vec4(7.4051374e-01, -2.9725102e-01, 6.027282e-01, 7.3493624e-01),
	vec4(-3.473532e-01, 7.237935e-01, 5.96212e-01, 1.556625e-02),
	vec4(-2.3419462e-01, -7.729791e-01, 5.896238e-01, 2.9619625e-01),
	vec4(6.989759e-01, 4.1423288e-01, 5.829612e-01, 5.768263e-01),
	vec4(-7.9990494e-01, 1.6769256e-01, 5.762215e-01, 8.5745627e-01),
	vec4(4.7932908e-01, -6.67851e-01, 5.694021e-01, 1.3808624e-01),
	vec4(9.824752e-02, 8.209392e-01, 5.625e-01, 4.1871625e-01),
	vec4(-6.305537e-01, -5.420408e-01, 5.5551213e-01, 6.9934624e-01),
	vec4(8.3577627e-01, -2.6396735e-02, 5.484353e-01, 9.7997624e-01),
	vec4(-6.017786e-01, 5.872765e-01, 5.412659e-01, 2.6060626e-01),
	vec4(4.7292396e-02, -8.441606e-01, 5.340002e-01, 5.412362e-01),
	vec4(5.3826785e-01, 6.579696e-01, 5.2663434e-01, 8.218663e-01),
	vec4(-8.458897e-01, -1.22226976e-01, 5.1916397e-01, 1.0249625e-01),
	vec4(7.100628e-01, -4.8383063e-01, 5.115845e-01, 3.8312626e-01),
	vec4(-1.9779359e-01, 8.4081596e-01, 5.038911e-01, 6.6375625e-01),
	vec4(-4.2432046e-01, -7.5753444e-01, 4.9607837e-01, 9.4438624e-01),
	vec4(8.288493e-01, 2.7336344e-01, 4.881406e-01, 2.2501625e-01),
	vec4(-7.998928e-01, 3.6014277e-01, 4.800716e-01, 5.056462e-01),
	vec4(3.4829774e-01, -8.099583e-01, 4.7186464e-01, 7.862762e-01),
	vec4(2.9175016e-01, 8.366828e-01, 4.635124e-01, 6.690625e-02),
	vec4(-7.8417104e-01, -4.2195317e-01, 4.5500687e-01, 3.4753624e-01),
	vec4(8.6749065e-01, -2.1963884e-01, 4.4633928e-01, 6.2816626e-01),
	vec4(-4.9368745e-01, 7.5157595e-01, 4.375e-01, 9.0879625e-01),
	vec4(-1.4434482e-01, -8.9194775e-01, 4.2847842e-01, 1.8942624e-01),
	vec4(7.123214e-01, 5.6286496e-01, 4.1926274e-01, 4.7005624e-01),
	vec4(-9.097346e-01, 6.6439755e-02, 4.098399e-01, 7.506862e-01),
	vec4(6.288623e-01, -6.6661525e-01, 4.0019527e-01, 3.131625e-02),
	vec4(-1.3473606e-02, 9.205839e-01, 3.9031237e-01, 3.1194624e-01),
	vec4(-6.1472386e-01, -6.91074e-01, 3.8017267e-01, 5.9257627e-01),
	vec4(9.2428386e-01, 9.476626e-02, 3.69755e-01, 8.7320626e-01),
	vec4(-7.4891776e-01, 5.569703e-01, 3.5903516e-01, 1.5383625e-01),
	vec4(1.7678808e-01, -9.206803e-01, 3.4798527e-01, 4.3446624e-01),
	vec4(4.9373242e-01, 8.0183977e-01, 3.365728e-01, 7.1509624e-01),
	vec4(-9.0967906e-01, -2.5887316e-01, 3.247595e-01, 9.957262e-01),
	vec4(8.4932e-01, -4.2544007e-01, 3.125e-01, 2.7635625e-01),
	vec4(-3.4034538e-01, 8.9124703e-01, 2.9973948e-01, 5.569863e-01),
	vec4(-3.5257214e-01, -8.908769e-01, 2.86411e-01, 8.3761626e-01),
	vec4(8.6541367e-01, 4.2052394e-01, 2.724312e-01, 1.1824625e-01),
	vec4(-9.260719e-01, 2.7565306e-01, 2.576941e-01, 3.9887625e-01),
	vec4(4.9872935e-01, -8.3227116e-01, 2.4206147e-01, 6.7950624e-01),
	vec4(1.9524874e-01, 9.5451385e-01, 2.2534695e-01, 9.6013623e-01),
	vec4(-7.9197437e-01, -5.74289e-01, 2.0728905e-01, 2.4076626e-01),
	vec4(9.758628e-01, -1.11962356e-01, 1.875e-01, 5.213963e-01),
	vec4(-6.4654315e-01, 7.4474037e-01, 1.6535945e-01, 8.020263e-01),
	vec4(-2.6429586e-02, -9.898334e-01, 1.3975425e-01, 8.265625e-02),
	vec4(6.908473e-01, 7.1485054e-01, 1.0825317e-01, 3.6328626e-01),
	vec4(-9.9619824e-01, -6.068637e-02, 6.25e-02, 6.4391625e-01));
vec4 nookDirection(int i)
{
	return nook_directions[i];
}

// Smallest and largest cosine to the normal of all directions within an angle below 90 degrees around one direction; `middle`
// and `within` are the cosines of that direction and of the angle.
vec2 nookRingAround(float middle, float within)
{
	if (within <= 0.0f)
	{
		return vec2(-1.0f, 1.0f);
	}
	float across = sqrt(max(0.0f, (1.0f - middle * middle) * (1.0f - within * within)));
	return vec2(-middle >= within ? -1.0f : middle * within - across, middle >= within ? 1.0f : middle * within + across);
}

// Smallest and largest cosine to the normal of all directions that a polygon covers within reach, rounded to the safe side.
// Requires that no corner coincides with the receiver.
vec2 nookMaskRing(int count, vec3 n, vec3 front, float height, float reach)
{
	vec3 sum = vec3(0.0f, 0.0f, 0.0f);
	float lowest = 1.0f;
	for (int i = 0; i < count; ++i)
	{
		vec3 corner = nookCorner(i);
		vec3 unit = corner / sqrt(dot(corner, corner));
		sum = sum + unit;
		lowest = min(lowest, dot(unit, n));
	}
	vec3 middle = sum / sqrt(max(dot(sum, sum), 1e-12f));
	float within = 1.0f;
	for (int i = 0; i < count; ++i)
	{
		vec3 corner = nookCorner(i);
		within = min(within, dot(middle, corner) / sqrt(dot(corner, corner)));
	}
	vec2 around = nookRingAround(dot(middle, n), within);
	vec2 plane = nookRingAround(dot(front, n) * (height < 0.0f ? 1.0f : -1.0f), abs(height) / reach);
	float slack = 1e-3f; // covers all rounding
	// Above the horizon, no point of an edge is lower than its ends.
	return vec2(max(lowest > 0.0f ? lowest : around.x, plane.x) - slack, min(around.y, plane.y) + slack);
}

// Can a polygon with that ring cover any of 32 directions? Directions are sorted, the steepest first.
bool nookMaskAsks(int word, vec2 ring)
{
	return nookDirection(32 * word).z >= ring.x && nookDirection(32 * word + 31).z <= ring.y;
}

// The upper 12 bits of each component: the product of two of them is exact.
vec3 nookHead(vec3 a)
{
	return vec3(uintBitsToFloat(floatBitsToUint(a.x) & 0xfffff000u), uintBitsToFloat(floatBitsToUint(a.y) & 0xfffff000u),
		uintBitsToFloat(floatBitsToUint(a.z) & 0xfffff000u));
}

// a * b - c * d for numbers in two parts (the upper bits and the rest), accurate to 2^-36 of the larger product. Swapping a
// with c and b with d gives exactly the negative.
float nookProducts(vec2 a, vec2 b, vec2 c, vec2 d)
{
	float low = (a.x * b.y + a.y * b.x + a.y * b.y) - (c.x * d.y + c.y * d.x + c.y * d.y);
	return (a.x * b.x - c.x * d.x) + low;
}

// Cross product whose direction is accurate even where it nearly cancels.
vec3 nookCross(vec3 a, vec3 b)
{
	vec3 ha = nookHead(a);
	vec3 hb = nookHead(b);
	vec3 la = a - ha;
	vec3 lb = b - hb;
	vec2 ax = vec2(ha.x, la.x);
	vec2 ay = vec2(ha.y, la.y);
	vec2 az = vec2(ha.z, la.z);
	vec2 bx = vec2(hb.x, lb.x);
	vec2 by = vec2(hb.y, lb.y);
	vec2 bz = vec2(hb.z, lb.z);
	return vec3(nookProducts(ay, bz, az, by), nookProducts(az, bx, ax, bz), nookProducts(ax, by, ay, bx));
}

// A number in [0, 1) for each polygon, evenly distributed over any run of consecutive polygons.
float nookShift(int polygon)
{
	return float((uint(polygon) * 2654435769u) >> 8u) * 5.9604645e-8f;
}

// Axis 0 or 1 of a frame around a unit normal, the same for every receiver with that normal: the shortest rotation that takes a
// fixed axis to the normal. Only the normal opposite to that axis has no frame; the axis points steeply up, in a direction that
// is opposite to no axis-aligned or mirrored surface.
vec3 nookTangent(vec3 n, int axis)
{
	vec3 pole = vec3(0.23f, 0.94f, 0.252f);
	pole = pole / sqrt(dot(pole, pole));
	vec3 u = vec3(pole.y, -pole.x, 0.0f);
	u = u / sqrt(dot(u, u));
	if (axis > 0)
	{
		u = cross(pole, u);
	}
	// This sum keeps its digits where n is nearly opposite to the pole; 1 + dot(n, pole) would lose them.
	vec3 between = pole + n;
	return u - 2.0f * dot(between, u) / max(dot(between, between), 1e-12f) * between;
}

// Inward normal of the plane through an edge and the receiver, along the axes of the frame. The neighbour along that edge gets
// exactly the negative, so that no direction falls between the two. 0 where both ends coincide.
vec3 nookInward(vec3 from, vec3 to, vec3 n, vec3 x, vec3 y)
{
	vec3 c = nookCross(to, from);
	return vec3(dot(c, x), dot(c, y), dot(c, n));
}

// Bits of the directions from 32 * word to 32 * word + 31 that one polygon covers. height: nookHeight(front). polygon: a number
// of its own, the index of its first corner.
uint nookMaskWord(int count, int word, vec3 n, vec3 front, float height, float alpha, int polygon, float reach)
{
	vec3 x = nookTangent(n, 0);
	vec3 y = nookTangent(n, 1);
	float side = height < 0.0f ? -1.0f : 1.0f;
	float up = abs(height);
	vec3 down = vec3(dot(front, x), dot(front, y), dot(front, n)) * -side;
	float shift = nookShift(polygon);
	uint bits = 0u;
	for (int i = 0; i < 32; ++i)
	{
		vec4 d = nookDirection(32 * word + i);
		float along = dot(vec3(d.x, d.y, d.z), down) * reach; // the ray meets the plane at up / along of the reach
		if (along > up && 1.0f - up / along > d.w)
		{
			float share = float(32 * word + i) * 0.754877666f + shift;
			if (share - floor(share) < alpha)
			{
				bits = bits | (1u << uint(i));
			}
		}
	}
	vec3 a = nookCorner(count - 1);
	// Three edges for each pass over the directions; an edge without length removes none.
	for (int k = 0; k < count; k += 3)
	{
		vec3 b = nookCorner(k);
		vec3 c = nookCorner(min(k + 1, count - 1));
		vec3 e = nookCorner(min(k + 2, count - 1));
		if (bits != 0u)
		{
			vec3 first = nookInward(a, b, n, x, y) * side;
			vec3 second = nookInward(b, c, n, x, y) * side;
			vec3 third = nookInward(c, e, n, x, y) * side;
			for (int i = 0; i < 32; ++i)
			{
				vec4 d = nookDirection(32 * word + i);
				vec3 ray = vec3(d.x, d.y, d.z);
				if (dot(ray, first) < 0.0f || dot(ray, second) < 0.0f || dot(ray, third) < 0.0f)
				{
					bits = bits & ~(1u << uint(i));
				}
			}
		}
		a = e;
	}
	return bits;
}

// Fragment stage of the volumes: from a pixel that a volume covers to the occlusion of the surface there by the polygon.

// Corner i of the polygon relative to the receiver.
vec3 nookCorner(int i)
{
	return nook_base + nook_step * vec3(nookPackedCorner(nook_polygon.x + i).xyz);
}

// From view space to the axes of the world.
vec3 nookTurned(vec3 v)
{
	return nook.right.xyz * v.x + nook.up.xyz * v.y + nook.back.xyz * v.z;
}

// Sets up the surface that a pixel shows as the receiver, with the rounding of its position; returns its normal, or 0 where
// there is no surface.
vec3 nookReceive(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return vec3(0.0);
	}
	nook_base = nook_offset - nookTurned(nookPosition(pixel, depth));
	nook_bias = max(nook.plane_bias, nookDepthError(depth) + nook.position_error);
	vec3 normal = nookTurned(nookNormal(pixel));
	nook_base -= nookLift(nookHeight(nook_front.xyz), float(nook_polygon.z), nook_bias, dot(normal, nook_front.xyz)) * nook_front.xyz;
	return normal;
}

// Fragment stage with masks: from a pixel that a volume covers to the directions that the polygon covers there, as bits.

// Height of the receiver above the polygon where it is within the volume, else 0.
float nookMaskHeight(vec3 normal)
{
	if (dot(normal, normal) < 0.25)
	{
		return 0.0;
	}
	float height = nookHeight(nook_front.xyz);
	bool within = nookReaches(height, float(nook_polygon.z), nook.radius * nookShare().x, nook_bias) &&
		nookFalloff(nook_polygon.y, nook_front.xyz, abs(height), nook.radius, nookShare().y) > 0.0;
	return within ? height : 0.0;
}

// nookMaskRing for this polygon.
vec2 nookCoveredRing(vec3 normal, float height)
{
	return nookMaskRing(nook_polygon.y, normal, nook_front.xyz, height, nook.radius);
}

// nookMaskWord for this polygon: 32 of the directions. height: not 0.
uint nookCovered(int word, vec3 normal, float height)
{
	return nookMaskWord(nook_polygon.y, word, normal, nook_front.xyz, height, nook_front.w, nook_polygon.x, nook.radius);
}

layout(location = 0) out uvec4 nook_bits_0;

void main()
{
	vec3 normal = nookReceive(ivec2(gl_FragCoord.xy) * nook.cell);
	nook_bits_0 = uvec4(0u);
	float height = nookMaskHeight(normal);
	int words = height != 0.0 ? 4 : 0;
	vec2 ring = nookCoveredRing(normal, height);
	for (int word = 0; word < words; ++word)
	{
		if (nookMaskAsks(word, ring))
		{
			uint bits = nookCovered(word, normal, height);
			nook_bits_0 += uvec4(equal(ivec4(word - 0), ivec4(0, 1, 2, 3))) * bits;
		}
	}
}
#endif // NOOK_FRAGMENT

#ifdef NOOK_RESOLVE

// Counts covered directions (GLSL has bitCount only since 4.00).

uint nookBitsOf(uvec4 words)
{
	uvec4 n = words - ((words >> 1) & uvec4(0x55555555u));
	n = (n & uvec4(0x33333333u)) + ((n >> 2) & uvec4(0x33333333u));
	n = (((n + (n >> 4)) & uvec4(0x0f0f0f0fu)) * 0x01010101u) >> 24;
	return n.x + n.y + n.z + n.w;
}

uniform usampler2D nook_sums; // the pictures of the fragment stage
layout(location = 0) out float nook_visibility;

void main()
{
	ivec2 cell = ivec2(gl_FragCoord.xy);
	uint covered = nookBitsOf(texelFetch(nook_sums, cell, 0));
	nook_visibility = 1.0 - float(covered) / 128.0;
}
#endif // NOOK_RESOLVE

#ifdef NOOK_SPARSE

#ifndef NOOK_DEPTH // linear depth: distance along the view direction, > 0, metres; NOOK_SKY or more without a surface
uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
#ifndef NOOK_NORMAL // unit normal in view space: x to the right, y up, z toward the camera
uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) texelFetch(nook_normals, pixel, 0).xyz
#endif

float nookDepth(ivec2 pixel)
{
	return NOOK_DEPTH(pixel);
}
vec3 nookNormal(ivec2 pixel)
{
	return NOOK_NORMAL(pixel);
}

uniform sampler2D nook_cells; // the picture of the resolve stage

float nookVisibility(ivec2 cell)
{
	return texelFetch(nook_cells, cell, 0).r;
}

// View-space position of the surface that a pixel shows, from its depth. With NDC x and y of the pixel and clip-space w at that
// depth, this is the inverse of the projection.
vec3 nookPosition(ivec2 pixel, float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	float ndc_x = (float(pixel.x) + 0.5f - nook.origin.x) * nook.pixel_size.x * 2.0f - 1.0f;
	float ndc_y = 1.0f - (float(pixel.y) + 0.5f - nook.origin.y) * nook.pixel_size.y * 2.0f;
	return vec3(ndc_x * w * nook.across_x.x + depth * nook.across_x.y + nook.aside.x,
				ndc_y * w * nook.across_y.x + depth * nook.across_y.y + nook.aside.y, -depth);
}

// Size of a pixel in view space at a clip-space w of 1: to the right, and downward.
vec2 nookTexel()
{
	return vec2(2.0f * nook.pixel_size.x * nook.across_x.x, -2.0f * nook.pixel_size.y * nook.across_y.x);
}

// By how much a point on the line of sight of a pixel moves per metre of depth toward the eye.
vec3 nookSight(ivec2 pixel)
{
	float ndc_x = (float(pixel.x) + 0.5f - nook.origin.x) * nook.pixel_size.x * 2.0f - 1.0f;
	float ndc_y = 1.0f - (float(pixel.y) + 0.5f - nook.origin.y) * nook.pixel_size.y * 2.0f;
	return vec3(-nook.w_slope * ndc_x * nook.across_x.x - nook.across_x.y, -nook.w_slope * ndc_y * nook.across_y.x - nook.across_y.y,
				1.0f);
}

// The pixel at which a cell of visibility was evaluated.
ivec2 nookPixel(ivec2 cell)
{
	return cell * nook.cell;
}

// First cell of the picture; the guard band around it is not drawn.
ivec2 nookFirstCell()
{
	return ivec2((int(nook.origin.x) + nook.cell - 1) / nook.cell, (int(nook.origin.y) + nook.cell - 1) / nook.cell);
}

// Last cell of the picture.
ivec2 nookLastCell()
{
	return ivec2((int(nook.origin.x + nook.size.x) - 1) / nook.cell, (int(nook.origin.y + nook.size.y) - 1) / nook.cell);
}

// Is a cell in the picture?
bool nookDrawn(ivec2 cell)
{
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	return cell.x >= first.x && cell.y >= first.y && cell.x <= last.x && cell.y <= last.y;
}

// Do two pixels show the same surface: 1 yes, 0 no, with a ramp between. The ramp is flat at both ends, so that all pixels of a
// smooth surface have the same weight and the mean over a window of variants is exact. The thresholds were chosen by eye.
float nookAlikeOf(float apart, vec3 n, vec3 n_there)
{
	float beside = clamp(2.0f - apart * 20.0f, 0.0f, 1.0f);
	float turned = clamp(dot(n, n_there) * 5.0f - 3.5f, 0.0f, 1.0f);
	return beside * turned;
}

// nookAlikeOf for the surface of a pixel, with the normal n and the line of sight `sight`, and that of the pixel `there`, which
// is `across` pixels away.
float nookAlike(vec3 sight, float depth, vec3 n, ivec2 there, vec2 across)
{
	vec3 n_there = nookNormal(there);
	float surface = nookDepth(there);
	vec2 texel = nookTexel();
	vec3 both = n + n_there;
	float w = nook.w_slope * surface + nook.w_start;
	float apart = w * (both.x * (texel.x * across.x) + both.y * (texel.y * across.y)) - dot(both, sight) * (surface - depth);
	float alike = nookAlikeOf(abs(apart) / (2.0f * nook.radius), n, n_there);
	return surface < NOOK_SKY ? alike : 0.0f;
}

// Mean over 5 x 5 cells around the nearest one, or -1 for pixels to be drawn by themselves: those where, of the cells that the
// pixel lies between (at most four, weighted as in linear interpolation), less than half show its surface, or those that do
// differ by more than 0.12.
// On two test levels at 1280 x 720 these are 9 to 13 % of the pixels for cells of 3 x 3 and 19 % for 5 x 5, and they reduce the
// RMS difference from drawing all pixels to less than half. A limit of 0.08 would take a fifth more pixels for 10 % less
// difference, a share of 0.3 in place of one half would take a third fewer for 35 % more.
float nookSparse(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	vec3 sight = nookSight(pixel);
	ivec2 middle = ivec2((pixel.x + nook.cell / 2) / nook.cell, (pixel.y + nook.cell / 2) / nook.cell);
	float sum = 0.0f;
	float weights = 0.0f;
	float known = 0.0f;
	float least = 1.0f;
	float most = 0.0f;
	for (int i = 0; i < 25; ++i)
	{
		ivec2 there = ivec2(middle.x + i % 5 - 2, middle.y + i / 5 - 2);
		if (nookDrawn(there))
		{
			ivec2 taken = nookPixel(there);
			float alike = nookAlike(sight, depth, n, taken, vec2(float(taken.x - pixel.x), float(taken.y - pixel.y)));
			if (alike > 0.0f)
			{
				float visibility = nookVisibility(there);
				vec2 off = abs(vec2(float(taken.x - pixel.x), float(taken.y - pixel.y))) / float(nook.cell);
				float between = alike * max(1.0f - off.x, 0.0f) * max(1.0f - off.y, 0.0f);
				if (between > 0.0f)
				{
					known += between;
					least = min(least, visibility);
					most = max(most, visibility);
				}
				// Narrow in cells, so that creases stay dark (3 is 5 % closer than 1.5); half of the reach in metres.
				vec3 away = (nookPosition(taken, nookDepth(taken)) - centre) / nook.radius;
				float weight = alike * exp(-3.0f * dot(off, off) - 2.0f * dot(away, away));
				sum += weight * visibility;
				weights += weight;
			}
		}
	}
	if (known < 0.5f || most - least > 0.12f || weights <= 0.0f) // the last where all of them are more than a few times the reach away
	{
		return -1.0f;
	}
	return sum / weights;
}

layout(location = 0) out float nook_visibility;

void main()
{
	float visibility = nookSparse(ivec2(gl_FragCoord.xy));
	if (visibility < 0.0)
	{
		discard; // left for a second drawing at every pixel
	}
	nook_visibility = visibility;
}
#endif // NOOK_SPARSE
