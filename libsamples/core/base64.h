// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes ↔ text (RFC 4648, §4).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr std::string_view kBase64 = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

inline std::string base64Of(std::span<const uint8_t> bytes)
{
	std::string text;
	text.reserve((bytes.size() + 2) / 3 * 4);
	for (std::size_t i = 0; i < bytes.size(); i += 3)
	{
		uint32_t group = 0;
		for (std::size_t k = 0; k < 3; ++k)
		{
			group = group << 8U | (i + k < bytes.size() ? bytes[i + k] : 0U);
		}
		for (std::size_t k = 0; k < 4; ++k)
		{
			text += i + k <= bytes.size() ? kBase64[(group >> (18 - 6 * k)) & 63U] : '=';
		}
	}
	return text;
}

// Returns nothing unless `text` is valid padded base64.
inline std::optional<std::vector<uint8_t>> bytesOfBase64(std::string_view text)
{
	if (text.size() % 4 != 0)
	{
		return std::nullopt;
	}
	std::vector<uint8_t> bytes;
	bytes.reserve(text.size() / 4 * 3);
	for (std::size_t i = 0; i < text.size(); i += 4)
	{
		const bool last = i + 4 == text.size();
		const std::size_t padding = !last || text[i + 3] != '=' ? 0 : text[i + 2] == '=' ? 2 : 1;
		uint32_t group = 0;
		for (std::size_t k = 0; k < 4; ++k)
		{
			const std::size_t digit = k >= 4 - padding ? 0 : kBase64.find(text[i + k]);
			if (digit == std::string_view::npos)
			{
				return std::nullopt;
			}
			group = group << 6U | static_cast<uint32_t>(digit);
		}
		for (std::size_t k = 0; k < 3 - padding; ++k)
		{
			bytes.push_back(static_cast<uint8_t>(group >> (16 - 8 * k)));
		}
	}
	return bytes;
}

} // namespace nook
