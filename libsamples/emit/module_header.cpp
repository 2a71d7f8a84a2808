// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/block_layout.h"
#include "emit/module.h"
#include "emit/module_parts.h"
#include "emit/text.h"

namespace nook
{
namespace
{

std::string structText()
{
	checkBlockLayout();
	std::string members;
	std::string checks;
	std::size_t offset = 0;
	for (const BlockMember& member : blockMembers())
	{
		if (member.constant)
		{
			continue;
		}
		const std::string scalar = member.type[0] == 'i' ? "std::int32_t" : "float";
		members += "\t" + scalar + " " + member.name + "[4]; // " + member.meaning + "\n";
		checks += "static_assert(offsetof(nook_block, " + std::string(member.name) + ") == " + std::to_string(offset) +
				  ", \"std140\");\n";
		offset += 16;
	}
	return "// The uniform block nook_block, std140: copy it into your buffer as it is.\nstruct alignas(16) nook_block\n{\n" +
		   members + "};\nstatic_assert(sizeof(nook_block) == " + std::to_string(offset) + ", \"std140\");\n" + checks;
}

std::string settingsText()
{
	const ShadeSettings defaults;
	const auto line = [](const char* name, double value, const char* meaning)
	{
		return "\tdouble " + std::string(name) + " = " + doubleText(value) + "; // " + meaning + "\n";
	};
	return "struct nook_settings\n{\n"
		   "\tint width = 0; // of the depth buffer, pixels\n\tint height = 0;\n"
		   "\tint first_row_ndc_y = -1; // which edge row 0 of the pixels is at: -1 OpenGL and Vulkan, 1 Direct3D\n" +
		   line("radius", defaults.radius_m, "metres, or in the unit of your depths; > 0") +
		   line("sigma", defaults.sigma, "Alchemy: intensity, with lengths in units of the radius") +
		   line("contrast", defaults.contrast, "Alchemy: the power at the end") +
		   line("beta", defaults.beta, "Alchemy: bias, a share of the depth") +
		   line("epsilon", defaults.epsilon, "Alchemy: keeps the quotient finite, in squares of the radius") + "};\n";
}

constexpr std::string_view kFillHead =
	R"(// Fills the block from settings and a projection: 16 numbers, column by column, from view space (right-handed, looking down -z)
// to clip space; perspective or orthographic, reversed, infinite, off-centre, jittered. False, and nothing filled, where x or y of
// the picture depends on the other (a skew), or where a setting is out of range.
template <class number> inline bool nook_fill(nook_block& block, const number (&projection)[16], const nook_settings& settings)
{
	double p[16];
	for (int i = 0; i < 16; ++i)
	{
		p[i] = static_cast<double>(projection[i]);
	}
	const bool skewed = p[1] != 0.0 || p[3] != 0.0 || p[4] != 0.0 || p[7] != 0.0 || p[0] == 0.0 || p[5] == 0.0;
	const bool in_range = settings.width > 0 && settings.height > 0 && settings.radius > 0.0 &&
						  (settings.first_row_ndc_y == -1 || settings.first_row_ndc_y == 1);
	if (skewed || !in_range)
	{
		return false;
	}
	const double width = settings.width;
	const double height = settings.height;
	const double first_row = settings.first_row_ndc_y;
)";

std::string fillText()
{
	std::string text(kFillHead);
	for (const BlockMember& member : blockMembers())
	{
		for (std::size_t i = 0; i < 4 && !member.constant; ++i)
		{
			const std::string scalar = member.type[0] == 'i' ? "std::int32_t" : "float";
			const std::string value = member.fill[i];
			text += "\tblock." + std::string(member.name) + "[" + std::to_string(i) +
					"] = " + (value == "0" ? "0;\n" : "static_cast<" + scalar + ">(" + value + ");\n");
		}
	}
	return text + "\treturn true;\n}\n";
}

std::string tileText(const ModuleMethod& method)
{
	const MethodRow& row = rowOf(method.method);
	const std::string width = std::to_string(method.variants.size());
	const std::string height = std::to_string(method.variants.front().count());
	std::string text = "\n// Texels of the texture " + std::string(row.stem) + "_tile: RGBA, 32-bit floats, " + width + " x " +
					   height + ", for texelFetch.\ninline constexpr int " + row.stem + "_tile_width = " + width +
					   ";\ninline constexpr int " + row.stem + "_tile_height = " + height + ";\ninline constexpr float " +
					   row.stem + "_tile[" + std::to_string(method.variants.size() * method.variants.front().count()) +
					   "][4] = {\n";
	for (const Sample& texel : texelsOf(method))
	{
		text += "\t{" + floatText(texel[0]) + "f, " + floatText(texel[1]) + "f, " + floatText(texel[2]) + "f, " +
				floatText(texel[3]) + "f},\n";
	}
	return text + "};\n";
}

} // namespace

std::string moduleHeader(const ModuleSettings& settings, const EmitContext& context)
{
	std::string tiles;
	for (const ModuleMethod& method : settings.methods)
	{
		tiles += fromTexture(settings, method) ? tileText(method) : "";
	}
	const std::string guard = guardOf(settings) + "_H";
	return commentBlock(notesOf(context, {}), "// ") +
		   "// For C++17 and later. Every GLSL module of this version of nook has this block.\n#ifndef " + guard + "\n#define " +
		   guard + "\n\n#include <cstddef>\n#include <cstdint>\n\n#ifndef NOOK_BLOCK_H\n#define NOOK_BLOCK_H\n\n" + structText() +
		   "\n" + settingsText() + "\n" + fillText() + "\n#endif // NOOK_BLOCK_H\n" + tiles + "\n#endif // " + guard + "\n";
}

} // namespace nook
