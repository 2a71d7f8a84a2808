// SPDX-License-Identifier: GPL-3.0-or-later
// A file → a sum of its bytes (content_hash.h).
#pragma once

#include <string>

namespace nook
{

// Reads it in blocks: a level may have gigabytes. Throws Error (file).
std::string hashOfFile(const std::string& path);

} // namespace nook
