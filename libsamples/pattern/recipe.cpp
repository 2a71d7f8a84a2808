// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/recipe.h"

#include "core/decimal.h"

namespace nook
{

std::span<const std::string_view> patternDomains()
{
	return namesOf<Domain>().first(4);
}

namespace
{

void checkRange(const char* option, double value, double least, double most, const char* range)
{
	refuseIf(!(value >= least && value <= most), std::string(option) + ": expected " + range);
}

bool usesStarts(Method method)
{
	return method == Method::electro || method == Method::lloyd || method == Method::refine || method == Method::equal;
}

} // namespace

void checkRecipe(const Recipe& recipe)
{
	const bool sphere = recipe.domain == Domain::sphere;
	refuseIf(recipe.domain == Domain::slice, "domain slice: slices come in tiles alone, expected a tile of them");
	checkRange("count", recipe.count, 1, kMaxCount, "a whole number from 1 to 4096");
	checkRange("starts", recipe.starts, 0, 100000, "a whole number from 1 to 100000");
	refuseIf(recipe.centre && isDirectional(recipe.domain), "centre: directions have no centre; expected the domain disk or ball");
	refuseIf(recipe.symmetric && recipe.domain == Domain::hemisphere,
			 "symmetric: the opposite of a direction lies outside the hemisphere; expected the domain disk, ball or sphere");
	refuseIf(recipe.symmetric && sphere && recipe.count % 2 != 0,
			 "symmetric: pairs of directions are even in number; expected an even count");
	refuseIf(recipe.symmetric && recipe.centre && recipe.count % 2 == 0,
			 "symmetric centre: pairs and a centre are odd in number; expected an odd count");
	refuseIf(recipe.minimise != Minimise::rms && recipe.method != Method::refine,
			 "minimise: only the method refine minimises a measure");
	refuseIf(recipe.minimise == Minimise::cliff && recipe.domain != Domain::disk,
			 "minimise cliff: vertical planes are measured for lines; expected the domain disk");
	refuseIf(recipe.minimise == Minimise::window && sphere,
			 "minimise window: rotations of a set of directions leave no error on the sphere; expected another domain");
	refuseIf(recipe.minimise == Minimise::noise && sphere,
			 "minimise noise: on the sphere the noise is all of the error; expected rms");
	refuseIf(recipe.method == Method::equal && recipe.weights == WeightRule::fitted,
			 "weights fitted: the method equal makes cells for equal weights; expected voronoi or equal");
	refuseIf(recipe.exponent != 0.0 && !(sphere && recipe.method == Method::electro),
			 "exponent: the repulsion is chosen for the domain sphere and the method electro only");
	if (recipe.exponent != 0.0)
	{
		checkRange("exponent", recipe.exponent, 0.1, 64.0, "a number from 0.1 to 64");
	}
	refuseIf(recipe.starts != 0 && !usesStarts(recipe.method),
			 "starts: this method makes one set; expected the method refine, electro, equal or lloyd");
}

int defaultStarts(const Recipe& recipe)
{
	if (recipe.starts != 0)
	{
		return recipe.starts;
	}
	if (!usesStarts(recipe.method))
	{
		return 1;
	}
	// On the sphere as few as a twentieth of the starts find the best known minimum (N = 56, 58).
	const int small = recipe.domain == Domain::sphere && recipe.method == Method::electro ? 192 : 32;
	return recipe.count <= 64     ? small
		   : recipe.count <= 128  ? 16
		   : recipe.count <= 256  ? 8
		   : recipe.count <= 512  ? 4
		   : recipe.count <= 1024 ? 2
								  : 1;
}

std::string patternCommand(const Recipe& recipe)
{
	const Recipe plain;
	std::string command =
		"nook pattern --domain " + std::string(nameOf(recipe.domain)) + " --count " + std::to_string(recipe.count);
	const auto add = [&command](bool differs, const std::string& option, const std::string& value)
	{
		command += differs ? option + value : "";
	};
	add(recipe.centre, " --centre", "");
	add(recipe.symmetric, " --symmetric", "");
	add(recipe.method != plain.method, " --method ", std::string(nameOf(recipe.method)));
	add(recipe.minimise != plain.minimise, " --minimise ", std::string(nameOf(recipe.minimise)));
	add(recipe.weights != plain.weights, " --weights ", std::string(nameOf(recipe.weights)));
	add(recipe.order != plain.order, " --order ", std::string(nameOf(recipe.order)));
	add(recipe.starts != plain.starts, " --starts ", std::to_string(recipe.starts));
	add(recipe.seed != plain.seed, " --seed ", std::to_string(recipe.seed));
	add(recipe.exponent != plain.exponent, " --exponent ", numberText(recipe.exponent));
	return command;
}

} // namespace nook
