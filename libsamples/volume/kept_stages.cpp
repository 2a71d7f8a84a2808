// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/kept_stages.h"

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
