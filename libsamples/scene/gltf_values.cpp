// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gltf_values.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace nook
{
namespace
{

template <class T> T valueAt(const char* at)
{
	T value{};
	std::memcpy(&value, at, sizeof value);
	return value;
}

// glTF 2.0, section 3.6.2.2: signed numbers range from −1 to 1; the least integer also maps to −1.
template <class T> double wholeAt(const char* at, bool normalized, double most)
{
	const auto value = static_cast<double>(valueAt<T>(at));
	return normalized ? std::max(value / most, -1.0) : value;
}

uint32_t indexAt(const char* at, uint64_t component)
{
	switch (component)
	{
	case 5121: return valueAt<uint8_t>(at);
	case 5123: return valueAt<uint16_t>(at);
	default: return valueAt<uint32_t>(at);
	}
}

} // namespace

std::size_t bytesOfComponent(uint64_t component)
{
	switch (component)
	{
	case 5120:
	case 5121: return 1;
	case 5122:
	case 5123: return 2;
	case 5125:
	case 5126: return 4;
	default: return 0;
	}
}

std::size_t componentsOf(std::string_view type)
{
	constexpr std::array<std::pair<std::string_view, std::size_t>, 7> kTypes{
		{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
	const auto* const found = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& entry) { return entry.first == type; });
	return found == kTypes.end() ? 0 : found->second;
}

GltfValues::GltfValues(GltfFile& file, std::size_t accessor)
{
	const JsonValue item = file.root().item("accessors", accessor);
	m_count = static_cast<std::size_t>(item.wholeNeeded("count", UINT32_MAX));
	m_component = item.wholeNeeded("componentType", UINT16_MAX);
	m_normalized = item.boolean("normalized", false);
	m_size = componentsOf(item.text("type")) * bytesOfComponent(m_component);
	// Bytes of the view that `of` names, starting at its offset.
	const auto bytes = [&](const JsonValue& of)
	{
		const auto view = static_cast<std::size_t>(of.wholeNeeded("bufferView", UINT32_MAX));
		return viewBytes(file, view).substr(static_cast<std::size_t>(of.whole("byteOffset", UINT64_MAX).value_or(0)));
	};
	m_stride = m_size;
	if (item.has("bufferView"))
	{
		const JsonValue view =
			file.root().item("bufferViews", static_cast<std::size_t>(item.wholeNeeded("bufferView", UINT32_MAX)));
		m_stride = static_cast<std::size_t>(view.whole("byteStride", UINT16_MAX).value_or(0));
		m_stride = m_stride == 0 ? m_size : m_stride;
		m_bytes = bytes(item);
	}
	if (const std::optional<JsonValue> sparse = item.object("sparse"))
	{
		const auto count = static_cast<std::size_t>(sparse->wholeNeeded("count", m_count));
		const JsonValue indices = sparse->objectNeeded("indices");
		const uint64_t component = indices.wholeNeeded("componentType", UINT16_MAX);
		const std::string_view from = bytes(indices);
		for (std::size_t i = 0; i < count; ++i)
		{
			const uint32_t index = indexAt(from.data() + i * bytesOfComponent(component), component);
			if (index >= m_count || (i > 0 && index <= m_replaced.back()))
			{
				sparse->fail("indices", std::to_string(index) + " in place " + std::to_string(i),
							 "ascending ones below " + std::to_string(m_count));
			}
			m_replaced.push_back(index);
		}
		m_replacing_bytes = bytes(sparse->objectNeeded("values"));
	}
}

const char* GltfValues::elementAt(std::size_t i) const
{
	if (!m_replaced.empty())
	{
		const auto found = std::lower_bound(m_replaced.begin(), m_replaced.end(), i);
		if (found != m_replaced.end() && *found == i)
		{
			return m_replacing_bytes.data() + static_cast<std::size_t>(found - m_replaced.begin()) * m_size;
		}
	}
	return m_bytes.empty() ? nullptr : m_bytes.data() + i * m_stride;
}

double GltfValues::number(std::size_t i, std::size_t component) const
{
	const char* at = elementAt(i);
	if (at == nullptr)
	{
		return 0.0;
	}
	at += component * bytesOfComponent(m_component);
	switch (m_component)
	{
	case 5120: return wholeAt<int8_t>(at, m_normalized, 127.0);
	case 5121: return wholeAt<uint8_t>(at, m_normalized, 255.0);
	case 5122: return wholeAt<int16_t>(at, m_normalized, 32767.0);
	case 5123: return wholeAt<uint16_t>(at, m_normalized, 65535.0);
	case 5125: return wholeAt<uint32_t>(at, m_normalized, 4294967295.0);
	default: return static_cast<double>(valueAt<float>(at));
	}
}

glm::dvec2 GltfValues::vec2(std::size_t i) const
{
	return {number(i, 0), number(i, 1)};
}

glm::dvec3 GltfValues::vec3(std::size_t i) const
{
	return {number(i, 0), number(i, 1), number(i, 2)};
}

uint32_t GltfValues::index(std::size_t i) const
{
	const char* const at = elementAt(i);
	return at == nullptr ? 0 : indexAt(at, m_component);
}

} // namespace nook
