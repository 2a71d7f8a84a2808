// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gltf_json.h"

#include "core/error.h"

#include <cmath>

namespace nook
{
namespace
{

// A value in an error line.
std::string shown(const nlohmann::json& value)
{
	if (value.is_object() || value.is_array())
	{
		return value.is_object() ? "an object" : "a list of " + std::to_string(value.size());
	}
	std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
	if (text.size() > 40)
	{
		text = text.substr(0, 37) + "...";
	}
	return text;
}

std::string wholeUpTo(uint64_t most)
{
	return "a whole number from 0 to " + std::to_string(most);
}

} // namespace

GltfItem::GltfItem(const nlohmann::json& value, const std::string& path, std::string where)
	: m_value(&value), m_path(&path), m_where(std::move(where))
{
	if (!value.is_object())
	{
		throw Error(ExitCode::invalid_input,
					path + ": " + (m_where.empty() ? "" : m_where + ": ") + "found " + shown(value) + ", expected an object");
	}
}

void GltfItem::fail(std::string_view field, const std::string& found, const std::string& expected) const
{
	std::string where = m_where;
	if (!field.empty())
	{
		where += (where.empty() ? "" : ".") + std::string(field);
	}
	throw Error(ExitCode::invalid_input,
				*m_path + ": " + (where.empty() ? "" : where + ": ") + "found " + found + ", expected " + expected);
}

const nlohmann::json* GltfItem::find(std::string_view field) const
{
	const auto found = m_value->find(field);
	return found == m_value->end() ? nullptr : &*found;
}

bool GltfItem::has(std::string_view field) const
{
	return find(field) != nullptr;
}

const nlohmann::json& GltfItem::needed(std::string_view field, const std::string& expected) const
{
	const nlohmann::json* const value = find(field);
	if (value == nullptr)
	{
		fail(field, "nothing", expected);
	}
	return *value;
}

std::optional<GltfItem> GltfItem::object(std::string_view field) const
{
	const nlohmann::json* const value = find(field);
	if (value == nullptr)
	{
		return std::nullopt;
	}
	return GltfItem(*value, *m_path, (m_where.empty() ? "" : m_where + ".") + std::string(field));
}

GltfItem GltfItem::objectNeeded(std::string_view field) const
{
	needed(field, "an object");
	return *object(field);
}

std::size_t GltfItem::count(std::string_view field) const
{
	const nlohmann::json* const value = find(field);
	if (value == nullptr)
	{
		return 0;
	}
	if (!value->is_array())
	{
		fail(field, shown(*value), "a list");
	}
	return value->size();
}

GltfItem GltfItem::item(std::string_view field, std::size_t index) const
{
	return {(*find(field))[index], *m_path,
			(m_where.empty() ? "" : m_where + ".") + std::string(field) + "[" + std::to_string(index) + "]"};
}

std::vector<GltfItem> GltfItem::objects(std::string_view field) const
{
	std::vector<GltfItem> items;
	const std::size_t size = count(field);
	for (std::size_t i = 0; i < size; ++i)
	{
		items.push_back(item(field, i));
	}
	return items;
}

std::optional<uint64_t> GltfItem::whole(std::string_view field, uint64_t most) const
{
	return has(field) ? std::optional(wholeNeeded(field, most)) : std::nullopt;
}

uint64_t GltfItem::wholeNeeded(std::string_view field, uint64_t most) const
{
	const nlohmann::json& value = needed(field, wholeUpTo(most));
	if (!value.is_number_unsigned() || value.get<uint64_t>() > most)
	{
		fail(field, shown(value), wholeUpTo(most));
	}
	return value.get<uint64_t>();
}

std::size_t GltfItem::indexOf(const nlohmann::json& value, std::string_view field, std::size_t size) const
{
	if (!value.is_number_unsigned() || value.get<uint64_t>() >= size)
	{
		fail(field, shown(value), size == 0 ? "no such field, since the file has none" : wholeUpTo(size - 1));
	}
	return static_cast<std::size_t>(value.get<uint64_t>());
}

std::optional<std::size_t> GltfItem::index(std::string_view field, std::size_t size) const
{
	const nlohmann::json* const value = find(field);
	return value == nullptr ? std::nullopt : std::optional(indexOf(*value, field, size));
}

std::size_t GltfItem::indexNeeded(std::string_view field, std::size_t size) const
{
	return indexOf(needed(field, "an index"), field, size);
}

std::vector<std::size_t> GltfItem::indices(std::string_view field, std::size_t size) const
{
	std::vector<std::size_t> found;
	for (std::size_t i = 0; i < count(field); ++i)
	{
		found.push_back(indexOf((*find(field))[i], std::string(field) + "[" + std::to_string(i) + "]", size));
	}
	return found;
}

double GltfItem::number(std::string_view field, double otherwise) const
{
	return has(field) ? numberNeeded(field) : otherwise;
}

double GltfItem::numberNeeded(std::string_view field) const
{
	const nlohmann::json& value = needed(field, "a number");
	if (!value.is_number() || !std::isfinite(value.get<double>()))
	{
		fail(field, shown(value), "a number");
	}
	return value.get<double>();
}

std::vector<double> GltfItem::numbers(std::string_view field, std::size_t size) const
{
	const nlohmann::json* const value = find(field);
	if (value == nullptr)
	{
		return {};
	}
	const std::string expected = "a list of " + std::to_string(size) + " numbers";
	if (!value->is_array() || value->size() != size)
	{
		fail(field, shown(*value), expected);
	}
	std::vector<double> found;
	for (const nlohmann::json& entry : *value)
	{
		if (!entry.is_number() || !std::isfinite(entry.get<double>()))
		{
			fail(field, shown(entry), expected);
		}
		found.push_back(entry.get<double>());
	}
	return found;
}

bool GltfItem::boolean(std::string_view field, bool otherwise) const
{
	const nlohmann::json* const value = find(field);
	if (value != nullptr && !value->is_boolean())
	{
		fail(field, shown(*value), "true or false");
	}
	return value == nullptr ? otherwise : value->get<bool>();
}

std::string GltfItem::text(std::string_view field, const std::string& otherwise) const
{
	const nlohmann::json* const value = find(field);
	if (value != nullptr && !value->is_string())
	{
		fail(field, shown(*value), "text");
	}
	return value == nullptr ? otherwise : value->get<std::string>();
}

std::vector<std::string> GltfItem::texts(std::string_view field) const
{
	std::vector<std::string> found;
	for (std::size_t i = 0; i < count(field); ++i)
	{
		const nlohmann::json& entry = (*find(field))[i];
		if (!entry.is_string())
		{
			fail(std::string(field) + "[" + std::to_string(i) + "]", shown(entry), "text");
		}
		found.push_back(entry.get<std::string>());
	}
	return found;
}

std::string GltfItem::name() const
{
	const nlohmann::json* const value = find("name");
	return value != nullptr && value->is_string() && !value->get_ref<const std::string&>().empty() ? value->get<std::string>()
																								   : m_where;
}

} // namespace nook
