// SPDX-License-Identifier: GPL-3.0-or-later
// Files that a command reads → hashes of what they and the files that they name hold.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace nook
{

// Without "./", "a/../" and doubled slashes: one text for one name.
std::string plainPath(const std::string& path);

// The files that a level's file names: buffers and pictures of a .gltf; the .mtl files of an .obj and their pictures. Those that
// are not there are left out: the verb will say so. Other formats name none that are seen here.
std::vector<std::string> filesBeside(const std::string& path);

// Each file is read once. Throws Error (file).
class InputHashes
{
public:
	// Of a file and those beside it, by its name in a folder.
	const std::string& of(const std::string& folder, const std::string& path);

private:
	std::map<std::string, std::string> m_hashes;
};

} // namespace nook
