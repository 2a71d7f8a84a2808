// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/reference.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/round.h"
#include "core/work_units.h"
#include "scene/matter.h"
#include "scene/reference_estimate.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

// A picture has about so many tiles, enough for shares and threads to take about the same time.
constexpr std::size_t kTiles = 512;
constexpr std::size_t kLeastTile_px = 8;

// Pixels of a G-buffer as world-space points.
class PixelPoints
{
public:
	explicit PixelPoints(const GBuffer& gbuffer)
		: m_gbuffer(gbuffer), m_projector(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px),
		  m_world_from_camera(glm::inverse(gbuffer.view.camera_from_world)), m_turn(m_world_from_camera)
	{
	}

	// View space.
	glm::dvec3 positionAt(int x, int y) const
	{
		return positionOf(m_gbuffer, m_projector, x, y);
	}

	// From view space to world space.
	const glm::dmat3& turn() const
	{
		return m_turn;
	}

	ReferencePoint operator()(int x, int y) const
	{
		const std::size_t pixel =
			static_cast<std::size_t>(y) * static_cast<std::size_t>(m_gbuffer.width_px) + static_cast<std::size_t>(x);
		const ViewLine line = m_projector.lineOf({x + 0.5, y + 0.5});
		const auto depth_m = static_cast<double>(m_gbuffer.depth[pixel]);
		const glm::dvec3 normal(m_gbuffer.normals[pixel]);
		// Errors off the surface come from the depth, at best a 32-bit number, and from the camera's matrices if the file had only
		// 32 bits.
		const double error_m =
			m_gbuffer.depth_error_m.empty() ? depth_m * kUnitRoundoff : static_cast<double>(m_gbuffer.depth_error_m[pixel]);
		const double lift_m = error_m * std::max(std::fabs(glm::dot(line.along, normal)), 1e-3) + m_gbuffer.view_error_m;
		return {glm::dvec3(m_world_from_camera * glm::dvec4(line.at + depth_m * line.along, 1.0)), glm::normalize(m_turn * normal),
				lift_m};
	}

private:
	const GBuffer& m_gbuffer;
	Projector m_projector;
	glm::dmat4 m_world_from_camera;
	glm::dmat3 m_turn;
};

// The pixels of each tile that see a surface; about kTiles tiles.
std::vector<std::vector<std::size_t>> tilesOf(const GBuffer& gbuffer)
{
	const auto width = static_cast<std::size_t>(gbuffer.width_px);
	const auto height = static_cast<std::size_t>(gbuffer.height_px);
	const auto tile_px =
		std::max<std::size_t>(kLeastTile_px, static_cast<std::size_t>(std::sqrt(static_cast<double>(width * height / kTiles))));
	const std::size_t tiles_x = (width + tile_px - 1) / tile_px;
	std::vector<std::vector<std::size_t>> tiles(tiles_x * ((height + tile_px - 1) / tile_px));
	for (std::size_t pixel = 0; pixel < width * height; ++pixel)
	{
		if (std::isfinite(gbuffer.depth[pixel]))
		{
			tiles[pixel / width / tile_px * tiles_x + pixel % width / tile_px].push_back(pixel);
		}
	}
	return tiles;
}

void passValues(Archive& archive, std::span<const std::size_t> places, const ReferenceSettings& settings,
				std::span<ReferenceValue> values)
{
	for (const std::size_t i : places)
	{
		archive(values[i].visibility, values[i].standard_error, values[i].rays);
		if (settings.measure == ReferenceMeasure::bent)
		{
			archive(values[i].bent);
		}
	}
}

// Computes the values at these indices, in units that a part may take; every index takes about as many rays.
void computeValues(const std::vector<std::vector<std::size_t>>& units, const ReferenceSettings& settings,
				   std::span<ReferenceValue> values, const std::function<void(std::size_t place)>& compute, const RunSettings& run)
{
	runStage({"rays", units.size(), [&](std::size_t unit) { return static_cast<double>(units[unit].size()) * settings.rays; },
			  [&](std::size_t unit) { std::for_each(units[unit].begin(), units[unit].end(), compute); },
			  [&](std::size_t unit, Archive& archive)
			  {
				  passValues(archive, units[unit], settings, values);
			  }},
			 run);
}

} // namespace

double coneAngle(double visibility)
{
	return std::asin(std::sqrt(std::clamp(visibility, 0.0, 1.0)));
}

std::vector<ReferenceValue> referenceAtPoints(const Tracer& tracer, std::span<const ReferencePoint> points,
											  const ReferenceSettings& settings, const RunSettings& run)
{
	return referenceAtPoints(
		tracer, points.size(), [points](std::size_t i) { return points[i]; }, settings, run);
}

std::vector<ReferenceValue> referenceAtPoints(const Tracer& tracer, std::size_t count,
											  const std::function<ReferencePoint(std::size_t i)>& point,
											  const ReferenceSettings& settings, const RunSettings& run)
{
	assert(settings.measure != ReferenceMeasure::box);
	assert(isByRays(settings.measure) || settings.source == MatterSource::geometry);
	const Batches batches(settings);
	std::vector<ReferenceValue> values(count);
	const auto compute = [&](std::size_t i)
	{
		Random random(settings.seed, i);
		values[i] = atPoint(tracer, point(i), glm::mat3(1.0F), settings, batches, random);
	};
	constexpr std::size_t kChunk = 256;
	std::vector<std::vector<std::size_t>> chunks((count + kChunk - 1) / kChunk);
	for (std::size_t i = 0; i < count; ++i)
	{
		chunks[i / kChunk].push_back(i);
	}
	computeValues(chunks, settings, values, compute, run);
	return values;
}

namespace
{

void checkDepths(const GBuffer& gbuffer)
{
	for (std::size_t i = 0; i < gbuffer.depth.size(); ++i)
	{
		const auto depth_m = static_cast<double>(gbuffer.depth[i]);
		if (std::isfinite(depth_m) && !isLength(depth_m))
		{
			const auto width = static_cast<std::size_t>(gbuffer.width_px);
			throw Error(ExitCode::invalid_input, "depth, pixel " + std::to_string(i % width) + "," + std::to_string(i / width) +
													 ": found " + numberText(depth_m) + " m, expected lengths from " +
													 numberText(kLeastLength_m) + " to " + numberText(kMostLength_m) + " m");
		}
	}
}

} // namespace

std::optional<Vicinity> reachOf(const Level& level, const GBuffer& gbuffer, const ReferenceSettings& settings)
{
	if (!isByRays(settings.measure) || !std::isfinite(settings.radius_m))
	{
		return std::nullopt;
	}
	checkDepths(gbuffer);
	const Bounds bounds = boundsOf(level);
	const double error_m = errorOfRays(bounds);
	Vicinity reach(bounds, 1.0001 * settings.radius_m + 16.0 * error_m);
	const PixelPoints pixels(gbuffer);
	for (int y = 0; y < gbuffer.height_px; ++y)
	{
		for (int x = 0; x < gbuffer.width_px; ++x)
		{
			const std::size_t pixel =
				static_cast<std::size_t>(y) * static_cast<std::size_t>(gbuffer.width_px) + static_cast<std::size_t>(x);
			if (std::isfinite(gbuffer.depth[pixel]))
			{
				reach.add(originOf(pixels(x, y), settings, error_m));
			}
		}
	}
	reach.count();
	return reach;
}

std::vector<ReferenceValue> referenceOfGBuffer(const Tracer* tracer, const GBuffer& gbuffer, const ReferenceSettings& settings,
											   const RunSettings& run)
{
	checkDepths(gbuffer);
	const bool from_depth = !isByRays(settings.measure) && settings.source == MatterSource::depth;
	assert(gbuffer.normals.size() == gbuffer.depth.size() && (from_depth || tracer != nullptr));
	const PixelPoints pixels(gbuffer);
	const glm::dmat3& turn = pixels.turn();
	const Batches batches(settings);
	const DepthMatter depth_matter = from_depth ? DepthMatter(gbuffer, run) : DepthMatter();

	const auto pixelValue = [&](int x, int y, std::size_t pixel)
	{
		Random random(settings.seed, pixel);
		if (!from_depth)
		{
			ReferenceValue value = atPoint(*tracer, pixels(x, y), glm::mat3(turn), settings, batches, random);
			if (settings.measure == ReferenceMeasure::bent)
			{
				value.bent = unitOf(glm::dvec3(value.bent) * turn); // multiplied by the transpose: to view space
			}
			return value;
		}
		const glm::dvec3 position = pixels.positionAt(x, y);
		const Fill fill = [&](const SampleSet& set, Random& r, Scratch& scratch)
		{
			placeVolume(settings, gbuffer.normals[pixel], glm::mat3(1.0F), set, r, scratch);
			depth_matter.sample(position, scratch.directions(), scratch.values);
		};
		return estimate(batches, settings, random, fill);
	};

	std::vector<ReferenceValue> values(gbuffer.depth.size());
	const auto width = static_cast<std::size_t>(gbuffer.width_px);
	const auto compute = [&](std::size_t pixel)
	{
		values[pixel] = pixelValue(static_cast<int>(pixel % width), static_cast<int>(pixel / width), pixel);
	};
	computeValues(tilesOf(gbuffer), settings, values, compute, run);
	return values;
}

} // namespace nook
