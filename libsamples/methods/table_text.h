// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of methods and features as the docs show them, in Markdown.
#pragma once

#include "methods/feature_table.h"
#include "methods/method_table.h"

#include <string>

namespace nook
{

// A line a method.
std::string methodsText();

// A line a feature that the method takes in `nook shade`: option, unit, range, default, what it does.
std::string optionsText(const MethodRow& method);

std::string rangeText(const FeatureRow& feature);
std::string defaultText(const FeatureRow& feature);

} // namespace nook
