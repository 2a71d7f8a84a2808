// SPDX-License-Identifier: GPL-3.0-or-later
// What a measurement of one candidate depends on → the key of a cache.
#pragma once

#include "bench/measure_view.h"

#include <string>

namespace nook
{

// `view`: of viewHash(). As 32 hexadecimal digits; ViewBench::contentHash says of what.
std::string measurementHash(const std::string& view, const Candidate& candidate, const MeasureSettings& settings, int threads);

} // namespace nook
