// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes as words, of what work takes and of what it may take.
#pragma once

#include <cstdint>
#include <string>

namespace nook
{

// What is needed goes up to whole numbers, what there may be down: the one is then never the other.
inline std::string needText(uint64_t bytes)
{
	return std::to_string((bytes + (1U << 20U) - 1) >> 20U) + " MiB";
}

inline std::string capText(uint64_t bytes)
{
	return bytes < (uint64_t{1} << 20U) ? std::to_string(bytes) + " bytes" : std::to_string(bytes >> 20U) + " MiB";
}

} // namespace nook
