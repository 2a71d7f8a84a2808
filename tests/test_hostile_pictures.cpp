// SPDX-License-Identifier: GPL-3.0-or-later
// Picture files that ask for much: a picture, or one error; never a wait without end.
#include "core/error.h"
#include "core/image.h"

#include "hostile_pictures.h"
#include "level_files.h"
#include "temporary_folder.h"

#include <catch2/catch.hpp>

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
