// SPDX-License-Identifier: GPL-3.0-or-later
// What the summaries of verbs that read a level have in common.
#pragma once

#include "summary.h"

#include "scene/load.h"

namespace nook
{

// Name, triangles, and the findings as "id count".
void addLevelFacts(Summary& summary, const LoadedLevel& loaded);

} // namespace nook
