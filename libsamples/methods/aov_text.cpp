// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/aov_text.h"

#include "core/decimal.h"
#include "methods/assets.h"
#include "methods/kernel_text.h"

#include <array>
#include <string_view>
#include <vector>

namespace nook
{
namespace
{

constexpr const char* kBlock = R"(#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// The uniform block, nook_volumes::Block of nook_volumes_draw.h, which Frame::set fills.
NOOK_AT_BLOCKuniform NookVolumes
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
)";

constexpr const char* kBuffers330 = R"(
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
)";

constexpr const char* kBuffersEs300 = R"(
// Textures of any width, filled row by row: corners (RGBA16UI) and polygons (RG32UI) of the file, and the clusters of this frame
// (RGBA32UI).
uniform highp usampler2D nook_corners;
uniform highp usampler2D nook_polygons;
uniform highp usampler2D nook_clusters;

ivec2 nookTexel(int i, ivec2 size)
{
	return ivec2(i % size.x, i / size.x);
}
uvec4 nookPackedCorner(int i)
{
	return texelFetch(nook_corners, nookTexel(i, textureSize(nook_corners, 0)), 0);
}
uvec2 nookPackedPolygon(int i)
{
	return texelFetch(nook_polygons, nookTexel(i, textureSize(nook_polygons, 0)), 0).xy;
}
uvec4 nookSeenCluster(int i, int texel)
{
	return texelFetch(nook_clusters, nookTexel(4 * i + texel, textureSize(nook_clusters, 0)), 0);
}
)";

constexpr const char* kStorage = R"(
// Storage buffers: corners and polygons of the file, and the clusters of this frame.
NOOK_AT_CORNERSreadonly buffer NookCorners
{
	uvec2 nook_corners[];
};
NOOK_AT_POLYGONSreadonly buffer NookPolygons
{
	uvec2 nook_polygons[];
};
NOOK_AT_CLUSTERSreadonly buffer NookClusters
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
// The polygon of a volume, from the vertex stage to the fragment stage.
NOOK_WAY0ivec4 nook_polygon; // first corner, number of corners, 1 where it occludes on both sides, extent (nookShare)
NOOK_WAY1vec4 nook_front;    // unit normal of its front, alpha
NOOK_WAY2vec3 nook_offset;   // a corner relative to the eye is nook_offset + nook_step * (stored integers)
NOOK_WAY3vec3 nook_step;

// Extent of the volume as shares of nook.radius: along the normal of its polygon (x) and beyond the edges (y).
vec2 nookShare()
{
	float height = float(nook_polygon.w & 255) / 128.0;
	return vec2(height, height * float(nook_polygon.w >> 8) / 8.0);
}
)";

std::string replaced(std::string text, std::string_view what, std::string_view by)
{
	for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
	{
		text.replace(at, what.size(), by);
	}
	return text;
}

// way: in or out.
std::string betweenText(GlslTarget target, const std::string& way)
{
	std::string text = kBetween;
	for (int i = 0; i < 4; ++i)
	{
		const std::string number = std::to_string(i);
		text = replaced(text, "NOOK_WAY" + number,
						(target == GlslTarget::vulkan ? "layout(location = " + number + ") " : "") + "flat " + way + " ");
	}
	return text;
}

std::string facesText(GlslTarget target)
{
	const bool vulkan = target == GlslTarget::vulkan;
	return std::string("\n// 1: keeps volumes that are drawn by their front faces, 2: by their back faces, 0: keeps all.\n") +
		   (vulkan ? "layout(push_constant) uniform NookFaces\n{\n\tint nook_faces;\n};\n"
				   : "NOOK_AT_FACESuniform int nook_faces;\n");
}

constexpr const char* kVertexMain = R"(
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
)";

constexpr const char* kDepthInput = R"(
#ifndef NOOK_DEPTH // NOOK_MEANS
NOOK_AT_DEPTHSuniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
#ifndef NOOK_NORMAL // unit normal in view space: x to the right, y up, z toward the camera
NOOK_AT_NORMALSuniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) texelFetch(nook_normals, pixel, 0).xyz
#endif
)";
constexpr const char* kInputs = R"(
float nookDepth(ivec2 pixel)
{
	return NOOK_DEPTH_HERE;
}
vec3 nookNormal(ivec2 pixel)
{
	return NOOK_NORMAL(pixel);
}
)";

// nookLinear of depth.glsl for a z that may depend on x and y.
constexpr const char* kLeaning = R"(
// Linear depth from the value of the depth buffer in a pixel, 0 to 1. With an oblique near plane, surfaces of equal value are not
// perpendicular to the view direction: nook.slope is what NDC x and y add to both parts of the fraction; 0 for all other cameras.
float nookLeaning(ivec2 pixel, float device)
{
	float x = (float(pixel.x) + 0.5 - nook.origin.x) * nook.pixel_size.x * 2.0 - 1.0;
	float y = 1.0 - (float(pixel.y) + 0.5 - nook.origin.y) * nook.pixel_size.y * 2.0;
	float t = abs(device - nook.far_end);
	float above = nook.depth.x + nook.slope.x * x + nook.slope.y * y + nook.depth.y * t;
	float below = nook.depth.z + nook.slope.z * x + nook.slope.w * y + nook.depth.w * t;
	return t > 0.0 && below > 0.0 ? above / below : NOOK_SKY;
}
)";

constexpr const char* kReceiver = R"(
vec3 nook_base;  // nook_offset relative to the receiver, which is the surface that the pixel shows
float nook_bias; // metres: a receiver closer to the plane of a polygon is not occluded by it
vec3 nookCorner(int i);
)";

constexpr const char* kFragmentMain = R"(
layout(location = 0) out float nook_occlusion;

void main()
{
	nook_occlusion = nookOcclusion(ivec2(gl_FragCoord.xy) * nook.cell);
}
)";

constexpr const char* kResolveMain = R"(
NOOK_AT_SUMSuniform sampler2D nook_sums; // the picture of the fragment stage
layout(location = 0) out float nook_visibility;

void main()
{
	nook_visibility = 1.0 - nookCompensated(texelFetch(nook_sums, ivec2(gl_FragCoord.xy), 0).r);
}
)";

constexpr const char* kSparseInput = R"(
NOOK_AT_CELLSuniform sampler2D nook_cells; // the picture of the resolve stage

float nookVisibility(ivec2 cell)
{
	return texelFetch(nook_cells, cell, 0).r;
}
)";

constexpr const char* kSparseMain = R"(
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
)";

const KernelText& volumeKernels()
{
	static const KernelText text =
		parseKernels({assets::camera_glsl, assets::depth_glsl, assets::form_factor_glsl, assets::volume_glsl, assets::mask_glsl});
	return text;
}

const KernelText& sparseKernels()
{
	static const KernelText text =
		parseKernels({assets::camera_glsl, assets::depth_glsl, assets::reconstruct_glsl, assets::aov_sparse_glsl});
	return text;
}

// Without the licence line, since the file already has one.
std::string stageText(std::string_view text)
{
	return "\n" + std::string(text.substr(text.find('\n') + 1));
}

bool hasFma(GlslTarget target)
{
	return target == GlslTarget::gl430 || target == GlslTarget::vulkan;
}

// One stage's functions, each once.
class Functions
{
public:
	// has_fma: is fma() part of the language, and does it round once?
	explicit Functions(const KernelText& kernels, bool has_fma = false) : m_writer(kernels), m_has_fma(has_fma) {}

	std::string of(const char* entry)
	{
		return m_writer.add(entry, {{"NOOK_CELL", "nook.cell"}, {"NOOK_NATIVE_FMA", m_has_fma ? "1" : "0"}});
	}

private:
	FunctionWriter m_writer;
	bool m_has_fma;
};

std::string inputs(const AovTextSettings& settings)
{
	const char* const means =
		settings.device_depth ? "the depth buffer as it is, 0 to 1, of any projection; a pixel at the far plane is sky"
							  : "linear depth: distance along the view direction, > 0, metres; NOOK_SKY or more without a surface";
	const char* const here = settings.device_depth ? "nookLeaning(pixel, NOOK_DEPTH(pixel))" : "NOOK_DEPTH(pixel)";
	return replaced(kDepthInput, "NOOK_MEANS", means) + (settings.device_depth ? kLeaning : "") +
		   replaced(kInputs, "NOOK_DEPTH_HERE", here);
}

// Shortest decimal that reads back as the same number.
std::string numberOf(float value)
{
	return shortestScientific(value);
}

// The constants of "nook_rays".
std::string raysText(int count)
{
	const std::vector<glm::vec3>& rays = maskTablesOf(count).rays;
	const std::string size = "[" + std::to_string(rays.size()) + "]";
	std::string text = "\nconst vec3 nook_rays" + size + " = vec3" + size + "(";
	for (std::size_t i = 0; i < rays.size(); ++i)
	{
		const glm::vec3& ray = rays[i];
		text += (i == 0 ? "\n\tvec3(" : ",\n\tvec3(") + numberOf(ray.x) + ", " + numberOf(ray.y) + ", " + numberOf(ray.z) + ")";
	}
	return text + ");\nvec3 nookRay(int i)\n{\n\treturn nook_rays[i];\n}\n";
}

constexpr const char* kHalfSpaces = R"(
NOOK_AT_HALF_SPACESuniform usampler2D nook_half_spaces; // the picture of the stage NOOK_HALF_SPACES

uvec4 nookHalfSpace(ivec2 texel, int four)
{
	return texelFetch(nook_half_spaces, ivec2(texel.x, texel.y + four * nookHalfSpaces()), 0);
}
)";

constexpr const char* kHalfSpacesMain = R"(
layout(location = 0) out uvec4 nook_bits;

void main()
{
	ivec2 texel = ivec2(gl_FragCoord.xy);
	int four = texel.y / nookHalfSpaces();
	nook_bits = nookHalfSpaceTexel(ivec2(texel.x, texel.y - four * nookHalfSpaces()), four);
}
)";

// 128 directions per target.
std::string maskMain(int directions)
{
	std::string outputs;
	std::string sets;
	for (int target = 0; 128 * target < directions; ++target)
	{
		const std::string number = std::to_string(target);
		outputs += "layout(location = " + number + ") out uvec4 nook_bits_" + number + ";\n";
		sets += "\tnook_bits_" + number + " = height != 0.0 ? nookCovered(" + number + ", normal, height) : uvec4(0u);\n";
	}
	return "\n" + outputs +
		   "\nvoid main()\n{\n\tvec3 normal = nookReceive(ivec2(gl_FragCoord.xy) * nook.cell);\n"
		   "\tfloat height = nookMaskHeight(normal);\n" +
		   sets + "}\n";
}

std::string maskResolveMain(int directions)
{
	const bool two = directions > 128;
	std::string text = "\nNOOK_AT_SUMSuniform usampler2D nook_sums; // the pictures of the fragment stage\n";
	text += two ? "NOOK_AT_MORE_SUMSuniform usampler2D nook_more_sums;\n" : "";
	text += "layout(location = 0) out float nook_visibility;\n\nvoid main()\n{\n\tivec2 cell = ivec2(gl_FragCoord.xy);\n";
	// Channels that the texture lacks read as 1.
	const char* const there = directions == 32 ? " * uvec4(1u, 0u, 0u, 0u)" : directions == 64 ? " * uvec4(1u, 1u, 0u, 0u)" : "";
	text += std::string("\tuint covered = nookBitsOf(texelFetch(nook_sums, cell, 0)") + there + ");\n";
	text += two ? "\tcovered += nookBitsOf(texelFetch(nook_more_sums, cell, 0));\n" : "";
	return text + "\tnook_visibility = 1.0 - float(covered) / " + std::to_string(directions) + ".0;\n}\n";
}

std::string fragmentStage(const AovTextSettings& settings, const std::string& buffers)
{
	Functions functions(volumeKernels(), hasFma(settings.target));
	std::string text = buffers + betweenText(settings.target, "in") + inputs(settings) + kReceiver;
	text += functions.of("nookPosition") + functions.of("nookDepthError") + functions.of("nookHeight") + functions.of("nookLift");
	if (settings.directions == 0)
	{
		return text + functions.of("nookVolume") + stageText(assets::aov_fragment_glsl) + kFragmentMain;
	}
	text += functions.of("nookReaches") + functions.of("nookFalloff");
	functions.of("nookHalfSpaceTexel"); // in masksText
	text += kHalfSpaces + functions.of("nookMaskBits");
	std::string receiver = stageText(assets::aov_fragment_glsl);
	receiver.resize(receiver.find("\n// AOV eqs. 4 and 5."));
	return text + receiver + stageText(assets::aov_mask_fragment_glsl) + maskMain(settings.directions);
}

// The part that the fragment stage of masks and the stage NOOK_HALF_SPACES share.
std::string masksText(int directions)
{
	Functions functions(volumeKernels());
	return "\n#if defined(NOOK_FRAGMENT) || defined(NOOK_HALF_SPACES)\n" + raysText(directions) +
		   functions.of("nookHalfSpaceTexel") + "#endif\n";
}

std::string sparseStage(const AovTextSettings& settings)
{
	Functions functions(sparseKernels());
	return inputs(settings) + kSparseInput + functions.of("nookSparse") + kSparseMain;
}

std::string stage(const char* name, const std::string& text)
{
	return std::string("\n#ifdef ") + name + "\n" + text + "#endif // " + name + "\n";
}

// Where resources are, on targets with explicit numbers; those of samplers match the modules of screen-space methods. OpenGL
// counts each kind on its own, Vulkan all of them.
struct Place
{
	const char* word; // before the declaration
	const char* macro;
	int number;
	const char* kind; // of OpenGL's
	int vulkan;
	const char* vulkan_kind;
};
constexpr std::array kPlaces{
	Place{"NOOK_AT_BLOCK", "NOOK_BLOCK_BINDING", 0, "std140, binding", 0, "std140, binding"},
	Place{"NOOK_AT_FACES", "NOOK_FACES_LOCATION", 0, "location", 16, "binding"},
	Place{"NOOK_AT_DEPTHS", "NOOK_DEPTHS_BINDING", 1, "binding", 1, "binding"},
	Place{"NOOK_AT_NORMALS", "NOOK_NORMALS_BINDING", 2, "binding", 2, "binding"},
	Place{"NOOK_AT_CORNERS", "NOOK_CORNERS_BINDING", 0, "std430, binding", 3, "std430, binding"},
	Place{"NOOK_AT_POLYGONS", "NOOK_POLYGONS_BINDING", 1, "std430, binding", 4, "std430, binding"},
	Place{"NOOK_AT_CLUSTERS", "NOOK_CLUSTERS_BINDING", 2, "std430, binding", 5, "std430, binding"},
	Place{"NOOK_AT_HALF_SPACES", "NOOK_HALF_SPACES_BINDING", 10, "binding", 10, "binding"},
	Place{"NOOK_AT_CELLS", "NOOK_CELLS_BINDING", 6, "binding", 6, "binding"},
	Place{"NOOK_AT_SUMS", "NOOK_SUMS_BINDING", 13, "binding", 13, "binding"},
	Place{"NOOK_AT_MORE_SUMS", "NOOK_MORE_SUMS_BINDING", 14, "binding", 14, "binding"},
};

std::string withPlaces(std::string text, GlslTarget target)
{
	const bool vulkan = target == GlslTarget::vulkan;
	for (const Place& place : kPlaces)
	{
		const std::string macro = place.macro;
		const std::string number = std::to_string(vulkan ? place.vulkan : place.number);
		const bool block = std::string_view("std140, binding") == place.kind;
		text =
			replaced(text, place.word,
					 !vulkan && target != GlslTarget::gl430 ? (block ? "layout(std140) " : "")
															: "#ifndef " + macro + "\n#define " + macro + " " + number +
																  "\n#endif\nlayout(" + (vulkan ? "set = NOOK_SET, " : "") +
																  (vulkan ? place.vulkan_kind : place.kind) + " = " + macro + ") ");
	}
	return vulkan ? replaced(text, "gl_VertexID", "gl_VertexIndex") : text;
}

} // namespace

std::string aovText(const AovTextSettings& settings)
{
	const GlslTarget target = settings.target;
	const std::string buffers = target == GlslTarget::gl330 ? kBuffers330 : target == GlslTarget::es300 ? kBuffersEs300 : kStorage;
	std::string text = kBlock;
	Functions of_vertex(volumeKernels(), hasFma(target));
	text += stage("NOOK_VERTEX", buffers + betweenText(target, "out") + of_vertex.of("nookCross") + "\n#ifdef NOOK_CHOOSE_FACES\n" +
									 facesText(target) + inputs(settings) + stageText(assets::aov_faces_glsl) +
									 "#endif // NOOK_CHOOSE_FACES\n" + stageText(assets::aov_vertex_glsl) + kVertexMain);
	text += settings.directions > 0 ? masksText(settings.directions) : "";
	text += stage("NOOK_FRAGMENT", fragmentStage(settings, buffers));
	text += stage("NOOK_RESOLVE", settings.directions == 0
									  ? stageText(assets::aov_resolve_glsl) + kResolveMain
									  : stageText(assets::aov_mask_resolve_glsl) + maskResolveMain(settings.directions));
	text += settings.directions > 0 ? stage("NOOK_HALF_SPACES", kHalfSpacesMain) : "";
	return withPlaces(text + stage("NOOK_SPARSE", sparseStage(settings)), target);
}

} // namespace nook
