// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/aov_text.h"

#include "core/decimal.h"
#include "methods/assets.h"
#include "methods/kernel_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>
#include <string_view>

namespace nook
{
namespace
{

constexpr const char* kBlockMembers = R"(	vec2 size; // width, height in pixels
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
)";

bool hasNumbers(GlslTarget target) // of resources
{
	return target != GlslTarget::gl330 && target != GlslTarget::es300;
}

std::string definition(const std::string& macro, int number)
{
	return "#ifndef " + macro + "\n#define " + macro + " " + std::to_string(number) + "\n#endif\n";
}

std::string blockText(GlslTarget target)
{
	const std::string head = "\n// The uniform block, nook_volumes::Block of nook_volumes_draw.h, which Frame::set fills.\n";
	const std::string macro = "NOOK_BLOCK_BINDING";
	const std::string text =
		"#ifndef NOOK_SKY\n#define NOOK_SKY 1e30\n#endif\n" + (hasNumbers(target) ? definition(macro, 0) : "") + head;
	if (target == GlslTarget::hlsl60)
	{
		return text + "struct NookVolumesMembers\n{\n" + kBlockMembers + "};\nNOOK_AT(" + macro +
			   ") cbuffer NookVolumes NOOK_REGISTER(b, " + macro + ")\n{\n\tNookVolumesMembers nook;\n};\n";
	}
	const std::string set = target == GlslTarget::gl430 || !hasNumbers(target) ? "" : "set = NOOK_SET, ";
	return text + "layout(" + set + "std140" + (hasNumbers(target) ? ", binding = " + macro : "") + ") uniform NookVolumes\n{\n" +
		   kBlockMembers + "} nook;\n";
}

// Resources of the stages, whose text asks for them with "NOOK_NEEDS nook_depths;". Numbers of textures match the modules of
// screen-space methods.
struct Resource
{
	const char* type; // in GLSL; uvec2, uvec4: elements of a storage buffer
	const char* name;
	int number; // in OpenGL 4.3, which counts each kind on its own
	int vulkan; // in Vulkan, HLSL and WGSL
};
constexpr std::array kResources{
	Resource{"int", "nook_faces", 0, 16},        Resource{"sampler2D", "nook_depths", 1, 1},
	Resource{"sampler2D", "nook_normals", 2, 2}, Resource{"uvec2", "nook_corners", 0, 3},
	Resource{"uvec2", "nook_polygons", 1, 4},    Resource{"uvec4", "nook_clusters", 2, 5},
	Resource{"sampler2D", "nook_cells", 6, 6},   Resource{"usampler2D", "nook_half_spaces", 10, 10},
	Resource{"sampler2D", "nook_sums", 13, 13},  Resource{"sampler2D", "nook_more_sums", 14, 14},
};

std::string declarationOf(const Resource& resource, const std::string& type, GlslTarget target)
{
	const std::string name = resource.name;
	const std::string declared = "uniform " + type + " " + name + ";";
	if (!hasNumbers(target))
	{
		return declared;
	}
	const bool number = type == "int";
	const bool buffer = type.starts_with("uvec");
	std::string macro = name + (number ? "_LOCATION" : "_BINDING");
	std::transform(macro.begin(), macro.end(), macro.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
	const std::string defined = definition(macro, target == GlslTarget::gl430 ? resource.number : resource.vulkan);
	if (target == GlslTarget::hlsl60)
	{
		const std::string kind = buffer ? "StructuredBuffer<" + type : type[0] == 'u' ? "Texture2D<uvec4" : "Texture2D<vec4";
		return number ? "#ifdef NOOK_VULKAN\n" + defined + "#endif\n" + definition(macro, 1) + "NOOK_AT(" + macro +
							") cbuffer NookFaces NOOK_REGISTER(b, " + macro + ")\n{\n\tint nook_faces;\n};"
					  : defined + "NOOK_AT(" + macro + ") " + kind + "> " + name + " NOOK_REGISTER(t, " + macro + ");";
	}
	if (number && target == GlslTarget::vulkan)
	{
		return "layout(push_constant) uniform NookFaces\n{\n\tint nook_faces;\n};";
	}
	const std::string layout = std::string("layout(") + (target == GlslTarget::gl430 ? "" : "set = NOOK_SET, ") +
							   (buffer ? "std430, " : "") + (number && target == GlslTarget::gl430 ? "location = " : "binding = ") +
							   macro + ") ";
	const std::string block = std::string("Nook") + static_cast<char>(std::toupper(name[5])) + name.substr(6);
	return defined + layout + (buffer ? "readonly buffer " + block + "\n{\n\t" + type + " " + name + "[];\n};" : declared);
}

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

// ES 3.00 has no buffer textures.
constexpr const char* kTexel = R"(
// Textures of any width, filled row by row, take the place of buffers.
ivec2 nookTexel(int i, ivec2 size)
{
	return ivec2(i % size.x, i / size.x);
}
)";

constexpr const char* kStorage = R"(
// Storage buffers: corners and polygons of the file, and the clusters of this frame.
NOOK_NEEDS nook_corners;
NOOK_NEEDS nook_polygons;
NOOK_NEEDS nook_clusters;

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

constexpr const char* kBetweenHlsl = R"(
struct NookBetween
{
	vec4 position : SV_Position;
	nointerpolation ivec4 polygon : NOOK_POLYGON; // first corner, number of corners, 1 where it occludes on both sides, extent (nookShare)
	nointerpolation vec4 front : NOOK_FRONT;      // unit normal of its front, alpha
	nointerpolation vec3 offset : NOOK_OFFSET;    // a corner relative to the eye is nook_offset + nook_step * (stored integers)
	nointerpolation vec3 step : NOOK_STEP;
};
static NookBetween nook_between;
#define nook_polygon nook_between.polygon
#define nook_front nook_between.front
#define nook_offset nook_between.offset
#define nook_step nook_between.step
)";

// way: in or out. WGSL has variables of the stage instead, which its entry points fill or pass on.
std::string betweenText(GlslTarget target, const std::string& way)
{
	std::string text = kBetween;
	if (target == GlslTarget::hlsl60)
	{
		return kBetweenHlsl + text.substr(text.find("\n// Extent"));
	}
	for (int i = 0; i < 4; ++i)
	{
		const std::string number = std::to_string(i);
		const std::string location = target == GlslTarget::vulkan ? "layout(location = " + number + ") " : "";
		text = replaced(text, "NOOK_WAY" + number, target == GlslTarget::wgsl ? "" : location + "flat " + way + " ");
	}
	return text;
}

constexpr const char* kFaces = R"(
// 1: keeps volumes that are drawn by their front faces, 2: by their back faces, 0: keeps all.
NOOK_NEEDS nook_faces;
)";

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

// Direct3D counts vertices from 0 in each draw call, whatever its first one is.
constexpr const char* kVertexHlsl = R"(
#ifdef NOOK_PRISMS
NookBetween main(int cluster : NOOK_CLUSTER, uvec4 corner : NOOK_POINT) // cluster: its number, the same for all its vertices
{
	nook_between.position = nookPrismVertex(cluster, corner);
#else
NookBetween main(int cluster : NOOK_CLUSTER, uint vertex : SV_VertexID)
{
	nook_between.position = nookPolygonVertex(cluster, int(vertex) + 12 * int(nookSeenCluster(cluster, 1).w));
#endif
#ifdef NOOK_ANY_DEPTH
	nook_between.position.z = 0.0; // neither the near nor the far plane cuts it
#endif
	return nook_between;
}
)";

constexpr const char* kDepthInput = R"(
#ifndef NOOK_DEPTH // NOOK_MEANS
NOOK_NEEDS nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
#ifndef NOOK_NORMAL // unit normal in view space: x to the right, y up, z toward the camera
NOOK_NEEDS nook_normals;
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
NOOK_STATICvec3 nook_base;  // nook_offset relative to the receiver, which is the surface that the pixel shows
NOOK_STATICfloat nook_bias; // metres: a receiver closer to the plane of a polygon is not occluded by it

// Corner i of the polygon relative to the receiver.
vec3 nookCorner(int i)
{
	return nook_base + nook_step * vec3(nookPackedCorner(nook_polygon.x + i).xyz);
}
)";

constexpr const char* kResolved = R"(
NOOK_NEEDS nook_sums; // the picture of the fragment stage

float nookResolved(ivec2 cell)
{
	return 1.0 - nookCompensated(texelFetch(nook_sums, cell, 0).r);
}
)";

constexpr const char* kSparseInput = R"(
NOOK_NEEDS nook_cells; // the picture of the resolve stage

float nookVisibility(ivec2 cell)
{
	return texelFetch(nook_cells, cell, 0).r;
}
)";

constexpr const char* kSparseMain = R"(
float nookKnown(ivec2 pixel)
{
	float visibility = nookSparse(pixel);
	if (visibility < 0.0)
	{
		discard; // left for a second drawing at every pixel
	}
	return visibility;
}
)";

const KernelText& volumeKernels()
{
	static const KernelText text =
		parseKernels({assets::camera_glsl, assets::depth_glsl, assets::form_factor_glsl, assets::volume_glsl, assets::mask_glsl,
					  assets::reconstruct_glsl, assets::aov_sparse_glsl});
	return text;
}

// Without the licence line, since the file already has one.
std::string stageText(std::string_view text)
{
	return "\n" + std::string(text.substr(text.find('\n') + 1));
}

// target: of functions with products that are rounded once.
std::string functionOf(FunctionWriter& writer, const char* entry, GlslTarget target = GlslTarget::gl330)
{
	const bool fma = target == GlslTarget::gl430 || target == GlslTarget::vulkan;
	return writer.add(entry, {{"NOOK_CELL", "nook.cell"}, {"NOOK_NATIVE_FMA", fma ? "1" : "0"}});
}

std::string inputs(const AovTextSettings& settings)
{
	const char* const means =
		settings.device_depth ? "the depth buffer as it is, 0 to 1, of any projection; a pixel at the far plane is sky"
							  : "linear depth: distance along the view direction, > 0, metres; NOOK_SKY or more without a surface";
	const char* const here = settings.device_depth ? "nookLeaning(pixel, NOOK_DEPTH(pixel))" : "NOOK_DEPTH(pixel)";
	return replaced(kDepthInput, "NOOK_MEANS", means) + (settings.device_depth ? kLeaning : "") +
		   replaced(kInputs, "NOOK_DEPTH_HERE", here);
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
		text += (i == 0 ? "\n\tvec3(" : ",\n\tvec3(") + shortestScientific(ray.x) + ", " + shortestScientific(ray.y) + ", " +
				shortestScientific(ray.z) + ")";
	}
	return text + ");\nvec3 nookRay(int i)\n{\n\treturn nook_rays[i];\n}\n";
}

constexpr const char* kHalfSpaces = R"(
NOOK_NEEDS nook_half_spaces; // the picture of the stage NOOK_HALF_SPACES

uvec4 nookHalfSpace(ivec2 texel, int four)
{
	return texelFetch(nook_half_spaces, ivec2(texel.x, texel.y + four * nookHalfSpaces()), 0);
}
)";

constexpr const char* kHalfSpacesMain = R"(
uvec4 nookHalfSpacesAt(ivec2 texel)
{
	int four = texel.y / nookHalfSpaces();
	return nookHalfSpaceTexel(ivec2(texel.x, texel.y - four * nookHalfSpaces()), four);
}
)";

constexpr const char* kMaskMain = R"(
NOOK_STATICfloat nook_height;

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
)";

std::string maskResolveMain(int directions)
{
	const bool two = directions > 128;
	std::string text = "\nNOOK_NEEDS nook_sums; // the pictures of the fragment stage\n";
	text += two ? "NOOK_NEEDS nook_more_sums;\n" : "";
	// Channels that the texture lacks read as 1.
	const char* const there = directions == 32 ? " * uvec4(1u, 0u, 0u, 0u)" : directions == 64 ? " * uvec4(1u, 1u, 0u, 0u)" : "";
	text += std::string("\nfloat nookResolved(ivec2 cell)\n{\n\tuint covered = nookBitsOf(texelFetch(nook_sums, cell, 0)") + there +
			");\n";
	text += two ? "\tcovered += nookBitsOf(texelFetch(nook_more_sums, cell, 0));\n" : "";
	return text + "\treturn 1.0 - float(covered) / " + std::to_string(directions) + ".0;\n}\n";
}

// The entry point of a fragment stage. values: of its targets, where PIXEL is the pixel. between: reads what the vertex stage
// passes.
std::string entryText(GlslTarget target, const std::string& type, const std::string& name, const std::vector<std::string>& values,
					  bool between = false)
{
	const bool hlsl = target == GlslTarget::hlsl60;
	std::string outputs;
	std::string sets = hlsl && between ? "\tnook_between = between;\n" : "";
	const char* const pixel = !hlsl ? "ivec2(gl_FragCoord.xy)" : between ? "ivec2(between.position.xy)" : "ivec2(place.xy)";
	for (std::size_t i = 0; i < values.size(); ++i)
	{
		const std::string number = std::to_string(i);
		const std::string one = type + " " + name + (values.size() > 1 ? "_" + number : "");
		outputs += hlsl ? ", out " + one + " : SV_Target" + number : "layout(location = " + number + ") out " + one + ";\n";
		sets += "\t" + one.substr(type.size() + 1) + " = " + replaced(values[i], "PIXEL", pixel) + ";\n";
	}
	const std::string head =
		hlsl ? std::string("void main(") + (between ? "NookBetween between" : "vec4 place : SV_Position") + outputs + ")"
			 : outputs + "\nvoid main()";
	return target == GlslTarget::wgsl ? "" : "\n" + head + "\n{\n" + sets + "}\n";
}

std::string fragmentStage(const AovTextSettings& settings, const std::string& buffers)
{
	FunctionWriter functions(volumeKernels());
	std::string text = buffers + betweenText(settings.target, "in") + inputs(settings) + kReceiver;
	text += functionOf(functions, "nookPosition") + functionOf(functions, "nookDepthError") + functionOf(functions, "nookHeight") +
			functionOf(functions, "nookLift") + functionOf(functions, "nookReaches");
	if (settings.directions == 0)
	{
		return text + functionOf(functions, "nookVolume", settings.target) + stageText(assets::aov_fragment_glsl) +
			   entryText(settings.target, "float", "nook_occlusion", {"nookOcclusion(PIXEL * nook.cell)"}, true);
	}
	std::vector<std::string> values{"nookBits(PIXEL * nook.cell)", "nookMoreBits()"};
	values.resize(settings.directions > 128 ? 2 : 1);
	text += functionOf(functions, "nookFalloff");
	functionOf(functions, "nookHalfSpaceTexel"); // in masksText
	text += kHalfSpaces + functionOf(functions, "nookMaskBits", settings.target);
	std::string receiver = stageText(assets::aov_fragment_glsl);
	receiver.resize(receiver.find("\n// AOV eqs. 4 and 5."));
	return text + receiver + "\nNOOK_STATICvec3 nook_normal;\n" + stageText(assets::aov_mask_fragment_glsl) + kMaskMain +
		   entryText(settings.target, "uvec4", "nook_bits", values, true);
}

// The part that the fragment stage of masks and the stage NOOK_HALF_SPACES share.
std::string masksText(int directions)
{
	FunctionWriter functions(volumeKernels());
	return "\n#if defined(NOOK_FRAGMENT) || defined(NOOK_HALF_SPACES)\n" + raysText(directions) +
		   functionOf(functions, "nookHalfSpaceTexel") + "#endif\n";
}

std::string sparseStage(const AovTextSettings& settings)
{
	FunctionWriter functions(volumeKernels());
	return inputs(settings) + kSparseInput + functionOf(functions, "nookSparse") + kSparseMain +
		   entryText(settings.target, "float", "nook_visibility", {"nookKnown(PIXEL)"});
}

std::string stage(GlslTarget target, const std::string& name, const std::string& text)
{
	return target == GlslTarget::wgsl ? text : "\n#ifdef " + name + "\n" + text + "#endif // " + name + "\n";
}

} // namespace

std::string aovText(const AovTextSettings& settings)
{
	const GlslTarget target = settings.target;
	const bool hlsl = target == GlslTarget::hlsl60;
	std::string buffers = hasNumbers(target) ? kStorage : kBuffers330;
	if (target == GlslTarget::es300)
	{
		static const std::regex fetch(R"(texelFetch\((\w+), ([^)]*)\))");
		buffers = kTexel + std::regex_replace(replaced(buffers, "usamplerBuffer", "highp usampler2D"), fetch,
											  "texelFetch($1, nookTexel($2, textureSize($1, 0)), 0)");
	}
	const char* const vertex_main = hlsl ? kVertexHlsl : target == GlslTarget::wgsl ? "" : kVertexMain;
	const bool masks = settings.directions > 0;
	FunctionWriter of_vertex(volumeKernels());
	std::string text = blockText(target) +
					   stage(target, "NOOK_VERTEX",
							 buffers + betweenText(target, "out") + functionOf(of_vertex, "nookCross", target) +
								 "\n#ifdef NOOK_CHOOSE_FACES\n" + kFaces + inputs(settings) + stageText(assets::aov_faces_glsl) +
								 "#endif // NOOK_CHOOSE_FACES\n" + stageText(assets::aov_vertex_glsl) + vertex_main);
	text += masks ? masksText(settings.directions) : "";
	text += stage(target, "NOOK_FRAGMENT", fragmentStage(settings, buffers));
	text += stage(target, "NOOK_RESOLVE",
				  (masks ? stageText(assets::aov_mask_resolve_glsl) + maskResolveMain(settings.directions)
						 : stageText(assets::aov_resolve_glsl) + kResolved) +
					  entryText(target, "float", "nook_visibility", {"nookResolved(PIXEL)"}));
	text += masks ? stage(target, "NOOK_HALF_SPACES",
						  kHalfSpacesMain + entryText(target, "uvec4", "nook_bits", {"nookHalfSpacesAt(PIXEL)"}))
				  : "";
	text += stage(target, "NOOK_SPARSE", sparseStage(settings));
	for (const Resource& resource : kResources)
	{
		const bool bits =
			masks && (resource.name == std::string_view("nook_sums") || resource.name == std::string_view("nook_more_sums"));
		text = replaced(text, std::string("NOOK_NEEDS ") + resource.name + ";",
						declarationOf(resource, bits ? "usampler2D" : resource.type, target));
	}
	text = replaced(text, "NOOK_STATIC", hlsl ? "static " : "");
	return target == GlslTarget::vulkan ? replaced(text, "gl_VertexID", "gl_VertexIndex") : text;
}

} // namespace nook
