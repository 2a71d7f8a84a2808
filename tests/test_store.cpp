// SPDX-License-Identifier: GPL-3.0-or-later
// The store of finished work: archives, values on disk, units of a stage and their shares.
#include "testing.h"

#include "core/work_units.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <sys/stat.h>
#include <unistd.h>

namespace nook
{

enum class Paint
{
	red,
	green,
};

struct Item
{
	std::string name;
	std::optional<double> size;
	std::vector<glm::vec3> points;
	std::array<int, 3> numbers{};
	Paint colour = Paint::red;
	bool whole = false;

	bool operator==(const Item&) const = default;
};

void visit(Archive& archive, Item& item)
{
	archive(item.name, item.size, item.points, item.numbers, item.colour, item.whole);
}

} // namespace nook

using namespace nook;

namespace
{

std::vector<Item> sampleItems()
{
	return {
		{"one", 0.1, {glm::vec3(1.0F, 2.0F, 3.0F)}, {1, 2, 3}, Paint::green, true}, {}, {"three", std::nullopt, {}, {}, {}, false}};
}

// The greatest load over the mean.
double balanceOf(std::span<const double> costs, int shares)
{
	std::vector<double> loads(static_cast<std::size_t>(shares));
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
	return *std::max_element(sums.begin(), sums.end()) * shares / std::accumulate(sums.begin(), sums.end(), 0.0);
}

const std::vector<std::string> kCommand{"1.2.3", "squares", "--count", "20"};

// Squares of numbers; how many of them are computed.
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
				  [&](std::size_t i, Archive& archive)
				  {
					  archive(values[i]);
				  }},
				 settings);
	}
};

std::vector<std::filesystem::path> valuesIn(const std::filesystem::path& folder)
{
	std::vector<std::filesystem::path> files;
	for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
	{
		if (entry.is_regular_file())
		{
			files.push_back(entry.path());
		}
	}
	return files;
}

} // namespace

TEST_CASE("archive: values come back, and every truncation is refused", "[core]")
{
	std::vector<Item> items = sampleItems();
	glm::dmat4 matrix(0.5);
	const Visitor visitor = [&](Archive& archive)
	{
		archive(items, matrix);
	};
	const std::string bytes = bytesOf(visitor);
	items.clear();
	matrix = glm::dmat4(0.0);
	REQUIRE(readBytes(bytes, visitor));
	CHECK(items == sampleItems());
	CHECK(matrix == glm::dmat4(0.5));
	for (std::size_t length = 0; length < bytes.size(); ++length)
	{
		CHECK_FALSE(readBytes(std::string_view(bytes).substr(0, length), visitor));
	}
	CHECK_FALSE(readBytes(bytes + "x", visitor));
	CHECK_FALSE(readBytes(std::string(8, '\xFF') + bytes, visitor)); // a count of 2^64 − 1
}

TEST_CASE("store: a value that was cut short, changed or moved counts as missing", "[core]")
{
	const TemporaryFolder folder;
	const std::string path = folder / "store";
	Store(path, "1").put("key", std::string("value"));
	CHECK(Store(path, "1").get<std::string>("key") == "value");
	CHECK_FALSE(Store(path, "1").get<std::string>("other"));
	CHECK_FALSE(Store(path, "2").get<std::string>("key"));
	const std::string file = valuesIn(path).front().string();
	const std::string bytes = readFile(file);
	const auto refused = [&](const std::string& changed)
	{
		writeFile(file, changed);
		Store store(path, "1");
		return !store.get<std::string>("key") && store.remark().starts_with(file + ": found a value that was cut short or changed");
	};
	for (std::size_t length = 0; length < bytes.size(); ++length)
	{
		CHECK(refused(bytes.substr(0, length)));
	}
	for (std::size_t i = 0; i < bytes.size(); ++i)
	{
		std::string changed = bytes;
		changed[i] = static_cast<char>(changed[i] ^ 1);
		CHECK(refused(changed));
	}
	Store store(path, "1");
	store.put("key", std::string("value"));
	CHECK(readFile(file) == bytes);
	store.put("other", std::string("another"));
	for (const std::filesystem::path& other : valuesIn(path))
	{
		if (other.string() != file)
		{
			std::filesystem::copy_file(other, file, std::filesystem::copy_options::overwrite_existing);
		}
	}
	CHECK_FALSE(Store(path, "1").get<std::string>("key"));
	std::filesystem::remove(file);
	std::filesystem::create_directory(file);
	CHECK_FALSE(Store(path, "1").get<std::string>("key"));
}

TEST_CASE("store: what cannot be kept is an error in a share, else a remark", "[core]")
{
	const TemporaryFolder folder;
	writeFile(folder / "file", "");
	CHECK_THROWS_WITH(Store(folder / "file", "1"), folder / "file" +
													   ": found a file, expected a folder for finished work, or a place "
													   "for one");
	CHECK_THROWS_AS(Store(folder / "file/below", "1"), Error);
	Store store(folder / "store", "1");
	Store share(folder / "store", "1", true);
	std::filesystem::remove_all(folder / "store");
	writeFile(folder / "store", ""); // in place of the folder: nothing can be written, whoever runs this
	store.put("key", 1.0);
	CHECK_FALSE(store.remark().empty());
	CHECK_THROWS_AS(share.put("key", 1.0), Error);
}

TEST_CASE("store: a value is computed once, and not kept if it is not to be", "[core]")
{
	const TemporaryFolder folder;
	int computed = 0;
	double value = 0.0;
	const auto take = [&](bool keep)
	{
		value = 0.0;
		Store(folder / "store", "1")
			.once(
				"key",
				[&]
				{
					computed += 1;
					value = 2.0;
					return keep;
				},
				[&](Archive& archive) { archive(value); });
		return value;
	};
	CHECK(take(false) == 2.0);
	CHECK(take(true) == 2.0);
	CHECK(take(true) == 2.0);
	CHECK(computed == 2);
}

TEST_CASE("shares: units are dealt evenly by what they cost", "[core]")
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

TEST_CASE("shares: neighbours of one cost go to different shares", "[core]")
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

TEST_CASE("shares: each unit is computed once, and a run after them computes none", "[core]")
{
	Squares single;
	single.run({});
	const int of = GENERATE(1, 2, 7, 16, 30);
	const TemporaryFolder folder;
	std::size_t computed = 0;
	for (int number = of; number >= 1; --number)
	{
		WorkUnits units(folder / "store", kCommand, WorkShare{number, of});
		Squares squares;
		squares.run({1, {}, &units});
		computed += squares.computed;
		CHECK(isShare({1, {}, &units}));
	}
	CHECK(computed == 20);
	WorkUnits units(folder / "store", kCommand);
	Squares all;
	all.run({2, {}, &units});
	CHECK(all.values == single.values);
	CHECK(all.computed == 0);
}

TEST_CASE("shares: units of a group go to one share, in whatever stage they are", "[core]")
{
	const TemporaryFolder folder;
	std::vector<int> owners(30, 0);
	for (int number = 1; number <= 3; ++number)
	{
		WorkUnits units(folder / ("store" + std::to_string(number)), kCommand, WorkShare{number, 3});
		const RunSettings run{1, {}, &units};
		const auto nothing = [](std::size_t, Archive&) {
		};
		const auto group = [](std::size_t i)
		{
			return std::to_string(i % 10);
		};
		runStage({"first", 30, [](std::size_t i) { return 1.0 + static_cast<double>(i % 7); },
				  [&](std::size_t i)
				  {
					  CHECK(owners[i] == 0);
					  owners[i] = number;
				  },
				  nothing, group},
				 run);
		runStage({"second", 10, [](std::size_t) { return 1.0; },
				  [&](std::size_t i)
				  {
					  for (const std::size_t k : {i, i + 10, i + 20})
					  {
						  CHECK(owners[k] == number);
					  }
				  },
				  nothing, group},
				 run);
	}
	CHECK(std::count(owners.begin(), owners.end(), 0) == 0);
}

TEST_CASE("shares: another command, version or input has other results", "[core]")
{
	const TemporaryFolder folder;
	const auto computed = [&](const std::vector<std::string>& command)
	{
		WorkUnits units(folder / "store", command);
		units.addInputs({folder / "input", "builtin:cornell"});
		Squares squares;
		squares.run({1, {}, &units});
		units.finish();
		return squares.computed;
	};
	const auto finished = [&](const std::vector<std::string>& command)
	{
		Store store(folder / "store", command.front());
		return finishedUnits(store, command, std::nullopt, "");
	};
	writeFile(folder / "input", "one");
	CHECK_FALSE(finished(kCommand));
	CHECK(computed(kCommand) == 20);
	CHECK(computed(kCommand) == 0);
	CHECK(finished(kCommand) == 20);
	CHECK(computed({"1.2.3", "squares", "--count", "21"}) == 20);
	CHECK(computed({"1.2.4", "squares", "--count", "20"}) == 20);
	writeFile(folder / "input", "two");
	CHECK_FALSE(finished(kCommand));
	CHECK(computed(kCommand) == 20);
	writeFile(folder / "input", "one");
	CHECK(computed(kCommand) == 0);
}
