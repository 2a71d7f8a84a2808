// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/aov_text.h"

#include "shade/assets.h"
#include "shade/kernel_functions.h"
#include "volume/assets.h"

#include <string_view>

namespace nook
{
namespace
{

constexpr const char* kBlock = R"(#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// nook_volumes::Block of nook_volumes_draw.h.
layout(std140NOOK_AT_BLOCK) uniform NookVolumes
{
	vec4 size;     // width, height in pixels; 1/width, 1/height
	vec4 across_x; // of the projection: nookPosition
	vec4 across_y;
	vec4 w;
	vec4 origin;
	vec4 depth; // nookLinear
	vec4 error;
	mat4 clip;  // clip space from the eye's, along axes of the world
	vec4 right; // axes of view space in the world
	vec4 up;
	vec4 back;
	vec4 reach;    // how far a volume reaches, metres; as close to its plane a polygon takes nothing; 1 for exact bounds; last knot
	vec4 curve[9]; // occlusion at its knots
} nook;
)";

constexpr const char* kBuffers330 = R"(
// The file's arrays as buffer textures: corners RGBA16UI, polygons RG32UI; and of each frame the clusters, RGBA32UI.
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
)";

constexpr const char* kBuffers430 = R"(
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
)";

constexpr const char* kBetween = R"(
// Of the polygon, from stage to stage.
flat NOOK_WAY ivec4 nook_polygon; // first corner, corners, 1 where it darkens both sides, 0
flat NOOK_WAY vec4 nook_front;    // unit normal of its front, alpha
flat NOOK_WAY vec3 nook_offset;   // of its cluster, from the eye
flat NOOK_WAY vec3 nook_step;
)";

constexpr const char* kVertexMain = R"(
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
)";

constexpr const char* kInputs = R"(
#ifndef NOOK_DEPTH // depth along the view direction, > 0, metres; NOOK_SKY or more where there is no surface
uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) NOOK_DEPTH_OF(texelFetch(nook_depths, pixel, 0).r)
#endif
#ifndef NOOK_NORMAL // unit normal in view space: x right, y up, z toward the camera
uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) texelFetch(nook_normals, pixel, 0).xyz
#endif
)";

constexpr const char* kFragmentMain = R"(
layout(location = 0) out float nook_occlusion;

void main()
{
	nook_occlusion = nookOcclusion(ivec2(gl_FragCoord.xy));
}
)";

constexpr const char* kResolveMain = R"(
uniform sampler2D nook_sums;
layout(location = 0) out float nook_visibility;

void main()
{
	nook_visibility = 1.0 - nookCompensated(texelFetch(nook_sums, ivec2(gl_FragCoord.xy), 0).r);
}
)";

const KernelText& kernels()
{
	static const KernelText text =
		parseKernels({assets::camera_glsl, assets::depth_glsl, assets::form_factor_glsl, assets::volume_glsl});
	return text;
}

// Without the licence line, which the whole file has.
std::string stageText(std::string_view text)
{
	return "\n" + std::string(text.substr(text.find('\n') + 1));
}

std::string replaced(std::string text, std::string_view what, std::string_view by)
{
	for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
	{
		text.replace(at, what.size(), by);
	}
	return text;
}

std::string functionsOf(const std::vector<std::string>& entries)
{
	FunctionWriter writer(kernels());
	std::string text;
	for (const std::string& entry : entries)
	{
		text += writer.add(entry, 1, {});
	}
	return text;
}

} // namespace

std::string aovText(const AovTextSettings& settings)
{
	const std::string buffers = settings.storage_buffers ? kBuffers430 : kBuffers330;
	std::string text = replaced(kBlock, "NOOK_AT_BLOCK", settings.storage_buffers ? ", binding = NOOK_BLOCK_BINDING" : "");
	text = (settings.storage_buffers ? "#ifndef NOOK_BLOCK_BINDING\n#define NOOK_BLOCK_BINDING 0\n#endif\n" : "") + text;
	text += "\n#ifdef NOOK_VERTEX\n" + buffers + replaced(kBetween, "NOOK_WAY", "out") + functionsOf({"nookCross"}) +
			stageText(assets::aov_vertex_glsl) + kVertexMain + "#endif // NOOK_VERTEX\n";
	text += "\n#ifdef NOOK_FRAGMENT\n" + buffers + replaced(kBetween, "NOOK_WAY", "in");
	text += replaced(kInputs, "NOOK_DEPTH_OF", settings.device_depth ? "nookLinear" : "");
	text += "\nvec3 nook_base; // the cluster's offset from the receiver\nvec3 nookCorner(int i);\n";
	text += functionsOf(settings.device_depth ? std::vector<std::string>{"nookLinear", "nookPosition", "nookVolume"}
											  : std::vector<std::string>{"nookPosition", "nookVolume"});
	text += stageText(assets::aov_fragment_glsl) + kFragmentMain + "#endif // NOOK_FRAGMENT\n";
	text += "\n#ifdef NOOK_RESOLVE\n" + stageText(assets::aov_resolve_glsl) + kResolveMain + "#endif // NOOK_RESOLVE\n";
	return text;
}

} // namespace nook
