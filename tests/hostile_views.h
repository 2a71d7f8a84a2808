// SPDX-License-Identifier: GPL-3.0-or-later
// Hostile G-buffers, and settings for shading them: depths of any size, projections of any scale. Choices come from `Source`, which
// has below(n) and number(), any float.
#pragma once

#include "scene/gbuffer.h"
#include "shade/shade.h"

#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace nook::test
{

struct HostileView
{
	GBuffer gbuffer;
	ShadeSettings settings;
	ShadeSamples samples;
};

// From zero and the smallest normal number through typical values to infinity.
template <class Source> float hostileDepth(Source& source)
{
	constexpr std::array<float, 16> kSome{
		1e-45F, 1e-40F,  1.17e-38F, 1.2e-38F, 1e-30F, 1e-12F,  1e-6F, 0.1F,
		1.0F,   1.0001F, 50.0F,     1e6F,     1e12F,  9.9e29F, 3e38F, std::numeric_limits<float>::infinity()};
	const auto which = source.below(kSome.size() + 1);
	return which < kSome.size() ? kSome[which] : std::fabs(source.number());
}

// Mostly 1.
template <class Source> double hostileScale(Source& source)
{
	constexpr std::array<double, 7> kSome{1e30, 1e-30, 1e9, 1e-9, 1e38, 1e-38, 3.0};
	const auto which = source.below(4 * kSome.size());
	return which < kSome.size() ? kSome[which] : 1.0;
}

template <class Source> glm::dmat4 hostileProjection(Source& source)
{
	glm::dmat4 p(0.0);
	p[0][0] = 1.5 * hostileScale(source);
	p[1][1] = source.below(4) == 0 ? 2.0 * hostileScale(source) : p[0][0] * 4.0 / 3.0;
	p[2][2] = -1.0;
	p[3][2] = -0.2 * hostileScale(source);
	const bool parallel = source.below(3) == 0;
	p[parallel ? 3 : 2][3] = parallel ? 1.0 : -1.0;
	if (source.below(4) == 0)
	{
		p[3][3] += hostileScale(source) * (source.below(2) == 0 ? 1.0 : -1.0);
	}
	if (source.below(4) == 0)
	{
		p[2][0] = 0.3 * hostileScale(source);
		p[3][1] = 0.3 * hostileScale(source);
	}
	return p * hostileScale(source);
}

// 9 x 7 pixels, so that levels and tiles of 8 have a remainder; depths mostly similar, or all arbitrary.
template <class Source> GBuffer hostileGBuffer(Source& source)
{
	GBuffer gbuffer{9, 7, {glm::dmat4(1.0), hostileProjection(source)}, 0.0, {}, {}};
	const float common = source.below(4) != 0 ? 1.0F : hostileDepth(source);
	const auto others = source.below(4); // in eighths
	const bool errors = source.below(4) == 0;
	for (int i = 0; i < 63; ++i)
	{
		gbuffer.depth.push_back(source.below(8) < others ? hostileDepth(source) : common);
		const auto turn = source.below(4);
		gbuffer.normals.push_back(turn == 0 ? glm::vec3(1.0F, 0.0F, 0.0F)
											: glm::vec3(0.0F, turn == 1 ? 0.6F : 0.0F, turn == 1 ? 0.8F : 1.0F));
		if (errors)
		{
			gbuffer.depth_error_m.push_back(std::isinf(gbuffer.depth.back()) ? 0.0F : hostileDepth(source));
			if (std::isinf(gbuffer.depth_error_m.back()))
			{
				gbuffer.depth_error_m.back() = 0.0F;
			}
		}
	}
	return gbuffer;
}

// Samples of a method: two pairs of opposite samples, in a window of 2 x 2 pixels.
inline ShadeSamples hostileSamples(const ShadeSettings& settings)
{
	if (!takesPattern(settings.method))
	{
		return ownSamples(settings);
	}
	std::vector<Pattern> variants(4);
	for (std::size_t i = 0; i < variants.size(); ++i)
	{
		const double z = domainOf(settings.method) == Domain::ball ? 0.4 : 0.0;
		const double far = 0.5 + 0.1 * static_cast<double>(i);
		variants[i].domain = domainOf(settings.method);
		variants[i].points = {{far, 0.1, z}, {-far, -0.1, -z}, {-0.1, far, z}, {0.1, -far, -z}};
		variants[i].weights = {0.3, 0.3, 0.2, 0.2};
	}
	return samplesOf(settings.method, variants);
}

template <class Source> ShadeSettings hostileSettings(Source& source)
{
	ShadeSettings settings;
	settings.method = static_cast<ShadeMethod>(source.below(namesOf<ShadeMethod>().size()));
	constexpr std::array<double, 4> kRadii{0.5, 1e-6, 1e6, 0.01};
	settings.radius_m = kRadii[source.below(kRadii.size())];
	settings.max_radius_px = source.below(2) == 0 ? 0.0 : 65536.0;
	settings.min_radius_px = source.below(2) == 0 ? 0.0 : 5.0;
	settings.use_normal = source.below(2) == 0;
	settings.normal_bits = source.below(2) == 0 ? 32 : 8;
	settings.cut = source.below(2) == 0;
	settings.depth_levels = static_cast<int>(source.below(3));
	settings.filter = static_cast<ShadeFilter>(source.below(takesPattern(settings.method) ? 3 : 2));
	settings.half_resolution = source.below(2) == 0;
	settings.bands.count = 1 + static_cast<int>(source.below(3));
	settings.volume.thickness_m = source.below(2) == 0 ? 0.0 : 1e6;
	settings.volume.radii = static_cast<TwoRadii>(source.below(3));
	settings.volume.second_radius_m = 2.0;
	settings.volume.quadratic = source.below(2) == 0;
	settings.volume.paired =
		(settings.method == ShadeMethod::vo_line || settings.method == ShadeMethod::vo_area) && source.below(2) == 0;
	settings.statvo.layering = static_cast<StatVoLayering>(source.below(2));
	settings.statvo.layers = 1 << source.below(settings.statvo.layering == StatVoLayering::uniform ? 7 : 3);
	settings.statvo.quadrants = source.below(2) == 0;
	settings.statvo.cell_px = 1 << source.below(3);
	settings.statvo.height = source.below(2) == 0 ? 1.0 : 100.0;
	settings.statvo.slope = source.below(2) == 0 ? 1.0 : 1e-3;
	settings.statvo.builder = source.below(2) == 0 ? TableBuilder::automatic : TableBuilder::fragments;
	settings.statvo.skip = source.below(2) == 0;
	const auto view = static_cast<DebugView>(source.below(5));
	if (source.below(4) == 0 && debugShows(view, settings))
	{
		settings.debug = view;
	}
	return settings;
}

template <class Source> HostileView hostileView(Source& source)
{
	HostileView view;
	view.gbuffer = hostileGBuffer(source);
	view.settings = hostileSettings(source);
	view.samples = hostileSamples(view.settings);
	return view;
}

} // namespace nook::test
