// SPDX-License-Identifier: GPL-3.0-or-later
// Sends plain values through a stream to another nook process. A message ends with an exit code and a line of text.
#pragma once

#include "core/archive.h"
#include "core/error.h"
#include "core/process.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace nook
{

// Thrown if the stream is not what the reader expects, or the other end is closed.
struct StreamEnded
{
	const char* found = nullptr; // null: use the other process's exit status
};

class ValueWriter
{
public:
	explicit ValueWriter(StreamEnd to) : m_to(to) {}

	void bytes(const void* data, std::size_t size);
	void text(std::string_view text);
	template <class T> void value(const T& value)
	{
		static_assert(std::is_trivially_copyable_v<T>);
		bytes(&value, sizeof value);
	}
	// A vector, span or string.
	template <class Values> void values(const Values& values)
	{
		static_assert(std::is_trivially_copyable_v<typename Values::value_type>);
		value(uint64_t{values.size()});
		bytes(values.data(), values.size() * sizeof(typename Values::value_type));
	}

	// Ends the message.
	void finish(ExitCode code, std::string_view message);

private:
	void chunk(const void* data, std::size_t size);
	void flush();

	StreamEnd m_to;
	std::vector<char> m_buffer; // of the next chunk
};

// Reads the same values in the same order.
class ValueReader
{
public:
	// `wait` is called before each read. It returns once there is something to read, and throws if nothing will come.
	explicit ValueReader(StreamEnd from, std::function<void()> wait = {}) : m_from(from), m_wait(std::move(wait)) {}

	void bytes(void* data, std::size_t size);
	std::string text();
	template <class T> T value()
	{
		static_assert(std::is_trivially_copyable_v<T>);
		T value{};
		bytes(&value, sizeof value);
		return value;
	}
	// Appends to a vector or string. Counts above `most` are rejected as damaged.
	template <class Values> void values(Values& values, std::size_t most)
	{
		static_assert(std::is_trivially_copyable_v<typename Values::value_type>);
		const auto count = static_cast<std::size_t>(value<uint64_t>());
		if (count > most)
		{
			throw StreamEnded{};
		}
		const std::size_t old = values.size();
		values.resize(old + count);
		bytes(values.data() + old, count * sizeof(typename Values::value_type));
	}

	// Reads what finish() sent; throws the Error it carries, if any.
	void finish();

	// True after finish(): another message may follow.
	bool isFinished() const
	{
		return m_finished;
	}

private:
	void raw(void* data, std::size_t size);
	void lastWords();

	StreamEnd m_from;
	std::function<void()> m_wait;
	std::size_t m_chunk_left = 0;
	bool m_finished = false;
};

// Sends and receives what visitors pass (archive.h). Longer texts and lists than `most_bytes` are rejected as damaged.
template <class Value> void send(const Value& value, ValueWriter& to)
{
	Archive archive([&to](void* data, std::size_t size) { to.bytes(data, size); }, false, 0);
	archive(const_cast<Value&>(value)); // NOLINT: writing changes nothing
}
template <class Value> void receive(Value& value, ValueReader& from, std::size_t most_bytes = UINT32_MAX)
{
	Archive archive([&from](void* data, std::size_t size) { from.bytes(data, size); }, true, most_bytes);
	archive(value);
	if (!archive.isComplete())
	{
		throw StreamEnded{};
	}
}

} // namespace nook
