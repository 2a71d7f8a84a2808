// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/number.h"
#include "core/text.h"
#include "emit/module.h"
#include "emit/module_parts.h"
#include "methods/assets.h"

namespace nook
{
namespace
{

std::string tileText(const ModuleMethod& method)
{
	const std::string stem = stemOf(rowOf(method.method));
	const std::string width = std::to_string(method.variants.size());
	const std::string height = std::to_string(method.variants.front().count());
	std::string text = "\n// Texels of the texture " + stem + "_tile: RGBA, 32-bit floats, " + width + " x " + height +
					   ", for texelFetch.\ninline constexpr int " + stem + "_tile_width = " + width + ";\ninline constexpr int " +
					   stem + "_tile_height = " + height + ";\ninline constexpr float " + stem + "_tile[" +
					   std::to_string(method.variants.size() * method.variants.front().count()) + "][4] = {\n";
	for (const Sample& texel : texelsOf(method))
	{
		text += "\t{" + floatText(texel[0]) + "f, " + floatText(texel[1]) + "f, " + floatText(texel[2]) + "f, " +
				floatText(texel[3]) + "f},\n";
	}
	return text + "};\n";
}

// What fills the settings of a recipe.
std::string settingsText(const ModuleMethod& method, const std::string& guard_end)
{
	const MethodRow& row = rowOf(method.method);
	const std::string assignment = "\tsettings.";
	const std::string once = macroOf(row) + "_SETTINGS" + guard_end;
	std::string text = "\n#ifndef " + once + " // of several headers with this method the first one's\n#define " + once +
					   "\n// Settings of " + std::string(entryOf(row)) +
					   " for rays that reach so far, in the unit of your depths; the picture's size is still to be set.\n" +
					   "inline nook_settings " + stemOf(row) + "_settings(double reach)\n{\n\tnook_settings settings;\n" +
					   assignment + "radius = " + numberText(method.recipe->radius) + " * reach;\n";
	for (const RecipeValue& one : method.recipe->values)
	{
		if (one.feature->kind == FeatureKind::number && !one.feature->setting.empty())
		{
			text += assignment + std::string(one.feature->setting) + " = " + numberText(one.value) +
					(isLength(*one.feature) ? " * reach;\n" : ";\n");
		}
	}
	return text + "\treturn settings;\n}\n#endif\n";
}

// A block of floats alone, of a name of its own: in one program with others each has its own nook_fill.
std::string floatBlockText(const ModuleSettings& settings)
{
	std::string members;
	std::string numbers;
	for (const BlockMember& member : blockMembers())
	{
		const std::string name = member.name;
		const std::string type = typeOf(settings, member);
		const std::string size = type == "float" ? "" : "[" + type.substr(3) + "]";
		members += "\tfloat " + name + size + "; // " + member.meaning + "\n";
		for (int i = 0; type != member.type && i < type.back() - '0'; ++i)
		{
			const std::string place = name + "[" + std::to_string(i) + "]";
			numbers += "\tblock." + place + " = static_cast<float>(whole." + place + ");\n";
		}
	}
	return "\n#ifndef NOOK_FLOAT_BLOCK_H\n#define NOOK_FLOAT_BLOCK_H\n\n#include <cstring>\n\n"
		   "// What modules of --block floats have in place of nook_block: the same, but that integers are floats.\n"
		   "struct alignas(16) nook_float_block\n{\n" +
		   members +
		   "};\nstatic_assert(sizeof(nook_float_block) == sizeof(nook_block), \"std140\");\n\n"
		   "template <class number>\n"
		   "inline bool nook_fill(nook_float_block& block, const number (&projection)[16], const nook_settings& settings)\n"
		   "{\n\tnook_block whole{};\n\tif (!nook_fill(whole, projection, settings))\n\t{\n\t\treturn false;\n\t}\n"
		   "\tstd::memcpy(&block, &whole, sizeof block);\n" +
		   numbers + "\treturn true;\n}\n\n#endif // NOOK_FLOAT_BLOCK_H\n";
}

} // namespace

std::string moduleHeader(const ModuleSettings& settings, const EmitContext& context)
{
	const std::string& space = settings.header_namespace;
	const std::string guard_end = space.empty() ? "" : "_" + space;
	std::string tiles;
	for (const ModuleMethod& method : settings.methods)
	{
		tiles += method.recipe ? settingsText(method, guard_end) : "";
		tiles += fromTexture(settings, method) ? tileText(method) : "";
	}
	if (!space.empty() && !tiles.empty())
	{
		tiles = "\nnamespace " + space + "\n{\n" + tiles + "\n} // namespace " + space + "\n";
	}
	const std::string guard = guardOf(settings) + "_H" + guard_end;
	const std::string_view block = assets::nook_block_h;
	return commentBlock(notesOf(context, {}), "// ") +
		   "// For C++17 and later. Every GLSL module of this version of nook has this block" +
		   (settings.float_block ? ", or with --block floats nook_float_block" : "") + ".\n#ifndef " + guard + "\n#define " +
		   guard + "\n\n" + std::string(block.substr(block.find("#ifndef"))) +
		   (settings.float_block ? floatBlockText(settings) : "") + tiles + "\n#endif // " + guard + "\n";
}

} // namespace nook
