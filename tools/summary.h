// SPDX-License-Identifier: GPL-3.0-or-later
// What --json holds: flat facts and the measures of what was made or read.
#pragma once

#include "format/notes.h"

#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// A JSON object, schema "nook.summary/1", field by field.
class Summary
{
public:
	explicit Summary(std::string_view verb);
	Summary() = default; // without schema, verb and version: an item of another's list

	void text(std::string_view name, std::string_view value);
	void number(std::string_view name, double value); // not finite: null
	void whole(std::string_view name, std::size_t value);
	void measures(std::string_view name, const std::vector<Measure>& measures);
	void texts(std::string_view name, const std::vector<std::string>& values);
	void numbers(std::string_view name, const std::vector<double>& values); // not finite: null
	void items(std::string_view name, const std::vector<Summary>& items);   // one a line

	std::string json() const;

private:
	void field(std::string_view name, const std::string& json);

	std::string m_fields;
};

// One measure a line, for people.
std::string measureLines(const std::vector<Measure>& measures);

} // namespace nook
