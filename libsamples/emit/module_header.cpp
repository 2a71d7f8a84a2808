// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/text.h"
#include "emit/module.h"
#include "emit/module_parts.h"
#include "methods/block_layout.h"

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
		   "\tint width = 0; // of the picture that the projection makes, pixels\n\tint height = 0;\n"
		   "\tint x = 0; // its first pixel in the textures, as texelFetch counts\n\tint y = 0;\n"
		   "\tint guard = 0; // pixels around it that hold depth and normals, too\n"
		   "\tint first_row_ndc_y = -1; // which edge row 0 of the pixels is at: -1 OpenGL and Vulkan, 1 Direct3D\n" +
		   line("radius", defaults.radius_m, "metres, or in the unit of your depths; > 0") +
		   line("most_pixels", 0.0, "greatest radius in the picture, near the camera; 0: the height of the picture") +
		   line("least_pixels", 0.0, "least radius in the picture, far away") +
		   "\tbool device_depth = false; // of a module emitted with --depth device\n"
		   "\tbool zero_to_one = false; // device depth: NDC z from 0 to 1 (Vulkan, Direct3D, Metal), else from -1\n"
		   "\tint depth_bits = 32; // 16, 24 or 32; device depth of 16 and 24 bits: whole numbers; all others: floats\n"
		   "\tint normal_bits = 32; // of a component: 8 to 16, or 32\n" +
		   line("second_radius", 0.0, "of a module with two radii; 0: as the first") +
		   line("thickness", 0.0, "of a module with a thickness: of surfaces, in the unit of the radius") +
		   line("first_band", defaults.bands.first_px,
				"of a module with bands: radius in pixels below which the first band is enough") +
		   line("second_band", defaults.bands.second_px, "of a module with three bands: below which the first two are") +
		   line("box_height", defaults.statvo.height, "StatVO: of the box over the surface, in radii") +
		   line("slope", defaults.statvo.slope, "StatVO: how fast what is farther in front stops counting, per height") +
		   line("largest_pixels", defaults.statvo.largest_px, "StatVO: half side of the box in the picture at most; 255 or less") +
		   line("slice_thickness", defaults.slices.thickness, "slices: of surfaces, in radii") +
		   line("sigma", defaults.sigma, "Alchemy: intensity, with lengths in units of the radius") +
		   line("contrast", defaults.contrast, "Alchemy: the power at the end") +
		   line("beta", defaults.beta, "Alchemy: bias, a share of the depth") +
		   line("epsilon", defaults.epsilon, "Alchemy: keeps the quotient finite, in squares of the radius") + "};\n";
}

constexpr std::string_view kFillHead =
	R"(// Fills the block from settings and a projection: 16 numbers, column by column, from view space (right-handed, looking down -z)
// to clip space; perspective or orthographic, reversed, infinite, off-centre, jittered. False, and nothing filled, where x or y of
// the picture depends on the other (a skew), where a setting is out of range, or with device depth where z depends on x or y.
template <class number> inline bool nook_fill(nook_block& block, const number (&projection)[16], const nook_settings& settings)
{
	double p[16];
	for (int i = 0; i < 16; ++i)
	{
		p[i] = static_cast<double>(projection[i]);
	}
	const bool skewed = p[1] != 0.0 || p[3] != 0.0 || p[4] != 0.0 || p[7] != 0.0 || p[0] == 0.0 || p[5] == 0.0;
	const bool bits = (settings.depth_bits == 16 || settings.depth_bits == 24 || settings.depth_bits == 32) &&
					  ((settings.normal_bits >= 8 && settings.normal_bits <= 16) || settings.normal_bits == 32);
	const bool in_range = settings.width > 0 && settings.height > 0 && settings.guard >= 0 && settings.radius > 0.0 &&
						  settings.most_pixels >= 0.0 && settings.least_pixels >= 0.0 &&
						  settings.box_height > 0.0 && settings.slope > 0.0 && settings.largest_pixels >= 1.0 &&
						  settings.largest_pixels <= 255.0 && settings.second_radius >= 0.0 && settings.thickness >= 0.0 &&
						  settings.first_band >= 0.0 && settings.second_band >= 0.0 && settings.sigma >= 0.0 &&
						  settings.contrast > 0.0 && settings.slice_thickness > 0.0 && settings.beta >= 0.0 && settings.epsilon > 0.0 &&
						  settings.least_pixels <= (settings.most_pixels > 0.0 ? settings.most_pixels : settings.height) &&
						  (settings.first_row_ndc_y == -1 || settings.first_row_ndc_y == 1);
	if (skewed || !in_range || !bits)
	{
		return false;
	}
	const double width = settings.width;
	const double height = settings.height;
	// StatVO: what is so far away that the box would be smaller needs finer tables.
	const double longer = (width > height ? width : height) + 2.0 * settings.guard;
	const double reach = 2.0 * settings.largest_pixels + 2.0;
	const double table_steps = std::fmin(4294967295.0 / (reach * reach), 4194304.0);
	const double least_box = std::fmax(0.5, std::sqrt(191.0 * longer / (table_steps * settings.box_height)));
	const double first_row = settings.first_row_ndc_y;
	const double most_pixels = settings.most_pixels > 0.0 ? settings.most_pixels : height;
	const double normal_error =
		settings.normal_bits == 32 ? 0.0 : std::sqrt(3.0) / (std::ldexp(1.0, settings.normal_bits) - 1.0);
	// z of the clip space is scale * device + least; a step of it is a length of w * w / |det|, and grows toward the far end.
	double far_end = 0.0;
	double turn = 0.0;
	double above = 0.0;
	double below = 0.0;
	double near_end = 1.0;
	double half_step = 0.0;
	double rounding = settings.depth_bits == 16 ? 0x1p-11 : 0x1p-24;
	if (settings.device_depth)
	{
		const double det = p[10] * p[15] - p[11] * p[14];
		const double scale = settings.zero_to_one ? 1.0 : 2.0;
		const double least = settings.zero_to_one ? 0.0 : -1.0;
		far_end = det < 0.0 ? 1.0 : 0.0;
		turn = det < 0.0 ? -scale : scale;
		above = p[14] - p[15] * (least + far_end * scale);
		below = p[10] - p[11] * (least + far_end * scale);
		near_end = below - p[11] * turn;
		if (!std::isfinite(det) || det == 0.0 || near_end == 0.0 || p[2] != 0.0 || p[6] != 0.0)
		{
			return false;
		}
		const double steps = settings.depth_bits == 32 ? 0.0 : 0.5 / (std::ldexp(1.0, settings.depth_bits) - 1.0);
		half_step = (steps + far_end * 0x1p-25) * scale / std::fabs(det) + (p[15] == 0.0 ? 0.0 : 0x1p-22 * std::fabs(above / near_end));
		rounding = 0x1.8p-22;
	}
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
		   guard +
		   "\n\n#include <cmath>\n#include <cstddef>\n#include <cstdint>\n\n#ifndef NOOK_BLOCK_H\n#define NOOK_BLOCK_H\n\n" +
		   structText() + "\n" + settingsText() + "\n" + fillText() + "\n#endif // NOOK_BLOCK_H\n" + tiles + "\n#endif // " +
		   guard + "\n";
}

} // namespace nook
