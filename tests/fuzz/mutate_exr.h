// SPDX-License-Identifier: GPL-3.0-or-later
// A mutator for OpenEXR: header attributes, offset table, scan line chunks.
#pragma once

#include "mutate_json.h"

#include <array>
#include <optional>
#include <utility>

namespace nook::fuzz
{

struct ExrAttribute
{
	std::string name;
	std::string type;
	std::string value;
};

struct ExrParts
{
	std::string head; // magic number and version
	std::vector<ExrAttribute> attributes;
	std::string rest; // offsets and chunks
};

inline std::optional<std::string> textAt(const std::string& bytes, std::size_t& at)
{
	const std::size_t end = bytes.find('\0', at);
	if (end == std::string::npos)
	{
		return std::nullopt;
	}
	return bytes.substr(std::exchange(at, end + 1), end - at);
}

inline std::optional<ExrParts> partsOfExr(const std::string& bytes)
{
	ExrParts parts{bytes.substr(0, 8), {}, {}};
	for (std::size_t at = 8; at < bytes.size();)
	{
		const std::optional<std::string> name = textAt(bytes, at);
		if (name && name->empty())
		{
			parts.rest = bytes.substr(at);
			return parts;
		}
		const std::optional<std::string> type = name ? textAt(bytes, at) : std::nullopt;
		if (!type || at + 4 > bytes.size() || wordAt(bytes, at) > bytes.size() - at - 4)
		{
			return std::nullopt;
		}
		const std::size_t size = wordAt(bytes, at);
		parts.attributes.push_back({*name, *type, bytes.substr(at + 4, size)});
		at += 4 + size;
	}
	return std::nullopt;
}

inline void setHardWord(std::string& bytes, std::size_t at, Chance& chance)
{
	static const std::array<std::uint32_t, 16> kWords{
		0, 1, 2, 3, 7, 16, 255, 65535, 65536, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x7F800000, 0x7FC00000, 0x3F800000, 1U << 28U};
	if (at + 4 <= bytes.size())
	{
		const std::uint32_t before = wordAt(bytes, at);
		const std::size_t which = below(chance, kWords.size() + 4);
		const std::uint32_t after = which < kWords.size() ? kWords[which] : which % 2 == 0 ? before + 1 : before - 1;
		bytes.replace(at, 4, wordBytes(after));
	}
}

inline void mutateAttribute(ExrParts& parts, Chance& chance)
{
	static const std::array<const char*, 12> kNames{"Z",          "N.X",   "depth",      "R",    "projection",  "worldToCamera",
													"dataWindow", "tiles", "chunkCount", "type", "compression", "channels"};
	static const std::array<const char*, 10> kTypes{"m44f",   "m44d",   "box2i",    "chlist",      "float",
													"double", "string", "tiledesc", "compression", "v2f"};
	const std::size_t which = below(chance, parts.attributes.size());
	ExrAttribute& one = parts.attributes[which];
	switch (below(chance, 7))
	{
	case 0: parts.attributes.erase(parts.attributes.begin() + static_cast<std::ptrdiff_t>(which)); break;
	case 1: parts.attributes.push_back(one); break;
	case 2: one.name = kNames[below(chance, kNames.size())]; break;
	case 3: one.type = kTypes[below(chance, kTypes.size())]; break;
	case 4: one.value = mutatedBytes(one.value, one.value.size() + 16); break;
	default:
		if (one.value.size() < 4 && !one.value.empty())
		{
			one.value[0] = static_cast<char>(below(chance, 12)); // compression, line order
		}
		setHardWord(one.value, below(chance, one.value.size() / 4 + 1) * 4, chance);
	}
}

inline std::string mutatedExr(const std::string& bytes, std::size_t most, Chance& chance)
{
	std::optional<ExrParts> parts = below(chance, 16) == 0 ? std::nullopt : partsOfExr(bytes);
	if (!parts || parts->attributes.empty())
	{
		return mutatedBytes(bytes, most);
	}
	switch (below(chance, 4))
	{
	case 0: // 8-byte offsets first, then the line number and size of a chunk
		setHardWord(parts->rest, below(chance, std::min<std::size_t>(parts->rest.size() / 4 + 1, 64)) * 4, chance);
		break;
	case 1: parts->rest = mutatedBytes(parts->rest, parts->rest.size() + 64); break;
	default: mutateAttribute(*parts, chance);
	}
	std::string made = parts->head;
	for (const ExrAttribute& one : parts->attributes)
	{
		made += one.name + '\0' + one.type + '\0' + wordBytes(static_cast<std::uint32_t>(one.value.size())) + one.value;
	}
	return made + '\0' + parts->rest;
}

} // namespace nook::fuzz
