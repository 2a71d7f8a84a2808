// SPDX-License-Identifier: GPL-3.0-or-later
// Files as Assimp 5.2.5 asks for them → their bytes, changed where it would take them wrongly; and which were there.
#pragma once

#include <assimp/DefaultIOSystem.h>

#include <string>
#include <vector>

namespace nook
{

class AssimpFiles : public Assimp::DefaultIOSystem
{
public:
	bool Exists(const char* file) const override;
	Assimp::IOStream* Open(const char* file, const char* mode) override;

	std::vector<std::string> opened;  // each once
	std::vector<std::string> missing; // each once
};

} // namespace nook
