// SPDX-License-Identifier: GPL-3.0-or-later
// MTL files: combinations of d and Tr, and the options of map_d.
#include "core/error.h"

#include "level_files.h"
#include "temporary_folder.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace nook;

namespace
{

class Folder
{
public:
	Folder()
	{
		// Red and green differ from left to right, blue is in between.
		constexpr std::array<uint8_t, 6> kTexels{255, 0, 128, 0, 255, 128};
		const std::string png = pngBytes(2, 1, std::span<const uint8_t>(kTexels), {});
		writeFile(m_folder / "two.png", png);
		writeFile(m_folder / "my leaf.png", png);
		writeFile(m_folder / "rows.png", rowsPng());
	}

	// The cube with one material defined by these lines.
	LoadedLevel load(const std::string& lines, const LoadSettings& settings = {}) const
	{
		writeFile(m_folder / "a.mtl", "newmtl a\n" + lines + "\n");
		return loadText(m_folder / "a.obj", "mtllib a.mtl\nusemtl a\n" + cubeObj(), settings);
	}

	// The error message for such a level, without the file's name.
	std::string refusalOf(const std::string& lines, ExitCode code = ExitCode::invalid_input) const
	{
		try
		{
			load(lines);
		}
		catch (const Error& error)
		{
			CHECK(error.code() == code);
			return std::string(error.what()).substr((m_folder / "a.mtl: ").size());
		}
		return "nothing";
	}

private:
	TemporaryFolder m_folder;
};

const Material& materialOf(const Level& level)
{
	return level.material_list.at(level.materials.at(0));
}

} // namespace

TEST_CASE("scene: d and Tr of MTL in any order, and Tr as opacity", "[scene]")
{
	const Folder folder;
	constexpr const char* kInverted = "inverted-transparency 1 repaired";
	struct Case
	{
		const char* lines;
		double opacity;
		const char* findings;
		TrMeaning tr = TrMeaning::automatic;
	};
	for (const Case& one : {
			 Case{"Tr 1.000000", 1.0, kInverted},
			 Case{"Tr 0.3", 0.7, ""},
			 Case{"tr 0.999", 0.001, ""},
			 Case{"Tr 0", 1.0, ""},
			 Case{"d 1\nTr 1", 1.0, kInverted},
			 Case{"Tr 1.0\nd 1.0", 1.0, kInverted},
			 Case{"d 1\nTr 0", 1.0, ""},
			 Case{"Tr 0\nd 1", 1.0, ""},
			 Case{"d 0.4\nTr 0.6", 0.4, ""},
			 Case{"Tr 0.667\nd 0.3333", 0.3333, ""},
			 Case{"d 0.4\nTr 0.4", 0.4, kInverted},
			 Case{"Tr 1\nd 0", 0.0, ""},
			 Case{"d 0", 0.0, ""},
			 Case{"Tr 1", 0.0, "", TrMeaning::transparency},
			 Case{"Tr 1", 1.0, "", TrMeaning::opacity},
			 Case{"Tr 0.3", 0.3, "", TrMeaning::opacity},
			 Case{"Tr 0", 0.0, "", TrMeaning::opacity},
			 Case{"d 0.4\nTr 0.4", 0.4, "", TrMeaning::opacity},
			 Case{"d 0.4", 0.4, "", TrMeaning::opacity},
			 Case{"Kd 1 1 1", 1.0, "", TrMeaning::opacity},
		 })
	{
		INFO(one.lines);
		LoadSettings settings;
		settings.tr = one.tr;
		const LoadedLevel loaded = folder.load(one.lines, settings);
		CHECK(materialOf(loaded.level).alpha == Approx(one.opacity).margin(1e-6));
		CHECK(materialOf(loaded.level).alpha_mode == (one.opacity < 1.0 ? AlphaMode::blend : AlphaMode::opaque));
		CHECK(findingsOf(loaded.diagnosis) == one.findings);
	}
	const LoadedLevel two = folder.load("Tr 1\nnewmtl b\nTr 1\nmap_d rows.png\nnewmtl c\nTr 0.5");
	REQUIRE(findingsOf(two.diagnosis) == "inverted-transparency 2 repaired");
	CHECK(two.diagnosis.findings[0].first == "material 'a'");
	CHECK(folder.refusalOf("Tr 2") == "line 2: found '2', expected 0 to 1 behind Tr");
	for (const char* const lines : {"Tr -1", "Tr nan", "Tr inf", "d 1.5", "d -0.1", "d nan", "Tr", "d 1\nTr 2"})
	{
		INFO(lines);
		CHECK(folder.refusalOf(lines).starts_with("line "));
	}
}

TEST_CASE("scene: the channel, base and gain that map_d asks for", "[scene]")
{
	const Folder folder;
	const auto alphas = [&](const std::string& options)
	{
		const LoadedLevel loaded = folder.load("map_d " + options + " two.png");
		CHECK(findingsOf(loaded.diagnosis).empty());
		const Mask& mask = loaded.level.masks.at(0);
		CHECK(mask.name == "two.png");
		return std::vector<int>(mask.alpha.begin(), mask.alpha.end());
	};
	using Alphas = std::vector<int>;
	CHECK(alphas("") == Alphas{255, 0});
	CHECK(alphas("-imfchan r") == Alphas{255, 0});
	CHECK(alphas("-imfchan g") == Alphas{0, 255});
	CHECK(alphas("-imfchan B") == Alphas{128, 128});
	CHECK(alphas("-imfchan m") == Alphas{255, 255}); // no alpha channel, so it is opaque
	CHECK(alphas("-imfchan l") == Alphas{63, 192});  // 0.2126 × 255 + 0.0722 × 128, 0.7152 × 255 + 0.0722 × 128
	CHECK(alphas("-mm 0.2 0.5") == Alphas{179, 51});
	CHECK(alphas("-mm 1 -1") == Alphas{0, 255});
	CHECK(alphas("-imfchan g -mm 0.5 1") == Alphas{128, 255});         // clamped to opaque
	const Level rows = folder.load("map_d -imfchan r rows.png").level; // its alpha channel is not selected
	CHECK(rows.masks.at(0).alpha.at(0) == rows.masks.at(0).alpha.back());
	CHECK(folder.load("map_d -imfchan m rows.png").level.masks.at(0).alpha.at(0) == 0);
	const Level both = folder
						   .load("map_d two.png\nnewmtl b\nmap_d -mm 1 -1 two.png\nnewmtl c\nmap_d -imfchan g two.png\n"
								 "newmtl d\nmap_d -s 2 2 two.png")
						   .level;
	REQUIRE(both.masks.size() == 3);
	CHECK(both.masks[0].alpha == std::vector<uint8_t>{255, 0});
	CHECK(both.masks[1].alpha == std::vector<uint8_t>{0, 255});
	CHECK(both.masks[2].alpha == std::vector<uint8_t>{0, 255});
}

TEST_CASE("scene: scale, offset and clamping of map_d, in any order", "[scene]")
{
	const Folder folder;
	const auto check = [&](const std::string& options, glm::dvec2 scale, glm::dvec2 offset, Wrap wrap)
	{
		INFO(options);
		const LoadedLevel loaded = folder.load("map_d " + options);
		CHECK(findingsOf(loaded.diagnosis).empty());
		const Level& level = loaded.level;
		CHECK(level.masks.at(0).wrap_u == wrap);
		CHECK(level.masks.at(0).wrap_v == wrap);
		for (std::size_t i = 0; i < level.positions.size(); ++i)
		{
			// The cube's coordinates are (x, y), v upward; a level's v grows downward.
			const glm::dvec3 p = level.positions[i];
			CHECK(static_cast<double>(level.uvs[i].x) == Approx(scale.x * p.x + offset.x).margin(1e-6));
			CHECK(1.0 - static_cast<double>(level.uvs[i].y) == Approx(scale.y * p.y + offset.y).margin(1e-6));
		}
	};
	check("two.png", {1.0, 1.0}, {0.0, 0.0}, Wrap::repeat);
	check("-s 0.1 1 1 two.png", {0.1, 1.0}, {0.0, 0.0}, Wrap::repeat);
	check("-s 2 two.png", {2.0, 1.0}, {0.0, 0.0}, Wrap::repeat);
	check("-o .25 -.5 two.png", {1.0, 1.0}, {0.25, -0.5}, Wrap::repeat);
	check("-s 2 -3 1 -o 0.25 0.5 0 -clamp on my leaf.png", {2.0, -3.0}, {0.25, 0.5}, Wrap::clamp);
	check("-O 0.25 0.5 -bm 1 -imfchan g -blendu on -t 0 0 0 -Clamp ON -mm 0 1 -s 2 3 -cc off my leaf.png  ", {2.0, 3.0},
		  {0.25, 0.5}, Wrap::clamp);
	check("-clamp off two.png", {1.0, 1.0}, {0.0, 0.0}, Wrap::repeat);
	CHECK(findingsOf(folder.load("map_Kd -s 2 2 2 -o 1 1 two.png").diagnosis).empty());
	CHECK(findingsOf(folder.load("map_Kd -s 0 0 0 -foo two.png\nmap_Kd").diagnosis).empty()); // its contents are not read
	CHECK(findingsOf(folder.load("map_Kd -clamp on absent one.png").diagnosis) == "missing-file 1 ignored");
}

TEST_CASE("scene: options of map_d that are not applied are found, broken ones refused", "[scene]")
{
	const Folder folder;
	for (const char* const options : {"-t 0.1 0 0", "-blendu off", "-blendv off", "-cc on", "-texres 256", "-type sphere", "-bm 2"})
	{
		INFO(options);
		const LoadedLevel loaded = folder.load("map_d -s 2 2 " + std::string(options) + " two.png");
		REQUIRE(findingsOf(loaded.diagnosis) == "not-applied 1 ignored");
		const std::string option = std::string(options).substr(0, std::string_view(options).find(' '));
		CHECK(loaded.diagnosis.findings[0].first == "material 'a', map_d " + option);
	}
	CHECK(folder.refusalOf("map_d -s 0 0 0 two.png") == "line 2: found a scale of 0, expected another number behind -s");
	CHECK(folder.refusalOf("map_d -s nan two.png") == "line 2: found 'nan', expected a number behind -s");
	CHECK(folder.refusalOf("map_d") == "line 2: found nothing, expected the name of a file behind map_d");
	for (const char* const options : {"-s 1 1 1", "-s two.png", "-s", "-s 1e99 two.png", "-o inf two.png", "-clamp maybe two.png",
									  "-clamp", "-imfchan x two.png", "-imfchan", "-mm 1 two.png", "-mm 1 a two.png",
									  "-foo two.png", "-s 1 0 two.png", "-texres two.png"})
	{
		INFO(options);
		CHECK(folder.refusalOf("map_d " + std::string(options)).starts_with("line 2: found "));
	}
	CHECK(folder.refusalOf("map_d -imfchan z two.png", ExitCode::unsupported).starts_with("line 2: found the channel z"));
}

TEST_CASE("scene: MTL names that are longer than Assimp takes", "[scene]")
{
	const TemporaryFolder folder;
	const std::string name = "a b" + std::string(5000, 'c');
	writeFile(folder / "a.mtl", "newmtl glass\nd 0.5\nnewmtl " + name + "\nd 0.25\n");
	const Level level = loadText(folder / "a.obj", "mtllib a.mtl\nusemtl " + name + "\n" + cubeObj()).level;
	CHECK(materialOf(level).alpha == 0.25);
	CHECK(materialOf(level).name == name.substr(0, 1000));
	writeFile(folder / "a.mtl", "newmtl " + name + "d\nd 0.5\nnewmtl " + name + "\nd 0.25\n");
	CHECK_THROWS_AS(loadLevel(folder / "a.obj", {}, {}), Error);
}
