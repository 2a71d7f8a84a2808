// SPDX-License-Identifier: GPL-3.0-or-later
// JSON ↔ text. File names may be any bytes; invalid UTF-8 is replaced by a mark.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace nook
{

// On one line, without a newline.
std::string jsonLine(const nlohmann::json& value);
std::string jsonLine(const nlohmann::ordered_json& value);

// Formatted for people too: one value per line.
std::string jsonFile(const nlohmann::ordered_json& value);

// Returns a `discarded` value if the text is not JSON. For text that must be JSON use parseJson (json_reader.h).
nlohmann::json looseJson(std::string_view text);

} // namespace nook
