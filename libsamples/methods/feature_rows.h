// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "methods/feature_table.h"

namespace nook
{

// What featureTable() holds.
std::vector<FeatureRow> featureRows();

} // namespace nook
