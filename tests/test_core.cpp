// SPDX-License-Identifier: GPL-3.0-or-later
#include "testing.h"

#include "core/decimal.h"
#include "core/isolate.h"
#include "core/parallel.h"
#include "core/progress.h"

#include <sys/wait.h>

#include <atomic>

namespace
{

ExitCode codeOf(const std::function<void()>& act)
{
	try
	{
		act();
	}
	catch (const Error& error)
	{
		return error.code();
	}
	return ExitCode::ok;
}

std::string messageOf(const std::function<void()>& act)
{
	try
	{
		act();
	}
	catch (const Error& error)
	{
		return error.what();
	}
	return "";
}

using Names = std::vector<std::string>;

[[gnu::noinline]] void roundPair(double* pair)
{
	pair[0] = static_cast<double>(static_cast<float>(pair[0]));
	pair[1] = static_cast<double>(static_cast<float>(pair[1]));
}

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

TEST_CASE("file: bytes come back as they went", "[core]")
{
	const TemporaryFolder folder;
	std::string bytes("\0\r\n\xff", 4);
	for (int i = 0; i < 100000; ++i)
	{
		bytes += static_cast<char>(i % 251);
	}
	writeFile(folder / "a b.bin", bytes);
	CHECK(readFile(folder / "a b.bin") == bytes);
	writeFile(folder / "a b.bin", "");
	CHECK(readFile(folder / "a b.bin").empty());
	CHECK(folder.names() == Names{"a b.bin"});
}

TEST_CASE("file: what cannot be read or written says so with its path", "[core]")
{
	const TemporaryFolder folder;
	CHECK(codeOf([&] { readFile(folder / "none.json"); }) == ExitCode::file);
	CHECK(codeOf([&] { readFile(folder / ""); }) == ExitCode::file); // a folder opens, but cannot be read
	CHECK(codeOf([&] { writeFile(folder / "none/a.json", "x"); }) == ExitCode::file);
	CHECK(codeOf([&] { writeFile("/dev/full", "x"); }) == ExitCode::file);
	CHECK(messageOf([&] { writeFile(folder / "none/a.json", "x"); }) ==
		  (folder / "none/a.json") + ": cannot be written: No such file or directory");
	CHECK(messageOf([] { writeFile("/dev/full", "x"); }) == "/dev/full: cannot be written: No space left on device");
	CHECK(folder.names().empty());
}

TEST_CASE("file: checkWritable finds closed folders before any work", "[core]")
{
	const TemporaryFolder folder;
	writeFile(folder / "plain", "x");
	CHECK_NOTHROW(checkWritable("-"));
	CHECK_NOTHROW(checkWritable("/dev/null"));
	CHECK_NOTHROW(checkWritable(folder / "new.json"));
	CHECK_NOTHROW(checkWritable(folder / "plain"));
	CHECK_NOTHROW(checkWritable("new.json"));
	CHECK(codeOf([&] { checkWritable(folder / ""); }) == ExitCode::file);
	CHECK(codeOf([&] { checkWritable(folder / "none/a.json"); }) == ExitCode::file);
	CHECK(codeOf([&] { checkWritable(folder / "plain/a.json"); }) == ExitCode::file);
	CHECK(folder.names() == Names{"plain"});
}

TEST_CASE("file: outputs of one run appear together or not at all", "[core]")
{
	const TemporaryFolder folder;
	writeFile(folder / "old.json", "old");
	SECTION("all good")
	{
		OutputSet outputs;
		outputs.add(folder / "old.json", "new");
		outputs.add(folder / "b.exr", "b");
		CHECK(readFile(folder / "old.json") == "old");
		outputs.commit();
		CHECK(readFile(folder / "old.json") == "new");
		CHECK(readFile(folder / "b.exr") == "b");
		CHECK(folder.names() == Names{"b.exr", "old.json"});
	}
	SECTION("a full device")
	{
		OutputSet outputs;
		outputs.add(folder / "old.json", "new");
		outputs.add(folder / "a.json", "a");
		outputs.add("/dev/full", "x");
		CHECK(codeOf([&] { outputs.commit(); }) == ExitCode::file);
	}
	SECTION("never committed")
	{
		OutputSet outputs;
		outputs.add(folder / "old.json", "new");
		outputs.add(folder / "a.json", "a");
	}
	SECTION("a folder that takes a name in between")
	{
		OutputSet outputs;
		outputs.add(folder / "old.json", "new");
		outputs.add(folder / "a.json", "a");
		outputs.add(folder / "b.json", "b");
		std::filesystem::create_directory(folder / "b.json");
		CHECK(codeOf([&] { outputs.commit(); }) == ExitCode::file);
		std::filesystem::remove(folder / "b.json");
	}
	if (folder.names().size() == 1)
	{
		CHECK(readFile(folder / "old.json") == "old");
	}
	CHECK((folder.names() == Names{"old.json"} || folder.names() == Names{"b.exr", "old.json"}));
}

TEST_CASE("file: a link stays a link, its end is replaced", "[core]")
{
	const TemporaryFolder folder;
	writeFile(folder / "end.json", "old");
	std::filesystem::create_symlink("end.json", folder / "link.json");
	writeFile(folder / "link.json", "new");
	CHECK(std::filesystem::is_symlink(folder / "link.json"));
	CHECK(readFile(folder / "end.json") == "new");
	std::filesystem::create_symlink("/dev/full", folder / "full.json");
	CHECK(codeOf([&] { writeFile(folder / "full.json", "x"); }) == ExitCode::file);
	CHECK(std::filesystem::is_symlink(folder / "full.json"));
	CHECK(folder.names() == Names{"end.json", "full.json", "link.json"});
}

TEST_CASE("depfile: blanks, hashes, dollars and colons are escaped", "[core]")
{
	const Names targets{"out/a b.h", "x#1.glsl"};
	const Names sources{"in $(x).json", "back\\slash", "odd\\ name", "c:d%e"};
	CHECK(depfileText(targets, sources) ==
		  "out/a\\ b.h x\\#1.glsl: \\\n  in\\ $$(x).json \\\n  back\\slash \\\n  odd\\\\\\ name \\\n  c\\:d%e\n");
	CHECK(depfileText(targets, {}) == "out/a\\ b.h x\\#1.glsl:\n");
}

// tests/depfile_test.sh checks with Make and Ninja.
TEST_CASE("depfile: names that Make or Ninja cannot hold are refused", "[core]")
{
	const auto codes = [](const std::string& name)
	{
		const Names names{name};
		return std::pair{codeOf([&] { depfileText(names, {}); }), codeOf([&] { depfileText({}, names); })};
	};
	const std::pair refused{ExitCode::unsupported, ExitCode::unsupported};
	for (const char c : std::string("\n\r\t\x01\x7F\"&'*;<=>?[^`|"))
	{
		INFO(static_cast<int>(c));
		CHECK(codes("a" + std::string(1, c) + "b") == refused);
	}
	for (const char* const name :
		 {"", "a ", "a:", "a\\", "a(b)", "~", "~root", "./~root", ".//./~root", "a\\#b", "a\\:b", "a\\$b", "a\\%b"})
	{
		INFO(name);
		CHECK(codes(name) == refused);
	}
	CHECK(codes("a%b") == std::pair{ExitCode::unsupported, ExitCode::ok});
	CHECK(messageOf([] { depfileText({}, Names{"a\n;b"}); }) ==
		  "a\n;b: found a line break, expected a name that a depfile for Make and Ninja can hold");
}

TEST_CASE("file: one identity for all names of a file", "[core]")
{
	const TemporaryFolder folder;
	std::filesystem::create_directory(folder / "in");
	writeFile(folder / "a", "x");
	std::filesystem::create_symlink("a", folder / "link");
	std::filesystem::create_hard_link(folder / "a", folder / "hard");
	std::filesystem::create_directory_symlink("in", folder / "door");
	std::filesystem::create_symlink("in/new", folder / "dangling");
	std::filesystem::create_symlink("dangling", folder / "to dangling");
	for (const char* const name : {"./a", "in/../a", "link", "hard", "door/../a"})
	{
		INFO(name);
		CHECK(fileIdentity(folder / name) == fileIdentity(folder / "a"));
	}
	for (const char* const name : {"in/./new", "door/new", "dangling", "to dangling"})
	{
		INFO(name);
		CHECK(fileIdentity(folder / name) == fileIdentity(folder / "in/new"));
	}
	CHECK(fileIdentity(folder / "in/new") != fileIdentity(folder / "new"));
	CHECK(fileIdentity(folder / "b") != fileIdentity(folder / "a"));
	CHECK(fileIdentity("-") == "-");
	CHECK(fileIdentity("new") == fileIdentity(std::filesystem::current_path().string() + "/new"));

	writeFile(folder / "to dangling", "y"); // links stay and now have a target
	CHECK(std::filesystem::is_symlink(folder / "to dangling"));
	CHECK(readFile(folder / "in/new") == "y");
}

// Compared with the C library's long double functions: with a 64-bit mantissa they are accurate to well below the stated error.
TEST_CASE("math: logarithm and powers within the stated error", "[core]")
{
	Random random(1);
	long double worst_log = 0.0L;
	long double worst_exp = 0.0L;
	for (int i = 0; i < 200000; ++i)
	{
		const double exponent = 600.0 * (random.uniform() - 0.5);
		const double x = std::exp2(exponent);
		const long double log_true = std::log(static_cast<long double>(x));
		const long double scale = std::max(1.0L, std::fabs(log_true));
		worst_log = std::max(worst_log, std::fabs(logOf(x) - log_true) / scale);
		const double y = 1400.0 * (random.uniform() - 0.5) * random.uniform();
		const long double exp_true = std::exp(static_cast<long double>(y));
		worst_exp = std::max(worst_exp, std::fabs(expOf(y) - exp_true) / exp_true);
	}
	CHECK(worst_log < 4e-16L);
	CHECK(worst_exp < 4e-16L);
	CHECK(logOf(1.0) == 0.0);
	CHECK(expOf(0.0) == 1.0);
	CHECK(powOf(2.0, 10.0) == Approx(1024.0).epsilon(1e-14));
	CHECK(powOf(0.3, -4.0) == Approx(1.0 / (0.3 * 0.3 * 0.3 * 0.3)).epsilon(1e-14));
}

TEST_CASE("math: angles within the stated error", "[core]")
{
	Random random(2);
	long double worst_sine = 0.0L;
	long double worst_angle = 0.0L;
	long double worst_asin = 0.0L;
	for (int i = 0; i < 200000; ++i)
	{
		const double reach = i % 2 == 0 ? 10.0 : 1e5;
		const double angle = 2.0 * reach * (random.uniform() - 0.5);
		const SinCos pair = sinCosOf(angle);
		worst_sine = std::max(worst_sine, std::fabs(pair.sin - std::sin(static_cast<long double>(angle))));
		worst_sine = std::max(worst_sine, std::fabs(pair.cos - std::cos(static_cast<long double>(angle))));
		const double x = random.uniform() - 0.5;
		const double y = random.uniform() - 0.5;
		const long double angle_true = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
		worst_angle = std::max(worst_angle, std::fabs(atan2Of(y, x) - angle_true) / std::fabs(angle_true));
		worst_asin = std::max(worst_asin, std::fabs(asinOf(2.0 * x) - std::asin(2.0L * x)));
	}
	CHECK(worst_sine < 4e-16L);
	CHECK(worst_angle < 1e-15L);
	CHECK(worst_asin < 1e-15L);
	CHECK(atan2Of(0.0, 0.0) == 0.0);
	CHECK(atan2Of(0.0, -1.0) == kPi);
	CHECK(atan2Of(1.0, 0.0) == 0.5 * kPi);
	CHECK(atan2Of(-1.0, 0.0) == -0.5 * kPi);
	CHECK(asinOf(1.0 + 1e-15) == 0.5 * kPi);
	CHECK(asinOf(-1.0 - 1e-15) == -0.5 * kPi);
}

TEST_CASE("math: rounding to a 32-bit float is kept by the compiler", "[core]")
{
	volatile double x = 0.59618837; // volatile: otherwise the compiler would compute the sum correctly
	volatile double y = 0.28025317;
	std::array<double, 2> pair{x, y};
	roundPair(pair.data());
	CHECK(pair[0] == 0x1.313f9ap-1);
	CHECK(pair[1] == 0x1.1efabp-2);
}

TEST_CASE("random: the reference sequence of PCG32", "[core]")
{
	// pcg32-demo of the generator's author: seed 42, sequence 54.
	Random random(42, 54);
	const std::array<uint32_t, 6> expected{0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU, 0xcbed606eU};
	for (const uint32_t value : expected)
	{
		CHECK(random.next() == value);
	}
}

TEST_CASE("random: uniform in range and mean, streams differ", "[core]")
{
	Random random(7);
	double sum = 0.0;
	const int count = 100000;
	for (int i = 0; i < count; ++i)
	{
		const double u = random.uniform();
		REQUIRE(u >= 0.0);
		REQUIRE(u < 1.0);
		sum += u;
	}
	CHECK(std::fabs(sum / count - 0.5) < 5.0 / std::sqrt(12.0 * count)); // five standard deviations
	Random first(7, 1);
	Random second(7, 2);
	int equal = 0;
	for (int i = 0; i < 1000; ++i)
	{
		equal += first.next() == second.next() ? 1 : 0;
	}
	CHECK(equal <= 1);
}

TEST_CASE("random: below gives every value as often", "[core]")
{
	Random random(3);
	std::array<int, 6> hits{};
	const int count = 60000;
	for (int i = 0; i < count; ++i)
	{
		hits[random.below(6)] += 1;
	}
	const double chi2 = sumOver(hits, [](const int n) { return (n - 10000.0) * (n - 10000.0) / 10000.0; });
	CHECK(chi2 < 20.5); // 0.1 % of the time above, five degrees of freedom
	CHECK(random.below(1) == 0);
}

TEST_CASE("parallel: every item once, on any number of threads", "[core]")
{
	for (const int threads : {1, 2, 4, 7})
	{
		std::vector<std::atomic<int>> hits(1000);
		parallelFor(hits.size(), threads, [&](std::size_t i) { hits[i] += 1; });
		CHECK(std::all_of(hits.begin(), hits.end(), [](const std::atomic<int>& n) { return n == 1; }));
		parallelFor(0, threads, [](std::size_t) { FAIL("no items"); });
	}
	CHECK(availableThreads() >= 1);
}

TEST_CASE("parallel: an item's exception arrives", "[core]")
{
	const int threads = GENERATE(1, 2, 4);
	const auto act = [&]
	{
		parallelFor(100, threads,
					[](std::size_t i)
					{
						if (i == 37)
						{
							throw Error(ExitCode::runtime, "37");
						}
					});
	};
	CHECK(codeOf(act) == ExitCode::runtime);
}

TEST_CASE("progress: grows from zero to one, one call at a time", "[core]")
{
	double last = -1.0;
	bool grows = true;
	const Progress progress = [&](std::string_view stage, double share)
	{
		grows = grows && stage == "work" && share > last;
		last = share;
	};
	ProgressCounter counter(progress, "work", 500);
	CHECK(last == 0.0);
	parallelFor(500, 4, [&](std::size_t) { counter.finishOne(); });
	CHECK(grows);
	CHECK(last == 1.0);
}

TEST_CASE("progress: a stage ends once, early or late, but not by an error", "[core]")
{
	std::vector<double> shares;
	const Progress progress = [&](std::string_view, double share)
	{
		shares.push_back(share);
	};
	{
		ProgressCounter early(progress, "work", 4);
		early.finishOne();
	}
	CHECK(shares == std::vector{0.0, 0.25, 1.0});
	shares.clear();
	{
		const ProgressCounter uncounted(progress, "work");
		const ProgressCounter none(progress, "nothing", countIfSeveral(1));
	}
	CHECK(shares == std::vector{0.0, 1.0});
	shares.clear();
	{
		ProgressCounter many(progress, "work", 100'000);
		many.finish(99'999);
		many.finishOne();
		CHECK(shares == std::vector{0.0, 0.99999, 1.0});
	}
	CHECK(shares.size() == 3);
	shares.clear();
	CHECK_THROWS_AS(
		[&]
		{
			const ProgressCounter failing(progress, "work");
			throw Error(ExitCode::runtime, "no");
		}(),
		Error);
	CHECK(shares == std::vector{0.0});
}

TEST_CASE("progress: the time that is left is that of an even stage, and of one that has become slower", "[core]")
{
	RemainingTime even;
	CHECK_FALSE(even.at(5.0));
	for (int i = 1; i <= 40; ++i)
	{
		even.add(0.1 * i, 0.01 * i);
		CHECK(even.at(0.1 * i).has_value() == (i >= 10));
	}
	CHECK(std::fabs(*even.at(4.0) - 6.0) < 1e-9);
	CHECK(std::fabs(*even.at(6.5) - 3.5) < 1e-9); // counts down
	CHECK_FALSE(even.at(10.5));                   // longer than estimated
	even.add(12.0, 1.0);
	CHECK(even.at(12.0) == 0.0);

	RemainingTime slower; // half in the first second, then a hundredth per second
	slower.add(1.0, 0.5);
	for (int i = 1; i <= 10; ++i)
	{
		slower.add(1.0 + i, 0.5 + 0.01 * i);
	}
	CHECK(std::fabs(*slower.at(11.0) - 40.0) < 1e-6);
}

// Numbers as text by printf and strtod (for libraries without floating-point <charconv>) compared with <charconv>.

// core/decimal_printf.cpp, compiled a second time under another name (tests/CMakeLists.txt).
namespace nook_by_printf
{
std::string shortestDecimal(float value);
std::string shortestDecimal(double value);
std::string shortestScientific(float value);
std::string decimalOf(double value, std::chars_format format, int digits);
std::from_chars_result readDecimal(const char* first, const char* last, double& value);
} // namespace nook_by_printf

using namespace nook;

TEST_CASE("decimal: the shortest text is that of <charconv>", "[core]")
{
	Random random(3);
	for (int i = 0; i < 20000; ++i)
	{
		const auto wide = bitsAs<double>((static_cast<uint64_t>(random.next()) << 32U) | random.next());
		const auto narrow = bitsAs<float>(random.next());
		const double power = std::ldexp(i % 2 == 0 ? 1.0 : -1.0, i % 2098 - 1074);
		const double plain = std::round(random.uniform() * 1e6) / std::pow(10.0, i % 12);
		for (const double value : {wide, power, plain, static_cast<double>(narrow), std::ldexp(plain, 60)})
		{
			if (!std::isnan(value))
			{
				REQUIRE(nook_by_printf::shortestDecimal(value) == shortestDecimal(value));
			}
		}
		for (const float value : {narrow, static_cast<float>(power), static_cast<float>(plain)})
		{
			if (!std::isnan(value))
			{
				REQUIRE(nook_by_printf::shortestDecimal(value) == shortestDecimal(value));
				REQUIRE(nook_by_printf::shortestScientific(value) == shortestScientific(value));
			}
		}
		for (const auto format : {std::chars_format::general, std::chars_format::scientific, std::chars_format::fixed})
		{
			REQUIRE(nook_by_printf::decimalOf(wide, format, 1 + i % 8) == decimalOf(wide, format, 1 + i % 8));
			REQUIRE(nook_by_printf::decimalOf(plain, format, i % 8) == decimalOf(plain, format, i % 8));
		}
	}
}

TEST_CASE("decimal: what is read is what <charconv> reads", "[core]")
{
	Random random(4);
	const std::string letters = "0123456789..eE+-0123456789infa x";
	std::vector<std::string> texts{"",       "-",      ".",        "1.",     ".5",        "+1",     " 1",       "0x10",
								   "1e",     "1e+",    "1e5",      "-1E-3",  "inf",       "-INF",   "infinity", "infinit",
								   "nan",    "nan(1)", "nan(",     "nan()",  "nan(_a9)x", "nan( )", "-nan(x)",  "1e400",
								   "-1e400", "1e-400", "4.9e-324", "2e-324", "1,5"};
	for (int i = 0; i < 20000; ++i)
	{
		std::string text;
		for (uint32_t k = random.below(9); k > 0; --k)
		{
			text += letters[random.below(static_cast<uint32_t>(letters.size()))];
		}
		texts.push_back(text);
	}
	for (const std::string& text : texts)
	{
		CAPTURE(text);
		double a = 7.0;
		double b = 7.0;
		const std::from_chars_result expected = readDecimal(text.data(), text.data() + text.size(), a);
		const std::from_chars_result found = nook_by_printf::readDecimal(text.data(), text.data() + text.size(), b);
		REQUIRE(found.ec == expected.ec);
		REQUIRE(found.ptr == expected.ptr);
		REQUIRE((a == b || (std::isnan(a) && std::isnan(b))));
	}
}

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
