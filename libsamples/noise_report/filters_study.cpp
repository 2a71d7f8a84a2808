// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/rotations.h"
#include "noise_report/studies.h"

#include "core/byte_text.h"
#include "core/math.h"
#include "core/work_units.h"
#include "noise_report/measures.h"
#include "pattern/tile.h"
#include "pattern/tile_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <string_view>
#include <utility>

namespace nook
{
namespace
{

constexpr double kAlpha = 0.1;
constexpr double kGolden = 0.6180339887498949;

// What is seen: the variants alone, or behind a filter, in one frame or a mean over many, with a camera that pans or does not.
struct View
{
	const char* head;
	std::string_view filter;
	bool frames = false;
	bool pan = false;
};

constexpr std::array kOneFrame{View{"no filter", "none"}, View{"bilateral:5", "bilateral:5"}, View{"gauss:1", "gauss:1"},
							   View{"box:3", "box:3"},    View{"binomial:3", "binomial:3"},   View{"box:4", "box:4"}};
constexpr std::array kOverFrames{View{"no filter", "none", true}, View{"the same, panned", "none", true, true},
								 View{"binomial:3", "binomial:3", true}, View{"the same, panned", "binomial:3", true, true},
								 View{"box:4", "box:4", true}};

TileShares sharesFor(const View& view, int size, int frames)
{
	return sharesOf(size, tileFilterNamed(std::string(view.filter)), {view.frames ? frames : 1, kAlpha}, view.frames ? 0 : 1,
					{view.pan ? 1 : 0, 0});
}

// What is made: minutes of work for nine lines, less for the fewer of a small report.
struct Effort
{
	int lines = 9;
	int side = 32;          // of noises that do not repeat, or where that is chosen
	int frames = 32;        // and of their sequences
	int sweeps = 1024;      // of the optimised ones
	int sweeps_frames = 64; // and of their sequences, with half the side
	int tiles = 16;         // one after the other
};
constexpr Effort kSmall{4, 16, 8, 64, 8, 2};

Effort effortOf(const NoiseReport& report)
{
	return report.settings.max_count < Effort{}.lines ? kSmall : Effort{};
}

// The error of what is made for a filter, by what is seen.
using Seen = std::function<double(const View&)>;

struct Rival
{
	std::string name;
	std::function<Seen(const View& still)> made;
	double cost = 1.0; // as those of rows
};

// As many even rings as samples, one sample on each a golden angle further, with its ring's share of the integral: little bias,
// which is all that stays when angles are averaged.
Pattern spiralOf(int count)
{
	Pattern spiral;
	spiral.domain = Domain::disk;
	const auto outside = [count](int ring)
	{
		const double rest = 1.0 - static_cast<double>(ring) / count;
		return rest * std::sqrt(rest);
	};
	for (int i = 0; i < count; ++i)
	{
		const double radius = std::sqrt((i + 0.5) / count);
		const SinCos turn = sinCosOf(2.0 * kPi * kGolden * i);
		spiral.points.emplace_back(radius * turn.cos, radius * turn.sin, 0.0);
		spiral.weights.push_back(outside(i) - outside(i + 1));
	}
	return spiral;
}

// Without a filter's name: for its window.
PatternTile madeTile(const Pattern& pattern, std::string_view filter, int frames, int starts)
{
	TileRecipe recipe;
	recipe.starts = starts;
	recipe.frames = frames;
	recipe.ema = kAlpha;
	if (!filter.empty())
	{
		recipe.filters = {tileFilterNamed(std::string(filter))};
	}
	return generateTile(pattern, recipe);
}

// Frame after frame the same tile, turned by the golden angle.
PatternTile turnedTile(const PatternTile& tile, int frames)
{
	PatternTile sequence = tile;
	sequence.frames = frames;
	sequence.variants.clear();
	for (int frame = 0; frame < frames; ++frame)
	{
		for (const Pattern& variant : tile.variants)
		{
			sequence.variants.push_back(turned(variant, frame * kGolden));
		}
	}
	return sequence;
}

// Views of one filter stand one after the other.
StudyTable tableOf(const std::vector<Rival>& rivals, std::span<const View> views, const RunSettings& run)
{
	std::vector<std::pair<std::size_t, std::size_t>> groups; // of one filter: the first and behind the last
	StudyTable table;
	table.head = {"variants"};
	for (std::size_t view = 0; view < views.size(); ++view)
	{
		table.head.emplace_back(views[view].head);
		if (view == 0 || views[view].filter != views[view - 1].filter)
		{
			groups.emplace_back(view, view);
		}
		groups.back().second = view + 1;
	}
	std::vector<std::string> errors(rivals.size() * views.size());
	const auto forViews = [&](std::size_t unit, const std::function<void(const View& view, std::string& error)>& visit)
	{
		const auto& [first, end] = groups[unit % groups.size()];
		for (std::size_t view = first; view < end; ++view)
		{
			visit(views[view], errors[unit / groups.size() * views.size() + view]);
		}
	};
	runStage({"filters", rivals.size() * groups.size(), [&](std::size_t i) { return rivals[i / groups.size()].cost; },
			  [&](std::size_t i)
			  {
				  const Seen seen = rivals[i / groups.size()].made(views[groups[i % groups.size()].first]);
				  forViews(i, [&](const View& view, std::string& error) { error = fixedText(seen(view), 4); });
			  },
			  [&](std::size_t i)
			  {
				  ByteWriter out;
				  forViews(i, [&](const View&, const std::string& error) { out.text(error); });
				  return out.take();
			  },
			  [&](std::size_t i, std::string_view bytes)
			  {
				  ByteReader in(bytes);
				  forViews(i, [&](const View&, std::string& error) { error = in.text(); });
				  return in.isAtEnd();
			  }},
			 run);
	for (std::size_t rival = 0; rival < rivals.size(); ++rival)
	{
		table.rows.push_back({rivals[rival].name});
		const auto begin = errors.begin() + static_cast<std::ptrdiff_t>(rival * views.size());
		table.rows.back().insert(table.rows.back().end(), begin, begin + static_cast<std::ptrdiff_t>(views.size()));
	}
	return table;
}

} // namespace

const NoiseRow* rowOfFilters(const NoiseReport& report)
{
	const int count = std::min(effortOf(report).lines, report.settings.max_count);
	return count < 3 ? nullptr
					 : findRow(report.rows, {Domain::disk, Variant::free, Method::refine, WeightRule::voronoi, VoronoiMode::exact},
							   count);
}

namespace
{

Seen seenTurned(const RotationError& error, Rotations rotations)
{
	return [&error, rotations = std::move(rotations)](const View& view)
	{
		return error.of(rotations, sharesFor(view, rotations.size, rotations.frames));
	};
}

Seen seenTile(PatternTile tile)
{
	return [tile = std::move(tile)](const View& view)
	{
		return errorBehind(tile, {sharesFor(view, tile.size, tile.frames)});
	};
}

// One pattern in every pixel, whatever filter there is.
std::function<Seen(const View&)> alone(const RotationError& error)
{
	return [&error](const View&) -> Seen
	{
		return [value = error.of({1, 1, {0.0}}, {1, 1, {1.0}})](const View&)
		{
			return value;
		};
	};
}

void title(StudyTable& one, StudyTable& over, const NoiseRow& row, const Effort& effort)
{
	const std::string lines = std::to_string(row.recipe.count) + " lines";
	one.title = "Behind filters: " + lines + ", another variant in each pixel";
	one.note = "Plane error of the filtered mean, over all pixels. Rotations turn the refined pattern by angles of " +
			   std::to_string(effort.side) + " × " + std::to_string(effort.side) +
			   " pixels, or of 4 × 4; whatever the angles, the error stays above the pattern’s bias of " +
			   fixedText(row.quality.bias, 4) +
			   ". A spiral, one sample on each of as many rings, has less bias and more error alone. Tiles place the samples of "
			   "4 × 4 pixels.";
	over.title = "Over frames: " + lines + ", a mean with a tenth of every new frame";
	over.note = "Rotations: " + std::to_string(effort.frames) +
				" frames, optimised for the filter and the mean at once, for a camera that stands. The tile made for its window is "
				"turned by the golden angle each frame; the last row has " +
				std::to_string(effort.tiles) +
				" tiles one after the other. Panned: by one pixel a frame, with a history that follows.";
}

} // namespace

std::vector<StudyTable> filterTables(const NoiseReport& report, const RunSettings& run)
{
	const Effort effort = effortOf(report);
	const NoiseRow* const row = rowOfFilters(report);
	if (row == nullptr)
	{
		return {};
	}
	const int count = row->recipe.count;
	const Pattern& pattern = row->pattern;
	const RotationError refined(pattern);
	const RotationError spiral(spiralOf(count));
	const PatternTile of_window = madeTile(pattern, {}, 1, report.settings.starts);
	const PatternTile golden = turnedTile(of_window, effort.frames);
	const auto rotated = [&](const RotationError& error, RotationNoise noise, int size)
	{
		return [&, noise, size](const View& still)
		{
			return seenTurned(error, rotationsOf(noise, size, still.frames ? effort.frames : 1));
		};
	};
	const auto optimised = [&](const RotationError& error)
	{
		return [&](const View& still)
		{
			const int size = still.frames ? effort.side / 2 : effort.side;
			const int frames = still.frames ? effort.frames : 1;
			return seenTurned(error, error.optimised(size, frames, sharesFor(still, size, frames),
													 still.frames ? effort.sweeps_frames : effort.sweeps));
		};
	};
	const std::vector<Rival> rivals{{"one pattern in every pixel", alone(refined)},
									{"white rotations", rotated(refined, RotationNoise::white, effort.side / 2)},
									{"sixteen rotations", rotated(refined, RotationNoise::sixteen, 4)},
									{"interleaved gradient noise", rotated(refined, RotationNoise::gradient, effort.side)},
									{"R2", rotated(refined, RotationNoise::r2, effort.side)},
									{"rotations optimised for the filter", optimised(refined)},
									{"one spiral in every pixel", alone(spiral)},
									{"spiral, interleaved gradient noise", rotated(spiral, RotationNoise::gradient, effort.side)},
									{"spiral, rotations optimised for the filter", optimised(spiral)},
									{"nook tile, made for its window",
									 [&](const View& still)
									 {
										 return seenTile(still.frames ? golden : of_window);
									 }},
									{"nook tile --filter, made for it", [&](const View& still)
									 {
										 return seenTile(madeTile(pattern, still.filter, still.frames ? effort.tiles : 1,
																  still.frames ? 1 : report.settings.starts));
									 }}};
	StudyTable one = tableOf(rivals, kOneFrame, run);
	StudyTable over = tableOf(rivals, kOverFrames, run);
	title(one, over, *row, effort);
	return {one, over};
}

} // namespace nook
