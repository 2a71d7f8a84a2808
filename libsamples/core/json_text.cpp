// SPDX-License-Identifier: GPL-3.0-or-later
// Kept in one source: every file that writes or parses JSON instantiates half of nlohmann-json.
#include "core/json_text.h"

#include <nlohmann/json.hpp>

namespace nook
{
namespace
{

template <typename Json> std::string lineOf(const Json& value)
{
	return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <typename Json> std::string fileOf(const Json& value)
{
	return value.dump(1, '\t', false, Json::error_handler_t::replace) + "\n";
}

} // namespace

std::string jsonLine(const nlohmann::json& value)
{
	return lineOf(value);
}

std::string jsonLine(const nlohmann::ordered_json& value)
{
	return lineOf(value);
}

std::string jsonFile(const nlohmann::json& value)
{
	return fileOf(value);
}

std::string jsonFile(const nlohmann::ordered_json& value)
{
	return fileOf(value);
}

nlohmann::json looseJson(std::string_view text)
{
	return nlohmann::json::parse(text, nullptr, false);
}

} // namespace nook
