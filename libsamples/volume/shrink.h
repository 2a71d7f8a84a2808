// SPDX-License-Identifier: GPL-3.0-or-later
// Part of trim.cpp: one volume that is made lower or narrower step by step, and what receivers may lose by that.
#pragma once

#include "volume/trim.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

// What one volume gives to one receiver, in eight bytes: there are many.
class TrimPart
{
public:
	TrimPart(uint32_t receiver, float occlusion, VolumeReach needed);

	uint32_t receiver() const
	{
		return m_receiver;
	}

	// As asked, or up to 2⁻¹⁰ of that more.
	double occlusion() const
	{
		return static_cast<double>(std::bit_cast<float>(((m_bits >> 17U) + kLeastExponent) << 13U));
	}

	// The greatest reach of volumes, as files have them, that leaves it out: multiples of 1/128 and of 1/1024.
	VolumeReach reach() const
	{
		return {static_cast<float>(height()) / 1024.0F, static_cast<float>(side()) / 1024.0F};
	}

	// The greatest of a grid's steps of a way that leaves it out, in 1/1024: lower, narrower, both. 0: there is none.
	uint32_t along(int way, uint32_t step) const
	{
		return (way == 0 ? height() : way == 1 ? side() : std::max(height(), side())) / step * step;
	}

private:
	uint32_t height() const
	{
		return (m_bits >> 7U) & 1016U;
	}
	uint32_t side() const
	{
		return m_bits & 1023U;
	}

	static constexpr uint32_t kLeastExponent = 96U << 10U; // of 2⁻³¹

	uint32_t m_receiver;
	uint32_t m_bits; // from the top: five of an exponent and ten of a fraction, seven of the height, ten of the side
};

// How much each receiver has lost, and may lose.
class TrimAllowances
{
public:
	TrimAllowances(const std::vector<double>& sums, double share) : m_share(share), m_receivers(sums.size())
	{
		for (std::size_t i = 0; i < sums.size(); ++i)
		{
			m_receivers[i].most = share * std::max(sums[i], kTrimFloor);
		}
	}

	// The square of its share of what its receiver gets from all volumes, or of kTrimFloor: where a volume ends is an edge, and two
	// faint ones are less visible than one of both.
	double lossOf(const TrimPart& part) const
	{
		const double share = m_share * part.occlusion() / m_receivers[part.receiver()].most;
		return share * share;
	}

	bool canTake(const TrimPart& part) const
	{
		const Receiver& receiver = m_receivers[part.receiver()];
		return receiver.lost + part.occlusion() <= receiver.most;
	}

	void take(const TrimPart& part)
	{
		m_receivers[part.receiver()].lost += part.occlusion();
	}

	void giveBack(const TrimPart& part)
	{
		m_receivers[part.receiver()].lost -= part.occlusion();
	}

	void describe(TrimCounts& counts) const
	{
		for (const Receiver& receiver : m_receivers)
		{
			counts.greatest_loss = std::max(counts.greatest_loss, receiver.lost);
			counts.mean_loss += receiver.lost / static_cast<double>(m_receivers.size());
		}
	}

private:
	struct Receiver // one place in memory: each part is at another
	{
		double lost = 0.0;
		double most = 0.0;
	};

	double m_share;
	std::vector<Receiver> m_receivers;
};

// A volume that is made smaller step by step.
class Shrinking
{
public:
	Shrinking() = default; // keeps its reach

	// Keeps the parts, and changes their order.
	Shrinking(const VolumeSet& volumes, const Occluder& polygon, std::span<TrimPart> parts);

	// About the surface of such a volume, in squares of the distance: four times the fragments of a view, on average.
	double surface(VolumeReach reach) const;

	// Takes away what saves most, with losses of `price` for a square of the distance, over and over.
	void shrink(TrimAllowances& allowances, double price);

	// The reach that is left, as files have it. What lies between it and the next receiver is not lost.
	VolumeReach finish(TrimAllowances& allowances);

	std::size_t lost() const // parts
	{
		return m_parts.size() - m_left;
	}

private:
	// Ways to make it smaller: lower, narrower, both.
	static constexpr int kWays = 3;
	static VolumeReach cutTo(int way, VolumeReach reach, uint32_t along);

	struct Step
	{
		double value = 0.0;
		VolumeReach reach;
	};

	void look(int way, const TrimAllowances& allowances, double price, Step& best) const;

	std::span<TrimPart> m_parts; // those that are left, then those that are lost
	std::size_t m_left = 0;
	double m_area = 0.0;    // of the polygon, in squares of the distance
	double m_outline = 0.0; // of the polygon, in distances
	double m_mitres = 0.0;  // by how many squares of the side it grows at corners
	double m_sides = 1.0;
	VolumeReach m_reach;
};

} // namespace nook
