// SPDX-License-Identifier: GPL-3.0-or-later
// OBJ, MTL, PLY and STL: every kind of line with every odd number, truncations, wrong headers.
#include "corpus.h"

#include "../hostile_pictures.h"
#include "../level_files.h"

namespace nook::hostile
{
namespace
{

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n";

// A cube with a masked material, so that the files it refers to are read.
std::vector<std::pair<std::string, std::string>> withMaterials(const std::string& materials)
{
	return {{"a.obj", "mtllib a.mtl\nusemtl net\n" + cubeObj()}, {"a.mtl", materials}, {"mask.png", blackPng(4, 4)}};
}

void addObj(Cases& cases)
{
	addCuts(cases, "obj/cuts", "03", "a.obj", cubeObj());
	for (const std::string& number : oddNumbers())
	{
		for (const std::string& line : {"v " + number + " 0 0", "v 0 0 0 " + number, "vt " + number + " 0", "vn " + number + " 0 1",
										"f " + number + " 2 3", "f 1/" + number + " 2 3", "f 1//" + number + " 2 3"})
		{
			cases.push_back({"obj/numbers", line.substr(0, 60), "03", {{"a.obj", kTriangle + line + "\nf 1 2 4\n"}}});
		}
	}
	const std::string many(200000, ' ');
	std::string fan = "f";
	for (int i = 0; i < 100000; ++i)
	{
		fan += " 1";
	}
	for (const std::string& line : {fan,
									std::string("f 1"),
									std::string("f 1 2"),
									std::string("f"),
									std::string("v"),
									std::string("l 1 2 3"),
									std::string("p 1 2 3"),
									"usemtl " + std::string(100000, 'a'),
									"o" + many,
									"g " + many + "a",
									std::string("mtllib"),
									std::string("usemtl"),
									std::string("vp 1 2 3\ncurv 0 1 1 2 3\nend"),
									std::string("cstype bezier\nsurf 0 1 0 1 1 2 3 4"),
									std::string("f 1 2 3 \\"),
									"# " + std::string(1000000, '#'),
									std::string("v 0 0 0\0 1", 10),
									std::string("\r\r\r\r"),
									std::string("call a.obj"),
									std::string("csh -touch taken"),
									std::string("mtllib a.obj"),
									std::string("bevel on")})
	{
		cases.push_back({"obj/lines", line.substr(0, 40), "03", {{"a.obj", kTriangle + line}}});
	}
	for (const char* const text : {"", "\n", "v 0 0 0\n", "f 1 2 3\n", "\xFF\xFEv", "\xFE\xFFv", "\xEF\xBB\xBFv 0 0 0\n"})
	{
		cases.push_back({"obj/empty", text, "3", {{"a.obj", text}}});
	}
	addCuts(cases, "fbx/cuts", "03", "a.fbx", cubeFbx(true, 1.0));
}

void addMtl(Cases& cases)
{
	for (const std::string& number : oddNumbers())
	{
		for (const char* const key : {"d ", "Tr ", "Ka ", "illum ", "map_d -s "})
		{
			cases.push_back(
				{"mtl/numbers", key + number.substr(0, 60), "023", withMaterials("newmtl net\n" + (key + number) + "\n")});
		}
	}
	for (const char* const line : {"map_d",
								   "map_d ",
								   "map_d .",
								   "map_d ..",
								   "map_d /",
								   "map_d a.obj",
								   "map_d a.mtl",
								   "map_d none.png",
								   "map_d -clamp on",
								   "map_d -o 1 1 1 -s 1 1 1 mask.png",
								   "map_d -bm nan mask.png",
								   "map_d -mm 0 1e999 mask.png",
								   "map_d mask.png\nmap_d mask.png\nmap_d a.mtl",
								   "newmtl",
								   "newmtl net\nnewmtl net",
								   "map_d \"mask.png\"",
								   "map_d /dev/zero",
								   "map_d /proc/self/environ",
								   "map_d *0",
								   "map_d *1"})
	{
		cases.push_back({"mtl/lines", line, "023", withMaterials(std::string("newmtl net\n") + line + "\n")});
	}
	cases.push_back({"mtl/lines", "a megabyte without an end of a line", "023", withMaterials(std::string(1000000, 'a'))});
}

void addPly(Cases& cases)
{
	const std::string whole = cubePly();
	addCuts(cases, "ply/cuts", "3", "a.ply", whole.substr(0, whole.find("end_header") + 40));
	const auto swap = [&](const std::string& from, const std::string& to)
	{
		std::string changed = whole;
		changed.replace(changed.find(from), from.size(), to);
		cases.push_back({"ply/header", to.substr(0, 60), "03", {{"a.ply", changed}}});
	};
	for (const char* const format :
		 {"binary_middle_endian 1.0", "binary_little_endian 1.0", "binary_big_endian 1.0", "ascii 2.0", "ascii", "", "ASCII 1.0"})
	{
		swap("format ascii 1.0", std::string("format ") + format);
	}
	for (const std::string& number : oddNumbers())
	{
		swap("vertex 8", "vertex " + number);
		swap("face 12", "face " + number);
		swap("3 0 4 6", number + " 0 4 6");
		swap("3 0 4 6", "3 " + number + " 4 6");
		swap("\n1 0 0\n", "\n" + number + " 0 0\n");
	}
	for (const char* const type : {"double", "uchar", "list uchar float", "list float int", "long", "", "float x"})
	{
		swap("property float x", std::string("property ") + type + " x");
		swap("property list uchar int", std::string("property ") + type);
	}
	for (const char* const name : {"vertex_index", "vertices", "tristrips", ""})
	{
		swap("vertex_indices", name);
	}
	// Binary files: counts that contradict the length.
	for (const char* const end : {"little", "big"})
	{
		for (const uint32_t count : {0U, 1U, 3U, 255U, 65536U, 0x7FFFFFFFU, 0xFFFFFFFFU})
		{
			std::string bytes = "ply\nformat binary_" + std::string(end) + "_endian 1.0\nelement vertex " + std::to_string(count) +
								"\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uint uint "
								"vertex_indices\nend_header\n";
			bytes += std::string(36, '\0');
			append(bytes, count);
			bytes += std::string(12, '\1');
			cases.push_back({"ply/binary", std::string(end) + " " + std::to_string(count), "3", {{"a.ply", bytes}}});
		}
	}
}

void addStl(Cases& cases)
{
	addCuts(cases, "stl/cuts", "03", "a.stl", cubeStl());
	for (const std::string& number : oddNumbers())
	{
		std::string changed = cubeStl();
		changed.replace(changed.find("vertex 0"), 8, "vertex " + number);
		cases.push_back({"stl/numbers", number.substr(0, 60), "03", {{"a.stl", changed}}});
	}
	for (const uint32_t count : {0U, 1U, 2U, 3U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU, 85899346U})
	{
		for (const std::size_t triangles : {std::size_t{0}, std::size_t{1}, std::size_t{2}})
		{
			std::string bytes(80, ' ');
			append(bytes, count);
			for (std::size_t i = 0; i < triangles; ++i)
			{
				for (const float value : {0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F})
				{
					append(bytes, value);
				}
				append(bytes, uint16_t{0});
			}
			cases.push_back({"stl/counts",
							 std::to_string(count) + " for " + std::to_string(triangles),
							 count == triangles && count > 0 ? "0" : "3",
							 {{"a.stl", bytes}}});
		}
	}
}

} // namespace

void addText(Cases& cases)
{
	addObj(cases);
	addMtl(cases);
	addPly(cases);
	addStl(cases);
}

} // namespace nook::hostile
