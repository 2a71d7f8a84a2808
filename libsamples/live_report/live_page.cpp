// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/command_words.h"
#include "core/json_text.h"
#include "core/number.h"
#include "core/system.h"
#include "live_report/live_parts.h"
#include "page/assets.h"
#include "page/page_fill.h"
#include "pattern/recipe.h"
#include "scene/camera_choice.h"

#include <filesystem>

namespace nook
{
namespace
{

// Less than where methods are compared: surfaces have no end, and what is near them shows best. Chosen by eye on builtin:suburb.
constexpr double kRadiusShare = 0.5;

template <class Enum> LiveJson choicesOf()
{
	LiveJson names = LiveJson::array();
	for (const std::string_view name : namesOf<Enum>())
	{
		names.push_back(name);
	}
	return names;
}

LiveJson readingOfPage()
{
	return {
		{"measures",
		 "Errors of the pattern over all half-spaces, as shares of the domain: plane is the whole error, noise the part that "
		 "changes "
		 "with a rotation, bias the part that does not. The figures are those of `nook info`, which reads the pattern again; the "
		 "catalogue's are the figures that its file holds."},
		{"relaxing",
		 "The points of the starting sets while `nook pattern` lowers their error: every step of the first start, some of the "
		 "others. The best one is kept. What is made has the bytes of the command below the picture, on any machine."},
		{"cells",
		 "Disk and hemisphere are seen along the view axis, the sphere from outside; each sample in its cell, shaded by its weight "
		 "(pale is lighter than average). The ball: its points, near ones large, with lines between neighbours of one shell; "
		 "beside "
		 "them its cells where the plane z = 0 cuts them."},
		{"visibility",
		 "White is open, black is occluded. Modules are those of `nook emit --glsl es300`; the program that runs above emits what "
		 "the page does not hold: your own pattern, surfaces with a thickness."},
		{"tile",
		 "Each pixel of 4 × 4 has samples of its own, made together so that the mean over the window is close to exact. Turned at "
		 "random: one pattern, reflected about a direction of its own in each of these pixels, as in the paper; everywhere the "
		 "same: "
		 "bands in place of noise. Unfiltered, the noise shows."},
		{"rays",
		 "Over the hemisphere, cosine-weighted; hits darken by 1 − distance / radius. Traced when the page was made, for its first "
		 "view. Volumetric methods take 1.1 times that radius. RMSE: over pixels with a surface."},
		{"GPU time", "Of all passes of the left picture, by the GPU's own timer, where the browser lets a page read it."}};
}

} // namespace

std::string commandOf(const LiveReportSettings& settings)
{
	const LiveReportSettings defaults;
	const bool builtin = settings.level.starts_with("builtin:");
	std::string text = "nook report live";
	text += settings.level == defaults.level
				? ""
				: " " + shellWord(builtin ? settings.level : nativePath(settings.level).filename().string());
	text += loadOptions(settings.load);
	text += settings.automatic ? " --camera auto:1" : settings.camera.empty() ? "" : " --camera " + shellWord(settings.camera);
	text += settings.width_px == defaults.width_px && settings.height_px == defaults.height_px
				? ""
				: " --size " + std::to_string(settings.width_px) + "x" + std::to_string(settings.height_px);
	text += settings.rays == defaults.rays ? "" : " --rays " + std::to_string(settings.rays);
	text += settings.radius_m > 0.0 ? " --radius " + numberText(settings.radius_m) : "";
	return text;
}

LivePage liveReport(const LiveReportSettings& settings, const RunSettings& run)
{
	LivePage page;
	LiveJson program = liveProgram(settings, page.read); // what may be missing comes before long work
	LiveJson catalogue = liveCatalogue(settings, page.read);
	Level level = loadLevel(settings.level, settings.load, run).level;
	page.read.insert(page.read.end(), level.files.begin(), level.files.end());
	const double radius_m = settings.radius_m > 0.0 ? settings.radius_m : kRadiusShare * radiusFor(level);
	LevelBench bench(std::move(level), radius_m, run);
	const CamerasOfLevel cameras = camerasOf(bench.tracer(), settings.camera, settings.automatic ? 1 : 0, run);
	const LevelCamera& camera = cameras.cameras.front();
	if (!cameras.chosen)
	{
		checkOutside(bench.tracer(), glm::dvec3(camera.world_from_camera[3]), camera.name);
	}
	ViewBench view(bench, camera, {settings.width_px, settings.height_px, settings.rays, 1}, run);
	LiveJson data{{"command", commandOf(settings)},
				  {"version", settings.version},
				  {"domains", choicesOf<Domain>()},
				  {"methods", choicesOf<Method>()},
				  {"most", kMaxCount},
				  {"rays", settings.rays},
				  {"load_options", loadOptions(settings.load)},
				  {"camera_option", cameras.chosen ? "auto:1" : camera.name},
				  {"catalogue", std::move(catalogue)},
				  {"shading", liveModules(bench, view, settings.version, run)},
				  {"view", liveView(camera, bench, view)},
				  {"reading", readingOfPage()},
				  {"program", std::move(program)}};
	page.html = pageHtml({"patterns and obscurance, live",
						  settings.version,
						  assets::live_html,
						  {assets::live_css},
						  {assets::pictures_js, assets::live_cells_js, assets::live_gl_js, assets::live_scene_js,
						   assets::live_shade_js, assets::live_pattern_js, assets::live_page_js},
						  jsonLine(data)});
	return page;
}

} // namespace nook
