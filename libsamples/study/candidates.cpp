// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/candidates.h"

#include "core/decimal.h"
#include "methods/feature_table.h"

#include <cassert>

namespace nook
{

namespace
{

void add(std::string& name, const std::string& word)
{
	name += " " + word;
}

std::string screenName(const Candidate& candidate)
{
	const ShadeSettings shade = shadeSettingsOf(candidate, 1.0);
	std::string name(nameOf(shade.method));
	add(name, std::to_string(candidate.count));
	if (candidate.source != SampleSource::own)
	{
		add(name, std::string(nameOf(candidate.source)));
	}
	if (shade.filter != ShadeFilter::none)
	{
		add(name, valueText(featureOf("--filter"), shade) +
					  (shade.filter == ShadeFilter::bilateral ? "-" + std::to_string(shade.filter_taps) : ""));
	}
	return name + (candidate.recipe ? featureWords(candidate.shade) + " rays" : featureWords(shade));
}

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
	if (kind == CandidateKind::asset && asset->resolution != nullptr)
	{
		return std::string(asset->resolution(*this));
	}
	return kind == CandidateKind::screen && shade.half_resolution ? "half" : "full";
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

} // namespace nook
