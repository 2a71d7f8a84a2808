// SPDX-License-Identifier: GPL-3.0-or-later
// Point sets without relaxation: independent, Poisson, Halton, Vogel. All follow the layout and the domain's measure.
#pragma once

#include "core/random.h"
#include "pattern/layout.h"

namespace nook
{

std::vector<glm::dvec3> randomPoints(const Layout& layout, Random& random);

// Dart throwing (Cook 1986). The minimum distance starts at that of a dense packing and shrinks by 5 % when darts keep missing.
std::vector<glm::dvec3> poissonPoints(const Layout& layout, Random& random);

// Halton's sequence in bases 2, 3, 5 from index 1, mapped through the measure's inverse distribution.
std::vector<glm::dvec3> haltonPoints(const Layout& layout);

// Golden-angle spiral (Vogel 1979; on the sphere Swinbank and Purser 2006); in the ball the radii also follow a golden-ratio
// sequence.
std::vector<glm::dvec3> vogelPoints(const Layout& layout);

} // namespace nook
