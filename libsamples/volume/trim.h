// SPDX-License-Identifier: GPL-3.0-or-later
// Shortens volumes where sampled receivers lose little, so that fewer fragments are drawn.
#pragma once

#include "core/progress.h"
#include "core/round.h"
#include "scene/tracer.h"
#include "volume/receivers.h"
#include "volume/volumes.h"

#include <algorithm>
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

// A volume's contribution to one receiver, in eight bytes, because there are many.
class TrimPart
{
public:
	TrimPart() = default;
	TrimPart(uint32_t receiver, float occlusion, VolumeReach needed) : m_receiver(receiver)
	{
		const uint32_t fraction = bitsAs<uint32_t>(std::max(occlusion, 0x1p-31F)) + 0x1fffU;
		const uint32_t height = std::min(static_cast<uint32_t>(needed.height * 128.0F), 127U);
		const uint32_t side = std::min(static_cast<uint32_t>(needed.side * 1024.0F), 1023U);
		m_bits = std::min((fraction >> 13U) - kLeastExponent, 0x7fffU) << 17U | height << 10U | side;
	}

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

	// The greatest reach in 1/1024 that excludes the receiver by a way: lower, narrower, both. 0: none does.
	uint32_t along(int way) const
	{
		return way == 0 ? height() : way == 1 ? side() : std::max(height(), side());
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

	uint32_t m_receiver = 0;
	uint32_t m_bits = 0; // from the top: five bits of exponent and ten of fraction, seven of height, ten of side
};

} // namespace nook
