// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/arrays.h"

#include "core/error.h"
#include "core/lists.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>

namespace nook
{
namespace
{

float toFloat(double value)
{
	return static_cast<float>(value);
}

std::string stemOf(const EmitContext& context, const std::string& derived)
{
	if (context.name.empty())
	{
		return "nook_" + derived;
	}
	if (!isIdentifier(context.name))
	{
		throw Error(ExitCode::usage,
					"name: found " + jsonText(context.name) + ", expected letters, digits and single underscores, a letter first");
	}
	return context.name;
}

// Macros share one global namespace, so all begin with NOOK_.
std::string macroStem(const std::string& stem)
{
	std::string macro = stem;
	std::transform(macro.begin(), macro.end(), macro.begin(),
				   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
	return macro.starts_with("NOOK_") ? macro : "NOOK_" + macro;
}

std::string sampleComment(Domain domain)
{
	switch (domain)
	{
	case Domain::disk: return "x, y, half length of the line sqrt(1 - x^2 - y^2), weight; the weights sum to 1";
	case Domain::ball: return "x, y, z in the unit ball, weight; the weights sum to 1";
	case Domain::sphere: return "unit direction x, y, z, weight; the weights sum to 1";
	case Domain::hemisphere: return "unit direction x, y, z with z >= 0 (cosine-weighted), weight; the weights sum to 1";
	case Domain::slice: return "azimuth in half turns and jitter in steps, both in [0, 1), 0, weight; the weights are equal";
	}
	return {};
}

} // namespace

std::vector<Sample> samplesOf(const Pattern& pattern)
{
	std::vector<Sample> samples;
	for (std::size_t i = 0; i < pattern.count(); ++i)
	{
		const glm::dvec3& p = pattern.points[i];
		const double third = pattern.domain == Domain::disk ? std::sqrt(std::max(0.0, 1.0 - p.x * p.x - p.y * p.y)) : p.z;
		samples.push_back({toFloat(p.x), toFloat(p.y), toFloat(third), toFloat(pattern.weights[i])});
	}
	return samples;
}

const char* columnsOf(Domain domain)
{
	return domain == Domain::disk    ? "x,y,half_length,weight"
		   : domain == Domain::slice ? "azimuth,jitter,zero,weight"
									 : "x,y,z,weight";
}

std::vector<Sample> transformsOf(const PatternTile& tile)
{
	const auto sampleOf = [&tile](const TileTransform& t)
	{
		return tile.domain == Domain::ball ? Sample{toFloat(t.axis.x), toFloat(t.axis.y), toFloat(t.axis.z), toFloat(t.scale)}
										   : Sample{toFloat(t.cos), toFloat(t.sin), toFloat(t.scale), toFloat(t.handedness)};
	};
	return mapped(tile.transforms, sampleOf);
}

const char* transformColumnsOf(Domain domain)
{
	return domain == Domain::ball ? "x,y,z,scale" : "cos,sin,scale,handedness";
}

std::string variantText(const PatternTile& tile, const std::string& side)
{
	const bool moves = !tile.moves.empty();
	const std::string own = moves ? "((y + move.y) % " + side + ") * " + side + " + (x + move.x) % " + side
								  : "(y % " + side + ") * " + side + " + x % " + side;
	const std::string frame = "frame % " + std::to_string(tile.frames);
	return own + (moves ? ", move that of " + frame : tile.frames > 1 ? " + (" + frame + ") * " + side + " * " + side : "");
}

Source sourceOf(const Pattern& pattern, const Recipe* recipe, const Quality& quality, const EmitContext& context)
{
	const std::string stem = stemOf(context, shortName(pattern.domain, pattern.count(), recipe));
	const std::string macro = macroStem(stem);
	Source source;
	source.notes = notesOf(context, measuresOf(quality));
	source.guard = macro;
	source.constants.push_back({macro + "_COUNT", static_cast<int>(pattern.count()), "samples"});
	source.arrays.push_back({stem + "_points", macro + "_COUNT", sampleComment(pattern.domain), samplesOf(pattern)});
	return source;
}

Source sourceOf(const PatternTile& tile, const TileQuality& quality, const EmitContext& context)
{
	const std::size_t count = tile.variants.front().count();
	const std::string size = std::to_string(tile.size);
	const std::string stem = stemOf(context, shortName(tile.domain, count, nullptr) + "_tile" + size);
	const std::string macro = macroStem(stem);
	Source source;
	source.notes = notesOf(context, measuresOf(quality));
	source.guard = macro;
	const int variants = static_cast<int>(tile.variants.size());
	source.constants.push_back({macro + "_SIZE", tile.size, "pixels along a side of the window"});
	source.constants.push_back({macro + "_VARIANTS", variants, "variant of a pixel = " + variantText(tile, "SIZE")});
	if (tile.frames > 1)
	{
		source.constants.push_back({macro + "_FRAMES", tile.frames, "of a cycle"});
	}
	if (!tile.moves.empty())
	{
		SourceArray moves{stem + "_moves", macro + "_FRAMES", "pixels x, y that the tile moves by in each frame", {}};
		for (const glm::ivec2& move : tile.moves)
		{
			moves.rows.push_back({static_cast<float>(move.x), static_cast<float>(move.y), 0.0f, 0.0f});
		}
		source.arrays.push_back(std::move(moves));
	}
	source.constants.push_back({macro + "_COUNT", static_cast<int>(count), "samples of a variant"});
	source.constants.push_back({macro + "_TOTAL", variants * static_cast<int>(count), "samples of all variants"});
	if (!tile.transforms.empty())
	{
		const bool ball = tile.domain == Domain::ball;
		source.arrays.push_back(
			{stem + "_transforms", macro + "_VARIANTS",
			 ball ? "reflects the base pattern about this direction: x, y, z, scale; one a variant"
				  : "turns the base pattern: cos c, sin s, scale k, handedness h: k (c x - s h y, s x + c h y); one a variant",
			 transformsOf(tile)});
	}
	SourceArray points{
		stem + "_points", macro + "_TOTAL", sampleComment(tile.domain) + " in each variant; index = variant * COUNT + sample", {}};
	for (const Pattern& variant : tile.variants)
	{
		const std::vector<Sample> samples = samplesOf(variant);
		points.rows.insert(points.rows.end(), samples.begin(), samples.end());
	}
	source.arrays.push_back(std::move(points));
	return source;
}

} // namespace nook
