// SPDX-License-Identifier: GPL-3.0-or-later
// Picture files that ask for much: a picture, or one error; never a wait without end.
#include "core/error.h"
#include "core/image.h"

#include "hostile_pictures.h"
#include "level_files.h"
#include "temporary_folder.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace nook;

TEST_CASE("image: the hostile pictures are whole ones where they are small", "[image]")
{
	const Image png = decodeImage(blackPng(9, 700), "a.png");
	CHECK(png.width_px == 9);
	CHECK(png.values == std::vector<float>(9 * 700, 0.0F));
	const Image exr = decodeImage(textsExr(1000), "a.exr");
	CHECK(exr.values == std::vector<float>{1.0F});
	CHECK(exr.notes.size() >= 1000);
}

TEST_CASE("image: more attributes than anybody needs are refused", "[image]")
{
	CHECK_THROWS_WITH(decodeImage(textsExr(10001), "a.exr"), "a.exr: found more than 10000 attributes, expected fewer");
}

TEST_CASE("image: many texels in few bytes are refused before they are decoded", "[image]")
{
	const std::string png = blackPng(20000, 20000); // 317 KB; decoded it would be a list that was longer than taken
	const std::string found = ": found 400000000 texels, expected at most 268435456";
	CHECK_THROWS_WITH(decodeImage(png, "a.png"), "a.png" + found);
	const TemporaryFolder folder;
	writeFile(folder / "net.png", png);
	writeFile(folder / "a.mtl", "newmtl net\nmap_d net.png\n");
	CHECK_THROWS_WITH(loadText(folder / "a.obj", "mtllib a.mtl\nusemtl net\n" + cubeObj()),
					  (folder / "net.png") + found + " (max-texels)");
	CHECK_THROWS_WITH(decodeAlphas({{"a.png", "", blackPng(9, 7)}, {"b.png", "", png}}, "level"),
					  "b.png" + found + " (max-texels)");
}

TEST_CASE("image: an OpenEXR of ours reads as OpenImageIO reads it", "[image]")
{
	Image image;
	image.width_px = 3;
	image.height_px = 37; // more than two pieces of 16 lines
	image.channels = {"N.X", "N.Y", "N.Z", "Z", "depth_error", "visibility", "bent.X", "R", "A", "G"};
	for (std::size_t i = 0; i < image.channels.size() * 3 * 37; ++i)
	{
		image.values.push_back(static_cast<float>(i) * 0.37F - 100.0F);
	}
	image.notes = {{"Software", "nook 0.1.0"}, {"nook:level", "a level"}};
	image.matrices = {{"worldToCamera", {1.0, 2.0, 3.5}, false}, {"projection64", {0.1, 0.2}, true}};
	const std::string ours = exrBytes(image);
	std::string others = ours; // the same but for a name, so that another worker reads it
	others[others.find("nook 0")] = 'l';
	const Image a = decodeImage(ours, "a.exr");
	const Image b = decodeImage(others, "a.exr");
	CHECK(a.channels == b.channels);
	CHECK(a.values == b.values);
	CHECK(a.halves == b.halves);
	CHECK(a.cropped == b.cropped);
	// OpenImageIO says of the colours what is in no file: that is how one sees which worker has read it.
	const auto remarks = [](const Image& from)
	{
		return std::count_if(from.notes.begin(), from.notes.end(), [](const Note& n) { return n.key.starts_with("oiio:"); });
	};
	CHECK(remarks(a) == 0);
	CHECK(remarks(b) > 0);
	const auto words = [](const Image& from)
	{
		std::string all;
		for (const Note& note : from.notes)
		{
			all += note.key.starts_with("oiio:") || note.key == "Software" ? "" : note.key + "=" + note.value + "\n";
		}
		return all;
	};
	CHECK(words(a) == words(b));
	REQUIRE(a.matrices.size() == 2);
	REQUIRE(b.matrices.size() == 2);
	for (std::size_t i = 0; i < 2; ++i)
	{
		CHECK(a.matrices[i].key == b.matrices[i].key);
		CHECK(a.matrices[i].values == b.matrices[i].values);
		CHECK(a.matrices[i].wide == b.matrices[i].wide);
	}
	for (std::size_t y = 0; y < image.channels.size(); ++y)
	{
		CHECK(a.at(100, a.channel(image.channels[y])) == image.at(100, static_cast<int>(y)));
	}
}

TEST_CASE("image: an OpenEXR that only begins as ours is OpenImageIO's", "[image]")
{
	Image image;
	image.width_px = image.height_px = 1;
	image.channels = {"Z"};
	image.values = {2.0F};
	image.notes = {{"Software", "nook 0.1.0"}, {"strange", "another program's"}};
	const Image read = decodeImage(exrBytes(image), "a.exr");
	CHECK(read.values == image.values);
	CHECK(std::any_of(read.notes.begin(), read.notes.end(), [](const Note& n) { return n.key == "strange"; }));
	CHECK(std::any_of(read.notes.begin(), read.notes.end(), [](const Note& n) { return n.key.starts_with("oiio:"); }));
}
