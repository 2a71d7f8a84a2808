// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a function in a child process with limits on memory and time; the bytes that it writes come back.
//
// Why a process: readers of other people's formats crash, loop and ask for gigabytes where a file is damaged or made for it.
// (Assimp 5.2.5 overflows its stack on a glTF whose nodes form a circle, before it looks at anything else.) Inside one process
// nothing of that can be caught; in a child all of it becomes one line. A fork without exec costs a few milliseconds and needs no
// second program. Only the calling thread exists in the child: the function must start no threads and wait for none of the
// parent's (a oneTBB loop, say). Memory of glibc is safe to use there; locks that another thread of the parent holds at that
// moment are not.
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

struct IsolationLimits
{
	std::size_t memory_bytes = std::size_t{1} << 30U; // on top of what the process has when it starts
	int processor_s = 60;                             // processor time; five times as long where it only waits
};

// The child's end: plain values, one after the other.
class IsolatedWriter
{
public:
	explicit IsolatedWriter(int file) : m_file(file) {}

	void bytes(const void* data, std::size_t size);
	void text(std::string_view text);
	template <class T> void value(const T& value)
	{
		static_assert(std::is_trivially_copyable_v<T>);
		bytes(&value, sizeof value);
	}
	template <class T> void values(const std::vector<T>& values)
	{
		static_assert(std::is_trivially_copyable_v<T>);
		value(uint64_t{values.size()});
		bytes(values.data(), values.size() * sizeof(T));
	}

	// The last thing that is sent.
	void finish(ExitCode code, std::string_view message);

private:
	void chunk(const void* data, std::size_t size);
	void flush();

	int m_file;
	std::vector<char> m_buffer; // of the next chunk
};

// The parent's end: the same values in the same order. Throws what isolate() makes an Error of, where the child ended early.
class IsolatedReader
{
public:
	struct Ended
	{
		const char* reason = nullptr; // or null: as the child's exit status and last words say
	};

	IsolatedReader(int file, int process, const IsolationLimits& limits);

	void bytes(void* data, std::size_t size);
	std::string text();
	template <class T> T value()
	{
		static_assert(std::is_trivially_copyable_v<T>);
		T value{};
		bytes(&value, sizeof value);
		return value;
	}
	// Adds to `values`; `most` guards against a child out of its mind.
	template <class T> void values(std::vector<T>& values, std::size_t most)
	{
		static_assert(std::is_trivially_copyable_v<T>);
		const auto count = static_cast<std::size_t>(value<uint64_t>());
		if (count > most)
		{
			throw Ended{};
		}
		const std::size_t old = values.size();
		values.resize(old + count);
		bytes(values.data() + old, count * sizeof(T));
	}

	// Reads what finish() sent; throws Error where it holds one.
	void finish();

private:
	void raw(void* data, std::size_t size);
	void waitForBytes();
	void lastWords();

	int m_file;
	int m_process;
	IsolationLimits m_limits;
	std::size_t m_resident_pages = 0; // of the child as it starts
	int m_idle_ticks = 0;
	std::size_t m_chunk_left = 0;
};

// `work` runs in the child and writes; `take` runs here at the same time and reads exactly that. An Error that `work` throws is
// thrown here. A child that crashes, runs too long or wants too much is an Error (invalid_input) of `name`, the file being read;
// `take` may change it as it goes from one file to the next.
void isolate(const std::string& name, const IsolationLimits& limits, const std::function<void(IsolatedWriter&)>& work,
			 const std::function<void(IsolatedReader&)>& take);

} // namespace nook
