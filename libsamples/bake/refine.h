// SPDX-License-Identifier: GPL-3.0-or-later
// A level and an error that is asked for → the level in as many triangles as that takes, and the values at its vertices.
#pragma once

#include "bake/bake.h"

namespace nook
{

// Rounds of fit and subdivision until no triangle's error is above settings.max_error. Requires max_error > 0 and BakeFit::surface.
VertexBake refineBake(const Tracer& tracer, const BakeSettings& settings, const RunSettings& run);

} // namespace nook
