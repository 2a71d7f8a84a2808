// SPDX-License-Identifier: GPL-3.0-or-later
// Values ↔ bytes, in memory or a stream. One visitor per type does both: `void visit(Archive& archive, T& value)` passes each
// member to the archive, which writes it or reads into it. Little-endian, as every machine that nook supports.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace nook
{

// Types copied as they lie in memory, none with padding: numbers, enumerations, GLM's vectors and matrices, arrays of these.
template <class T, class = void> struct IsPlain : std::bool_constant<std::is_arithmetic_v<T> || std::is_enum_v<T>>
{
};
template <class T>
struct IsPlain<T, std::void_t<typename T::value_type, decltype(sizeof(typename T::value_type))>>
	: std::bool_constant<std::is_trivially_copyable_v<T> && std::is_default_constructible_v<T> &&
						 std::is_arithmetic_v<typename T::value_type> && sizeof(T) % sizeof(typename T::value_type) == 0 &&
						 !std::is_constructible_v<T, const char*>>
{
};

class Archive
{
public:
	Archive() = default;                                                       // writes
	explicit Archive(std::string_view bytes) : m_left(bytes), m_reads(true) {} // reads; `bytes` must outlive it

	// Writes or reads by moving each piece. Longer texts and lists than `most_bytes` are rejected.
	using Move = std::function<void(void* data, std::size_t size)>;
	Archive(Move move, bool reads, std::size_t most_bytes) : m_move(std::move(move)), m_most_bytes(most_bytes), m_reads(reads) {}

	bool reads() const
	{
		return m_reads;
	}

	template <class... Values> Archive& operator()(Values&... values)
	{
		(pass(values), ...);
		return *this;
	}

	// Reading stops being valid where this is false: the bytes do not fit what is read into.
	void require(bool fits)
	{
		m_well = m_well && fits;
	}

	// After reading: everything was there, and nothing remains.
	bool isComplete() const
	{
		return m_well && m_left.empty();
	}

	std::string take()
	{
		return std::move(m_bytes);
	}

private:
	void raw(void* data, std::size_t size)
	{
		if (m_move)
		{
			if (m_well)
			{
				m_move(data, size);
			}
			return;
		}
		if (!m_reads)
		{
			m_bytes.append(static_cast<const char*>(data), size);
			return;
		}
		require(size <= m_left.size());
		if (m_well && size > 0)
		{
			std::memcpy(data, m_left.data(), size);
			m_left.remove_prefix(size);
		}
	}

	// The length of a list whose items take at least `least_bytes` each: never more than the bytes can hold.
	std::size_t count(std::size_t size, std::size_t least_bytes)
	{
		auto found = static_cast<uint64_t>(size);
		raw(&found, sizeof found);
		if (m_reads)
		{
			require(found <= (m_move ? m_most_bytes : m_left.size()) / least_bytes);
			found = m_well ? found : 0;
		}
		return static_cast<std::size_t>(found);
	}

	void pass(std::string& text)
	{
		text.resize(count(text.size(), 1));
		raw(text.data(), text.size());
	}

	template <class Item> void pass(std::vector<Item>& list)
	{
		if constexpr (IsPlain<Item>::value)
		{
			list.resize(count(list.size(), sizeof(Item)));
			raw(list.data(), list.size() * sizeof(Item));
		}
		else
		{
			const std::size_t size = count(list.size(), 1);
			list.resize(m_reads ? 0 : size);
			for (std::size_t i = 0; i < size && m_well; ++i) // never more items than bytes that were sent
			{
				pass(m_reads ? list.emplace_back() : list[i]);
			}
		}
	}

	template <class Value> void pass(std::optional<Value>& value)
	{
		bool there = value.has_value();
		raw(&there, sizeof there);
		if (m_reads)
		{
			value = there && m_well ? std::optional<Value>(std::in_place) : std::nullopt;
		}
		if (value)
		{
			pass(*value);
		}
	}

	template <class Value> void pass(Value& value)
	{
		if constexpr (IsPlain<Value>::value)
		{
			raw(&value, sizeof value);
		}
		else
		{
			visit(*this, value);
		}
	}

	std::string m_bytes;
	std::string_view m_left;
	Move m_move; // of a stream
	std::size_t m_most_bytes = 0;
	bool m_reads = false;
	bool m_well = true;
};

using Visitor = std::function<void(Archive& archive)>;

// Returns the bytes that a visitor writes.
inline std::string bytesOf(const Visitor& visitor)
{
	Archive archive;
	visitor(archive);
	return archive.take();
}

// Reads into what the visitor passes. Returns false where the bytes do not fit; what was passed may have changed.
inline bool readBytes(std::string_view bytes, const Visitor& visitor)
{
	Archive archive(bytes);
	visitor(archive);
	return archive.isComplete();
}

} // namespace nook
