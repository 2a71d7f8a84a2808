// SPDX-License-Identifier: GPL-3.0-or-later
#include "statvo_options.h"

#include "options.h"

#include "core/error.h"

#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 3> kBuilders{"automatic", "compute", "fragments"};

} // namespace

void addStatVoOptions(CLI::App& app, StatVoSettings& settings, std::vector<MethodOption>& options)
{
	const auto add = [&options](CLI::Option* option)
	{
		options.push_back({option, {ShadeMethod::statvo}});
	};
	add(addWhole(app, "--layers", settings.layers, 1, 64, "StatVO: layers of depth, 1, 2 or 4 (default); uniform: 1 to 64"));
	add(addChoiceText(
		app, "--layering", kLayerings, [&settings](std::size_t i) { settings.layering = static_cast<StatVoLayering>(i); },
		"StatVO: adaptive (default), by the mean depth around each pixel; or uniform, equal parts of the picture's depths"));
	add(app.add_flag("--quadrants", settings.quadrants, "StatVO: four parts of the box by themselves; better, and dearer"));
	add(addChoiceText(
		app, "--tables", kStatVoTables, [&settings](std::size_t i) { settings.cell_px = 1 << i; },
		"StatVO: summed-area tables of full (default), half or quarter width and height"));
	add(addNumber(app, "--slope", settings.slope, 1e-3, 1e3,
				  "StatVO: how fast what is farther in front than the box is high stops counting, per height (default 1)"));
	add(addNumber(app, "--height", settings.height, 0.05, 100.0,
				  "StatVO: height of the box over the surface, in radii (default 1)"));
	add(addWhole(app, "--largest", settings.largest_px, 1, 255,
				 "StatVO: half side of the box in the picture at most, in pixels; smaller boxes near the camera, and coarser "
				 "tables the larger it is (default 127)"));
	add(addChoiceText(
		app, "--skip", kSkips, [&settings](std::size_t i) { settings.skip = i == 0; },
		"StatVO: looks at no layers where a surface is smooth, which changes nothing that shows (default yes)"));
	add(addChoiceText(
		app, "--tables-by", kBuilders, [&settings](std::size_t i) { settings.builder = static_cast<TableBuilder>(i); },
		"StatVO, --device gl: sums by compute shaders or by fragments; automatic (default): compute shaders where a GPU has them"));
}

void checkStatVo(const StatVoSettings& settings)
{
	const bool adaptive = settings.layering == StatVoLayering::adaptive;
	if (adaptive && settings.layers != 1 && settings.layers != 2 && settings.layers != 4)
	{
		refuseValue("--layers", std::to_string(settings.layers), "1, 2 or 4, or --layering uniform");
	}
}

std::string layersText(const StatVoSettings& settings)
{
	const std::string tables(kStatVoTables[static_cast<std::size_t>(settings.cell_px / 2)]);
	return std::to_string(settings.layers) + " " + std::string(kLayerings[static_cast<std::size_t>(settings.layering)]) +
		   (settings.layers == 1 ? " layer, " : " layers, ") + tables + " tables" + (settings.quadrants ? ", quadrants" : "");
}

} // namespace nook
