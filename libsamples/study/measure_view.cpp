// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/measure_view.h"

#include "core/content_hash.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/parallel.h"
#include "core/system.h"
#include "core/text.h"
#include "image/compare.h"
#include "methods/feature_table.h"
#include "scene/describe.h"
#include "scene/reference.h"
#include "shade/gl_context.h"
#include "shade/shade.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace nook
{

void visit(Archive& archive, TimeSpread& spread)
{
	archive(spread.name, spread.median_s, spread.low_s, spread.high_s);
}

void visit(Archive& archive, ViewErrors& errors)
{
	archive(errors.eq14, errors.rmse, errors.flip, errors.ssim, errors.mean_error, errors.best_factor, errors.best_rmse);
}

void visit(Archive& archive, Measurement& measurement)
{
	archive(measurement.candidate, measurement.renderer, measurement.repetitions, measurement.total, measurement.passes,
			measurement.fragments, measurement.volumes, measurement.bytes, measurement.errors, measurement.own_rmse,
			measurement.visibility);
}

void visit(Archive& archive, Reference& reference)
{
	archive(reference.visibility, reference.error);
}
namespace
{

// Candidates that are rays must not repeat the reference's rays.
constexpr uint32_t kOtherSeed = 7919;

double quantile(std::vector<double> values, double share)
{
	std::sort(values.begin(), values.end());
	const double place = share * static_cast<double>(values.size() - 1);
	const auto below = static_cast<std::size_t>(place);
	const std::size_t above = std::min(below + 1, values.size() - 1);
	return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

TimeSpread spreadOf(const std::string& name, const std::vector<double>& seconds)
{
	return {name, quantile(seconds, 0.5), quantile(seconds, 0.25), quantile(seconds, 0.75)};
}

void setTimes(const Shaded& shaded, Measurement& measurement)
{
	std::vector<double> totals;
	for (const PassTime& pass : shaded.passes)
	{
		totals.resize(pass.drawings.size());
		for (std::size_t i = 0; i < totals.size(); ++i)
		{
			totals[i] += pass.drawings[i];
		}
		measurement.passes.push_back(spreadOf(pass.name, pass.drawings));
	}
	measurement.total = spreadOf("total", totals);
}

bool isSlow(const Candidate& candidate)
{
	return candidate.kind == CandidateKind::asset && candidate.asset->slow;
}

constexpr double kGolden = 0.6180339887498949;

// True where both pictures show one smooth surface: normals within 5°, depths as a plane at a grazing angle has them.
bool isAlike(const GBuffer& one, const GBuffer& other, std::size_t pixel)
{
	const float first = one.depth[pixel];
	const float second = other.depth[pixel];
	return std::isfinite(first) && std::isfinite(second) && std::fabs(first - second) <= 0.05F * std::min(first, second) &&
		   glm::dot(one.normals[pixel], other.normals[pixel]) >= 0.996F;
}

std::string hashOf(const Level& level)
{
	ContentHash hash;
	hash.items(std::span<const glm::dvec3>(level.positions));
	hash.items(std::span<const glm::vec3>(level.normals));
	hash.items(std::span<const glm::vec2>(level.uvs));
	hash.items(std::span<const glm::uvec3>(level.triangles));
	hash.items(std::span<const uint32_t>(level.materials));
	for (const Material& material : level.material_list)
	{
		hash.add(static_cast<int>(material.alpha_mode), material.cutoff, material.alpha, material.mask, material.two_sided);
	}
	for (const Mask& mask : level.masks)
	{
		hash.add(mask.width_px, static_cast<int>(mask.wrap_u), static_cast<int>(mask.wrap_v));
		hash.items(std::span<const uint8_t>(mask.alpha));
	}
	return hash.text();
}

using SteadyClock = std::chrono::steady_clock;

constexpr double kSlow_s = 0.5;                // a drawing
constexpr double kBusyShare = 0.1;             // less is the system's own
constexpr std::chrono::milliseconds kSpin{60}; // a few turns of a scheduler
constexpr std::chrono::seconds kPause{6};

constexpr int kLeastHeight_px = 64;

// Returns the share of that many processors that other programs take, 0 to 1: keeps all of them busy for 60 ms and compares the
// time that its threads had. 0 where the system does not tell.
double takenByOthers(int threads)
{
	const auto count = static_cast<std::size_t>(std::max(threads, 1));
	std::vector<double> had(count); // shares; an item takes a thread for as long as it spins, so each has its own
	parallelFor(count, threads,
				[&](std::size_t i)
				{
					const double before = threadSeconds();
					const SteadyClock::time_point start = SteadyClock::now();
					while (SteadyClock::now() - start < kSpin)
					{
					}
					had[i] = before < 0.0 ? 1.0 : (threadSeconds() - before) / secondsSince(start);
				});
	return 1.0 - sumOver(had, [](double share) { return std::clamp(share, 0.0, 1.0); }) / static_cast<double>(count);
}

} // namespace

double secondsSince(SteadyClock::time_point start)
{
	return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

RendererFacts rendererOf(const MeasureSettings& settings)
{
	if (settings.device == Device::cpu)
	{
		return {"CPU", true};
	}
	const GlContext context(GlApi::core, settings.gl_device);
	return {context.renderer(), context.isSoftware()};
}

std::string viewHash(const LevelBench& level, const LevelCamera& camera, const ViewSettings& settings, const std::string& version)
{
	ContentHash hash;
	hash.add(version);
	hash.add(level.hash);
	const View view = viewOf(camera, settings.width_px, settings.height_px);
	for (const glm::dmat4& matrix : {view.camera_from_world, view.projection})
	{
		hash.add(std::as_bytes(std::span(&matrix[0][0], 16)));
	}
	hash.add(settings.width_px, settings.height_px, level.radius_m, settings.reference_rays, settings.seed);
	return hash.text();
}

struct ViewBench::Data
{
	Data(LevelBench& of, const LevelCamera& from, const ViewSettings& given, const RunSettings& how)
		: level(of), camera(from), settings(given), run(how), timed(silent(how)),
		  gbuffer(castGBuffer(of.tracer, viewOf(from, given.width_px, given.height_px), given.width_px, given.height_px,
							  NormalKind::geometric, how))
	{
		surface = mapped(gbuffer.depth, [](float depth) { return static_cast<uint8_t>(std::isfinite(depth) ? 1 : 0); });
		surfaces = static_cast<std::size_t>(std::count(surface.begin(), surface.end(), uint8_t{1}));
	}

	const Reference& reference()
	{
		if (!known)
		{
			Reference made;
			double squares = 0.0;
			for (const ReferenceValue& value : trace(settings.reference_rays, settings.seed, run))
			{
				made.visibility.push_back(static_cast<float>(value.visibility));
				squares += value.standard_error * value.standard_error;
			}
			made.error = surfaces > 0 ? std::sqrt(squares / static_cast<double>(surfaces)) : 0.0;
			known = std::move(made);
		}
		return *known;
	}

	// The view moved by parts of a pixel, along (i, i·φ) modulo 1.
	void move(int shifts)
	{
		if (moved.size() == static_cast<std::size_t>(shifts))
		{
			return;
		}
		moved.clear();
		moved_smooth.assign(surface.size(), 1);
		for (int i = 0; i < shifts; ++i)
		{
			View view = gbuffer.view;
			const double x = (i + 0.5) / shifts - 0.5;
			const double y = std::fmod(i * kGolden + 0.5, 1.0) - 0.5;
			glm::dmat4 shift(1.0); // of the picture, after the division by w
			shift[3] = {2.0 * x / gbuffer.width_px, 2.0 * y / gbuffer.height_px, 0.0, 1.0};
			view.projection = shift * view.projection;
			moved.push_back(castGBuffer(level.tracer, view, gbuffer.width_px, gbuffer.height_px, NormalKind::geometric, timed));
			for (std::size_t pixel = 0; pixel < surface.size(); ++pixel)
			{
				moved_smooth[pixel] = moved_smooth[pixel] != 0 && isAlike(gbuffer, moved.back(), pixel) ? 1 : 0;
			}
		}
	}

	std::vector<ReferenceValue> trace(int rays, uint32_t seed, const RunSettings& trace_run) const
	{
		ReferenceSettings how{.falloff = Falloff::linear, .radius_m = level.radius_m, .rays = rays, .seed = seed};
		return referenceOfGBuffer(&level.tracer, gbuffer, how, trace_run);
	}

	AovShaded drawRays(int rays, int repetitions) const
	{
		AovShaded drawn;
		PassTime pass{"rays"};
		for (int i = 0; i <= repetitions; ++i)
		{
			const auto start = std::chrono::steady_clock::now();
			const std::vector<ReferenceValue> values = trace(rays, settings.seed + kOtherSeed, timed);
			const double seconds = secondsSince(start);
			if (i > 0 || repetitions == 0)
			{
				pass.drawings.push_back(seconds);
			}
			drawn.shaded.visibility =
				mapped(values, [](const ReferenceValue& value) { return static_cast<float>(value.visibility); });
		}
		drawn.shaded.renderer = "CPU";
		drawn.shaded.passes = {pass};
		return drawn;
	}

	AovShaded drawn(const GBuffer& of, const Candidate& candidate, const MeasureSettings& how, int repetitions) const
	{
		const DrawSettings drawing{repetitions, how.gl_device, how.session.get()};
		if (candidate.kind == CandidateKind::rays)
		{
			return drawRays(candidate.count, repetitions);
		}
		if (candidate.kind == CandidateKind::asset)
		{
			return level.asset(candidate).draw(of, candidate, how.device == Device::gl, timed, drawing);
		}
		const ShadeSettings shade = shadeSettingsOf(candidate, level.radius_m);
		const ShadeSamples& samples = level.samples->samplesOf(candidate, shade, run);
		return {how.device == Device::gl ? shadeOnGl(of, samples, shade, drawing) : shadeOnCpu(of, samples, shade, timed, drawing),
				{}};
	}

	// Throws TooSlow.
	void refuseSlow(const Candidate& candidate, const MeasureSettings& how) const
	{
		if (!isSlow(candidate) || how.slowest_s <= 0.0)
		{
			return;
		}
		const double expected_s = expectedSeconds(
			[&](int width_px, int height_px)
			{
				const GBuffer small = castGBuffer(level.tracer, viewOf(camera, width_px, height_px), width_px, height_px,
												  NormalKind::geometric, timed);
				return drawn(small, candidate, how, 0).shaded.seconds;
			},
			gbuffer.width_px, gbuffer.height_px, how.slowest_s);
		if (expected_s > how.slowest_s)
		{
			throw TooSlow(expected_s, how.slowest_s);
		}
	}

	// The picture of definitionOf(), drawn once; empty where that is too slow.
	const std::vector<float>& definition(const Candidate& candidate, const MeasureSettings& how)
	{
		const Candidate best = definitionOf(candidate);
		const std::string key = best.name() + (how.device == Device::gl ? " gl" : " cpu");
		const auto [found, fresh] = definitions.try_emplace(key);
		if (fresh)
		{
			try
			{
				refuseSlow(best, how);
				found->second = drawn(gbuffer, best, how, 0).shaded.visibility;
			}
			catch (const TooSlow&)
			{
			}
			catch (...)
			{
				definitions.erase(found);
				throw;
			}
		}
		return found->second;
	}

	double rmseBetween(const std::vector<float>& one, const std::vector<float>& other) const
	{
		double squares = 0.0;
		for (std::size_t i = 0; i < one.size(); ++i)
		{
			const double difference = surface[i] != 0 ? static_cast<double>(one[i]) - static_cast<double>(other[i]) : 0.0;
			squares += difference * difference;
		}
		return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(surfaces, 1)));
	}

	LevelBench& level;
	LevelCamera camera;
	ViewSettings settings;
	RunSettings run;
	RunSettings timed; // of what has its time taken, or is drawn by the hundred
	GBuffer gbuffer;
	std::vector<uint8_t> surface; // 1: the pixel shows one
	std::size_t surfaces = 0;
	std::optional<Reference> known;
	std::map<std::string, std::vector<float>> definitions;
	std::vector<GBuffer> moved;        // by parts of a pixel
	std::vector<uint8_t> moved_smooth; // 1: the pixel shows one smooth surface in all of them
};

ViewBench::ViewBench(LevelBench& level, const LevelCamera& camera, const ViewSettings& settings, const RunSettings& run,
					 std::optional<Reference> known)
	: m_data(std::make_shared<Data>(level, camera, settings, run))
{
	assert(!known || known->visibility.size() == m_data->gbuffer.depth.size());
	m_data->known = std::move(known);
}

const GBuffer& ViewBench::gbuffer() const
{
	return m_data->gbuffer;
}

const Reference& ViewBench::reference() const
{
	return m_data->reference();
}

double ViewBench::surfaceShare() const
{
	return static_cast<double>(m_data->surfaces) / static_cast<double>(m_data->surface.size());
}

std::vector<float> ViewBench::draw(const Candidate& candidate, const MeasureSettings& settings)
{
	return m_data->drawn(m_data->gbuffer, candidate, settings, 0).shaded.visibility;
}

ViewErrors ViewBench::errorsOf(const std::vector<float>& visibility) const
{
	ViewErrors errors;
	if (m_data->surfaces == 0)
	{
		return errors;
	}
	const VisibilityPlane test{m_data->gbuffer.width_px, m_data->gbuffer.height_px, visibility};
	const std::vector<float>& reference = m_data->reference().visibility;
	const VisibilityPlane truth{m_data->gbuffer.width_px, m_data->gbuffer.height_px, reference};
	CompareSettings how{.counted = m_data->surface};
	const Comparison found = compareImages(test, truth, how, m_data->timed);
	errors = {found.eq14, found.rmse, found.flip, found.ssim, found.mean_error, 1.0, found.rmse};

	double both = 0.0; // least squares: Σ (1 − f·o − r)²
	double own = 0.0;
	for (std::size_t i = 0; i < visibility.size(); ++i)
	{
		const double occlusion = m_data->surface[i] != 0 ? 1.0 - static_cast<double>(visibility[i]) : 0.0;
		both += occlusion * (1.0 - static_cast<double>(reference[i]));
		own += occlusion * occlusion;
	}
	if (own > 0.0)
	{
		errors.best_factor = both / own;
		const auto scaled = [&](float v)
		{
			return static_cast<float>(std::max(0.0, 1.0 - errors.best_factor * (1.0 - static_cast<double>(v))));
		};
		errors.best_rmse = m_data->rmseBetween(mapped(visibility, scaled), reference);
	}
	return errors;
}

double ViewBench::errorBy(ErrorMeasure measure, const std::vector<float>& visibility) const
{
	if (m_data->surfaces == 0)
	{
		return 0.0;
	}
	const std::vector<float>& reference = m_data->reference().visibility;
	const VisibilityPlane test{m_data->gbuffer.width_px, m_data->gbuffer.height_px, visibility};
	const VisibilityPlane truth{m_data->gbuffer.width_px, m_data->gbuffer.height_px, reference};
	switch (measure)
	{
	case ErrorMeasure::rmse: break;
	case ErrorMeasure::eq14: return logError(test, truth, m_data->surface, m_data->timed);
	case ErrorMeasure::flip: return meanFlip(test, truth, m_data->surface, CompareSettings{}.pixels_per_degree, m_data->timed);
	}
	return m_data->rmseBetween(visibility, reference);
}

Measurement ViewBench::measure(const Candidate& candidate, const MeasureSettings& settings)
{
	m_data->refuseSlow(candidate, settings);
	int repetitions = isSlow(candidate) ? 0 : settings.repetitions;
	AovShaded drawn = m_data->drawn(m_data->gbuffer, candidate, settings, repetitions);
	if (isSlow(candidate) && settings.repetitions > 0 && drawn.shaded.seconds < kSlow_s)
	{
		repetitions = settings.repetitions;
		drawn = m_data->drawn(m_data->gbuffer, candidate, settings, repetitions);
	}
	Measurement measurement;
	measurement.candidate = candidate.name();
	measurement.renderer = drawn.shaded.renderer;
	measurement.repetitions = repetitions;
	setTimes(drawn.shaded, measurement);
	measurement.fragments = drawn.counts.fragments;
	measurement.volumes = drawn.counts.volumes;
	if (candidate.kind == CandidateKind::asset)
	{
		measurement.bytes = m_data->level.asset(candidate).bytes();
		measurement.renderer = candidate.asset->with_level ? rendererOf(settings).name : measurement.renderer; // would draw it
	}
	measurement.errors = settings.errors ? errorsOf(drawn.shaded.visibility) : ViewErrors{};
	const bool has_definition = candidate.kind == CandidateKind::screen || isSlow(candidate);
	if (isSlow(candidate) && definitionOf(candidate).name() == measurement.candidate)
	{
		m_data->definitions.emplace(measurement.candidate + (settings.device == Device::gl ? " gl" : " cpu"),
									drawn.shaded.visibility); // it is one itself
	}
	else if (settings.errors && has_definition)
	{
		const std::vector<float>& definition = m_data->definition(candidate, settings);
		measurement.own_rmse =
			definition.empty() ? std::nullopt : std::optional(m_data->rmseBetween(drawn.shaded.visibility, definition));
	}
	measurement.visibility = std::move(drawn.shaded.visibility);
	return measurement;
}

double ViewBench::flicker(const Candidate& candidate, const MeasureSettings& settings, int shifts)
{
	assert(shifts >= 2 && candidate.kind != CandidateKind::rays);
	m_data->move(shifts);
	std::vector<double> sums(m_data->surface.size());
	std::vector<double> squares(m_data->surface.size());
	for (const GBuffer& gbuffer : m_data->moved)
	{
		const std::vector<float> visibility = m_data->drawn(gbuffer, candidate, settings, 0).shaded.visibility;
		for (std::size_t i = 0; i < visibility.size(); ++i)
		{
			const auto value = static_cast<double>(visibility[i]);
			sums[i] += value;
			squares[i] += value * value;
		}
	}
	double variance = 0.0;
	std::size_t pixels = 0;
	for (std::size_t i = 0; i < sums.size(); ++i)
	{
		if (m_data->moved_smooth[i] != 0)
		{
			const double mean = sums[i] / shifts;
			variance += std::max(0.0, squares[i] / shifts - mean * mean) * shifts / (shifts - 1);
			pixels += 1;
		}
	}
	return pixels > 0 ? std::sqrt(variance / static_cast<double>(pixels)) : 0.0;
}

std::string ViewBench::contentHash(const Candidate& candidate, const MeasureSettings& settings, const std::string& version)
{
	ContentHash hash;
	hash.add(viewHash(m_data->level, m_data->camera, m_data->settings, version));
	hash.add(candidate.radius_ratio, candidate.thickness_ratio, settings.repetitions, settings.errors,
			 settings.device == Device::gl, m_data->run.threads);
	for (const FeatureRow& feature : featureTable()) // names have words of some
	{
		hash.add(feature.value.get(candidate.shade));
	}
	if (candidate.recipe)
	{
		hash.add(jsonLine(recipeJson(*candidate.recipe)));
	}
	hash.add(candidate.name());
	hash.add(candidate.kind == CandidateKind::asset && candidate.asset->slow ? settings.slowest_s
																			 : 0.0); // what else there is to compare with
	return hash.text();
}

LevelBench::LevelBench(Level given, double radius, const RunSettings& run, std::shared_ptr<SampleStore> store, double few)
	: level(std::move(given)), tracer(level, run), radius_m(radius > 0.0 ? radius : suggestedRadius(level)), hash(hashOf(level)),
	  samples(store ? std::move(store) : std::make_shared<SampleStore>()), m_run(run), m_few(few)
{
}

LevelAsset& LevelBench::asset(const Candidate& candidate)
{
	assert(candidate.kind == CandidateKind::asset);
	std::unique_ptr<LevelAsset>& made = m_assets[candidate.asset->key(candidate)];
	if (!made)
	{
		made = candidate.asset->make({level, tracer, radius_m, m_few}, candidate, m_run);
	}
	return *made;
}

void BusyWatch::look()
{
	if (m_last && SteadyClock::now() - *m_last < kPause)
	{
		return;
	}
	m_sum += takenByOthers(m_threads);
	m_looks += 1;
	m_last = SteadyClock::now();
}

std::string busyText(double share)
{
	return share < kBusyShare ? std::string()
							  : "the machine was busy: other programs took about " + fixedText(100.0 * share, 0) +
									" % of the processors, so times are longer and less steady than on a quiet one";
}

TooSlow::TooSlow(double expected, double limit)
	: Error(ExitCode::unsupported,
			"stopped: a picture would take about " + roundedText(expected, 2) + " s, more than " + roundedText(limit, 3) + " s"),
	  expected_s(expected)
{
}

double expectedSeconds(const std::function<double(int, int)>& draw, int width_px, int height_px, double limit_s)
{
	double expected_s = 0.0;
	double last_s = 0.0;
	double last_pixels = 0.0;
	const double all = static_cast<double>(width_px) * height_px;
	for (const int part : {16, 8, 4})
	{
		if (height_px < kLeastHeight_px)
		{
			break;
		}
		const int width = std::max(1, width_px / part);
		const int height = std::max(1, height_px / part);
		const double seconds = draw(width, height);
		const double pixels = static_cast<double>(width) * height;
		const double each_s = last_pixels > 0.0 ? std::max(0.0, seconds - last_s) / (pixels - last_pixels) : 0.0;
		expected_s = seconds + each_s * (all - pixels);
		if (expected_s > limit_s)
		{
			break;
		}
		last_s = seconds;
		last_pixels = pixels;
	}
	return expected_s;
}

} // namespace nook
