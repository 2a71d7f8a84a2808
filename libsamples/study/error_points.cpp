// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/error_report.h"

#include "core/lists.h"
#include "methods/method_table.h"

#include <algorithm>
#include <cmath>

namespace nook
{
namespace
{

// Seconds of one thread, rough; measured by stages of `nook report error --quick --threads 1 --progress`
// (docs/reference/sharing.md).
constexpr double kDepth_s = 5e-8;        // of a depth that a pixel reads, on a CPU
constexpr double kPixel_s = 2e-7;        // of a pixel, whatever it reads
constexpr double kErrors_s = 1e-6;       // of a pixel of what was drawn: its errors
constexpr double kTileOfLines_s = 8e-4;  // of tiles made for windows: times count^3.5
constexpr double kTileOfPoints_s = 1e-2; // times count^2
constexpr double kElectro_s = 2e-3;      // times count^2
constexpr double kRay_s = 2e-7;
constexpr double kMoved = 0.4; // of the candidates, which are drawn four times more for their flicker

double madeOnce(const Candidate& candidate, const ViewCost& view)
{
	const auto triangles = static_cast<double>(view.triangles);
	const double count = candidate.count;
	switch (candidate.kind)
	{
	case CandidateKind::asset: return candidate.asset->make_s(candidate, triangles);
	case CandidateKind::rays: return 0.0;
	case CandidateKind::screen: break;
	}
	switch (candidate.source)
	{
	case SampleSource::tile:
		return domainOf(candidate.shade.method) == Domain::disk ? kTileOfLines_s * std::pow(count, 3.5)
																: kTileOfPoints_s * count * count;
	case SampleSource::electro:
	case SampleSource::refined: return kElectro_s * count * count;
	default: return 0.0;
	}
}

// Returns how many depths a pixel reads.
double depthsOf(const Candidate& candidate)
{
	return candidate.count * std::max(1, sampleDepths(rowOf(candidate.shade.method), candidate.shade));
}

double drawn(const Candidate& candidate, const ViewCost& view)
{
	double pixel_s = kPixel_s;
	double times = view.repetitions + 1.0 + 4.0 * kMoved;
	switch (candidate.kind)
	{
	case CandidateKind::asset: pixel_s = candidate.asset->pixel_s; break;
	case CandidateKind::rays:
		pixel_s = kRay_s * candidate.count;
		times = 3.0;
		break;
	case CandidateKind::screen: pixel_s += kDepth_s * depthsOf(candidate) * (candidate.shade.half_resolution ? 0.25 : 1.0); break;
	}
	return static_cast<double>(view.pixels) * (times * pixel_s + kErrors_s);
}

} // namespace

std::string sharedBy(const Candidate& candidate, const std::string& level)
{
	if (candidate.kind == CandidateKind::asset)
	{
		return candidate.asset->key(candidate) + " of " + level;
	}
	if (candidate.kind != CandidateKind::screen || candidate.source == SampleSource::own)
	{
		return candidate.name() + " on " + level;
	}
	return candidate.method() + " " + std::to_string(candidate.count) + " " + std::string(nameOf(candidate.source)) +
		   (candidate.shade.volume.paired ? " paired" : "") + (candidate.shade.bands.count > 1 ? " bands" : "");
}

std::vector<double> candidateSeconds(std::span<const Candidate> candidates, const ViewCost& view, std::set<std::string>& made)
{
	const auto secondsOf = [&](const Candidate& candidate)
	{
		const bool is_first = made.insert(sharedBy(candidate, view.level)).second;
		return drawn(candidate, view) + (is_first ? madeOnce(candidate, view) : 0.0);
	};
	return mapped(candidates, secondsOf);
}

} // namespace nook
