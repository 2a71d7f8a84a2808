// SPDX-License-Identifier: GPL-3.0-or-later
// A level as loadLevels() makes it, kept for other runs of the program (core/kept_answers.h): the parts of a command read and clean
// it once.
#pragma once

#include "core/progress.h"
#include "scene/load.h"

#include <functional>
#include <span>

namespace nook
{

// What `read` gives, or gave to another part of a command that found the same bytes in all of its files. Kept where parts share out
// the work, and nothing is missing that the level names.
LoadedLevel keptLevel(std::span<const PlacedLevel> levels, const LoadSettings& settings, const RunSettings& run,
					  const std::function<LoadedLevel()>& read);

} // namespace nook
