// SPDX-License-Identifier: GPL-3.0-or-later
// The report on time and error: front, cache, baseline, JSON, page.
#include "small_levels.h"
#include "testing.h"

#include "core/base64.h"
#include "core/content_hash.h"
#include "core/work_units.h"
#include "shade/gl_context.h"
#include "study/error_report.h"
#include "study/measure_view.h"

namespace
{

ErrorPoint pointOf(const std::string& name, Origin origin, double milliseconds, double eq14, double noise = 0.01)
{
	ErrorPoint point;
	point.name = name;
	point.method = name.substr(0, name.find(' '));
	point.origin = origin;
	point.count = name.find(' ') == std::string::npos ? 0 : std::atoi(name.c_str() + name.find(' '));
	point.resolution = "full";
	point.measured.candidate = name;
	point.measured.renderer = "test";
	point.measured.repetitions = 3;
	point.measured.total = {"total", 1e-3 * milliseconds, 0.9e-3 * milliseconds, 1.1e-3 * milliseconds};
	point.measured.passes = {point.measured.total};
	point.measured.errors.eq14 = eq14;
	point.measured.errors.rmse = 0.1 * eq14;
	point.measured.own_rmse = noise;
	return point;
}

ErrorReport reportOf(std::vector<ErrorPoint> points)
{
	ErrorReport report;
	report.context = {"test", false, 1, "0"};
	report.command = "nook report error test";
	report.rays = 64;
	report.repetitions = 3;
	ErrorLevel level;
	level.name = "test";
	level.radius_m = 1.0;
	ErrorView view;
	view.camera = "main";
	view.width_px = 2;
	view.height_px = 1;
	view.points = std::move(points);
	view.picture = {0, 255};
	level.views = {view};
	report.levels = {level};
	return report;
}

ErrorView& viewIn(ErrorReport& report)
{
	return report.levels.front().views.front();
}

// A box in a corner of a file, tiny pictures on the CPU: a second.
ErrorReportSettings tinySettings(const TemporaryFolder& folder)
{
	const std::string path = folder / "corner.obj";
	writeFile(path, "v -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nv -2 3 -2\nv 2 3 -2\nv -0.5 0 -0.5\nv 0.5 0 -0.5\nv 0 1 -0.5\n"
					"f 4 3 2\nf 4 2 1\nf 1 2 6\nf 1 6 5\nf 7 8 9\nf 9 8 7\n");
	ErrorReportSettings settings;
	settings.levels = {path};
	settings.automatic = 1;
	settings.width_px = 32;
	settings.height_px = 18;
	settings.rays = 64;
	for (const Candidate& candidate : candidateGrid(GridSize::quick))
	{
		const std::string name = candidate.name();
		if (name == "vo-line 5 electro window" || name == "alchemy 4 uniform bilateral-13" || name == "statvo 4 cells-2 skip" ||
			name == "aov triangles" || name == "aov built third" || name == "rays 8")
		{
			settings.only.push_back(candidate);
		}
	}
	settings.measure.device = Device::cpu;
	settings.measure.repetitions = 1;
	settings.version = "test";
	return settings;
}

// A box on a floor, seen from above one side.
Level boxOnFloor()
{
	Level level = emptyLevel();
	addQuad(level, {-4.0, 0.0, -4.0}, {0.0, 0.0, 8.0}, {8.0, 0.0, 0.0});
	addBox(level, {-0.5, 0.0, -0.5}, {0.5, 1.0, 0.5});
	LevelCamera camera;
	camera.name = "main";
	camera.world_from_camera = worldFromCamera({2.0, 2.0, 2.0}, {0.0, 0.3, 0.0});
	level.cameras.push_back(camera);
	return level;
}

Candidate lines(int count)
{
	Candidate candidate;
	candidate.source = SampleSource::refined;
	candidate.count = count;
	candidate.shade.filter = ShadeFilter::bilateral;
	return candidate;
}

MeasureSettings onCpu(int repetitions)
{
	MeasureSettings settings;
	settings.device = Device::cpu;
	settings.repetitions = repetitions;
	return settings;
}

Candidate assetOf(std::string_view name)
{
	Candidate candidate;
	candidate.kind = CandidateKind::asset;
	candidate.asset = assetNamed(name);
	return candidate;
}

Candidate rays(int count)
{
	Candidate candidate;
	candidate.kind = CandidateKind::rays;
	candidate.origin = Origin::rays;
	candidate.count = count;
	return candidate;
}

} // namespace

TEST_CASE("error report: the front is what nothing beats in both time and error", "[report]")
{
	ErrorReport report = reportOf({pointOf("a 1", Origin::ours, 1.0, 8.0), pointOf("b 1", Origin::paper, 2.0, 9.0),
								   pointOf("b 2", Origin::paper, 2.0, 4.0), pointOf("a 2", Origin::ours, 4.0, 4.0),
								   pointOf("a 3", Origin::ours, 8.0, 2.0), pointOf("c 1", Origin::ours, 16.0, 3.0),
								   pointOf("rays 1", Origin::rays, 0.5, 1.0)});
	ErrorView& view = viewIn(report);
	setFront(view);
	std::string front;
	for (const ErrorPoint& point : view.points)
	{
		front += point.front ? point.name + "," : "";
	}
	CHECK(front == "a 1,b 2,a 3,");
	CHECK(view.share.papers == std::vector<std::string>{"b 2"});
	// From 1 to 8 ms: theirs leads from 2 to 4, at 4 ours is as good.
	CHECK(view.share.held == Approx(2.0 / 3.0));
	REQUIRE(view.share.worst_ratio);
	CHECK(*view.share.worst_ratio == Approx(2.0));
	CHECK(view.share.worst_paper == "b 2");
}

TEST_CASE("error report: the front of bytes is of what needs some; what takes no time is on no front of time", "[report]")
{
	std::vector<ErrorPoint> points{pointOf("vo-line 1", Origin::ours, 1.0, 9.0), pointOf("bake", Origin::ours, 0.0, 3.0),
								   pointOf("bake 0.1", Origin::ours, 0.0, 2.0), pointOf("aov built", Origin::ours, 5.0, 2.5),
								   pointOf("aov-mask 128", Origin::ours, 9.0, 1.0)};
	for (const auto& [i, bytes] : {std::pair{1U, 100U}, {2U, 400U}, {3U, 500U}, {4U, 500U}})
	{
		points[i].measured.bytes = bytes;
	}
	ErrorReport report = reportOf(std::move(points));
	ErrorView& view = viewIn(report);
	setFront(view);
	std::string of_bytes;
	std::string of_time;
	for (const ErrorPoint& point : view.points)
	{
		of_bytes += point.front_bytes ? point.name + "," : "";
		of_time += point.front ? point.name + "," : "";
	}
	CHECK(of_bytes == "bake,bake 0.1,aov-mask 128,");
	CHECK(of_time == "vo-line 1,aov built,aov-mask 128,");
}

TEST_CASE("error report: what is chosen from all points is likely among any part of them", "[report]")
{
	Random random(7, 1);
	for (int round = 0; round < 200; ++round)
	{
		ErrorView all;
		for (int i = 0; i < 20; ++i)
		{
			const std::string method = std::vector<std::string>{"vo-line", "statvo", "alchemy", "rays"}[random.next() % 4];
			const Origin origin = method == "rays" ? Origin::rays : random.next() % 2 == 0 ? Origin::ours : Origin::paper;
			const double time_ms = 0.5 * static_cast<double>(random.next() % 8); // some are equal, some none
			all.points.push_back(pointOf(method + " " + std::to_string(i), origin, time_ms, 0.1 * (random.next() % 8)));
		}
		std::vector<ErrorView> parts(3);
		std::vector<std::pair<std::size_t, std::size_t>> places; // part, place there
		for (const ErrorPoint& point : all.points)
		{
			const std::size_t part = random.next() % 3;
			places.emplace_back(part, parts[part].points.size());
			parts[part].points.push_back(point);
		}
		setFront(all);
		std::vector<std::set<std::size_t>> likely;
		for (ErrorView& part : parts)
		{
			setFront(part);
			likely.push_back(likelyPoints(part));
		}
		const std::set<std::size_t> chosen = chosenPoints(all, 8);
		REQUIRE(!chosen.empty());
		for (std::size_t i = 0; i < all.points.size(); ++i)
		{
			if (chosen.contains(i) || all.points[i].front)
			{
				CHECK(likely[places[i].first].contains(places[i].second));
			}
		}
	}
}

TEST_CASE("error report: patterns are made once for all levels, volumes and bakes once a level", "[report]")
{
	const std::vector<Candidate> grid = candidateGrid(GridSize::quick);
	std::set<std::string> made;
	const std::vector<double> one = candidateSeconds(grid, {"one", 1000, 20000, 3}, made);
	const std::vector<double> other = candidateSeconds(grid, {"other", 1000, 20000, 3}, made);
	const std::vector<double> again = candidateSeconds(grid, {"one", 1000, 20000, 3}, made);
	int tiles = 0;
	int of_level = 0;
	for (std::size_t i = 0; i < grid.size(); ++i)
	{
		const bool is_tile = grid[i].kind == CandidateKind::screen && grid[i].source == SampleSource::tile;
		const bool is_split = grid[i].method() == "bake" && grid[i].bake_error > 0.0;
		CHECK(again[i] <= one[i]);
		CHECK((sharedBy(grid[i], "one") == sharedBy(grid[i], "other")) ==
			  (grid[i].kind == CandidateKind::screen && grid[i].source != SampleSource::own));
		if (is_split || (grid[i].kind == CandidateKind::asset && grid[i].method() != "bake"))
		{
			CHECK(other[i] == one[i]);
			of_level += again[i] < one[i] ? 1 : 0;
		}
		tiles += is_tile && other[i] < one[i] ? 1 : 0;
	}
	CHECK(tiles >= 4);
	CHECK(of_level >= 3);
}

TEST_CASE("error report: a baseline finds errors that grow, and no times", "[report]")
{
	const std::vector<ErrorPoint> points{pointOf("vo-line 5", Origin::ours, 1.0, 2.0), pointOf("aov", Origin::ours, 4.0, 0.5)};
	const ErrorReport before = reportOf(points);
	ErrorReport now = before;
	viewIn(now).points[0].measured.total.median_s *= 100.0;
	viewIn(now).points[0].measured.errors.eq14 *= 1.01;
	CHECK(compareWithBaseline(now, before).regressions.empty());
	CHECK(compareWithBaseline(now, before).compared == 2);

	viewIn(now).points[1].measured.errors.eq14 = 0.6;
	viewIn(now).points[0].measured.errors.rmse *= 1.1;
	const BaselineResult worse = compareWithBaseline(now, before);
	REQUIRE(worse.regressions.size() == 2);
	CHECK(worse.regressions[0].candidate == "aov");
	CHECK(worse.regressions[0].metric == "eq14");
	CHECK(worse.regressions[1].metric == "rmse");

	viewIn(now).points.pop_back();
	CHECK(compareWithBaseline(now, before).missing == std::vector<std::string>{"test, main, aov"});
	now.rays = 65;
	CHECK_THROWS_AS(compareWithBaseline(now, before), Error);
}

TEST_CASE("error report: JSON reads back, and what is cut off is refused", "[report]")
{
	ErrorReport report = reportOf({pointOf("vo-line 5", Origin::ours, 1.0, 2.0), pointOf("rays 4", Origin::rays, 4.0, 0.5)});
	viewIn(report).points[0].picture = {1, 2};
	viewIn(report).points[0].flicker = 0.25;
	viewIn(report).limit = ScreenLimit{0.5, 0.8, 1.5, {0.3, 0.1, 0.2, {}, -0.1, 1.1, 0.05}};
	setFront(viewIn(report));
	const std::string text = errorReportJson(report);
	CHECK(errorReportJson(errorReportFrom(text, "report.json")) == text);
	for (std::size_t size = 0; size + 2 < text.size(); size += 7)
	{
		CHECK_THROWS_AS(errorReportFrom(text.substr(0, size), "report.json"), Error);
	}
	std::string wrong = text;
	wrong.replace(wrong.find("\"AQI=\""), 6, "\"AQ==\"");
	CHECK_THROWS_WITH(errorReportFrom(wrong, "report.json"),
					  Catch::Contains("found 1 bytes, expected a byte for each of 2 pixels"));
	viewIn(report).points[0].measured.errors.rmse = -0.5; // found by the fuzzer: it is worse than itself
	CHECK_THROWS_WITH(errorReportFrom(errorReportJson(report), "report.json"), Catch::Contains("expected a number from 0 to "));
}

TEST_CASE("error report: bytes come back from base64", "[report]")
{
	std::vector<uint8_t> bytes;
	for (int size = 0; size < 70; ++size)
	{
		const std::string text = base64Of(bytes);
		CHECK(bytesOfBase64(text) == bytes);
		bytes.push_back(static_cast<uint8_t>(37 * size + 11));
	}
	CHECK(base64Of(std::vector<uint8_t>{'f', 'o', 'o', 'b'}) == "Zm9vYg=="); // RFC 4648, §10
	CHECK_FALSE(bytesOfBase64("abc"));
	CHECK_FALSE(bytesOfBase64("a*cd"));
	CHECK_FALSE(bytesOfBase64("a=cd"));
}

TEST_CASE("error report: a file with one view twice is refused", "[report]")
{
	ErrorReport report;
	report.context.threads = 1;
	report.rays = 1;
	report.levels.resize(1);
	report.levels[0].views.resize(2);
	for (ErrorView& view : report.levels[0].views)
	{
		view.camera = "main";
		view.width_px = 1;
		view.height_px = 1;
		view.picture = {0};
	}
	CHECK_THROWS_WITH(errorReportFrom(errorReportJson(report), "report.json"),
					  Catch::Contains("levels[0].views[1].camera: found 'main' twice, expected each once"));
}

TEST_CASE("error report: an interrupted run goes on, and measures nothing twice", "[report]")
{
	const TemporaryFolder folder;
	const ErrorReportSettings settings = tinySettings(folder);
	const std::vector<std::string> command{"test", "report", "error"};
	const auto measured = [&](ErrorReportCounts* counts)
	{
		WorkUnits units(folder / "store", command);
		return measureErrors(settings, {1, {}, &units}, counts);
	};
	ErrorReportCounts first;
	const ErrorReport report = measured(&first);
	REQUIRE(report.levels.size() == 1);
	INFO(report.levels[0].failure);
	REQUIRE(report.levels[0].views.size() == 1);
	CHECK(report.levels[0].views[0].points.size() == 6);
	CHECK(first.measured > 15); // the limit tries ten, none of them as another
	const std::optional<ScreenLimit>& limit = report.levels[0].views[0].limit;
	REQUIRE(limit);
	CHECK(limit->errors.rmse > 0.0);
	for (const ErrorPoint& point : report.levels[0].views[0].points)
	{
		INFO(point.name << ' ' << point.measured.errors.rmse << ' ' << limit->errors.rmse);
		CHECK((point.method == "aov" || point.method == "rays" ||
			   limit->errors.rmse < point.measured.errors.rmse + 1e-3)); // all is nearly open
	}

	ErrorReportCounts second;
	const ErrorReport again = measured(&second);
	CHECK(errorReportJson(again) == errorReportJson(report));
	for (std::size_t i = 0; i < report.levels[0].views[0].points.size(); ++i)
	{
		const TimeSpread& fresh = report.levels[0].views[0].points[i].measured.total;
		const TimeSpread& kept = again.levels[0].views[0].points[i].measured.total;
		CHECK(fresh.median_s == kept.median_s);
		CHECK(fresh.low_s == kept.low_s);
		CHECK(fresh.high_s == kept.high_s);
	}
	CHECK(second.measured == 0);

	// Some results are lost, others cut short.
	std::size_t number = 0;
	for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "store"))
	{
		if (entry.is_regular_file() && ++number % 3 == 0)
		{
			std::filesystem::resize_file(entry.path(), number % 2 * std::filesystem::file_size(entry.path()) / 2);
		}
	}
	ErrorReportCounts third;
	const ErrorReport more = measured(&third);
	CHECK(third.measured > 0);
	for (std::size_t i = 0; i < report.levels[0].views[0].points.size(); ++i)
	{
		CHECK(more.levels[0].views[0].points[i].measured.errors.rmse == report.levels[0].views[0].points[i].measured.errors.rmse);
	}
}

TEST_CASE("error report: measurements and limits come back from the store", "[report]")
{
	const TemporaryFolder folder;
	Store store(folder / "store", "test");
	for (const std::optional<double> ssim : {std::optional(0.4), std::optional<double>()})
	{
		const ViewErrors errors{0.1, 0.2, 0.3, ssim, -0.5, 0.6, 0.7};
		store.put("limit", ScreenLimit{0.5, 1.25, 0.75, errors});
		const std::optional<ScreenLimit> limit = store.get<ScreenLimit>("limit");
		REQUIRE(limit);
		CHECK(limit->power == 0.75);
		CHECK(limit->errors.ssim == ssim);
		CHECK(limit->errors.best_rmse == 0.7);
		const Measurement measured{"a 1",  "CPU", 3,           {"total", 1.0, 0.5, 2.0}, {{"pass", 1.0, 0.5, 2.0}}, 7, 8, 9,
								   errors, ssim,  {0.5F, 1.0F}};
		store.put("measurement", measured);
		const std::optional<Measurement> found = store.get<Measurement>("measurement");
		REQUIRE(found);
		CHECK(found->candidate == "a 1");
		CHECK(found->passes.at(0).high_s == 2.0);
		CHECK(found->bytes == 9);
		CHECK(found->own_rmse == ssim);
		CHECK(found->visibility == measured.visibility);
	}
	store.put("reference", Reference{{0.25F, 1.0F, 0.5F}, 0.125});
	CHECK(store.get<Reference>("reference")->visibility == std::vector<float>{0.25F, 1.0F, 0.5F});
	CHECK_FALSE(store.get<Measurement>("reference"));
}

TEST_CASE("error report: its command has the options that levels are read with, and words of a shell", "[report]")
{
	ErrorReportSettings settings;
	settings.levels = {"builtin:cornell", "some folder/it's a level.obj"};
	settings.load = {{0.01, UpAxis::z, true}, {"Lamp*"}};
	settings.camera = "by the door";
	CHECK(errorReportCommand(settings) ==
		  "nook report error builtin:cornell 'it'\\''s a level.obj' --unit 0.01 --up z --ignore 'Lamp*' --strict --grid normal "
		  "--camera 'by the door' --size 320x180 --rays 1024 --repetitions 5 --slowest 0");
	settings.load = {};
	CHECK(errorReportCommand(settings).find("--unit") == std::string::npos);
	CHECK(shellWord("") == "''");
	CHECK(shellWord("a/b-1.glb") == "a/b-1.glb");
}

TEST_CASE("error report: a candidate that fails takes nothing from the others", "[report]")
{
	const TemporaryFolder folder;
	ErrorReportSettings settings = tinySettings(folder);
	settings.shifts = 0;
	const ErrorReport whole = measureErrors(settings, {});
	Candidate bad = settings.only.front();
	bad.shade.min_radius_px = 1e6; // more than the picture is high
	REQUIRE(bad.kind == CandidateKind::screen);
	settings.only.insert(settings.only.begin() + 1, bad);
	settings.shifts = 2;
	const ErrorReport report = measureErrors(settings, {});
	CHECK(report.levels[0].failure.find("'" + bad.name() + "': min-pixels") != std::string::npos);
	const std::vector<ErrorPoint>& points = report.levels[0].views.at(0).points;
	REQUIRE(points.size() == whole.levels[0].views.at(0).points.size());
	std::size_t moved = 0;
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		CHECK(points[i].name == whole.levels[0].views[0].points[i].name);
		moved += points[i].flicker ? 1U : 0U;
		if (points[i].flicker && points[i].name.starts_with("aov"))
		{
			CHECK(*points[i].flicker < 0.2); // that candidate's own, not its neighbour's
		}
	}
	CHECK(moved > 0);
	CHECK(errorReportHtml({&report, 1}, "test").find("min-pixels: found") != std::string::npos);
	settings.only = {bad};
	CHECK(measureErrors(settings, {}).levels[0].views.empty());
}

TEST_CASE("error report: how long a picture would take is told by smaller ones", "[report]")
{
	std::vector<int> drawn;
	const auto draw = [&drawn](int width_px, int height_px)
	{
		drawn.push_back(width_px);
		return 0.25 + 1e-3 * width_px * height_px;
	};
	CHECK(expectedSeconds(draw, 320, 160, 1e9) == Approx(0.25 + 51.2));
	CHECK(drawn == std::vector<int>{20, 40, 80});
	drawn.clear();
	CHECK(expectedSeconds(draw, 320, 160, 10.0) == Approx(0.25 + 51.2)); // a sixteenth, of which no line is known, and an eighth
	CHECK(drawn == std::vector<int>{20, 40});
	CHECK(expectedSeconds(draw, 320, 160, 0.1) == Approx(0.25 + 0.2));
	CHECK(drawn.size() == 3);
	CHECK(expectedSeconds(draw, 100, 63, 0.1) == 0.0);
	CHECK(drawn.size() == 3);
}

TEST_CASE("error report: what is too slow is stopped and shown, and is no failure", "[report]")
{
	const TemporaryFolder folder;
	ErrorReportSettings settings = tinySettings(folder);
	settings.shifts = 0;
	settings.width_px = 128;
	settings.height_px = 72;
	settings.measure.slowest_s = 1e-9;
	std::erase_if(settings.only, [](const Candidate& candidate) { return candidate.kind == CandidateKind::rays; });
	const std::size_t candidates = settings.only.size();
	const ErrorReport report = measureErrors(settings, {});
	CHECK(report.levels[0].failure.empty());
	const ErrorView& view = report.levels[0].views.at(0);
	REQUIRE(!view.stopped.empty());
	CHECK(view.stopped.size() + view.points.size() == candidates);
	for (const StoppedPoint& stopped : view.stopped)
	{
		CHECK(stopped.method.starts_with("aov"));
		CHECK(stopped.expected_s > 1e-9);
	}
	for (const ErrorPoint& point : view.points)
	{
		CHECK(!point.method.starts_with("aov"));
	}
	const std::string text = errorReportJson(report);
	CHECK(errorReportJson(errorReportFrom(text, "report.json")) == text);
}

TEST_CASE("error report: a level that fails is a line of it, and the others go on", "[report]")
{
	const TemporaryFolder folder;
	ErrorReportSettings settings = tinySettings(folder);
	settings.levels.insert(settings.levels.begin(), folder / "none.obj");
	settings.shifts = 0;
	const ErrorReport report = measureErrors(settings, {});
	REQUIRE(report.levels.size() == 2);
	CHECK(report.levels[0].failure.find("none.obj") != std::string::npos);
	CHECK(report.levels[0].failure.find(folder / "") == std::string::npos);
	CHECK(report.levels[1].failure.empty());
	CHECK(report.levels[1].views.size() == 1);
	const std::string page = errorReportHtml({&report, 1}, "test");
	CHECK(page.find("none.obj") != std::string::npos);
	CHECK(page.find("@DATA@") == std::string::npos);
	for (const char* const outside : {"src=\"http", "href=\"http", "url(http", "@import"})
	{
		CHECK(page.find(outside) == std::string::npos);
	}
}

// Candidates and what a view measures of them.

TEST_CASE("error report: names of candidates are unique, and the smaller grid is of the larger one's methods", "[report]")
{
	std::size_t before = 0;
	for (const GridSize size : {GridSize::quick, GridSize::normal, GridSize::full})
	{
		const std::vector<Candidate> grid = candidateGrid(size);
		std::set<std::string> names;
		std::set<std::string> methods;
		for (const Candidate& candidate : grid)
		{
			INFO(candidate.name());
			CHECK(names.insert(candidate.name()).second);
			methods.insert(candidate.method());
		}
		CHECK(methods.size() == 16);
		for (const std::string name :
			 {"hbao 6 bilateral-13 bias-10", "gtao 3 bilateral-5", "gtao 3 bilateral-5 rays", "bitmask 3 bilateral-5 rays"})
		{
			CHECK(names.contains(name)); // published at their best, raw and fitted
		}
		CHECK(grid.size() > before);
		before = grid.size();
	}
}

TEST_CASE("error report: more rays err less, and the reference says how far it may be off", "[report]")
{
	LevelBench level(boxOnFloor(), 1.0, {});
	ViewBench view(level, level.level.cameras.front(), {32, 18, 512, 1}, {});
	const MeasureSettings settings = onCpu(2);
	const Measurement few = view.measure(rays(4), settings);
	const Measurement many = view.measure(rays(256), settings);
	CHECK(many.errors.rmse < 0.5 * few.errors.rmse);
	CHECK(many.errors.eq14 < few.errors.eq14);
	CHECK(view.reference().error > 0.0);
	CHECK(view.reference().error < few.errors.rmse);
	CHECK(few.passes.size() == 1);
	CHECK(few.total.low_s <= few.total.median_s);
	CHECK(few.total.median_s <= few.total.high_s);
	CHECK_FALSE(few.own_rmse);
}

TEST_CASE("error report: a method's definition is what it draws without noise, and a factor can only help", "[report]")
{
	LevelBench level(boxOnFloor(), 1.0, {});
	ViewBench view(level, level.level.cameras.front(), {32, 18, 256, 1}, {});
	const MeasureSettings settings = onCpu(1);
	const Measurement measured = view.measure(lines(5), settings);
	REQUIRE(measured.own_rmse);
	CHECK(*measured.own_rmse > 0.0);
	CHECK(view.measure(definitionOf(lines(5)), settings).own_rmse == 0.0);
	CHECK(measured.errors.best_rmse <= measured.errors.rmse + 1e-6);
	CHECK(view.errorsOf(view.reference().visibility).rmse == 0.0);
	CHECK(view.errorsOf(view.reference().visibility).eq14 == 0.0);
	CHECK(measured.visibility == view.draw(lines(5), settings));
}

TEST_CASE("error report: volumes of a level are measured as its other methods are", "[report]")
{
	LevelBench level(boxOnFloor(), 1.0, {});
	ViewBench view(level, level.level.cameras.front(), {32, 18, 512, 1}, {});
	const MeasureSettings settings = onCpu(1);
	Candidate volumes = assetOf("aov");
	const Measurement built = view.measure(volumes, settings);
	volumes.volumes = VolumeRecipe::triangles;
	const Measurement triangles = view.measure(volumes, settings);
	CHECK(built.volumes < triangles.volumes);
	CHECK(triangles.volumes == 14);
	CHECK(built.fragments > 0);
	CHECK(built.errors.rmse < view.measure(lines(9), settings).errors.rmse);
}

TEST_CASE("error report: hashes differ where pictures may, and nowhere else", "[report]")
{
	LevelBench level(boxOnFloor(), 1.0, {});
	ViewBench view(level, level.level.cameras.front(), {16, 9, 64, 1}, {});
	ViewBench same(level, level.level.cameras.front(), {16, 9, 64, 1}, {});
	ViewBench larger(level, level.level.cameras.front(), {32, 9, 64, 1}, {});
	LevelBench wider(boxOnFloor(), 2.0, {});
	ViewBench further(wider, level.level.cameras.front(), {16, 9, 64, 1}, {});
	MeasureSettings settings;
	MeasureSettings longer;
	longer.repetitions = 9;
	const std::string hash = view.contentHash(lines(5), settings, "1");
	CHECK(hash.size() == 32);
	CHECK(same.contentHash(lines(5), settings, "1") == hash);
	std::set<std::string> others{hash};
	for (const std::string& other : {view.contentHash(lines(6), settings, "1"), view.contentHash(lines(5), longer, "1"),
									 view.contentHash(lines(5), settings, "2"), larger.contentHash(lines(5), settings, "1"),
									 further.contentHash(lines(5), settings, "1")})
	{
		CHECK(others.insert(other).second);
	}
}

TEST_CASE("error report: bakes and volumes say their bytes, and splitting triangles brings a bake nearer to rays", "[report]")
{
	LevelBench bench(boxOnFloor(), 0.5, {});
	ViewBench view(bench, bench.level.cameras.front(), {64, 36, 64, 1}, {});
	const MeasureSettings how = onCpu(1);
	Candidate bake = assetOf("bake");
	CHECK(bake.name() == "bake");
	const Measurement coarse = view.measure(bake, how);
	CHECK(coarse.bytes == 4 * bench.level.positions.size());
	CHECK(coarse.total.median_s == 0.0);
	bake.bake_error = 0.05;
	CHECK(bake.name() == "bake 0.05");
	const Measurement fine = view.measure(bake, how);
	CHECK(fine.bytes > coarse.bytes);
	CHECK(fine.errors.rmse < coarse.errors.rmse);
	Candidate volumes = assetOf("aov");
	CHECK(view.measure(volumes, how).bytes > 100);
	CHECK(view.flicker(bake, how, 2) >= 0.0);
}

TEST_CASE("error report: pictures of one session are those of contexts of their own, whatever was drawn before", "[report]")
{
	const Level level = boxOnFloor();
	LevelBench bench(boxOnFloor(), 0.5, {});
	ViewBench large(bench, level.cameras.front(), {64, 36, 8, 1}, {});
	ViewBench small(bench, level.cameras.front(), {33, 20, 8, 1}, {});
	MeasureSettings in_session;
	in_session.session = std::make_shared<GlSession>();
	const std::vector<Candidate> grid = candidateGrid(GridSize::quick);
	for (int round = 0; round < 2; ++round) // volumes, in contexts of their own, come between
	{
		for (std::size_t i = 0; i < grid.size(); i += 2)
		{
			if (grid[i].kind != CandidateKind::rays)
			{
				ViewBench& view = i % 4 == 0 ? large : small;
				INFO(grid[i].name());
				CHECK(view.draw(grid[i], in_session) == view.draw(grid[i], {}));
			}
		}
	}
}
