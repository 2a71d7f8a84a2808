// SPDX-License-Identifier: GPL-3.0-or-later
// Emitted C headers, GLSL and HLSL: their numbers, their names, and whether they compile.
#include "emit_samples.h"
#include "other_tools.h"
#include "testing.h"

#include "format/arrays.h"
#include "format/pattern_file.h"

namespace
{

// Every row of four numbers between `open` and `close`.
std::vector<Sample> rowsIn(const std::string& text, const std::string& open)
{
	std::vector<Sample> rows;
	for (std::size_t at = text.find("\t" + open); at != std::string::npos; at = text.find("\t" + open, at + 1))
	{
		const char* cursor = text.c_str() + at + 1 + open.size();
		Sample row{};
		for (float& value : row)
		{
			char* end = nullptr;
			value = std::strtof(cursor, &end);
			cursor = end + std::strspn(end, "f, ");
		}
		rows.push_back(row);
	}
	return rows;
}

} // namespace

TEST_CASE("source files: their numbers are the pattern's 32-bit floats", "[emit]")
{
	for (const Domain domain : kDomains)
	{
		const Pattern pattern = scatteredPattern(domain, 40);
		const std::vector<Sample> samples = samplesOf(pattern);
		const auto bytes = [&](const char* format)
		{
			return patternBytes(format, pattern, nullptr, {}, contextOf("nook"));
		};
		CHECK(rowsIn(bytes(".h"), "{") == samples);
		CHECK(rowsIn(bytes(".glsl"), "vec4(") == samples);
		CHECK(rowsIn(bytes(".hlsl"), "float4(") == samples);
	}
	const std::vector<Sample> disk = samplesOf(scatteredPattern(Domain::disk, 3));
	for (const Sample& s : disk)
	{
		CHECK(s[2] == Approx(std::sqrt(1.0F - s[0] * s[0] - s[1] * s[1])).margin(1e-6));
	}
}

TEST_CASE("source files: names come from the recipe, or from the caller", "[emit]")
{
	const Pattern pattern = scatteredPattern(Domain::disk, 9);
	Recipe recipe = recipeOf(pattern);
	recipe.symmetric = true;
	EmitContext context = contextOf("nook pattern");
	const auto header = [&]
	{
		return patternBytes(".h", pattern, &recipe, {}, context);
	};
	CHECK(header().find("nook_disk9_symmetric_points[NOOK_DISK9_SYMMETRIC_COUNT][4]") != std::string::npos);
	recipe.method = Method::electro;
	CHECK(header().find("nook_disk9_symmetric_electro_points") != std::string::npos);
	context.name = "rim_lines";
	CHECK(header().find("rim_lines_points[NOOK_RIM_LINES_COUNT]") != std::string::npos);
	for (const char* name : {"9lines", "a b", "_a", "a__b", "gl_a", "a-b", "a_", "\xc3\xa9"})
	{
		context.name = name;
		CHECK_THROWS_AS(header(), Error);
	}
}

TEST_CASE("source files: a comment cannot be left by the text in it", "[emit]")
{
	const Pattern pattern = scatteredPattern(Domain::disk, 1);
	const char* const command = GENERATE(as<const char*>{}, "nook\n#error", "nook \\", "nook ?\?/", "nook */ /*", "nook\r#error");
	const std::string header = patternBytes(".h", pattern, nullptr, {}, contextOf(command));
	const TemporaryFolder folder;
	writeFile(folder / "p.h", header);
	CHECK(header.find("\n#error") == std::string::npos);
	if (toolExists("g++"))
	{
		CHECK(passes("g++ -x c -std=c11 -Wall -Wextra -Werror -pedantic -fsyntax-only '" + folder / "p.h" + "'", folder));
	}
}

TEST_CASE("headers: compile alone as C11 and C++17 with g++ and clang++", "[emit]")
{
	const TemporaryFolder folder;
	emitPattern(folder / "p.h", scatteredPattern(Domain::ball, 64), awkwardQuality(), contextOf("nook pattern"));
	emitTile(folder / "t.h", scatteredTile(Domain::disk, 4, 5, true), contextOf("nook tile"));
	writeFile(
		folder / "both.c",
		"#include \"p.h\"\n#include \"t.h\"\n#include \"p.h\"\n"
		"extern float x;\nfloat x = 0.0f;\nint main(void) { return nook_ball64_points[63][3] > 0.0f && "
		"nook_disk5_tile4_points[NOOK_DISK5_TILE4_TOTAL - 1][3] > 0.0f && nook_disk5_tile4_transforms[15][2] > 0.0f ? 0 : 1; }\n");
	for (const std::string compiler : {"g++", "clang++"})
	{
		if (!toolExists(compiler))
		{
			WARN(compiler << " is not installed");
			continue;
		}
		const std::string flags = " -Wall -Wextra -Werror -pedantic -Wshadow -Wconversion ";
		for (const std::string language : {"-x c -std=c11", "-x c++ -std=c++17"})
		{
			CHECK(passes(compiler + flags + "-fsyntax-only " + language + " '" + folder / "p.h" + "'", folder));
			CHECK(passes(compiler + flags + "-fsyntax-only " + language + " '" + folder / "t.h" + "'", folder));
			CHECK(passes(compiler + flags + language + " '" + folder / "both.c" + "' -o '" + folder / "both" + "' && '" +
							 folder / "both" + "'",
						 folder));
		}
	}
}

TEST_CASE("shaders: glslangValidator takes them alone and included", "[emit]")
{
	if (!toolExists("glslangValidator"))
	{
		WARN("glslangValidator is not installed");
		return;
	}
	const TemporaryFolder folder;
	const Pattern pattern = scatteredPattern(Domain::sphere, 64);
	const PatternTile tile = scatteredTile(Domain::disk, 4, 5, true);
	emitPattern(folder / "p.glsl", pattern, awkwardQuality(), contextOf("nook pattern"));
	emitTile(folder / "t.glsl", tile, contextOf("nook tile"));
	const std::string both = readFile(folder / "p.glsl") + readFile(folder / "t.glsl") + readFile(folder / "p.glsl");
	const std::string sum =
		"nook_sphere64_points[63] + nook_disk5_tile4_points[NOOK_DISK5_TILE4_TOTAL - 1] + nook_disk5_tile4_transforms[15]";
	for (const std::string name : {"p.glsl", "t.glsl"})
	{
		for (const std::string version : {"", " --glsl-version 330", " --glsl-version 450", " --glsl-version 300es"})
		{
			CHECK(passes("glslangValidator -S frag" + version + " '" + folder / name + "'", folder));
		}
	}
	for (const std::string version : {"330", "450", "300 es", "310 es"})
	{
		writeFile(folder / "w.frag",
				  "#version " + version + "\n" + both + "out highp vec4 c;\nvoid main()\n{\n\tc = " + sum + ";\n}\n");
		CHECK(passes("glslangValidator '" + folder / "w.frag" + "'", folder));
	}
	const std::string hlsl = patternBytes(".hlsl", pattern, nullptr, awkwardQuality(), contextOf("nook pattern"));
	writeFile(folder / "w.hlsl", hlsl + tileBytes(".hlsl", tile, nullptr, {}, contextOf("nook tile")) + hlsl +
									 "float4 main(float4 p : SV_Position) : SV_Target { return " + sum + "; }\n");
	CHECK(passes("glslangValidator -D -S frag -e main '" + folder / "w.hlsl" + "' -V -o '" + folder / "w.spv" + "'", folder));
}
