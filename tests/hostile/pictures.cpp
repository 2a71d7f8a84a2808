// SPDX-License-Identifier: GPL-3.0-or-later
// OpenEXR: truncations, every number of its header at its limits; masks of a level in PNG, JPEG, TGA, BMP and OpenEXR: truncations,
// changed bytes, and pictures that decode to far more.
#include "corpus.h"

#include "../hostile_pictures.h"
#include "../level_files.h"

#include <cstdio> // jpeglib.h needs it
#include <cstdlib>

#include <jpeglib.h>

namespace nook::hostile
{
namespace
{

std::vector<std::pair<std::string, std::string>> asMask(const std::string& name, const std::string& picture)
{
	return {{"a.obj", "mtllib a.mtl\nusemtl net\n" + cubeObj()}, {"a.mtl", "newmtl net\nmap_d " + name + "\n"}, {name, picture}};
}

// A black JPEG; scans == 0: baseline, else progressive with as many scans of its last bits as that.
std::string blackJpeg(uint32_t side_px, std::size_t scans)
{
	jpeg_compress_struct jpeg{};
	jpeg_error_mgr errors{};
	jpeg.err = jpeg_std_error(&errors);
	jpeg_create_compress(&jpeg);
	unsigned char* bytes = nullptr;
	unsigned long size = 0;
	jpeg_mem_dest(&jpeg, &bytes, &size);
	jpeg.image_width = side_px;
	jpeg.image_height = side_px;
	jpeg.input_components = 1;
	jpeg.in_color_space = JCS_GRAYSCALE;
	jpeg_set_defaults(&jpeg);
	if (scans > 0)
	{
		jpeg_simple_progression(&jpeg);
	}
	jpeg_start_compress(&jpeg, TRUE);
	std::string row(side_px, '\0');
	for (uint32_t y = 0; y < side_px; ++y)
	{
		auto* const pixels = reinterpret_cast<JSAMPLE*>(row.data());
		JSAMPROW rows = pixels;
		jpeg_write_scanlines(&jpeg, &rows, 1);
	}
	jpeg_finish_compress(&jpeg);
	jpeg_destroy_compress(&jpeg);
	std::string whole(reinterpret_cast<const char*>(bytes), size);
	std::free(bytes); // NOLINT: of libjpeg
	const std::size_t last = whole.rfind("\xFF\xDA");
	const std::string scan = whole.substr(last, whole.size() - 2 - last);
	for (std::size_t i = 1; i < scans; ++i)
	{
		whole.insert(whole.size() - 2, scan);
	}
	return whole;
}

std::string littleEndian(uint32_t value, std::size_t bytes)
{
	std::string text;
	for (std::size_t i = 0; i < bytes; ++i)
	{
		text.push_back(static_cast<char>(value >> (8 * i)));
	}
	return text;
}

// Black, of 24 bits a pixel.
std::string blackTga(uint32_t width_px, uint32_t height_px)
{
	return std::string("\0\0\2\0\0\0\0\0\0\0\0\0", 12) + littleEndian(width_px, 2) + littleEndian(height_px, 2) +
		   std::string("\x18\0", 2) + std::string(std::size_t{3} * width_px * height_px, '\0');
}

std::string blackBmp(uint32_t width_px, uint32_t height_px)
{
	const std::string pixels(std::size_t{4} * width_px * height_px, '\0');
	return "BM" + littleEndian(static_cast<uint32_t>(54 + pixels.size()), 4) + littleEndian(0, 4) + littleEndian(54, 4) +
		   littleEndian(40, 4) + littleEndian(width_px, 4) + littleEndian(height_px, 4) + littleEndian(1, 2) + littleEndian(32, 2) +
		   littleEndian(0, 4) + littleEndian(static_cast<uint32_t>(pixels.size()), 4) + std::string(16, '\0') + pixels;
}

// Truncations of a mask, and every byte of its first 200 at its limits.
void addMask(Cases& cases, const std::string& format, const std::string& picture)
{
	const std::string name = "mask." + format;
	for (std::size_t size = 0; size < picture.size(); ++size)
	{
		cases.push_back({format + "/cuts", "cut at byte " + std::to_string(size), "03", asMask(name, picture.substr(0, size))});
	}
	for (std::size_t at = 0; at < std::min<std::size_t>(picture.size(), 200); ++at)
	{
		for (const int value : {0, 0x7F, 0xFF})
		{
			std::string changed = picture;
			changed[at] = static_cast<char>(value);
			cases.push_back(
				{format + "/bytes", "byte " + std::to_string(at) + " = " + std::to_string(value), "03", asMask(name, changed)});
		}
	}
}

} // namespace

void addPictures(Cases& cases)
{
	addMask(cases, "jpg", blackJpeg(9, 0));
	addMask(cases, "tga", blackTga(5, 3));
	addMask(cases, "bmp", blackBmp(5, 3));
	for (const std::size_t scans : {1UL, 10UL, 2000UL})
	{
		cases.push_back({"jpg/scans", std::to_string(scans) + " last scans", "03", asMask("mask.jpg", blackJpeg(4096, scans)), "",
						 decodedMb(4096)});
	}
	const std::string exr = textsExr(1);
	addCuts(cases, "exr/cuts", "03", "a.exr", exr);
	for (std::size_t size = 0; size < exr.size(); ++size)
	{
		cases.push_back({"exr/mask_cuts", "cut at byte " + std::to_string(size), "03", asMask("mask.exr", exr.substr(0, size))});
	}
	// Every fourth byte: attribute sizes, windows, line offsets, and letters between them.
	for (std::size_t at = 0; at + 4 <= exr.size(); at += 4)
	{
		for (const uint32_t value : {0xFFFFFFFFU, 0x7FFFFFFFU, 0U})
		{
			std::string changed = exr;
			std::memcpy(changed.data() + at, &value, sizeof value);
			cases.push_back(
				{"exr/numbers", "number at " + std::to_string(at) + " = " + std::to_string(value), "03", {{"a.exr", changed}}});
		}
	}
	cases.push_back({"exr/texts", "20000 attributes", "3", {{"a.exr", textsExr(20000)}}});
	const std::string png = blackPng(5, 3);
	for (std::size_t size = 0; size < png.size(); ++size)
	{
		cases.push_back({"png/cuts", "cut at byte " + std::to_string(size), "03", asMask("mask.png", png.substr(0, size))});
	}
	for (const char* const name :
		 {"mask.jpg", "mask.tga", "mask.bmp", "mask.tif", "mask.exr", "mask.dds", "mask.gif", "mask.psd", "mask.hdr", "mask.webp",
		  "mask.ppm", "mask.ico", "mask.sgi", "mask.pic", "mask.jp2", "mask.heic", "mask.nothing"})
	{
		cases.push_back({"png/names", name, "03", asMask(name, png)});
		cases.push_back(
			{"png/names", std::string("no picture as ") + name, "3", asMask(name, "no picture at all, whatever its name says")});
		cases.push_back({"png/names", std::string("zeros as ") + name, "3", asMask(name, std::string(1000, '\0'))});
	}
	for (const uint32_t side : {8192U, 8193U, 16384U, 40000U})
	{
		cases.push_back({"png/bombs", std::to_string(side) + " by as many pixels", side > 16384U ? "3" : "0",
						 asMask("mask.png", blackPng(side, side)), "", decodedMb(side)});
	}
}

} // namespace nook::hostile
