// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/decimal.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/text.h"
#include "page/assets.h"
#include "page/page_fill.h"
#include "study/error_report.h"

#include <nlohmann/json.hpp>

#include <cassert>
#include <filesystem>
#include <utility>

namespace nook
{
namespace
{

using Json = nlohmann::ordered_json;

std::vector<std::pair<std::string, std::string>> readingText(const ErrorReport& report)
{
	return {
		{"reference",
		 "Rays over the hemisphere, cosine-weighted, whose hits darken by 1 − distance / radius: " + std::to_string(report.rays) +
			 " a pixel. Its own standard error is below each chart; what errs by no more than that cannot be told apart."},
		{"eq. 14",
		 "AOV's error of 8-bit visibility: MSE of log†T, and half the MSE of log† of each of its two slopes. Pixels with a surface "
		 "alone count, in all errors."},
		{"time",
		 "Median of " + std::to_string(report.repetitions) +
			 " drawings after one that warms up, all passes, filters too (volumes that take over half a second: of one); "
			 "the bar on a mark of the front spans the quartiles. By "
			 "the GPU's own timers; by the clock on a renderer that draws on a CPU. Rays: Embree on the CPU, by the clock. Making "
			 "the "
			 "G-buffer, the patterns and the volumes, and sending them to the GPU, is not in it."},
		{"nook's forms",
		 "Patterns that descend on the error itself, and a variant of them for each pixel of 4 × 4, made together (tile); the "
		 "filter of 5 taps that goes with them, or the window; half resolution with reconstruction; StatVO that skips what "
		 "is smooth (skip); volumes that are merged, dropped, trimmed and fitted to the level (built), or masks of directions "
		 "over them (aov-mask)."},
		{"papers' recipes",
		 "VO: repelled samples of equal weight, one pattern reflected at random in 4 × 4 pixels and an edge-aware blur "
		 "(electro, window). Alchemy: independent samples, two passes of 13 taps (uniform, bilateral-13). StatVO: 1 to 4 "
		 "adaptive layers, tables of whole, half or quarter pictures, no filter. AOV: a volume a triangle, all of them, the "
		 "paper's curve (triangles), every pixel or one of 9 or 25 (third, fifth). And the methods that these papers compare "
		 "with (docs/reference/comparison.md)."},
		{"radius", "The same for all: volumetric methods take 1.1 times the rays' radius, volumes 0.6 times, as in AOV's own "
				   "comparison (§6); "
				   "no other setting is fitted to a view. 'thick' gives surfaces a thickness of half the radius (VO §4.3)."},
		{"RMSE, best strength",
		 "What is left once the obscurance has been multiplied by the factor that fits best: methods differ in how dark "
		 "they are, which one number mends."},
		{"front",
		 "What no other candidate beats in both time and error. The share of budgets: of the logarithm of time, from the fastest "
		 "candidate to the slowest of the front, where the best of nook's forms errs no more than the best recipe of the papers."},
		{"flicker", "Only of the front and of what is pictured. The views lie on a lattice within one pixel."},
	};
}

} // namespace

std::string errorReportHtml(std::span<const ErrorReport> reports, const std::string& version)
{
	assert(!reports.empty());
	const Json data{{"reports", mapped(reports, errorReportFields)}, {"reading", readingText(reports.front())}};
	return pageHtml({"run time against error",
					 version,
					 assets::error_html,
					 {assets::error_css},
					 {assets::charts_js, assets::error_charts_js, assets::error_pictures_js, assets::error_page_js},
					 jsonLine(data)});
}

// The command that measures a report again.

std::string errorReportCommand(const ErrorReportSettings& settings)
{
	const ErrorReportSettings defaults;
	const auto nameOfLevel = [](const std::string& level)
	{
		return " " + shellWord(level.starts_with("builtin:") ? level : std::filesystem::path(level).filename().string());
	};
	std::string text = "nook report error" + joinedText(settings.levels, "", nameOfLevel);
	text += loadOptions(settings.load) + " --grid " + std::string(nameOf(settings.grid));
	text += settings.methods.empty() ? "" : " --methods " + joinedText(settings.methods, ",");
	text += settings.automatic > 0    ? " --camera auto:" + std::to_string(settings.automatic)
			: settings.camera.empty() ? ""
									  : " --camera " + shellWord(settings.camera);
	text += " --size " + std::to_string(settings.width_px) + "x" + std::to_string(settings.height_px) + " --rays " +
			std::to_string(settings.rays);
	text += settings.radius_m > 0.0 ? " --radius " + numberText(settings.radius_m) : "";
	text += " --repetitions " + std::to_string(settings.measure.repetitions);
	text += settings.measure.device == Device::cpu ? " --device cpu" : "";
	text += settings.measure.gl_device ? " --gl-device " + std::to_string(*settings.measure.gl_device) : "";
	text += settings.pictures != defaults.pictures ? " --pictures " + std::to_string(settings.pictures) : "";
	text += settings.measure.slowest_s != kSlowestPicture_s ? " --slowest " + numberText(settings.measure.slowest_s) : "";
	text += settings.shifts != defaults.shifts ? " --shifts " + std::to_string(settings.shifts) : "";
	return text;
}

std::string loadOptions(const LoadSettings& load)
{
	std::string text = load.unit_m > 0.0 ? " --unit " + numberText(load.unit_m) : "";
	text += load.up == UpAxis::file ? "" : std::string(" --up ") + "xyz"[static_cast<std::size_t>(load.up) - 1];
	text += load.max_texels == kMaxTexels ? "" : " --max-texels " + std::to_string(load.max_texels);
	text += load.pose == Pose::rest ? " --pose rest" : "";
	text += joinedText(load.ignore, "", [](const std::string& pattern) { return " --ignore " + shellWord(pattern); });
	text += load.tr == TrMeaning::automatic ? "" : load.tr == TrMeaning::opacity ? " --tr opacity" : " --tr transparency";
	return text + (load.strict ? " --strict" : "") + (load.allow_outside ? " --allow-outside" : "");
}

} // namespace nook
