// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_report/error_costs.h"

#include <cmath>
#include <set>

namespace nook
{
namespace
{

// Seconds of one thread, rough; measured by stages of `nook report error --quick --threads 1 --progress` (docs/reference/parts.md).
constexpr double kSample_s = 1e-8;       // of a sample of a pixel, drawn on a CPU
constexpr double kErrors_s = 6e-7;       // of a pixel of what was drawn: its errors
constexpr double kTileOfLines_s = 8e-4;  // of tiles made for windows: times count^3.5
constexpr double kTileOfPoints_s = 1e-2; // times count^2
constexpr double kElectro_s = 1e-3;      // times count^2
constexpr double kVolume_s = 3e-4;       // of a triangle whose volumes are built and compensated
constexpr double kVolumePixel_s = 2e-6;
constexpr double kRay_s = 2e-7;

double madeOnce(const Candidate& candidate, const ViewCost& view)
{
	if (candidate.kind == CandidateKind::volumes)
	{
		return kVolume_s * static_cast<double>(view.triangles) + 1.0;
	}
	const double count = candidate.count;
	switch (candidate.kind == CandidateKind::screen ? candidate.source : SampleSource::own)
	{
	case SampleSource::tile:
		return domainOf(candidate.shade.method) == Domain::disk ? kTileOfLines_s * std::pow(count, 3.5)
																: kTileOfPoints_s * count * count;
	case SampleSource::electro:
	case SampleSource::refined: return kElectro_s * count * count;
	default: return 0.0;
	}
}

double drawn(const Candidate& candidate, const ViewCost& view)
{
	const auto pixels = static_cast<double>(view.pixels);
	const double times = candidate.kind == CandidateKind::rays ? 3.0 : view.repetitions + 1.0;
	const double pixel_s = candidate.kind == CandidateKind::rays      ? kRay_s * candidate.count
						   : candidate.kind == CandidateKind::volumes ? kVolumePixel_s
																	  : kSample_s * (candidate.count + 10.0);
	return pixels * (times * pixel_s + kErrors_s);
}

} // namespace

std::string sharedBy(const Candidate& candidate)
{
	if (candidate.kind == CandidateKind::volumes)
	{
		return "volumes " + std::string(nameOf(candidate.volumes)) + (candidate.aov.compensate ? "" : " sum");
	}
	if (candidate.kind == CandidateKind::rays || candidate.source == SampleSource::own)
	{
		return candidate.name();
	}
	return candidate.method() + " " + std::to_string(candidate.count) + " " + std::string(nameOf(candidate.source)) +
		   (candidate.shade.volume.paired ? " paired" : "") + (candidate.shade.bands.count > 1 ? " bands" : "");
}

CandidateCosts::CandidateCosts(std::span<const Candidate> candidates, const ViewCost& view)
{
	std::set<std::string> made;
	for (const Candidate& candidate : candidates)
	{
		m_seconds.push_back(drawn(candidate, view) + (made.insert(sharedBy(candidate)).second ? madeOnce(candidate, view) : 0.0));
	}
}

} // namespace nook
