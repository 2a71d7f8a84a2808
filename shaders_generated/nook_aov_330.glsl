// Made by: nook emit --methods aov --glsl 330
// Version: nook 0.1.0
// SPDX-License-Identifier: MIT
//
// Draws the static ambient occlusion volumes of a file that `nook volumes` wrote over the depth and normals of a frame: visibility of
// static surfaces, 1 where open. Stages: define one of these macros first, after your #version, for its main():
//   NOOK_VERTEX (with NOOK_PRISMS for files of --layout prisms), NOOK_FRAGMENT: the volumes; one depth read per fragment
//   NOOK_RESOLVE, NOOK_SPARSE: the picture; NOOK_SPARSE where one pixel of 9 or 25 was drawn, at most 51 depth reads.
// Once: nook_volumes::Volumes::open (nook_volumes.h; volumes_file.js of the npm package nook-ao). Upload corners() and polygons() as
// buffer textures RGBA16UI and RG32UI, nook_corners and nook_polygons.
// Every frame: nook_volumes::Frame::set (nook_volumes_draw.h); its block is the uniform block NookVolumes. Frame::seen of every cluster
// makes buffer textures RGBA32UI, four texels a cluster, nook_clusters.
// Draw call of each cluster i with Frame::inSight:
//   glVertexAttribI1i(0, i); // or NOOK_CLUSTER, defined as a uniform of yours, gl_DrawID, in Vulkan gl_InstanceIndex
//   glDrawArrays(GL_TRIANGLES, 12 * first_corner, 12 * corner_count);
// With prisms the attribute nook_point (location 1) is vertices(), four unsigned 16-bit integers, and the call
//   glDrawElementsBaseVertex(GL_TRIANGLES, index_count, GL_UNSIGNED_SHORT, 2 * first_index, first_vertex);
// All in one call: glMultiDrawArraysIndirect, where nook_cluster has divisor 1 and holds 0, 1, 2 ..., and i is the base instance.
// States: depth test against the depth buffer of the frame, no depth writes; depth clamp; front faces counter-clockwise (clockwise where
// Frame::mirrored). Clusters that do not contain the eye: cull back faces, depth test "less or equal". Clusters that do
// (Frame::holdsEye): cull front faces, depth test "greater or equal"; reversed depth has the opposite tests. Without depth clamp set
// NOOK_ANY_DEPTH for the vertex stage and draw without a depth test.
// nook's page "Drawing occlusion volumes" says how NOOK_CHOOSE_FACES spares fragments, and NOOK_SPARSE draws one pixel of 9 or 25.
// Together with a screen-space method, take min(this visibility, that one): then an occluder that both see counts once.
// Target: R16F (or R32F; R8 would saturate at 1), cleared to 0; blending adds. The resolve stage reads it as nook_sums.
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

// Cross product whose direction is accurate even where it nearly cancels. Where the language has fma(), which rounds once, products
// and their rounding are subtracted (W. Kahan's difference of products); otherwise factors are split.
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

// 1: keeps volumes that are drawn by their front faces, 2: by their back faces, 0: keeps all.
uniform int nook_faces;

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
	vec2 place = clamp(vec2(x + 1.0, 1.0 - y) * 0.5, vec2(0.0, 0.0), vec2(1.0, 1.0)) * nook.size + nook.origin;
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
	vec3 middle = vec3(0.0, 0.0, 0.0);
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
	vec3 sum = vec3(0.0, 0.0, 0.0);
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
vec4 nookPolygonVertex(int cluster, int vertex)
{
	int corner = vertex / 12;
	int part = vertex % 12;
	nookSetPolygon(cluster, int(nookPackedCorner(corner).w));
#ifdef NOOK_CHOOSE_FACES
	if (!nookIsAsked())
	{
		return vec4(2.0, 2.0, 2.0, 1.0); // outside the picture, as all vertices of this polygon: nothing is drawn
	}
#endif
	int i = corner - nook_polygon.x;
	int next = i + 1 < nook_polygon.y ? i + 1 : 0;
	int at = part == 6 || part == 9 ? 0 : part == 0 || part == 3 || part == 5 || part == 8 || part == 10 ? i : next;
	int ring = part == 2 || part == 4 || part == 5 || part > 8 ? 1 : 0;
	return nook.clip * vec4(nookPrismPoint(at, ring), 1.0);
}

// Layout prisms: a vertex of the file.
vec4 nookPrismVertex(int cluster, uvec4 point)
{
	nookSetPolygon(cluster, int(point.w));
#ifdef NOOK_CHOOSE_FACES
	if (!nookIsAsked())
	{
		return vec4(2.0, 2.0, 2.0, 1.0); // outside the picture, as all vertices of this polygon: nothing is drawn
	}
#endif
	vec3 offset = uintBitsToFloat(nookSeenCluster(cluster, 2).xyz);
	vec3 step = uintBitsToFloat(nookSeenCluster(cluster, 3).xyz);
	vec3 at = offset + step * vec3(point.xyz);
	vec3 corner = nook_offset + nook_step * vec3(nookPackedCorner(nook_polygon.x).xyz);
	bool lower = nook_polygon.z == 0 && dot(nook_front.xyz, at - corner) < 0.5 * nook.radius * nookShare().x;
	return nook.clip * vec4(at - (lower ? nookBehind() : 0.0) * nook_front.xyz, 1.0);
}

#ifndef NOOK_CLUSTER // number of the cluster, the same for all its vertices
layout(location = 0) in int nook_cluster;
#define NOOK_CLUSTER nook_cluster
#endif
#ifdef NOOK_PRISMS
layout(location = 1) in uvec4 nook_point; // a vertex of the file
#endif

void main()
{
#ifdef NOOK_PRISMS
	gl_Position = nookPrismVertex(NOOK_CLUSTER, nook_point);
#else
	gl_Position = nookPolygonVertex(NOOK_CLUSTER, gl_VertexID);
#endif
#ifdef NOOK_ANY_DEPTH
	gl_Position.z = 0.0; // neither the near nor the far plane cuts it
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

// Corner i of the polygon relative to the receiver.
vec3 nookCorner(int i)
{
	return nook_base + nook_step * vec3(nookPackedCorner(nook_polygon.x + i).xyz);
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

// Cross product whose direction is accurate even where it nearly cancels. Where the language has fma(), which rounds once, products
// and their rounding are subtracted (W. Kahan's difference of products); otherwise factors are split.
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

// acos(x) / sqrt(1 - x * x) for x in [0, 1]: the angle between two unit vectors over its sine, from its cosine. Times the sine, the
// polynomial is off by 4e-7. It gives the same result on every GPU, which acos does not guarantee.
float nookArc(float x)
{
	float p = 0.522759580f + x * (-0.345475831f + x * (0.152677448f - x * 0.0317200786f));
	return 1.57079595f + x * (-0.999943104f + x * (0.783984789f + x * (-0.653083218f + x * p)));
}

// A vector times this has unit length, if it is longer than 1e-15.
float nookUnit(vec3 a)
{
	return 1.0f / sqrt(max(dot(a, a), 1e-30f));
}

// Angle of a unit vector in a plane from the x axis, in (-pi/2, pi]; below 0 where rounding has swapped two points that should be in
// that order. Beyond a right angle the sign is not due to rounding, except for a receiver close to the polygon, where it could
// only be guessed.
float nookTurn(vec2 a)
{
	float arc = nookArc(abs(a.x));
	return a.x < 0.0f ? 3.14159265f - arc * abs(a.y) : arc * a.y;
}

// AOV eq. 4 for the part of the polygon above the tangent plane of a receiver with the unit normal n, in [0, 1]. side: 1 where
// the receiver sees the corners counter-clockwise, -1 where clockwise.
// It walks around the edges once, in a frame whose z axis is n (T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT
// 2017). The tangent plane cuts the polygon at pairs of an exit and an entry, and the edge along the cut has the angle between
// them. A convex polygon has one pair; rounding may add more close to the tangent plane. As complex numbers, the exits times the
// conjugates of the entries have the sum of all these angles.
// The direction in which an edge crosses the tangent plane is interpolated between those of its ends. Where they are nearly
// opposite it lies on the line that the tangent plane and the plane of the edge share, unless both planes nearly are one: then
// any direction between the ends will do.
float nookFormFactor(int count, vec3 n, float side)
{
	float upward = n.z < 0.0f ? -1.0f : 1.0f;
	float q = -1.0f / (upward + n.z);
	float mixed = n.x * n.y * q;
	vec3 right = vec3(1.0f + upward * n.x * n.x * q, upward * mixed, -upward * n.x);
	vec3 up = vec3(mixed, upward + n.y * n.y * q, -n.y);
	vec3 a = nookCorner(count - 1);
	vec3 away = a * nookUnit(a);
	vec3 from = vec3(dot(away, right), dot(away, up), dot(away, n));
	float edges = 0.0f;
	vec2 cut = vec2(1.0f, 0.0f);
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nookCorner(i);
		away = b * nookUnit(b);
		vec3 to = vec3(dot(away, right), dot(away, up), dot(away, n));
		if (from.z > 0.0f || to.z > 0.0f)
		{
			vec2 first = vec2(from.x, from.y);
			vec2 last = vec2(to.x, to.y);
			float cosine = dot(from, to);
			bool opposite = cosine < -0.95f;
			vec3 exact = vec3(0.0f, 0.0f, 0.0f);
			if (opposite)
			{
				exact = nookCross(b, a);
			}
			if (from.z <= 0.0f || to.z <= 0.0f)
			{
				bool exits = to.z <= 0.0f;
				vec2 node = first * abs(to.z) + last * abs(from.z);
				if (opposite)
				{
					vec2 line = vec2(-dot(exact, up), dot(exact, right));
					line = exits ? line : -line;
					node = dot(line, line) > 1e-4f * dot(exact, exact) ? line : node;
				}
				node = node * (1.0f / sqrt(max(dot(node, node), 1e-30f)));
				first = exits ? first : node;
				last = exits ? node : last;
				cosine = dot(first, last);
				float turn = exits ? node.y : -node.y;
				cut = vec2(cut.x * node.x - cut.y * turn, cut.x * turn + cut.y * node.x);
			}
			float sine = last.x * first.y - last.y * first.x;
			float term = sine * nookArc(abs(cosine));
			if (cosine < 0.0f)
			{
				float unit = opposite ? dot(n, exact) * nookUnit(exact) : sine / sqrt(1.0f - cosine * cosine);
				term = 3.14159265f * unit - term;
			}
			edges += term;
		}
		a = b;
		from = to;
	}
	float cuts = nookTurn(vec2(cut.x, side * cut.y));
	return clamp((side * edges + cuts) * 0.159154943f, 0.0f, 1.0f);
}

// The falloff without alpha (AOV eqs. 5 and 8), in [0, 1]; 0 outside the volume. height: distance from the plane. share: the
// volume ends where the factor of a side falls below 1 - share; the height is checked by nookReaches.
float nookFalloff(int count, vec3 front, float height, float reach, float share)
{
	float least = 1.0f - share;
	float scale = 1.0f / reach;
	float g = clamp(1.0f - height * scale, 0.0f, 1.0f);
	vec3 a = nookCorner(count - 1);
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nookCorner(i);
		vec3 inward = cross(front, b - a); // AOV eq. 7
		float side = clamp(1.0f - dot(a, inward) * (scale * nookUnit(inward)), 0.0f, 1.0f); // 1 where both ends coincide
		g = side < least ? 0.0f : g * side;
		a = b;
	}
	return g;
}

// The occlusion by the polygon, falloff times form factor, at a receiver with the unit normal n; in [0, alpha]. height:
// nookHeight(front). share: extent of the volume along the normal (x) and beyond the edges (y), as shares of reach.
float nookVolume(int count, vec3 n, vec3 front, float alpha, float two_sided, float height, float reach, vec2 share, float bias)
{
	if (!nookReaches(height, two_sided, reach * share.x, bias))
	{
		return 0.0f;
	}
	float g = alpha * nookFalloff(count, front, abs(height), reach, share.y);
	if (g > 0.0f)
	{
		return g * nookFormFactor(count, n, height < 0.0f ? -1.0f : 1.0f);
	}
	return 0.0f;
}

// Fragment stage of the volumes: from a pixel that a volume covers to the occlusion of the surface there by the polygon.

// From view space to the axes of the world.
vec3 nookTurned(vec3 v)
{
	return nook.right.xyz * v.x + nook.up.xyz * v.y + nook.back.xyz * v.z;
}

// Sets up the surface that a pixel shows as the receiver, with the rounding of its position; returns its height above the polygon.
float nookReceive(ivec2 pixel, float depth)
{
	nook_base = nook_offset - nookTurned(nookPosition(pixel, depth));
	nook_bias = max(nook.plane_bias, nookDepthError(depth) + nook.position_error);
	return nookHeight(nook_front.xyz);
}

// Does the volume reach the receiver, or may it once nookLifted has moved it?
bool nookMayReach(float height)
{
	return nookReaches(height, float(nook_polygon.z), nook.radius * nookShare().x, -nook_bias);
}

// Moves the receiver by nookLift; returns its new height.
float nookLifted(float height, vec3 normal)
{
	float lift = nookLift(height, float(nook_polygon.z), nook_bias, dot(normal, nook_front.xyz));
	nook_base -= lift * nook_front.xyz;
	return height + lift;
}

// AOV eqs. 4 and 5. The normal is fetched only where the volume reaches.
float nookOcclusion(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 0.0;
	}
	float height = nookReceive(pixel, depth);
	if (!nookMayReach(height))
	{
		return 0.0;
	}
	vec3 normal = nookTurned(nookNormal(pixel));
	height = nookLifted(height, normal);
	return nookVolume(nook_polygon.y, normal, nook_front.xyz, nook_front.w, float(nook_polygon.z), height, nook.radius, nookShare(),
		nook_bias);
}

layout(location = 0) out float nook_occlusion;

void main()
{
	nook_occlusion = nookOcclusion(ivec2(gl_FragCoord.xy) * nook.cell);
}
#endif // NOOK_FRAGMENT

#ifdef NOOK_RESOLVE

// Corrects the sum of the occlusion of all volumes by the curve of the level (AOV section 5.4).

// Linear between 33 knots from 0 to nook.sum_range, constant beyond.
float nookCompensated(float sum)
{
	float place = clamp(sum / nook.sum_range, 0.0, 1.0) * 32.0;
	int knot = int(min(floor(place), 31.0));
	float share = place - float(knot);
	float before = nook.curve[knot / 4][knot % 4];
	float after = nook.curve[(knot + 1) / 4][(knot + 1) % 4];
	return before + share * (after - before);
}

uniform sampler2D nook_sums; // the picture of the fragment stage

float nookResolved(ivec2 cell)
{
	return 1.0 - nookCompensated(texelFetch(nook_sums, cell, 0).r);
}

layout(location = 0) out float nook_visibility;

void main()
{
	nook_visibility = nookResolved(ivec2(gl_FragCoord.xy));
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

// The cell that holds a pixel of the picture. Without signs the division is a shift.
ivec2 nookCellOf(ivec2 pixel)
{
	return ivec2(int(uint(pixel.x) / uint(nook.cell)), int(uint(pixel.y) / uint(nook.cell)));
}

// First cell of the picture; the guard band around it is not drawn.
ivec2 nookFirstCell()
{
	return nookCellOf(ivec2(int(nook.origin.x) + nook.cell - 1, int(nook.origin.y) + nook.cell - 1));
}

// Last cell of the picture.
ivec2 nookLastCell()
{
	return nookCellOf(ivec2(int(nook.origin.x + nook.size.x) - 1, int(nook.origin.y + nook.size.y) - 1));
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

// nookAlikeOf for the surface of a pixel, with the normal n and the line of sight `sight`, and a surface at depth `there`, `across`
// pixels away; 0 where that is sky.
float nookAlikeThere(vec3 sight, float depth, vec3 n, vec2 across, float there, vec3 n_there)
{
	vec2 texel = nookTexel();
	vec3 both = n + n_there;
	float w = nook.w_slope * there + nook.w_start;
	float apart = w * (both.x * (texel.x * across.x) + both.y * (texel.y * across.y)) - dot(both, sight) * (there - depth);
	float alike = nookAlikeOf(abs(apart) / (2.0f * nook.radius), n, n_there);
	return there < NOOK_SKY ? alike : 0.0f;
}

// nookAlikeThere for the pixel `there`.
float nookAlike(vec3 sight, float depth, vec3 n, ivec2 there, vec2 across)
{
	return nookAlikeThere(sight, depth, n, across, nookDepth(there), nookNormal(there));
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

float nookKnown(ivec2 pixel)
{
	float visibility = nookSparse(pixel);
	if (visibility < 0.0)
	{
		discard; // left for a second drawing at every pixel
	}
	return visibility;
}

layout(location = 0) out float nook_visibility;

void main()
{
	nook_visibility = nookKnown(ivec2(gl_FragCoord.xy));
}
#endif // NOOK_SPARSE
