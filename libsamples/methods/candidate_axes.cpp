// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/candidate_axes.h"

#include <array>

namespace nook
{

std::vector<FilterChoice> filtersFor(GridSize size)
{
	return upTo<FilterChoice>(size, {kFive}, {kFive, kWindow}, {kNoFilter, kFive, kNine, kWindow});
}

CandidateAxes oursAxes(GridSize size, const std::vector<int>& counts)
{
	CandidateAxes axes;
	axes.counts = counts;
	axes.sources =
		upTo<SampleSource>(size, {SampleSource::tile}, {SampleSource::tile}, {SampleSource::tile, SampleSource::refined});
	axes.filters = filtersFor(size);
	return axes;
}

CandidateAxes fittedAxes(GridSize size, SampleSource source, const std::vector<int>& counts)
{
	CandidateAxes axes;
	axes.counts = counts;
	axes.sources = {source};
	axes.filters = filtersFor(size);
	axes.half = kBothResolutions;
	axes.rays = {true};
	return axes;
}

} // namespace nook
