// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade_samples.h"

#include "core/error.h"
#include "format/input.h"
#include "methods/method_table.h"
#include "pattern/generate.h"
#include "pattern/tile.h"

namespace nook
{
namespace
{

// Without --pattern.
Pattern defaultPattern(const ShadeSettings& settings, const RunSettings& run)
{
	const MethodRow& row = rowOf(settings.method);
	if (row.own_pattern != nullptr)
	{
		return row.own_pattern(row.default_count);
	}
	Recipe recipe;
	recipe.domain = domainOf(settings.method);
	recipe.count = row.default_count / radiiOf(settings.volume); // as many depths
	recipe.symmetric = settings.volume.paired;
	recipe.order = settings.bands.count > 1 ? Order::progressive : Order::none;
	return generatePattern(recipe, run);
}

PatternTile tileFor(const std::string& path, const ShadeSettings& settings, const RunSettings& run)
{
	const Domain domain = domainOf(settings.method);
	if (path.empty())
	{
		TileRecipe tile;
		tile.kind = TileKind::random;
		return generateTile(defaultPattern(settings, run), tile, run);
	}
	std::variant<PatternFile, TileFile> input =
		readInput(path, mayTakeTile(settings.method) ? std::nullopt : std::optional(domain));
	PatternTile tile;
	if (PatternFile* const file = std::get_if<PatternFile>(&input))
	{
		completeWeights(*file);
		tile.domain = file->pattern.domain;
		tile.size = 1;
		tile.variants = {file->pattern};
	}
	else
	{
		tile = std::get<TileFile>(input).tile;
	}
	if (settings.bands.count > 1)
	{
		checkProgressive(input, path);
	}
	if (tile.domain != domain)
	{
		throw Error(ExitCode::invalid_input, path + ": domain: found " + std::string(nameOf(tile.domain)) + ", expected " +
												 std::string(nameOf(domain)) + " for --method " +
												 std::string(nameOf(settings.method)));
	}
	return tile;
}

} // namespace

ShadeSamples shadeSamples(const std::string& path, const std::optional<int>& frame, const ShadeSettings& settings,
						  const RunSettings& run)
{
	const bool tile_alone = mayTakeTile(settings.method) && !path.empty();
	if (frame && (path.empty() || !(takesPattern(settings.method) || tile_alone)))
	{
		throw Error(ExitCode::usage, "--frame: found without a tile, expected --pattern with one made by nook tile --frames");
	}
	if (!takesPattern(settings.method) && !tile_alone)
	{
		return ownSamples(settings);
	}
	PatternTile tile = tileFor(path, settings, run);
	if (frame && tile.frames == 1)
	{
		throw Error(ExitCode::invalid_input, path + ": frames: found one, expected several for --frame");
	}
	if (settings.volume.paired)
	{
		for (Pattern& variant : tile.variants)
		{
			variant = pairedPattern(variant);
		}
	}
	ShadeSamples samples = samplesOf(settings.method, tile.variants, layersOf(tile));
	samples.variant = variantOfFrame(tile, frame.value_or(0));
	return samples;
}

} // namespace nook
