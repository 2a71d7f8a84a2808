// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/isolate.h"

#include <catch2/catch.hpp>

#include <csignal>
#include <numeric>
#include <string>

#include <sys/wait.h>

using namespace nook;

namespace
{

constexpr const char* kWorker = "nook_test_worker"; // test_worker.cpp

const auto kNoArguments = [](ValueWriter&) {
};

// Outcome of a worker that runs this function: its text, or the error.
std::string outcomeOf(const char* function, const std::optional<IsolationLimits>& limits = IsolationLimits{})
{
	std::string answer = "nothing";
	try
	{
		isolate({kWorker, function}, "some.file", limits, kNoArguments, [&](ValueReader& from) { answer = from.text(); });
	}
	catch (const Error& error)
	{
		answer = std::to_string(static_cast<int>(error.code())) + " " + error.what();
	}
	return answer;
}

// Likewise for a kept worker; the argument is for "trap".
std::string keptOutcomeOf(const char* function, const std::optional<bool>& argument = std::nullopt)
{
	std::string answer;
	isolate(
		{kWorker, function, true}, "some.file", IsolationLimits{},
		[argument](ValueWriter& to)
		{
			if (argument)
			{
				to.value(*argument);
			}
		},
		[&](ValueReader& from) { answer = from.text(); });
	return answer;
}

} // namespace

TEST_CASE("isolate: what a worker writes comes back", "[core]")
{
	std::vector<double> sent(300000);
	std::iota(sent.begin(), sent.end(), 0.5);
	std::vector<double> got;
	int whole = 0;
	std::string text;
	isolate(
		{kWorker, "echo"}, "f", IsolationLimits{},
		[&](ValueWriter& to)
		{
			to.value(7);
			to.values(sent);
			to.text("end");
		},
		[&](ValueReader& from)
		{
			whole = from.value<int>();
			from.values(got, 1000000);
			from.values(got, 0);
			text = from.text() + from.text();
		});
	CHECK(whole == 7);
	CHECK(got == sent);
	CHECK(text == "end");
	CHECK(outcomeOf("process") != outcomeOf("process"));
}

TEST_CASE("isolate: errors of a worker are errors here", "[core]")
{
	CHECK(outcomeOf("error") == "2 a.bin: gone");
	std::vector<char> got;
	CHECK_THROWS_WITH(isolate({kWorker, "half an error"}, "f", IsolationLimits{}, kNoArguments,
							  [&](ValueReader& from)
							  {
								  CHECK(from.text() == "half");
								  from.values(got, 100000);
								  from.text();
							  }),
					  "b: wrong");
	CHECK(got.size() == 100000);
	CHECK(outcomeOf("no thread").starts_with("4 threads: no thread"));
	CHECK(outcomeOf("none").starts_with("4 none: found no such function"));
	CHECK_THROWS_WITH(isolate({"nook_no_worker", "none"}, "f", IsolationLimits{}, kNoArguments, [](ValueReader&) {}),
					  Catch::StartsWith("nook_no_worker: found no such program"));
}

TEST_CASE("isolate: a worker that ends badly is one line", "[core]")
{
	for (const char* const function : {"abort", "end", "fault", "throw", "nothing", "two texts", "half, then fault"})
	{
		INFO(function);
		CHECK(outcomeOf(function) == "3 some.file: found contents that crash their reader, expected a complete file of its format");
		CHECK(outcomeOf(function, std::nullopt).starts_with("4 some.file: found contents that crash their reader"));
	}
	CHECK(::kill(std::stoi(outcomeOf("process")), 0) == -1); // no worker remains
	CHECK(::waitpid(-1, nullptr, WNOHANG) <= 0);             // nor a zombie
}

TEST_CASE("isolate: a worker that writes more than is taken is not waited for", "[core]")
{
	std::vector<char> got;
	for (const std::size_t most : {std::size_t{10}, std::size_t{1} << 20U})
	{
		CHECK_THROWS_WITH(isolate({kWorker, "flood"}, "some.file", IsolationLimits{}, kNoArguments,
								  [&](ValueReader& from) { from.values(got, most); }),
						  Catch::Contains("crash their reader"));
	}
}

TEST_CASE("isolate: endless work and endless memory are stopped", "[core]")
{
	CHECK(outcomeOf("spin", IsolationLimits{1U << 30U, 1}).find("never finish reading") != std::string::npos);
	CHECK(outcomeOf("sleep", IsolationLimits{1U << 30U, 1}).find("never finish reading") != std::string::npos);
	CHECK(outcomeOf("grow", IsolationLimits{std::size_t{200} << 20U, 20}).find("far more memory") != std::string::npos);
}

TEST_CASE("isolate: a worker that is kept serves again, and pays for no other's file", "[core]")
{
	const std::string process = keptOutcomeOf("process");
	CHECK(keptOutcomeOf("process") == process);
	CHECK_THROWS_WITH(keptOutcomeOf("error"), "a.bin: gone");
	CHECK(keptOutcomeOf("process") == process);
	CHECK(keptOutcomeOf("trap", true) == "fine");
	CHECK(keptOutcomeOf("trap", false) == "fine"); // a new worker, since the first one crashes
	CHECK(keptOutcomeOf("process") != process);
	CHECK_THROWS_WITH(keptOutcomeOf("abort"), Catch::Contains("crash their reader"));
	CHECK_THROWS_WITH(keptOutcomeOf("two texts"), Catch::Contains("crash their reader"));
	CHECK(keptOutcomeOf("process") != process);
}
