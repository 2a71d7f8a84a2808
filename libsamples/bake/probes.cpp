// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: R. Ramamoorthi, P. Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001 (cosine
// hemispheres are smooth in the normal; here its first two bands); Z. Majercik, J.-P. Guertin, D. Nowrouzezahrai, M. McGuire,
// "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", 2019 (weights that fade probes behind the surface).
#include "bake/probes.h"

#include "bake/surface_samples.h"
#include "core/decimal.h"
#include "core/lists.h"
#include "core/math.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/words.h"
#include "format/arrays.h"
#include "scene/reference.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{

namespace
{

constexpr std::array<glm::dvec3, 6> kAxes{glm::dvec3(1.0, 0.0, 0.0),  glm::dvec3(-1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0),
										  glm::dvec3(0.0, -1.0, 0.0), glm::dvec3(0.0, 0.0, 1.0),  glm::dvec3(0.0, 0.0, -1.0)};

ProbeGrid placeProbes(const Bounds& bounds, double spacing_m)
{
	ProbeGrid grid;
	grid.spacing_m = spacing_m;
	double probes = 1.0;
	for (int axis = 0; axis < 3; ++axis)
	{
		const double count = std::ceil((bounds.most[axis] - bounds.least[axis]) / spacing_m);
		refuseInputIf(!(count <= kMostProbesAlong), "probes",
					  "more than " + std::to_string(kMostProbesAlong) + " probes along an axis of the level", "at most that",
					  ExitCode::usage);
		grid.count[axis] = std::max(1, static_cast<int>(count));
		grid.origin[axis] = 0.5 * (bounds.least[axis] + bounds.most[axis]) - 0.5 * spacing_m * (grid.count[axis] - 1);
		probes *= grid.count[axis];
	}
	refuseInputIf(probes > static_cast<double>(kMostProbes), "probes",
				  std::to_string(static_cast<uint64_t>(probes)) + " probes in the level", "at most " + std::to_string(kMostProbes),
				  ExitCode::usage);
	grid.texels.assign(static_cast<std::size_t>(probes), {128, 128, 128, 0});
	return grid;
}

glm::dvec3 placeOf(const ProbeGrid& grid, std::size_t i)
{
	const auto x = static_cast<std::size_t>(grid.count.x);
	const auto y = static_cast<std::size_t>(grid.count.y);
	return grid.origin +
		   grid.spacing_m * glm::dvec3(static_cast<double>(i % x), static_cast<double>(i / x % y), static_cast<double>(i / x / y));
}

uint8_t byteOf(double value)
{
	return static_cast<uint8_t>(std::floor(std::clamp(value, 0.0, 255.0) + 0.5));
}

// Least-squares fit over six normals along the axes.
std::array<uint8_t, 4> texelOf(std::span<const ReferenceValue> values)
{
	const double mean = sumOver(values, [](const ReferenceValue& value) { return value.visibility / 6.0; });
	const auto slope = [&](std::size_t axis)
	{
		return byteOf(255.0 * (0.5 * (values[2 * axis].visibility - values[2 * axis + 1].visibility) + 0.5));
	};
	return {slope(0), slope(1), slope(2), byteOf(1.0 + 254.0 * mean)};
}

// A number with a point or an exponent, as GLSL ES requires.
std::string real(double value)
{
	const std::string text = numberText(value);
	return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string vector(glm::dvec3 v)
{
	return "vec3(" + real(v.x) + ", " + real(v.y) + ", " + real(v.z) + ")";
}

// Returns the box that the grid covers.
Bounds boxOf(const Tracer& tracer, const BakeSettings& settings)
{
	return settings.receivers != nullptr ? boundsOf(*settings.receivers) : tracer.bounds();
}

} // namespace

ProbeGrid bakeProbes(const Tracer& tracer, double spacing_m, const BakeSettings& settings, const RunSettings& run)
{
	assert(spacing_m > 0.0);
	ProbeGrid grid = placeProbes(boxOf(tracer, settings), spacing_m);
	const int rays = std::max(1, settings.rays / 6);
	constexpr std::size_t kBlock = std::size_t{1} << 14U;
	ProgressCounter progress(run.progress, "probes", grid.texels.size());
	std::vector<uint8_t> inside(kBlock);
	double squares = 0.0;
	for (std::size_t first = 0; first < grid.texels.size(); first += kBlock)
	{
		const std::size_t count = std::min(kBlock, grid.texels.size() - first);
		parallelFor(count, run.threads, [&](std::size_t i) { inside[i] = isInMatter(tracer, placeOf(grid, first + i)) ? 1 : 0; });
		std::vector<ReferencePoint> points;
		for (std::size_t i = 0; i < count; ++i)
		{
			for (const glm::dvec3& axis : kAxes)
			{
				if (inside[i] == 0)
				{
					points.push_back({placeOf(grid, first + i), axis, 0.0});
				}
			}
		}
		const auto seed = settings.seed + static_cast<uint32_t>(first / kBlock) * 0x9e3779b9U; // a different sequence per block
		const std::vector<ReferenceValue> values =
			referenceAtPoints(tracer, points, raysOf(settings, rays, seed), withoutProgress(run));
		std::size_t next = 0;
		for (std::size_t i = 0; i < count; ++i)
		{
			if (inside[i] != 0)
			{
				grid.buried += 1;
				continue;
			}
			const std::span<const ReferenceValue> six = std::span(values).subspan(next, 6);
			grid.texels[first + i] = texelOf(six);
			for (const ReferenceValue& value : six)
			{
				squares += value.standard_error * value.standard_error / 36.0;
			}
			next += 6;
		}
		grid.rays += values.size() * static_cast<std::size_t>(rays);
		progress.finish(count);
	}
	grid.standard_error = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(grid.texels.size() - grid.buried, 1)));
	return grid;
}

double visibilityAt(const ProbeGrid& grid, glm::dvec3 position, glm::dvec3 normal)
{
	const glm::dvec3 most = glm::dvec3(grid.count - 1);
	const glm::dvec3 at = glm::clamp((position - grid.origin) / grid.spacing_m, glm::dvec3(0.0), most);
	const glm::ivec3 first = glm::min(glm::ivec3(at), glm::max(grid.count - 2, glm::ivec3(0)));
	const glm::dvec3 share = at - glm::dvec3(first);
	double sum = 0.0;
	double weights = 0.0;
	for (int i = 0; i < 8; ++i)
	{
		const glm::ivec3 step(i & 1, (i >> 1) & 1, i >> 2);
		const glm::ivec3 probe = glm::min(first + step, grid.count - 1);
		const std::array<uint8_t, 4>& texel =
			grid.texels[static_cast<std::size_t>(probe.x) +
						static_cast<std::size_t>(grid.count.x) *
							(static_cast<std::size_t>(probe.y) +
							 static_cast<std::size_t>(grid.count.y) * static_cast<std::size_t>(probe.z))];
		const glm::dvec3 trilinear = glm::mix(1.0 - share, share, glm::dvec3(step));
		const glm::dvec3 way = grid.origin + grid.spacing_m * glm::dvec3(probe) - position;
		const double facing = 0.5 + 0.5 * glm::dot(way, normal) / std::max(glm::length(way), 1e-6 * grid.spacing_m);
		const double weight = texel[3] == 0 ? 0.0 : (trilinear.x * trilinear.y * trilinear.z + 1e-4) * (facing * facing + 0.05);
		const glm::dvec3 slope = glm::dvec3(texel[0], texel[1], texel[2]) / 255.0 - 0.5;
		sum += weight * ((texel[3] - 1) / 254.0 + glm::dot(slope, normal));
		weights += weight;
	}
	return weights > 0.0 ? std::clamp(sum / weights, 0.0, 1.0) : 1.0;
}

BakeCheck checkProbes(const Tracer& tracer, const ProbeGrid& grid, const BakeSettings& settings, std::size_t points,
					  const RunSettings& run)
{
	constexpr int kRays = 1024;
	Random random(settings.seed, 0x5eed);
	const Bounds bounds = boxOf(tracer, settings);
	BakeCheck check;
	std::vector<ReferencePoint> open;
	for (std::size_t i = 0; i < points; ++i)
	{
		const glm::dvec3 share{random.uniform(), random.uniform(), random.uniform()}; // braces fix the evaluation order
		const double z = 2.0 * random.uniform() - 1.0;
		const SinCos turn = sinCosOf(2.0 * kPi * random.uniform());
		const double across = std::sqrt(1.0 - z * z);
		const ReferencePoint point{glm::mix(bounds.least, bounds.most, share), {across * turn.cos, across * turn.sin, z}, 0.0};
		if (isInMatter(tracer, point.position))
		{
			check.buried += 1;
		}
		else
		{
			open.push_back(point);
		}
	}
	const std::vector<ReferenceValue> values =
		referenceAtPoints(tracer, open, raysOf(settings, kRays, settings.seed ^ 0x5eedU), withoutProgress(run));
	for (std::size_t i = 0; i < open.size(); ++i)
	{
		const double off = visibilityAt(grid, open[i].position, open[i].normal) - values[i].visibility;
		check.rmse += off * off;
		check.bias += off;
		check.standard_error += values[i].standard_error * values[i].standard_error;
	}
	const auto count = static_cast<double>(std::max<std::size_t>(open.size(), 1));
	check.points = open.size();
	check.rays = open.size() * static_cast<std::size_t>(kRays);
	check.rmse = std::sqrt(check.rmse / count);
	check.bias /= count;
	check.standard_error = std::sqrt(check.standard_error / count);
	return check;
}

std::string probesKtx2(const ProbeGrid& grid, std::string_view writer)
{
	Ktx2Texture texture;
	texture.texel = Ktx2Texel::rgba8_unorm;
	texture.width = static_cast<uint32_t>(grid.count.x);
	texture.height = static_cast<uint32_t>(grid.count.y);
	texture.depth = static_cast<uint32_t>(grid.count.z);
	texture.notes = {
		{"KTXwriter", std::string(writer)},
		{"Layout", "visibility for the normal n = (255 a - 1) / 254 + dot(rgb - 0.5, n); a = 0: inside matter"},
		{"nook:origin_m", numberText(grid.origin.x) + " " + numberText(grid.origin.y) + " " + numberText(grid.origin.z)},
		{"nook:spacing_m", numberText(grid.spacing_m)}};
	texture.bytes.reserve(4 * grid.texels.size());
	for (const std::array<uint8_t, 4>& texel : grid.texels)
	{
		texture.bytes.append(reinterpret_cast<const char*>(texel.data()), texel.size());
	}
	return ktx2Bytes(texture);
}

std::string probesGlsl(const ProbeGrid& grid, std::string_view writer)
{
	const std::string count =
		std::to_string(grid.count.x) + ", " + std::to_string(grid.count.y) + ", " + std::to_string(grid.count.z);
	std::string text = "// SPDX-License-Identifier: MIT\n// Made by " + std::string(writer) + ": nook bake --probes.\n";
	text += "const vec3 NOOK_PROBE_ORIGIN = " + vector(grid.origin) + "; // of the first probe, metres, the level's world space\n";
	text += "const float NOOK_PROBE_SPACING = " + real(grid.spacing_m) + ";\n";
	text += "const ivec3 NOOK_PROBE_COUNT = ivec3(" + count + ");\n";
	// Matches visibilityAt() in probes.cpp step by step.
	return text + R"(
// Visibility in [0, 1] at a point with a unit normal, both in the level's world space. `probes` is the KTX2 file's texture.
float nookProbeVisibility(sampler3D probes, vec3 position, vec3 normal)
{
	vec3 at = clamp((position - NOOK_PROBE_ORIGIN) / NOOK_PROBE_SPACING, vec3(0.0), vec3(NOOK_PROBE_COUNT - ivec3(1)));
	ivec3 first = min(ivec3(at), max(NOOK_PROBE_COUNT - ivec3(2), ivec3(0)));
	vec3 share = at - vec3(first);
	float sum = 0.0;
	float weights = 0.0;
	for (int i = 0; i < 8; ++i)
	{
		ivec3 offset = ivec3(i & 1, (i >> 1) & 1, i >> 2);
		ivec3 probe = min(first + offset, NOOK_PROBE_COUNT - ivec3(1));
		vec4 texel = texelFetch(probes, probe, 0);
		vec3 trilinear = mix(vec3(1.0) - share, share, vec3(offset));
		vec3 way = NOOK_PROBE_ORIGIN + NOOK_PROBE_SPACING * vec3(probe) - position;
		float facing = 0.5 + 0.5 * dot(way, normal) / max(length(way), 1e-6 * NOOK_PROBE_SPACING);
		float weight = (trilinear.x * trilinear.y * trilinear.z + 1e-4) * (facing * facing + 0.05);
		weight = texel.w == 0.0 ? 0.0 : weight; // inside matter
		sum += weight * ((255.0 * texel.w - 1.0) / 254.0 + dot(texel.xyz - vec3(0.5), normal));
		weights += weight;
	}
	return weights > 0.0 ? clamp(sum / weights, 0.0, 1.0) : 1.0;
}
)";
}

} // namespace nook
