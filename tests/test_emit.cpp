// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit_samples.h"
#include "testing.h"

#include "core/image.h"
#include "core/text.h"
#include "format/arrays.h"
#include "format/pattern_file.h"
#include "format/pattern_json.h"
#include "format/tile_json.h"
#include "image/drawing.h"

namespace
{

bool sameBits(const std::vector<double>& a, const std::vector<double>& b)
{
	return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

bool sameBits(const Pattern& a, const Pattern& b)
{
	const bool points = a.points.size() == b.points.size() &&
						std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(glm::dvec3)) == 0;
	return a.domain == b.domain && points && sameBits(a.weights, b.weights) && sameBits(a.powers, b.powers);
}

} // namespace

TEST_CASE("numbers: neighbours are rounded to 32-bit floats too", "[emit]")
{
	// A compiler that converts two at a time may lose both roundings; see core/round.h.
	Random random(13);
	for (int i = 0; i < 100; ++i)
	{
		const glm::dvec3 p{random.uniform(), random.uniform(), random.uniform()};
		const glm::dvec3 rounded{roundToFloat(p.x), roundToFloat(p.y), roundToFloat(p.z)};
		for (glm::length_t axis = 0; axis < 3; ++axis)
		{
			CHECK(std::fabs(rounded[axis] - p[axis]) <= 0x1p-25);
			CHECK((std::bit_cast<uint64_t>(rounded[axis]) & 0x1fffffffU) == 0U); // the lower 29 of 52 bits are zero
		}
	}
}

TEST_CASE("numbers: the shortest decimal of a 32-bit float reads back as the same float", "[emit]")
{
	Random random(3);
	for (int i = 0; i < 200000; ++i)
	{
		const float value = std::bit_cast<float>(random.next());
		if (std::isfinite(value))
		{
			const std::string text = floatText(value);
			CHECK((std::strtof(text.c_str(), nullptr) == value && text.find('.') != std::string::npos));
		}
	}
	CHECK(floatText(1.0F) == "1.0");
	CHECK(floatText(-0.0F) == "-0.0");
	CHECK(floatText(0.1F) == "0.1");
	CHECK(floatText(1e-7F) == "1.0e-07");
	CHECK(floatText(2.5e-8F) == "2.5e-08");
}

TEST_CASE("pattern JSON: what is read back is what was written, bit for bit", "[emit]")
{
	const Domain domain = GENERATE(from_range(kDomains));
	const int count = GENERATE(1, 2, 9, 64, 4096);
	Pattern pattern = scatteredPattern(domain, count);
	if (count == 9)
	{
		Random random(5);
		for (int i = 0; i < count; ++i)
		{
			pattern.powers.push_back(random.uniform() - 0.5);
		}
		pattern.points[0].x = -0.0;
	}
	if (count == 9 && isDirectional(domain))
	{
		pattern.points[0] = {-0.0, 0.6F, 0.8F};
	}
	const Recipe recipe = recipeOf(pattern);
	const std::string text = patternJson(pattern, &recipe, awkwardQuality(), contextOf("nook pattern \"quoted\" \\ é"));
	const PatternFile file = parsePatternJson(text, "p.json");
	CHECK(sameBits(file.pattern, pattern));
	CHECK(file.weights_given);
	CHECK(file.command == "nook pattern \"quoted\" \\ é");
	CHECK(file.version == "0.1.0");
	REQUIRE(file.recipe.has_value());
	CHECK(patternCommand(*file.recipe) == patternCommand(recipe));
	REQUIRE(file.quality.has_value());
	CHECK(file.quality->plane == 0.1 / 3.0);
	CHECK(file.quality->noise == 1e-300);
	CHECK(std::isinf(file.quality->energy));
	CHECK(file.quality->cliff == awkwardQuality().cliff);
	CHECK_FALSE(file.quality->crease.has_value());
	CHECK(patternJson(file.pattern, &*file.recipe, *file.quality, contextOf(file.command)) == text);
}

TEST_CASE("pattern CSV: what is read back is what was written, bit for bit", "[emit]")
{
	const Domain domain = GENERATE(from_range(kDomains));
	const Pattern pattern = scatteredPattern(domain, 33);
	const PatternFile file = parsePatternCsv(patternCsv(pattern, awkwardQuality(), contextOf("nook pattern")), "p.csv");
	CHECK(sameBits(file.pattern, pattern));
	CHECK(file.weights_given);
}

TEST_CASE("tile JSON: what is read back is what was written, bit for bit", "[emit]")
{
	const Domain domain = GENERATE(Domain::disk, Domain::ball, Domain::hemisphere);
	const bool transforms = GENERATE(false, true);
	const PatternTile tile = scatteredTile(domain, 3, 5, transforms);
	TileRecipe recipe{.size = 3, .kind = transforms ? TileKind::random : TileKind::points};
	EmitContext context = contextOf("nook tile --pattern p.json --size 3");
	context.base_command = "nook pattern --domain disk --count 5";
	TileQuality quality;
	quality.window = 0.1;
	const std::string text = tileJson(tile, &recipe, quality, context);
	const TileFile file = parseTileJson(text, "t.json");
	CHECK(file.tile.size == 3);
	REQUIRE(file.tile.variants.size() == 9);
	for (std::size_t i = 0; i < 9; ++i)
	{
		CHECK(sameBits(file.tile.variants[i], tile.variants[i]));
	}
	CHECK(file.base_command == context.base_command);
	REQUIRE(file.recipe.has_value());
	REQUIRE(file.quality.has_value());
	CHECK(tileJson(file.tile, &*file.recipe, *file.quality, context) == text);
}

TEST_CASE("every file: begins with the command, the version, the measures and the licence", "[emit]")
{
	const Pattern pattern = scatteredPattern(Domain::disk, 9);
	const PatternTile tile = scatteredTile(Domain::disk, 2, 4, false);
	const auto check = [](std::string_view format, const std::string& bytes)
	{
		INFO(format);
		for (const char* part : {"nook make it", "0.1.0", "plane", "MIT"})
		{
			const std::size_t at = bytes.find(part);
			CHECK(at < 1200);
		}
	};
	for (const std::string_view format : patternFormats())
	{
		check(format, patternBytes(format, pattern, nullptr, awkwardQuality(), contextOf("nook make it")));
	}
	TileQuality quality;
	quality.variant_plane = 0.25;
	for (const std::string_view format : tileFormats())
	{
		check(format, tileBytes(format, tile, nullptr, quality, contextOf("nook make it")));
	}
}

TEST_CASE("every file: two emissions are equal bytes without a date", "[emit]")
{
	for (const Domain domain : kDomains)
	{
		const Pattern pattern = scatteredPattern(domain, 12);
		for (const std::string_view format : patternFormats())
		{
			CHECK(patternBytes(format, pattern, nullptr, {}, contextOf("nook")) ==
				  patternBytes(format, pattern, nullptr, {}, contextOf("nook")));
		}
	}
	const PatternTile tile = scatteredTile(Domain::disk, 4, 5, true);
	const std::string_view format = GENERATE(from_range(tileFormats()));
	const std::string bytes = tileBytes(format, tile, nullptr, {}, contextOf("nook"));
	CHECK(bytes == tileBytes(format, tile, nullptr, {}, contextOf("nook")));
	CHECK(bytes.find("tIME") == std::string::npos);
	CHECK(bytes.find("OpenImageIO") == std::string::npos);
	const std::size_t date = bytes.find("capDate"); // OpenEXR requires the attribute; it is empty
	CHECK((date == std::string::npos || bytes.substr(date + 15, 4) == std::string(4, '\0')));
}

TEST_CASE("textures: EXR holds the floats, PNG stays within its stated error", "[emit]")
{
	const bool transforms = GENERATE(false, true);
	const PatternTile tile = scatteredTile(Domain::disk, 4, 5, transforms);
	const TileTexture texture = textureOf(tile);
	CHECK(texture.width_px == (transforms ? 4 : 16));
	CHECK(texture.height_px == (transforms ? 4 : 5));
	if (transforms)
	{
		const std::size_t at = 4 * (2 * 4 + 1); // row 2, column 1: variant 9
		CHECK(texture.rgba[at] == static_cast<float>(tile.transforms[9].cos));
		CHECK(texture.rgba[at + 3] == static_cast<float>(tile.transforms[9].handedness));
	}
	else
	{
		const std::size_t at = 4 * (3 * 16 + 9); // sample 3 of variant 9
		CHECK(texture.rgba[at] == static_cast<float>(tile.variants[9].points[3].x));
		CHECK(texture.rgba[at + 3] == static_cast<float>(tile.variants[9].weights[3]));
	}
	const TemporaryFolder folder;
	for (const char* name : {"t.exr", "t.png"})
	{
		emitTile(folder / name, tile, contextOf("nook tile"));
		const Image image = readImage(folder / name);
		const bool exr = std::string(name) == "t.exr";
		REQUIRE(image.values.size() == texture.rgba.size());
		if (exr)
		{
			CHECK(image.halves == std::vector<uint8_t>(4, 0));
		}
		for (std::size_t i = 0; i < image.values.size(); ++i)
		{
			const double range = double{texture.range[i % 4]};
			const double stored = double{image.values[i]} * 65535.0; // 16 bits of a PNG
			const double value = exr ? double{image.values[i]} : (std::round(stored) - 32768.0) / 32767.0 * range;
			CHECK((exr || std::fabs(stored - std::round(stored)) < 0.01));
			CHECK(std::fabs(value - double{texture.rgba[i]}) <= (exr ? 0.0 : range / 65534.0 * 1.0000001));
		}
	}
}

TEST_CASE("pictures: cells fill the disk and carry their weights' colours", "[emit]")
{
	// Two halves: blue on the left (light), orange on the right (heavy).
	Pattern pattern;
	pattern.points = {{-0.5, 0.0, 0.0}, {0.5, 0.0, 0.0}};
	pattern.weights = {0.25, 0.75};
	const Drawing drawing = patternPicture(pattern, nullptr, {});
	const auto colourAt = [&](double x, double y) // of the last polygon around that point
	{
		Colour found = drawing.background;
		for (const Shape& shape : drawing.shapes)
		{
			bool inside = false;
			for (std::size_t i = 0; shape.kind == ShapeKind::polygon && i < shape.points.size(); ++i)
			{
				const glm::dvec2 from = shape.points[i];
				const glm::dvec2 to = shape.points[(i + 1) % shape.points.size()];
				inside ^= (from.y > y) != (to.y > y) && x < from.x + (to.x - from.x) * (y - from.y) / (to.y - from.y);
			}
			found = inside ? shape.fill : found;
		}
		return found;
	};
	CHECK(colourAt(200, 400).blue > colourAt(200, 400).red + 0.2);
	CHECK(colourAt(312, 400).red > colourAt(312, 400).blue + 0.2);
	CHECK(colourAt(5, 5).red > 0.96);
	for (const Domain domain : kDomains)
	{
		for (const int count : {1, 2, 3, 300})
		{
			const std::string svg = patternBytes(".svg", scatteredPattern(domain, count), nullptr, {}, contextOf("nook <&>"));
			CHECK(svg.starts_with("<svg "));
			CHECK(svg.ends_with("</svg>\n"));
			CHECK(svg.find("nan") == std::string::npos);
			CHECK(svg.find("<title>" + std::string(nameOf(domain)) + ", " + std::to_string(count)) != std::string::npos);
		}
	}
	Pattern doubled = scatteredPattern(Domain::disk, 300);
	doubled.points[7] = doubled.points[8];
	CHECK(patternBytes(".svg", doubled, nullptr, {}, contextOf("nook")).ends_with("</svg>\n"));
}

TEST_CASE("KTX2: the header, the format and the texels where the specification has them", "[emit]")
{
	PatternTile tile = scatteredTile(Domain::disk, 2, 3, false);
	tile.frames = 2; // one layer each
	const PatternTile other = scatteredTile(Domain::disk, 2, 3, true);
	tile.variants.insert(tile.variants.end(), other.variants.begin(), other.variants.end());
	const std::string bytes = tileKtx2(tile, {}, contextOf("nook make it"));
	const auto number = [&](std::size_t at)
	{
		uint32_t value = 0;
		std::memcpy(&value, bytes.data() + at, sizeof value);
		return value;
	};
	CHECK(bytes.substr(0, 12) == std::string("\xABKTX 20\xBB\r\n\x1A\n"));
	// vkFormat, typeSize, width, height, depth, layers, faces, levels, supercompression.
	const std::array<uint32_t, 9> header{109, 4, 4, 3, 0, 2, 1, 1, 0};
	for (std::size_t i = 0; i < header.size(); ++i)
	{
		CHECK(number(12 + 4 * i) == header[i]);
	}
	const std::size_t format = number(48);
	CHECK(format == 104);
	CHECK(number(52) == 92);
	CHECK(number(format) == 92);
	CHECK(number(format + 8) == 2U + (88U << 16U));                           // version, block size
	CHECK(number(format + 28 + 48) == (96U | (31U << 16U) | (0xCFU << 24U))); // alpha: a signed float
	CHECK(number(56) == format + 92);
	const std::size_t texels = number(80);
	CHECK(texels % 16 == 0);
	CHECK(texels >= number(56) + number(60));
	CHECK(number(88) == 16 * 4 * 3 * 2);
	CHECK(texels + number(88) == bytes.size());
	for (std::size_t v = 0; v < tile.variants.size(); ++v)
	{
		for (std::size_t i = 0; i < 3; ++i)
		{
			float weight = 0.0f;
			std::memcpy(&weight, bytes.data() + texels + 16 * ((v / 4 * 3 + i) * 4 + v % 4) + 12, sizeof weight);
			CHECK(weight == static_cast<float>(tile.variants[v].weights[i]));
		}
	}
	tile.frames = 1;
	tile.variants.resize(4);
	CHECK(tileKtx2(tile, {}, contextOf("nook")).substr(32, 4) == std::string(4, '\0')); // no array
}

TEST_CASE("formats: the ending decides, and what is unknown is refused before any work", "[emit]")
{
	CHECK(formatOf("a.b/p.json", patternFormats()) == ".json");
	CHECK(formatOf("-", patternFormats()) == ".json");
	CHECK(formatOf("/dev/full", patternFormats()) == ".json");
	CHECK(formatOf("t.exr", tileFormats()) == ".exr");
	CHECK(formatOf("t.ktx2", tileFormats()) == ".ktx2");
	const char* const path = GENERATE(as<const char*>{}, "p.exr", "p.ktx2", "p", "p.JSON", "p.txt", "", ".json", "dir.h/p", "p.h.");
	CHECK_FALSE(refusalBy([&] { formatOf(path, patternFormats()); }, ExitCode::usage).empty());
}

TEST_CASE("writing: a failure leaves no file behind", "[emit]")
{
	const TemporaryFolder folder;
	const Pattern pattern = scatteredPattern(Domain::disk, 9);
	const auto codeOf = [&](const std::string& path)
	{
		try
		{
			emitPattern(path, pattern, {}, contextOf("nook"));
		}
		catch (const Error& error)
		{
			CHECK(std::string(error.what()).find('\n') == std::string::npos);
			CHECK(std::string(error.what()).find(path) == 0);
			return error.code();
		}
		return ExitCode::ok;
	};
	CHECK(codeOf("/dev/full") == ExitCode::file);
	for (const std::string name : {"none/p.json", "none/p.svg"})
	{
		CHECK(codeOf(folder / name) == ExitCode::file);
	}
	std::filesystem::create_directory(folder / "p.json");
	CHECK(codeOf(folder / "p.json") == ExitCode::file);
	for (const std::string name : {"full.json", "full.h", "full.svg"})
	{
		std::filesystem::create_symlink("/dev/full", folder / name);
		CHECK(codeOf(folder / name) == ExitCode::file);
		std::filesystem::remove(folder / name);
	}
	CHECK(folder.names() == std::vector<std::string>{"p.json"});
}
