// Made by: nook emit --methods aov --glsl 430
// Version: nook 0.1.0
// SPDX-License-Identifier: MIT
//
// Static ambient occlusion volumes of `nook volumes`, drawn over a frame's depth and normals: visibility of static surfaces, 1 where
// open. Four stages in one file, without #version, to be included after yours; say which one before:
//   #define NOOK_VERTEX    vertex stage of the volumes; with NOOK_PRISMS for files of --layout prisms
//   #define NOOK_FRAGMENT  their fragment stage
//   #define NOOK_RESOLVE   fragment stage over the picture: what was added up -> visibility
//   #define NOOK_SPARSE    only where one pixel of many is drawn: fragment stage over the whole picture, from nook_cells, the
//                          visibility of those; it discards pixels that they do not tell
// Each has its main(). nook_volumes.h reads the file, nook_volumes_draw.h fills the block and the clusters of a frame; both come with
// nook, are MIT, and need nothing else.
//
// Once: nook_volumes::Volumes::open. Upload corners() and polygons(): storage buffers nook_corners and
// nook_polygons. With prisms, vertices() as well, as the attribute nook_point (location 1, four GL_UNSIGNED_SHORT, 8 bytes apart),
// and indices() as elements (GL_UNSIGNED_SHORT).
// Every frame: nook_volumes::Frame::set; its block is the uniform block NookVolumes; Frame::seen of every cluster makes the storage
// buffer nook_clusters.
//
// Drawing, for each cluster i with Frame::inSight:
//   glVertexAttribI1i(0, i);
//   glDrawArrays(GL_TRIANGLES, 12 * first_corner, 12 * corner_count); // or, with prisms:
//   glDrawElementsBaseVertex(GL_TRIANGLES, index_count, GL_UNSIGNED_SHORT, 2 * first_index, first_vertex);
// or all in one call of glMultiDrawArraysIndirect (OpenGL 4.3), where nook_cluster (location 0) is an attribute with divisor 1 of the
// numbers 0, 1, 2 ..., and i the base instance.
// States: depth test against the frame's depth buffer, no depth writes; depth clamp; front faces counter-clockwise (clockwise where
// Frame::mirrored). Clusters that do not hold the eye: cull back faces, pass where nearer or equal. Those that do (Frame::holdsEye):
// cull front faces, pass where farther or equal. With EXT_depth_bounds_test, and a call a cluster: glDepthBoundsEXT of
// Frame::depthBounds spares the fragments of volumes that float between the eye and a surface.
// Fewer fragments: with NOOK_CHOOSE_FACES in the vertex stage draw all clusters in sight twice, with the first states and
// nook_faces = 1, then with the second ones and nook_faces = 2. Of each volume those faces are drawn that seem to cover fewer pixels
// in vain; the stage reads the depth in a few pixels for that (NOOK_DEPTH). Only for files with nook_volumes::kExactBounds: others
// are cut where they may still take light, and what is lost there depends on the faces.
// Target: R16F (or R32F; R8 saturates at 1), cleared to 0, blended GL_ONE, GL_ONE. It is nook_sums of the resolve stage.
// With Camera::every above 1 the target has ceil(width / every) columns and as many rows; its depth buffer holds the depths of those
// pixels. nook_depths and nook_normals are always those of the whole picture. Then, over the whole picture, whose target has a stencil:
//   1. clear the stencil to 0; NOOK_SPARSE, with the same block, and the stencil set to 1 where it draws (GL_ALWAYS, GL_REPLACE);
//   2. for the pixels that it discarded (thin things, edges, sharp creases: about a tenth) all again, where the stencil is 0
//      (GL_EQUAL, GL_KEEP): the volumes into a target as large as the picture, with the block of a Frame whose Camera::every is 1
//      (nook_clusters stays as it is), then NOOK_RESOLVE into the picture of step 1.
// Beside a screen-space method: visibility = min(this, that); nothing that both see is darkened twice.
#if __VERSION__ < 430
#error nook: this module needs #version 430 or later
#endif
#ifndef NOOK_BLOCK_BINDING
#define NOOK_BLOCK_BINDING 0
#endif
#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// nook_volumes::Block of nook_volumes_draw.h.
layout(std140, binding = NOOK_BLOCK_BINDING) uniform NookVolumes
{
	vec2 size; // width, height in pixels
	vec2 pixel_size;
	vec2 across_x; // of the projection: nookPosition
	vec2 across_y;
	vec2 aside;
	float w_slope;
	float w_start;
	vec2 origin;
	float far_end; // nookLeaning
	int cell;      // one pixel of as many squared is drawn
	vec4 depth;
	float depth_step; // nookDepthError
	float depth_share;
	float position_error; // metres
	float radius;         // how far a volume reaches, metres
	mat4 clip;            // clip space from the eye's, along axes of the world
	vec4 right;           // axes of view space in the world
	vec4 up;
	vec4 back;
	vec4 curve[9];      // occlusion at its knots
	vec4 slope;         // nookLeaning
	float plane_bias;   // so close to its plane a polygon takes nothing, metres
	float exact_bounds; // 1: of the volumes
	float sum_range;    // last knot
} nook;

#ifdef NOOK_VERTEX

#ifndef NOOK_CORNERS_BINDING
#define NOOK_CORNERS_BINDING 0
#endif
#ifndef NOOK_POLYGONS_BINDING
#define NOOK_POLYGONS_BINDING 1
#endif
#ifndef NOOK_CLUSTERS_BINDING
#define NOOK_CLUSTERS_BINDING 2
#endif

// The file's arrays as storage buffers; and of each frame the clusters.
layout(std430, binding = NOOK_CORNERS_BINDING) readonly buffer NookCorners
{
	uvec2 nook_corners[];
};
layout(std430, binding = NOOK_POLYGONS_BINDING) readonly buffer NookPolygons
{
	uvec2 nook_polygons[];
};
layout(std430, binding = NOOK_CLUSTERS_BINDING) readonly buffer NookClusters
{
	uvec4 nook_clusters[];
};

uvec4 nookPackedCorner(int i)
{
	uvec2 both = nook_corners[i];
	return uvec4(both.x & 65535u, both.x >> 16, both.y & 65535u, both.y >> 16);
}
uvec2 nookPackedPolygon(int i)
{
	return nook_polygons[i];
}
uvec4 nookSeenCluster(int i, int texel)
{
	return nook_clusters[4 * i + texel];
}

// Of the polygon, from stage to stage.
flat out ivec4 nook_polygon; // first corner, corners, 1 where it darkens both sides, how far it goes (nookShare)
flat out vec4 nook_front;    // unit normal of its front, alpha
flat out vec3 nook_offset;   // of its cluster, from the eye
flat out vec3 nook_step;

// Of the distance, how far its volume goes along its normal (x) and beyond its edges (y).
vec2 nookShare()
{
	float height = float(nook_polygon.w & 255) / 128.0;
	return vec2(height, height * float(nook_polygon.w >> 8) / 8.0);
}

// The upper 12 bits of each component: products of two of them are exact.
vec3 nookHead(vec3 a)
{
	return vec3(uintBitsToFloat(floatBitsToUint(a.x) & 0xfffff000u), uintBitsToFloat(floatBitsToUint(a.y) & 0xfffff000u),
		uintBitsToFloat(floatBitsToUint(a.z) & 0xfffff000u));
}

// a * b - c * d of numbers in two parts (head and the rest), to 2^-36 of the greater product. Swapping a with c and b with d gives
// exactly the negative.
float nookProducts(vec2 a, vec2 b, vec2 c, vec2 d)
{
	float low = (a.x * b.y + a.y * b.x + a.y * b.y) - (c.x * d.y + c.y * d.x + c.y * d.y);
	return (a.x * b.x - c.x * d.x) + low;
}

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

uniform int nook_faces; // 1: volumes that are drawn by their front faces, 2: by their back ones, 0: all

#ifndef NOOK_DEPTH // depth along the view direction, > 0, metres; NOOK_SKY or more where there is no surface
uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
#ifndef NOOK_NORMAL // unit normal in view space: x right, y up, z toward the camera
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

// Vertex stage of ambient occlusion volumes: which of a polygon's volumes are drawn by their front faces, and which by their back
// ones. Front faces also cover surfaces that lie behind the whole volume, back faces those that lie before it; neither takes
// anything from them, so whichever cover fewer are the ones to draw. What stands before it is in aov_text.cpp.

// Is the surface behind that point of the eye's space, along axes of the world (1), before it (-1), or not known (0)?
int nookSurfaceAt(vec3 point)
{
	float depth = -dot(nook.back.xyz, point);
	float w = nook.w_slope * depth + nook.w_start;
	if (w <= 0.0 || depth <= 0.0)
	{
		return 0;
	}
	// nookPosition the other way round.
	float x = (dot(nook.right.xyz, point) - depth * nook.across_x.y - nook.aside.x) / (w * nook.across_x.x);
	float y = (dot(nook.up.xyz, point) - depth * nook.across_y.y - nook.aside.y) / (w * nook.across_y.x);
	vec2 place = clamp(vec2(x + 1.0, 1.0 - y) * 0.5, 0.0, 1.0) * nook.size + nook.origin;
	return nookDepth(ivec2(min(place, nook.size + nook.origin - 1.0))) > depth ? 1 : -1;
}

// After nookSetPolygon. Back faces where the eye may be in the volume, for then there are no front ones before it; else by the
// surfaces at points halfway between the volume's middle and its corners, two for each corner of the polygon.
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

// Is this polygon one of those that nook_faces asks for?
bool nookIsAsked()
{
	return nook_faces == 0 || nookBackFaces() == (nook_faces == 2);
}
#endif // NOOK_CHOOSE_FACES

// Vertex stage of ambient occlusion volumes: numbers of a file -> a vertex of a polygon's volume (AOV section 5.2). Not a kernel of
// both languages: volume/prism.cpp is its twin in 64 bits. What stands before it, and its main(), are in aov_text.cpp.

// Unit normal of the polygon's front: its area, as a vector.
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

// How far a corner moves outward in the polygon's plane, where one edge arrives and another one leaves (AOV eqs. 9 to 11; closed form
// for unit vectors), at most `most`.
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

// How far volumes of one side begin behind their plane, metres: what lies there may be lifted into them (nookLift).
float nookBehind()
{
	return 1.01 * (nook.plane_bias + nook.position_error);
}

// Of corner i in the lower ring (ring 0) or the upper one.
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
	float most = 2.0 * reach; // AOV's clamp
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

// Fetches what all vertices of a polygon share. polygon: which of the cluster's.
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

// Layout polygons. Twelve vertices a corner: two triangles of the side that its edge makes, one of the lower face, one of the upper one.
void nookPolygonVertex(int cluster, int vertex)
{
	int corner = vertex / 12;
	int part = vertex % 12;
	nookSetPolygon(cluster, int(nookPackedCorner(corner).w));
#ifdef NOOK_CHOOSE_FACES
	if (!nookIsAsked())
	{
		gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // as all vertices of the polygon: nothing
		return;
	}
#endif
	int i = corner - nook_polygon.x;
	int next = i + 1 < nook_polygon.y ? i + 1 : 0;
	int at = part == 6 || part == 9 ? 0 : part == 0 || part == 3 || part == 5 || part == 8 || part == 10 ? i : next;
	int ring = part == 2 || part == 4 || part == 5 || part > 8 ? 1 : 0;
	gl_Position = nook.clip * vec4(nookPrismPoint(at, ring), 1.0);
}

// Layout prisms: a point of the file.
void nookPrismVertex(int cluster, uvec4 point)
{
	nookSetPolygon(cluster, int(point.w));
#ifdef NOOK_CHOOSE_FACES
	if (!nookIsAsked())
	{
		gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // as all vertices of the polygon: nothing
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

layout(location = 0) in int nook_cluster; // the same for all vertices of a cluster
#ifdef NOOK_PRISMS
layout(location = 1) in uvec4 nook_point; // of the file's vertices
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

#ifndef NOOK_CORNERS_BINDING
#define NOOK_CORNERS_BINDING 0
#endif
#ifndef NOOK_POLYGONS_BINDING
#define NOOK_POLYGONS_BINDING 1
#endif
#ifndef NOOK_CLUSTERS_BINDING
#define NOOK_CLUSTERS_BINDING 2
#endif

// The file's arrays as storage buffers; and of each frame the clusters.
layout(std430, binding = NOOK_CORNERS_BINDING) readonly buffer NookCorners
{
	uvec2 nook_corners[];
};
layout(std430, binding = NOOK_POLYGONS_BINDING) readonly buffer NookPolygons
{
	uvec2 nook_polygons[];
};
layout(std430, binding = NOOK_CLUSTERS_BINDING) readonly buffer NookClusters
{
	uvec4 nook_clusters[];
};

uvec4 nookPackedCorner(int i)
{
	uvec2 both = nook_corners[i];
	return uvec4(both.x & 65535u, both.x >> 16, both.y & 65535u, both.y >> 16);
}
uvec2 nookPackedPolygon(int i)
{
	return nook_polygons[i];
}
uvec4 nookSeenCluster(int i, int texel)
{
	return nook_clusters[4 * i + texel];
}

// Of the polygon, from stage to stage.
flat in ivec4 nook_polygon; // first corner, corners, 1 where it darkens both sides, how far it goes (nookShare)
flat in vec4 nook_front;    // unit normal of its front, alpha
flat in vec3 nook_offset;   // of its cluster, from the eye
flat in vec3 nook_step;

// Of the distance, how far its volume goes along its normal (x) and beyond its edges (y).
vec2 nookShare()
{
	float height = float(nook_polygon.w & 255) / 128.0;
	return vec2(height, height * float(nook_polygon.w >> 8) / 8.0);
}

#ifndef NOOK_DEPTH // depth along the view direction, > 0, metres; NOOK_SKY or more where there is no surface
uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
#ifndef NOOK_NORMAL // unit normal in view space: x right, y up, z toward the camera
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

vec3 nook_base;  // the cluster's offset from the receiver
float nook_bias; // metres: closer to a polygon's plane it takes nothing
vec3 nookCorner(int i);

// View-space position of what a pixel shows at a depth. nook.across_x = (1/P00, P20/P00) and nook.across_y = (1/P11, P21/P11),
// nook.aside = (-P30/P00, -P31/P11); w after the projection is nook.w_slope * depth + nook.w_start, of -P23 and P33.
vec3 nookPosition(ivec2 pixel, float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	float ndc_x = (float(pixel.x) + 0.5f - nook.origin.x) * nook.pixel_size.x * 2.0f - 1.0f;
	float ndc_y = 1.0f - (float(pixel.y) + 0.5f - nook.origin.y) * nook.pixel_size.y * 2.0f;
	return vec3(ndc_x * w * nook.across_x.x + depth * nook.across_x.y + nook.aside.x,
				ndc_y * w * nook.across_y.x + depth * nook.across_y.y + nook.aside.y, -depth);
}

// By how much a depth may be off, in its unit: a step of a depth buffer stands for a length that grows with the square of w.
// nook.depth_step = half a step for w = 1, nook.depth_share = rounding as a share of the depth.
float nookDepthError(float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	return nook.depth_step * w * w + nook.depth_share * abs(depth);
}

// Metres by which the receiver is above the polygon, whose unit normal is `front`; < 0 behind it.
float nookHeight(vec3 front)
{
	return -dot(front, nookCorner(0));
}

// Metres by which to move a receiver along `front` before it is evaluated: what lies in a polygon's plane, to within `bias`, is
// either on the polygon itself, which faces as the receiver does and must not darken it, or beside another surface, at a crease,
// where it would be a bright dot: that is moved just out of the plane. facing: cosine between the receiver's normal and `front`.
float nookLift(float height, float two_sided, float bias, float facing)
{
	if (abs(height) > bias || abs(facing) > 0.7f)
	{
		return 0.0f;
	}
	float out_of = two_sided > 0.5f && height < 0.0f ? -1.01f * bias : 1.01f * bias;
	return out_of - height;
}

// The upper 12 bits of each component: products of two of them are exact.
vec3 nookHead(vec3 a)
{
	return vec3(uintBitsToFloat(floatBitsToUint(a.x) & 0xfffff000u), uintBitsToFloat(floatBitsToUint(a.y) & 0xfffff000u),
		uintBitsToFloat(floatBitsToUint(a.z) & 0xfffff000u));
}

// a * b - c * d of numbers in two parts (head and the rest), to 2^-36 of the greater product. Swapping a with c and b with d gives
// exactly the negative.
float nookProducts(vec2 a, vec2 b, vec2 c, vec2 d)
{
	float low = (a.x * b.y + a.y * b.x + a.y * b.y) - (c.x * d.y + c.y * d.x + c.y * d.y);
	return (a.x * b.x - c.x * d.x) + low;
}

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

// Angle of (x, y), y >= 0, in [0, pi]; 0 for (0, 0). To 2e-7: the polynomial is the interpolation of atan(t) / t in t^2 at nine
// Chebyshev nodes, off by 2e-8. One text for all, since what a GPU's own atan() returns is not laid down.
float nookAngle(float y, float x)
{
	float across = abs(x);
	float most = max(y, across);
	if (!(most > 0.0f))
	{
		return 0.0f;
	}
	float t = min(y, across) / most;
	float u = t * t;
	float p = 0.0421376236f + u * (-0.0157312491f + u * 0.0027662835f);
	p = -0.141977978f + u * (0.106183706f + u * (-0.0745685483f + u * p));
	p = t * (0.999999982f + u * (-0.333330367f + u * (0.19991872f + u * p)));
	if (y > across)
	{
		p = 1.57079633f - p;
	}
	if (x < 0.0f)
	{
		p = 3.14159265f - p;
	}
	return p;
}

// Where the edge from a, h metres above the receiver's tangent plane, to b, on the other side of it, meets that plane, as a
// direction. c: the edge's cross product, of that length squared. Between a and b; where the edge's plane is steep enough, along
// the line that both planes share, which rounding of corners that are far away does not move.
vec3 nookNode(vec3 a, float ha, vec3 b, float hb, float squared, vec3 c, vec3 n)
{
	vec3 between = (a * hb - b * ha) / (hb - ha);
	vec3 node = cross(n, c);
	if (dot(node, node) > 1e-4f * squared && squared > 0.0f)
	{
		node = node / sqrt(squared);
		return dot(node, between) < 0.0f ? -node : node;
	}
	return between;
}

// Angle from a to b around the given axis, in (-pi/2, pi]: where rounding has two points pass each other that ought to be in that
// order, less than 0. At more than a right angle the sign is no question of rounding, unless the receiver is close to the polygon,
// where it would be a bad guess.
float nookTurn(vec3 a, vec3 b, vec3 axis)
{
	vec3 c = cross(a, b);
	float x = dot(a, b);
	float angle = nookAngle(sqrt(dot(c, c)), x);
	if (x > 0.0f && dot(c, axis) < 0.0f)
	{
		return -angle;
	}
	return angle;
}

// AOV eq. 4 for the part of the polygon above the tangent plane of a receiver with the unit normal n; side: 1 where the receiver
// sees the polygon's corners run counter-clockwise, -1 where clockwise. In [0, 1].
// One walk around the edges: the tangent plane cuts off an exit and an entry at a time, and the cut's own edge is added for each
// pair of them. A convex polygon has one pair; rounding may add pairs close to the tangent plane, and each gets its edge.
float nookFormFactor(int count, vec3 n, float side)
{
	vec3 a = nookCorner(count - 1);
	float ha = dot(a, n);
	float edges = 0.0f;
	float cuts = 0.0f;
	vec3 exit = vec3(0.0f, 0.0f, 0.0f);  // the last one
	vec3 entry = vec3(0.0f, 0.0f, 0.0f); // the first one, where no exit came before it
	int exits = 0;
	int entries = 0;
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nookCorner(i);
		float hb = dot(b, n);
		if (ha > 0.0f || hb > 0.0f)
		{
			vec3 c = nookCross(b, a);
			float squared = dot(c, c);
			float angle = 0.0f;
			if (ha > 0.0f && hb > 0.0f)
			{
				angle = nookAngle(sqrt(squared), dot(a, b));
			}
			if (ha <= 0.0f)
			{
				vec3 node = nookNode(a, ha, b, hb, squared, c, n);
				angle = nookTurn(b, node, c);
				if (exits > 0)
				{
					cuts += nookTurn(node, exit, n * side);
				}
				else
				{
					entry = node;
					entries = 1;
				}
			}
			if (hb <= 0.0f)
			{
				exit = nookNode(a, ha, b, hb, squared, c, n);
				exits = 1;
				angle = nookTurn(exit, a, c);
			}
			if (squared > 0.0f)
			{
				edges += dot(n, c) / sqrt(squared) * angle;
			}
		}
		a = b;
		ha = hb;
	}
	if (entries > 0 && exits > 0)
	{
		cuts += nookTurn(entry, exit, n * side);
	}
	return clamp((side * edges + cuts) * 0.159154943f, 0.0f, 1.0f);
}

// Does a polygon whose volume reaches that far (AOV: delta, metres) reach a receiver at that height: one of two sides to both, else
// its front alone. Nothing is within `bias` of its plane, so that no surface darkens itself, whatever its normals.
bool nookReaches(float height, float two_sided, float reach, float bias)
{
	float up = two_sided > 0.5f ? abs(height) : height;
	return up > bias && up < reach;
}

// The falloff without alpha (AOV eqs. 5 and 8), in [0, 1]; 0 outside of the volume. height: in front or, of two sides, behind.
// share: the volume ends where the factor of a side falls below 1 - share; of the height nookReaches asks.
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

// g times the form factor: what the polygon takes from a receiver with the unit normal n; in [0, alpha]. share: of reach, how far
// the volume goes along the normal (x) and beyond the edges (y).
float nookVolume(int count, vec3 n, vec3 front, float alpha, float two_sided, float reach, vec2 share, float bias)
{
	float height = nookHeight(front);
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

// Fragment stage of ambient occlusion volumes: a pixel of a volume -> what its polygon takes from the surface there. Not a kernel of
// both languages, but calls those (methods/kernels/*.glsl). What stands before it, and its main(), are in aov_text.cpp.

// Corner i of the polygon from the receiver.
vec3 nookCorner(int i)
{
	return nook_base + nook_step * vec3(nookPackedCorner(nook_polygon.x + i).xyz);
}

// View space -> axes of the world.
vec3 nookTurned(vec3 v)
{
	return nook.right.xyz * v.x + nook.up.xyz * v.y + nook.back.xyz * v.z;
}

// Sets the receiver and by how much its place may be off; its normal, or 0 where there is none.
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

// AOV eqs. 4 and 5.
float nookOcclusion(ivec2 pixel)
{
	vec3 normal = nookReceive(pixel);
	if (dot(normal, normal) < 0.25)
	{
		return 0.0;
	}
	return nookVolume(nook_polygon.y, normal, nook_front.xyz, nook_front.w, float(nook_polygon.z), nook.radius,
		nookShare(), nook_bias);
}

layout(location = 0) out float nook_occlusion;

void main()
{
	nook_occlusion = nookOcclusion(ivec2(gl_FragCoord.xy) * nook.cell);
}
#endif // NOOK_FRAGMENT

#ifdef NOOK_RESOLVE

// Sum of all volumes' occlusion -> occlusion, by the level's curve (AOV section 5.4).

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

uniform sampler2D nook_sums;
layout(location = 0) out float nook_visibility;

void main()
{
	nook_visibility = 1.0 - nookCompensated(texelFetch(nook_sums, ivec2(gl_FragCoord.xy), 0).r);
}
#endif // NOOK_RESOLVE

#ifdef NOOK_SPARSE

#ifndef NOOK_DEPTH // depth along the view direction, > 0, metres; NOOK_SKY or more where there is no surface
uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
#ifndef NOOK_NORMAL // unit normal in view space: x right, y up, z toward the camera
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

uniform sampler2D nook_cells; // what the resolve stage drew

float nookVisibility(ivec2 cell)
{
	return texelFetch(nook_cells, cell, 0).r;
}

// View-space position of what a pixel shows at a depth. nook.across_x = (1/P00, P20/P00) and nook.across_y = (1/P11, P21/P11),
// nook.aside = (-P30/P00, -P31/P11); w after the projection is nook.w_slope * depth + nook.w_start, of -P23 and P33.
vec3 nookPosition(ivec2 pixel, float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	float ndc_x = (float(pixel.x) + 0.5f - nook.origin.x) * nook.pixel_size.x * 2.0f - 1.0f;
	float ndc_y = 1.0f - (float(pixel.y) + 0.5f - nook.origin.y) * nook.pixel_size.y * 2.0f;
	return vec3(ndc_x * w * nook.across_x.x + depth * nook.across_x.y + nook.aside.x,
				ndc_y * w * nook.across_y.x + depth * nook.across_y.y + nook.aside.y, -depth);
}

ivec2 nookPixel(ivec2 cell)
{
	return cell * nook.cell;
}

// Of the picture, as far as it is drawn: a guard band is not.
ivec2 nookFirstCell()
{
	return ivec2((int(nook.origin.x) + nook.cell - 1) / nook.cell, (int(nook.origin.y) + nook.cell - 1) / nook.cell);
}

ivec2 nookLastCell()
{
	return ivec2((int(nook.origin.x + nook.size.x) - 1) / nook.cell, (int(nook.origin.y + nook.size.y) - 1) / nook.cell);
}

bool nookDrawn(ivec2 cell)
{
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	return cell.x >= first.x && cell.y >= first.y && cell.x <= last.x && cell.y <= last.y;
}

// How far, as a share of the radius, two positions are from the tangent plane that they share: the plane between the two normals
// holds both ends of any arc of a circle, so that columns are as smooth as walls. Unlike a difference of depths it is 0 along a plane
// at any slope; and visibility can change by no more than about its size.
float nookApartFrom(vec3 centre, vec3 n, vec3 there, vec3 n_there)
{
	return abs(dot(n + n_there, there - centre)) / (2.0f * nook.radius);
}

// Of a pixel's position from a pixel; NOOK_SKY for sky.
float nookApart(vec3 centre, vec3 n, ivec2 there)
{
	float depth = nookDepth(there);
	if (depth >= NOOK_SKY)
	{
		return NOOK_SKY;
	}
	return nookApartFrom(centre, n, nookPosition(there, depth), nookNormal(there));
}

// Do two show the same surface: 1 yes, 0 no. Flat at both ends, so that on a smooth surface all pixels count alike, which is what
// makes the mean of a window of variants exact. Chosen by eye on builtin:courtyard, not swept.
float nookAlikeOf(float apart, vec3 n, vec3 n_there)
{
	float beside = clamp(2.0f - apart * 20.0f, 0.0f, 1.0f);
	float turned = clamp(dot(n, n_there) * 5.0f - 3.5f, 0.0f, 1.0f);
	return beside * turned;
}

float nookAlike(vec3 centre, vec3 n, ivec2 there)
{
	return nookAlikeOf(nookApart(centre, n, there), n, nookNormal(there));
}

// The mean over 5 x 5 cells around the nearest one; or -1, for pixels to be drawn by themselves: of the cells between which a pixel
// lies (at most four, weighted as for a linear interpolation) less than half show its surface, or those that do differ by more than
// 0.12. On builtin:suburb and Sponza at 1280 x 720 these are 9 to 13 % of the pixels for cells of 3 x 3, 19 % for 5 x 5, and the
// RMS difference from all pixels falls to less than half of what it is if they are filtered as well; 0.08 takes a fifth more pixels
// for 10 % less, a share of 0.3 in place of the half a third fewer pixels for 35 % more.
float nookSparse(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
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
			float alike = nookAlike(centre, n, taken);
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
				// Narrow in cells, so that creases stay dark (3 is 5 % closer than 1.5); in metres half of the reach.
				vec3 away = (nookPosition(taken, nookDepth(taken)) - centre) / nook.radius;
				float weight = alike * exp(-3.0f * dot(off, off) - 2.0f * dot(away, away));
				sum += weight * visibility;
				weights += weight;
			}
		}
	}
	if (known < 0.5f || most - least > 0.12f || weights <= 0.0f) // the last: all of them more than a few times the reach away
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
		discard; // to be drawn by itself
	}
	nook_visibility = visibility;
}
#endif // NOOK_SPARSE
