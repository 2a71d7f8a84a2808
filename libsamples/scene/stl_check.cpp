// SPDX-License-Identifier: GPL-3.0-or-later
// The length of a binary STL file, which says nothing else of itself: 80 bytes, a count, 50 bytes for each triangle. Assimp 5.2.5
// takes any other length for text, and then finds nothing.
#include "scene/load_parts.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace nook
{

void checkStl(const std::string& path)
{
	std::array<char, 84> head{};
	std::ifstream stream(path, std::ios::binary);
	if (!stream.read(head.data(), head.size()) || std::find(head.begin(), head.end(), '\0') == head.end())
	{
		return; // text, or too short for anything: no count below 2^24 is without a zero
	}
	uint64_t count = 0;
	for (std::size_t i = 0; i < 4; ++i)
	{
		count |= uint64_t{static_cast<unsigned char>(head[80 + i])} << (8U * i);
	}
	std::error_code failed;
	const std::uintmax_t size = std::filesystem::file_size(path, failed);
	const uint64_t needed = head.size() + 50 * count;
	if (!failed && size != needed)
	{
		throw Error(ExitCode::invalid_input, path + ": header: found " + std::to_string(count) + " triangles in " +
												 std::to_string(size) + " bytes, expected " + std::to_string(needed) + " bytes");
	}
}

} // namespace nook
