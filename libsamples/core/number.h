// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers → text that reads back as the same number, the same in every locale.
#pragma once

#include <charconv>
#include <string>

namespace nook
{

// The shortest decimal: "0.1", "1e-09", "inf".
inline std::string numberText(double value)
{
	char buffer[32];
	const std::to_chars_result result = std::to_chars(buffer, buffer + sizeof buffer, value);
	return {buffer, result.ptr};
}

} // namespace nook
