// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/shrink.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace nook
{
namespace
{

constexpr double kSharpest = 1.0 / 16.0; // of corners, twice the cosine of half their turn: a mitre of 32 half widths

// The least whole number that is not below, of 0 to some thousands: this is asked for every part, over and over.
float roundedUp(float x)
{
	const auto whole = static_cast<float>(static_cast<int>(x));
	return whole < x ? whole + 1.0F : whole;
}

// As files have them, none less: multiples of 1/128, and of 1/8 of those.
VolumeReach rounded(VolumeReach reach)
{
	const float height = std::clamp(roundedUp(std::max(reach.height, reach.side) * 128.0F), 1.0F, 128.0F) / 128.0F;
	return {height, height * std::clamp(roundedUp(reach.side / height * 8.0F), 1.0F, 8.0F) / 8.0F};
}

// Is the part out of such a volume?
bool isBeyond(const TrimPart& part, VolumeReach reach)
{
	return part.reach.height >= reach.height || part.reach.side >= reach.side;
}

} // namespace

Shrinking::Shrinking(const VolumeSet& volumes, const Occluder& polygon, const std::vector<TrimPart>& parts) : m_parts(parts)
{
	const std::span<const glm::dvec3> corners = volumes.occluders.cornersOf(polygon);
	glm::dvec3 across(0.0);
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		const glm::dvec3 next = corners[(i + 1) % corners.size()];
		across += glm::cross(corners[i] - corners[0], next - corners[0]) * (0.5 / (volumes.distance_m * volumes.distance_m));
		m_outline += glm::length(next - corners[i]) / volumes.distance_m;
		// The half angle's tangent of the turn, for unit vectors, of which exact bounds keep up to some 64.
		const glm::dvec3 before = glm::normalize(corners[i] - corners[(i + corners.size() - 1) % corners.size()]);
		const glm::dvec3 after = glm::normalize(next - corners[i]);
		m_mitres += glm::length(before - after) / std::max(glm::length(before + after), kSharpest);
	}
	m_area = glm::length(across);
	m_sides = polygon.two_sided ? 2.0 : 1.0;
	m_gone.assign(parts.size(), false);
	struct Place
	{
		float along = 0.0F;
		uint32_t receiver = 0;
		uint32_t part = 0;
	};
	std::vector<Place> places(parts.size());
	for (int way = 0; way < kWays; ++way)
	{
		for (std::size_t i = 0; i < parts.size(); ++i)
		{
			places[i] = {alongWay(way, parts[i].reach), parts[i].receiver, static_cast<uint32_t>(i)};
		}
		std::sort(places.begin(), places.end(),
				  [](const Place& a, const Place& b) { return a.along != b.along ? a.along > b.along : a.receiver < b.receiver; });
		std::vector<uint32_t>& order = m_orders[static_cast<std::size_t>(way)];
		order.reserve(parts.size());
		for (const Place& place : places)
		{
			order.push_back(place.part);
		}
	}
}

double Shrinking::surface(VolumeReach reach) const
{
	return surfaceOf(rounded(reach));
}

double Shrinking::surfaceOf(VolumeReach kept) const
{
	const auto side = static_cast<double>(kept.side);
	const double area = m_area + (m_outline + m_mitres * side) * side;
	return 2.0 * area + (m_outline + 2.0 * m_mitres * side) * static_cast<double>(kept.height) * m_sides;
}

void Shrinking::shrink(TrimAllowances& allowances, double price)
{
	for (;;)
	{
		Step best;
		for (int way = 0; way < kWays; ++way)
		{
			look(way, allowances, price, best);
		}
		if (best.value <= 0.0)
		{
			return;
		}
		m_reach = best.reach;
		const std::vector<uint32_t>& order = m_orders[static_cast<std::size_t>(best.way)];
		for (std::size_t i = 0; i < best.end; ++i)
		{
			m_gone[order[i]] = true;
			allowances.take(m_parts[order[i]]);
		}
		for (std::vector<uint32_t>& left : m_orders)
		{
			std::erase_if(left, [this](uint32_t part) { return m_gone[part]; });
		}
	}
}

VolumeReach Shrinking::finish(TrimAllowances& allowances)
{
	const VolumeReach reach = rounded(m_reach);
	for (std::size_t i = 0; i < m_parts.size(); ++i)
	{
		if (m_gone[i] && !isBeyond(m_parts[i], reach))
		{
			m_gone[i] = false;
			allowances.giveBack(m_parts[i]);
		}
	}
	return reach;
}

std::size_t Shrinking::lost() const
{
	return static_cast<std::size_t>(std::count(m_gone.begin(), m_gone.end(), true));
}

float Shrinking::alongWay(int way, VolumeReach reach)
{
	return way == 0 ? reach.height : way == 1 ? reach.side : std::max(reach.height, reach.side);
}

VolumeReach Shrinking::cutTo(int way, VolumeReach reach, float to)
{
	return {way == 1 ? reach.height : std::min(reach.height, to), way == 0 ? reach.side : std::min(reach.side, to)};
}

void Shrinking::look(int way, const TrimAllowances& allowances, double price, Step& best) const
{
	const std::vector<uint32_t>& order = m_orders[static_cast<std::size_t>(way)];
	const double now = surface(m_reach);
	const double least = surface(cutTo(way, m_reach, 0.0F));
	double loss = 0.0;
	VolumeReach last{0.0F, 0.0F};
	for (std::size_t i = 0; i < order.size(); ++i)
	{
		const TrimPart& part = m_parts[order[i]];
		if (!allowances.canTake(part))
		{
			return;
		}
		loss += allowances.lossOf(part);
		if (price * (now - least) - loss <= best.value)
		{
			return; // nor is anything that costs more
		}
		const VolumeReach reach = cutTo(way, m_reach, alongWay(way, part.reach));
		const VolumeReach kept = rounded(reach);
		if (kept.height == last.height && kept.side == last.side)
		{
			continue; // saves no more than the one before, and costs more
		}
		last = kept;
		const double value = price * (now - surfaceOf(kept)) - loss;
		if (value > best.value)
		{
			best = {value, way, i + 1, reach};
		}
	}
}

} // namespace nook
