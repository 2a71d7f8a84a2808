// SPDX-License-Identifier: GPL-3.0-or-later
// Measurements ↔ JSON.
#pragma once

#include "core/json_reader.h"
#include "study/measure_view.h"

#include <nlohmann/json.hpp>

namespace nook
{

// Times in milliseconds, with nine significant digits; without the picture.
nlohmann::ordered_json measurementJson(const Measurement& measurement);

// Throws Error (invalid_input).
Measurement measurementFrom(const JsonValue& value);

// In milliseconds, likewise.
nlohmann::ordered_json spreadJson(const TimeSpread& spread);

// Errors alone, as they stand among a measurement's other fields.
nlohmann::ordered_json errorsJson(const ViewErrors& errors);
ViewErrors errorsFrom(const JsonValue& value);

// null: none.
std::optional<double> optionalNumber(const JsonValue& value);
nlohmann::ordered_json optionalJson(const std::optional<double>& value);

} // namespace nook
