// SPDX-License-Identifier: GPL-3.0-or-later
// OpenEXR: truncations, every number of its header at its limits; PNG masks of a level: truncations, and pictures that decode to
// far more.
#include "corpus.h"

#include "../hostile_pictures.h"
#include "../level_files.h"

namespace nook::hostile
{
namespace
{

std::vector<std::pair<std::string, std::string>> asMask(const std::string& name, const std::string& picture)
{
	return {{"a.obj", "mtllib a.mtl\nusemtl net\n" + cubeObj()}, {"a.mtl", "newmtl net\nmap_d " + name + "\n"}, {name, picture}};
}

} // namespace

void addPictures(Cases& cases)
{
	const std::string exr = textsExr(1);
	addCuts(cases, "exr/cuts", "03", "a.exr", exr);
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
