// SPDX-License-Identifier: GPL-3.0-or-later
// Positions of a file with full precision, where Assimp 5.2.5 rounds to 32 bits.
#pragma once

#include "scene/diagnosis.h"

#include <glm/vec3.hpp>

#include <cmath>
#include <vector>

namespace nook
{

class ExactPositions
{
public:
	void add(glm::dvec3 position)
	{
		for (int i = 0; i < 3; ++i)
		{
			const double length = std::fabs(position[i]);
			m_large = m_large || (length >= kLarge_m && length <= kFarthest_m);
		}
		m_positions.push_back(position);
	}

	// Returns nothing if 32 bits suffice: all coordinates are below kLarge_m units of the file.
	std::vector<glm::dvec3> take()
	{
		return m_large ? std::move(m_positions) : std::vector<glm::dvec3>();
	}

private:
	std::vector<glm::dvec3> m_positions;
	bool m_large = false;
};

} // namespace nook
