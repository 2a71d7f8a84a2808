// SPDX-License-Identifier: GPL-3.0-or-later
// The sets that need no relaxation: independent, Poisson, Halton, Vogel. All points of the layout, distributed by the domain's
// measure.
#pragma once

#include "core/random.h"
#include "pattern/layout.h"

namespace nook
{

std::vector<glm::dvec3> randomPoints(const Layout& layout, Random& random);

// Dart throwing (Cook 1986); the least distance starts from that of a dense packing and shrinks by 5 % when darts keep missing.
std::vector<glm::dvec3> poissonPoints(const Layout& layout, Random& random);

// Halton's sequence in bases 2, 3, 5 from index 1, through the inverse distribution of the measure.
std::vector<glm::dvec3> haltonPoints(const Layout& layout);

// Golden-angle spiral (Vogel 1979; Swinbank and Purser 2006 on the sphere); in the ball radii follow a golden-ratio sequence too.
std::vector<glm::dvec3> vogelPoints(const Layout& layout);

} // namespace nook
