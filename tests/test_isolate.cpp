// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/isolate.h"

#include <catch2/catch.hpp>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>
#include <numeric>

#include <sys/wait.h>
#include <unistd.h>

using namespace nook;

namespace
{

// What becomes of a child that does this.
std::string outcomeOf(const std::function<void(IsolatedWriter&)>& work, const IsolationLimits& limits = {})
{
	std::string answer = "fine";
	try
	{
		isolate("some.file", limits, work, [&](IsolatedReader& from) { answer = from.text(); });
	}
	catch (const Error& error)
	{
		answer = std::to_string(static_cast<int>(error.code())) + " " + error.what();
	}
	CHECK(::waitpid(-1, nullptr, WNOHANG) == -1); // no child is left, alive or dead
	return answer;
}

} // namespace

TEST_CASE("isolate: what the child writes comes back", "[core]")
{
	CHECK(outcomeOf([](IsolatedWriter& to) { to.text("a word"); }) == "a word");
	std::vector<double> sent(300000);
	std::iota(sent.begin(), sent.end(), 0.5);
	std::vector<double> got;
	int whole = 0;
	std::string text;
	isolate(
		"f", {},
		[&](IsolatedWriter& to)
		{
			to.value(7);
			to.values(sent);
			to.values(std::vector<double>{});
			to.text("");
			to.text("end");
		},
		[&](IsolatedReader& from)
		{
			whole = from.value<int>();
			from.values(got, 1000000);
			from.values(got, 0);
			text = from.text() + from.text();
		});
	CHECK(whole == 7);
	CHECK(got == sent);
	CHECK(text == "end");
}

TEST_CASE("isolate: errors of the child are errors here", "[core]")
{
	CHECK(outcomeOf([](IsolatedWriter&) { throw Error(ExitCode::file, "a.bin: gone"); }) == "2 a.bin: gone");
	CHECK(outcomeOf(
			  [](IsolatedWriter& to)
			  {
				  to.text("half");
				  throw Error(ExitCode::invalid_input, "b: wrong");
			  }) == "3 b: wrong");
}

TEST_CASE("isolate: a child that ends badly is one line", "[core]")
{
	const std::string broken = "3 some.file: found something that breaks its reader, expected a whole file of its format";
	CHECK(outcomeOf([](IsolatedWriter&) { std::abort(); }) == broken);
	CHECK(outcomeOf([](IsolatedWriter&) { std::raise(SIGSEGV); }) == broken);
	CHECK(outcomeOf([](IsolatedWriter&) { ::_exit(0); }) == broken);
	CHECK(outcomeOf([](IsolatedWriter&) { throw 1; }) == broken);
	CHECK(outcomeOf([](IsolatedWriter&) {}) == broken); // less than was expected
	CHECK(outcomeOf(
			  [](IsolatedWriter& to)
			  {
				  to.text("more");
				  to.text("than was expected");
			  }) == broken);
}

TEST_CASE("isolate: a child that writes more than is taken is not waited for", "[core]")
{
	const auto flood = [](IsolatedWriter& to)
	{
		to.values(std::vector<char>(1000));
		to.values(std::vector<char>(std::size_t{1} << 24U));
	};
	std::vector<char> got;
	CHECK_THROWS_WITH(isolate("some.file", {}, flood, [&](IsolatedReader& from) { from.values(got, 10); }),
					  Catch::Contains("breaks its reader"));
	CHECK_THROWS_WITH(isolate("some.file", {}, flood, [&](IsolatedReader& from) { from.values(got, 1000); }),
					  Catch::Contains("breaks its reader"));
}

TEST_CASE("isolate: endless work and endless memory are stopped", "[core]")
{
	const auto spin = [](IsolatedWriter&)
	{
		for (std::atomic<int> i = 0;; ++i)
		{
		}
	};
	CHECK(outcomeOf(spin, {1U << 30U, 1}).find("does not come to an end") != std::string::npos);
	CHECK(outcomeOf([](IsolatedWriter&) { ::pause(); }, {1U << 30U, 1}).find("does not come to an end") != std::string::npos);
	const auto grow = [](IsolatedWriter&)
	{
		for (std::vector<char*> held;;)
		{
			held.push_back(new char[1U << 24U]);
			std::memset(held.back(), 1, 1U << 24U);
			::usleep(1000); // with address checks only the parent's watch stops this
		}
	};
	CHECK(outcomeOf(grow, {std::size_t{200} << 20U, 20}).find("far more memory") != std::string::npos);
}
