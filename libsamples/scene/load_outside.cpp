// SPDX-License-Identifier: GPL-3.0-or-later
// Restricts a level to files in its own folder. Otherwise a level from elsewhere could copy any file of this machine into a picture
// or a message.
#include "scene/load_parts.h"

#include "core/error.h"

#include <algorithm>
#include <filesystem>

namespace nook
{

void checkInside(const std::string& level_path, const std::string& reference, const std::string& path, const LoadSettings& settings)
{
	if (settings.allow_outside)
	{
		return;
	}
	std::error_code failed;
	const std::filesystem::path parent = std::filesystem::path(level_path).parent_path();
	const std::filesystem::path folder = std::filesystem::canonical(parent.empty() ? "." : parent, failed);
	const std::filesystem::path file = std::filesystem::canonical(path, failed);
	if (failed)
	{
		return; // missing; reported elsewhere
	}
	if (std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first != folder.end())
	{
		throw Error(ExitCode::invalid_input,
					level_path + ": " + reference + ": found " + path +
						", which is outside the level's folder, expected a file in it (allow-outside permits others)");
	}
}

} // namespace nook
