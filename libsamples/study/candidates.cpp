// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/candidates.h"

#include "core/lists.h"
#include "methods/feature_table.h"
#include "pattern/recipe.h"

#include <cassert>
#include <utility>

namespace nook
{
namespace
{

std::string screenName(const Candidate& candidate)
{
	const ShadeSettings shade = shadeSettingsOf(candidate, 1.0);
	std::string name(nameOf(shade.method));
	name += " " + std::to_string(candidate.count);
	if (candidate.source != SampleSource::own)
	{
		name += " " + std::string(nameOf(candidate.source));
	}
	if (shade.filter != ShadeFilter::none)
	{
		name += " " + valueText(featureOf("--filter"), shade);
		name += shade.filter == ShadeFilter::bilateral ? "-" + std::to_string(shade.filter_taps) : "";
	}
	return name + (candidate.recipe ? featureWords(candidate.shade) + " rays" : featureWords(shade));
}

// The samples of candidates.

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

// The list of candidates: the axes of each row of the table of methods, volumes and rays.

class Grid
{
public:
	explicit Grid(GridSize size) : m_size(size) {}

	std::vector<Candidate> take()
	{
		for (const MethodRow& row : methodTable())
		{
			if (row.kind == MethodKind::screen)
			{
				for (const CandidateAxes& axes : row.axes(m_size))
				{
					multiply(row, axes);
				}
			}
		}
		assets();
		rays();
		return std::move(m_all);
	}

private:
	void multiply(const MethodRow& row, const CandidateAxes& axes)
	{
		for (const int count : axes.counts)
		{
			for (const SampleSource source : axes.sources)
			{
				if (source == SampleSource::tile && count > kMaxTileCount)
				{
					continue;
				}
				Candidate candidate;
				candidate.origin = axes.origin;
				candidate.only_form = axes.only_form;
				candidate.radius_ratio = row.radius_ratio;
				candidate.source = source;
				candidate.count = count;
				for (const ShadeSettings& form : axes.forms)
				{
					candidate.shade = form;
					candidate.shade.method = row.method;
					if (row.set_count != nullptr)
					{
						row.set_count(candidate.shade, count);
					}
					addFiltered(candidate, axes);
				}
			}
		}
	}

	void addFiltered(Candidate candidate, const CandidateAxes& axes)
	{
		for (const FilterChoice& filter : axes.filters)
		{
			candidate.shade.filter = filter.filter;
			candidate.shade.filter_taps = filter.taps;
			for (const double thickness : axes.thickness)
			{
				candidate.thickness_ratio = thickness;
				for (const bool half : axes.half)
				{
					candidate.shade.half_resolution = half;
					addRecipes(candidate, axes);
				}
			}
		}
	}

	void addRecipes(Candidate candidate, const CandidateAxes& axes)
	{
		for (const bool rays : axes.rays)
		{
			const MethodRecipe* const recipe = rays ? recipeFor(raysRecipes(), candidate.shade.method) : nullptr;
			candidate.recipe = recipe != nullptr ? std::optional(*recipe) : std::nullopt;
			if (!rays || recipe != nullptr)
			{
				m_all.push_back(candidate);
			}
		}
	}

	void assets()
	{
		for (const AssetKind& kind : assetTable())
		{
			for (const AssetCandidate& one : kind.candidates(m_size))
			{
				Candidate candidate;
				static_cast<AssetSettings&>(candidate) = one.settings;
				candidate.kind = CandidateKind::asset;
				candidate.asset = &kind;
				candidate.origin = one.origin;
				m_all.push_back(candidate);
			}
		}
	}

	void rays()
	{
		for (const int count : upTo<int>(m_size, {1, 8, 64}, {1, 4, 16, 64, 256}, {1, 2, 4, 8, 16, 32, 64, 128, 256}))
		{
			Candidate candidate;
			candidate.kind = CandidateKind::rays;
			candidate.origin = Origin::rays;
			candidate.count = count;
			m_all.push_back(candidate);
		}
	}

	GridSize m_size;
	std::vector<Candidate> m_all;
};

} // namespace

const MethodRow* Candidate::row() const
{
	return kind == CandidateKind::screen ? &rowOf(shade.method) : kind == CandidateKind::asset ? methodNamed(asset->name) : nullptr;
}

std::string Candidate::method() const
{
	return kind == CandidateKind::asset ? std::string(asset->name) : row() != nullptr ? std::string(row()->name) : "rays";
}

std::string Candidate::resolution() const
{
	const bool own = kind == CandidateKind::asset && asset->resolution != nullptr;
	return own ? std::string(asset->resolution(*this)) : kind == CandidateKind::screen && shade.half_resolution ? "half" : "full";
}

std::string Candidate::name() const
{
	switch (kind)
	{
	case CandidateKind::screen: return screenName(*this);
	case CandidateKind::asset: return method() + asset->words(*this);
	case CandidateKind::rays: break;
	}
	return "rays " + std::to_string(count);
}

ShadeSettings shadeSettingsOf(const Candidate& candidate, double radius_m)
{
	assert(candidate.kind == CandidateKind::screen);
	ShadeSettings settings = candidate.shade;
	if (candidate.recipe)
	{
		applyRecipe(settings, *candidate.recipe, radius_m);
		return settings;
	}
	settings.radius_m = candidate.radius_ratio * radius_m;
	settings.volume.thickness_m = candidate.thickness_ratio * settings.radius_m;
	return settings;
}

Candidate definitionOf(const Candidate& candidate)
{
	Candidate best = candidate;
	if (candidate.kind == CandidateKind::asset && candidate.asset->definition != nullptr)
	{
		static_cast<AssetSettings&>(best) = candidate.asset->definition(candidate);
	}
	if (candidate.kind != CandidateKind::screen)
	{
		return best;
	}
	ShadeSettings& shade = best.shade;
	shade.filter = ShadeFilter::none;
	shade.half_resolution = false;
	shade.bands = {};
	shade.depth_levels = 0;
	const MethodRow& row = rowOf(shade.method);
	best.count = row.set_best != nullptr ? row.set_best(shade) : 256;
	best.source = row.domain && row.own_pattern == nullptr ? SampleSource::spiral : SampleSource::own;
	return best;
}

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
		for (Recipe recipe = made.recipe; recipe.seed <= kWindow_px * kWindow_px; ++recipe.seed) // from 1
		{
			made.variants.push_back(generatePattern(recipe, run));
		}
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
		TileRecipe tile{.kind = TileKind::random};
		variants = generateTile(rowOf(settings.method).own_pattern(candidate.count), tile, run).variants;
	}
	else
	{
		variants = patternOf(candidate, run).variants;
	}
	return samplesOf(settings.method, settings.volume.paired ? mapped(variants, pairedPattern) : variants);
}

const ShadeSamples& SampleStore::samplesOf(const Candidate& candidate, const ShadeSettings& settings, const RunSettings& run)
{
	const std::string key = candidate.method() + " " + std::to_string(candidate.count) + " " +
							std::string(nameOf(candidate.source)) + (settings.volume.paired ? " paired" : "") +
							(settings.bands.count > 1 ? " bands" : "");
	const auto found = m_made.find(key);
	return found != m_made.end() ? found->second : m_made.emplace(key, nook::samplesOf(candidate, settings, run)).first->second;
}

std::vector<Candidate> candidateGrid(GridSize size)
{
	return Grid(size).take();
}

} // namespace nook
