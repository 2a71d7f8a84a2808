// SPDX-License-Identifier: GPL-3.0-or-later
// A level, a camera and a size → the times and the errors of any candidates on that view. What candidates share is made once:
// the level's volumes by LevelBench, G-buffer, reference and the methods' own definitions by ViewBench.
//
//	LevelBench level(loadLevel(…).level, radius_m, run);
//	ViewBench view(level, camera, {240, 135, 512}, run);
//	for (const Candidate& candidate : candidateGrid(GridSize::quick))
//	{
//		const Measurement m = view.measure(candidate, {Device::gl, {}, 3});
//	}
//
// Successive halving measures few views with few repetitions first: both are cheap to make small, and nothing is kept between
// calls but what is the same for all of them, and shaders, with a session.
#pragma once

#include "core/archive.h"
#include "core/error.h"
#include "core/progress.h"
#include "scene/gbuffer.h"
#include "scene/tracer.h"
#include "shade/asset_kinds.h"
#include "study/candidates.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

enum class Device
{
	cpu, // our own code on the CPU
	gl,  // OpenGL without a display, whatever renderer that is
};

struct MeasureSettings
{
	Device device = Device::gl;
	std::optional<int> gl_device;       // of EGL's list
	int repetitions = 5;                // drawings after one that warms up; 0: one drawing, whose time says little
	double slowest_s = 0.0;             // volumes that would take longer a picture are not drawn; 0: all are
	bool errors = true;                 // false: neither errors nor own_rmse (see errorBy())
	std::shared_ptr<GlSession> session; // on that device, keeps the shaders of screen-space methods; without: compiled each time
};

struct RendererFacts
{
	std::string name;      // that measurements will have: "CPU", or what OpenGL calls itself
	bool software = false; // draws on a CPU: its times say nothing of a GPU's
};

// Throws Error (unsupported) where there is none.
RendererFacts rendererOf(const MeasureSettings& settings);

// Over several drawings, seconds.
struct TimeSpread
{
	std::string name; // of a pass; of the whole: "total"
	double median_s = 0.0;
	double low_s = 0.0; // lower and upper quartile
	double high_s = 0.0;
};

// Against the reference, pixels with a surface alone (measure/compare.h).
struct ViewErrors
{
	double eq14 = 0.0;
	double rmse = 0.0;
	double flip = 0.0;
	std::optional<double> ssim;
	double mean_error = 0.0;  // negative: darker than the reference
	double best_factor = 1.0; // of the obscurance 1 − v, that brings RMSE down to best_rmse: a gamma or strength slider's doing
	double best_rmse = 0.0;
};

enum class ErrorMeasure
{
	rmse,
	eq14, // AOV eq. 14
	flip,
};

struct Measurement
{
	std::string candidate; // its name
	std::string renderer;  // rays: "CPU"
	int repetitions = 0;
	TimeSpread total;
	std::vector<TimeSpread> passes;
	uint64_t fragments = 0; // volumes: fragments shaded, or pairs of pixel and volume on the CPU
	uint64_t volumes = 0;   // of the set
	uint64_t bytes = 0; // of what the level needs for it: a file of volumes, or a bake's values (and vertices, where it has more)
	ViewErrors errors;
	std::optional<double> own_rmse; // to definitionOf() the candidate; none for what has none, or one that is too slow
	std::vector<float> visibility;  // rows from the top; sky 1
};

// Shared by the views of a level, which point to it: neither copied nor moved.
class LevelBench
{
public:
	// `radius`: reach of the reference's rays, metres (linear falloff); 0: suggestedRadius(). `store`: of several levels in one
	// run. `few`: of its bakes, BakeSettings::few. Throws as Tracer.
	LevelBench(Level given, double radius, const RunSettings& run, std::shared_ptr<SampleStore> store = nullptr, double few = 0.0);
	LevelBench& operator=(LevelBench&&) = delete;

	// Made at the first call. Requires kind asset; Throws as the kind's maker.
	LevelAsset& asset(const Candidate& candidate);

	const Level level;
	const Tracer tracer;
	const double radius_m;
	const std::string hash; // of the level's triangles, materials and masks
	const std::shared_ptr<SampleStore> samples;

private:
	RunSettings m_run;
	double m_few;
	std::map<std::string, std::unique_ptr<LevelAsset>> m_assets; // by key
};

struct ViewSettings
{
	int width_px = 320;
	int height_px = 180;
	int reference_rays = 512;
	uint32_t seed = 1; // of the reference
};

struct Reference
{
	std::vector<float> visibility; // rows from the top; sky 1
	double error = 0.0;            // root mean square of its standard error, over pixels with a surface
};

// Visitors for the store.
void visit(Archive& archive, Measurement& measurement);
void visit(Archive& archive, Reference& reference);
void visit(Archive& archive, ViewErrors& errors);

// All that a view's reference depends on, as 32 hexadecimal digits: what a cache is asked for.
std::string viewHash(const LevelBench& level, const LevelCamera& camera, const ViewSettings& settings, const std::string& version);

class ViewBench
{
public:
	// `level` must outlive it. Casts the G-buffer; the reference is traced when it is first needed, or `known`.
	ViewBench(LevelBench& level, const LevelCamera& camera, const ViewSettings& settings, const RunSettings& run,
			  std::optional<Reference> known = std::nullopt);

	const GBuffer& gbuffer() const;
	const Reference& reference() const;
	double surfaceShare() const; // of pixels

	// Times and errors. Volumes that take longer than half a second a drawing are drawn once (repetitions 0). Throws Error:
	// unsupported where the renderer cannot draw it; TooSlow where that would take longer than slowest_s.
	Measurement measure(const Candidate& candidate, const MeasureSettings& settings);

	// The picture alone, once.
	std::vector<float> draw(const Candidate& candidate, const MeasureSettings& settings);

	// Errors of any picture of this size.
	ViewErrors errorsOf(const std::vector<float>& visibility) const;

	// One of them, in less time.
	double errorBy(ErrorMeasure measure, const std::vector<float>& visibility) const;

	// Standard deviation of a pixel's visibility, root mean square over pixels, when the view moves by parts of a pixel (`shifts`
	// of them, on a low-discrepancy lattice): what flickers when the camera moves slowly. Only pixels that show one smooth surface
	// in all of these views count; 0 where there is none. Requires shifts ≥ 2. Not for rays.
	double flicker(const Candidate& candidate, const MeasureSettings& settings, int shifts);

	// Everything that a measurement's picture depends on, and its repetitions, as 32 hexadecimal digits: what a cache is asked for.
	// Not the machine's speed: caches belong to a machine, whose renderer is part of it.
	std::string contentHash(const Candidate& candidate, const MeasureSettings& settings, const std::string& version);

private:
	struct Data;
	std::shared_ptr<Data> m_data;
};

// How far times can be trusted: how much of the processors other programs take, and how long a picture would take to draw.

// Looks now and then, so that it takes a hundredth of the time.
class BusyWatch
{
public:
	explicit BusyWatch(int threads) : m_threads(threads) {}

	// Between measurements, as often as one likes.
	void look();

	// The mean over all looks; 0 before the first.
	double share() const
	{
		return m_looks > 0 ? m_sum / m_looks : 0.0;
	}

private:
	int m_threads;
	int m_looks = 0;
	double m_sum = 0.0;
	std::optional<std::chrono::steady_clock::time_point> m_last;
};

// Returns a warning about times that were measured then; empty where few processors were taken.
std::string busyText(double share);

// A candidate that is not drawn, since that would take too long.
struct TooSlow : Error
{
	TooSlow(double expected, double limit);

	double expected_s;
};

// Seconds of a picture of that size, by two drawings of a sixteenth and an eighth of its sides and one of a quarter, and the line
// through the last two: a part of each drawing does not depend on the pixels. Once one exceeds the limit, no larger
// one is drawn. 0 for a picture that is too small for that (less than 64 pixels high).
double expectedSeconds(const std::function<double(int width_px, int height_px)>& draw, int width_px, int height_px, double limit_s);

// null: none.
inline nlohmann::ordered_json optionalJson(const std::optional<double>& value)
{
	return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

double secondsSince(std::chrono::steady_clock::time_point start);

// The command's options for what differs from the defaults, each after a blank: " --unit 0.01 --up z --strict".
struct LoadSettings;
std::string loadOptions(const LoadSettings& load);

} // namespace nook
