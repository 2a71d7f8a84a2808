// SPDX-License-Identifier: GPL-3.0-or-later
// Cost and error of screen-space methods, compared within one run.
//   nook_bench_shade [--gl-device N] [--level NAME] [cost | radius | lines | tile]…      default: all, builtin:courtyard
// cost: milliseconds for 1280 × 720 through OpenGL, without compiling, and RMSE against rays, all methods with one filter; all take
// turns five times, each the median of three drawings after one warm-up, and the minimum of the five counts, so that a busy machine
// affects all alike.
// radius: the same errors for other radii.
// lines: RMSE of VO's lines against the open volume of the depth buffer, by number of lines.
// tile: nine lines from a tile compared with nine from a random texture, with the same filter.
#include "core/parallel.h"
#include "pattern/quality.h"
#include "pattern/recipe.h"
#include "pattern/tile.h"
#include "scene/gbuffer.h"
#include "scene/load.h"
#include "scene/reference.h"
#include "shade/shade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace
{

using namespace nook;
using Picture = std::vector<float>;

constexpr int kRepetitions = 3;
constexpr int kRounds = 5;

RunSettings all()
{
	return {availableThreads(), {}};
}

struct Scene
{
	LoadedLevel loaded;
	Tracer tracer;

	explicit Scene(const std::string& name) : loaded(loadLevel(name, {}, all())), tracer(loaded.level, all()) {}
	GBuffer gbuffer(int width, int height) const
	{
		return castGBuffer(tracer, viewOf(loaded.level.cameras.at(0), width, height), width, height, NormalKind::geometric, all());
	}
	Picture reference(const GBuffer& gbuffer, const ReferenceSettings& settings) const
	{
		Picture picture;
		for (const ReferenceValue& value : referenceOfGBuffer(&tracer, gbuffer, settings, all()))
		{
			picture.push_back(static_cast<float>(value.visibility));
		}
		return picture;
	}
};

// Over pixels with a surface, for 1 − factor × (1 − test).
double rmseOf(const GBuffer& gbuffer, const Picture& test, const Picture& truth, double factor = 1.0)
{
	double squares = 0.0;
	double pixels = 0.0;
	for (std::size_t i = 0; i < test.size(); ++i)
	{
		if (std::isfinite(gbuffer.depth[i]))
		{
			const double scaled = std::max(0.0, 1.0 - factor * (1.0 - static_cast<double>(test[i])));
			const double error = scaled - static_cast<double>(truth[i]);
			squares += error * error;
			pixels += 1.0;
		}
	}
	return std::sqrt(squares / pixels);
}

// The factor of the obscurance, 0.2 to 4 in steps of 0.05, that minimises the error.
double bestFactor(const GBuffer& gbuffer, const Picture& test, const Picture& truth)
{
	double best = 1.0;
	for (int i = 4; i <= 80; ++i)
	{
		best = rmseOf(gbuffer, test, truth, 0.05 * i) < rmseOf(gbuffer, test, truth, best) ? 0.05 * i : best;
	}
	return best;
}

Pattern patternOf(Domain domain, int count, bool symmetric = false, Order order = Order::none)
{
	Recipe recipe{.domain = domain, .count = count, .symmetric = symmetric, .order = order};
	return generatePattern(recipe, all());
}

ShadeSamples tiled(ShadeMethod method, const Pattern& pattern, TileKind kind, std::uint32_t seed = 1)
{
	TileRecipe tile{.kind = kind, .seed = seed};
	return samplesOf(method, generateTile(pattern, tile, all()).variants);
}

struct Contender
{
	std::string name;
	ShadeSettings settings;
	ShadeSamples samples;
};

Contender contender(const std::string& name, ShadeMethod method, const std::function<void(ShadeSettings&)>& change = {})
{
	Contender one{name, {}, {}};
	one.settings.method = method;
	one.settings.radius_m = 1.0;
	one.settings.filter = ShadeFilter::bilateral;
	if (change)
	{
		change(one.settings);
	}
	if (!takesPattern(method))
	{
		one.samples = ownSamples(one.settings);
	}
	else if (method == ShadeMethod::crytek)
	{
		one.samples = tiled(method, crytekPoints(16), TileKind::random);
	}
	else if (one.settings.volume.paired)
	{
		one.samples = tiled(method, pairedPattern(patternOf(domainOf(method), 9, true)), TileKind::random);
	}
	else if (one.settings.bands.count > 1)
	{
		one.samples = tiled(method, patternOf(domainOf(method), 9, false, Order::progressive), TileKind::random);
	}
	else
	{
		one.samples = tiled(method, patternOf(domainOf(method), 9), TileKind::points);
	}
	return one;
}

Contender horizon(int directions, int steps, double bias_deg)
{
	return contender("hbao " + std::to_string(directions) + " x " + std::to_string(steps) + ", bias " +
						 std::to_string(static_cast<int>(bias_deg)),
					 ShadeMethod::hbao,
					 [=](ShadeSettings& settings)
					 {
						 settings.own["--hbao-directions"] = directions;
						 settings.own["--hbao-steps"] = steps;
						 settings.own["--hbao-angle-bias"] = bias_deg;
					 });
}

// The first one's time is the unit of the others.
std::vector<Contender> contenders()
{
	return {horizon(6, 6, 30.0),
			horizon(6, 4, 30.0),
			horizon(8, 6, 30.0),
			horizon(6, 6, 10.0),
			contender("slices 1 x 4", ShadeMethod::slices),
			contender("slices 1 x 4, half", ShadeMethod::slices, [](ShadeSettings& settings) { settings.half_resolution = true; }),
			contender("vo-line 9", ShadeMethod::vo_line),
			contender("vo-line 9, 0.5 m thick", ShadeMethod::vo_line,
					  [](ShadeSettings& settings) { settings.volume.thickness_m = 0.5; }),
			contender("vo-line 9, paired", ShadeMethod::vo_line, [](ShadeSettings& settings) { settings.volume.paired = true; }),
			contender("vo-line 9, 3 bands", ShadeMethod::vo_line, [](ShadeSettings& settings) { settings.bands.count = 3; }),
			contender("vo-line 9, half", ShadeMethod::vo_line, [](ShadeSettings& settings) { settings.half_resolution = true; }),
			contender("same, 0.5 m thick", ShadeMethod::vo_line,
					  [](ShadeSettings& settings)
					  {
						  settings.half_resolution = true;
						  settings.volume.thickness_m = 0.5;
					  }),
			contender("vo-point 9", ShadeMethod::vo_point),
			contender("vo-area 9", ShadeMethod::vo_area),
			contender("statvo 4 layers", ShadeMethod::statvo),
			contender("same, skipping none", ShadeMethod::statvo, [](ShadeSettings& settings) { settings.statvo.skip = false; }),
			contender("statvo 1 layer", ShadeMethod::statvo, [](ShadeSettings& settings) { settings.statvo.layers = 1; }),
			contender("alchemy 9, 3 bands", ShadeMethod::alchemy, [](ShadeSettings& settings) { settings.bands.count = 3; }),
			contender("alchemy 9", ShadeMethod::alchemy),
			contender("crytek 16", ShadeMethod::crytek),
			contender("volumetric-ao 9", ShadeMethod::volumetric),
			contender("sao 11", ShadeMethod::sao),
			contender("gtao 3 x 6", ShadeMethod::gtao),
			contender("bitmask 3 x 6", ShadeMethod::bitmask)};
}

struct Truths
{
	Picture linear; // falloff 1 − t / radius
	Picture hard;
};

Truths truthsOf(const Scene& scene, const GBuffer& gbuffer, double radius_m)
{
	ReferenceSettings settings{.radius_m = radius_m, .rays = 256};
	Truths truths;
	truths.hard = scene.reference(gbuffer, settings);
	settings.falloff = Falloff::linear;
	truths.linear = scene.reference(gbuffer, settings);
	return truths;
}

void printErrors(const GBuffer& gbuffer, const Picture& picture, const Truths& truths)
{
	for (const Picture* const truth : {&truths.linear, &truths.hard})
	{
		const double factor = bestFactor(gbuffer, picture, *truth);
		std::printf(" %9.4f %9.4f %6.2f", rmseOf(gbuffer, picture, *truth), rmseOf(gbuffer, picture, *truth, factor), factor);
	}
	std::printf("\n");
}

constexpr const char* kErrorHead = "  rmse lin.     best factor  rmse hard     best factor";

struct Cost
{
	double whole = 1e300; // seconds
	double method = 1e300;
	double filter = 1e300;
};

// Keeps the minimum of each.
void lessen(Cost& cost, const Shaded& shaded)
{
	Cost now{shaded.seconds, 0.0, 0.0};
	for (const PassTime& pass : shaded.passes)
	{
		(pass.name.starts_with("bilateral") ? now.filter : now.method) += pass.seconds;
	}
	cost = {std::min(cost.whole, now.whole), std::min(cost.method, now.method), std::min(cost.filter, now.filter)};
}

void printCost(const Scene& scene, const DrawSettings& drawing)
{
	const GBuffer gbuffer = scene.gbuffer(1280, 720);
	const Truths truths = truthsOf(scene, gbuffer, 1.0);
	const std::vector<Contender> all_of_them = contenders();
	std::vector<Cost> costs(all_of_them.size());
	std::vector<Shaded> shaded(all_of_them.size());
	for (int round = 0; round < kRounds; ++round)
	{
		for (std::size_t i = 0; i < costs.size(); ++i)
		{
			shaded[i] = shadeOnGl(gbuffer, all_of_them[i].samples, all_of_them[i].settings, drawing);
			lessen(costs[i], shaded[i]);
		}
	}
	std::printf("\nCost and error, radius 1 m, bilateral filter of 5 taps, 1280 x 720: %s\n%-22s %8s %8s %8s %8s %8s%s\n",
				shaded[0].renderer.c_str(), "", "ms", "method", "filter", "ratio", "method", kErrorHead);
	for (std::size_t i = 0; i < costs.size(); ++i)
	{
		std::printf("%-22s %8.1f %8.1f %8.1f %8.3f %8.3f", all_of_them[i].name.c_str(), 1e3 * costs[i].whole, 1e3 * costs[i].method,
					1e3 * costs[i].filter, costs[i].whole / costs[0].whole, costs[i].method / costs[0].method);
		printErrors(gbuffer, shaded[i].visibility, truths);
	}
}

void printRadii(const Scene& scene)
{
	const GBuffer gbuffer = scene.gbuffer(640, 360);
	const Truths truths = truthsOf(scene, gbuffer, 1.0);
	std::printf("\nError for other radii of the method, rays of 1 m, 640 x 360\n%-22s %9s%s\n", "", "radius", kErrorHead);
	for (Contender& one : contenders())
	{
		for (const double radius_m : {0.35, 0.5, 0.7, 1.0, 1.4})
		{
			one.settings.radius_m = radius_m;
			std::printf("%-22s %9.2f", one.name.c_str(), radius_m);
			printErrors(gbuffer, shadeOnCpu(gbuffer, one.samples, one.settings, all()).visibility, truths);
		}
	}
}

Picture depthTruth(const Scene& scene, const GBuffer& gbuffer)
{
	ReferenceSettings settings{
		.measure = ReferenceMeasure::hemisphere, .source = MatterSource::depth, .radius_m = 0.5, .rays = 512};
	return scene.reference(gbuffer, settings);
}

Picture linesOf(const GBuffer& gbuffer, const ShadeSamples& samples, ShadeFilter filter)
{
	ShadeSettings settings;
	settings.filter = filter;
	return shadeOnCpu(gbuffer, samples, settings, all()).visibility;
}

void printLines(const Scene& scene)
{
	const GBuffer gbuffer = scene.gbuffer(960, 540);
	const Picture truth = depthTruth(scene, gbuffer);
	const Picture limit = linesOf(gbuffer, samplesOf(ShadeMethod::vo_line, {patternOf(Domain::disk, 400)}), ShadeFilter::none);
	std::printf(
		"\nVO lines against the open volume of the depth buffer (radius 0.5 m, 960 x 540), 4 x 4 random reflections, no filter;\n"
		"400 lines are at %.4f. Last columns: all divided by those of 9 lines\n%5s %8s %8s %10s %14s %8s %8s %8s\n",
		rmseOf(gbuffer, limit, truth), "lines", "plane", "noise", "rmse", "to 400 lines", "plane", "rmse", "to 400");
	struct Row
	{
		int count;
		double plane;
		double noise;
		double rmse;
		double scatter;
	};
	std::vector<Row> rows;
	for (const int count : {5, 9, 16, 33, 64})
	{
		const Pattern pattern = patternOf(Domain::disk, count);
		const Quality quality = measurePattern(pattern, all());
		const Picture picture = linesOf(gbuffer, tiled(ShadeMethod::vo_line, pattern, TileKind::random), ShadeFilter::none);
		rows.push_back({count, quality.plane, quality.noise, rmseOf(gbuffer, picture, truth), rmseOf(gbuffer, picture, limit)});
	}
	for (const Row& row : rows)
	{
		std::printf("%5d %8.4f %8.4f %10.4f %14.4f %8.3f %8.3f %8.3f\n", row.count, row.plane, row.noise, row.rmse, row.scatter,
					row.plane / rows[1].plane, row.rmse / rows[1].rmse, row.scatter / rows[1].scatter);
	}
}

// Root mean square over seeds of random textures, or for the one tile.
struct Errors
{
	double truth = 0.0; // against the depth buffer
	double limit = 0.0; // against 400 lines
	double noise = 0.0; // against 400 lines with the same filter
};

Errors errorsOf(const GBuffer& gbuffer, const std::vector<ShadeSamples>& samples, ShadeFilter filter, const Picture& truth,
				const std::array<Picture, 2>& limits)
{
	Errors squares;
	const double share = 1.0 / static_cast<double>(samples.size());
	for (const ShadeSamples& one : samples)
	{
		const Picture picture = linesOf(gbuffer, one, filter);
		squares.truth += share * std::pow(rmseOf(gbuffer, picture, truth), 2);
		squares.limit += share * std::pow(rmseOf(gbuffer, picture, limits[0]), 2);
		squares.noise += share * std::pow(rmseOf(gbuffer, picture, limits[1]), 2);
	}
	return {std::sqrt(squares.truth), std::sqrt(squares.limit), std::sqrt(squares.noise)};
}

void printTile(const Scene& scene)
{
	const GBuffer gbuffer = scene.gbuffer(960, 540);
	const Picture truth = depthTruth(scene, gbuffer);
	const Pattern nine = patternOf(Domain::disk, 9);
	// With the same window, so that the window filter averages over as many pixels.
	const ShadeSamples many = tiled(ShadeMethod::vo_line, patternOf(Domain::disk, 400), TileKind::even);
	const std::vector<ShadeSamples> tile{tiled(ShadeMethod::vo_line, nine, TileKind::points)};
	std::vector<ShadeSamples> random;
	for (const std::uint32_t seed : {1U, 2U, 3U})
	{
		random.push_back(tiled(ShadeMethod::vo_line, nine, TileKind::random, seed));
	}
	std::printf("\nNine lines from a tile of 4 x 4 and from a random texture of 4 x 4 (three seeds), radius 0.5 m, 960 x 540\n"
				"%-12s %26s %30s %30s\n%-12s %8s %8s %8s %12s %8s %8s %12s %8s %8s\n",
				"", "rmse to the depth buffer", "to 400 lines", "to 400 lines, filtered", "filter", "tile", "random", "ratio",
				"tile", "random", "ratio", "tile", "random", "ratio");
	constexpr std::array<std::pair<ShadeFilter, const char*>, 3> kFilters{
		{{ShadeFilter::none, "none"}, {ShadeFilter::bilateral, "bilateral 5"}, {ShadeFilter::window, "window"}}};
	const Picture limit = linesOf(gbuffer, many, ShadeFilter::none);
	for (const auto& [filter, name] : kFilters)
	{
		const std::array<Picture, 2> limits{limit, linesOf(gbuffer, many, filter)};
		const Errors ours = errorsOf(gbuffer, tile, filter, truth, limits);
		const Errors theirs = errorsOf(gbuffer, random, filter, truth, limits);
		std::printf("%-12s %8.4f %8.4f %8.3f %12.4f %8.4f %8.3f %12.4f %8.4f %8.3f\n", name, ours.truth, theirs.truth,
					ours.truth / theirs.truth, ours.limit, theirs.limit, ours.limit / theirs.limit, ours.noise, theirs.noise,
					ours.noise / theirs.noise);
	}
}

} // namespace

int main(int argc, char** argv)
{
	std::set<std::string> sections;
	std::string level = "builtin:courtyard";
	DrawSettings drawing;
	drawing.repetitions = kRepetitions;
	try
	{
		for (int i = 1; i < argc; ++i)
		{
			const std::string word = argv[i];
			if ((word == "--level" || word == "--gl-device") && i + 1 < argc)
			{
				i += 1;
				if (word == "--level")
				{
					level = argv[i];
				}
				else
				{
					drawing.gl_device = std::stoi(argv[i]);
				}
			}
			else if (word == "cost" || word == "radius" || word == "lines" || word == "tile")
			{
				sections.insert(word);
			}
			else
			{
				std::fprintf(stderr,
							 "nook_bench_shade: found '%s', expected --gl-device N, --level NAME, cost, radius, lines, tile\n",
							 word.c_str());
				return 1;
			}
		}
		const auto wants = [&sections](const char* name)
		{
			return sections.empty() || sections.contains(name);
		};
		const Scene scene(level);
		std::printf("%s\n", level.c_str());
		if (wants("cost"))
		{
			printCost(scene, drawing);
		}
		if (wants("radius"))
		{
			printRadii(scene);
		}
		if (wants("lines"))
		{
			printLines(scene);
		}
		if (wants("tile"))
		{
			printTile(scene);
		}
	}
	catch (const std::exception& error)
	{
		std::fprintf(stderr, "nook_bench_shade: %s\n", error.what());
		return 1;
	}
	return 0;
}
