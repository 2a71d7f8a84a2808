// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/error_points.h"

#include "core/content_hash.h"
#include "core/lists.h"
#include "core/work_units.h"
#include "methods/method_table.h"
#include "shade/gl_context.h"
#include "study/fit.h"
#include "study/measure_view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

// Rays are slow and their times steady.
constexpr int kRayRepetitions = 2;

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

using Draw = std::function<std::vector<float>(const Candidate&)>;

// With the strength and the power that suit this view.
ScreenLimit limitWith(const ViewBench& on, const SliceSettings& slices, std::span<const char> counted, const Draw& draw)
{
	Candidate candidate;
	candidate.shade.method = ShadeMethod::slices;
	candidate.shade.slices = slices;
	candidate.shade.filter = ShadeFilter::none;
	std::vector<float> visibility = draw(candidate);
	const ShapeView view = shapeView(0, visibility, on.reference().visibility, counted);
	const CurveShape shape = fitShape({&view, 1});
	for (float& v : visibility)
	{
		v = static_cast<float>(std::pow(std::max(0.0, 1.0 - shape.strength * (1.0 - static_cast<double>(v))), shape.power));
	}
	return {slices.thickness, shape.strength, shape.power, on.errorsOf(visibility)};
}

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
	ErrorPoint point{
		candidate.name(), candidate.method(), candidate.origin, candidate.count, candidate.resolution(), {}, {}, false, {}};
	point.measured = known(hash, [&] { return on.measure(candidate, how); });
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
	return known(hash, [&] { return on.flicker(candidate, m_measure, m_shifts); });
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
	return {bench.hash, on.gbuffer().depth.size(), bench.level.triangles.size(), m_measure.repetitions};
}

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

ScreenLimit screenLimitOf(const ViewBench& on, const Draw& draw, const RunSettings& run)
{
	const std::vector<char> counted = surfacesOf(on.gbuffer());
	std::optional<ScreenLimit> best;
	constexpr std::array<double, 5> kThicknesses{0.25, 0.5, 0.75, 1.0, 2.0};
	constexpr std::array<int, 2> kStepCounts{8, 32}; // more find what is thin, fewer let more light through
	ProgressCounter progress(run.progress, "limit", kThicknesses.size() * kStepCounts.size());
	for (const int steps : kStepCounts)
	{
		for (const double thickness : kThicknesses)
		{
			const ScreenLimit found = limitWith(on, {16, steps, thickness}, counted, draw);
			if (!best || found.errors.rmse < best->errors.rmse)
			{
				best = found;
			}
			progress.finishOne();
		}
	}
	return *best;
}

void visit(Archive& archive, ScreenLimit& limit)
{
	archive(limit.thickness, limit.strength, limit.power, limit.errors);
}

} // namespace nook
