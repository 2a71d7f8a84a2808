// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/rotations.h"

#include "core/math.h"
#include "core/random.h"
#include "core/sequence.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

constexpr std::size_t kAngles = 4096;
constexpr double kGolden = 0.6180339887498949;

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

// visit(index of the angle that is a lag away from that at `index`, its share), for angles of size × size pixels in `frames` frames
template <class Visit> void eachPair(int size, int frames, const std::vector<Lag>& lags, int index, Visit visit)
{
	const auto wrapped = [](int sum, int count) // both were below it
	{
		return sum < count ? sum : sum - count;
	};
	const int x = index % size;
	const int y = index / size % size;
	const int frame = index / (size * size);
	for (const Lag& lag : lags)
	{
		visit((wrapped(frame + lag.frame, frames) * size + wrapped(y + lag.y, size)) * size + wrapped(x + lag.x, size), lag.share);
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
		eachPair(rotations.size, rotations.frames, lags, static_cast<int>(i),
				 [&](int j, double share)
				 { sum += share * pairOf(rotations.turns[i] - rotations.turns[static_cast<std::size_t>(j)]); });
	}
	return std::sqrt(std::max(0.0, sum / static_cast<double>(rotations.turns.size())));
}

Rotations RotationError::optimised(int size, int frames, const TileShares& shares, int sweeps, uint64_t seed) const
{
	// The angles are even, (k + ½) / number: their order alone is looked for, and what a pair adds hangs on the difference of its
	// k.
	const int number = size * size * frames;
	std::vector<int> order;
	Random random(seed);
	for (int i = 0; i < number; ++i)
	{
		order.push_back(i);
		std::swap(order.back(), order[random.below(static_cast<uint32_t>(i + 1))]);
	}
	std::vector<double> pairs; // of differences from −number
	for (int difference = -number; difference < number; ++difference)
	{
		pairs.push_back(pairOf(static_cast<double>(difference) / number));
	}
	const double* const pair = pairs.data() + number;
	const std::vector<Lag> lags = lagsOf(shares);
	for (int64_t step = 0; step < int64_t{number} * sweeps; ++step)
	{
		const auto i = static_cast<int>(random.below(static_cast<uint32_t>(number)));
		const auto j = static_cast<int>(random.below(static_cast<uint32_t>(number)));
		int& one = order[static_cast<std::size_t>(i)];
		int& two = order[static_cast<std::size_t>(j)];
		// What the swap adds: pairs with themselves and with each other stay.
		double added = 0.0;
		const auto add = [&](int index, int to, int from)
		{
			eachPair(size, frames, lags, index,
					 [&](int k, double share)
					 {
						 const int other = order[static_cast<std::size_t>(k)];
						 added += k == i || k == j ? 0.0 : share * (pair[to - other] - pair[from - other]);
					 });
		};
		add(i, two, one);
		add(j, one, two);
		if (added < 0.0)
		{
			std::swap(one, two);
		}
	}
	Rotations rotations{size, frames, {}};
	for (const int k : order)
	{
		rotations.turns.push_back((k + 0.5) / number);
	}
	return rotations;
}

} // namespace nook
