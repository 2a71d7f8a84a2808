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

std::vector<Pattern> variantsOf(const std::string& path, const ShadeSettings& settings, const RunSettings& run)
{
	const Domain domain = domainOf(settings.method);
	if (path.empty())
	{
		TileRecipe tile;
		tile.kind = TileKind::random;
		return generateTile(defaultPattern(settings, run), tile, run).variants;
	}
	std::variant<PatternFile, TileFile> input = readInput(path, domain);
	std::vector<Pattern> variants;
	if (PatternFile* const file = std::get_if<PatternFile>(&input))
	{
		completeWeights(*file);
		variants = {file->pattern};
	}
	else
	{
		variants = std::get<TileFile>(input).tile.variants;
	}
	if (settings.bands.count > 1)
	{
		checkProgressive(input, path);
	}
	if (variants.front().domain != domain)
	{
		throw Error(ExitCode::invalid_input, path + ": domain: found " + std::string(nameOf(variants.front().domain)) +
												 ", expected " + std::string(nameOf(domain)) + " for --method " +
												 std::string(nameOf(settings.method)));
	}
	return variants;
}

} // namespace

ShadeSamples shadeSamples(const std::string& path, const ShadeSettings& settings, const RunSettings& run)
{
	if (!takesPattern(settings.method))
	{
		return ownSamples(settings);
	}
	std::vector<Pattern> variants = variantsOf(path, settings, run);
	if (settings.volume.paired)
	{
		for (Pattern& variant : variants)
		{
			variant = pairedPattern(variant);
		}
	}
	return samplesOf(settings.method, variants);
}

} // namespace nook
