// SPDX-License-Identifier: GPL-3.0-or-later
// What claims are judged by, and the methods that they are about.
#pragma once

#include "bench/candidate_query.h"
#include "core/text.h"
#include "error_report/error_report.h"
#include "methods/method_table.h"

#include <string>
#include <utility>
#include <vector>

namespace nook
{

// The lower quartile: claims compare times that differ by a few per cent, and whatever else a machine does only adds to them.
inline double claimTime(const ErrorPoint& point)
{
	return point.measured.total.low_s;
}

// A view with the level's name: what a row is of.
struct ClaimPlace
{
	std::string name;
	const ErrorView* view = nullptr;
};
std::vector<ClaimPlace> placesOf(const ErrorReport& report);

// The methods that papers claim something of.
inline const MethodRow& claimedLines()
{
	return rowOf(ShadeMethod::vo_line);
}
inline const MethodRow& claimedPoints()
{
	return rowOf(ShadeMethod::vo_point);
}
inline const MethodRow& claimedTables()
{
	return rowOf(ShadeMethod::statvo);
}
inline const MethodRow& claimedVolumes()
{
	return volumeRow(false);
}

// The one whose best says how near any method of the picture alone can come.
inline const MethodRow& limitMethod()
{
	return rowOf(ShadeMethod::slices);
}

// Points of candidates that fit, in their order; or the first of them, null where there is none.
std::vector<const ErrorPoint*> pointsOf(const ErrorView& view, const CandidateQuery& query);
const ErrorPoint* pointOf(const ErrorView& view, const CandidateQuery& query);

// A claim, row by row.
class JudgedClaim
{
public:
	explicit JudgedClaim(ErrorClaim claim) : m_claim(std::move(claim)) {}

	// `cells` without the last one, which says whether the claim holds.
	void add(std::vector<std::string> cells, bool holds);

	// A row that cannot tell.
	void addOpen(std::vector<std::string> cells);

	// With its verdict, by the rows that can tell: confirmed where it holds in all of them, mixed in more than half.
	ErrorClaim take();

private:
	ErrorClaim m_claim;
	std::size_t m_told = 0;
	std::size_t m_held = 0;
};

// Three significant digits.
inline std::string shortText(double value)
{
	return roundedText(value, 3);
}

// error_claims_radius.cpp
ErrorClaim statVoRadius(const ErrorReport& report);
ErrorClaim samplesRadius(const ErrorReport& report);
ErrorClaim timeOverSquare(const ErrorReport& report);

} // namespace nook
