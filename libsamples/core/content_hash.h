// SPDX-License-Identifier: GPL-3.0-or-later
// 128-bit content hash as text. Not cryptographic.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace nook
{

// Two 64-bit FNV-1a sums (Fowler, Noll, Vo) over little-endian 8-byte words and the remaining bytes; the second hashes each word's
// complement from another start. The upper halves are mixed into the lower ones, which FNV alone never does.
class ContentHash
{
public:
	void add(std::span<const std::byte> bytes)
	{
		std::size_t at = 0;
		for (; at + 8 <= bytes.size(); at += 8)
		{
			uint64_t word = 0;
			std::memcpy(&word, bytes.data() + at, sizeof word); // every supported machine is little-endian
			take(word);
		}
		for (; at < bytes.size(); ++at)
		{
			take(std::to_integer<uint64_t>(bytes[at]));
		}
	}

	// Includes the length, so that "ab", "c" differs from "a", "bc".
	void add(std::string_view text)
	{
		add(text.size());
		add(std::as_bytes(std::span(text.data(), text.size())));
	}

	// Numbers as 64-bit floats.
	template <class... Number>
	requires(std::is_arithmetic_v<Number>&&...) void add(Number... values)
	{
		const std::array<double, sizeof...(values)> all{static_cast<double>(values)...};
		add(std::as_bytes(std::span(all)));
	}

	// `Item` has no padding.
	template <class Item> void items(std::span<const Item> list)
	{
		add(list.size());
		add(std::as_bytes(list));
	}

	// 32 hexadecimal digits.
	std::string text() const
	{
		std::string digits;
		for (const uint64_t half : {m_first, m_second})
		{
			for (int shift = 60; shift >= 0; shift -= 4)
			{
				digits += "0123456789abcdef"[(half >> static_cast<unsigned>(shift)) & 15U];
			}
		}
		return digits;
	}

private:
	void take(uint64_t word)
	{
		m_first = (m_first ^ word) * kPrime;
		m_first ^= m_first >> 32U;
		m_second = (m_second ^ ~word) * kPrime;
		m_second ^= m_second >> 29U;
	}

	static constexpr uint64_t kPrime = 0x100000001b3;
	uint64_t m_first = 0xcbf29ce484222325;
	uint64_t m_second = 0x9e3779b97f4a7c15;
};

// Reads in blocks: a level may have gigabytes. Throws Error (file).
std::string hashOfFile(const std::string& path);

} // namespace nook
