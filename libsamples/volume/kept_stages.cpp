// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/kept_stages.h"

#include "core/byte_lists.h"
#include "core/byte_text.h"

#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::size_t TrimCounts::*, 6> kWhole{&TrimCounts::receivers, &TrimCounts::left_out, &TrimCounts::whole,
														  &TrimCounts::shares,    &TrimCounts::lost,     &TrimCounts::trimmed};
constexpr std::array<double TrimCounts::*, 4> kNumbers{&TrimCounts::mean_reach, &TrimCounts::surface, &TrimCounts::greatest_loss,
													   &TrimCounts::mean_loss};

constexpr std::array kOccluderCounts{
	&OccluderCounts::triangles,  &OccluderCounts::proxies,    &OccluderCounts::polygons,   &OccluderCounts::two_sided,
	&OccluderCounts::corners,    &OccluderCounts::regions,    &OccluderCounts::with_holes, &OccluderCounts::fallbacks,
	&OccluderCounts::duplicates, &OccluderCounts::reversed,   &OccluderCounts::thin,       &OccluderCounts::uncut,
	&OccluderCounts::clear,      &OccluderCounts::components, &OccluderCounts::closed,     &OccluderCounts::sealed};
constexpr std::array kSideCounts{&ReceiverSides::inside_sides, &ReceiverSides::unseen_sides, &ReceiverSides::check_rays,
								 &ReceiverSides::check_missed};
constexpr std::size_t kOccluderBytes = 25;

// Lists of a byte or eight each, in the order of their making.
template <class Sides, class Visit> void forLists(Sides& sides, const Visit& visit)
{
	visit(sides.materials.oriented);
	visit(sides.materials.fronts);
	visit(sides.materials.backs);
	visit(sides.there);
	visit(sides.outside);
	visit(sides.seen);
}

bool isReach(float value)
{
	return value >= 0.0F && value <= 1.0F;
}

} // namespace

std::string savedDetail(const DetailChoice& choice)
{
	ByteWriter out;
	out.number(choice.detail);
	out.whole(choice.points);
	out.whole(choice.trials.size());
	for (const DetailTrial& trial : choice.trials)
	{
		out.number(trial.detail);
		out.whole(trial.polygons);
		out.number(trial.paper_rmse);
		out.number(trial.fitted_rmse);
	}
	return out.take();
}

bool loadDetail(std::string_view bytes, DetailChoice& choice)
{
	ByteReader in(bytes);
	choice.detail = in.number();
	choice.points = static_cast<std::size_t>(in.whole());
	choice.trials.resize(in.count(32));
	for (DetailTrial& trial : choice.trials)
	{
		trial.detail = in.number();
		trial.polygons = in.whole();
		trial.paper_rmse = in.number();
		trial.fitted_rmse = in.number();
	}
	return in.isAtEnd() && choice.detail >= 0.0;
}

std::string savedOccluding(const Occluding& found)
{
	ByteWriter out;
	for (const auto member : kOccluderCounts)
	{
		out.whole(found.counts.*member);
	}
	out.number(found.counts.extent_m);
	out.number(found.counts.deviation_m);
	addList(out, found.occluders.corners);
	out.whole(found.occluders.polygons.size());
	for (const Occluder& polygon : found.occluders.polygons)
	{
		out.small(polygon.first_corner);
		out.small(polygon.corner_count);
		out.small(polygon.triangle);
		out.number(polygon.alpha);
		out.byte(polygon.two_sided ? 1 : 0);
		out.number(polygon.reach);
		out.number(polygon.side_reach);
	}
	return out.take();
}

bool loadOccluding(std::string_view bytes, Occluding& found)
{
	ByteReader in(bytes);
	for (const auto member : kOccluderCounts)
	{
		found.counts.*member = in.whole();
	}
	found.counts.extent_m = in.number();
	found.counts.deviation_m = in.number();
	takeList(in, found.occluders.corners);
	found.occluders.polygons.resize(in.count(kOccluderBytes));
	for (Occluder& polygon : found.occluders.polygons)
	{
		polygon.first_corner = in.small();
		polygon.corner_count = in.small();
		polygon.triangle = in.small();
		polygon.alpha = in.single();
		polygon.two_sided = in.byte() != 0;
		polygon.reach = in.single();
		polygon.side_reach = in.single();
	}
	return in.isAtEnd();
}

std::string savedSides(const ReceiverSides& sides)
{
	ByteWriter out;
	for (const auto member : kSideCounts)
	{
		out.whole(sides.*member);
	}
	forLists(sides, [&](const auto& list) { addList(out, list); });
	return out.take();
}

bool loadSides(std::string_view bytes, ReceiverSides& sides)
{
	ByteReader in(bytes);
	for (const auto member : kSideCounts)
	{
		sides.*member = in.whole();
	}
	forLists(sides, [&](auto& list) { takeList(in, list); });
	return in.isAtEnd();
}

std::string savedTrim(const VolumeSet& volumes, const TrimCounts& counts)
{
	ByteWriter out;
	for (const auto member : kWhole)
	{
		out.whole(counts.*member);
	}
	for (const auto member : kNumbers)
	{
		out.number(counts.*member);
	}
	out.whole(volumes.occluders.polygons.size());
	for (const Occluder& polygon : volumes.occluders.polygons)
	{
		out.number(polygon.reach);
		out.number(polygon.side_reach);
	}
	return out.take();
}

bool loadTrim(std::string_view bytes, VolumeSet& volumes, TrimCounts& counts)
{
	ByteReader in(bytes);
	TrimCounts found;
	for (const auto member : kWhole)
	{
		found.*member = static_cast<std::size_t>(in.whole());
	}
	for (const auto member : kNumbers)
	{
		found.*member = in.number();
	}
	std::vector<VolumeReach> reaches(in.count(8));
	bool well = reaches.size() == volumes.occluders.polygons.size();
	for (VolumeReach& reach : reaches)
	{
		reach = {in.single(), in.single()};
		well = well && isReach(reach.height) && isReach(reach.side);
	}
	if (!well || !in.isAtEnd())
	{
		return false;
	}
	for (std::size_t i = 0; i < reaches.size(); ++i)
	{
		volumes.occluders.polygons[i].reach = reaches[i].height;
		volumes.occluders.polygons[i].side_reach = reaches[i].side;
	}
	counts = found;
	return true;
}

} // namespace nook
