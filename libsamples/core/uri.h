// SPDX-License-Identifier: GPL-3.0-or-later
// Names as glTF writes them.
#pragma once

#include <string>

namespace nook
{

// "a%20b.png" → "a b.png"; a % that no code follows stays.
std::string unescaped(const std::string& uri);

} // namespace nook
