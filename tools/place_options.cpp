// SPDX-License-Identifier: GPL-3.0-or-later
#include "place_options.h"

#include "options.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace nook
{
namespace
{

// So many numbers with commas between them, each of a level's coordinates.
template <std::size_t count> std::optional<std::array<double, count>> numbersOf(std::string_view text)
{
	std::array<double, count> numbers{};
	for (std::size_t i = 0; i < count; ++i)
	{
		const std::size_t end = std::min(text.find(','), text.size());
		const std::from_chars_result result = std::from_chars(text.data(), text.data() + end, numbers[i]);
		const bool is_last = end == text.size();
		if (result.ec != std::errc{} || result.ptr != text.data() + end || !(std::fabs(numbers[i]) <= kFarthest_m) ||
			is_last != (i + 1 == count))
		{
			return std::nullopt;
		}
		text.remove_prefix(is_last ? end : end + 1);
	}
	return numbers;
}

} // namespace

glm::dvec3 positionOf(const std::string& option, const std::string& text)
{
	const std::optional<std::array<double, 3>> numbers = numbersOf<3>(text);
	if (!numbers)
	{
		refuseValue(option, text, "X,Y,Z: three numbers, each from -1e15 to 1e15");
	}
	return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

Bounds boxOf(const std::string& option, const std::string& text)
{
	const std::optional<std::array<double, 6>> numbers = numbersOf<6>(text);
	if (!numbers || (*numbers)[0] > (*numbers)[3] || (*numbers)[1] > (*numbers)[4] || (*numbers)[2] > (*numbers)[5])
	{
		refuseValue(option, text, "six numbers X,Y,Z,X,Y,Z, the least corner of a box first, metres");
	}
	return {{(*numbers)[0], (*numbers)[1], (*numbers)[2]}, {(*numbers)[3], (*numbers)[4], (*numbers)[5]}};
}

} // namespace nook
