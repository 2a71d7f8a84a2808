// SPDX-License-Identifier: GPL-3.0-or-later
// The C API: what it returns, and that nothing a caller passes gets further than an error.
#include "testing.h"

#include "nook/nook.h"
#include "nook/nook.hpp"

#include <atomic>
#include <thread>

namespace nook
{
namespace
{

// A floor of 20 x 20 metres at y = 0, and a wall of that width at z = -10, 100 metres high.
const std::vector<double> kFloorAndWall{-10, 0, 10, 10, 0, 10, 10, 0, -10, -10, 0, -10, 10, 100, -10, -10, 100, -10};
const std::vector<int32_t> kFloorTriangles{0, 1, 2, 0, 2, 3, 3, 2, 4, 3, 4, 5};

nook_array rowsOf(const std::vector<double>& values)
{
	return array(values.data(), {values.size() / 3, 3});
}

// Programs were compiled with this layout: another one needs another NOOK_ABI.
static_assert(NOOK_ABI == 1 && sizeof(nook_array) == 48 && offsetof(nook_array, type) == 8 && offsetof(nook_array, shape) == 16);

// Status of making a level, which is destroyed again.
nook_status levelStatus(const nook_array* positions, const nook_array* triangles, const nook_array* normals = nullptr,
						const nook_array* uvs = nullptr)
{
	nook_level* level = nullptr;
	const nook_status status = nook_level_create(positions, triangles, normals, uvs, nullptr, &level);
	CHECK((level != nullptr) == (status == NOOK_OK));
	nook_level_destroy(level);
	return status;
}

std::string commandBytes(const std::string& command, const std::string& file)
{
	const std::string line = std::string(NOOK_PROGRAM) + " " + command + " -o " + file;
	REQUIRE(std::system(line.c_str()) == 0); // NOLINT: a command of this test
	return readFile(file);
}

} // namespace

TEST_CASE("capi: patterns, tiles and modules have the program's bytes", "[capi]")
{
	const TemporaryFolder folder;
	const std::string disk = folder / "disk.json";
	const std::string json = commandBytes("pattern --domain disk --count 5 --starts 2 --seed 3", disk);
	const Result made =
		pattern(Options().set("domain", "disk").set("count", 5).set("starts", 2).set("seed", 3).set("output", ".json"));
	CHECK(made.file(".json") == json);
	CHECK(made.array("points").shape[0] == 5);
	CHECK(made.array("points").shape[1] == 2);

	const std::string tile_json = commandBytes("tile --pattern " + disk + " --size 2 --starts 1", folder / "tile.json");
	const Result tiled = tile(Options().file("pattern", "disk.json", json).set("size", 2).set("starts", 1).set("output", ".json"));
	CHECK(tiled.file(".json") == tile_json);
	CHECK(tiled.array("points").dimensions == 3);

	const std::string glsl = commandBytes("emit --methods vo-line --patterns " + disk + " --glsl 330", folder / "module.glsl");
	const Result module =
		emit(Options().set("methods", "vo-line").file("patterns", "disk.json", json).set("glsl", "330").set("output", ".glsl"));
	CHECK(module.file(".glsl") == glsl);
}

TEST_CASE("capi: a floor reads 1, and 1/2 next to a wall", "[capi]")
{
	const Level level = Level::create(kFloorAndWall, kFloorTriangles);
	const std::vector<double> points{0, 0, 5, 0, 0, -9.999};
	const std::vector<double> normals{0, 2, 0, 0, 0.5, 0};
	const Options options = Options().set("radius", 4.0).set("rays", 4096);
	const Result result = visibility(level, rowsOf(points), rowsOf(normals), options);
	const std::vector<double> values = result.values<double>("visibility");
	CHECK(values[0] == 1.0);
	CHECK(values[1] == Approx(0.5).margin(0.02));

	const Result baked = bake(level, Options().set("radius", 4.0).set("rays", 32).set("output", ".glb"));
	CHECK(baked.array("visibility").shape[0] == 6);
	CHECK(baked.file(".glb").substr(0, 4) == "glTF");

	const Result pixels = gbuffer(level, Options().set("eye", "0,5,9").set("target", "0,0,0").set("size", "32x16"));
	const Result drawn = shade(pixels, Options().set("method", "slices").set("radius", 1.0));
	CHECK(drawn.array("visibility").shape[0] == 16);
	CHECK(drawn.array("visibility").shape[1] == 32);
	const nook_array picture = drawn.array("visibility");
	CHECK(compare(picture, picture).values<double>("rmse").front() == 0.0);
}

TEST_CASE("capi: vertices without a triangle are NaN, the others keep their places", "[capi]")
{
	std::vector<double> positions{7, 7, 7};
	positions.insert(positions.end(), kFloorAndWall.begin(), kFloorAndWall.end());
	std::vector<int32_t> triangles = kFloorTriangles;
	for (int32_t& index : triangles)
	{
		index += 1;
	}
	const Options options = Options().set("radius", 4.0).set("rays", 32);
	const std::vector<float> all = bake(Level::create(positions, triangles), options).values<float>("visibility");
	const std::vector<float> used = bake(Level::create(kFloorAndWall, kFloorTriangles), options).values<float>("visibility");
	CHECK(std::isnan(all.front()));
	CHECK(std::vector(all.begin() + 1, all.end()) == used);
	// Six vertices are used; six rows of pixels are no vertices.
	const Options view = Options().set("eye", "0,5,9").set("target", "0,0,0").set("size", "8x6");
	CHECK(gbuffer(Level::create(positions, triangles), view).array("depth").shape[0] == 6);
}

TEST_CASE("capi: parts are ignored where a level is loaded, and chosen where it is used", "[capi]")
{
	const TemporaryFolder folder;
	const std::string path = folder / "a.obj";
	writeFile(path, "v 0 0 1\nv 1 0 1\nv 1 0 0\no Floor\nf 1 2 3\nv 0 0 0\nv 1 0 0\nv 1 1 0\no Wall\nf 4 5 6\n");
	const Options options = Options().set("radius", 1.0).set("rays", 32).set("receivers", "Wall").set("occluders", "Wall");
	const std::vector<float> values = bake(Level::load(path), options).values<float>("visibility");
	REQUIRE(values.size() == 6);
	CHECK((std::isnan(values[0]) && values[3] == 1.0F && values[5] == 1.0F));
	const Level ignoring = Level::load(path, Options().set("ignore", "Floor"));
	CHECK(bake(ignoring, options).values<float>("visibility").size() == 3);
	CHECK_THROWS_WITH(bake(ignoring, Options().set("radius", 1.0).set("ignore", "Wall")),
					  Catch::Contains("ignore: found with a level that is loaded"));
	CHECK_THROWS_WITH(bake(ignoring, Options().set("radius", 1.0).set("unit", 2.0)),
					  Catch::Contains("unit: found with a level that is loaded"));
	CHECK_THROWS_WITH(bake(ignoring, Options().set("radius", 1.0).set("occluders", "Floor")),
					  Catch::Contains("occluders: found 'Floor', expected parts of a.obj: '/Wall'"));
}

TEST_CASE("capi: numbers of any type give the same level, also misaligned", "[capi]")
{
	std::vector<float> numbers(kFloorAndWall.begin(), kFloorAndWall.end());
	std::vector<char> bytes(numbers.size() * sizeof(float) + 1);
	std::memcpy(bytes.data() + 1, numbers.data(), numbers.size() * sizeof(float));
	nook_array positions = array(numbers.data(), {numbers.size() / 3, 3});
	positions.data = bytes.data() + 1;
	const std::vector<uint8_t> triangles(kFloorTriangles.begin(), kFloorTriangles.end());
	const nook_array corners = array(triangles.data(), {4, 3});
	nook_level* handle = nullptr;
	REQUIRE(nook_level_create(&positions, &corners, nullptr, nullptr, nullptr, &handle) == NOOK_OK);
	const Level level(handle);
	nook_result* described = nullptr;
	REQUIRE(nook_level_describe(handle, &described) == NOOK_OK);
	CHECK(Result(described).values<double>("positions") == kFloorAndWall);
}

TEST_CASE("capi: null pointers, destroyed handles and handles of another kind are errors", "[capi]")
{
	const nook_array points = rowsOf(kFloorAndWall);
	nook_options* options = nullptr;
	nook_result* result = nullptr;
	REQUIRE(nook_options_create(&options) == NOOK_OK);
	auto* const other = reinterpret_cast<nook_level*>(options); // NOLINT: on purpose
	nook_array found{};
	const char* text = nullptr;
	std::size_t size = 0;
	const std::array<nook_status, 20> statuses{
		nook_options_create(nullptr),
		nook_options_set(nullptr, "rays", "1"),
		nook_options_set(options, nullptr, "1"),
		nook_options_set(options, "rays", nullptr),
		nook_options_file(options, "pattern", nullptr, "", 0),
		nook_options_file(options, "pattern", "../p.json", "", 0),
		nook_options_progress(nullptr, nullptr, nullptr),
		nook_level_load(nullptr, nullptr, nullptr),
		nook_level_describe(nullptr, &result),
		nook_level_describe(other, &result),
		nook_run_pattern(options, nullptr),
		nook_run_visibility(nullptr, &points, &points, options, &result),
		nook_run_bake(other, options, &result),
		nook_run_volumes(nullptr, nullptr, &result),
		nook_run_shade(nullptr, nullptr, nullptr, nullptr, options, &result),
		nook_run_compare(&points, nullptr, nullptr, options, &result),
		nook_result_array(nullptr, "points", &found),
		nook_result_file(reinterpret_cast<nook_result*>(uintptr_t{12345}), ".json", &text, &size), // NOLINT
		nook_result_facts(nullptr, &text, nullptr),
		nook_run_emit(nullptr, &result)};
	for (std::size_t i = 0; i < statuses.size(); ++i)
	{
		INFO(i);
		CHECK(statuses[i] == NOOK_USAGE);
	}
	CHECK(nook_result_name(nullptr, 0) == nullptr);
	nook_options_destroy(options);
	nook_options_destroy(options);
	nook_level_destroy(nullptr);
	CHECK(nook_options_set(options, "rays", "1") == NOOK_USAGE);
	CHECK(result == nullptr);
}

TEST_CASE("capi: arrays that cannot be are errors", "[capi]")
{
	const nook_array good = rowsOf(kFloorAndWall);
	const nook_array triangles = array(kFloorTriangles.data(), {4, 3});
	CHECK(levelStatus(&good, &triangles) == NOOK_OK);
	const auto with = [&](const auto& change)
	{
		nook_array bad = good;
		change(bad);
		return levelStatus(&bad, &triangles);
	};
	CHECK(with([](nook_array& a) { a.data = nullptr; }) == NOOK_USAGE);
	CHECK(with([](nook_array& a) { a.type = 0; }) == NOOK_USAGE);
	CHECK(with([](nook_array& a) { a.type = 8; }) == NOOK_USAGE);
	CHECK(with([](nook_array& a) { a.dimensions = -1; }) == NOOK_USAGE);
	CHECK(with([](nook_array& a) { a.dimensions = 1 << 30; }) == NOOK_USAGE);
	CHECK(with([](nook_array& a) { a.shape[0] = 0; }) == NOOK_USAGE);
	CHECK(with([](nook_array& a) { a.shape[0] = ~uint64_t{0}; }) == NOOK_USAGE);
	CHECK(with([](nook_array& a) { a.shape[0] = (~uint64_t{0} / 3) + 1; }) == NOOK_USAGE);
	CHECK(with([](nook_array& a) { a.shape[1] = 2; }) == NOOK_USAGE);
	CHECK(levelStatus(&good, &good) == NOOK_USAGE); // indices are whole
	CHECK(levelStatus(&good, &triangles, &triangles) == NOOK_USAGE);

	for (const double number : {std::nan(""), HUGE_VAL, -1e16})
	{
		std::vector<double> positions = kFloorAndWall;
		positions[7] = number;
		const nook_array bad = rowsOf(positions);
		CHECK(levelStatus(&bad, &triangles) == NOOK_INVALID_INPUT);
		CHECK(std::string(nook_error()).find("row 2") != std::string::npos);
	}
	for (const int32_t index : {-1, 6, std::numeric_limits<int32_t>::max()})
	{
		std::vector<int32_t> corners = kFloorTriangles;
		corners[4] = index;
		const nook_array bad = array(corners.data(), {4, 3});
		CHECK(levelStatus(&good, &bad) == NOOK_INVALID_INPUT);
	}
}

TEST_CASE("capi: options are checked as on the command line", "[capi]")
{
	const auto statusOf = [](const char* name, const char* value)
	{
		nook_result* result = nullptr;
		const Options options = Options().set("domain", "disk").set("count", 4).set(name, value);
		const nook_status status = nook_run_pattern(options.get(), &result);
		nook_result_destroy(result);
		return status;
	};
	CHECK(statusOf("starts", "1") == NOOK_OK);
	CHECK(statusOf("starts", "0") == NOOK_USAGE);
	CHECK(std::string(nook_error()).starts_with("--starts: found '0'"));
	CHECK(statusOf("startz", "1") == NOOK_USAGE);
	CHECK(statusOf("output", "x/y.json") == NOOK_USAGE);
	CHECK(statusOf("output", ".tiff") == NOOK_USAGE);
	CHECK(statusOf("timing", "true") == NOOK_USAGE);
	CHECK(statusOf("json", "-") == NOOK_USAGE);
	CHECK(statusOf("", "1") == NOOK_USAGE);
	CHECK(statusOf("o=x/y.json --count", "1") == NOOK_USAGE);
	CHECK(nook_require(NOOK_ABI) == NOOK_OK);
	CHECK(nook_require(NOOK_ABI + 1) == NOOK_WRONG_VERSION);
	CHECK(std::string(nook_version()) == NOOK_VERSION);
}

TEST_CASE("capi: nook.hpp takes the numbers that arrays can hold", "[capi]")
{
	STATIC_REQUIRE(isArrayNumber<float> == true);
	STATIC_REQUIRE(isArrayNumber<std::uint8_t> == true);
	STATIC_REQUIRE(isArrayNumber<std::uint64_t> == true);
	STATIC_REQUIRE(isArrayNumber<std::uint16_t> == false);
	STATIC_REQUIRE(isArrayNumber<std::int8_t> == false);
	STATIC_REQUIRE(isArrayNumber<bool> == false);
	STATIC_REQUIRE(isArrayNumber<long double> == (sizeof(long double) == 8));
	CHECK_THROWS_AS(Level::create(kFloorAndWall, std::vector<std::uint32_t>{0, 1, 2, 0}), Failure);
}

TEST_CASE("capi: nook.hpp reaches every function", "[capi]")
{
	std::vector<double> normals(kFloorAndWall.size(), 0.0);
	for (std::size_t i = 1; i < normals.size(); i += 3)
	{
		normals[i] = 1.0;
	}
	const Level level =
		Level::create(kFloorAndWall, kFloorTriangles, normals, std::vector<double>(kFloorAndWall.size() / 3 * 2, 0.5));
	const Result described = level.describe();
	CHECK(described.names() == std::vector<std::string>{"positions", "triangles", "normals", "uvs"});
	CHECK(described.array("triangles").shape[0] == 4);
	CHECK(described.warnings().empty());
	Options view;
	view.set("eye", "0,1,-8").set("target", "0,0,-10").set("size", "8x6");
	const Result pixels = gbuffer(level, view);
	const nook_array depth = pixels.array("depth");
	const nook_array projection = pixels.array("projection");
	const nook_array camera = pixels.array("world_to_camera");
	Options how;
	how.set("method", "slices").set("radius", "2").set("normals", "from-depth");
	const std::vector<float> seen = shade(depth, nullptr, &projection, &camera, how).values<float>("visibility");
	CHECK(seen.size() == 48);
	const std::vector<float> open(48, 1.0F);
	const std::vector<float> none(48, 0.0F);
	const nook_array test = array(seen.data(), {6, 8});
	const nook_array reference = array(open.data(), {6, 8});
	const nook_array mask = array(none.data(), {6, 8});
	CHECK(compare(test, reference).values<double>("rmse").front() > 0.0);
	CHECK_THROWS_AS(compare(test, reference, &mask), Failure); // nothing is left
}

TEST_CASE("capi: progress cancels, also by throwing", "[capi]")
{
	const Level level = Level::load("builtin:cornell");
	std::atomic<int> told = 0;
	const auto statusOf = [&](nook_progress progress)
	{
		for (const int threads : {1, 4})
		{
			const Options options = Options().set("radius", 1.0).set("rays", 64).set("threads", threads);
			check(nook_options_progress(options.get(), progress, &told));
			nook_result* result = nullptr;
			CHECK(nook_run_bake(level.get(), options.get(), &result) == NOOK_CANCELLED);
			CHECK(result == nullptr);

			const Options points = Options().set("domain", "disk").set("count", 9).set("threads", threads);
			check(nook_options_progress(points.get(), progress, &told));
			CHECK(nook_run_pattern(points.get(), &result) == NOOK_CANCELLED);
		}
	};
	statusOf(
		[](void* user, const char*, double)
		{
			auto& count = *static_cast<std::atomic<int>*>(user);
			count += 1;
			return count % 5 == 0 ? 1 : 0;
		});
	CHECK(told > 4);
	statusOf([](void*, const char*, double) -> int32_t { throw 1; });
}

TEST_CASE("capi: a progress callback may make calls of its own", "[capi]")
{
	const auto nested = [](void* user, const char*, double) -> int32_t
	{
		auto& calls = *static_cast<int*>(user);
		const Options options = Options().set("radius", 1.0).set("rays", 16).set("threads", 4);
		nook_level* level = nullptr;
		nook_result* result = nullptr;
		// The callback that runs is not called again by the call that it makes.
		if (calls < 3 && nook_level_load("builtin:cornell", nullptr, &level) == NOOK_OK &&
			nook_run_bake(level, options.get(), &result) == NOOK_OK)
		{
			++calls;
		}
		nook_result_destroy(result);
		nook_level_destroy(level);
		return 0;
	};
	int calls = 0;
	const Options options = Options().set("radius", 1.0).set("rays", 64).set("threads", 4);
	check(nook_options_progress(options.get(), nested, &calls));
	const Level level = Level::load("builtin:cornell");
	const Result with = bake(level, options);
	CHECK(calls == 3);
	const Result without = bake(level, Options().set("radius", 1.0).set("rays", 64));
	CHECK(with.values<float>("visibility") == without.values<float>("visibility"));
}

TEST_CASE("capi: one level in several threads, destroyed while it is used", "[capi]")
{
	nook_level* level = nullptr;
	REQUIRE(nook_level_load("builtin:cornell", nullptr, &level) == NOOK_OK);
	const std::vector<double> points{0, 1, 0};
	const std::vector<double> normals{0, 1, 0};
	const nook_array at = rowsOf(points);
	const nook_array about = rowsOf(normals);
	const Options options = Options().set("radius", 2.0).set("threads", 2);
	std::atomic<int> good = 0;
	std::atomic<int> other = 0;
	std::vector<std::thread> threads;
	for (int i = 0; i < 4; ++i)
	{
		threads.emplace_back(
			[&]
			{
				for (int call = 0; call < 50; ++call)
				{
					nook_result* result = nullptr;
					const nook_status status = nook_run_visibility(level, &at, &about, options.get(), &result);
					good += status == NOOK_OK ? 1 : 0;
					other += status != NOOK_OK && status != NOOK_USAGE ? 1 : 0;
					nook_options_set(options.get(), "seed", "7"); // twice in the end, which is an error of later calls
					nook_result_destroy(result);
				}
			});
	}
	nook_level_destroy(level);
	for (std::thread& thread : threads)
	{
		thread.join();
	}
	CHECK(other == 0);
}

TEST_CASE("capi: random calls end with a status", "[capi]")
{
	Random random(1);
	const auto below = [&random](std::size_t count)
	{
		return static_cast<std::size_t>(random.uniform() * static_cast<double>(count)) % count;
	};
	const std::array<const char*, 10> names{"rays",   "radius", "count", "domain",   "size",
											"method", "seed",   "",      "distance", "max-error"};
	const std::array<const char*, 12> values{"1", "2", "-1", "disk", "nan", "inf", "", "8x8", "slices", "1e9", "true", "0.5"};
	const std::array<uint64_t, 6> counts{0, 1, 3, 6, ~uint64_t{0}, uint64_t{1} << 62U};
	std::vector<double> numbers(6 * 6 * 6, 0.25);
	numbers[5] = std::nan("");
	std::vector<void*> handles{nullptr, reinterpret_cast<void*>(uintptr_t{8})}; // NOLINT: garbage on purpose
	const auto arrayOf = [&]
	{
		nook_array made = array(numbers.data(), {1, 3});
		made.dimensions = static_cast<int32_t>(below(6)) - 1;
		made.type = static_cast<nook_type>(below(9));
		for (uint64_t& count : made.shape)
		{
			count = counts[below(counts.size())]; // all items of a sound shape are among the numbers
		}
		return made;
	};
	for (int call = 0; call < 3000; ++call)
	{
		const auto handle = [&]<class Handle>(Handle*)
		{
			return static_cast<Handle*>(handles[below(handles.size())]);
		};
		nook_options* const options = handle(static_cast<nook_options*>(nullptr));
		nook_level* const level = handle(static_cast<nook_level*>(nullptr));
		nook_result* result = nullptr;
		nook_options* made_options = nullptr;
		nook_level* made_level = nullptr;
		const nook_array one = arrayOf();
		const nook_array two = arrayOf();
		switch (below(10))
		{
		case 0: nook_options_create(&made_options); break;
		case 1: nook_options_set(options, names[below(names.size())], values[below(values.size())]); break;
		case 2: nook_options_number(options, names[below(names.size())], numbers[below(9)]); break;
		case 3:
			nook_level_create(&one, &two, below(4) == 0 ? &one : nullptr, below(4) == 0 ? &two : nullptr, options, &made_level);
			break;
		case 4: nook_run_visibility(level, &one, &two, options, &result); break;
		case 5: nook_run_shade(&one, &two, &one, &two, options, &result); break;
		case 6: nook_run_compare(&one, &two, below(2) == 0 ? &one : nullptr, options, &result); break;
		case 7: nook_run_gbuffer(level, options, &result); break;
		case 8: nook_options_destroy(options); break;
		default: nook_run_tile(options, &result); break;
		}
		for (void* const made : {static_cast<void*>(result), static_cast<void*>(made_options), static_cast<void*>(made_level)})
		{
			if (made != nullptr)
			{
				handles.push_back(made);
			}
		}
	}
	for (void* const made : handles)
	{
		nook_options_destroy(static_cast<nook_options*>(made));
	}
}

} // namespace nook
