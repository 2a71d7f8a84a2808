// SPDX-License-Identifier: GPL-3.0-or-later
// Running sums along the rows or columns of a picture of counts, on the CPU.
#pragma once

#include "core/progress.h"
#include "methods/picture.h"

namespace nook
{

// Along x (axis 0) or y (1). Requires planes of the same size.
void scanOnCpu(const PicturePlane& source, int axis, PicturePlane& target, const RunSettings& run);

} // namespace nook
