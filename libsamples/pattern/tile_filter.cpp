// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/tile_filter.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/math.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/vec3.hpp>

namespace nook
{
namespace
{

[[noreturn]] void refuseFilter(const std::string& name)
{
	throw Error(ExitCode::usage, "filter: found '" + name +
									 "', expected none, box:N or binomial:N with N from 1 to 64, gauss:SIGMA from 0.1 to 8 or "
									 "bilateral:N, odd, from 3 to 33");
}

// Product of the same taps along both axes.
TileFilter separable(const std::string& name, const std::vector<double>& axis)
{
	std::vector<double> taps;
	for (const double y : axis)
	{
		for (const double x : axis)
		{
			taps.push_back(y * x);
		}
	}
	return tileFilterOf(name, static_cast<int>(axis.size()), std::move(taps));
}

std::vector<double> binomial(int taps)
{
	std::vector<double> row{1.0};
	while (static_cast<int>(row.size()) < taps)
	{
		row.push_back(0.0);
		for (std::size_t i = row.size() - 1; i > 0; --i)
		{
			row[i] = 0.5 * (row[i] + row[i - 1]);
		}
		row[0] *= 0.5;
	}
	return row;
}

std::vector<double> gauss(int reach, double sigma)
{
	return mapped(countingFrom(-reach, 2 * static_cast<std::size_t>(reach) + 1),
				  [sigma](int i) { return expOf(-0.5 * i * i / (sigma * sigma)); });
}

std::optional<double> numberOf(const std::string& text)
{
	double value = 0.0;
	const auto [end, error] = readDecimal(text.data(), text.data() + text.size(), value);
	return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

// A pixel of the tile that the mean reads, relative to its own pixel, and its weight.
struct TapTerm
{
	glm::ivec3 at; // x, y, frame
	double weight;
};

int wrapped(int i, int size)
{
	return ((i % size) + size) % size;
}

// Weights of this frame, the one before, …, folded to `period`.
std::vector<double> weightsInTime(double ema, int frames, int period)
{
	std::vector<double> weights(static_cast<std::size_t>(period), 0.0);
	for (int j = 0; j < frames; ++j)
	{
		weights[static_cast<std::size_t>(j % period)] += 1.0 / frames;
	}
	double sum = 0.0;
	double weight = 1.0;
	for (std::size_t j = 0; j < weights.size() && frames == 0; ++j)
	{
		weights[j] = weight;
		sum += weight;
		weight *= 1.0 - ema;
	}
	for (double& one : weights)
	{
		one /= frames == 0 ? sum : 1.0;
	}
	return weights;
}

} // namespace

TileFilter tileFilterOf(std::string name, int width, std::vector<double> taps)
{
	const double sum = sumOver(taps);
	for (double& tap : taps)
	{
		tap /= sum;
	}
	return {std::move(name), 1.0, width, std::move(taps)};
}

std::pair<std::string, double> nameAndShare(const std::string& text)
{
	const std::size_t at = text.rfind('@');
	const std::optional<double> share = at != std::string::npos ? numberOf(text.substr(at + 1)) : 1.0;
	refuseIf(!share || !(*share > 0.0 && *share <= 1e6),
			 "filter: found '" + text + "', expected a share above 0, at most 1e6, after @");
	return {text.substr(0, at), *share};
}

TileFilter tileFilterNamed(const std::string& name)
{
	if (name == "none")
	{
		return separable(name, {1.0});
	}
	const std::size_t colon = name.find(':');
	const std::optional<double> number = colon != std::string::npos ? numberOf(name.substr(colon + 1)) : std::nullopt;
	if (!number)
	{
		refuseFilter(name);
	}
	const std::string kind = name.substr(0, colon);
	const bool whole = *number >= 1.0 && *number <= 64.0 && *number == std::floor(*number);
	const int taps = whole ? static_cast<int>(*number) : 0;
	if (kind == "box" && whole)
	{
		return separable(name, std::vector<double>(static_cast<std::size_t>(taps), 1.0));
	}
	if (kind == "binomial" && whole)
	{
		return separable(name, binomial(taps));
	}
	if (kind == "gauss" && *number >= 0.1 && *number <= 8.0)
	{
		return separable(name, gauss(static_cast<int>(std::ceil(4.0 * *number)), *number));
	}
	if (kind == "bilateral" && taps >= 3 && taps <= 33 && taps % 2 == 1)
	{
		std::vector<double> line(static_cast<std::size_t>(taps), 1.0); // nookMeanAlong in reconstruct.glsl
		line.front() = 0.5;
		line.back() = 0.5;
		return separable(name, line);
	}
	refuseFilter(name);
}

std::vector<TileFilter> halvesOf(const TileFilter& filter)
{
	constexpr int kAngles = 16;
	const auto height = static_cast<int>(filter.taps.size()) / filter.width;
	std::vector<TileFilter> halves;
	for (int k = 0; k < kAngles; ++k)
	{
		const SinCos normal = sinCosOf(2.0 * kPi * (k + 0.5) / kAngles); // no row of taps lies exactly on the edge
		std::vector<double> taps = filter.taps;
		for (std::size_t i = 0; i < taps.size(); ++i)
		{
			const double x = static_cast<double>(static_cast<int>(i) % filter.width) - 0.5 * (filter.width - 1);
			const double y = static_cast<double>(static_cast<int>(i) / filter.width) - 0.5 * (height - 1);
			taps[i] = normal.cos * x + normal.sin * y < -1e-9 ? 0.0 : taps[i];
		}
		halves.push_back(tileFilterOf(filter.name, filter.width, std::move(taps)));
	}
	return halves;
}

std::vector<glm::ivec2> tileMoves(int size, int frames)
{
	int width = 1;
	while (width < size && width * width < frames)
	{
		width += 1;
	}
	return listOf(static_cast<std::size_t>(frames),
				  [width](std::size_t f) { return glm::ivec2(static_cast<int>(f) % width, static_cast<int>(f) / width); });
}

TileShares sharesOf(int size, const TileFilter& filter, const TileTime& time, int last, glm::ivec2 pan)
{
	const bool sequence = time.moves.empty();
	// Number of frames after which the same variants return, including how a pan moves what the history reads.
	const int period = pan == glm::ivec2(0) ? time.frames : time.frames * size;
	const std::vector<double> of_frame = weightsInTime(time.ema, last, period);
	TileShares shares{size, sequence ? time.frames : 1, {}};
	shares.pairs.resize(static_cast<std::size_t>(shares.frames * size * size), 0.0);
	const auto indexOf = [size](const glm::ivec3& at)
	{
		return static_cast<std::size_t>((at.z * size + at.y) * size + at.x);
	};
	const int different = sequence ? 1 : time.frames; // the earlier frames after which the picture differs
	for (int now = 0; now < different; ++now)
	{
		std::vector<double> row(shares.pairs.size(), 0.0);
		for (int before = 0; before < period; ++before)
		{
			const double weight = of_frame[static_cast<std::size_t>(before)];
			const int frame = wrapped(now - before, time.frames);
			const glm::ivec2 move = sequence ? glm::ivec2(0) : time.moves[static_cast<std::size_t>(frame)];
			for (std::size_t tap = 0; tap < filter.taps.size() && weight != 0.0; ++tap)
			{
				const int x = wrapped(static_cast<int>(tap) % filter.width + move.x - before * pan.x, size);
				const int y = wrapped(static_cast<int>(tap) / filter.width + move.y - before * pan.y, size);
				row[indexOf({x, y, sequence ? frame : 0})] += weight * filter.taps[tap];
			}
		}
		std::vector<TapTerm> terms;
		for (int i = 0; i < static_cast<int>(row.size()); ++i)
		{
			if (row[static_cast<std::size_t>(i)] != 0.0)
			{
				terms.push_back({{i % size, i / size % size, i / (size * size)}, row[static_cast<std::size_t>(i)]});
			}
		}
		for (const TapTerm& a : terms)
		{
			for (const TapTerm& b : terms)
			{
				const glm::ivec3 offset = b.at - a.at;
				shares.pairs[indexOf({wrapped(offset.x, size), wrapped(offset.y, size), wrapped(offset.z, shares.frames)})] +=
					a.weight * b.weight / different;
			}
		}
	}
	return shares;
}

double stepsOfShares(int size, const TileFilter& filter, const TileTime& time, bool panned)
{
	const bool sequence = time.moves.empty();
	const double different = sequence ? 1.0 : time.frames;
	const double read = static_cast<double>(filter.taps.size()) * time.frames * (panned ? size : 1);
	const double terms = std::min(read, static_cast<double>(size) * size * (sequence ? time.frames : 1));
	return different * (read + terms * terms);
}

double stepsOfError(const TileShares& shares, std::size_t count)
{
	const auto pairs =
		static_cast<double>(std::count_if(shares.pairs.begin(), shares.pairs.end(), [](double one) { return one != 0.0; }));
	return 0.5 * static_cast<double>(shares.pairs.size()) * pairs * static_cast<double>(count) * static_cast<double>(count);
}

void addShares(TileShares& into, const TileShares& added, double scale)
{
	into.size = added.size;
	into.frames = added.frames;
	into.pairs.resize(added.pairs.size(), 0.0);
	for (std::size_t i = 0; i < added.pairs.size(); ++i)
	{
		into.pairs[i] += scale * added.pairs[i];
	}
}

} // namespace nook
