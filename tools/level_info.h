// SPDX-License-Identifier: GPL-3.0-or-later
// A level and its diagnosis → the lines that `nook info` prints, and the same facts as JSON.
#pragma once

#include "summary.h"

#include "scene/load.h"

#include <string>

namespace nook
{

std::string describeLevel(const LoadedLevel& loaded, int threads, Summary& summary);

// "degenerate-triangles: 12 dropped, first mesh 'wall', triangle 3", a line each.
std::string findingLines(const Diagnosis& diagnosis);

} // namespace nook
