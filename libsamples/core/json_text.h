// SPDX-License-Identifier: GPL-3.0-or-later
// JSON → text, and back. Names of files are bytes: what is no UTF-8 gets a mark.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace nook
{

// In one line, without its end.
std::string jsonLine(const nlohmann::json& value);
std::string jsonLine(const nlohmann::ordered_json& value);

// As a file for people too: a line a value.
std::string jsonFile(const nlohmann::json& value);
std::string jsonFile(const nlohmann::ordered_json& value);

// Of text that may be no JSON: it is `discarded` then. Text that must be JSON: parseJson (json_reader.h).
nlohmann::json looseJson(std::string_view text);

} // namespace nook
