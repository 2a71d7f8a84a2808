// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/rotations.h"

#include "core/math.h"
#include "core/random.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

constexpr std::size_t kAngles = 4096;
constexpr double kGolden = 0.6180339887498949;

double fraction(double x)
{
	return x - std::floor(x);
}

double turnOf(RotationNoise noise, int x, int y, int frame, Random& random)
{
	switch (noise)
	{
	case RotationNoise::white: return random.uniform();
	case RotationNoise::sixteen:
	{
		// Ordered dither (Bayer 1973): near pixels are far apart in angle.
		const auto quarter = [](int a, int b)
		{
			return 2 * ((a ^ b) & 1) + (b & 1);
		};
		return fraction((4 * quarter(x, y) + quarter(x >> 1, y >> 1)) / 16.0 + frame * kGolden);
	}
	case RotationNoise::gradient:
		return fraction(52.9829189 * fraction(0.06711056 * (x + 5.588238 * frame) + 0.00583715 * (y + 5.588238 * frame)));
	case RotationNoise::r2: return fraction(0.7548776662466927 * x + 0.5698402909980532 * y + frame * kGolden);
	}
	return 0.0;
}

struct Lag
{
	int x;
	int y;
	int frame;
	double share;
};

std::vector<Lag> lagsOf(const TileShares& shares)
{
	std::vector<Lag> lags;
	for (int i = 0; i < static_cast<int>(shares.pairs.size()); ++i)
	{
		if (const double share = shares.pairs[static_cast<std::size_t>(i)]; share != 0.0)
		{
			lags.push_back({i % shares.size, i / shares.size % shares.size, i / (shares.size * shares.size), share});
		}
	}
	return lags;
}

int at(const Rotations& rotations, int x, int y, int frame)
{
	return (frame % rotations.frames * rotations.size + y % rotations.size) * rotations.size + x % rotations.size;
}

// visit(index of the angle that is a lag away from that at `index`, its share)
template <class Visit> void eachPair(const Rotations& rotations, const std::vector<Lag>& lags, int index, Visit visit)
{
	const int x = index % rotations.size;
	const int y = index / rotations.size % rotations.size;
	const int frame = index / (rotations.size * rotations.size);
	for (const Lag& lag : lags)
	{
		visit(at(rotations, x + lag.x, y + lag.y, frame + lag.frame), lag.share);
	}
}

} // namespace

Rotations rotationsOf(RotationNoise noise, int size, int frames, uint64_t seed)
{
	Rotations rotations{size, frames, {}};
	Random random(seed);
	for (int frame = 0; frame < frames; ++frame)
	{
		for (int y = 0; y < size; ++y)
		{
			for (int x = 0; x < size; ++x)
			{
				rotations.turns.push_back(turnOf(noise, x, y, frame, random));
			}
		}
	}
	return rotations;
}

Pattern turned(const Pattern& pattern, double turns)
{
	Pattern result = pattern;
	const SinCos turn = sinCosOf(2.0 * kPi * turns);
	for (glm::dvec3& p : result.points)
	{
		p = glm::dvec3(turn.cos * p.x - turn.sin * p.y, turn.sin * p.x + turn.cos * p.y, p.z);
	}
	return result;
}

// The squared error is Σ s_ij K(t_i − t_j) + constant with Σ s_ij = 1; of two patterns' mean ½ K(0) + ½ K(t) + constant.
RotationError::RotationError(const Pattern& pattern)
{
	const double alone = squaredError(pattern.domain, Ensemble::plane, Part::whole, pattern.points, pattern.weights);
	for (std::size_t angle = 0; angle < kAngles; ++angle)
	{
		const Pattern other = turned(pattern, static_cast<double>(angle) / kAngles);
		std::vector<glm::dvec3> points = pattern.points;
		std::vector<double> weights;
		points.insert(points.end(), other.points.begin(), other.points.end());
		for (int side = 0; side < 2; ++side)
		{
			for (const double weight : pattern.weights)
			{
				weights.push_back(0.5 * weight);
			}
		}
		m_pairs.push_back(2.0 * squaredError(pattern.domain, Ensemble::plane, Part::whole, points, weights) - alone);
	}
}

double RotationError::pairOf(double turn) const
{
	return m_pairs[static_cast<std::size_t>(std::lround(fraction(turn) * kAngles)) % kAngles];
}

double RotationError::of(const Rotations& rotations, const TileShares& shares) const
{
	const std::vector<Lag> lags = lagsOf(shares);
	double sum = 0.0;
	for (std::size_t i = 0; i < rotations.turns.size(); ++i)
	{
		eachPair(rotations, lags, static_cast<int>(i),
				 [&](int j, double share)
				 { sum += share * pairOf(rotations.turns[i] - rotations.turns[static_cast<std::size_t>(j)]); });
	}
	return std::sqrt(std::max(0.0, sum / static_cast<double>(rotations.turns.size())));
}

Rotations RotationError::optimised(int size, int frames, const TileShares& shares, int sweeps, uint64_t seed) const
{
	Rotations rotations{size, frames, {}};
	const auto number = static_cast<std::size_t>(size) * static_cast<std::size_t>(size) * static_cast<std::size_t>(frames);
	Random random(seed);
	for (std::size_t i = 0; i < number; ++i)
	{
		rotations.turns.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(number));
		std::swap(rotations.turns[i], rotations.turns[random.below(static_cast<uint32_t>(i + 1))]);
	}
	const std::vector<Lag> lags = lagsOf(shares);
	for (std::size_t step = 0; step < number * static_cast<std::size_t>(sweeps); ++step)
	{
		const auto i = static_cast<int>(random.below(static_cast<uint32_t>(number)));
		const auto j = static_cast<int>(random.below(static_cast<uint32_t>(number)));
		double& one = rotations.turns[static_cast<std::size_t>(i)];
		double& two = rotations.turns[static_cast<std::size_t>(j)];
		// What the swap adds: pairs with themselves and with each other stay.
		double added = 0.0;
		const auto add = [&](int index, double to, double from)
		{
			eachPair(rotations, lags, index,
					 [&](int k, double share)
					 {
						 const double other = rotations.turns[static_cast<std::size_t>(k)];
						 added += k == i || k == j ? 0.0 : share * (pairOf(to - other) - pairOf(from - other));
					 });
		};
		add(i, two, one);
		add(j, one, two);
		if (added < 0.0)
		{
			std::swap(one, two);
		}
	}
	return rotations;
}

} // namespace nook
