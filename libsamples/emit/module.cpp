// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/module.h"

#include "core/lists.h"
#include "emit/module_parts.h"
#include "format/arrays.h"
#include "methods/kernel_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>
#include <set>

namespace nook
{
namespace
{

constexpr const char* kLinear = "nookLinear"; // converts device depth
constexpr const char* kNormal = "nookNormal";
constexpr const char* kNormalFromDepth = "nookNormalFromDepth";

// Inputs that kernels read from textures. An engine may define the macro first to read its own data.
struct Input
{
	const char* function;
	const char* type;
	const char* macro;
	const char* sampler;
	const char* binding_macro;
	const char* channels;
	int binding;
	const char* meaning;
};
constexpr std::array kInputs{
	Input{"nookDepth", "float", "NOOK_DEPTH", "nook_depths", "NOOK_DEPTHS", ".r", 1,
		  "Linear depth: distance along the view direction, > 0; NOOK_SKY or more where there is no surface."},
	Input{kNormal, "vec3", "NOOK_NORMAL", "nook_normals", "NOOK_NORMALS", ".xyz", 2,
		  "Unit normal in view space: x to the right, y up, z toward the camera."},
	Input{"nookVisibility", "float", "NOOK_VISIBILITY", "nook_cells", "NOOK_CELLS", ".r", 6,
		  "Visibility in the picture of the pass before."},
};

// Inputs drawn by earlier passes of the module.
struct PassInput
{
	const char* function;
	const char* head; // function head
	const char* parameters;
	const char* sampler;
	const char* type;
	const char* binding_macro;
	int binding;
	const char* place;
	const char* level;
	const char* meaning;
};
constexpr std::array kPassInputs{
	PassInput{"nookLevel", "vec4 nookLevel(ivec2 texel, int level)", "texel, level", "nook_levels", "sampler2D", "NOOK_LEVELS", 7,
			  "texel", "level",
			  "Picture of an earlier pass, with its mip levels where it has some. While you draw into level l of it, restrict the "
			  "texture\n"
			  "// to the levels before l (GL_TEXTURE_MAX_LEVEL, or an image view)."},
	PassInput{
		"nookPacked", "vec4 nookPacked(ivec2 cell)", "cell", "nook_packed", "sampler2D", "NOOK_PACKED", 11, "cell", "0",
		"Picture of the pass before: visibility in the first channel, numbers for the filter or for upsampling in the others."},
	PassInput{"nookTable", "uvec4 nookTable(ivec2 texel, int table)", "texel, table", "nook_tables", "highp usampler2DArray",
			  "NOOK_TABLES", 8, "ivec3(texel, table)", "0", "Summed-area tables: RGBA32UI, one table per layer."},
	PassInput{"nookRange", "vec4 nookRange(int i)", "i", "nook_range", "sampler2D", "NOOK_RANGE", 9, "ivec2(i, 0)", "0",
			  "Picture of nookStatFrame, two texels: the range of the positions in the tables."},
};

bool isHlsl(const ModuleSettings& settings)
{
	return settings.target == GlslTarget::hlsl60;
}

bool hasBindings(GlslTarget target)
{
	return target == GlslTarget::gl430 || target == GlslTarget::vulkan || target == GlslTarget::hlsl60;
}

std::string setOf(GlslTarget target)
{
	return target == GlslTarget::vulkan ? "set = NOOK_SET, " : "";
}

// On targets with binding numbers, a macro that an engine may define first.
std::string bindingMacro(GlslTarget target, const std::string& name, int number)
{
	return hasBindings(target) ? "#ifndef " + name + "\n#define " + name + " " + std::to_string(number) + "\n#endif\n" : "";
}

// A macro for a resource whose numbers differ between Direct3D, which counts each kind, and HLSL for Vulkan.
std::string placeMacro(const std::string& name, int number, int vulkan_number)
{
	return "#ifndef " + name + "\n#ifdef NOOK_VULKAN\n#define " + name + " " + std::to_string(vulkan_number) + "\n#else\n#define " +
		   name + " " + std::to_string(number) + "\n#endif\n#endif\n";
}

bool isSeparate(const ModuleSettings& settings)
{
	return settings.target == GlslTarget::vulkan && settings.textures == ModuleTextures::separate;
}

// "sampler2D" as the type of a texture alone: "texture2D", or "Texture2D<vec4>" for toHlsl.
std::string textureType(const ModuleSettings& settings, std::string type)
{
	if (isHlsl(settings))
	{
		return type == "sampler2D" ? "Texture2D<vec4>" : "Texture2DArray<uvec4>";
	}
	return isSeparate(settings) ? type.replace(type.find("sampler"), 7, "texture") : type;
}

// Declares a texture. `macro`: the name of its binding macro without _BINDING.
std::string samplerText(const ModuleSettings& settings, const std::string& macro, const std::string& sampler, int binding,
						const std::string& type = "sampler2D")
{
	const GlslTarget target = settings.target;
	const std::string number = macro + "_BINDING";
	if (isHlsl(settings))
	{
		return bindingMacro(target, number, binding) + "NOOK_AT(" + number + ") " + textureType(settings, type) + " " + sampler +
			   " NOOK_REGISTER(t, " + number + ");\n";
	}
	const std::string layout = hasBindings(target) ? "layout(" + setOf(target) + "binding = " + number + ") " : "";
	return bindingMacro(target, number, binding) + layout + "uniform " + textureType(settings, type) + " " + sampler + ";\n";
}

std::string fetchText(const ModuleSettings& settings, const std::string& sampler, const std::string& place,
					  const std::string& level = "0", std::string_view type = "sampler2D")
{
	if (isHlsl(settings))
	{
		return sampler + ".Load(" + (type == "sampler2D" ? "ivec3(" : "ivec4(") + place + ", " + level + "))";
	}
	const std::string combined = std::string(type.substr(type.find_last_of(' ') + 1)) + "(" + sampler + ", nook_sampler)";
	return "texelFetch(" + (isSeparate(settings) ? combined : sampler) + ", " + place + ", " + level + ")";
}

// `made`: normals are reconstructed from depths.
std::string inputText(const ModuleSettings& settings, const Input& input, bool made)
{
	const std::string macro = input.macro;
	const std::string value = macro + "(pixel)";
	const bool device = settings.device_depth && macro == "NOOK_DEPTH";
	const std::string fetch =
		made ? std::string(kNormalFromDepth) + "(pixel)" : fetchText(settings, input.sampler, "pixel") + input.channels;
	return "\n// " +
		   std::string(device ? "The depth buffer as it is, 0 to 1, of any projection; a pixel at the far plane is sky."
							  : input.meaning) +
		   "\n// Define " + value + " before this file to read your own" + (made ? "" : " in another way") + ".\n#ifndef " + macro +
		   "\n" + (made ? "" : samplerText(settings, input.binding_macro, input.sampler, input.binding)) + "#define " + value +
		   " " + fetch + "\n#endif\n" + input.type + " " + input.function + "(ivec2 pixel)\n{\n\treturn " +
		   (device ? kLinear + ("(" + value + ")") : value) + ";\n}\n";
}

// A function that fetches a texel, through a macro where the module has macros.
std::string readText(const ModuleSettings& settings, const std::string& declaration, const std::string& head,
					 const std::string& call, const std::string& fetch)
{
	if (settings.textures == ModuleTextures::fixed && !isHlsl(settings))
	{
		return declaration + head + "\n{\n\treturn " + fetch + ";\n}\n";
	}
	return "// Define " + call + " before this file to read it in another way.\n#ifndef " + call.substr(0, call.find('(')) + "\n" +
		   declaration + "#define " + call + " " + fetch + "\n#endif\n" + head + "\n{\n\treturn " + call + ";\n}\n";
}

std::string passInputText(const ModuleSettings& settings, const PassInput& input)
{
	const std::string macro = input.binding_macro;
	return "\n// " + std::string(input.meaning) + "\n" +
		   readText(settings, samplerText(settings, macro, input.sampler, input.binding, input.type), input.head,
					macro + "(" + input.parameters + ")", fetchText(settings, input.sampler, input.place, input.level, input.type));
}

// The uniform for what differs between passes of one function.
std::string passText(const ModuleSettings& settings)
{
	const std::string member = settings.float_block ? "vec4 nook_pass;" : "ivec4 nook_pass;";
	const std::string text = "\n// Parameters of the pass that is drawn, as the list at the top says.\n";
	switch (settings.target)
	{
	case GlslTarget::wgsl:
	case GlslTarget::vulkan: return text + "layout(push_constant) uniform nook_pass_block\n{\n\t" + member + "\n};\n";
	case GlslTarget::hlsl60:
		return text + placeMacro("NOOK_PASS_BINDING", 1, 16) +
			   "NOOK_AT(NOOK_PASS_BINDING) cbuffer nook_pass_block NOOK_REGISTER(b, NOOK_PASS_BINDING)\n{\n\t" + member + "\n};\n";
	case GlslTarget::gl430:
		return text + bindingMacro(settings.target, "NOOK_PASS_LOCATION", 0) + "layout(location = NOOK_PASS_LOCATION) uniform " +
			   member + "\n";
	case GlslTarget::gl330:
	case GlslTarget::es300: break;
	}
	return text + "uniform " + member + "\n";
}

std::string blockText(const ModuleSettings& settings)
{
	const GlslTarget target = settings.target;
	const std::string text =
		"\n// The uniform block that nook_fill fills. Lengths are in metres, or in the unit of your depths.\n" +
		bindingMacro(target, "NOOK_BLOCK_BINDING", 0);
	if (isHlsl(settings))
	{
		return text + "struct nook_block_members\n{\n" + membersText(settings) +
			   "};\nNOOK_AT(NOOK_BLOCK_BINDING) cbuffer nook_block NOOK_REGISTER(b, NOOK_BLOCK_BINDING)\n{\n"
			   "\tnook_block_members nook;\n};\n";
	}
	const std::string layout =
		"layout(" + setOf(target) + "std140" + (hasBindings(target) ? ", binding = NOOK_BLOCK_BINDING" : "") + ")";
	return text + layout + " uniform nook_block\n{\n" + membersText(settings) + "} nook;\n";
}

std::string headOf(const ModuleSettings& settings)
{
	switch (settings.target)
	{
	case GlslTarget::gl330: return "#if __VERSION__ < 330\n#error nook: this module needs #version 330 or later\n#endif\n";
	case GlslTarget::gl430: return "#if __VERSION__ < 430\n#error nook: this module needs #version 430 or later\n#endif\n";
	case GlslTarget::es300:
		return "#if !defined(GL_ES) || __VERSION__ < 300\n#error nook: this module needs #version 300 es or later\n#endif\n"
			   "// Depths need high precision. The rest of your shader gets these defaults too, unless it sets others.\n"
			   "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n";
	case GlslTarget::hlsl60:
		return "#ifndef NOOK_REGISTER // define it first for another space, or as nothing where your engine binds by name\n"
			   "#define NOOK_REGISTER_OF(kind, number) : register(kind##number)\n"
			   "#define NOOK_REGISTER(kind, number) NOOK_REGISTER_OF(kind, number)\n#endif\n"
			   "#ifdef NOOK_VULKAN // define it first for SPIR-V\n"
			   "#ifndef NOOK_SET\n#define NOOK_SET 0 // descriptor set of every binding of this module\n#endif\n"
			   "#define NOOK_AT(number) [[vk::binding(number, NOOK_SET)]]\n#else\n#define NOOK_AT(number)\n#endif\n";
	case GlslTarget::wgsl:
	case GlslTarget::vulkan: break;
	}
	return "#if !defined(VULKAN) || __VERSION__ < 450\n#error nook: this module needs #version 450 or later, and Vulkan\n#endif\n"
		   "#ifndef NOOK_SET\n#define NOOK_SET 0 // descriptor set of every binding of this module\n#endif\n" +
		   (isSeparate(settings)
				? bindingMacro(settings.target, "NOOK_SAMPLER_BINDING", 16) +
					  "layout(set = NOOK_SET, binding = NOOK_SAMPLER_BINDING) uniform sampler nook_sampler; // any\n"
				: "");
}

constexpr std::array kVersionLines{"#version 330 core\n", "#version 430 core\n", "#version 300 es\n", "#version 450\n", ""};

// An array of constants. `space`: between the elements.
std::string arrayText(const ModuleSettings& settings, const std::string& type, const std::string& name,
					  const std::vector<std::string>& elements, const std::string& before, const std::string& space)
{
	const std::string size = "[" + std::to_string(elements.size()) + "]";
	return (isHlsl(settings) ? "static const " : "const ") + type + " " + name + size + " = " +
		   (isHlsl(settings) ? "{" : type + size + "(") + before +
		   joinedText(elements, "," + space, [&type](const std::string& element) { return type + "(" + element + ")"; }) +
		   (isHlsl(settings) ? "};\n" : ");\n");
}

std::string columnsText(const ModuleMethod& method)
{
	return rowOf(method.method).third == SampleThird::log2_side ? "x, y, log2 of the side of its area, weight"
																: columnsOf(method.variants.front().domain);
}

// Text of a method's samples and how its kernel reads them.
std::string samplesText(const ModuleSettings& settings, const ModuleMethod& method)
{
	const MethodRow& row = rowOf(method.method);
	if (method.variants.empty())
	{
		return {};
	}
	const std::string count = std::to_string(method.variants.front().count());
	const std::string name = stemOf(row) + "_samples";
	const std::string entry = entryOf(settings, method);
	const std::string function = entry + "Sample";
	const int window = windowOf(method);
	const std::string side = std::to_string(window);
	const std::string cell = shadeOf(settings, method).half_resolution ? " / 2" : "";
	std::string text = "\n// The samples: " + columnsText(method) + " of each, for a radius of 1";
	if (fromTexture(settings, method))
	{
		const std::string sampler = stemOf(row) + "_tile";
		text += ". A texture RGBA32F, " + std::to_string(method.variants.size()) + " x " + count +
				", whose texels the header holds;\n// a column is the variant of a pixel, a row is a sample.\n";
		const std::string macro = macroOf(row) + "_TILE";
		text += readText(settings, samplerText(settings, macro, sampler, row.tile_binding), "vec4 " + function + "(int row, int i)",
						 macro + "(row, i)", fetchText(settings, sampler, "ivec2(row, i)"));
	}
	else
	{
		text += window > 1 ? "; those of one variant after the other.\n" : ".\n";
		text += arrayText(settings, "vec4", name, mapped(rowsOf(method), rowText), "\n\t", "\n\t");
		const std::string at = window > 1 ? "row * " + count + " + i" : "i";
		text += "vec4 " + function + "(int row, int i)\n{\n\treturn " + name + "[" + at + "];\n}\n";
	}
	std::string variant =
		window > 1 ? "(nookRow(pixel.y)" + cell + " % " + side + ") * " + side + " + pixel.x" + cell + " % " + side : "0";
	const std::string frame = "int(nook.frame) % " + std::to_string(method.frames);
	if (!method.moves.empty())
	{
		const auto textOf = [](const glm::ivec2& move)
		{
			return std::to_string(move.x) + ", " + std::to_string(move.y);
		};
		text += arrayText(settings, "ivec2", stemOf(row) + "_moves", mapped(method.moves, textOf), "", " ");
		variant =
			"(nookRow(pixel.y)" + cell + " + move.y) % " + side + " * " + side + " + (pixel.x" + cell + " + move.x) % " + side;
		return text + "int " + entry + "Variant(ivec2 pixel)\n{\n\tivec2 move = " + stemOf(row) + "_moves[" + frame +
			   "];\n\treturn " + variant + ";\n}\n";
	}
	if (method.frames > 1)
	{
		variant = "(" + frame + ") * " + std::to_string(window * window) + " + " + variant;
	}
	return text + "int " + entry + "Variant(ivec2 pixel)\n{\n\treturn " + variant + ";\n}\n";
}

// For half resolution: text of the full-resolution method for pixels that upsampling cannot fill.
std::string fullText(const ModuleSettings& settings, const ModuleMethod& method)
{
	if (!shadeOf(settings, method).half_resolution)
	{
		return {};
	}
	const MethodRow& row = rowOf(method.method);
	const std::string entry = entryOf(row);
	const std::string own = isShaped(shadeOf(settings, method)) ? "nookShaped(" + entry + "(pixel))" : entry + "(pixel)";
	return "\n// Visibility of a pixel for which upsampling found no surface, evaluated for this pixel alone.\nfloat " + entry +
		   "Left(ivec2 pixel)\n{\n\treturn " + own +
		   ";\n}\n\n// Visibility of a pixel at full resolution: upsampled, or evaluated for this pixel where none of the cells "
		   "around it shows its\n"
		   "// surface.\nfloat " +
		   entry +
		   "Full(ivec2 pixel)\n{\n\tfloat visibility = nookUpsample(pixel);\n\tif (visibility < 0.0)\n\t{\n"
		   "\t\treturn " +
		   entry + "Left(pixel);\n\t}\n\treturn visibility;\n}\n";
}

// Text that packs a texel's visibility with the values that later passes read.
std::string packedText(FunctionWriter& writer, const ModuleEntry& entry)
{
	const char* const packing = packingCall(entry.packing);
	const std::string value = entry.call + (entry.of_pixel ? "(nookPixel(cell))" : "(cell)");
	const std::string functions = writer.add(packing, entry.constants); // including nookPixel
	return functions + "\nvec4 " + entry.call + (packing + std::string_view("nook").size()) + "(ivec2 cell)\n{\n\treturn " +
		   packing + "(cell, " + value + ");\n}\n";
}

// Functions of all methods, with their samples.
std::string functionsOf(const ModuleSettings& settings, FunctionWriter& writer)
{
	std::string functions;
	std::set<std::string> wrapped;
	for (const ModuleMethod& method : settings.methods)
	{
		functions += windowOf(method) > 1 ? writer.add("nookRow", {}) : "";
		functions += samplesText(settings, method);
		for (const ModuleEntry& entry : entriesOf(settings, method))
		{
			functions += writer.add(entry.call, entry.constants);
			if (entry.packing != ShadePacking::none && wrapped.insert(entry.call).second) // methods share one filter
			{
				functions += packedText(writer, entry);
			}
		}
		for (const char* const function : {"nookBentCoded", "nookBentDecoded", "nookConeAngle"})
		{
			functions += hasBentNormals(settings, method) ? writer.add(function, {}) : "";
		}
		functions += fullText(settings, method);
	}
	if (settings.gather)
	{
		functions += writer.add("nookGather", entriesOf(settings, settings.methods.front()).back().constants);
	}
	return functions;
}

// The main function of a pass, with its output.
std::string mainOf(const ModuleSettings& settings, const ModulePass& pass)
{
	const bool compute = settings.main == ModuleMain::compute;
	if (isHlsl(settings))
	{
		return compute ? "NOOK_AT(NOOK_OUT_BINDING) RWTexture2D<" + pass.type +
							 "> nook_out NOOK_REGISTER(u, NOOK_OUT_BINDING); // " + pass.format +
							 " or better\n\n[numthreads(NOOK_GROUP, NOOK_GROUP, 1)]\nvoid main(uvec3 id : SV_DispatchThreadID)\n{\n"
							 "\tuvec2 size;\n\tnook_out.GetDimensions(size.x, size.y);\n\tivec2 at = ivec2(id.xy);\n"
							 "\tif (id.x < size.x && id.y < size.y)\n\t{\n\t\tnook_out[id.xy] = " +
							 pass.call + ";\n\t}\n}\n"
					   : pass.type + " main(vec4 place : SV_Position) : SV_Target\n{\n\tivec2 at = ivec2(place.xy);\n\treturn " +
							 pass.call + ";\n}\n";
	}
	if (!compute)
	{
		return "layout(location = 0) out " + pass.type + " nook_out; // " + pass.format +
			   " or better\n\nvoid main()\n{\n\tivec2 at = ivec2(gl_FragCoord.xy);\n\tnook_out = " + pass.call + ";\n}\n";
	}
	const std::string own = pass.type.front() == 'u' ? "uvec4" : "vec4";
	const std::string image = pass.type.front() == 'u' ? "uimage2D" : "image2D";
	return "#ifndef NOOK_OUT_FORMAT\n#define NOOK_OUT_FORMAT " + pass.format + " // or better\n#endif\nlayout(" +
		   setOf(settings.target) + "binding = NOOK_OUT_BINDING, NOOK_OUT_FORMAT) uniform writeonly " + image +
		   " nook_out;\n\nvoid main()\n{\n\tivec2 at = ivec2(gl_GlobalInvocationID.xy);\n\tivec2 size = imageSize(nook_out);\n"
		   "\tif (at.x < size.x && at.y < size.y)\n\t{\n\t\timageStore(nook_out, at, " +
		   own + "(" + pass.call + "));\n\t}\n}\n";
}

std::string mainText(const ModuleSettings& settings)
{
	const std::vector<ModulePass> passes = mainPasses(settings);
	std::string text;
	if (settings.main == ModuleMain::compute)
	{
		const bool glsl = !isHlsl(settings);
		text +=
			"\n// Dispatch (width + NOOK_GROUP - 1) / NOOK_GROUP by (height + NOOK_GROUP - 1) / NOOK_GROUP groups for the picture "
			"nook_out.\n#ifndef NOOK_GROUP\n#define NOOK_GROUP 8\n#endif\n";
		text += settings.target == GlslTarget::gl430 ? bindingMacro(settings.target, "NOOK_OUT_BINDING", 0)
				: glsl                               ? bindingMacro(settings.target, "NOOK_OUT_BINDING", 15)
													 : placeMacro("NOOK_OUT_BINDING", 0, 15);
		text += glsl ? "layout(local_size_x = NOOK_GROUP, local_size_y = NOOK_GROUP) in;\n" : "";
	}
	if (passes.size() == 1)
	{
		return text + "\n" + mainOf(settings, passes.front());
	}
	text += "\n// The pass that main computes.\n#ifndef NOOK_PASS\n#define NOOK_PASS 0\n#endif\n";
	for (std::size_t i = 0; i < passes.size(); ++i)
	{
		text += (i == 0 ? "#if" : "#elif") + std::string(" NOOK_PASS == ") + std::to_string(i) + "\n" + mainOf(settings, passes[i]);
	}
	return text + "#else\n#error nook: NOOK_PASS: expected 0 to " + std::to_string(passes.size() - 1) + "\n#endif\n";
}

// A module in the kernels' subset of GLSL as HLSL. Declarations of resources already are HLSL, but for the names of types.

using Matches = std::sregex_iterator;

// Adds vector types, which are their constructors, and the names declared with them.
void addVectors(const std::string& code, std::set<std::string>& vectors)
{
	static const std::regex declared(R"(\b([iu]?vec[234])\s+(\w+))");
	for (Matches it(code.begin(), code.end(), declared), end; it != end; ++it)
	{
		vectors.insert({(*it)[1], (*it)[2]});
	}
}

// GLSL's == and != of two vectors are one truth; HLSL's are one per component, and ?: would choose by each. `vectors`: names of
// vectors, and of functions that return them. An operand is a name, or a call without further calls.
std::string withWholeComparisons(const std::string& code, const std::set<std::string>& vectors)
{
	static const std::regex comparison(R"((\w+)(\([^()]*\))? (==|!=) (\w+)(\([^()]*\))?(?!\w*\.))");
	std::string text;
	std::size_t done = 0;
	for (Matches it(code.begin(), code.end(), comparison), end; it != end; ++it)
	{
		const std::smatch& match = *it;
		const auto at = static_cast<std::size_t>(match.position());
		const bool member = at > 0 && code[at - 1] == '.';
		if (!member && (vectors.contains(match[1]) || vectors.contains(match[4])))
		{
			text += code.substr(done, at - done) + (match[3] == "==" ? "all(" : "any(") + match.str() + ")";
			done = at + match.str().size();
		}
	}
	return text + code.substr(done);
}

// GLSL declarations and functions in the kernels' subset as HLSL: names of types and functions, words that HLSL reserves, and
// comparisons of vectors, which return vectors there.
std::string toHlsl(const std::string& module)
{
	static const std::regex head(R"(\n[iu]?vec[234] nook\w+\()");
	std::set<std::string> functions;
	for (Matches it(module.begin(), module.end(), head), end; it != end; ++it)
	{
		addVectors(it->str(), functions);
	}
	std::string text;
	for (std::size_t at = 0; at < module.size();) // function by function, since names are local to each
	{
		const std::size_t end = std::min(module.find("\n}\n", at), module.size() - 3) + 3;
		const std::string code = module.substr(at, end - at);
		std::set<std::string> vectors = functions;
		addVectors(code, vectors);
		text += withWholeComparisons(code, vectors);
		at = end;
	}
	text = renamed(text, {{"bitCount", "countbits"},
						  {"floatBitsToUint", "asuint"},
						  {"uintBitsToFloat", "asfloat"},
						  {"mat4", "float4x4"},
						  {"line", "one_line"}, // reserved, as is `point`
						  {"point", "one_point"}});
	for (const auto& [pattern, by] : {std::pair{R"(\btexelFetch\((\w+), (.*), 0\))", "$1.Load(ivec3($2, 0))"},
									  std::pair{R"(\bconst (\w+ \w+\[\d+\]) = \w+\[\d+\]\(([^;]*)\);)", "static const $1 = {$2};"},
									  std::pair{R"(\bnook\.clip \* ([^;]+);)", "mul(nook.clip, $1);"}})
	{
		text = std::regex_replace(text, std::regex(pattern), by);
	}
	for (const auto& [type, name] : {std::pair{"ivec", "int"}, std::pair{"uvec", "uint"}, std::pair{"vec", "float"}})
	{
		text = std::regex_replace(text, std::regex(std::string(R"(\b)") + type + R"(([234])\b)"), std::string(name) + "$1");
	}
	return text;
}

// $1 to $4: the stages, corners and polygons, the clusters, the draw calls.
constexpr const char* kVolumesHead = R"(//
// Draws the static ambient occlusion volumes of a file that `nook volumes` wrote over the depth and normals of a frame: visibility of
// static surfaces, 1 where open. Stages: $1.
// Once: nook_volumes::Volumes::open (nook_volumes.h; volumes_file.js of the npm package nook-ao). Upload corners() and polygons() as
// $2 nook_corners and nook_polygons.
// Every frame: nook_volumes::Frame::set (nook_volumes_draw.h); its block is the uniform block NookVolumes. Frame::seen of every cluster
// makes $3 nook_clusters.
// Draw call of each cluster i with Frame::inSight:$4
// States: depth test against the depth buffer of the frame, no depth writes; depth clamp; front faces counter-clockwise (clockwise where
// Frame::mirrored). Clusters that do not contain the eye: cull back faces, depth test "less or equal". Clusters that do
// (Frame::holdsEye): cull front faces, depth test "greater or equal"; reversed depth has the opposite tests. Without depth clamp set
// NOOK_ANY_DEPTH for the vertex stage and draw without a depth test.
// nook's page "Drawing occlusion volumes" says how NOOK_CHOOSE_FACES spares fragments, and NOOK_SPARSE draws one pixel of 9 or 25.
// Together with a screen-space method, take min(this visibility, that one): then an occluder that both see counts once.
)";
constexpr const char* kMacros = R"(define one of these macros first, after your #version, for its main():
//   NOOK_VERTEX (with NOOK_PRISMS for files of --layout prisms), NOOK_FRAGMENT: the volumes; one depth read per fragment
//   NOOK_RESOLVE, NOOK_SPARSE: the picture; NOOK_SPARSE where one pixel of 9 or 25 was drawn, at most 51 depth reads)";
constexpr const char* kCallsGl = R"(
//   glVertexAttribI1i(0, i); // or NOOK_CLUSTER, defined as a uniform of yours, gl_DrawID, in Vulkan gl_InstanceIndex
//   glDrawArrays(GL_TRIANGLES, 12 * first_corner, 12 * corner_count);
// With prisms the attribute nook_point (location 1) is vertices(), four unsigned 16-bit integers, and the call
//   glDrawElementsBaseVertex(GL_TRIANGLES, index_count, GL_UNSIGNED_SHORT, 2 * first_index, first_vertex);
// All in one call: glMultiDrawArraysIndirect, where nook_cluster has divisor 1 and holds 0, 1, 2 ..., and i is the base instance.)";
constexpr const char* kCallsHlsl = R"(
//   DrawInstanced(12 * corner_count, 1, 0, i), where NOOK_CLUSTER is an attribute per instance of the numbers 0, 1, 2 ...
// With prisms NOOK_POINT is vertices(), R16G16B16A16_UINT, and the call
//   DrawIndexedInstanced(index_count, 1, first_index, first_vertex, i))";
constexpr const char* kCallsWgsl = R"(
//   draw(12 * corner_count, 1, 12 * first_corner, i)
// With prisms the attribute 0 is vertices(), uint16x4, and the call
//   drawIndexed(index_count, 1, first_index, first_vertex, i)
// nook_faces is 0 unless faces are chosen. NOOK_ANY_DEPTH is the constant nook_any_depth.)";

constexpr const char* kSums =
	R"(// Target: R16F (or R32F; R8 would saturate at 1), cleared to 0; blending adds. The resolve stage reads it as nook_sums.
)";
constexpr const char* kBits =
	R"(// Target: unsigned integers, R32UI, RG32UI or RGBA32UI for up to 32, 64 and 128 directions, a second RGBA32UI for more; cleared to 0;
// no blending, but the logic operation OR (GL_COLOR_LOGIC_OP). The resolve stage reads them as nook_sums and nook_more_sums.
// Once, before the first frame: draw a triangle over a texture RGBA32UI of 64 x 64 texels, 64 x 128 above 128 directions, with the
// stage NOOK_HALF_SPACES. The fragment stage of the volumes reads it as nook_half_spaces.
)";

std::string volumesHead(const AovTextSettings& settings)
{
	const GlslTarget target = settings.target;
	const bool wgsl = target == GlslTarget::wgsl;
	const std::string buffers = target == GlslTarget::gl330   ? "buffer textures"
								: target == GlslTarget::es300 ? "textures of any width, filled row by row,"
															  : "";
	const std::string stages =
		wgsl ? "nook_vertex (nook_prism_vertex for files of\n// --layout prisms) and nook_fragment draw volumes, nook_triangle and "
			   "nook_resolve or nook_sparse the picture"
			 : kMacros;
	const std::string once = buffers.empty() ? "storage buffers" : buffers + " RGBA16UI and RG32UI,";
	const std::string frame = buffers.empty() ? "the storage buffer" : buffers + " RGBA32UI, four texels a cluster,";
	const char* const calls = wgsl ? kCallsWgsl : target == GlslTarget::hlsl60 ? kCallsHlsl : kCallsGl;
	std::string text = kVolumesHead;
	for (const auto& [mark, by] : {std::pair{"\\$1", stages}, {"\\$2", once}, {"\\$3", frame}, {"\\$4", std::string(calls)}})
	{
		text = std::regex_replace(text, std::regex(mark), by);
	}
	return text + (settings.directions > 0 ? kBits : kSums);
}

} // namespace

bool hasCompute(GlslTarget target)
{
	return hasBindings(target) || target == GlslTarget::wgsl;
}

std::string stemOf(const MethodRow& row)
{
	std::string stem = "nook_" + std::string(row.name);
	std::replace(stem.begin(), stem.end(), '-', '_');
	return stem;
}

std::string macroOf(const MethodRow& row)
{
	std::string macro = stemOf(row);
	std::transform(macro.begin(), macro.end(), macro.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
	return macro;
}

int layersOf(const ModuleMethod& method)
{
	return method.moves.empty() ? method.frames : 1;
}

int windowOf(const ModuleMethod& method)
{
	int side = 1;
	while (static_cast<std::size_t>(side * side * layersOf(method)) < method.variants.size())
	{
		side += 1;
	}
	return side;
}

bool fromTexture(const ModuleSettings& settings, const ModuleMethod& method)
{
	return method.variants.size() > 1 && settings.tile == TilePlace::texture;
}

std::string guardOf(const ModuleSettings& settings)
{
	return "NOOK" +
		   joinedText(settings.methods, "", [](const ModuleMethod& method) { return macroOf(rowOf(method.method)).substr(4); });
}

std::vector<Sample> rowsOf(const ModuleMethod& method)
{
	return mapped(samplesOf(method.method, method.variants, layersOf(method)).samples,
				  [](const glm::vec4& sample) {
					  return Sample{sample.x, sample.y, sample.z, sample.w};
				  });
}

std::vector<Sample> texelsOf(const ModuleMethod& method)
{
	const std::vector<Sample> rows = rowsOf(method);
	const std::size_t count = method.variants.front().count();
	const std::size_t variants = method.variants.size();
	return listOf(rows.size(), [&](std::size_t i) { return rows[i % variants * count + i / variants]; });
}

bool readsNormals(const ModuleSettings& settings)
{
	FunctionWriter writer(screenKernels());
	functionsOf(settings, writer);
	return writer.uses(kNormal);
}

std::string moduleGlsl(const ModuleSettings& settings, const EmitContext& context)
{
	if (settings.target == GlslTarget::wgsl)
	{
		return moduleWgsl(settings, context);
	}
	const bool makes_normals = settings.normals_from_depth && readsNormals(settings);
	FunctionWriter writer(screenKernels());
	// Functions that inputs depend on come before them, all others after.
	const std::string of_device = settings.device_depth ? writer.add(kLinear, {}) : "";
	const std::string of_normals = makes_normals ? writer.add(kNormalFromDepth, {}) : "";
	const std::string functions = functionsOf(settings, writer);
	const auto textOf = [&](const Input& input)
	{
		const bool made = makes_normals && std::string_view(kNormal) == input.function;
		return (made ? of_normals : "") + inputText(settings, input, made);
	};
	const auto isUsed = [&](const Input& input)
	{
		return writer.uses(input.function) || (settings.device_depth && &input == &kInputs[0]);
	};
	std::string inputs = of_device + joinedText(itemsWhere(kInputs, isUsed), "", textOf);
	inputs += joinedText(kPassInputs, "",
						 [&](const PassInput& input) { return writer.uses(input.function) ? passInputText(settings, input) : ""; });
	const bool whole = settings.main.has_value();
	const std::string guard = guardOf(settings) + (isHlsl(settings) ? "_HLSL" : "_GLSL");
	const std::string head = commentBlock(notesOf(context, {}), "// ");
	const std::string text = introductionOf(settings) + writer.credits() +
							 (whole ? "" : "#ifndef " + guard + "\n#define " + guard + "\n") + headOf(settings) +
							 "#ifndef NOOK_SKY\n#define NOOK_SKY 1e30\n#endif\n" + blockText(settings) +
							 (writer.uses("nook_pass") ? passText(settings) : "") + withIntegers(settings, inputs + functions) +
							 (whole ? mainText(settings) : "\n#endif // " + guard + "\n");
	return (whole ? kVersionLines[static_cast<std::size_t>(settings.target)] : "") + head +
		   (isHlsl(settings) ? toHlsl(text) : text);
}

std::string volumesGlsl(const AovTextSettings& settings, const EmitContext& context)
{
	ModuleSettings module;
	module.target = settings.target;
	const std::string text = headOf(module) + aovText(settings);
	return commentBlock(notesOf(context, {}), "// ") + volumesHead(settings) +
		   (settings.target == GlslTarget::wgsl ? volumesWgsl(text)
			: isHlsl(module)                    ? toHlsl(text)
												: text);
}

} // namespace nook
