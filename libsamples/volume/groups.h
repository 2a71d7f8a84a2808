// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers 0 to n − 1 in sets that are joined (union-find).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace nook::detail
{

// Sets with the least member as their name.
class Groups
{
public:
	explicit Groups(std::size_t count) : m_parents(count)
	{
		std::iota(m_parents.begin(), m_parents.end(), 0U);
	}

	uint32_t of(uint32_t item)
	{
		while (m_parents[item] != item)
		{
			m_parents[item] = m_parents[m_parents[item]];
			item = m_parents[item];
		}
		return item;
	}

	void join(uint32_t a, uint32_t b)
	{
		a = of(a);
		b = of(b);
		m_parents[std::max(a, b)] = std::min(a, b);
	}

private:
	std::vector<uint32_t> m_parents;
};

} // namespace nook::detail
