// SPDX-License-Identifier: GPL-3.0-or-later
// Helpers of those who read files: lower case, counts, numbers of bytes, errors.
#pragma once

#include "core/error.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace nook
{

// ASCII letters in lower case; others stay.
inline std::string lowered(std::string_view text)
{
	std::string lower(text);
	std::transform(lower.begin(), lower.end(), lower.begin(),
				   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
	return lower;
}

// "1 page", "2 pages".
inline std::string counted(std::size_t count, const std::string& one, const std::string& many)
{
	return std::to_string(count) + " " + (count == 1 ? one : many);
}

// An unsigned number of `size` bytes.
inline uint64_t littleEndian(std::string_view bytes, std::size_t at, std::size_t size)
{
	uint64_t number = 0;
	for (std::size_t i = 0; i < size; ++i)
	{
		number |= uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8U * i);
	}
	return number;
}

// Throws Error "where: found X, expected Y".
[[noreturn]] inline void refuseInput(const std::string& where, const std::string& found, const std::string& expected,
									 ExitCode code = ExitCode::invalid_input)
{
	throw Error(code, where + ": found " + found + ", expected " + expected);
}
template <class... Words> void refuseInputIf(bool condition, const Words&... words)
{
	if (condition)
	{
		refuseInput(words...);
	}
}

} // namespace nook
