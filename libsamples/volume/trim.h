// SPDX-License-Identifier: GPL-3.0-or-later
// Shortens volumes where sampled receivers lose little, so that fewer fragments are drawn.
#pragma once

#include "core/progress.h"
#include "core/round.h"
#include "scene/tracer.h"
#include "volume/receivers.h"
#include "volume/volumes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

struct TrimSettings
{
	// Loss allowed at a receiver, in (0, 1], relative to the summed occlusion of all volumes there, or to kTrimFloor if greater.
	double share = 0.1;
	ReceiverSettings receivers{8, 10000, 220000, 0, 7}; // the receivers to trim for
	// A share is a volume's contribution to a receiver, 8 to 16 bytes. Above the greater of both limits, random receivers are
	// dropped.
	std::size_t most_shares = std::size_t{1} << 25U;
	std::size_t shares_each = 64; // average per volume
};

inline constexpr double kTrimFloor = 0.05;

struct TrimCounts
{
	std::size_t receivers = 0;  // evaluated
	std::size_t left_out = 0;   // dropped because of the limit on shares
	std::size_t whole = 0;      // volumes left as they are because fewer than four receivers have a share of them
	std::size_t shares = 0;     // contributions of single volumes to receivers
	std::size_t lost = 0;       // shares removed
	std::size_t trimmed = 0;    // number of trimmed volumes
	double mean_reach = 1.0;    // over all volumes, along the normal
	double surface = 1.0;       // trimmed relative to original surface, estimated, for volumes with at least four receivers
	double greatest_loss = 0.0; // greatest loss of occlusion at those receivers
	double mean_loss = 0.0;
};

// Sets Occluder::reach and side_reach of the set's polygons, which must be 1, in the steps of files: multiples of 1/128, and of 1/8
// of that. A volume with a contribution to fewer than four receivers keeps its reach. Same result for any thread count.
TrimCounts trimVolumes(VolumeSet& volumes, const Tracer& tracer, const TrimSettings& settings, const RunSettings& run);

// Likewise for given receivers and, with a tracer, for points seen by polygons whose volumes contribute to fewer than four of them.
TrimCounts trimVolumes(VolumeSet& volumes, std::span<const ReferencePoint> receivers, const TrimSettings& settings,
					   const RunSettings& run, const Tracer* tracer = nullptr);

// How far a volume must reach to contain a point, relative to the distance: along its normal, and beyond its edges.
struct VolumeReach
{
	float height = 1.0F;
	float side = 1.0F;
};

// For trim.cpp: one volume that is made lower or narrower step by step, and what receivers may lose by it.

// A volume's contribution to one receiver, in eight bytes, because there are many.
class TrimPart
{
public:
	TrimPart(uint32_t receiver, float occlusion, VolumeReach needed);

	uint32_t receiver() const
	{
		return m_receiver;
	}

	// The given value, rounded up by at most a factor of 1 + 2⁻¹⁰.
	double occlusion() const
	{
		return static_cast<double>(bitsAs<float>(((m_bits >> 17U) + kLeastExponent) << 13U));
	}

	// The greatest reach, in the steps of files, that excludes the receiver: multiples of 1/128 and of 1/1024.
	VolumeReach reach() const
	{
		return {static_cast<float>(height()) / 1024.0F, static_cast<float>(side()) / 1024.0F};
	}

	// The greatest step in 1/1024 of a way (lower, narrower, both) that excludes the receiver; 0: none does.
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
	uint32_t m_bits; // from the top: five bits of exponent and ten of fraction, seven of height, ten of side
};

// How much each receiver has lost, and may still lose.
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

	// The squared fraction of the receiver's total, or of kTrimFloor: a volume's border is an edge, and two faint edges are less
	// visible than one of their sum.
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
	struct Receiver // together in memory, since each part accesses another receiver
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

	// Keeps a reference to the parts and reorders them.
	Shrinking(const VolumeSet& volumes, const Occluder& polygon, std::span<TrimPart> parts);

	// Approximate surface of such a volume, in squared distances: four times its average fragments in a view.
	double surface(VolumeReach reach) const;

	// Repeatedly removes what saves most, while the loss is below `price` per squared distance saved.
	void shrink(TrimAllowances& allowances, double price);

	// The resulting reach in the steps of files. Parts between it and the next receiver are not lost.
	VolumeReach finish(TrimAllowances& allowances);

	std::size_t lost() const // number of parts
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

	struct Place
	{
		uint64_t order = 0; // distance from the outside, then the lowest receiver
		uint32_t part = 0;

		bool operator<(const Place& other) const
		{
			return order < other.order;
		}
	};

	Place placeOf(int way, uint32_t part) const;
	void findFirst();
	void look(int way, const TrimAllowances& allowances, double price, Step& best) const;

	std::span<TrimPart> m_parts; // remaining parts first, then lost ones
	std::size_t m_left = 0;
	std::array<uint32_t, kWays> m_first{}; // the outermost remaining part of each way
	double m_area = 0.0;                   // polygon area, in squared distances
	double m_outline = 0.0;                // polygon perimeter, in distances
	double m_mitres = 0.0;                 // growth at corners, in squares of the side
	double m_sides = 1.0;
	VolumeReach m_reach;
};

} // namespace nook
