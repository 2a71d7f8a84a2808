// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of an accessor of a checked glTF file: any component type, normalised or not, strided, sparse, or zeros.
#pragma once

#include "scene/gltf_file.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace nook
{

class GltfValues
{
public:
	// Throws Error (invalid_input) if sparse indices are not ascending or exceed the count. The file must outlive this object.
	GltfValues(GltfFile& file, std::size_t accessor);

	std::size_t count() const
	{
		return m_count;
	}
	double number(std::size_t i, std::size_t component) const;
	glm::dvec2 vec2(std::size_t i) const;
	glm::dvec3 vec3(std::size_t i) const;
	uint32_t index(std::size_t i) const; // for unsigned integers

private:
	const char* elementAt(std::size_t i) const; // null: zeros

	std::size_t m_count = 0;
	uint64_t m_component = 0; // 5120 … 5126
	bool m_normalized = false;
	std::size_t m_size = 0; // element size in bytes
	std::size_t m_stride = 0;
	std::string_view m_bytes;           // from the first element; empty: zeros
	std::vector<uint32_t> m_replaced;   // indices replaced by a sparse accessor, ascending
	std::string_view m_replacing_bytes; // their values, packed
};

// Size of a component type (5120 to 5126) in bytes, and number of components of "SCALAR" to "MAT4"; 0 for anything else.
std::size_t bytesOfComponent(uint64_t component);
std::size_t componentsOf(std::string_view type);

} // namespace nook
