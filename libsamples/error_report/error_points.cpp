// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_report/error_points.h"

#include "core/content_hash.h"
#include "error_report/error_units.h"
#include "shade/gl_session.h"

#include <algorithm>

namespace nook
{
namespace
{

// Rays are slow and their times steady.
constexpr int kRayRepetitions = 2;

} // namespace

PointMeasurer::PointMeasurer(const ErrorReportSettings& settings, int threads, ErrorReportCounts& counts)
	: m_measure(settings.measure), m_shifts(settings.shifts), m_counts(counts), m_cache(settings.cache)
{
	const RendererFacts renderer = rendererOf(m_measure);
	m_context.renderer = renderer.name;
	m_context.software = renderer.software;
	m_context.threads = threads;
	m_context.version = settings.version;
	if (m_measure.device == Device::gl)
	{
		m_measure.session = std::make_shared<GlSession>(m_measure.gl_device);
	}
}

ErrorPoint PointMeasurer::point(ViewBench& on, const Candidate& candidate, int most)
{
	MeasureSettings how = m_measure;
	how.repetitions = std::min(how.repetitions, candidate.kind == CandidateKind::rays ? kRayRepetitions : most);
	const std::string hash = hashOf(on, candidate, how, "");
	ErrorPoint point = emptyPoint(candidate);
	const std::optional<Measurement> known = m_cache.measurement(hash);
	if (known && known->candidate == point.name && known->visibility.size() == on.gbuffer().depth.size())
	{
		m_counts.cached += 1;
		point.measured = *known;
		return point;
	}
	m_counts.measured += 1;
	point.measured = MeasurementCache::asStored(on.measure(candidate, how));
	keepOrFail([&] { m_cache.keep(hash, point.measured); });
	return point;
}

bool PointMeasurer::mayFlicker(const ErrorPoint& point) const
{
	const double slowest_s = m_measure.slowest_s; // of all that it would draw
	const bool slow = slowest_s > 0.0 && point.measured.total.median_s * m_shifts > slowest_s;
	return m_shifts >= 2 && !slow && point.origin != Origin::rays;
}

double PointMeasurer::flicker(ViewBench& on, const Candidate& candidate)
{
	const std::string hash = hashOf(on, candidate, m_measure, "flicker " + std::to_string(m_shifts));
	if (const std::optional<double> known = m_cache.number(hash))
	{
		m_counts.cached += 1;
		return *known;
	}
	m_counts.measured += 1;
	const double found = on.flicker(candidate, m_measure, m_shifts);
	keepOrFail([&] { m_cache.keep(hash, found); });
	return found;
}

std::string PointMeasurer::hashOf(ViewBench& on, const Candidate& candidate, const MeasureSettings& how,
								  const std::string& what) const
{
	ContentHash hash;
	hash.add(on.contentHash(candidate, how, m_context.version));
	hash.add(candidate.kind == CandidateKind::rays ? std::string("CPU") : m_context.renderer);
	hash.add(what);
	return hash.text();
}

ViewCost PointMeasurer::costOf(const ViewBench& on, const LevelBench& bench) const
{
	return {bench.contentHash(), on.gbuffer().depth.size(), bench.level().triangles.size(), m_measure.repetitions};
}

} // namespace nook
