// SPDX-License-Identifier: GPL-3.0-or-later
// JSON → text. Names of files are bytes: what is no UTF-8 gets a mark.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace nook
{

// In one line, without its end.
template <typename Json> std::string jsonLine(const Json& json)
{
	return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// As a file for people too: a line a value.
template <typename Json> std::string jsonFile(const Json& json)
{
	return json.dump(1, '\t', false, Json::error_handler_t::replace) + "\n";
}

} // namespace nook
