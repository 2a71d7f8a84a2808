// SPDX-License-Identifier: GPL-3.0-or-later
// Plain values, one after the other, through a socket to another process of ours. A message ends with an exit code and a line.
#pragma once

#include "core/error.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace nook
{

// Thrown where the stream is not what its reader expects, or nobody listens.
struct StreamEnded
{
	const char* found = nullptr; // or null: as the other process's exit status says
};

class ValueWriter
{
public:
	explicit ValueWriter(int socket) : m_socket(socket) {}

	void bytes(const void* data, std::size_t size);
	void text(std::string_view text);
	template <class T> void value(const T& value)
	{
		static_assert(std::is_trivially_copyable_v<T>);
		bytes(&value, sizeof value);
	}
	// Of a vector, span or string.
	template <class Values> void values(const Values& values)
	{
		static_assert(std::is_trivially_copyable_v<typename Values::value_type>);
		value(uint64_t{values.size()});
		bytes(values.data(), values.size() * sizeof(typename Values::value_type));
	}

	// The last thing that is sent.
	void finish(ExitCode code, std::string_view message);

private:
	void chunk(const void* data, std::size_t size);
	void flush();

	int m_socket;
	std::vector<char> m_buffer; // of the next chunk
};

// The same values in the same order.
class ValueReader
{
public:
	// `wait` is called before each read; it returns where there is something, and throws where nothing will come. All that is read
	// is added to `heard`, where there is one.
	explicit ValueReader(int socket, std::function<void()> wait = {}, std::string* heard = nullptr)
		: m_socket(socket), m_wait(std::move(wait)), m_heard(heard)
	{
	}

	// What another reader heard, which must outlive this one.
	explicit ValueReader(std::string_view heard) : m_kept(heard) {}

	void bytes(void* data, std::size_t size);
	std::string text();
	template <class T> T value()
	{
		static_assert(std::is_trivially_copyable_v<T>);
		T value{};
		bytes(&value, sizeof value);
		return value;
	}
	// Adds to a vector or string; `most` guards against a writer out of its mind.
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

	// Reads what finish() sent; throws Error where it holds one.
	void finish();

	// What finish() sent has been read: another message may follow.
	bool isFinished() const
	{
		return m_finished;
	}

private:
	void raw(void* data, std::size_t size);
	void lastWords();

	void receive(char* to, std::size_t size);

	int m_socket = -1; // none: `m_kept` has what follows
	std::string_view m_kept;
	std::function<void()> m_wait;
	std::string* m_heard = nullptr;
	std::size_t m_chunk_left = 0;
	bool m_finished = false;
};

} // namespace nook
