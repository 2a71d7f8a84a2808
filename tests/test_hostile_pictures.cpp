// SPDX-License-Identifier: GPL-3.0-or-later
// Picture files with large demands: a picture, or one error, within bounded time.
#include "hostile_pictures.h"
#include "level_files.h"
#include "testing.h"

#include "core/image_codec.h"
#include "core/isolate.h"

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

// Compares a picture with OpenImageIO's reading of it.
void checkSame(const std::string& bytes, const std::string& name)
{
	const Image a = decodeImage(bytes, name);
	Decoded<Image> other;
	isolate(
		{kImageWorker, kDecode, true}, name, IsolationLimits{},
		[&](ValueWriter& to)
		{
			to.text(name);
			to.values(bytes);
		},
		[&](ValueReader& from) { receive(other, from); });
	const Image& b = other.image.value();
	CHECK(a.width_px == b.width_px);
	CHECK(a.height_px == b.height_px);
	CHECK(a.channels == b.channels);
	CHECK(a.values == b.values);
	CHECK(a.halves == b.halves);
	CHECK(a.cropped == b.cropped);
	CHECK(wordsOf(a) == wordsOf(b));
	REQUIRE(a.matrices.size() == b.matrices.size());
	for (std::size_t i = 0; i < a.matrices.size(); ++i)
	{
		CHECK(a.matrices[i].key == b.matrices[i].key);
		CHECK(a.matrices[i].values == b.matrices[i].values);
		CHECK(a.matrices[i].wide == b.matrices[i].wide);
	}
}

// The PNG with an additional chunk after its header.
std::string withChunk(const std::string& png, const std::string& type, const std::string& content)
{
	constexpr std::size_t kHeader = 8 + 12 + 13;
	std::string chunk;
	appendPngChunk(chunk, type, content);
	return png.substr(0, kHeader) + chunk + png.substr(kHeader);
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

TEST_CASE("image: an OpenEXR reads as OpenImageIO reads it", "[image]")
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
	checkSame(ours, "a.exr");
	const Image a = decodeImage(ours, "a.exr");
	CHECK(a.matrices.size() == 2);
	for (std::size_t y = 0; y < image.channels.size(); ++y)
	{
		CHECK(a.at(100, a.channel(image.channels[y])) == image.at(100, static_cast<int>(y)));
	}
}

TEST_CASE("image: a PNG reads as OpenImageIO reads it", "[image]")
{
	std::vector<uint8_t> rgb(3 * 16 * 16);
	for (std::size_t i = 0; i < rgb.size(); ++i)
	{
		rgb[i] = static_cast<uint8_t>(i * 7 % 256);
	}
	checkSame(bare(pngBytes(16, 16, rgb, {{"Made by", "nook pattern, ä"}, {"Version", ""}, {"Comment", "a\nb"}})), "a.png");
	std::vector<uint16_t> rgba(4 * 128 * 128);
	for (std::size_t i = 0; i < rgba.size(); ++i)
	{
		rgba[i] = static_cast<uint16_t>(i);
	}
	checkSame(bare(pngBytes(128, 128, rgba, {})), "a.png");
	checkSame(bare(alphaPngBytes(5, 3, std::vector<uint8_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 90, 100, 200, 253, 254, 255})), "a.png");
	checkSame(zerosPng(9, 7, 8, 0, 1), "a.png");
	checkSame(zerosPng(9, 7, 16, 4, 2), "a.png");
	// A text after the pixels does not belong to the picture.
	std::string chunk;
	appendPngChunk(chunk, "tEXt", std::string("Title\0late", 10));
	std::string late = zerosPng(9, 7, 8, 0, 1);
	late.insert(late.size() - 12, chunk);
	checkSame(late, "a.png");
}

TEST_CASE("image: offsets, transparent colours, palettes and texts of PNG files", "[image]")
{
	checkSame(blackPng(9, 7), "a.png");
	const std::string grey = zerosPng(9, 7, 8, 0, 1);
	// An offset of 2 pixels makes it a part of a picture.
	CHECK(decodeImage(withChunk(grey, "oFFs", std::string("\0\0\0\2\0\0\0\0\0", 9)), "a.png").cropped);
	// Grey with black as the transparent colour.
	const std::string holes = withChunk(grey, "tRNS", std::string(2, '\0'));
	checkSame(holes, "a.png");
	CHECK(decodeAlphas({{"a.png", "", holes}}, "level").front().alpha == std::vector<uint8_t>(9 * 7, 0));
	// Palette indices.
	const std::string palette = withChunk(zerosPng(9, 7, 8, 3, 1), "PLTE", std::string("\xFF\0\0", 3));
	checkSame(palette, "a.png");
	CHECK(decodeImage(palette, "a.png").values[0] == 1.0F);
	// Texts keep their names.
	const Notes notes = decodeImage(withChunk(grey, "tEXt", std::string("Title\0of all", 12)), "a.png").notes;
	REQUIRE(notes.size() == 1);
	CHECK(notes[0].key == "Title");
	CHECK(notes[0].value == "of all");
	// 16 bits are reduced to an 8-bit opacity.
	CHECK(decodeAlphas({{"a.png", "", zerosPng(9, 7, 16, 4, 2)}}, "level").front().alpha == std::vector<uint8_t>(9 * 7, 0));
	std::string cut = grey;
	cut.resize(cut.size() - 30);
	CHECK_THROWS_WITH(decodeImage(cut, "cut.png"), Catch::Contains("cut.png: found "));
}

TEST_CASE("image: opacities of several pictures, in their order", "[image]")
{
	const std::vector<uint8_t> alpha{0, 50, 100, 200, 254, 255};
	const std::string plain = alphaPngBytes(3, 2, alpha);
	const std::string grey = zerosPng(4, 1, 8, 0, 1);
	const std::vector<AlphaImage> read = decodeAlphas({{"a.png", "", withChunk(plain, "noOk", "")},
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
	CHECK_THROWS_WITH(decodeAlphas({{"a.png", "", plain, MaskChannel::alpha, 3},
									{"b.png", "", withChunk(plain, "noOk", ""), MaskChannel::alpha, 2}},
								   "level", 7),
					  Catch::Contains("level: found masks of more than 28 texels in all"));
	std::string cut = plain;
	cut.resize(cut.size() - 20);
	CHECK_THROWS_WITH(decodeAlphas({{"a.png", "", plain}, {"cut.png", "", cut}}, "level"), Catch::Contains("cut.png: found "));
}

TEST_CASE("image: texts of other programs in an OpenEXR", "[image]")
{
	Image image;
	image.width_px = image.height_px = 1;
	image.channels = {"Z"};
	image.values = {2.0F};
	image.notes = {{"strange", "another program's"}};
	checkSame(exrBytes(image), "a.exr");
}
