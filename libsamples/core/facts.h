// SPDX-License-Identifier: GPL-3.0-or-later
// Facts about what was made or read, in order: text for people, a JSON object for programs.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// A measure by its name in JSON. Infinite values are JSON's null.
struct Measure
{
	std::string name;
	double value = 0.0;
};

// A fact has a name for programs, words for people, or both. Numbers that are not finite are null in JSON.
class Facts
{
public:
	void text(std::string_view name, std::string_view value, std::string_view words = {});
	void number(std::string_view name, double value, std::string_view words = {}, std::string_view unit = {});
	void measures(std::string_view name, const std::vector<Measure>& values, std::string_view words = {});
	void texts(std::string_view name, const std::vector<std::string>& values);
	void numbers(std::string_view name, const std::vector<double>& values);
	void items(std::string_view name, const std::vector<Facts>& values); // one per line
	template <std::integral Whole> void whole(std::string_view name, Whole value, std::string_view words = {})
	{
		add(name, std::to_string(static_cast<uint64_t>(value)), words, ": " + std::to_string(static_cast<uint64_t>(value)));
	}
	// One reason of a count above it: an indented line, unless it is 0.
	template <std::integral Whole> void reason(std::string_view name, Whole value, std::string_view words)
	{
		whole(name, value, value == Whole{} ? std::string() : "  " + std::string(words));
	}

	// The next fact is added only if the condition holds. It is made either way.
	Facts& when(bool condition)
	{
		m_skips = !condition;
		return *this;
	}

	// For people alone: a whole line, without its end.
	void line(std::string_view words);

	std::string json() const;
	std::string lines() const; // of the facts that have words

private:
	struct Fact
	{
		std::string name;
		std::string json;
		std::string words;
		std::string shown; // behind the words
	};

	void add(std::string_view name, std::string json, std::string_view words = {}, std::string shown = {});
	std::string fields() const;

	std::vector<Fact> m_facts;
	bool m_skips = false; // the next one
};

// Measures as a JSON object, one per line.
std::string measuresJson(const std::vector<Measure>& measures);

} // namespace nook
