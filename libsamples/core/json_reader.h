// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a JSON file → checked values; everything wrong is an Error (invalid_input) "path: element: found X, expected Y".
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace nook
{

// A value, and where it stands. Cheap to copy; the document must outlive it.
struct JsonValue
{
	const nlohmann::json* value = nullptr;
	const std::string* path = nullptr; // of the file
	std::string element;               // "points[3]"; empty: the whole file

	[[noreturn]] void fail(const std::string& found, const std::string& expected) const;
	[[noreturn]] void expected(const std::string& what) const; // what was found is described here

	bool has(std::string_view field) const;
	JsonValue at(std::string_view field) const; // a missing field is an error
	JsonValue at(std::size_t index) const;
	std::string nameOfField(std::string_view field) const;

	std::size_t arraySize() const; // not an array is an error
	void requireObject() const;
	void allowOnly(std::initializer_list<std::string_view> fields) const; // also requires an object

	double number() const; // finite
	int64_t integer(int64_t least, int64_t most) const;
	bool boolean() const;
	std::string string() const;
};

// Parses; broken text and fields that occur twice are errors that name line and column.
nlohmann::json parseJson(const std::string& text, const std::string& path);

} // namespace nook
