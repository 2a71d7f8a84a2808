// SPDX-License-Identifier: GPL-3.0-or-later
// Texels that nothing covers → values from those around, so that filters and mipmaps at the borders of charts read no darkness.
#pragma once

#include <vector>

namespace nook
{

// Values below 0 are empty. Four rings take the mean of the neighbours that are filled; the rest is pulled down from coarser levels
// (S. Gortler, R. Grzeszczuk, R. Szeliski, M. Cohen, "The Lumigraph", 1996: push and pull). All 1 where all are empty.
void fillEmpty(std::vector<float>& values, int size_px);

} // namespace nook
