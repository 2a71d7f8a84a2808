// SPDX-License-Identifier: GPL-3.0-or-later
// Pattern and tile files from other programs, broken or hostile.
#include "emit_samples.h"
#include "testing.h"

#include "format/pattern_json.h"
#include "format/tile_json.h"

namespace
{

struct Wrong
{
	std::string text;
	const char* message; // a part of it
};

template <class Parse> void checkRefusals(const std::vector<Wrong>& table, const std::string& path, const Parse& parse)
{
	for (const Wrong& wrong : table)
	{
		INFO(wrong.text);
		const std::string message = refusalBy([&] { parse(wrong.text, path); });
		INFO(message);
		CHECK(message.find(path + ": ") == 0);
		CHECK(message.find(wrong.message) != std::string::npos);
		CHECK(message.find("expected") != std::string::npos);
	}
}

std::string disk(const std::string& fields)
{
	return R"({"domain": "disk", )" + fields + "}";
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
	const std::size_t at = text.find(from);
	REQUIRE(at != std::string::npos);
	return text.replace(at, from.size(), to);
}

} // namespace

TEST_CASE("JSON input: every truncation of a pattern and of a tile is an error of one line", "[emit]")
{
	const Pattern pattern = scatteredPattern(Domain::ball, 3);
	const Recipe recipe = recipeOf(pattern);
	const std::string text = patternJson(pattern, &recipe, awkwardQuality(), contextOf("nook é"));
	for (std::size_t size = 0; size + 2 < text.size(); ++size) // complete except for the last newline
	{
		if (refusalBy([&] { parsePatternJson(text.substr(0, size), "p.json"); }).find("p.json: line ") != 0)
		{
			FAIL("truncated to " << size);
		}
	}
	const std::string tile = tileJson(scatteredTile(Domain::disk, 2, 2, true), nullptr, {}, contextOf("nook tile"));
	for (std::size_t size = 0; size + 2 < tile.size(); ++size)
	{
		if (refusalBy([&] { parseTileJson(tile.substr(0, size), "t.json"); }).find("t.json: line ") != 0)
		{
			FAIL("truncated to " << size);
		}
	}
}

TEST_CASE("JSON input: one byte changed is a pattern or an error, never anything else", "[emit]")
{
	const Pattern pattern = scatteredPattern(Domain::disk, 3);
	const Recipe recipe = recipeOf(pattern);
	const std::string text = patternJson(pattern, &recipe, awkwardQuality(), contextOf("nook"));
	Random random(11);
	for (int i = 0; i < 4000; ++i)
	{
		std::string changed = text;
		changed[random.below(static_cast<uint32_t>(text.size()))] = static_cast<char>(random.below(256));
		refusalBy([&] { parsePatternJson(changed, "p.json"); });
	}
}

TEST_CASE("JSON input: a pattern of someone else needs domain and points only", "[emit]")
{
	const PatternFile file = parsePatternJson(disk(R"("points": [[0, 0], [0.1, -0.5], [1, 0], [0.6, 0.8]])"), "p.json");
	CHECK(file.pattern.count() == 4);
	CHECK_FALSE(file.weights_given);
	CHECK(file.pattern.weights.empty());
	CHECK_FALSE(file.recipe.has_value());
	CHECK(file.pattern.points[1].x == double{0.1F});
	// 0.6 and 0.8 as floats lie just outside the circle; the point is moved in by a rounding.
	const glm::dvec3 rim = file.pattern.points[3];
	CHECK(rim.x * rim.x + rim.y * rim.y <= 1.0);
	CHECK(rim.x == Approx(0.6).margin(1e-6));
	const PatternFile weighted =
		parsePatternJson(disk(R"("comment": "by hand", "points": [[0, 0], [0.5, 0]], "weights": [0.25, 0.75])"), "p.json");
	CHECK(weighted.weights_given);
	CHECK(weighted.pattern.weights[1] == 0.75);
}

TEST_CASE("JSON input: what is wrong is named", "[emit]")
{
	const Pattern pattern = scatteredPattern(Domain::disk, 2);
	const Recipe recipe = recipeOf(pattern);
	const std::string ours = patternJson(pattern, &recipe, {}, contextOf("nook"));
	const std::vector<Wrong> table{
		{"", "line 1, column 1: found the end of the file, expected JSON"},
		{"hello", "found 'h', expected JSON"},
		{"\xff\xfe{", "found byte 255"},
		{"[1, 2]", "p.json: found an array of 2, expected an object"},
		{"null", "found null, expected an object"},
		{"{} {}", "column 4"},
		{"{}", "domain: found nothing"},
		{R"({"domain": "disk"})", "points: found nothing"},
		{R"({"domain": "cube", "points": [[0, 0]]})", "domain: found \"cube\", expected one of disk, ball, sphere, hemisphere"},
		{R"({"domain": 3, "points": [[0, 0]]})", "domain: found 3, expected a string"},
		{R"({"schema": "nook.tile/1"})", "schema: found \"nook.tile/1\", expected \"nook.pattern/1\""},
		{R"({"schema": "nook.pattern/2"})", "schema: found \"nook.pattern/2\""},
		{R"({"domain": "disk", "domain": "ball", "points": []})", "found the field \"domain\" twice"},
		{R"({"asset": {"version": "2.0"}, "meshes": []})", "the unknown field \"asset\""},
		{disk(R"("points": [[0, 0]], "weight": [1])"), "the unknown field \"weight\""},
		{disk(R"("points": {})"), "points: found an object, expected an array"},
		{disk(R"("points": [])"), "points: found an array of 0, expected an array of 1 to 4096"},
		{disk(R"("points": [[0, 0, 0]])"), "points[0]: found an array of 3, expected an array of 2 numbers"},
		{disk(R"("points": [[0, 0], [0, "x"]])"), "points[1][1]: found \"x\", expected a number"},
		{disk(R"("points": [[0, null]])"), "points[0][1]: found null"},
		{disk(R"("points": [[0, NaN]])"), "found 'N', expected JSON"},
		{disk(R"("points": [[0, 1e999]])"), "out of range"},
		{disk(R"("points": [[0, 0], [0.8, 0.8]])"), "points[1]: found a point at distance 1.131371 from the centre"},
		{disk(R"("points": [[0, 1.00001]])"), "points[0]"},
		{disk(R"("points": [[1e308, 1e308]])"), "points[0]"},
		{disk(R"("points": [[0, 0]], "weights": [0.9])"), "weights: found the sum 0.9"},
		{disk(R"("points": [[0, 0]], "weights": [1, 1])"), "weights: found an array of 2, expected an array of 1"},
		{disk(R"("points": [[0, 0], [0, 0.5]], "weights": [1.5, -0.5])"), "weights[1]: found the weight -0.5"},
		{disk(R"("points": [[0, 0]], "count": 2)"), "points: found an array of 1, expected an array of 2"},
		{disk(R"("points": [[0, 0]], "count": 1.0)"), "count: found 1.0, expected a whole number"},
		{disk(R"("points": [[0, 0]], "count": 18446744073709551615)"), "count: found 18446744073709551615"},
		{disk(R"("points": [[0, 0]], "count": -1)"), "count: found -1"},
		{disk(R"("points": [[0, 0]], "powers": [0, 0])"), "powers: found an array of 2"},
		{disk(R"("points": [[0, 0]], "quality": {"plan": 1})"), "quality.plan: found an unknown measure"},
		{disk(R"("points": [[0, 0]], "quality": {"plane": 1})"), "quality.noise: found nothing"},
		{disk(R"("points": [[0, 0]], "command": 7)"), "command: found 7, expected a string"},
		{R"({"domain": "ball", "points": [[1, 1, 1]]})", "expected a point in the unit ball"},
		{R"({"domain": "sphere", "points": [[0, 0, 0.9]]})", "points[0]: found a direction of length 0.9, expected length 1"},
		{R"({"domain": "hemisphere", "points": [[0, 0.6, -0.8]]})", "points[0]: found z = -0.8"},
		{replaced(ours, "\"count\": 2,\n", ""), "recipe.count: found nothing"},
		{replaced(ours, "\t\"count\": 2,\n\t\"points\"", "\t\"points\""), "count: found nothing"},
		{replaced(ours, "\"weights\": [", "\"powers\": ["), "weights: found nothing"},
		{replaced(ours, "\"seed\": 4000000000", "\"seed\": 5000000000"), "recipe.seed: found 5000000000"},
		{replaced(ours, "\"method\": \"refine\"", "\"method\": \"magic\""),
		 "recipe.method: found \"magic\", expected one of refine"},
		{replaced(ours, "\"domain\": \"disk\"", "\"domain\": \"ball\""), "recipe.domain: found \"ball\", expected \"disk\""},
		{replaced(ours, "\"centre\": false", "\"centre\": 0"), "recipe.centre: found 0, expected true or false"},
		{replaced(ours, "\"exponent\": 0.0", "\"exponent\": 2.0"), "recipe: found options that do not go together"},
	};
	checkRefusals(table, "p.json", [](const std::string& text, const std::string& path) { parsePatternJson(text, path); });
	std::string many = R"({"domain": "disk", "points": [)";
	for (int i = 0; i < 4097; ++i)
	{
		many += i == 0 ? "[0, 0]" : ", [0, 0]";
	}
	CHECK(refusalBy([&] { parsePatternJson(many + "]}", "p.json"); }).find("an array of 4097") != std::string::npos);
	const std::string deep(200000, '[');
	CHECK(refusalBy([&] { parsePatternJson(deep, "p.json"); }).find("column 200001") != std::string::npos);
	const std::string nested = deep + std::string(200000, ']');
	CHECK_FALSE(refusalBy([&] { parsePatternJson(nested, "p.json"); }).empty());
}

TEST_CASE("tile input: what is wrong is named", "[emit]")
{
	TileRecipe recipe{.size = 2, .kind = TileKind::random};
	TileQuality quality;
	quality.window = 0.0;
	const std::string ours = tileJson(scatteredTile(Domain::disk, 2, 2, true), &recipe, quality, contextOf("nook tile"));
	REQUIRE(refusalBy([&] { parseTileJson(ours, "t.json"); }).empty());
	const std::vector<Wrong> table{
		{"{}", "schema: found nothing"},
		{R"({"schema": "nook.pattern/1"})", "expected \"nook.tile/1\""},
		{replaced(ours, "\t\"size\": 2,\n\t\"transforms\"", "\t\"size\": 129,\n\t\"transforms\""), "size: found 129"},
		{replaced(ours, "\t\"size\": 2,\n\t\"transforms\"", "\t\"size\": 3,\n\t\"transforms\""), "variants: found an array of 4"},
		{replaced(ours, "\t\"count\": 2", "\t\"count\": 3"), "variants[0].points: found an array of 2, expected an array of 3"},
		{replaced(ours, "\t\t[1.0, 0.0, 1.0, 1.0],", ""), "transforms: found an array of 3"},
		{replaced(ours, "[1.0, 0.0, 1.0, 1.0]", "[1.0, 1.0, 1.0, 1.0]"), "transforms[0]: found an array of 4, expected the cosine"},
		{replaced(ours, "[1.0, 0.0, 1.0, 1.0]", "[1.0, 0.0, 1.0]"), "transforms[0]: found an array of 3"},
		{replaced(ours, "\"window\": 0.0", "\"window\": true"), "quality.window: found true"},
		{replaced(ours, "\"kind\": \"random\"", "\"kind\": \"none\""), "recipe.kind: found \"none\""},
	};
	checkRefusals(table, "t.json", [](const std::string& text, const std::string& path) { parseTileJson(text, path); });
}

TEST_CASE("tile input: filters, frames and moves come back, and what is wrong with them is named", "[emit]")
{
	TileRecipe recipe{.size = 2, .filters = {tileFilterNamed("binomial:3"), tileFilterNamed("box:2")}};
	recipe.filters[1].share = 2.5;
	recipe.frames = 3;
	recipe.moves = true;
	recipe.robust = true;
	PatternTile tile = scatteredTile(Domain::disk, 2, 2, false);
	tile.frames = 3;
	tile.moves = tileMoves(2, 3);
	const std::string ours = tileJson(tile, &recipe, {}, contextOf("nook tile"));
	const TileFile read = parseTileJson(ours, "t.json");
	CHECK(tileJson(read.tile, &*read.recipe, *read.quality, contextOf("nook tile")) == ours);
	CHECK((read.recipe->filters[1].share == 2.5 && read.recipe->filters[0].taps == recipe.filters[0].taps));
	CHECK((read.tile.moves == tile.moves && read.recipe->robust));
	recipe.moves = false;
	tile.moves.clear();
	for (int i = 4; i < 12; ++i)
	{
		tile.variants.push_back(scatteredPattern(Domain::disk, 2, static_cast<uint64_t>(i) + 1));
	}
	const std::string sequence = tileJson(tile, &recipe, {}, contextOf("nook tile"));
	CHECK(parseTileJson(sequence, "t.json").tile.variants.size() == 12);
	const std::vector<Wrong> table{
		{replaced(ours, "\n\t\"frames\": 3", "\n\t\"frames\": 4"), "moves: found an array of 3, expected an array of 4"},
		{replaced(ours, "\n\t\"frames\": 3", "\n\t\"frames\": 65"), "frames: found 65"},
		{replaced(ours, "\n\t\"frames\": 3", "\n\t\"frames\": 0"), "frames: found 0"},
		{replaced(ours, "\n\t\"moves\": [[0, 0]", "\n\t\"moves\": [[0, 2]"), "moves[0][1]: found 2"},
		{replaced(ours, "\n\t\"moves\": [[0, 0]", "\n\t\"moves\": [[0]"), "moves[0]: found an array of 1"},
		{replaced(sequence, "\t\"frames\": 3,\n\t\"variants\"", "\t\"variants\""),
		 "variants: found an array of 12, expected an array of 4"},
		{replaced(ours, "\"share\":2.5", "\"share\":0"), "share: found 0"},
		{replaced(ours, "\"width\":2", "\"width\":3"), "taps: found an array of 4, expected rows of 3"},
		{replaced(ours, "[0.25,0.25,0.25,0.25]", "[0.25,0.25,-0.25,-0.25]"), "taps: found taps with the sum 0"},
		{replaced(ours, "\"ema\": 0.1", "\"ema\": 0.0"), "ema: expected"},
	};
	checkRefusals(table, "t.json", [](const std::string& text, const std::string& path) { parseTileJson(text, path); });
}

TEST_CASE("filter input: taps of a file, and what is wrong is named", "[emit]")
{
	const FilterFile cross = parseFilter(R"({"taps": [[0, 1, 0], [1, 4, 1], [0, 1, 0]]})", "k.json");
	CHECK(cross.sum == 8.0);
	CHECK((cross.filter.name == "file:k.json" && cross.filter.width == 3 && cross.filter.taps[4] == 0.5));
	CHECK(parseFilter(R"({"taps": [[1.2, -0.2]]})", "k.json").filter.taps[1] == Approx(-0.2));
	const std::vector<Wrong> table{
		{"{}", "taps: found nothing"},
		{R"({"taps": [[1]], "more": 1})", "more"},
		{R"({"taps": []})", "taps: found"},
		{R"({"taps": [[1, 2], [3]]})", "taps[1]: found an array of 1, expected an array of 2 numbers"},
		{R"({"taps": [[1, "2"]]})", "taps[0][1]: found"},
		{R"({"taps": [[1, null]]})", "taps[0][1]: found"},
		{R"({"taps": [[1, 1e999]]})", "k.json"},
		{R"({"taps": [[1, -2]]})", "taps: found taps with the sum -1"},
		{R"({"taps": [[0, 0]]})", "taps: found taps with the sum 0"},
		{R"({"taps": 3})", "taps: found 3"},
	};
	checkRefusals(table, "k.json", [](const std::string& text, const std::string& path) { parseFilter(text, path); });
}

TEST_CASE("CSV input: columns, headers and comments of others are understood", "[emit]")
{
	const auto read = [](const std::string& text, std::optional<Domain> domain = std::nullopt)
	{
		return parsePatternCsv(text, "p.csv", domain);
	};
	CHECK(read("0,0\n0.5,0.25\n").pattern.domain == Domain::disk);
	CHECK(read("0,0\n0.5,0.25").pattern.count() == 2);
	CHECK(read("0,0,0.5\n0.5,0.25,-0.5\n").pattern.domain == Domain::ball);
	CHECK_FALSE(read("0,0,0.5\n").weights_given);
	CHECK(read("0,0,0.5,1\n").weights_given);
	CHECK(read("0,0,0.25\n0,0.5,0.75\n", Domain::disk).pattern.weights[1] == 0.75);
	CHECK(read("# domain: sphere\n0,0,1\n").pattern.domain == Domain::sphere);
	CHECK(read("0,0,1\n", Domain::hemisphere).pattern.domain == Domain::hemisphere);
	const PatternFile mixed = read("\xef\xbb\xbf# made by hand\r\nweight, y , x\r\n\r\n 1 ,+0.5,\t-2.5e-1\r\n");
	CHECK(mixed.pattern.domain == Domain::disk);
	CHECK(mixed.pattern.points[0] == glm::dvec3(-0.25, 0.5, 0.0));
	CHECK(mixed.pattern.weights[0] == 1.0);
	CHECK(read("x,y,z\n0,0,0.5\n").pattern.domain == Domain::ball);
}

TEST_CASE("CSV input: what is wrong is named by its row", "[emit]")
{
	const std::vector<Wrong> table{
		{"", "found no samples"},
		{"# domain: disk\nx,y\n", "found no samples"},
		{"0,0\n0.5,nan\n", "row 2: found \"nan\", expected a finite number"},
		{"nan,nan\n", "row 1: found \"nan\""},
		{"0,0\n\n# note\n1e999,0\n", "row 4: found \"1e999\""},
		{"0,0\n0.5,\n", "row 2: found \"\""},
		{"0,0\n0.5,0.5x\n", "row 2: found \"0.5x\""},
		{"0,0\n0.5\n", "row 2: found 1 columns, expected 2"},
		{"0,0\n0.8,0.8\n", "row 2: found a point at distance 1.131371"},
		{"0\n", "row 1: found 1 columns and no header"},
		{"0,0,0,0,0\n", "row 1: found 5 columns and no header"},
		{"x,y,w\n0,0,1\n", "row 1: found the column \"w\""},
		{"x,y,x\n0,0,1\n", "row 1: found the column \"x\""},
		{"x,weight\n0,1\n", "columns: found x,weight, expected x,y"},
		{"x,y,weight\n0,0,0.5\n", "weight column: found the sum 0.5"},
		{"x,y,weight\n0,0,1.5\n0,0,-0.5\n", "row 3: found the weight -0.5"},
		{"x,y,half_length,weight\n0,0,0.5,1\n", "row 2: found half_length 0.5, expected 1"},
		{"# domain: cube\n0,0\n", "row 1: found the domain \"cube\""},
		{"# domain: ball\n0,0\n", "columns: found x,y, expected x,y,z"},
		{"# domain: sphere\n0,0,0.5\n", "row 2: found a direction of length 0.5"},
		{std::string("0,0\n0\0,1\n", 9), "row 2: found \"0\\u0000\""},
		{R"({"domain": "disk"})", "found the column"},
	};
	checkRefusals(table, "p.csv", [](const std::string& text, const std::string& path) { parsePatternCsv(text, path); });
	CHECK(refusalBy([] { parsePatternCsv("# domain: ball\n0,0,0\n", "p.csv", Domain::disk); })
			  .find("expected \"disk\" as asked for") != std::string::npos);
	std::string many;
	for (int i = 0; i < 4097; ++i)
	{
		many += "0,0\n";
	}
	CHECK(refusalBy([&] { parsePatternCsv(many, "p.csv"); }).find("row 4097: found more samples") != std::string::npos);
}
