// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/candidates.h"

#include "core/number.h"
#include "methods/feature_table.h"

#include <array>
#include <cassert>

namespace nook
{

template <> std::span<const std::string_view> namesOf<VolumeRecipe>()
{
	static constexpr std::array<std::string_view, 3> kNames{"triangles", "built", "masks"};
	return kNames;
}

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
	return kind == CandidateKind::screen ? &rowOf(shade.method) : kind == CandidateKind::volumes ? &volumeRow(aov.mask) : nullptr;
}

std::string Candidate::method() const
{
	return row() != nullptr ? std::string(row()->name) : kind == CandidateKind::bake ? "bake" : "rays";
}

std::string Candidate::resolution() const
{
	if (kind == CandidateKind::volumes)
	{
		return aov.every_px == 3 ? "third" : aov.every_px == 5 ? "fifth" : "full";
	}
	return kind == CandidateKind::screen && shade.half_resolution ? "half" : "full";
}

std::string Candidate::name() const
{
	const std::string scaled = scale != 1.0 ? " x" + numberText(scale) : "";
	if (kind == CandidateKind::screen)
	{
		return screenName(*this) + scaled;
	}
	std::string name = method();
	if (kind == CandidateKind::bake)
	{
		if (bake_error > 0.0)
		{
			add(name, numberText(bake_error));
		}
		return name;
	}
	if (kind == CandidateKind::rays)
	{
		add(name, std::to_string(count));
		return name;
	}
	if (aov.mask)
	{
		add(name, std::to_string(aov.directions));
	}
	if (!aov.mask || volumes != VolumeRecipe::masks)
	{
		add(name, std::string(nameOf(volumes)));
	}
	if (!aov.mask && !aov.compensate)
	{
		add(name, "sum");
	}
	if (resolution() != "full")
	{
		add(name, resolution());
	}
	return name + scaled;
}

ShadeSettings shadeSettingsOf(const Candidate& candidate, double radius_m)
{
	assert(candidate.kind == CandidateKind::screen);
	ShadeSettings settings = candidate.shade;
	if (candidate.recipe)
	{
		applyRecipe(settings, *candidate.recipe, candidate.scale * radius_m);
		return settings;
	}
	settings.radius_m = candidate.scale * candidate.radius_ratio * radius_m;
	settings.volume.thickness_m = candidate.thickness_ratio * settings.radius_m;
	return settings;
}

Candidate definitionOf(const Candidate& candidate)
{
	Candidate best = candidate;
	if (candidate.kind == CandidateKind::volumes)
	{
		best.aov.every_px = 1;
		return best;
	}
	if (candidate.kind == CandidateKind::rays || candidate.kind == CandidateKind::bake)
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
