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
	const VolumeReach at = part.reach();
	return at.height >= reach.height || at.side >= reach.side;
}

} // namespace

TrimPart::TrimPart(uint32_t receiver, float occlusion, VolumeReach needed) : m_receiver(receiver)
{
	const uint32_t fraction = std::bit_cast<uint32_t>(std::max(occlusion, 0x1p-31F)) + 0x1fffU;
	const uint32_t height = std::min(static_cast<uint32_t>(needed.height * 128.0F), 127U);
	const uint32_t side = std::min(static_cast<uint32_t>(needed.side * 1024.0F), 1023U);
	m_bits = std::min((fraction >> 13U) - kLeastExponent, 0x7fffU) << 17U | height << 10U | side;
}

Shrinking::Shrinking(const VolumeSet& volumes, const Occluder& polygon, std::span<TrimPart> parts)
	: m_parts(parts), m_left(parts.size())
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
}

double Shrinking::surface(VolumeReach reach) const
{
	const VolumeReach kept = rounded(reach);
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
		const auto lost = std::partition(m_parts.begin(), m_parts.begin() + static_cast<std::ptrdiff_t>(m_left),
										 [this](const TrimPart& part) { return !isBeyond(part, m_reach); });
		const auto left = static_cast<std::size_t>(lost - m_parts.begin());
		for (const TrimPart& part : m_parts.subspan(left, m_left - left))
		{
			allowances.take(part);
		}
		m_left = left;
	}
}

VolumeReach Shrinking::finish(TrimAllowances& allowances)
{
	const VolumeReach reach = rounded(m_reach);
	const auto lost = std::partition(m_parts.begin() + static_cast<std::ptrdiff_t>(m_left), m_parts.end(),
									 [reach](const TrimPart& part) { return !isBeyond(part, reach); });
	const auto left = static_cast<std::size_t>(lost - m_parts.begin());
	for (const TrimPart& part : m_parts.subspan(m_left, left - m_left))
	{
		allowances.giveBack(part);
	}
	m_left = left;
	return reach;
}

VolumeReach Shrinking::cutTo(int way, VolumeReach reach, uint32_t along)
{
	const float to = static_cast<float>(along) / 1024.0F;
	return {way == 1 ? reach.height : std::min(reach.height, to), way == 0 ? reach.side : std::min(reach.side, to)};
}

// Outermost first, as long as it does not cost too much. That is seldom long: the first one is looked for by itself, others in a
// heap.
void Shrinking::look(int way, const TrimAllowances& allowances, double price, Step& best) const
{
	struct Place
	{
		uint64_t order = 0; // how far out, then the least receiver
		uint32_t part = 0;

		bool operator<(const Place& other) const
		{
			return order < other.order;
		}
	};
	const uint32_t step = way == 1 ? static_cast<uint32_t>(m_reach.height * 128.0F) : 8; // of reaches in files, in 1/1024
	const auto placeOf = [&](uint32_t part)
	{
		return Place{uint64_t{m_parts[part].along(way, step)} << 32U | ~m_parts[part].receiver(), part};
	};
	Place first;
	for (uint32_t i = 0; i < m_left; ++i)
	{
		first = std::max(first, placeOf(i));
	}
	const double now = surface(m_reach);
	const double most = price * (now - surface(cutTo(way, m_reach, 0)));
	const auto isTooMuch = [&](const TrimPart& part, double before)
	{
		return !allowances.canTake(part) || most - (before + allowances.lossOf(part)) <= best.value;
	};
	if (m_left == 0 || isTooMuch(m_parts[first.part], 0.0))
	{
		return;
	}
	thread_local std::vector<Place> places;
	places.clear();
	for (uint32_t i = 0; i < m_left; ++i)
	{
		places.push_back(placeOf(i));
	}
	std::make_heap(places.begin(), places.end());
	double loss = 0.0;
	while (!places.empty())
	{
		const Place place = places.front();
		const TrimPart& part = m_parts[place.part];
		if (place.order >> 32U == 0 || isTooMuch(part, loss))
		{
			return; // nor is anything that costs more
		}
		loss += allowances.lossOf(part);
		std::pop_heap(places.begin(), places.end());
		places.pop_back();
		if (!places.empty() && places.front().order >> 32U == place.order >> 32U)
		{
			continue; // both or none
		}
		const VolumeReach reach = cutTo(way, m_reach, static_cast<uint32_t>(place.order >> 32U));
		const double value = price * (now - surface(reach)) - loss;
		if (value > best.value)
		{
			best = {value, reach};
		}
	}
}

} // namespace nook
