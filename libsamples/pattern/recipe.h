// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that makes a pattern again: the settings of its generator, their names, and which of them go together.
#pragma once

#include "pattern/pattern.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace nook
{

enum class Method
{
	refine,  // gradient descent on a measure, from the best of the others
	electro, // Loos & Sloan 2010, §4.5: repulsion and centroids (directions on the sphere: least energy)
	equal,   // capacity-constrained power diagram: every cell has the same integral
	random,  // independent, by the domain's measure
	poisson, // dart throwing
	halton,  // Halton points carried over by the measure's inverse distribution
	vogel,   // golden-angle spiral
	lloyd,   // centroidal Voronoi
};

enum class Minimise // of refine
{
	rms,    // plane² (disk: with half of cliff²)
	noise,  // variance over rotations, plane held within 1.1 times the best
	cliff,  // vertical half-spaces (disk)
	window, // what 16 even rotations leave
};

enum class WeightRule
{
	voronoi, // integrals of the cells
	equal,   // 1/count
	fitted,  // non-negative least squares on the half-space ensemble
};

enum class VoronoiMode
{
	exact,
	discrete, // the paper's grids
};

enum class Order
{
	none,        // as the generator leaves them
	progressive, // every prefix covers the domain as well as it can
	cache,       // neighbours in the list are neighbours in the domain
};

inline constexpr int kMaxCount = 4096;

struct Recipe
{
	Domain domain = Domain::disk;
	int count = 16;         // samples, 1 to kMaxCount
	bool centre = false;    // disk and ball: a sample at the centre
	bool symmetric = false; // disk, ball and sphere: p and −p with equal weights; a centre where the count is odd
	Method method = Method::refine;
	Minimise minimise = Minimise::rms;
	WeightRule weights = WeightRule::voronoi;
	VoronoiMode voronoi = VoronoiMode::exact;
	Order order = Order::none;
	int starts = 0;        // independent starting sets, 1 to 100000; 0: defaultStarts
	uint32_t seed = 1;     // same seed, same bytes
	double exponent = 0.0; // repulsion 1/d^exponent as an energy on the sphere, 0.1 to 64; 0: 1 (Thomson's problem)
};

// Throws Error (usage) when a value is out of range or options exclude each other; the message names the options.
void checkRecipe(const Recipe& recipe);

// The number of starts that `starts = 0` means.
int defaultStarts(const Recipe& recipe);

// The command line that makes this pattern, without output files: "nook pattern --domain disk --count 9 --symmetric";
// only what differs from the defaults is written out.
std::string commandOf(const Recipe& recipe);

// Names as on the command line and in JSON. namesOf<Enum>() lists them in the order of the enumerators.
template <class Enum> std::span<const std::string_view> namesOf();

template <class Enum> std::string_view nameOf(Enum value)
{
	return namesOf<Enum>()[static_cast<std::size_t>(value)];
}

template <class Enum> std::optional<Enum> valueNamed(std::string_view name)
{
	const std::span<const std::string_view> names = namesOf<Enum>();
	for (std::size_t i = 0; i < names.size(); ++i)
	{
		if (names[i] == name)
		{
			return static_cast<Enum>(i);
		}
	}
	return std::nullopt;
}

template <> std::span<const std::string_view> namesOf<Domain>();

// Those of which there are patterns by themselves.
std::span<const std::string_view> patternDomains();

template <> std::span<const std::string_view> namesOf<Method>();
template <> std::span<const std::string_view> namesOf<Minimise>();
template <> std::span<const std::string_view> namesOf<WeightRule>();
template <> std::span<const std::string_view> namesOf<VoronoiMode>();
template <> std::span<const std::string_view> namesOf<Order>();

} // namespace nook
