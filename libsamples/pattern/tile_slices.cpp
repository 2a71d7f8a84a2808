// SPDX-License-Identifier: GPL-3.0-or-later
// Every variant has its own azimuths and jitters with equal weights.
#include "core/sequence.h"
#include "pattern/starts.h"
#include "pattern/tile_parts.h"

#include <cmath>

namespace nook
{
namespace
{

constexpr double kGolden = 0.6180339887498949;
constexpr double kShake = 0.02; // fraction of a period

// Position of a pixel of a 4 × 4 block, row by row, in a Bayer matrix (nookSliceVariant).
unsigned bayer(unsigned pixel)
{
	const unsigned x = pixel % 4;
	const unsigned y = pixel / 4;
	return 4 * (2 * ((x + y) % 2) + y % 2) + 2 * ((x / 2 + y / 2) % 2) + y / 2;
}

double periodic(double x)
{
	const double inside = x - std::floor(x);
	return inside < 1.0 ? inside : 0.0;
}

// Variables: azimuth and jitter of each slice of each variant; unbounded, since both are periodic.
class SliceTile final : public TileProblem
{
public:
	SliceTile(const Pattern& base, const TileRecipe& recipe, std::size_t variants)
		: m_base(base), m_known(recipe.size == 4), m_azimuth(radicalInverse(recipe.seed - 1, 2)),
		  m_jitter(radicalInverse(recipe.seed - 1, 3)), m_variants(variants)
	{
	}

	// The base, shifted as a whole in each variant: at random or, for the first start, as the kernel shifts it without a tile,
	// which has period 4 × 4. A common shift of all variants changes no error; seeds choose it, the first seed none.
	std::vector<double> start(std::size_t number, Random& random) const override
	{
		std::vector<double> x;
		const auto count = static_cast<double>(m_base.count());
		for (std::size_t v = 0; v < m_variants; ++v)
		{
			const unsigned place = bayer(static_cast<unsigned>(v % 16));
			const bool known = number == 0 && m_known;
			const double azimuth = known ? (place + 0.5) / (16.0 * count) + m_azimuth : random.uniform();
			const double jitter = known ? radicalInverse(place, 2) + 0.5 / 16.0 + m_jitter : random.uniform();
			for (const glm::dvec3& p : m_base.points)
			{
				x.push_back(p.x + azimuth);
				x.push_back(p.y + jitter);
			}
		}
		return x;
	}

	std::vector<double> startNear(std::span<const Pattern> variants, Random& random) const override
	{
		std::vector<double> x;
		for (const Pattern& variant : variants)
		{
			for (const glm::dvec3& p : variant.points)
			{
				x.push_back(p.x + kShake * (random.uniform() - 0.5));
				x.push_back(p.y + kShake * (random.uniform() - 0.5));
			}
		}
		return x;
	}

	bool unpack(std::span<const double> x, VariantUnion& all) const override
	{
		all.points.clear();
		all.weights.clear();
		for (std::size_t i = 0; i < x.size(); i += 2)
		{
			if (!(std::fabs(x[i]) < 1e6 && std::fabs(x[i + 1]) < 1e6))
			{
				return false;
			}
			all.points.emplace_back(periodic(x[i]), periodic(x[i + 1]), 0.0);
			all.weights.push_back(1.0 / static_cast<double>(m_base.count()));
		}
		return true;
	}

	void pullBack(std::span<const double>, const VariantUnion&, const EnergyGradient& by_all,
				  std::span<double> gradient) const override
	{
		for (std::size_t i = 0; i < by_all.points.size(); ++i)
		{
			gradient[2 * i] = by_all.points[i].x;
			gradient[2 * i + 1] = by_all.points[i].y;
		}
	}

private:
	const Pattern& m_base;
	bool m_known;
	double m_azimuth;
	double m_jitter;
	std::size_t m_variants;
};

} // namespace

std::unique_ptr<TileProblem> sliceProblem(const Pattern& base, const TileRecipe& recipe, std::size_t variants)
{
	return std::make_unique<SliceTile>(base, recipe, variants);
}

Pattern slicePattern(int count)
{
	Pattern pattern;
	pattern.domain = Domain::slice;
	for (int i = 0; i < count; ++i)
	{
		pattern.points.emplace_back((i + 0.5) / count, periodic((i + 0.5) * kGolden), 0.0);
		pattern.weights.push_back(1.0 / count);
	}
	return pattern;
}

} // namespace nook
