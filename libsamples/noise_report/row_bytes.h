// SPDX-License-Identifier: GPL-3.0-or-later
// What was made and measured of a row ↔ bytes, for parts of a report.
#pragma once

#include "noise_report/noise_report.h"

#include <string>
#include <string_view>

namespace nook
{

std::string savedRow(const NoiseRow& row);

// Into a row with its recipe. False for bytes that savedRow() does not write for it.
bool loadRow(std::string_view bytes, NoiseRow& row);

} // namespace nook
