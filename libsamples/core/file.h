// SPDX-License-Identifier: GPL-3.0-or-later
// Whole files in and out; an output appears complete or not at all.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace nook
{

// The file's bytes. Throws Error (file) with the path and the system's reason.
std::string readFile(const std::string& path);

// Writes to a temporary file beside `path` and renames it; "-" is standard output; an existing file that is not a regular one
// (a device, a pipe) is written directly. On failure nothing is left behind. Throws Error (file).
void writeFile(const std::string& path, std::string_view bytes);

// The same where a library writes the file itself: `write` gets the temporary path (same ending) and throws on failure.
void writeFileWith(const std::string& path, const std::function<void(const std::string& temporary_path)>& write);

} // namespace nook
