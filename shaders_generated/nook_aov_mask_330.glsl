// Made by: nook emit --methods aov-mask --glsl 330
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
// Target: unsigned integers, R32UI, RG32UI or RGBA32UI for up to 32, 64 and 128 directions, a second RGBA32UI for more; cleared to 0;
// no blending, but the logic operation OR (GL_COLOR_LOGIC_OP). The resolve stage reads them as nook_sums and nook_more_sums.
// Once, before the first frame: draw a triangle over a texture RGBA32UI of 64 x 64 texels, 64 x 128 above 128 directions, with the
// stage NOOK_HALF_SPACES. The fragment stage of the volumes reads it as nook_half_spaces.
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

#if defined(NOOK_FRAGMENT) || defined(NOOK_HALF_SPACES)

const vec3 nook_rays[128] = vec3[128](
	vec3(6.225586e-02, 0e+00, 9.9414635e-01),
	vec3(-5.7110123e-02, 5.231755e-02, 7.1125925e-01),
	vec3(5.31285e-03, -6.053718e-02, 4.305664e-01),
	vec3(1.5514614e-02, 2.0236066e-02, 1.5208091e-01),
	vec3(-1.6129123e-01, -2.8530149e-02, 8.5808057e-01),
	vec3(1.037066e-01, -6.596965e-02, 5.800649e-01),
	vec3(-1.8270679e-02, 6.7966014e-02, 3.0428058e-01),
	vec3(-3.5348863e-03, -6.8062088e-03, 3.0741498e-02),
	vec3(1.8179823e-01, 6.639242e-02, 7.256881e-01),
	vec3(-1.1846238e-01, 4.8899543e-02, 4.526301e-01),
	vec3(2.3039853e-02, -4.9234822e-02, 1.8184271e-01),
	vec3(8.1558526e-02, 2.6002142e-01, 8.673614e-01),
	vec3(-1.69942e-01, -9.848487e-02, 5.970553e-01),
	vec3(1.1034977e-01, -2.4260087e-02, 3.2904616e-01),
	vec3(-1.3022373e-02, 1.8522987e-02, 6.3348815e-02),
	vec3(-3.5178572e-02, -2.7147064e-01, 7.374785e-01),
	vec3(1.3891892e-01, 1.17081024e-01, 4.722748e-01),
	vec3(-8.32656e-02, 3.4432942e-03, 2.0941065e-01),
	vec3(2.5458995e-01, -2.5335097e-01, 8.7381744e-01),
	vec3(-1.197355e-02, 2.5893906e-01, 6.1144716e-01),
	vec3(-9.833116e-02, -1.17833585e-01, 3.514451e-01),
	vec3(4.178117e-02, 5.621597e-03, 9.382792e-02),
	vec3(-2.8297612e-01, 1.9688742e-01, 7.464772e-01),
	vec3(5.0934058e-02, -2.2640698e-01, 4.8936716e-01),
	vec3(5.676613e-02, 9.906447e-02, 2.3467241e-01),
	vec3(-4.1686592e-01, -1.3299158e-01, 8.7727416e-01),
	vec3(2.890176e-01, -1.3353345e-01, 6.230866e-01),
	vec3(-7.499257e-02, 1.7919092e-01, 3.7134615e-01),
	vec3(-2.2111569e-02, -6.1475787e-02, 1.2207063e-01),
	vec3(3.645359e-01, 1.9158985e-01, 7.525081e-01),
	vec3(-2.7244544e-01, 7.1815744e-02, 5.037545e-01),
	vec3(7.956743e-02, -1.23745635e-01, 2.574997e-01),
	vec3(1.3599002e-03, 7.9128705e-03, 1.3763052e-02),
	vec3(-2.9740876e-01, -2.3033005e-01, 6.3179725e-01),
	vec3(2.3524429e-01, -1.9489508e-02, 3.8859814e-01),
	vec3(-6.224267e-02, 6.72825e-02, 1.4795321e-01),
	vec3(2.327344e-03, -4.770775e-01, 7.5536734e-01),
	vec3(2.2285016e-01, 2.4565978e-01, 5.1526016e-01),
	vec3(-1.8138748e-01, -1.681095e-02, 2.7774465e-01),
	vec3(2.2799177e-02, -1.7303763e-02, 4.2842425e-02),
	vec3(-7.761224e-02, 4.2662555e-01, 6.3737285e-01),
	vec3(-1.4868069e-01, -2.3626849e-01, 4.030258e-01),
	vec3(1.16499655e-01, 3.1927727e-02, 1.7133231e-01),
	vec3(-4.8183018e-01, 2.472673e-01, 7.548156e-01),
	vec3(1.3289273e-01, -3.584553e-01, 5.236772e-01),
	vec3(8.266782e-02, 2.0307143e-01, 2.9523462e-01),
	vec3(-4.7447268e-02, -2.2486147e-02, 6.951211e-02),
	vec3(4.6948248e-01, -1.4474647e-01, 6.395707e-01),
	vec3(-1.6366549e-01, 2.7926615e-01, 4.1442272e-01),
	vec3(-3.2017022e-02, -1.490977e-01, 1.9204031e-01),
	vec3(4.9394023e-01, 3.50872e-01, 7.5056845e-01),
	vec3(-4.3051162e-01, 5.3653836e-02, 5.287603e-01),
	vec3(1.6742788e-01, -1.9670115e-01, 3.097655e-01),
	vec3(2.8909892e-03, 7.9275884e-02, 9.3611866e-02),
	vec3(-3.8568e-01, -3.913661e-01, 6.381001e-01),
	vec3(3.6921623e-01, 1.8878276e-02, 4.2254236e-01),
	vec3(-1.4382544e-01, 1.1883575e-01, 2.0987774e-01),
	vec3(1.7018769e-05, -1.21982164e-04, 1.3637765e-04),
	vec3(2.7587456e-01, 4.0065524e-01, 5.3021336e-01),
	vec3(-2.9163507e-01, -6.710455e-02, 3.2109192e-01),
	vec3(9.468618e-02, -5.3645402e-02, 1.14950426e-01),
	vec3(-1.8772706e-01, 5.786714e-01, 6.32607e-01),
	vec3(-1.731293e-01, -3.7957048e-01, 4.2708522e-01),
	vec3(2.0515613e-01, 8.7037705e-02, 2.2460349e-01),
	vec3(-2.3937436e-02, 8.478149e-03, 2.5196858e-02),
	vec3(2.5364196e-01, -4.7693747e-01, 5.2767277e-01),
	vec3(8.556377e-02, 3.3114684e-01, 3.2891324e-01),
	vec3(-1.18053906e-01, -7.672426e-02, 1.3329509e-01),
	vec3(6.589764e-01, -1.0994433e-01, 6.226514e-01),
	vec3(-2.8722435e-01, 3.6715835e-01, 4.2767954e-01),
	vec3(-2.0298287e-02, -2.6044106e-01, 2.3591952e-01),
	vec3(3.8975403e-02, 3.641038e-02, 4.741294e-02),
	vec3(-5.9507763e-01, -5.8061145e-03, 5.206811e-01),
	vec3(2.8755826e-01, -2.5831243e-01, 3.3285248e-01),
	vec3(-1.7006196e-02, 1.7423981e-01, 1.4835595e-01),
	vec3(-4.3772075e-01, -5.826144e-01, 6.076722e-01),
	vec3(5.077854e-01, 9.493834e-02, 4.238518e-01),
	vec3(-2.5603208e-01, 1.5937938e-01, 2.43448e-01),
	vec3(2.253204e-02, -8.0670275e-02, 6.651101e-02),
	vec3(2.9449984e-01, 5.808265e-01, 5.0864655e-01),
	vec3(-4.0502813e-01, -1.524105e-01, 3.3242282e-01),
	vec3(1.9628336e-01, -7.879047e-02, 1.597614e-01),
	vec3(-3.419462e-01, 7.125268e-01, 5.869312e-01),
	vec3(-1.6482706e-01, -5.440256e-01, 4.1497946e-01),
	vec3(2.9578826e-01, 1.7529248e-01, 2.4669386e-01),
	vec3(-1.14021435e-01, 2.3903523e-02, 8.2136765e-02),
	vec3(4.1314033e-01, -5.7562995e-01, 4.907755e-01),
	vec3(5.7109687e-02, 4.771986e-01, 3.269721e-01),
	vec3(-1.8957834e-01, -1.6296661e-01, 1.670168e-01),
	vec3(1.6735386e-02, -5.2856194e-04, 1.0981738e-02),
	vec3(-4.4495133e-01, 4.3422857e-01, 4.002086e-01),
	vec3(2.1696039e-02, -3.872703e-01, 2.4497996e-01),
	vec3(9.588366e-02, 1.1720657e-01, 9.381133e-02),
	vec3(-7.591891e-01, -1.0969917e-01, 4.659516e-01),
	vec3(4.380191e-01, -2.9846242e-01, 3.1558305e-01),
	vec3(-6.6506855e-02, 2.827191e-01, 1.6943024e-01),
	vec3(-2.3598054e-02, -4.2129334e-02, 2.7588781e-02),
	vec3(6.423448e-01, 2.1185222e-01, 3.7830105e-01),
	vec3(-3.9543003e-01, 1.7803794e-01, 2.373252e-01),
	vec3(7.443951e-02, -1.7310734e-01, 1.008487e-01),
	vec3(2.7223024e-01, 7.807035e-01, 4.325005e-01),
	vec3(-5.1164323e-01, -2.7530918e-01, 2.968755e-01),
	vec3(3.225623e-01, -8.166913e-02, 1.65964e-01),
	vec3(-4.5026146e-02, 6.854654e-02, 3.990164e-02),
	vec3(-1.1700212e-01, -7.2298944e-01, 3.4731337e-01),
	vec3(3.7749028e-01, 2.9828677e-01, 2.2218567e-01),
	vec3(-2.2680937e-01, 1.6564347e-02, 1.0217873e-01),
	vec3(6.091687e-01, -6.457393e-01, 3.8766265e-01),
	vec3(-9.270565e-03, 6.3341117e-01, 2.6855588e-01),
	vec3(-2.5045308e-01, -2.8155994e-01, 1.5489137e-01),
	vec3(1.1719341e-01, 1.2015768e-02, 4.6882622e-02),
	vec3(-6.3370705e-01, 4.7128808e-01, 3.0380255e-01),
	vec3(9.9979624e-02, -5.206758e-01, 1.9679742e-01),
	vec3(1.4066623e-01, 2.2844717e-01, 9.589086e-02),
	vec3(-3.8877612e-03, -1.106365e-03, 1.3879482e-03),
	vec3(6.146051e-01, -3.0786705e-01, 2.2613868e-01),
	vec3(-1.5077768e-01, 3.9483467e-01, 1.327887e-01),
	vec3(-5.7251982e-02, -1.4466392e-01, 4.6508487e-02),
	vec3(7.630817e-01, 3.7079856e-01, 2.4021722e-01),
	vec3(-5.566838e-01, 1.657016e-01, 1.5490603e-01),
	vec3(1.5983965e-01, -2.667377e-01, 7.7579185e-02),
	vec3(7.78335e-03, 3.8050517e-02, 8.983178e-03),
	vec3(-6.012936e-01, -4.360196e-01, 1.5738083e-01),
	vec3(4.6705157e-01, -5.35856e-02, 8.97382e-02),
	vec3(-1.2799856e-01, 1.4743903e-01, 3.2736827e-02),
	vec3(-2.4245014e-02, -9.0801746e-01, 1.2820269e-01),
	vec3(4.3987197e-01, 4.5515516e-01, 6.892628e-02),
	vec3(-3.5473e-01, -2.160943e-02, 2.2255234e-02));
vec3 nookRay(int i)
{
	return nook_rays[i];
}

// Side of the table in texels. A texel is 2 degrees wide.
int nookHalfSpaces()
{
	return 64;
}

// Normal of a texel of the table: a hemisphere as a square, the folded octahedron turned by 45 degrees. Not of unit length.
vec3 nookHalfSpaceNormal(ivec2 texel)
{
	float side = float(nookHalfSpaces());
	float u = (2.0f * float(texel.x) + 1.0f) / side - 1.0f;
	float v = (2.0f * float(texel.y) + 1.0f) / side - 1.0f;
	float x = 0.5f * (u + v);
	float y = 0.5f * (u - v);
	return vec3(x, y, 1.0f - abs(x) - abs(y));
}

// Bits of the rays from 32 * word to 32 * word + 31 that reach farther than `least` along the direction `toward`, in shares of the
// reach.
uint nookMaskWord(int word, vec3 toward, float least)
{
	uint bits = 0u;
	for (int i = 0; i < 32; ++i)
	{
		bits = bits | (uint(dot(nookRay(32 * word + i), toward) > least) << uint(i));
	}
	return bits;
}

// nookMaskWord for the rays among `asked`, of 128 * four to 128 * four + 127.
uvec4 nookMaskWords(int four, vec3 toward, float least, uvec4 asked)
{
	uvec4 bits = uvec4(0u, 0u, 0u, 0u);
	if (asked.x != 0u)
	{
		bits.x = nookMaskWord(4 * four, toward, least);
	}
	if (asked.y != 0u)
	{
		bits.y = nookMaskWord(4 * four + 1, toward, least);
	}
	if (asked.z != 0u)
	{
		bits.z = nookMaskWord(4 * four + 2, toward, least);
	}
	if (asked.w != 0u)
	{
		bits.w = nookMaskWord(4 * four + 3, toward, least);
	}
	return bits & asked;
}

// A texel of the table of half spaces.
uvec4 nookHalfSpaceTexel(ivec2 texel, int four)
{
	return nookMaskWords(four, nookHalfSpaceNormal(texel), 0.0f, uvec4(4294967295u, 4294967295u, 4294967295u, 4294967295u));
}
#endif

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

// A vector times this has unit length, if it is longer than 1e-15.
float nookUnit(vec3 a)
{
	return 1.0f / sqrt(max(dot(a, a), 1e-30f));
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

uniform usampler2D nook_half_spaces; // the picture of the stage NOOK_HALF_SPACES

uvec4 nookHalfSpace(ivec2 texel, int four)
{
	return texelFetch(nook_half_spaces, ivec2(texel.x, texel.y + four * nookHalfSpaces()), 0);
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

// Bits of the rays on the inner side of a plane through the receiver, whose normal points inward; all where it is 0. For the
// opposite normal they are exactly the others.
uvec4 nookInsideEdge(int four, vec3 inward)
{
	float size = abs(inward.x) + abs(inward.y) + abs(inward.z);
	bool upper = inward.z > 0.0f || (inward.z == 0.0f && (inward.y > 0.0f || (inward.y == 0.0f && inward.x >= 0.0f)));
	vec3 n = upper ? inward : -inward;
	int side = nookHalfSpaces();
	float half_side = 0.5f * float(side);
	float scale = half_side / max(size, 1e-37f);
	ivec2 texel = ivec2(int(half_side + scale * (n.x + n.y)), int(half_side + scale * (n.x - n.y)));
	uvec4 bits = nookHalfSpace(ivec2(clamp(texel.x, 0, side - 1), clamp(texel.y, 0, side - 1)), four);
	uint other = upper ? 0u : 4294967295u;
	uint all = size > 0.0f ? 0u : 4294967295u;
	return (bits ^ uvec4(other, other, other, other)) | uvec4(all, all, all, all);
}

// Bits of the share `alpha` of the rays from 32 * word to 32 * word + 31. shift: nookShift of the polygon.
uint nookMaskShare(int word, float alpha, float shift)
{
	uint bits = 0u;
	for (int i = 0; i < 32; ++i)
	{
		float share = float(32 * word + i) * 0.754877666f + shift;
		if (share - floor(share) < alpha)
		{
			bits = bits | (1u << uint(i));
		}
	}
	return bits;
}

// Bits of the rays among `asked`, of 128 * four to 128 * four + 127, that one polygon covers. height: nookHeight(front). polygon: a
// number that no other has, the index of its first corner.
uvec4 nookMaskBits(int count, int four, vec3 n, vec3 front, float height, float alpha, int polygon, float reach, uvec4 asked)
{
	vec3 x = nookTangent(n, 0);
	vec3 y = nookTangent(n, 1);
	float side = height < 0.0f ? -1.0f : 1.0f;
	uvec4 bits = asked;
	vec3 a = nookCorner(count - 1);
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nookCorner(i);
		bits = bits & nookInsideEdge(four, nookInward(a, b, n, x, y) * side);
		if ((bits.x | bits.y | bits.z | bits.w) == 0u)
		{
			return bits;
		}
		a = b;
	}
	vec3 down = vec3(dot(front, x), dot(front, y), dot(front, n)) * -side;
	bits = nookMaskWords(four, down, abs(height) / reach, bits);
	if (alpha < 1.0f)
	{
		float shift = nookShift(polygon);
		bits = bits & uvec4(nookMaskShare(4 * four, alpha, shift), nookMaskShare(4 * four + 1, alpha, shift),
							nookMaskShare(4 * four + 2, alpha, shift), nookMaskShare(4 * four + 3, alpha, shift));
	}
	return bits;
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

vec3 nook_normal;

// Fragment stage with masks: from a pixel that a volume covers to the directions that the polygon covers there, as bits.

// Height of the surface that a pixel shows above the polygon where it is within the volume, else 0. Sets nook_normal.
float nookMaskHeight(ivec2 pixel)
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
	nook_normal = nookTurned(nookNormal(pixel));
	if (dot(nook_normal, nook_normal) < 0.25)
	{
		return 0.0;
	}
	height = nookLifted(height, nook_normal);
	bool within = nookReaches(height, float(nook_polygon.z), nook.radius * nookShare().x, nook_bias) &&
		nookFalloff(nook_polygon.y, nook_front.xyz, abs(height), nook.radius, nookShare().y) > 0.0;
	return within ? height : 0.0;
}

// nookMaskBits for this polygon. height: not 0.
uvec4 nookCovered(int four, vec3 normal, float height)
{
	return nookMaskBits(nook_polygon.y, four, normal, nook_front.xyz, height, nook_front.w, nook_polygon.x, nook.radius,
		uvec4(0xffffffffu, 0xffffffffu, 0xffffffffu, 0xffffffffu));
}

float nook_height;

// Directions 0 to 127; nookMoreBits: the others.
uvec4 nookBits(ivec2 pixel)
{
	nook_height = nookMaskHeight(pixel);
	return nook_height != 0.0 ? nookCovered(0, nook_normal, nook_height) : uvec4(0u, 0u, 0u, 0u);
}
uvec4 nookMoreBits()
{
	return nook_height != 0.0 ? nookCovered(1, nook_normal, nook_height) : uvec4(0u, 0u, 0u, 0u);
}

layout(location = 0) out uvec4 nook_bits;

void main()
{
	nook_bits = nookBits(ivec2(gl_FragCoord.xy) * nook.cell);
}
#endif // NOOK_FRAGMENT

#ifdef NOOK_RESOLVE

// Counts covered directions (GLSL has bitCount only since 4.00).

uint nookBitsOf(uvec4 words)
{
	uvec4 n = words - ((words >> 1) & uvec4(0x55555555u, 0x55555555u, 0x55555555u, 0x55555555u));
	n = (n & uvec4(0x33333333u, 0x33333333u, 0x33333333u, 0x33333333u)) + ((n >> 2) & uvec4(0x33333333u, 0x33333333u, 0x33333333u, 0x33333333u));
	n = (((n + (n >> 4)) & uvec4(0x0f0f0f0fu, 0x0f0f0f0fu, 0x0f0f0f0fu, 0x0f0f0f0fu)) * 0x01010101u) >> 24;
	return n.x + n.y + n.z + n.w;
}

uniform usampler2D nook_sums; // the pictures of the fragment stage

float nookResolved(ivec2 cell)
{
	uint covered = nookBitsOf(texelFetch(nook_sums, cell, 0));
	return 1.0 - float(covered) / 128.0;
}

layout(location = 0) out float nook_visibility;

void main()
{
	nook_visibility = nookResolved(ivec2(gl_FragCoord.xy));
}
#endif // NOOK_RESOLVE

#ifdef NOOK_HALF_SPACES

uvec4 nookHalfSpacesAt(ivec2 texel)
{
	int four = texel.y / nookHalfSpaces();
	return nookHalfSpaceTexel(ivec2(texel.x, texel.y - four * nookHalfSpaces()), four);
}

layout(location = 0) out uvec4 nook_bits;

void main()
{
	nook_bits = nookHalfSpacesAt(ivec2(gl_FragCoord.xy));
}
#endif // NOOK_HALF_SPACES

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
