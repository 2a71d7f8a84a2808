// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes → 128 bits that change with them, as text. Not against adversaries.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace nook
{

// Two 64-bit FNV-1a sums (Fowler, Noll, Vo) over the bytes; the second takes each byte's complement from another start.
class ContentHash
{
public:
	void add(std::span<const std::byte> bytes)
	{
		for (const std::byte byte : bytes)
		{
			const auto value = std::to_integer<uint64_t>(byte);
			m_first = (m_first ^ value) * kPrime;
			m_second = (m_second ^ (value ^ 0xFFU)) * kPrime;
			m_second ^= m_second >> 29U;
		}
	}

	// With its length, so that "ab", "c" differs from "a", "bc".
	void add(std::string_view text)
	{
		add(static_cast<double>(text.size()));
		add(std::as_bytes(std::span(text.data(), text.size())));
	}

	void add(const std::string& text)
	{
		add(std::string_view(text));
	}

	void add(const char* text)
	{
		add(std::string_view(text));
	}

	void add(double value)
	{
		add(std::as_bytes(std::span(&value, 1)));
	}

	// Of a type without padding.
	template <class Item> void items(std::span<const Item> list)
	{
		add(static_cast<double>(list.size()));
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
	static constexpr uint64_t kPrime = 0x100000001b3;
	uint64_t m_first = 0xcbf29ce484222325;
	uint64_t m_second = 0x9e3779b97f4a7c15;
};

} // namespace nook
