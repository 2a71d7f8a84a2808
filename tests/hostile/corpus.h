// SPDX-License-Identifier: GPL-3.0-or-later
// Files made to break their reader, and the exit codes that each may get. Nothing of it is committed but what makes it.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace nook::hostile
{

struct Case
{
	std::string group; // "gltf/types": cases of one group stand in their order
	std::string what;  // what is wrong with it, for people
	std::string codes; // exit codes that may be: "3", "03"
	// Name in a folder of its own → bytes. The first is what nook is given; others are what it names.
	std::vector<std::pair<std::string, std::string>> files;
	std::string link{}; // a link of that name leads to the bait
};

using Cases = std::vector<Case>;

// Files that nook wrote, by name: what is ours is broken from whole ones.
using Seeds = std::map<std::string, std::string>;

// A folder outside of every level's: its files must not be opened.
struct Bait
{
	std::string folder;
	int port = 0; // of this machine, where somebody listens
};

void addGltf(Cases& cases, const Bait& bait);
void addText(Cases& cases);                     // OBJ, MTL, PLY, STL
void addPictures(Cases& cases);                 // PNG as masks, OpenEXR
void addOurs(Cases& cases, const Seeds& seeds); // patterns, tiles, recipes, volumes, parts, plans
void addNames(Cases& cases, const Bait& bait);  // names of files, nodes, materials; where they lead

// Every beginning of `whole`, as so many cases.
void addCuts(Cases& cases, const std::string& group, const std::string& codes, const std::string& name, const std::string& whole);

// Every value of a JSON document, and every object and array, in turn replaced by what it should not be, or left out. `make`
// makes the files of a document.
using FilesOf = std::function<std::vector<std::pair<std::string, std::string>>(const nlohmann::json&)>;
void addFields(Cases& cases, const std::string& group, const std::string& codes, const nlohmann::json& whole, const FilesOf& make);

// Numbers as text that readers take for others, or for none.
const std::vector<std::string>& oddNumbers();

// Names that something that prints, runs or parses them could take for more than a name.
const std::vector<std::string>& oddNames();

} // namespace nook::hostile
