// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/byte_text.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "core/random.h"
#include "core/work_units.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>

using namespace nook;

namespace
{

// Of what a part has to do, the greatest over the mean.
double balanceOf(std::span<const double> costs, int parts)
{
	std::vector<double> loads(static_cast<std::size_t>(parts));
	const std::vector<int> owners = dealUnits(costs, loads);
	std::vector<double> sums(loads.size());
	for (std::size_t i = 0; i < costs.size(); ++i)
	{
		sums[static_cast<std::size_t>(owners[i])] += costs[i];
	}
	for (std::size_t i = 0; i < loads.size(); ++i)
	{
		CHECK(sums[i] == Approx(loads[i])); // added in another order
	}
	return *std::max_element(sums.begin(), sums.end()) * parts / std::accumulate(sums.begin(), sums.end(), 0.0);
}

PartFile samplePart(int number = 2, int of = 3)
{
	PartFile part;
	part.path = std::to_string(number) + ".part";
	part.version = "1.2.3";
	part.command = {"reference", "level.glb", "--rays", "16"};
	part.part = {number, of};
	part.inputs = {{"level.glb", "0123456789abcdef0123456789abcdef"}};
	part.stages["rays"] = {{1, "first"}, {7, ""}};
	part.stages["rays 2"] = {};
	return part;
}

std::string refusalOf(const std::string& bytes)
{
	try
	{
		partFrom(bytes, "a.part");
	}
	catch (const Error& error)
	{
		CHECK(error.code() == ExitCode::invalid_input);
		return error.what();
	}
	return {};
}

std::string refusalOf(std::vector<PartFile> parts)
{
	try
	{
		checkParts(parts, "1.2.3");
	}
	catch (const Error& error)
	{
		CHECK(error.code() == ExitCode::invalid_input);
		return error.what();
	}
	return {};
}

// Squares of numbers, and sums that need all of them; how often a square is computed.
struct Squares
{
	std::vector<double> values = std::vector<double>(20);
	std::size_t computed = 0;

	void run(const RunSettings& settings)
	{
		runStage({"squares", values.size(), [](std::size_t i) { return static_cast<double>(i); },
				  [&](std::size_t i)
				  {
					  values[i] = static_cast<double>(i * i);
					  computed += 1;
				  },
				  [&](std::size_t i)
				  {
					  ByteWriter out;
					  out.number(values[i]);
					  return out.take();
				  },
				  [&](std::size_t i, std::string_view bytes)
				  {
					  ByteReader in(bytes);
					  values[i] = in.number();
					  return in.isAtEnd();
				  }},
				 settings);
		finishUnits(settings);
	}
};

std::vector<PartFile> partsOfSquares(int of)
{
	std::vector<PartFile> parts;
	for (int number = of; number >= 1; --number)
	{
		WorkUnits units(PartNumber{number, of});
		Squares squares;
		CHECK_THROWS_AS(squares.run({1, {}, &units}), PartIsDone);
		parts.push_back(units.result());
		parts.back().version = "1.2.3";
		parts.back().command = {"squares"};
		parts.back().path = std::to_string(number) + ".part";
	}
	return parts;
}

} // namespace

TEST_CASE("parts: units are dealt evenly by what they cost", "[core]")
{
	const std::vector<double> even(1600, 1.0);
	CHECK(balanceOf(even, 16) == 1.0);
	CHECK(balanceOf(even, 7) < 1.01);
	std::vector<double> uneven;
	Random random(1);
	for (int i = 0; i < 1600; ++i)
	{
		uneven.push_back(1.0 + 100.0 * random.uniform() * random.uniform());
	}
	CHECK(balanceOf(uneven, 16) < 1.01);
	CHECK(balanceOf(uneven, 100) < 1.1);
	std::vector<double> loads(4);
	const std::vector<double> few{5.0, 1.0};
	const std::vector<int> owners = dealUnits(few, loads);
	CHECK(owners == std::vector<int>{0, 1});
	dealUnits(few, loads); // what was dealt before counts
	CHECK(loads == std::vector<double>{5.0, 1.0, 5.0, 1.0});
}

TEST_CASE("parts: neighbours of one cost are not of one part", "[core]")
{
	std::vector<double> loads(16);
	const std::vector<double> costs(3600, 1.0);
	const std::vector<int> owners = dealUnits(costs, loads);
	int beside = 0;
	for (std::size_t i = 80; i < owners.size(); ++i) // rows of 80, a multiple of 16
	{
		beside += owners[i] == owners[i - 80] ? 1 : 0;
	}
	CHECK(beside < 3600 / 8);
}

TEST_CASE("parts: a file comes back as it was written", "[core]")
{
	const std::string bytes = partBytes(samplePart());
	const PartFile part = partFrom(bytes, "a.part");
	CHECK(partBytes(part) == bytes);
	CHECK(part.part == PartNumber{2, 3});
	CHECK(part.command == samplePart().command);
	CHECK(part.stages.at("rays").at(1) == "first");
}

TEST_CASE("parts: every truncation and every changed byte is refused", "[core]")
{
	const std::string bytes = partBytes(samplePart());
	for (std::size_t length = 0; length < bytes.size(); ++length)
	{
		CHECK(refusalOf(bytes.substr(0, length)).starts_with("a.part: found "));
	}
	for (std::size_t i = 0; i < bytes.size(); ++i)
	{
		for (const unsigned flip : {1U, 32U, 128U, 255U})
		{
			std::string changed = bytes;
			changed[i] = static_cast<char>(static_cast<unsigned char>(changed[i]) ^ flip);
			CHECK(refusalOf(changed).starts_with("a.part: found "));
		}
	}
	CHECK(refusalOf(bytes + "x").starts_with("a.part: found "));
}

// The sum is no secret: whoever lies may make it fit.
TEST_CASE("parts: lengths that lie under a sum that fits are refused", "[core]")
{
	const std::string bytes = partBytes(samplePart());
	const std::size_t begin = bytes.find('\n') + 1;
	const auto sealed = [](const std::string& body)
	{
		ContentHash sum;
		sum.add(body);
		return "nook.part/1 " + sum.text() + " " + std::to_string(body.size()) + "\n" + body;
	};
	REQUIRE(sealed(bytes.substr(begin)) == bytes);
	for (std::size_t i = 0; begin + i < bytes.size(); ++i)
	{
		for (const unsigned flip : {1U, 128U, 255U})
		{
			std::string body = bytes.substr(begin);
			body[i] = static_cast<char>(static_cast<unsigned char>(body[i]) ^ flip);
			const std::string refusal = refusalOf(sealed(body));
			if (refusal.empty()) // a letter of a text, or an index
			{
				CHECK(partBytes(partFrom(sealed(body), "a.part")) == sealed(body));
			}
		}
		CHECK(refusalOf(sealed(bytes.substr(begin, i))).starts_with("a.part: found "));
	}
}

TEST_CASE("parts: what does not belong together is refused by name", "[core]")
{
	const auto with = [](auto change)
	{
		std::vector<PartFile> parts{samplePart(3), samplePart(1), samplePart(2)};
		change(parts);
		return refusalOf(parts);
	};
	CHECK(with([](auto&) {}).empty());
	CHECK(with([](auto& parts) { parts.pop_back(); }) == "merge: found 2 of 3 parts, expected all; missing: 2");
	CHECK(with([](auto& parts) { parts.erase(parts.begin()); }) == "merge: found 2 of 3 parts, expected all; missing: 3");
	CHECK(with([](auto& parts) { parts.push_back(samplePart(1)); }) ==
		  "1.part: found part 1/3 again, which 1.part is, expected it once");
	CHECK(with([](auto& parts) { parts[1].version = "1.2.4"; }) ==
		  "1.part: found a part that nook 1.2.4 has made, expected nook 1.2.3");
	CHECK(with([](auto& parts) { parts[1].command.back() = "17"; }).starts_with("1.part: found a part of 'nook reference"));
	CHECK(with([](auto& parts) { parts[1].part.of = 4; }) == "1.part: found part 1/4, expected one of 3 as 3.part");
	CHECK(with([](auto& parts) { parts[1].inputs[0].hash[0] = 'f'; }) ==
		  "1.part: found it made from other bytes of level.glb than 3.part, expected the same");
	CHECK(with([](auto& parts) { parts[1].inputs.clear(); }) ==
		  "1.part: found it made from other files than 3.part, expected the same");
}

TEST_CASE("parts: each unit is computed once, and a merge computes none", "[core]")
{
	Squares single;
	single.run({});
	for (const int of : {1, 2, 7, 16, 30})
	{
		std::vector<PartFile> parts = partsOfSquares(of);
		checkParts(parts, "1.2.3");
		WorkUnits units(std::move(parts));
		Squares merged;
		merged.run({2, {}, &units});
		CHECK(merged.values == single.values);
		CHECK(merged.computed == 0);
	}
}

TEST_CASE("parts: a merge refuses shares that are not a part's own", "[core]")
{
	const auto with = [](auto change)
	{
		std::vector<PartFile> parts = partsOfSquares(3);
		checkParts(parts, "1.2.3");
		change(parts);
		WorkUnits units(std::move(parts));
		try
		{
			Squares().run({1, {}, &units});
		}
		catch (const Error& error)
		{
			return std::string(error.what());
		}
		return std::string();
	};
	CHECK(with([](auto&) {}).empty());
	CHECK(with([](auto& parts) { parts[0].stages["cubes"] = {}; }) ==
		  "1.part: found a stage 'cubes' that this command has not, expected none");
	CHECK(with([](auto& parts) { parts[1].stages.clear(); }).starts_with("2.part: stage 'squares': unit "));
	CHECK(with([](auto& parts) { parts[1].stages["squares"].erase(parts[1].stages["squares"].begin()); })
			  .starts_with("2.part: stage 'squares': unit "));
	CHECK(
		with([](auto& parts) { parts[1].stages["squares"].begin()->second += "x"; }).starts_with("2.part: stage 'squares': unit "));
	CHECK(with([](auto& parts) { parts[1].stages["squares"][99] = "x"; }).starts_with("2.part: stage 'squares': found "));
}
