// SPDX-License-Identifier: GPL-3.0-or-later
// Points and weights as read from a file → 32-bit values that the measures may rely on, or an Error (invalid_input).
#pragma once

#include "pattern/pattern.h"

#include <functional>
#include <string>

namespace nook
{

// Name of a sample in messages: "p.json: weights[3]", "p.csv: row 5".
using SampleName = std::function<std::string(std::size_t index)>;

// Checks one point of a domain, finite already, and rounds it to 32-bit floats (held in doubles). A point beyond the unit circle
// or ball by no more than 1e-6, as other tools' rounding leaves them, is pulled onto the nearest floats inside; directions are of
// unit length within 1e-5; z ≥ −1e-6 on the hemisphere. `where` is "path: element".
glm::dvec3 checkedPoint(Domain domain, const glm::dvec3& point, const std::string& where);

// Checks weights that were given, finite already: ≥ 0, sum 1 within 1e-4; rounds them to 32-bit floats.
// `where` names the list, `name_of` one of its entries, both with the path in front.
void checkWeights(std::vector<double>& weights, const std::string& where, const SampleName& name_of);

} // namespace nook
