// SPDX-License-Identifier: GPL-3.0-or-later
// A worker whose readers behave like readers of other people's formats: correctly, incorrectly, or without end. For
// test_core.cpp.
#include "core/isolate.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

using namespace nook;

namespace
{

// Returns its input.
void echo(ValueReader& request, ValueWriter& answer)
{
	const auto number = request.value<int>();
	std::vector<double> values;
	request.values(values, 1000000);
	const std::string text = request.text();
	answer.value(number);
	answer.values(values);
	answer.values(std::vector<double>{});
	answer.text("");
	answer.text(text);
}

void process(ValueReader&, ValueWriter& answer)
{
	answer.text(std::to_string(::getpid()));
}

void error(ValueReader&, ValueWriter&)
{
	throw Error(ExitCode::file, "a.bin: gone");
}

void halfAnError(ValueReader&, ValueWriter& answer)
{
	answer.text("half");
	answer.values(std::vector<char>(100000));
	throw Error(ExitCode::invalid_input, "b: wrong");
}

[[noreturn]] void abortNow(ValueReader&, ValueWriter&)
{
	std::abort();
}

[[noreturn]] void end(ValueReader&, ValueWriter&)
{
	::_exit(0);
}

void fault(ValueReader&, ValueWriter&)
{
	std::raise(SIGSEGV);
}

void throwNumber(ValueReader&, ValueWriter&)
{
	throw 1;
}

void nothing(ValueReader&, ValueWriter&) {}

void twoTexts(ValueReader&, ValueWriter& answer)
{
	answer.text("more");
	answer.text("than was expected");
}

void halfThenFault(ValueReader&, ValueWriter& answer)
{
	answer.values(std::vector<char>(100000));
	std::raise(SIGSEGV);
}

void flood(ValueReader&, ValueWriter& answer)
{
	for (;;)
	{
		answer.values(std::vector<char>(std::size_t{1} << 20U));
	}
}

void spin(ValueReader&, ValueWriter&)
{
	for (std::atomic<int> i = 0;; ++i)
	{
	}
}

void sleepOn(ValueReader&, ValueWriter&)
{
	::pause();
}

void grow(ValueReader&, ValueWriter&)
{
	for (std::vector<char*> held;;)
	{
		held.push_back(new char[1U << 24U]);
		std::memset(held.back(), 1, 1U << 24U);
		::usleep(1000); // with the address sanitizer only the parent's watch stops this
	}
}

void noThread(ValueReader&, ValueWriter&)
{
	throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again), "no thread");
}

// The first picture of a hostile file leaves a trap for the second, in the same process only.
void trap(ValueReader& request, ValueWriter& answer)
{
	static bool set = false;
	const bool was_set = set;
	set = request.value<bool>();
	if (was_set)
	{
		std::abort();
	}
	answer.text("fine");
}

} // namespace

int main(int argc, char** argv)
{
	constexpr std::array<WorkerFunction, 17> kFunctions{{{"echo", echo},
														 {"process", process},
														 {"error", error},
														 {"half an error", halfAnError},
														 {"abort", abortNow},
														 {"end", end},
														 {"fault", fault},
														 {"throw", throwNumber},
														 {"nothing", nothing},
														 {"two texts", twoTexts},
														 {"half, then fault", halfThenFault},
														 {"flood", flood},
														 {"spin", spin},
														 {"sleep", sleepOn},
														 {"grow", grow},
														 {"no thread", noThread},
														 {"trap", trap}}};
	return serveRequests(argc, argv, kFunctions);
}
