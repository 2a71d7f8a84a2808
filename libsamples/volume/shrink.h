// SPDX-License-Identifier: GPL-3.0-or-later
// Part of trim.cpp: one volume that is made lower or narrower step by step, and what receivers may lose by that.
#pragma once

#include "volume/trim.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

// What one volume gives to one receiver.
struct TrimPart
{
	uint32_t receiver = 0;
	float occlusion = 0.0F;
	VolumeReach reach; // that takes
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
		const double share = m_share * static_cast<double>(part.occlusion) / m_receivers[part.receiver].most;
		return share * share;
	}

	bool canTake(const TrimPart& part) const
	{
		const Receiver& receiver = m_receivers[part.receiver];
		return receiver.lost + static_cast<double>(part.occlusion) <= receiver.most;
	}

	void take(const TrimPart& part)
	{
		m_receivers[part.receiver].lost += static_cast<double>(part.occlusion);
	}

	void giveBack(const TrimPart& part)
	{
		m_receivers[part.receiver].lost -= static_cast<double>(part.occlusion);
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

	// Keeps a reference to the parts.
	Shrinking(const VolumeSet& volumes, const Occluder& polygon, const std::vector<TrimPart>& parts);

	// About the surface of such a volume, in squares of the distance: four times the fragments of a view, on average.
	double surface(VolumeReach reach) const;

	// Takes away what saves most, with losses of `price` for a square of the distance, over and over.
	void shrink(TrimAllowances& allowances, double price);

	// The reach that is left, as files have it. What lies between it and the next receiver is not lost.
	VolumeReach finish(TrimAllowances& allowances);

	std::size_t lost() const; // parts

private:
	// Ways to make it smaller: lower, narrower, both.
	static constexpr int kWays = 3;
	static float alongWay(int way, VolumeReach reach);
	static VolumeReach cutTo(int way, VolumeReach reach, float to);

	struct Step
	{
		double value = 0.0;
		int way = 0;
		std::size_t end = 0; // of the order: those before it go out
		VolumeReach reach;
	};

	void look(int way, const TrimAllowances& allowances, double price, Step& best) const;
	double surfaceOf(VolumeReach kept) const; // of what rounding left

	std::span<const TrimPart> m_parts;
	std::vector<bool> m_gone;
	std::array<std::vector<uint32_t>, kWays> m_orders; // of the parts that are left, outermost first
	double m_area = 0.0;                               // of the polygon, in squares of the distance
	double m_outline = 0.0;                            // of the polygon, in distances
	double m_mitres = 0.0;                             // by how many squares of the side it grows at corners
	double m_sides = 1.0;
	VolumeReach m_reach;
};

} // namespace nook
