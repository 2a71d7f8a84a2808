// SPDX-License-Identifier: GPL-3.0-or-later
// Names: of the file itself, of its contents, of other files. They are printed as text and lead nowhere outside.
#include "corpus.h"

#include "../hostile_pictures.h"
#include "../level_files.h"
#include "core/json_text.h"

namespace nook::hostile
{
namespace
{

using nlohmann::json;

const std::string kCube = "usemtl net\n" + cubeObj();

json namedCube(const std::string& name)
{
	json document = cubeGltf();
	document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(cubeBuffer());
	document["nodes"][0]["name"] = name;
	document["meshes"][0]["name"] = name;
	document["materials"] = {{{"name", name}, {"alphaMode", "BLEND"}}};
	document["meshes"][0]["primitives"][0]["material"] = 0;
	document["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
	document["nodes"].push_back({{"name", name}, {"camera", 0}});
	document["scenes"][0]["nodes"] = {0, 1};
	return document;
}

} // namespace

void addNames(Cases& cases, const Bait& bait)
{
	for (const std::string& name : oddNames())
	{
		if (name.size() < 200 && name.find('/') == std::string::npos)
		{
			cases.push_back({"names/file", name, "0", {{name + ".obj", cubeObj()}}});
			cases.push_back({"names/refused", name, "3", {{name + ".obj", "v 0 0 0\n"}}});
		}
		const bool is_text = name.find('\xFF') == std::string::npos; // JSON is UTF-8
		std::string document = jsonLine(namedCube(is_text ? name : "NAME"));
		for (std::size_t at = document.find("NAME"); at != std::string::npos; at = document.find("NAME", at + 1))
		{
			document.replace(at, 4, name);
		}
		cases.push_back({"names/gltf", name, is_text ? "0" : "3", {{"a.gltf", document}}});
		cases.push_back({"names/obj", name, "0", {{"a.obj", "o " + name + "\ng " + name + "\n" + cubeObj()}}});
		cases.push_back({"names/material",
						 name,
						 "0",
						 {{"a.obj", "mtllib a.mtl\nusemtl " + name + "\n" + cubeObj()}, {"a.mtl", "newmtl " + name + "\n"}}});
		cases.push_back(
			{"names/mask", name, "023", {{"a.obj", "mtllib a.mtl\n" + kCube}, {"a.mtl", "newmtl net\nmap_d " + name + "\n"}}});
		cases.push_back({"names/mtllib", name, "0", {{"a.obj", "mtllib " + name + "\n" + cubeObj()}}});
	}
	const std::string port = "127.0.0.1:" + std::to_string(bait.port);
	for (const std::string& way :
		 {bait.folder, std::string("../../bait"), std::string("in/../../../bait"), std::string("..\\..\\bait"), std::string("out"),
		  "file://" + bait.folder, "http://" + port, "//" + port})
	{
		cases.push_back({"names/outside", "mtllib " + way, "03", {{"a.obj", "mtllib " + way + "/a.mtl\n" + kCube}}, "out"});
		cases.push_back({"names/outside",
						 "map_d " + way,
						 "23",
						 {{"a.obj", "mtllib a.mtl\n" + kCube}, {"a.mtl", "newmtl net\nmap_d " + way + "/mask.png\n"}},
						 "out"});
		json document = namedCube("a");
		document["buffers"][0]["uri"] = way + "/b.bin";
		cases.push_back({"names/outside", "uri " + way, "23", {{"a.gltf", jsonLine(document)}}, "out"});
	}
}

} // namespace nook::hostile
