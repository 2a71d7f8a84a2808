// SPDX-License-Identifier: GPL-3.0-or-later
// The samples of candidates.
#include "study/candidates.h"

#include "pattern/recipe.h"

#include <cassert>

namespace nook
{
namespace
{

constexpr int kWindow_px = 4;

Recipe recipeOf(const Candidate& candidate)
{
	Recipe recipe;
	recipe.domain = domainOf(candidate.shade.method);
	recipe.count = candidate.count;
	recipe.symmetric = candidate.shade.volume.paired;
	recipe.order = candidate.shade.bands.count > 1 ? Order::progressive : Order::none;
	switch (candidate.source)
	{
	case SampleSource::electro:
		// Directions have no electro of their own: cells about their centroids are what it comes to.
		recipe.method = recipe.domain == Domain::hemisphere ? Method::lloyd : Method::electro;
		recipe.weights = WeightRule::equal;
		break;
	case SampleSource::uniform:
		recipe.method = Method::random;
		recipe.weights = WeightRule::equal;
		break;
	case SampleSource::spiral: recipe.method = Method::vogel; break;
	case SampleSource::own:
	case SampleSource::refined:
	case SampleSource::tile: break;
	}
	return recipe;
}

std::vector<Pattern> independent(Recipe recipe, const RunSettings& run)
{
	std::vector<Pattern> variants;
	for (int i = 0; i < kWindow_px * kWindow_px; ++i)
	{
		recipe.seed = static_cast<uint32_t>(i + 1);
		variants.push_back(generatePattern(recipe, run));
	}
	return variants;
}

} // namespace

CandidatePattern patternOf(const Candidate& candidate, const RunSettings& run)
{
	assert(candidate.kind == CandidateKind::screen && candidate.source != SampleSource::own);
	CandidatePattern made;
	made.recipe = recipeOf(candidate);
	made.pattern = generatePattern(made.recipe, run);
	if (candidate.source == SampleSource::spiral)
	{
		made.variants = {made.pattern};
		return made;
	}
	if (candidate.source == SampleSource::uniform)
	{
		made.variants = independent(made.recipe, run);
		return made;
	}
	made.tiled = true;
	made.tile.size = kWindow_px;
	made.tile.kind = candidate.source == SampleSource::tile ? TileKind::points : TileKind::random;
	made.variants = generateTile(made.pattern, made.tile, run).variants;
	return made;
}

ShadeSamples samplesOf(const Candidate& candidate, const ShadeSettings& settings, const RunSettings& run)
{
	if (!takesPattern(settings.method))
	{
		return ownSamples(settings);
	}
	std::vector<Pattern> variants;
	if (candidate.source == SampleSource::own)
	{
		assert(rowOf(settings.method).own_pattern != nullptr);
		TileRecipe tile;
		tile.kind = TileKind::random;
		variants = generateTile(rowOf(settings.method).own_pattern(candidate.count), tile, run).variants;
	}
	else
	{
		variants = patternOf(candidate, run).variants;
	}
	if (settings.volume.paired)
	{
		for (Pattern& variant : variants)
		{
			variant = pairedPattern(variant);
		}
	}
	return samplesOf(settings.method, variants);
}

const ShadeSamples& SampleStore::samplesOf(const Candidate& candidate, const ShadeSettings& settings, const RunSettings& run)
{
	const std::string key = candidate.method() + " " + std::to_string(candidate.count) + " " +
							std::string(nameOf(candidate.source)) + (settings.volume.paired ? " paired" : "") +
							(settings.bands.count > 1 ? " bands" : "");
	const auto found = m_made.find(key);
	return found != m_made.end() ? found->second : m_made.emplace(key, nook::samplesOf(candidate, settings, run)).first->second;
}

} // namespace nook
