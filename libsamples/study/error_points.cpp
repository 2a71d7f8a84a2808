// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/error_points.h"

#include "core/content_hash.h"
#include "core/work_units.h"
#include "shade/gl_context.h"
#include "study/measurement_json.h"

#include <algorithm>

namespace nook
{
namespace
{

// Rays are slow and their times steady.
constexpr int kRayRepetitions = 2;

} // namespace

PointMeasurer::PointMeasurer(const ErrorReportSettings& settings, const RunSettings& run, ErrorReportCounts& counts)
	: m_measure(settings.measure), m_shifts(settings.shifts), m_counts(counts),
	  m_store(run.units != nullptr ? &run.units->store() : nullptr)
{
	const RendererFacts renderer = rendererOf(m_measure);
	m_context.renderer = renderer.name;
	m_context.software = renderer.software;
	m_context.threads = run.threads;
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
	ErrorPoint point{candidate.name(), candidate.method(), candidate.origin, candidate.count, candidate.resolution(), {}, {}, false, {}};
	if (const std::optional<Measurement> known = m_store != nullptr ? m_store->get<Measurement>(hash) : std::nullopt)
	{
		m_counts.cached += 1;
		point.measured = *known;
		return point;
	}
	m_counts.measured += 1;
	point.measured = on.measure(candidate, how);
	if (m_store != nullptr)
	{
		keepOrFail([&] { m_store->put(hash, point.measured); });
	}
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
	if (const std::optional<double> known = m_store != nullptr ? m_store->get<double>(hash) : std::nullopt)
	{
		m_counts.cached += 1;
		return *known;
	}
	m_counts.measured += 1;
	double found = on.flicker(candidate, m_measure, m_shifts);
	if (m_store != nullptr)
	{
		keepOrFail([&] { m_store->put(hash, found); });
	}
	return found;
}

Reference PointMeasurer::reference(const std::string& hash, const std::function<Reference()>& trace)
{
	if (m_store == nullptr)
	{
		return trace();
	}
	Reference found;
	const auto compute = [&]
	{
		found = trace();
		return true;
	};
	keepOrFail([&] { m_store->once("reference " + hash, compute, [&](Archive& archive) { archive(found); }); });
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
