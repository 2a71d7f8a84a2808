// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the fuzz targets: input as text or as a file, and the only allowed outcomes of a parser: success, or an Error of one
// line.
#pragma once

#include "core/error.h"
#include "core/text.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <unistd.h>

namespace nook::fuzz
{

// Any exception other than an Error ends the run: libFuzzer reports exceptions that leave a target as crashes.
template <class Parse> void tryTo(const Parse& parse)
{
	try
	{
		parse();
	}
	catch (const Error& error)
	{
		const std::string line = oneLine(error.what()); // as printed: names of files and levels may contain anything
		if (line.empty() || line.find_first_of("\n\r") != std::string::npos || error.code() == ExitCode::ok)
		{
			std::abort();
		}
	}
}

// A file with those bytes, kept for the lifetime of the process.
inline std::string fileOf(const std::uint8_t* data, std::size_t size, const std::string& ending)
{
	const char* const folder = std::getenv("TMPDIR");
	const std::string path = std::string(folder != nullptr ? folder : "/tmp") + "/nook_fuzz_" + std::to_string(getpid()) + ending;
	std::FILE* const file = std::fopen(path.c_str(), "wb");
	if (file == nullptr || std::fwrite(data, 1, size, file) != size || std::fclose(file) != 0)
	{
		std::abort();
	}
	return path;
}

// Takes numbers from the front of the input; zeros once it is exhausted.
class Bytes
{
public:
	Bytes(const std::uint8_t* data, std::size_t size) : m_data(data), m_size(size) {}

	template <class Number> Number number()
	{
		Number value{};
		const std::size_t taken = m_size < sizeof value ? m_size : sizeof value;
		std::memcpy(&value, m_data, taken);
		m_data += taken;
		m_size -= taken;
		return value;
	}
	std::string text(std::size_t most)
	{
		const std::size_t wanted = number<std::uint8_t>() % (most + 1);
		const std::size_t taken = m_size < wanted ? m_size : wanted;
		std::string value(reinterpret_cast<const char*>(m_data), taken);
		m_data += taken;
		m_size -= taken;
		return value;
	}

private:
	const std::uint8_t* m_data;
	std::size_t m_size;
};

} // namespace nook::fuzz
