// SPDX-License-Identifier: GPL-3.0-or-later
// Settings of the pattern generator, their names, and which of them exclude each other.
#pragma once

#include "core/error.h"
#include "core/progress.h"
#include "pattern/pattern.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace nook
{

enum class Method
{
	refine,  // gradient descent on a measure, starting from the best of the others
	electro, // Loos & Sloan 2010, §4.5: repulsion and centroids (directions on the sphere: least energy)
	equal,   // capacity-constrained power diagram: every cell has the same integral
	random,  // independent, distributed by the domain's measure
	poisson, // dart throwing
	halton,  // Halton points mapped through the measure's inverse distribution
	vogel,   // golden-angle spiral
	lloyd,   // centroidal Voronoi
};

enum class Minimise // Objective of refine.
{
	rms,    // plane² (disk: with half of cliff²)
	noise,  // variance over rotations, plane held within 1.1 times the best
	cliff,  // vertical half-spaces (disk)
	window, // error after averaging 16 even rotations
};

enum class WeightRule
{
	voronoi, // integrals of the cells
	equal,   // 1/count
	fitted,  // non-negative least squares on the half-space ensemble
};

enum class Order
{
	none,        // as the generator leaves them
	progressive, // every prefix covers the domain as well as possible
};

inline constexpr int kMaxCount = 4096;

struct Recipe
{
	Domain domain = Domain::disk;
	int count = 16;         // samples, 1 to kMaxCount
	bool centre = false;    // disk and ball: a sample at the centre
	bool symmetric = false; // disk, ball and sphere: p and −p with equal weights; a centre if the count is odd
	Method method = Method::refine;
	Minimise minimise = Minimise::rms;
	WeightRule weights = WeightRule::voronoi;
	Order order = Order::none;
	int starts = 0;        // independent starting sets, 1 to 100000; 0: defaultStarts
	uint32_t seed = 1;     // same seed, same bytes
	double exponent = 0.0; // exponent of the sphere's repulsion energy 1/d^exponent, 0.1 to 64; 0: 1 (Thomson's problem)
};

// Throws Error (usage) if a value is out of range or options exclude each other; the message names the options.
void checkRecipe(const Recipe& recipe);

// The number of starts used for `starts = 0`.
int defaultStarts(const Recipe& recipe);

// The command that makes this pattern, without outputs and defaults: "nook pattern --domain disk --count 9 --symmetric".
std::string patternCommand(const Recipe& recipe);

// Structure of a pattern in the catalogue and in the report on noise.
enum class Variant
{
	free,
	centred,
	symmetric,
};

// Names as on the command line and in JSON, in enumerator order.
template <class Enum> inline constexpr std::array<std::string_view, 0> kNamesOf{};

template <class Enum> std::span<const std::string_view> namesOf()
{
	static_assert(!kNamesOf<Enum>.empty(), "an enumeration without names");
	return kNamesOf<Enum>;
}

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

template <> inline constexpr std::array<std::string_view, 5> kNamesOf<Domain>{"disk", "ball", "sphere", "hemisphere", "slice"};

// The domains of stand-alone patterns.
std::span<const std::string_view> patternDomains();

template <>
inline constexpr std::array<std::string_view, 8> kNamesOf<Method>{"refine",  "electro", "equal", "random",
																  "poisson", "halton",  "vogel", "lloyd"};
template <> inline constexpr std::array<std::string_view, 4> kNamesOf<Minimise>{"rms", "noise", "cliff", "window"};
template <> inline constexpr std::array<std::string_view, 3> kNamesOf<WeightRule>{"voronoi", "equal", "fitted"};
template <> inline constexpr std::array<std::string_view, 2> kNamesOf<Order>{"none", "progressive"};
template <> inline constexpr std::array<std::string_view, 3> kNamesOf<Variant>{"free", "centred", "symmetric"};

// Called with a start's number and its current points while they move; several starts run in parallel if there are several threads.
// Never changes the result. May be empty.
using Watch = std::function<void(std::size_t start, std::span<const glm::dvec3> points)>;

// Generates the pattern. Points and weights are rounded to 32-bit floats (held in doubles), so that the measured pattern is the
// emitted one. Deterministic: the recipe alone decides every bit. Throws Error (usage) like checkRecipe.
Pattern generatePattern(const Recipe& recipe, const RunSettings& run = {}, const Watch& watch = {});

} // namespace nook
