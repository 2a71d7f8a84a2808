// SPDX-License-Identifier: GPL-3.0-or-later
// The form factors of four polygons at one receiver.
#pragma once

#include "methods/volume_kernels.h"
#include "volume/lanes.h"
#include "volume/volumes.h"

#include <algorithm>
#include <array>
#include <span>

namespace nook
{

// nookArc()
inline Floats arcOf(const Floats& x)
{
	const Floats p = 0.522759580F + x * (-0.345475831F + x * (0.152677448F - x * 0.0317200786F));
	return 1.57079595F + x * (-0.999943104F + x * (0.783984789F + x * (-0.653083218F + x * p)));
}

// nookFormFactor() of the polygons among `held`; repeated corners change nothing. Edges that appear nearly as long as half a turn
// take more digits: the kernel itself evaluates such polygons.
inline Floats formFactors(std::span<const Vectors> corners, const Vectors& n, const Floats& side, const Ints& held)
{
	const Floats upward = n.z < 0.0F ? Floats{} - 1.0F : Floats{} + 1.0F;
	const Floats q = -1.0F / (upward + n.z);
	const Floats mixed = n.x * n.y * q;
	const Vectors right{1.0F + upward * n.x * n.x * q, upward * mixed, -upward * n.x};
	const Vectors forward{mixed, upward + n.y * n.y * q, -n.y};
	const auto directionOf = [&](const Vectors& corner)
	{
		const Vectors away = corner * unitOf(corner);
		return Vectors{dotOf(away, right), dotOf(away, forward), dotOf(away, n)};
	};
	Vectors from = directionOf(corners.back());
	Floats edges{};
	Vectors cut{Floats{} + 1.0F, Floats{}, Floats{}};
	Ints hard{};
	for (const Vectors& corner : corners)
	{
		const Vectors to = directionOf(corner);
		const Ints above = held & ((from.z > 0.0F) | (to.z > 0.0F));
		if (anyOf(above))
		{
			Floats cosine = dotOf(from, to);
			Vectors first = from;
			Vectors last = to;
			hard |= above & (cosine < -0.95F);
			const Ints exits = above & (to.z <= 0.0F);
			const Ints crosses = exits | (above & (from.z <= 0.0F));
			if (anyOf(crosses))
			{
				const Floats wa = magnitudeOf(to.z);
				const Floats wb = magnitudeOf(from.z);
				Vectors node{from.x * wa + to.x * wb, from.y * wa + to.y * wb, Floats{}};
				node = node * unitOf(node);
				first = chosen(crosses & ~exits, node, from);
				last = chosen(exits, node, to);
				cosine = dotOf(first, last);
				const Floats turn = exits ? node.y : -node.y;
				cut = chosen(crosses, {cut.x * node.x - cut.y * turn, cut.x * turn + cut.y * node.x, Floats{}}, cut);
			}
			const Floats sine = last.x * first.y - last.y * first.x;
			const Floats term = sine * arcOf(magnitudeOf(cosine));
			const Ints obtuse = above & (cosine < 0.0F);
			const Floats rest = anyOf(obtuse) ? 3.14159265F * (sine / rootOf(1.0F - cosine * cosine)) - term : term;
			edges += above ? (obtuse ? rest : term) : Floats{};
		}
		from = to;
	}
	const Floats arc = arcOf(magnitudeOf(cut.x));
	const Floats rise = side * cut.y;
	const Floats cuts = cut.x < 0.0F ? 3.14159265F - arc * magnitudeOf(rise) : arc * rise;
	Floats factor = (side * edges + cuts) * 0.159154943F;
	factor = factor > 0.0F ? factor : Floats{};
	factor = factor < 1.0F ? factor : Floats{} + 1.0F;
	for (std::size_t lane = 0; anyOf(hard) && lane < 4; ++lane)
	{
		if (hard[lane] != 0)
		{
			std::array<glm::vec3, kMaxOccluderCorners> of_lane;
			std::transform(corners.begin(), corners.end(), of_lane.begin(), [lane](const Vectors& v) { return laneOf(v, lane); });
			volume_kernels::Kernels kernels;
			kernels.corners = of_lane;
			factor[lane] = kernels.nookFormFactor(static_cast<int>(corners.size()), laneOf(n, lane), side[lane]);
		}
	}
	return factor;
}

} // namespace nook
