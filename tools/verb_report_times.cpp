// SPDX-License-Identifier: GPL-3.0-or-later
// nook report times: levels → times of every screen-space method on a renderer, and their differences to the CPU.
#include "options.h"
#include "scene_options.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "study/times_report.h"

namespace nook
{
namespace
{

struct TimesOptions
{
	TimesSettings settings;
	std::string only;
	Outputs outputs;
};

double radiusOf(const std::string& name, const std::string& text)
{
	const double radius_px = numberFrom<double>(text).value_or(0.0);
	refuseValueIf(!(radius_px >= 1.0 && radius_px <= 65536.0), name, text, "a number from 1 to 65536");
	return radius_px;
}

void declareTimes(CLI::App& app, TimesOptions& options)
{
	TimesSettings& settings = options.settings;
	settings.measure.repetitions = 9;
	addOptions(
		app, {{"LEVEL",
			   takesEach("LEVEL", [&settings](const std::string&, const std::string& level) { settings.levels.push_back(level); }),
			   "Levels (.gltf .glb .obj .fbx .ply .stl), or builtin:NAME", kRequired},
			  {"--size", takesEach("WxH", settings.sizes, sizeOf),
			   "Width and height of the pictures in pixels, may be repeated (default 1920x1080)"},
			  {"--radius-px", takesEach("X", settings.radii_px, radiusOf),
			   "Radius in pixels, the same at every pixel; may be repeated (default: by depth and the level's size)"},
			  {"--check", takesFlag(settings.check),
			   "Compares the pictures of the first size with those of the CPU; exit code 7 if too many pixels differ by more than "
			   "1/255"},
			  {"--grid", takesChoice(namesOf<GridSize>(), settings.grid), "How much is tried: quick (default), normal or full"},
			  {"--only", takesText(options.only, "LIST"),
			   "Only candidates whose names begin with these words, with commas between: vo-line, slices 1 (default: all)"},
			  {"--repetitions", takesWhole(settings.measure.repetitions, 1, 1000),
			   "Drawings of each candidate, after a warm-up (default 9)"},
			  {"--seconds", takesNumber(settings.seconds, 0.0, 1e6),
			   "Begins no further picture after this time, and counts those left out; 0 (default): no limit"},
			  glDeviceRow(settings.measure.gl_device)});
	addJson(app, options.outputs.json);
	addRun(app, options.outputs);
}

void settleTimes(TimesOptions& options)
{
	TimesSettings& settings = options.settings;
	settings.only = partsOf(options.only);
	if (settings.sizes.empty())
	{
		settings.sizes = {{1920, 1080}};
	}
	if (settings.radii_px.empty())
	{
		settings.radii_px = {0.0};
	}
	checkNames(options.outputs, settings.levels);
}

double msPerMegapixel(const TimedPicture& picture)
{
	const double megapixels = 1e-6 * static_cast<double>(picture.size.x) * static_cast<double>(picture.size.y);
	return 1e3 * picture.measured.total.median_s / megapixels;
}

Facts pictureFacts(const TimedPicture& picture)
{
	Facts facts;
	facts.text("candidate", picture.candidate.name());
	facts.text("method", picture.candidate.method());
	facts.text("resolution", picture.candidate.resolution());
	facts.text("level", picture.level);
	facts.whole("width_px", picture.size.x);
	facts.whole("height_px", picture.size.y);
	facts.number("radius_px", picture.radius_px);
	if (!picture.failure.empty())
	{
		facts.text("failure", picture.failure);
		return facts;
	}
	const TimeSpread& total = picture.measured.total;
	facts.number("ms_per_megapixel", msPerMegapixel(picture));
	facts.numbers("quartiles_ms", {1e3 * total.low_s, 1e3 * total.high_s});
	std::vector<Facts> passes;
	for (const TimeSpread& pass : picture.measured.passes)
	{
		Facts& item = passes.emplace_back();
		item.text("pass", pass.name);
		item.number("milliseconds", 1e3 * pass.median_s);
	}
	facts.items("passes", std::move(passes));
	if (picture.most)
	{
		facts.number("cpu_most", *picture.most);
		facts.number("cpu_share_above_1_255", picture.unlike);
	}
	return facts;
}

void runTimes(TimesOptions& options, VerbProgress& progress)
{
	settleTimes(options);
	const TimesReport report =
		measureTimes(options.settings, progress.start("report times", options.outputs.threads, options.outputs.progress));
	checkRead(options.outputs, report.files);
	Facts facts = verbFacts("report times");
	facts.text("renderer", report.renderer.name, "renderer");
	facts.whole("repetitions", options.settings.measure.repetitions);
	facts.whole("left_out", report.left_out, "pictures left out");
	std::vector<Facts> pictures;
	std::string failure;
	std::string unlike;
	for (const TimedPicture& one : report.pictures)
	{
		const std::string name = one.level + ", " + std::to_string(one.size.x) + "x" + std::to_string(one.size.y) +
								 (one.radius_px > 0.0 ? ", radius " + numberText(one.radius_px) + " px" : "") + ", '" +
								 one.candidate.name() + "'";
		pictures.push_back(pictureFacts(one));
		facts.line(name + ": " + (one.failure.empty() ? roundedText(msPerMegapixel(one), 4) + " ms per megapixel" : one.failure));
		failure = failure.empty() && !one.failure.empty() ? name + ": " + one.failure : failure;
		unlike = unlike.empty() && one.unlike > kUnlikeShare ? name : unlike;
	}
	facts.items("pictures", std::move(pictures));
	writeOutputs(options.outputs, {}, facts.json(), report.files);
	if (options.outputs.json != "-" && isStdoutFree(options.outputs))
	{
		writeFile("-", facts.lines());
	}
	refuseIf(!failure.empty(), failure, ExitCode::runtime);
	refuseIf(!unlike.empty(),
			 unlike + ": found more than " + numberText(100.0 * kUnlikeShare) +
				 " % of pixels that differ from the CPU by more than 1/255, expected fewer",
			 ExitCode::difference);
}

} // namespace

Verb addReportTimes(CLI::App& report)
{
	return addVerb<TimesOptions>(report, "times",
								 "Times of every screen-space method on a renderer, and its differences to the CPU", declareTimes,
								 runTimes);
}

} // namespace nook
