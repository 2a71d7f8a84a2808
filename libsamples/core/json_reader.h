// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a JSON file → checked values; everything wrong is an Error (invalid_input) "path: element: found X, expected Y".
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
	double number(double least, double most) const;
	int64_t integer(int64_t least, int64_t most) const;
	uint64_t whole(uint64_t most) const;           // 0 to `most`
	std::size_t indexInto(std::size_t size) const; // of an array of that size
	bool boolean() const;
	std::string string() const;

	// Fields of an object, as formats have them that leave out what has a default: nothing, none, 0 or `otherwise` where a field is
	// absent, an error where it is there and wrong.
	[[noreturn]] void fail(std::string_view field, const std::string& found, const std::string& expected) const;
	std::optional<JsonValue> object(std::string_view field) const;
	JsonValue objectNeeded(std::string_view field) const;
	std::size_t count(std::string_view field) const;                 // of an array
	JsonValue item(std::string_view field, std::size_t index) const; // an object, of an array that has it
	std::vector<JsonValue> objects(std::string_view field) const;    // of an array
	std::optional<uint64_t> whole(std::string_view field, uint64_t most) const;
	uint64_t wholeNeeded(std::string_view field, uint64_t most) const;
	std::optional<std::size_t> index(std::string_view field, std::size_t size) const;
	std::size_t indexNeeded(std::string_view field, std::size_t size) const;
	std::vector<std::size_t> indices(std::string_view field, std::size_t size) const;
	double number(std::string_view field, double otherwise) const;
	double numberNeeded(std::string_view field) const;
	std::vector<double> numbers(std::string_view field, std::size_t size) const; // so many
	bool boolean(std::string_view field, bool otherwise) const;
	std::string text(std::string_view field, const std::string& otherwise = {}) const;
	std::vector<std::string> texts(std::string_view field) const;
	std::string name() const; // for people: the field "name", or where it stands
};

// Parses; broken text and fields that occur twice are errors that name line and column.
nlohmann::json parseJson(const std::string& text, const std::string& path);

} // namespace nook
