// SPDX-License-Identifier: GPL-3.0-or-later
// Hand-made patterns and tiles for the tests of emission: independent of generators, with awkward bits.
#pragma once

#include "testing.h"

#include "core/round.h"
#include "format/pattern_file.h"

namespace nook::test
{

inline constexpr std::array kDomains{Domain::disk, Domain::ball, Domain::sphere, Domain::hemisphere};

inline Pattern scatteredPattern(Domain domain, int count, uint64_t seed = 7)
{
	Random random(seed);
	Pattern pattern;
	pattern.domain = domain;
	double sum = 0.0;
	while (pattern.count() < static_cast<std::size_t>(count))
	{
		glm::dvec3 p{2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0};
		p.z = domain == Domain::disk ? 0.0 : domain == Domain::hemisphere ? std::fabs(p.z) : p.z;
		const double length = glm::length(p);
		if (length > 0.999 || length < 0.01)
		{
			continue;
		}
		p /= isDirectional(domain) ? length : 1.0;
		pattern.points.emplace_back(roundToFloat(p.x), roundToFloat(p.y), roundToFloat(p.z));
		pattern.weights.push_back(0.5 + random.uniform());
		sum += pattern.weights.back();
	}
	for (double& weight : pattern.weights)
	{
		weight = roundToFloat(weight / sum);
	}
	return pattern;
}

inline Quality awkwardQuality()
{
	Quality quality;
	quality.plane = 0.1 / 3.0;
	quality.noise = 1e-300;
	quality.cliff = 0.0488;
	quality.energy = std::numeric_limits<double>::infinity();
	return quality;
}

inline void emitPattern(const std::string& path, const Pattern& pattern, const Quality& quality, const EmitContext& context)
{
	writeFile(path, patternBytes(formatOf(path, patternFormats()), pattern, nullptr, quality, context));
}

inline void emitTile(const std::string& path, const PatternTile& tile, const EmitContext& context)
{
	writeFile(path, tileBytes(formatOf(path, tileFormats()), tile, nullptr, {}, context));
}

inline EmitContext contextOf(const std::string& command)
{
	return {command, "0.1.0", "", ""};
}

inline Recipe recipeOf(const Pattern& pattern)
{
	Recipe recipe{.domain = pattern.domain, .count = static_cast<int>(pattern.count()), .seed = 4000000000U};
	return recipe;
}

inline PatternTile scatteredTile(Domain domain, int size, int count, bool transforms)
{
	PatternTile tile;
	tile.domain = domain;
	tile.size = size;
	for (int i = 0; i < size * size; ++i)
	{
		tile.variants.push_back(scatteredPattern(domain, count, static_cast<uint64_t>(i) + 1));
		if (transforms)
		{
			const double c = roundToFloat(1.0 / (i + 1));
			const double s = roundToFloat(std::sqrt(1.0 - c * c));
			tile.transforms.push_back(domain == Domain::ball
										  ? TileTransform{1.0, 0.0, 1.0, 1.0, {c, s, 0.0}}
										  : TileTransform{c, s, roundToFloat(1.0 - 0.01 * i), i % 2 == 0 ? 1.0 : -1.0, {}});
		}
	}
	return tile;
}

} // namespace nook::test
