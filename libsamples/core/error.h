// SPDX-License-Identifier: GPL-3.0-or-later
// One-line error with an exit code that gives its kind.
#pragma once

#include <stdexcept>
#include <string>

namespace nook
{

enum class ExitCode
{
	ok = 0,
	usage = 1,         // the command line
	file = 2,          // a file cannot be read or written
	invalid_input = 3, // a file was read but holds something wrong
	runtime = 4,       // failed while working
	unsupported = 5,   // well formed, but not offered here
	difference = 7,    // a comparison found a difference
};

// Message format: `path: element: found X, expected Y`.
class Error : public std::runtime_error
{
public:
	Error(ExitCode code, const std::string& message) : std::runtime_error(message), m_code(code) {}

	ExitCode code() const
	{
		return m_code;
	}

private:
	ExitCode m_code;
};

// Throws Error where a condition holds. The message is made either way.
inline void refuseIf(bool condition, const std::string& message, ExitCode code = ExitCode::usage)
{
	if (condition)
	{
		throw Error(code, message);
	}
}

// place.fail(words…), which throws Error, where a condition holds.
template <class Place, class... Words> void failIf(bool condition, const Place& place, const Words&... words)
{
	if (condition)
	{
		place.fail(words...);
	}
}

} // namespace nook
