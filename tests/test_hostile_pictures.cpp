// SPDX-License-Identifier: GPL-3.0-or-later
// Picture files with large demands: a picture, or one error, within bounded time.
#include "core/error.h"
#include "core/image.h"

#include "hostile_pictures.h"
#include "level_files.h"
#include "temporary_folder.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace nook;

namespace
{

// All notes except the program that wrote it and what OpenImageIO adds.
std::string wordsOf(const Image& image)
{
	std::string all;
	for (const Note& note : image.notes)
	{
		all += note.key.starts_with("oiio:") || note.key == "Software" ? "" : note.key + "=" + note.value + "\n";
	}
	return all;
}

// Compares one picture read by two workers; matrices separately.
void checkSame(const Image& a, const Image& b)
{
	CHECK(a.width_px == b.width_px);
	CHECK(a.height_px == b.height_px);
	CHECK(a.channels == b.channels);
	CHECK(a.values == b.values);
	CHECK(a.halves == b.halves);
	CHECK(a.cropped == b.cropped);
	CHECK(wordsOf(a) == wordsOf(b));
}

} // namespace

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
	const std::string png = blackPng(20000, 20000); // 317 KB; decoded to floats it would exceed the limit
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
	image.height_px = 37; // more than two blocks of 16 lines
	image.channels = {"N.X", "N.Y", "N.Z", "Z", "depth_error", "visibility", "bent.X", "R", "A", "G"};
	for (std::size_t i = 0; i < image.channels.size() * 3 * 37; ++i)
	{
		image.values.push_back(static_cast<float>(i) * 0.37F - 100.0F);
	}
	image.notes = {{"Software", "nook 0.1.0"}, {"nook:level", "a level"}};
	image.matrices = {{"worldToCamera", {1.0, 2.0, 3.5}, false}, {"projection64", {0.1, 0.2}, true}};
	const std::string ours = exrBytes(image);
	std::string others = ours; // renamed so that another worker reads it
	others[others.find("nook 0")] = 'l';
	const Image a = decodeImage(ours, "a.exr");
	const Image b = decodeImage(others, "a.exr");
	checkSame(a, b);
	// OpenImageIO adds colour information that is not in the file, which shows which worker read it.
	const auto remarks = [](const Image& from)
	{
		return std::count_if(from.notes.begin(), from.notes.end(), [](const Note& n) { return n.key.starts_with("oiio:"); });
	};
	CHECK(remarks(a) == 0);
	CHECK(remarks(b) > 0);
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

namespace
{

// The PNG with an additional chunk after its header.
std::string withChunk(const std::string& png, const std::string& type, const std::string& content)
{
	constexpr std::size_t kHeader = 8 + 12 + 13;
	std::string chunk;
	appendPngChunk(chunk, type, content);
	return png.substr(0, kHeader) + chunk + png.substr(kHeader);
}

// With an unknown chunk, so that OpenImageIO reads it.
std::string forOpenImageIO(const std::string& png)
{
	return withChunk(png, "noOk", "");
}

bool saysColours(const Image& image)
{
	return std::any_of(image.notes.begin(), image.notes.end(), [](const Note& n) { return n.key == "oiio:ColorSpace"; });
}

// A PNG of zeros with `channels` values of `bits` bits per pixel.
std::string zerosPng(uint32_t width_px, uint32_t height_px, char bits, char colour_type, uint32_t channels)
{
	std::string head;
	appendBigEndian(head, width_px);
	appendBigEndian(head, height_px);
	head += {bits, colour_type, 0, 0, 0};
	std::string png = "\x89PNG\r\n\x1A\n";
	appendPngChunk(png, "IHDR", head);
	appendPngChunk(png, "IDAT",
				   zlibZeros(uint64_t{height_px} * (1 + uint64_t{width_px} * channels * static_cast<uint64_t>(bits / 8))));
	appendPngChunk(png, "IEND", "");
	return png;
}

void checkSamePng(const std::string& png)
{
	checkSame(decodeImage(png, "a.png"), decodeImage(forOpenImageIO(png), "a.png"));
	// OpenImageIO adds colour information that is not in the file, which shows which worker read it.
	const std::string coloured = withChunk(png, "sRGB", std::string(1, '\0'));
	CHECK_FALSE(saysColours(decodeImage(coloured, "a.png")));
	CHECK(saysColours(decodeImage(forOpenImageIO(coloured), "a.png")));
}

// Without the chunks that pngBytes() adds.
std::string bare(const std::string& png)
{
	std::string left = png.substr(0, 8);
	for (std::size_t at = 8; at + 12 <= png.size();)
	{
		std::size_t size = 12;
		for (std::size_t i = 0; i < 4; ++i)
		{
			size += static_cast<std::size_t>(static_cast<unsigned char>(png[at + i])) << (24 - 8 * i);
		}
		const std::string type = png.substr(at + 4, 4);
		if (type == "IHDR" || type == "IDAT" || type == "IEND" || (type == "tEXt" && png.compare(at + 8, 5, "oiio:") != 0))
		{
			left += png.substr(at, size);
		}
		at += size;
	}
	return left;
}

} // namespace

TEST_CASE("image: a plain PNG reads as OpenImageIO reads it", "[image]")
{
	std::vector<uint8_t> rgb(3 * 16 * 16);
	for (std::size_t i = 0; i < rgb.size(); ++i)
	{
		rgb[i] = static_cast<uint8_t>(i * 7 % 256);
	}
	checkSamePng(bare(pngBytes(16, 16, rgb, {{"Made by", "nook pattern, ä"}, {"Version", ""}, {"Comment", "a\nb"}})));
	std::vector<uint16_t> rgba(4 * 128 * 128);
	for (std::size_t i = 0; i < rgba.size(); ++i)
	{
		rgba[i] = static_cast<uint16_t>(i);
	}
	checkSamePng(bare(pngBytes(128, 128, rgba, {})));
	checkSamePng(bare(alphaPngBytes(5, 3, std::vector<uint8_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 90, 100, 200, 253, 254, 255})));
	checkSamePng(zerosPng(9, 7, 8, 0, 1));
	checkSamePng(zerosPng(9, 7, 16, 4, 2));
	// A text after the pixels does not belong to the picture.
	std::string chunk;
	appendPngChunk(chunk, "tEXt", std::string("Title\0late", 10));
	std::string late = zerosPng(9, 7, 8, 0, 1);
	late.insert(late.size() - 12, chunk);
	checkSamePng(late);
}

TEST_CASE("image: PNG files that are not plain are OpenImageIO's", "[image]")
{
	const Image bits = decodeImage(blackPng(9, 7), "a.png");
	CHECK(bits.values == std::vector<float>(9 * 7, 0.0F));
	const std::string grey = zerosPng(9, 7, 8, 0, 1);
	// An offset of 2 pixels makes it a part of a picture.
	CHECK(decodeImage(withChunk(grey, "oFFs", std::string("\0\0\0\2\0\0\0\0\0", 9)), "a.png").cropped);
	// Grey with black as the transparent colour.
	const std::string holes = withChunk(grey, "tRNS", std::string(2, '\0'));
	CHECK(decodeImage(holes, "a.png").channels.size() == 2);
	CHECK(decodeAlphas({{"a.png", "", holes}}, "level").front().alpha == std::vector<uint8_t>(9 * 7, 0));
	// Palette indices.
	const std::string palette = withChunk(zerosPng(9, 7, 8, 3, 1), "PLTE", std::string("\xFF\0\0", 3));
	CHECK(decodeImage(palette, "a.png").channels.size() == 3);
	CHECK(decodeImage(palette, "a.png").values[0] == 1.0F);
	// Texts that OpenImageIO renames, and repeated names.
	const auto textOf = [&](const std::string& png, const std::string& key)
	{
		const Image read = decodeImage(png, "a.png");
		const auto found = std::find_if(read.notes.begin(), read.notes.end(), [&](const Note& n) { return n.key == key; });
		return found == read.notes.end() ? "" : found->value;
	};
	CHECK(textOf(withChunk(grey, "tEXt", std::string("Title\0of all", 12)), "DocumentName") == "of all");
	const std::string one = withChunk(grey, "tEXt", std::string("Comment\0b", 9));
	const std::string two = withChunk(one, "tEXt", std::string("comment\0a", 9));
	const Image read = decodeImage(two, "a.png");
	CHECK(std::count_if(read.notes.begin(), read.notes.end(), [](const Note& n) { return n.value == "a" || n.value == "b"; }) == 1);
	// 16 bits are reduced to an 8-bit opacity.
	CHECK(decodeAlphas({{"a.png", "", zerosPng(9, 7, 16, 4, 2)}}, "level").front().alpha == std::vector<uint8_t>(9 * 7, 0));
	std::string cut = grey;
	cut.resize(cut.size() - 30);
	CHECK_THROWS_WITH(decodeImage(cut, "cut.png"), Catch::Contains("cut.png: found "));
}

TEST_CASE("image: opacities of plain PNG files and of others, in their order", "[image]")
{
	const std::vector<uint8_t> alpha{0, 50, 100, 200, 254, 255};
	const std::string plain = alphaPngBytes(3, 2, alpha);
	const std::string grey = zerosPng(4, 1, 8, 0, 1);
	const std::vector<AlphaImage> read = decodeAlphas({{"a.png", "", forOpenImageIO(plain)},
													   {"b.png", "", plain},
													   {"c.png", "", grey},
													   {"d.png", "", grey, MaskChannel::alpha_or_first},
													   {"e.png", "", blackPng(2, 2), MaskChannel::alpha_or_first}},
													  "level");
	REQUIRE(read.size() == 5);
	CHECK(read[0].alpha == alpha);
	CHECK(read[1].alpha == alpha);
	CHECK(read[1].width_px == 3);
	CHECK(read[2].alpha == std::vector<uint8_t>(4, 255));
	CHECK(read[3].alpha == std::vector<uint8_t>(4, 0));
	CHECK(read[4].alpha == std::vector<uint8_t>(4, 0));
	// They have a common limit, whichever worker reads them.
	CHECK_THROWS_WITH(
		decodeAlphas({{"a.png", "", plain, MaskChannel::alpha, 3}, {"b.png", "", forOpenImageIO(plain), MaskChannel::alpha, 2}},
					 "level", 7),
		Catch::Contains("level: found masks of more than 28 texels in all"));
	std::string cut = plain;
	cut.resize(cut.size() - 20);
	CHECK_THROWS_WITH(decodeAlphas({{"a.png", "", plain}, {"cut.png", "", cut}}, "level"), Catch::Contains("cut.png: found "));
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
