// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/module.h"

#include "core/error.h"
#include "emit/block_layout.h"
#include "emit/kernel_text.h"
#include "emit/module_parts.h"
#include "emit/source_text.h"
#include "shade/assets.h"
#include "shade/block.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <regex>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 4> kTargets{"330", "430", "es300", "vulkan"};
constexpr std::array kMethods{
	MethodRow{ShadeMethod::vo_line, "vo-line", "nookVoLine", "nook_vo_line", "NOOK_VO_LINE", "volumetric obscurance by lines", 3},
	MethodRow{ShadeMethod::vo_point, "vo-point", "nookVoPoint", "nook_vo_point", "NOOK_VO_POINT", "volumetric obscurance by points",
			  4},
	MethodRow{ShadeMethod::alchemy, "alchemy", "nookAlchemy", "nook_alchemy", "NOOK_ALCHEMY", "Alchemy ambient obscurance", 5},
};
constexpr std::array<std::string_view, 3> kMethodNames{kMethods[0].option, kMethods[1].option, kMethods[2].option};

// After the methods, in a pass of its own.
constexpr MethodRow kWindow{ShadeMethod::vo_line, "window", "nookWindow", "nook_window", "NOOK_WINDOW", "", 0};

// Of device depth.
constexpr MethodRow kLinear{ShadeMethod::vo_line, "", "nookLinear", "", "", "", 0};

// What kernels take from whoever includes them, by textures. An engine may define the macro first and read what it has.
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
		  "Depth along the view direction, > 0, linear; NOOK_SKY or more where there is no surface."},
	Input{"nookNormal", "vec3", "NOOK_NORMAL", "nook_normals", "NOOK_NORMALS", ".xyz", 2,
		  "Unit normal in view space: x right, y up, z toward the camera."},
	Input{"nookVisibility", "float", "NOOK_VISIBILITY", "nook_cells", "NOOK_CELLS", ".r", 6, "Visibility as a method drew it."},
};

bool hasBindings(GlslTarget target)
{
	return target == GlslTarget::gl430 || target == GlslTarget::vulkan;
}

std::string setOf(GlslTarget target)
{
	return target == GlslTarget::vulkan ? "set = NOOK_SET, " : "";
}

// Where the target has binding numbers: a macro that an engine may define first.
std::string bindingMacro(GlslTarget target, const std::string& name, int number)
{
	return hasBindings(target) ? "#ifndef " + name + "\n#define " + name + " " + std::to_string(number) + "\n#endif\n" : "";
}

std::string samplerText(GlslTarget target, const std::string& macro, const std::string& sampler, int binding)
{
	const std::string number = macro + "_BINDING";
	const std::string layout = hasBindings(target) ? "layout(" + setOf(target) + "binding = " + number + ") " : "";
	return bindingMacro(target, number, binding) + layout + "uniform sampler2D " + sampler + ";\n";
}

// Depth as a depth buffer holds it, in place of the first input.
constexpr Input kDeviceDepth{"nookDepth",
							 "float",
							 "NOOK_DEPTH",
							 "nook_depths",
							 "NOOK_DEPTHS",
							 ".r",
							 1,
							 "What a depth buffer holds, 0 to 1; its far end is sky."};

std::string inputText(GlslTarget target, const Input& input)
{
	const std::string macro = input.macro;
	const std::string value = macro + "(pixel)";
	const bool device = &input == &kDeviceDepth;
	return "\n// " + std::string(input.meaning) + "\n// Define " + macro + "(pixel) first to read yours in another way.\n#ifndef " +
		   macro + "\n" + samplerText(target, input.binding_macro, input.sampler, input.binding) + "#define " + macro +
		   "(pixel) texelFetch(" + input.sampler + ", pixel, 0)" + input.channels + "\n#endif\n" + input.type + " " +
		   input.function + "(ivec2 pixel)\n{\n\treturn " + (device ? "nookLinear(" + value + ")" : value) + ";\n}\n";
}

std::string blockText(GlslTarget target)
{
	checkBlockLayout();
	const std::string layout =
		"layout(" + setOf(target) + "std140" + (hasBindings(target) ? ", binding = NOOK_BLOCK_BINDING" : "") + ")";
	std::string text = "\n// Lengths are in metres, or whatever unit your depths have.\n" +
					   bindingMacro(target, "NOOK_BLOCK_BINDING", 0) + layout + " uniform nook_block\n{\n";
	for (const BlockMember& member : blockMembers())
	{
		text += member.constant ? "" : "\t" + std::string(member.type) + " " + member.name + "; // " + member.meaning + "\n";
	}
	return text + "} nook;\n";
}

std::string headOf(GlslTarget target)
{
	switch (target)
	{
	case GlslTarget::gl330: return "#if __VERSION__ < 330\n#error nook: this module needs #version 330 or later\n#endif\n";
	case GlslTarget::gl430: return "#if __VERSION__ < 430\n#error nook: this module needs #version 430 or later\n#endif\n";
	case GlslTarget::es300:
		return "#if !defined(GL_ES) || __VERSION__ < 300\n#error nook: this module needs #version 300 es or later\n#endif\n"
			   "// Depths need them. What follows in your shader has them too, unless it says otherwise.\n"
			   "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n";
	case GlslTarget::vulkan: break;
	}
	return "#if !defined(VULKAN) || __VERSION__ < 450\n#error nook: this module needs #version 450 or later, and Vulkan\n#endif\n"
		   "#ifndef NOOK_SET\n#define NOOK_SET 0 // descriptor set of all that the module binds\n#endif\n";
}

std::string versionLine(GlslTarget target)
{
	constexpr std::array<const char*, 4> lines{"#version 330 core\n", "#version 430 core\n", "#version 300 es\n", "#version 450\n"};
	return lines[static_cast<std::size_t>(target)];
}

// The samples of a method, and how its kernel reaches them.
std::string samplesText(const ModuleSettings& settings, const ModuleMethod& method)
{
	const MethodRow& row = rowOf(method.method);
	const std::string count = std::to_string(method.variants.front().count());
	const std::string name = std::string(row.stem) + "_samples";
	const std::string function = std::string(row.entry) + "Sample";
	const int window = windowOf(method);
	const std::string side = std::to_string(window);
	std::string text = "\n// " + std::string(columnsOf(method.variants.front().domain)) + " of each sample, for a radius of 1";
	if (fromTexture(settings, method))
	{
		const std::string sampler = std::string(row.stem) + "_tile";
		text += ": RGBA, 32-bit floats, " + std::to_string(window * window) + " x " + count + " texels.\n";
		text += samplerText(settings.target, std::string(row.macro) + "_TILE", sampler, row.tile_binding);
		text += "vec4 " + function + "(int row, int i)\n{\n\treturn texelFetch(" + sampler + ", ivec2(row, i), 0);\n}\n";
	}
	else
	{
		const std::vector<Sample> rows = rowsOf(method);
		const std::string size = "[" + std::to_string(rows.size()) + "]";
		text += window > 1 ? ", one variant after the other.\n" : ".\n";
		text += "const vec4 " + name + size + " = vec4" + size + "(\n";
		for (std::size_t i = 0; i < rows.size(); ++i)
		{
			text += "\tvec4(" + rowText(rows[i]) + (i + 1 < rows.size() ? "),\n" : "));\n");
		}
		const std::string at = window > 1 ? "row * " + count + " + i" : "i";
		text += "vec4 " + function + (window > 1 ? "(int row, int i)" : "(int i)") + "\n{\n\treturn " + name + "[" + at + "];\n}\n";
	}
	if (window > 1)
	{
		text += "int " + std::string(row.entry) + "Variant(ivec2 pixel)\n{\n\treturn (pixel.y % " + side + ") * " + side +
				" + pixel.x % " + side + ";\n}\n";
	}
	return text;
}

// The functions of one method after the other, each with the method's constants in it.
class FunctionWriter
{
public:
	explicit FunctionWriter(const KernelText& kernels) : m_kernels(kernels) {}

	// Appends what the method needs and is not yet there.
	std::string add(const MethodRow& row, int window, const std::map<std::string, std::string>& constants)
	{
		std::map<std::string, std::string> texts; // of what is reached
		reach(row.entry, constants, texts);
		if (texts.empty())
		{
			throw Error(ExitCode::runtime, std::string("kernels: found no ") + row.entry + ", expected one in shade/*.glsl");
		}
		std::map<std::string, std::string> names{{"nookSample", std::string(row.entry) + "Sample"},
												 {"nookVariant", std::string(row.entry) + "Variant"}};
		std::string result;
		for (const KernelFunction& function : m_kernels.functions)
		{
			const auto found = texts.find(function.name);
			if (found == texts.end())
			{
				continue;
			}
			std::string text = renamed(window == 1 ? withoutRow(found->second) : found->second, names);
			const auto [there, fresh] = m_written.emplace(function.name, text);
			if (!fresh && there->second == text)
			{
				continue;
			}
			if (!fresh) // another method has it with other constants
			{
				names[function.name] = function.name + "Of" + std::string(row.entry).substr(4);
				text = renamed(text, names);
			}
			m_credits.insert(function.credit);
			result += "\n" + function.comment + text;
		}
		return result;
	}

	bool uses(std::string_view name) const
	{
		return m_used.contains(std::string(name));
	}
	std::string credits() const
	{
		std::string text;
		for (const std::size_t credit : m_credits)
		{
			text += "//\n" + m_kernels.credits[credit];
		}
		return text;
	}

private:
	void reach(const std::string& name, const std::map<std::string, std::string>& constants,
			   std::map<std::string, std::string>& texts)
	{
		m_used.insert(name);
		for (const KernelFunction& function : m_kernels.functions)
		{
			if (function.name == name && !texts.contains(name))
			{
				const std::string text = specialised(function.text, constants);
				texts[name] = text;
				for (const std::string& used : identifiersOf(text))
				{
					reach(used, constants, texts);
				}
			}
		}
	}

	// With one variant there is no row to choose.
	static std::string withoutRow(const std::string& text)
	{
		static const std::regex call(R"(\bnookSample\(\w+, )");
		static const std::regex variant(R"(\bnookVariant\(\w+\))");
		return specialised(std::regex_replace(std::regex_replace(text, call, "nookSample("), variant, "0"), {});
	}

	const KernelText& m_kernels;
	std::map<std::string, std::string> m_written;
	std::set<std::string> m_used;
	std::set<std::size_t> m_credits;
};

ShadeBlock blockFor(const ModuleSettings& settings, const ModuleMethod& method)
{
	ShadeSettings shade;
	shade.method = method.method;
	shade.use_normal = settings.use_normal;
	shade.cut = settings.cut;
	GBuffer any; // what comes of it is no constant
	any.width_px = 1;
	any.height_px = 1;
	any.view.projection = glm::dmat4(1.0);
	return blockOf(any, samplesOf(method.method, method.variants), shade);
}

std::string introduction(const ModuleSettings& settings)
{
	std::string text = "//\n// Visibility, 1 where open, of the pixel of a depth buffer:\n";
	for (const ModuleMethod& method : settings.methods)
	{
		const MethodRow& row = rowOf(method.method);
		const int window = windowOf(method);
		text += "//   float " + std::string(row.entry) + "(ivec2 pixel): " + row.what + ", " +
				std::to_string(method.variants.front().count()) + " samples" +
				(window > 1 ? ", others in each pixel of " + std::to_string(window) + " x " + std::to_string(window) : "") + "\n";
	}
	text += settings.window_filter
				? "//   float nookWindow(ivec2 pixel): what one of these drew, as the mean over a window on the same surface\n"
				: "";
	text += "// Pixels count as texelFetch does. `nook emit -o FILE.h` writes the C++ that fills the block.\n";
	text += settings.main ? "" : "// Without #version, to be included after yours. All names begin with nook or NOOK.\n";
	return text;
}

std::string mainText(const ModuleSettings& settings)
{
	assert(settings.methods.size() == 1);
	return "\nlayout(location = 0) out float nook_visibility;\n\nvoid main()\n{\n\tnook_visibility = " +
		   std::string(rowOf(settings.methods.front().method).entry) + "(ivec2(gl_FragCoord.xy));\n}\n";
}

} // namespace

std::span<const std::string_view> glslTargets()
{
	return kTargets;
}

std::span<const std::string_view> moduleMethods()
{
	return kMethodNames;
}

ShadeMethod moduleMethod(std::size_t index)
{
	return kMethods[index].method;
}

std::string_view moduleNameOf(ShadeMethod method)
{
	return rowOf(method).option;
}

const MethodRow& rowOf(ShadeMethod method)
{
	const auto found =
		std::find_if(kMethods.begin(), kMethods.end(), [method](const MethodRow& row) { return row.method == method; });
	assert(found != kMethods.end());
	return *found;
}

int windowOf(const ModuleMethod& method)
{
	int side = 1;
	while (static_cast<std::size_t>(side * side) < method.variants.size())
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
	std::string guard = "NOOK";
	for (const ModuleMethod& method : settings.methods)
	{
		guard += std::string(rowOf(method.method).macro).substr(4);
	}
	return guard;
}

std::vector<Sample> rowsOf(const ModuleMethod& method)
{
	std::vector<Sample> rows;
	for (const Pattern& variant : method.variants)
	{
		const std::vector<Sample> samples = samplesOf(variant);
		rows.insert(rows.end(), samples.begin(), samples.end());
	}
	return rows;
}

std::vector<Sample> texelsOf(const ModuleMethod& method)
{
	const std::vector<Sample> rows = rowsOf(method);
	const std::size_t count = method.variants.front().count();
	std::vector<Sample> texels;
	for (std::size_t i = 0; i < rows.size(); ++i)
	{
		texels.push_back(rows[i % method.variants.size() * count + i / method.variants.size()]);
	}
	return texels;
}

std::string moduleGlsl(const ModuleSettings& settings, const EmitContext& context)
{
	const KernelText kernels =
		parseKernels({assets::camera_glsl, assets::depth_glsl, assets::vo_glsl, assets::alchemy_glsl, assets::reconstruct_glsl});
	FunctionWriter writer(kernels);
	std::string functions;
	for (const ModuleMethod& method : settings.methods)
	{
		functions += samplesText(settings, method) +
					 writer.add(rowOf(method.method), windowOf(method), constantsOf(blockFor(settings, method)));
	}
	if (settings.window_filter)
	{
		const ModuleMethod& tile = settings.methods.front();
		functions += writer.add(kWindow, windowOf(tile), constantsOf(blockFor(settings, tile)));
	}
	std::string inputs;
	if (settings.device_depth)
	{
		inputs = writer.add(kLinear, 1, {}) + inputText(settings.target, kDeviceDepth);
	}
	for (const Input& input : std::span(kInputs).subspan(settings.device_depth ? 1 : 0))
	{
		inputs += writer.uses(input.function) ? inputText(settings.target, input) : "";
	}
	const std::string guard = guardOf(settings) + "_GLSL";
	const std::string text = commentBlock(notesOf(context, {}), "// ") + introduction(settings) + writer.credits() +
							 (settings.main ? "" : "#ifndef " + guard + "\n#define " + guard + "\n") + headOf(settings.target) +
							 "#ifndef NOOK_SKY\n#define NOOK_SKY 1e30\n#endif\n" + blockText(settings.target) + inputs + functions +
							 (settings.main ? mainText(settings) : "\n#endif // " + guard + "\n");
	return (settings.main ? versionLine(settings.target) : "") + text;
}

} // namespace nook
