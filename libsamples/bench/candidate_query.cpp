// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/candidate_query.h"

#include "methods/feature_table.h"

namespace nook
{
namespace
{

bool isPlain(const Candidate& candidate)
{
	switch (candidate.kind)
	{
	case CandidateKind::screen: return candidate.scale == 1.0 && featureWords(shadeSettingsOf(candidate, 1.0)).empty();
	case CandidateKind::volumes:
		return candidate.scale == 1.0 && candidate.aov.every_px == 1 && (candidate.aov.mask || candidate.aov.compensate);
	case CandidateKind::bake:
	case CandidateKind::rays: break;
	}
	return true;
}

template <class Value> bool agrees(const std::optional<Value>& wanted, const Value& found)
{
	return !wanted || *wanted == found;
}

} // namespace

bool fits(const Candidate& candidate, const CandidateQuery& query)
{
	const bool screen = candidate.kind == CandidateKind::screen;
	return candidate.kind != CandidateKind::bake && candidate.row() == query.row && agrees(query.count, candidate.count) &&
		   (!screen || (agrees(query.source, candidate.source) && agrees(query.filter, candidate.shade.filter))) &&
		   (candidate.kind != CandidateKind::volumes || agrees(query.volumes, candidate.volumes)) && isPlain(candidate);
}

} // namespace nook
