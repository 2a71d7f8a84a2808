// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and texts ↔ bytes, the lowest first on every machine; a reader that never reads past the end.
#pragma once

#include "core/bits.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace nook
{

class ByteWriter
{
public:
	void whole(uint64_t value)
	{
		for (unsigned shift = 0; shift < 64; shift += 8)
		{
			m_bytes += static_cast<char>(static_cast<unsigned char>((value >> shift) & 0xFFU));
		}
	}

	void byte(uint8_t value)
	{
		m_bytes += static_cast<char>(value);
	}

	void small(uint32_t value)
	{
		for (unsigned shift = 0; shift < 32; shift += 8)
		{
			m_bytes += static_cast<char>(static_cast<unsigned char>((value >> shift) & 0xFFU));
		}
	}

	// Every bit of it.
	void number(double value)
	{
		whole(bitsAs<uint64_t>(value));
	}
	void number(float value)
	{
		small(bitsAs<uint32_t>(value));
	}

	// With its length.
	void text(std::string_view text)
	{
		whole(text.size());
		m_bytes += text;
	}

	std::string take()
	{
		return std::move(m_bytes);
	}

private:
	std::string m_bytes;
};

// Once something was asked for that is not there, everything reads as 0 and isWell() is false.
class ByteReader
{
public:
	explicit ByteReader(std::string_view bytes) : m_left(bytes) {}

	uint64_t whole()
	{
		return read<uint64_t>();
	}
	uint8_t byte()
	{
		return read<uint8_t>();
	}
	uint32_t small()
	{
		return read<uint32_t>();
	}
	double number()
	{
		return bitsAs<double>(whole());
	}
	float single()
	{
		return bitsAs<float>(small());
	}

	// Of a list whose items take at least so many bytes each: no more than can be there.
	std::size_t count(std::size_t least_bytes)
	{
		const uint64_t found = whole();
		if (found > m_left.size() / least_bytes)
		{
			fail();
			return 0;
		}
		return static_cast<std::size_t>(found);
	}

	std::string_view bytes(uint64_t length)
	{
		if (length > m_left.size())
		{
			fail();
			return {};
		}
		const std::string_view found = m_left.substr(0, static_cast<std::size_t>(length));
		m_left.remove_prefix(static_cast<std::size_t>(length));
		return found;
	}

	std::string text()
	{
		return std::string(bytes(whole()));
	}

	bool isWell() const
	{
		return m_well;
	}

	// Nothing is left, and all was there.
	bool isAtEnd() const
	{
		return m_well && m_left.empty();
	}

private:
	template <class Number> Number read()
	{
		const std::string_view found = bytes(sizeof(Number));
		Number value = 0;
		for (std::size_t i = 0; i < found.size(); ++i)
		{
			value |= static_cast<Number>(static_cast<Number>(static_cast<unsigned char>(found[i])) << (8U * i));
		}
		return value;
	}

	void fail()
	{
		m_well = false;
		m_left = {};
	}

	std::string_view m_left;
	bool m_well = true;
};

} // namespace nook
