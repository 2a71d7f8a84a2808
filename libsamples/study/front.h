// SPDX-License-Identifier: GPL-3.0-or-later
// Costs and errors of candidates → the front: the candidates that no other beats in both.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <tuple>
#include <vector>

namespace nook
{

struct FrontPlace
{
	std::size_t item = 0; // the caller's number
	double cost = 0.0;    // seconds or bytes
	double error = 0.0;
};

// Returns the items that err less than everything that costs no more, cheapest first. The first of equal ones is taken.
inline std::vector<std::size_t> frontOf(std::vector<FrontPlace> places)
{
	std::stable_sort(places.begin(), places.end(),
					 [](const FrontPlace& a, const FrontPlace& b)
					 { return std::tie(a.cost, a.error) < std::tie(b.cost, b.error); });
	std::vector<std::size_t> front;
	double least = std::numeric_limits<double>::infinity();
	for (const FrontPlace& place : places)
	{
		if (place.error < least)
		{
			least = place.error;
			front.push_back(place.item);
		}
	}
	return front;
}

} // namespace nook
