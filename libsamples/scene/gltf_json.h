// SPDX-License-Identifier: GPL-3.0-or-later
// The JSON of a glTF file, read with checks; everything wrong is an Error (invalid_input) "path: element: found X, expected Y".
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// An object of the file, and where it stands. Cheap to copy; the document must outlive it.
class GltfItem
{
public:
	GltfItem(const nlohmann::json& value, const std::string& path, std::string where); // not an object is an error

	[[noreturn]] void fail(std::string_view field, const std::string& found, const std::string& expected) const;

	bool has(std::string_view field) const;
	const nlohmann::json* find(std::string_view field) const; // null where absent

	std::optional<GltfItem> object(std::string_view field) const;
	GltfItem objectNeeded(std::string_view field) const;
	std::vector<GltfItem> objects(std::string_view field) const;    // of an array; none where absent
	GltfItem item(std::string_view field, std::size_t index) const; // of an array that has it
	std::size_t count(std::string_view field) const;                // of an array; 0 where absent

	// Whole numbers. `most` is included.
	std::optional<uint64_t> whole(std::string_view field, uint64_t most) const;
	uint64_t wholeNeeded(std::string_view field, uint64_t most) const;
	// Index into an array of `size` things.
	std::optional<std::size_t> index(std::string_view field, std::size_t size) const;
	std::size_t indexNeeded(std::string_view field, std::size_t size) const;
	std::vector<std::size_t> indices(std::string_view field, std::size_t size) const;

	double number(std::string_view field, double otherwise) const; // finite
	double numberNeeded(std::string_view field) const;
	std::vector<double> numbers(std::string_view field, std::size_t count) const; // none where absent
	bool boolean(std::string_view field, bool otherwise) const;
	std::string text(std::string_view field, const std::string& otherwise = {}) const;
	std::vector<std::string> texts(std::string_view field) const;

	// The item's name in the file, for people: its "name", or where it stands.
	std::string name() const;
	const std::string& where() const
	{
		return m_where;
	}

private:
	const nlohmann::json& needed(std::string_view field, const std::string& expected) const;
	std::size_t indexOf(const nlohmann::json& value, std::string_view field, std::size_t size) const;

	const nlohmann::json* m_value;
	const std::string* m_path;
	std::string m_where; // "nodes[3]"; empty: the whole file
};

} // namespace nook
