// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/json_reader.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/json_text.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace nook
{
namespace
{

using nlohmann::json;

std::string shortened(const std::string& text)
{
	return text.size() <= 48 ? text : text.substr(0, 45) + "...";
}

std::string describe(const json& value)
{
	switch (value.type())
	{
	case json::value_t::array: return "an array of " + std::to_string(value.size());
	case json::value_t::object: return "an object";
	case json::value_t::string:
	{
		// Cut before escaping: a cut inside an escape or a UTF-8 sequence would be unreadable.
		const auto& text = value.get_ref<const std::string&>();
		return text.size() <= 48 ? jsonText(text) : jsonText(text.substr(0, 45)) + "...";
	}
	default: return shortened(jsonLine(value));
	}
}

// Stops at the first field that an object has twice.
struct TwiceWatch : nlohmann::detail::json_sax_acceptor<json>
{
	std::vector<std::set<std::string>> seen; // fields of the open objects
	std::optional<std::string> twice;

	bool start_object(std::size_t /*size*/)
	{
		seen.emplace_back();
		return true;
	}
	bool end_object()
	{
		seen.pop_back();
		return true;
	}
	bool key(string_t& name)
	{
		if (!seen.back().insert(name).second)
		{
			twice = name;
		}
		return !twice;
	}
};

[[noreturn]] void failAt(const std::string& text, std::size_t byte, const std::string& path, std::string found,
						 const char* expected)
{
	byte = std::min(byte, text.size());
	std::size_t line = 1;
	std::size_t column = 1;
	for (std::size_t i = 0; i < byte; ++i)
	{
		const bool ends = text[i] == '\n';
		column = ends ? 1U : column + 1U;
		line += ends ? 1U : 0U;
	}
	if (found.empty())
	{
		const unsigned char c = byte < text.size() ? static_cast<unsigned char>(text[byte]) : 0;
		const bool printable = c >= 0x20 && c < 0x7f;
		found = byte >= text.size() ? "the end of the file"
				: printable         ? std::string("'") + static_cast<char>(c) + "'"
									: "byte " + std::to_string(int{c});
	}
	throw Error(ExitCode::invalid_input, path + ": line " + std::to_string(line) + ", column " + std::to_string(column) +
											 ": found " + found + ", expected " + expected);
}

} // namespace

void JsonValue::fail(const std::string& found, const std::string& expected_what) const
{
	const std::string where = element.empty() ? *path : *path + ": " + element;
	throw Error(ExitCode::invalid_input, where + ": found " + found + ", expected " + expected_what);
}

void JsonValue::expected(const std::string& what) const
{
	fail(describe(*value), what);
}

void JsonValue::require(bool condition, std::string_view what) const
{
	if (!condition)
	{
		expected(std::string(what));
	}
}

std::string JsonValue::nameOfField(std::string_view field) const
{
	return field.empty() ? element : element.empty() ? std::string(field) : element + "." + std::string(field);
}

bool JsonValue::has(std::string_view field) const
{
	return value->contains(field);
}

JsonValue JsonValue::at(std::string_view field) const
{
	const auto found = value->find(field);
	if (found == value->end())
	{
		JsonValue{value, path, nameOfField(field)}.fail("nothing", "this field");
	}
	return {&*found, path, nameOfField(field)};
}

JsonValue JsonValue::at(std::size_t index) const
{
	return {&(*value)[index], path, element + "[" + std::to_string(index) + "]"};
}

std::size_t JsonValue::arraySize() const
{
	require(value->is_array(), "an array");
	return value->size();
}

void JsonValue::requireObject() const
{
	require(value->is_object(), "an object");
}

void JsonValue::allowOnly(std::initializer_list<std::string_view> fields) const
{
	requireObject();
	for (const auto& item : value->items())
	{
		if (std::find(fields.begin(), fields.end(), item.key()) == fields.end())
		{
			fail("the unknown field " + describe(json(item.key())), "one of " + joinedText(fields, ", "));
		}
	}
}

double JsonValue::number() const
{
	require(value->is_number(), "a number");
	const auto result = value->get<double>();
	require(std::isfinite(result), "a finite number");
	return result;
}

double JsonValue::number(double least, double most) const
{
	const double result = number();
	if (result < least || result > most)
	{
		expected("a number from " + numberText(least) + " to " + numberText(most));
	}
	return result;
}

int64_t JsonValue::integer(int64_t least, int64_t most) const
{
	const bool small_enough = value->is_number_integer() && (!value->is_number_unsigned() || value->get<uint64_t>() <= INT64_MAX);
	if (!small_enough || value->get<int64_t>() < least || value->get<int64_t>() > most)
	{
		expected("a whole number from " + std::to_string(least) + " to " + std::to_string(most));
	}
	return value->get<int64_t>();
}

uint64_t JsonValue::whole(uint64_t most) const
{
	if (!value->is_number_unsigned() || value->get<uint64_t>() > most)
	{
		expected("a whole number from 0 to " + std::to_string(most));
	}
	return value->get<uint64_t>();
}

std::size_t JsonValue::indexInto(std::size_t size) const
{
	require(size > 0, "no such field, since the file has none");
	return static_cast<std::size_t>(whole(size - 1));
}

bool JsonValue::boolean() const
{
	require(value->is_boolean(), "true or false");
	return value->get<bool>();
}

std::string JsonValue::string() const
{
	require(value->is_string(), "a string");
	return value->get<std::string>();
}

void JsonValue::fail(std::string_view field, const std::string& found, const std::string& expected_what) const
{
	JsonValue{value, path, nameOfField(field)}.fail(found, expected_what);
}

std::optional<JsonValue> JsonValue::object(std::string_view field) const
{
	return has(field) ? std::optional(objectNeeded(field)) : std::nullopt;
}

JsonValue JsonValue::objectNeeded(std::string_view field) const
{
	JsonValue found = at(field);
	found.requireObject();
	return found;
}

std::size_t JsonValue::count(std::string_view field) const
{
	return has(field) ? at(field).arraySize() : 0;
}

JsonValue JsonValue::item(std::string_view field, std::size_t index) const
{
	JsonValue found = at(field).at(index);
	found.requireObject();
	return found;
}

std::vector<JsonValue> JsonValue::objects(std::string_view field) const
{
	return listOf(count(field), [&](std::size_t i) { return item(field, i); });
}

std::optional<uint64_t> JsonValue::whole(std::string_view field, uint64_t most) const
{
	return has(field) ? std::optional(at(field).whole(most)) : std::nullopt;
}

std::optional<std::size_t> JsonValue::index(std::string_view field, std::size_t size) const
{
	return has(field) ? std::optional(at(field).indexInto(size)) : std::nullopt;
}

std::vector<std::size_t> JsonValue::indices(std::string_view field, std::size_t size) const
{
	return listOf(count(field), [&](std::size_t i) { return at(field).at(i).indexInto(size); });
}

double JsonValue::number(std::string_view field, double otherwise) const
{
	return has(field) ? at(field).number() : otherwise;
}

std::vector<double> JsonValue::numbers(std::string_view field, std::size_t size) const
{
	if (has(field) && at(field).arraySize() != size)
	{
		at(field).expected("an array of " + std::to_string(size) + " numbers");
	}
	return listOf(count(field), [&](std::size_t i) { return at(field).at(i).number(); });
}

bool JsonValue::boolean(std::string_view field, bool otherwise) const
{
	return has(field) ? at(field).boolean() : otherwise;
}

std::string JsonValue::text(std::string_view field, const std::string& otherwise) const
{
	return has(field) ? at(field).string() : otherwise;
}

std::vector<std::string> JsonValue::texts(std::string_view field) const
{
	return listOf(count(field), [&](std::size_t i) { return at(field).at(i).string(); });
}

std::string JsonValue::name() const
{
	const auto found = value->find("name");
	const bool named = found != value->end() && found->is_string() && !found->get_ref<const std::string&>().empty();
	return named ? found->get<std::string>() : element;
}

nlohmann::json parseJson(const std::string& text, const std::string& path)
{
	// This is a separate pass, since a parser with a callback takes time quadratic in the length of an array of objects.
	TwiceWatch watch;
	json::sax_parse(text, &watch);
	if (watch.twice)
	{
		throw Error(ExitCode::invalid_input, path + ": found the field " + describe(*watch.twice) + " twice, expected it once");
	}
	try
	{
		return json::parse(text);
	}
	catch (const json::parse_error& error)
	{
		failAt(text, error.byte == 0 ? 0 : error.byte - 1, path, "", "JSON");
	}
	catch (const json::exception&) // a number outside the range of double
	{
		throw Error(ExitCode::invalid_input, path + ": found a number out of range, expected finite numbers");
	}
}

} // namespace nook
