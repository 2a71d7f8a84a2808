// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/candidates.h"

#include "core/number.h"

#include <array>
#include <cassert>

namespace nook
{

template <> std::span<const std::string_view> namesOf<Origin>()
{
	static constexpr std::array<std::string_view, 3> kNames{"paper", "ours", "rays"};
	return kNames;
}

template <> std::span<const std::string_view> namesOf<SampleSource>()
{
	static constexpr std::array<std::string_view, 6> kNames{"own", "electro", "uniform", "refined", "tile", "spiral"};
	return kNames;
}

template <> std::span<const std::string_view> namesOf<VolumeRecipe>()
{
	static constexpr std::array<std::string_view, 3> kNames{"triangles", "built", "masks"};
	return kNames;
}

template <> std::span<const std::string_view> namesOf<GridSize>()
{
	static constexpr std::array<std::string_view, 3> kNames{"quick", "normal", "full"};
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
	const ShadeSettings& shade = candidate.shade;
	std::string name(nameOf(shade.method));
	add(name, std::to_string(candidate.count));
	if (shade.method == ShadeMethod::statvo)
	{
		const StatVoSettings& statvo = shade.statvo;
		for (const auto& [on, word] : {std::pair<bool, std::string>{statvo.layering == StatVoLayering::uniform, "uniform"},
									   {statvo.quadrants, "quadrants"},
									   {statvo.cell_px > 1, "cells-" + std::to_string(statvo.cell_px)},
									   {statvo.skip, "skip"}})
		{
			if (on)
			{
				add(name, word);
			}
		}
	}
	if (candidate.source != SampleSource::own)
	{
		add(name, std::string(nameOf(candidate.source)));
	}
	if (shade.filter != ShadeFilter::none)
	{
		add(name, shade.filter == ShadeFilter::window ? "window" : "bilateral-" + std::to_string(shade.filter_taps));
	}
	for (const auto& [on, word] : {std::pair<bool, const char*>{candidate.thickness_ratio > 0.0, "thick"},
								   {shade.volume.paired, "paired"},
								   {shade.volume.quadratic, "quadratic"},
								   {!shade.use_normal, "no-normal"},
								   {shade.bands.count > 1, "bands"},
								   {shade.cut, "cut"},
								   {shade.method == ShadeMethod::alchemy && shade.depth_levels > 0, "levels"},
								   {shade.half_resolution, "half"}})
	{
		if (on)
		{
			add(name, word);
		}
	}
	return name;
}

} // namespace

std::string Candidate::method() const
{
	return kind == CandidateKind::screen    ? std::string(nameOf(shade.method))
		   : kind == CandidateKind::volumes ? aov.mask ? "aov-mask" : "aov"
											: "rays";
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
	if (candidate.kind == CandidateKind::rays)
	{
		return best;
	}
	ShadeSettings& shade = best.shade;
	shade.filter = ShadeFilter::none;
	shade.half_resolution = false;
	shade.bands = {};
	shade.depth_levels = 0;
	best.count = 256;
	if (takesPattern(shade.method))
	{
		best.source = SampleSource::spiral;
	}
	if (shade.method == ShadeMethod::crytek)
	{
		best.source = SampleSource::own; // its points are not even over the ball
	}
	if (shade.method == ShadeMethod::sao)
	{
		shade.rival.spiral_samples = best.count;
	}
	if (shade.method == ShadeMethod::statvo)
	{
		best.count = 4;
		shade.statvo = {};
		shade.statvo.quadrants = true;
		shade.statvo.skip = false;
	}
	if (shade.method == ShadeMethod::hbao)
	{
		best.count = 32;
		shade.rival.directions = best.count;
		shade.rival.steps = 32;
	}
	return best;
}

} // namespace nook
