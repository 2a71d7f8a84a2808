// SPDX-License-Identifier: GPL-3.0-or-later
// What one part of a command has done ↔ the bytes of its file (docs/reference/parts.md).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nook
{

inline constexpr int kMostParts = 100'000;

struct PartNumber
{
	int number = 1; // 1 to `of`
	int of = 1;     // 1 to kMostParts

	bool operator==(const PartNumber&) const = default;
};

// A file that the work depends on.
struct PartInput
{
	std::string path;
	std::string hash; // of its bytes, 32 hexadecimal digits

	bool operator==(const PartInput&) const = default;
};

// What a stage's units came to, by their indices.
using UnitResults = std::map<uint64_t, std::string>;

struct PartFile
{
	std::string path;                 // where it was read; not in the file
	std::string version;              // of nook
	std::vector<std::string> command; // the verb and its arguments, without outputs
	PartNumber part;
	std::vector<PartInput> inputs; // in the order of their reading
	std::map<std::string, UnitResults> stages;
};

// The same bytes for the same work, whenever and wherever it is done: no time, no host.
std::string partBytes(const PartFile& part);

// Throws Error (invalid_input) in one line that begins with `path` for anything that partBytes() does not write.
PartFile partFrom(std::string_view bytes, const std::string& path);

// Checks that they are of one command, one version and the same inputs, and that each of the N is there once; sorts them by number.
// Requires at least one. Throws Error (invalid_input) that names the file or the number.
void checkParts(std::vector<PartFile>& parts, std::string_view version);

} // namespace nook
