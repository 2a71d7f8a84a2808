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
std::string settingsText(const ModuleMethod& method)
{
	const MethodRow& row = rowOf(method.method);
	const std::string assignment = "\tsettings.";
	const std::string once = macroOf(row) + "_SETTINGS";
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

} // namespace

std::string moduleHeader(const ModuleSettings& settings, const EmitContext& context)
{
	std::string tiles;
	for (const ModuleMethod& method : settings.methods)
	{
		tiles += method.recipe ? settingsText(method) : "";
		tiles += fromTexture(settings, method) ? tileText(method) : "";
	}
	const std::string guard = guardOf(settings) + "_H";
	const std::string_view block = assets::nook_block_h;
	return commentBlock(notesOf(context, {}), "// ") +
		   "// For C++17 and later. Every GLSL module of this version of nook has this block.\n#ifndef " + guard + "\n#define " +
		   guard + "\n\n" + std::string(block.substr(block.find("#ifndef"))) + tiles + "\n#endif // " + guard + "\n";
}

} // namespace nook
