// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle's texture coordinates, as a function of the position in its plane.
#pragma once

#include "volume/surface.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>

namespace nook::detail
{

// Texture coordinates as a function of position: exact at the triangle's corners, constant across its plane.
struct TextureMap
{
	glm::dvec3 origin{0.0};
	glm::dvec2 at_origin{0.0};
	glm::dvec3 u{0.0}; // gradients, 1/m
	glm::dvec3 v{0.0};

	glm::dvec2 at(glm::dvec3 position) const;
};
TextureMap textureMapOf(const Soup& soup, std::size_t triangle);

} // namespace nook::detail
