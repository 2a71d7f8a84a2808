// SPDX-License-Identifier: GPL-3.0-or-later
// Files made to break their reader, with the allowed exit codes. Generated; no file is committed.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace nook::hostile
{

struct Case
{
	std::string group; // "gltf/types": the cases of a group are in order
	std::string what;  // description of the defect
	std::string codes; // allowed exit codes: "3", "03"
	// Name in a new folder → bytes. The first is passed to nook; the others are referenced by it.
	std::vector<std::pair<std::string, std::string>> files;
	std::string link{};      // name of a link to the bait
	double decoded_mb = 0.0; // of a mask that is read
};

// A square mask of that side, if it is small enough to be read.
constexpr double decodedMb(uint32_t side_px)
{
	return side_px > 16384U ? 0.0 : 1e-6 * side_px * side_px;
}

using Cases = std::vector<Case>;

// Files written by nook, by name: nook's own formats are broken starting from valid files.
using Seeds = std::map<std::string, std::string>;

// A folder outside of every level's: its files must not be opened.
struct Bait
{
	std::string folder;
	int port = 0; // local port with a listener
};

void addGltf(Cases& cases, const Bait& bait);
void addText(Cases& cases);                     // OBJ, MTL, PLY, STL
void addPictures(Cases& cases);                 // PNG masks, OpenEXR
void addOurs(Cases& cases, const Seeds& seeds); // patterns, tiles, recipes, volumes, parts, plans
void addNames(Cases& cases, const Bait& bait);  // names of files, nodes and materials, and where they lead

// Adds every prefix of `whole` as a case.
void addCuts(Cases& cases, const std::string& group, const std::string& codes, const std::string& name, const std::string& whole);

// Replaces every value, object and array of a JSON document in turn with invalid ones, or removes it. `make` creates the files for
// a document.
using FilesOf = std::function<std::vector<std::pair<std::string, std::string>>(const nlohmann::json&)>;
void addFields(Cases& cases, const std::string& group, const std::string& codes, const nlohmann::json& whole, const FilesOf& make);

// Numbers as text that readers misinterpret or reject.
const std::vector<std::string>& oddNumbers();

// Names that a program that prints, executes or parses them could misinterpret.
const std::vector<std::string>& oddNames();

} // namespace nook::hostile
