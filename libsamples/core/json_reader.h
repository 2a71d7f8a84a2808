// SPDX-License-Identifier: GPL-3.0-or-later
// Parses JSON into checked values; every error is an Error (invalid_input) "path: element: found X, expected Y".
#pragma once

#include "core/lists.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// A value and its location. Cheap to copy; the document must outlive it.
struct JsonValue
{
	const nlohmann::json* value = nullptr;
	const std::string* path = nullptr; // file path
	std::string element;               // "points[3]"; empty: the whole file

	[[noreturn]] void fail(const std::string& found, const std::string& expected) const;
	[[noreturn]] void expected(const std::string& what) const; // describes the value found
	void require(bool condition, std::string_view what) const; // that the condition holds, else as expected()

	bool has(std::string_view field) const;
	JsonValue at(std::string_view field) const; // throws if the field is missing
	JsonValue at(std::size_t index) const;
	std::string nameOfField(std::string_view field) const;

	std::size_t arraySize() const;                              // throws if it is not an array
	template <class Read> auto elements(const Read& read) const // read(element) of each; throws if it is not an array
	{
		return listOf(arraySize(), [&](std::size_t i) { return std::invoke(read, at(i)); });
	}
	void requireObject() const;
	void allowOnly(std::initializer_list<std::string_view> fields) const; // throws if it is not an object

	double number() const; // finite
	double number(double least, double most) const;
	int64_t integer(int64_t least, int64_t most) const;
	uint64_t whole(uint64_t most) const;           // 0 to `most`
	std::size_t indexInto(std::size_t size) const; // index into an array of that size
	bool boolean() const;
	std::string string() const;

	// Optional fields of an object: a missing field yields an empty value, 0 or `otherwise`; a field of the wrong type throws.
	[[noreturn]] void fail(std::string_view field, const std::string& found, const std::string& expected) const;
	std::optional<JsonValue> object(std::string_view field) const;
	JsonValue objectNeeded(std::string_view field) const;
	std::size_t count(std::string_view field) const;                 // size of an array
	JsonValue item(std::string_view field, std::size_t index) const; // an element, which must be an object
	std::vector<JsonValue> objects(std::string_view field) const;    // elements of an array
	std::optional<uint64_t> whole(std::string_view field, uint64_t most) const;
	std::optional<std::size_t> index(std::string_view field, std::size_t size) const;
	std::vector<std::size_t> indices(std::string_view field, std::size_t size) const;
	double number(std::string_view field, double otherwise) const;
	std::vector<double> numbers(std::string_view field, std::size_t size) const; // exactly `size` numbers
	bool boolean(std::string_view field, bool otherwise) const;
	std::string text(std::string_view field, const std::string& otherwise = {}) const;
	std::vector<std::string> texts(std::string_view field) const;
	std::string name() const; // for messages: the field "name", else the location
};

// Invalid text and duplicate fields are errors that name line and column.
nlohmann::json parseJson(const std::string& text, const std::string& path);

} // namespace nook
