// SPDX-License-Identifier: GPL-3.0-or-later
// nook compare: two visibility images → errors, a picture of them, and a verdict.
#include "call.h"
#include "options.h"

#include "core/error.h"
#include "core/file.h"
#include "core/system.h"
#include "core/text.h"
#include "core/words.h"
#include "image/drawing.h"
#include "image/visibility_image.h"
#include "scene/gbuffer.h"

#include <array>
#include <optional>

namespace nook
{

// Names as on the command line, in the order of the enumerators.
template <>
inline constexpr std::array<std::string_view, 7> kNamesOf<ErrorMetric>{"rmse", "mae", "p95", "max", "ssim", "flip", "eq14"};
namespace
{

constexpr std::array<std::string_view, 1> kPictureFormats{".png"};

struct CompareOptions
{
	std::string test;
	std::string reference;
	std::string channel;
	std::string mask;
	std::optional<double> max_error;
	ErrorMetric metric = ErrorMetric::rmse;
	std::string diff;
	std::optional<double> diff_range;
	bool bent = false;
	Outputs outputs;
	CompareSettings settings;
};

void declare(CLI::App& app, CompareOptions& options)
{
	const OptionRules visibility = excludes("--bent", "one of them", "with --bent, of which it says nothing");
	const auto also = [&visibility](const std::string& needed, const std::string& expected)
	{
		OptionRules rules = visibility;
		rules.needs = {{needed, expected}};
		return rules;
	};
	addOptions(
		app,
		{{"TEST", takesText(options.test, "TEST"), "Visibility to be judged: any image file", kRequired},
		 {"REFERENCE", takesText(options.reference, "REFERENCE"), "Visibility that is taken for true, of the same size", kRequired},
		 {"--channel", takesText(options.channel, "NAME"),
		  "Channel of both files (default: visibility, else the only one, else Y, else R, G, B where they are gray)", visibility},
		 {"--mask", takesText(options.mask, "GBUFFER.exr"),
		  "Pixels without a surface in this G-buffer (linear depth) do not count"},
		 {"--max-error", takesNumber(options.max_error, 0.0, 1e6), "Greater errors end with exit code 7 (see --metric)"},
		 {"--metric", takesChoice(namesOf<ErrorMetric>(), options.metric),
		  "The error that --max-error is about (default: rmse); ssim stands for 1 - SSIM", also("--max-error", "--max-error")},
		 {"--diff", takesText(options.diff, "FILE.png"),
		  "Picture of test - reference: blue where the test is darker, red where lighter", visibility},
		 {"--diff-range", takesNumber(options.diff_range, 1e-6, 1e6),
		  "Difference of the strongest colour (default: a round number that holds 99 % of them)",
		  also("--diff", "--diff FILE.png")},
		 {"--ppd", takesNumber(options.settings.pixels_per_degree, 4.0, 1000.0),
		  "Pixels per degree of vision, for FLIP (default: 67, a 70 cm wide 4K display seen from 70 cm)", visibility},
		 {"--bent", takesFlag(options.bent),
		  "The angles between bent normals, in degrees: of nook shade --bent, nook reference --measure bent, or a G-buffer's "
		  "normals; --max-error is about their mean"}});
	addJson(app, options.outputs.json);
	addRun(app, options.outputs);
}

void check(const CompareOptions& options)
{
	refuseValueIf(options.diff == "-", "--diff", "-", "a file");
	Outputs outputs = options.outputs;
	if (!options.diff.empty())
	{
		outputs.files.push_back(options.diff);
	}
	checkAnyOutputs(outputs, kPictureFormats, {options.test, options.reference, options.mask});
}

// Which pixels count; empty: all.
template <class Picture> std::vector<uint8_t> readMask(const std::string& path, const Picture& reference)
{
	if (path.empty())
	{
		return t_call != nullptr ? t_call->counted : std::vector<uint8_t>{};
	}
	SurfaceMask mask = readSurfaceMask(path);
	refuseInputIf(mask.width_px != reference.width_px || mask.height_px != reference.height_px, path + ": size",
				  std::to_string(mask.width_px) + "x" + std::to_string(mask.height_px) + " pixels",
				  std::to_string(reference.width_px) + "x" + std::to_string(reference.height_px) + " as " + reference.path);
	refuseIf(std::find(mask.surface.begin(), mask.surface.end(), uint8_t{1}) == mask.surface.end(),
			 path + ": depth: found sky alone, expected a surface somewhere", ExitCode::invalid_input);
	return std::move(mask.surface);
}

std::string shortText(double value)
{
	return roundedText(value, 5);
}

std::string nameOfFile(const std::string& path)
{
	return nativePath(path).filename().string();
}

// The errors for people, in three columns.
std::string table(const VisibilityImage& test, const VisibilityImage& reference, const Comparison& c,
				  const std::optional<double>& uncertainty, const CompareSettings& settings)
{
	std::string lines;
	const auto row = [&lines](const std::string& name, const std::string& value, const std::string& meaning)
	{
		const std::size_t gap = value.size() < 13 ? 13 - value.size() : 1;
		lines +=
			name + std::string(12 - name.size(), ' ') + value + (meaning.empty() ? "" : std::string(gap, ' ') + meaning) + "\n";
	};
	row("test", test.path + " (" + test.channel + ")", "");
	row("reference", reference.path + " (" + reference.channel + ")", "");
	row("pixels", std::to_string(c.pixels),
		"of " + std::to_string(test.width_px) + " x " + std::to_string(test.height_px) +
			(settings.counted.empty() ? "" : ", the others are sky"));
	row("rmse", shortText(c.rmse), "root of the mean squared error");
	row("mae", shortText(c.mae), "mean of |test - reference|");
	row("mean error", shortText(c.mean_error), "mean of test - reference: negative is too dark");
	row("p95", shortText(c.p95), "95 % of the pixels are no further off");
	row("max", shortText(c.max),
		"at pixel " + std::to_string(c.worst.x) + "," + std::to_string(c.worst.y) + ": " + shortText(c.worst.test) + " for " +
			shortText(c.worst.reference));
	row("ssim", c.ssim ? shortText(*c.ssim) : "-",
		c.ssim ? "structural similarity, 1 for equal images" : "no 11 x 11 window lies inside and counts");
	row("flip", shortText(c.flip),
		"visible difference, 0 to 1, at " + roundedText(settings.pixels_per_degree, 4) + " pixels per degree");
	row("eq14", shortText(c.eq14), "perceptual error of Ambient Occlusion Volumes, 8 bits");
	if (uncertainty)
	{
		row("uncertainty", shortText(*uncertainty), "of the reference itself: RMS of its standard error");
	}
	return lines;
}

// The error that --max-error is about; 0 without it.
double judged(const CompareOptions& options, const Comparison& comparison)
{
	if (!options.max_error)
	{
		return 0.0;
	}
	const std::optional<double> error = errorBy(comparison, options.metric);
	refuseInputIf(!error, options.test + ": size", "no window of 11x11 pixels that counts", "one for --metric ssim");
	return *error;
}

// Names and size of the two images, of visibility or of bent normals.
template <class Picture>
Facts headFacts(const CompareOptions& options, const Picture& test, const Picture& reference, std::size_t pixels)
{
	Facts facts = verbFacts("compare");
	facts.text("test", nameOfFile(test.path));
	facts.text("test_channel", test.channel);
	facts.text("reference", nameOfFile(reference.path));
	facts.text("reference_channel", reference.channel);
	facts.when(!options.mask.empty()).text("mask", nameOfFile(options.mask));
	facts.whole("width", test.width_px);
	facts.whole("height", test.height_px);
	facts.whole("pixels", pixels);
	return facts;
}

void addVerdict(Facts& facts, const CompareOptions& options, double found)
{
	if (options.max_error)
	{
		facts.number("found", found);
		facts.number("allowed", *options.max_error);
		facts.text("verdict", found > *options.max_error ? "exceeded" : "within");
	}
}

void refuseWorse(const CompareOptions& options, const std::string& what, double found, const std::string& unit = "")
{
	refuseIf(options.max_error && found > *options.max_error,
			 options.test + ": " + what + ": found " + doubleText(found) + unit + ", expected at most " +
				 doubleText(options.max_error.value_or(0.0)),
			 ExitCode::difference);
}

std::string summaryOf(const CompareOptions& options, const VisibilityImage& test, const VisibilityImage& reference,
					  const Comparison& c, const std::optional<double>& uncertainty, double found)
{
	Facts facts = headFacts(options, test, reference, c.pixels);
	const std::vector<Measure> errors{
		{"rmse", c.rmse}, {"mae", c.mae},  {"mean_error", c.mean_error},
		{"p95", c.p95},   {"max", c.max},  {"ssim", c.ssim.value_or(std::numeric_limits<double>::quiet_NaN())},
		{"flip", c.flip}, {"eq14", c.eq14}};
	for (const Measure& error : errors)
	{
		give<double>(error.name.c_str(), std::vector{error.value}, {});
	}
	facts.measures("errors", errors);
	facts.whole("worst_x", c.worst.x);
	facts.whole("worst_y", c.worst.y);
	facts.number("worst_test", c.worst.test);
	facts.number("worst_reference", c.worst.reference);
	facts.number("pixels_per_degree", options.settings.pixels_per_degree);
	facts.when(uncertainty.has_value()).number("reference_standard_error", uncertainty.value_or(0.0));
	facts.when(options.max_error.has_value()).text("metric", nameOf(options.metric));
	addVerdict(facts, options, found);
	return facts.json();
}

std::string differenceOf(const CompareOptions& options, const VisibilityImage& test, const VisibilityImage& reference)
{
	const std::span<const uint8_t> counted = options.settings.counted;
	const double range = options.diff_range ? *options.diff_range : differenceRange(test.plane(), reference.plane(), counted);
	const Notes notes{{"Title", "test - reference"},
					  {"Description", nameOfFile(test.path) + " - " + nameOfFile(reference.path) + ", -" + doubleText(range) +
										  " to " + doubleText(range)}};
	return differencePng(test.plane(), reference.plane(), counted, range, notes);
}

std::string bentTable(const BentImage& test, const BentImage& reference, const BentAngles& angles)
{
	std::string lines = "test        " + test.path + " (" + test.channel + ")\n";
	lines += "reference   " + reference.path + " (" + reference.channel + ")\n";
	lines += "pixels      " + std::to_string(angles.pixels) + "\n";
	lines += "mean angle  " + shortText(angles.mean_deg) + " degrees\n";
	lines += "rmse        " + shortText(angles.rmse_deg) + " degrees\n";
	lines += "p95         " + shortText(angles.p95_deg) + " degrees\n";
	lines += "max         " + shortText(angles.max_deg) + " degrees, at pixel " + std::to_string(angles.worst_x) + "," +
			 std::to_string(angles.worst_y) + "\n";
	return lines;
}

std::string bentSummary(const CompareOptions& options, const BentImage& test, const BentImage& reference, const BentAngles& angles)
{
	Facts facts = headFacts(options, test, reference, angles.pixels);
	facts.measures("angles_deg",
				   {{"mean", angles.mean_deg}, {"rmse", angles.rmse_deg}, {"p95", angles.p95_deg}, {"max", angles.max_deg}});
	facts.whole("worst_x", angles.worst_x);
	facts.whole("worst_y", angles.worst_y);
	addVerdict(facts, options, angles.mean_deg);
	return facts.json();
}

// Directions in place of visibility.
void runBent(const CompareOptions& options)
{
	const BentImage test = bentOf(imageOf(options.test), options.test);
	const BentImage reference = bentOf(imageOf(options.reference), options.reference);
	const std::vector<uint8_t> counted = readMask(options.mask, reference);
	const BentAngles angles = anglesBetween(test, reference, counted);
	writeOutputs(options.outputs, {}, bentSummary(options, test, reference, angles), {}, bentTable(test, reference, angles));
	refuseWorse(options, "mean angle", angles.mean_deg, " degrees");
}

void run(CompareOptions& options, VerbProgress& progress)
{
	check(options);
	const RunSettings settings = progress.start("compare", options.outputs.threads, options.outputs.progress);
	if (options.bent)
	{
		runBent(options);
		return;
	}
	const VisibilityImage test = visibilityOf(imageOf(options.test), options.test, options.channel);
	const VisibilityImage reference = visibilityOf(imageOf(options.reference), options.reference, options.channel);
	checkSameSize(test, reference);
	const std::vector<uint8_t> counted = readMask(options.mask, reference);
	options.settings.counted = counted;
	const Comparison comparison = compareImages(test.plane(), reference.plane(), options.settings, settings);
	const std::optional<double> uncertainty = ownUncertainty(reference, counted);
	const double found = judged(options, comparison);
	OutputSet files;
	if (!options.diff.empty())
	{
		files.add(options.diff, differenceOf(options, test, reference));
	}
	addSide(files, options.outputs, summaryOf(options, test, reference, comparison, uncertainty, found), {},
			table(test, reference, comparison, uncertainty, options.settings));
	files.commit();
	refuseWorse(options, std::string(nameOf(options.metric)), found);
}

} // namespace

Verb addCompareVerb(CLI::App& nook)
{
	return addVerb<CompareOptions>(nook, "compare", "Says how far one visibility image is from another", declare, run);
}

} // namespace nook
