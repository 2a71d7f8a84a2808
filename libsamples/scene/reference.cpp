// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/reference.h"

#include "core/decimal.h"
#include "core/lists.h"
#include "core/random.h"
#include "core/round.h"
#include "core/words.h"
#include "core/work_units.h"
#include "pattern/methods.h"
#include "scene/sample_set.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>

namespace nook
{
namespace
{

// Coordinates of many samples, and their values; one per thread.
struct Scratch
{
	std::vector<float> x, y, z, values;
	std::vector<uint8_t> blocked;

	void resize(std::size_t count)
	{
		for (std::vector<float>* v : {&x, &y, &z, &values})
		{
			v->resize(count);
		}
		blocked.resize(count);
	}
	Directions directions() const
	{
		return {x, y, z};
	}
	glm::vec3 operator[](std::size_t i) const
	{
		return {x[i], y[i], z[i]};
	}
	void put(std::size_t i, glm::vec3 p)
	{
		x[i] = p.x;
		y[i] = p.y;
		z[i] = p.z;
	}
};

constexpr int kFirstBatch = 32; // with max_error; each later batch is as large as all previous ones together

SampleDomain domainOf(ReferenceMeasure measure)
{
	return isByRays(measure) ? SampleDomain::hemisphere : measure == ReferenceMeasure::box ? SampleDomain::box : SampleDomain::ball;
}

// Sample sets for one run, and the order in which a point uses them.
class Batches
{
public:
	explicit Batches(const ReferenceSettings& settings)
	{
		assert(settings.rays >= 1 && settings.rays <= kMaxSamples && settings.radius_m > 0.0);
		int spent = 0;
		while (spent < settings.rays)
		{
			const int wanted = settings.max_error > 0.0 ? std::max(kFirstBatch, spent) : settings.rays;
			const int size = std::min(wanted, settings.rays - spent);
			if (m_sets.empty() || m_sets.back().count() != size)
			{
				m_sets.emplace_back(domainOf(settings.measure), size);
			}
			m_order.push_back(m_sets.size() - 1);
			spent += size;
		}
	}

	std::size_t count() const
	{
		return m_order.size();
	}
	const SampleSet& operator[](std::size_t i) const
	{
		return m_sets[m_order[i]];
	}

private:
	std::vector<SampleSet> m_sets;
	std::vector<std::size_t> m_order;
};

// Fills scratch.values with the occlusion in [0, 1] of one placement of the set.
using Fill = std::function<void(const SampleSet& set, Random& random, Scratch& scratch)>;

// Two vectors that complete a right-handed frame with n (T. Duff et al., "Building an Orthonormal Basis, Revisited", 2017).
void frameOf(glm::vec3 n, glm::vec3& tangent, glm::vec3& bitangent)
{
	const float sign = std::copysign(1.0F, n.z);
	const float a = -1.0F / (sign + n.z);
	const float b = n.x * n.y * a;
	tangent = {1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x};
	bitangent = {b, sign + n.y * n.y * a, -n.y};
}

// Rotates from coordinates about +z to coordinates about n.
void turnTo(glm::vec3 n, Scratch& scratch)
{
	glm::vec3 t;
	glm::vec3 b;
	frameOf(n, t, b);
	for (std::size_t i = 0; i < scratch.x.size(); ++i)
	{
		const glm::vec3 p = scratch[i];
		scratch.put(i, t * p.x + b * p.y + n * p.z);
	}
}

// Sum of the directions, each times its open fraction.
glm::dvec3 openSum(const Scratch& scratch)
{
	glm::dvec3 sum(0.0);
	for (std::size_t i = 0; i < scratch.values.size(); ++i)
	{
		sum += static_cast<double>(1.0F - scratch.values[i]) * glm::dvec3(scratch[i]);
	}
	return sum;
}

float falloffAt(float distance_m, const ReferenceSettings& settings, float radius_m, float u_m)
{
	if (!(distance_m < radius_m))
	{
		return 0.0F;
	}
	return settings.falloff == Falloff::linear ? 1.0F - distance_m / radius_m
		   : distance_m <= u_m                 ? distance_m / u_m
											   : u_m / distance_m;
}

void fillObscurance(const Tracer& tracer, const ReferenceSettings& settings, glm::dvec3 origin, glm::vec3 normal,
					const SampleSet& set, Random& random, Scratch& scratch)
{
	const auto radius_m = static_cast<float>(settings.radius_m);
	set.place(random, scratch.x, scratch.y, scratch.z);
	turnTo(normal, scratch);
	if (settings.falloff == Falloff::hard)
	{
		tracer.blocked(origin, scratch.directions(), radius_m, scratch.blocked);
		std::transform(scratch.blocked.begin(), scratch.blocked.end(), scratch.values.begin(),
					   [](uint8_t blocked) { return static_cast<float>(blocked); });
		return;
	}
	const auto u_m = static_cast<float>(settings.falloff_u_m);
	tracer.distances(origin, scratch.directions(), radius_m, scratch.values);
	std::transform(scratch.values.begin(), scratch.values.end(), scratch.values.begin(),
				   [&](float distance_m) { return falloffAt(distance_m, settings, radius_m, u_m); });
}

// Normalises and rounds, so that no component exceeds 1.
glm::vec3 unitOf(glm::dvec3 v)
{
	return glm::clamp(glm::vec3(glm::normalize(v)), -1.0F, 1.0F);
}

// Weight of a batch of n samples, n^1.5: the variance of a spiral's mean decreases about as n^−1.5.
double weightOf(const SampleSet& set)
{
	return set.count() * std::sqrt(static_cast<double>(set.count()));
}

// The weighted mean over batches.
ReferenceValue estimate(const Batches& batches, const ReferenceSettings& settings, Random& random, const Fill& fill)
{
	thread_local Scratch scratch;
	double weights = 0.0;
	double occlusion = 0.0;
	double squared_error = 0.0;
	glm::dvec3 open(0.0);
	ReferenceValue value;
	for (std::size_t i = 0; i < batches.count(); ++i)
	{
		const SampleSet& set = batches[i];
		scratch.resize(static_cast<std::size_t>(set.count()));
		fill(set, random, scratch);
		const double sum = std::accumulate(scratch.values.begin(), scratch.values.end(), 0.0);
		const double weight = weightOf(set);
		weights += weight;
		occlusion += weight * sum / set.count();
		squared_error += weight * weight * set.squaredError(scratch.values);
		if (settings.measure == ReferenceMeasure::bent)
		{
			open += weight / set.count() * openSum(scratch);
		}
		value.rays += set.count();
		value.visibility = 1.0 - occlusion / weights;
		value.standard_error = std::sqrt(squared_error) / weights;
		if (value.standard_error <= settings.max_error)
		{
			break;
		}
	}
	const double length = glm::length(open);
	value.bent = length > 0.0 ? unitOf(open) : glm::vec3(0.0F);
	return value;
}

// Offsets of the volume's samples in metres; `camera` holds the axes of the box.
void placeVolume(const ReferenceSettings& settings, glm::vec3 normal, const glm::mat3& camera, const SampleSet& set, Random& random,
				 Scratch& scratch)
{
	set.place(random, scratch.x, scratch.y, scratch.z);
	const auto radius_m = static_cast<float>(settings.radius_m);
	for (std::size_t i = 0; i < scratch.x.size(); ++i)
	{
		glm::vec3 p = scratch[i];
		if (settings.measure == ReferenceMeasure::hemisphere) // VO §4.4: mirrors samples below the tangent plane
		{
			p -= 2.0F * std::min(0.0F, p.x * normal.x + p.y * normal.y + p.z * normal.z) * normal;
		}
		scratch.put(i, radius_m * (settings.measure == ReferenceMeasure::box ? camera * p : p));
	}
}

// Start of a point's rays. `tracer_error_m`: Tracer::error().
glm::dvec3 originOf(const ReferencePoint& point, const ReferenceSettings& settings, double tracer_error_m)
{
	return point.position + (point.lift_m + settings.lift_m + tracer_error_m) * point.normal;
}

// By rays, or by samples of the volume inside the geometry; `camera` holds the axes of the box.
ReferenceValue atPoint(const Tracer& tracer, const ReferencePoint& point, const glm::mat3& camera,
					   const ReferenceSettings& settings, const Batches& batches, Random& random)
{
	const glm::dvec3 origin = originOf(point, settings, tracer.error());
	const glm::vec3 normal(point.normal);
	const Fill fill = [&](const SampleSet& set, Random& r, Scratch& scratch)
	{
		if (isByRays(settings.measure))
		{
			fillObscurance(tracer, settings, origin, normal, set, r, scratch);
			return;
		}
		placeVolume(settings, normal, camera, set, r, scratch);
		matterOfGeometry(tracer, origin, scratch.directions(), scratch.values);
	};
	ReferenceValue value = estimate(batches, settings, random, fill);
	if (settings.measure == ReferenceMeasure::bent && value.bent == glm::vec3(0.0F))
	{
		value.bent = unitOf(point.normal);
	}
	return value;
}

// A picture has about so many tiles, enough for shares and threads to take about the same time.
constexpr std::size_t kTiles = 512;
constexpr std::size_t kLeastTile_px = 8;

// Pixels of a G-buffer as world-space points.
struct PixelPoints
{
	explicit PixelPoints(const GBuffer& of)
		: gbuffer(of), projector(of.view.projection, of.width_px, of.height_px),
		  world_from_camera(glm::inverse(of.view.camera_from_world)), turn(world_from_camera)
	{
	}

	ReferencePoint operator()(int x, int y) const
	{
		const std::size_t pixel = gbuffer.index(x, y);
		const ViewLine line = projector.lineOf({x + 0.5, y + 0.5});
		const auto depth_m = static_cast<double>(gbuffer.depth[pixel]);
		const glm::dvec3 normal(gbuffer.normals[pixel]);
		// Errors off the surface come from the depth, at best a 32-bit number, and from camera matrices of 32 bits.
		const double error_m =
			gbuffer.depth_error_m.empty() ? depth_m * kUnitRoundoff : static_cast<double>(gbuffer.depth_error_m[pixel]);
		const double lift_m = error_m * std::max(std::fabs(glm::dot(line.along, normal)), 1e-3) + gbuffer.view_error_m;
		return {glm::dvec3(world_from_camera * glm::dvec4(line.at + depth_m * line.along, 1.0)), glm::normalize(turn * normal),
				lift_m};
	}

	const GBuffer& gbuffer;
	Projector projector;
	glm::dmat4 world_from_camera;
	glm::dmat3 turn; // from view space to world space
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

// Units of points of lists.
constexpr std::size_t kChunk = 256;

std::vector<std::vector<std::size_t>> chunksOf(std::size_t count)
{
	std::vector<std::vector<std::size_t>> chunks((count + kChunk - 1) / kChunk);
	for (std::size_t i = 0; i < count; ++i)
	{
		chunks[i / kChunk].push_back(i);
	}
	return chunks;
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

void checkDepths(const GBuffer& gbuffer)
{
	for (std::size_t i = 0; i < gbuffer.depth.size(); ++i)
	{
		const auto depth_m = static_cast<double>(gbuffer.depth[i]);
		if (std::isfinite(depth_m) && !isLength(depth_m))
		{
			const auto width = static_cast<std::size_t>(gbuffer.width_px);
			refuseInput("depth, pixel " + std::to_string(i % width) + "," + std::to_string(i / width), numberText(depth_m) + " m",
						"lengths from " + numberText(kLeastLength_m) + " to " + numberText(kMostLength_m) + " m");
		}
	}
}

constexpr std::size_t kVotes = 9; // odd: surfaces on both sides cannot tie

// Evenly distributed directions, none along an axis.
struct VoteDirections
{
	std::array<float, kVotes> x{}, y{}, z{};

	VoteDirections()
	{
		Recipe recipe;
		recipe.domain = Domain::sphere;
		recipe.method = Method::vogel;
		recipe.count = static_cast<int>(kVotes);
		const std::vector<glm::dvec3> points = vogelPoints(Layout(recipe));
		for (std::size_t i = 0; i < kVotes; ++i)
		{
			x[i] = static_cast<float>(points[i].x);
			y[i] = static_cast<float>(points[i].y);
			z[i] = static_cast<float>(points[i].z);
		}
	}
};

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
	computeValues(chunksOf(count), settings, values, compute, run);
	return values;
}

std::vector<std::vector<double>> visibilitiesWithin(const Tracer& tracer, std::span<const ReferencePoint> points,
													const ReferenceSettings& settings, std::span<const double> radii_m,
													const RunSettings& run)
{
	assert(settings.measure == ReferenceMeasure::obscurance && settings.falloff == Falloff::linear && settings.max_error == 0.0);
	const SampleSet set(domainOf(settings.measure), settings.rays);
	const auto reach_m = static_cast<float>(*std::max_element(radii_m.begin(), radii_m.end()));
	std::vector<std::vector<double>> values(radii_m.size(), std::vector<double>(points.size()));
	const auto compute = [&](std::size_t i)
	{
		thread_local Scratch scratch;
		scratch.resize(static_cast<std::size_t>(set.count()));
		Random random(settings.seed, i);
		set.place(random, scratch.x, scratch.y, scratch.z);
		turnTo(glm::vec3(points[i].normal), scratch);
		tracer.distances(originOf(points[i], settings, tracer.error()), scratch.directions(), reach_m, scratch.values);
		for (std::size_t r = 0; r < radii_m.size(); ++r)
		{
			const auto radius_m = static_cast<float>(radii_m[r]);
			const double sum = sumOver(scratch.values, [&](float distance_m)
									   { return static_cast<double>(falloffAt(distance_m, settings, radius_m, 0.0F)); });
			values[r][i] = 1.0 - weightOf(set) * sum / set.count() / weightOf(set);
		}
	};
	const std::vector<std::vector<std::size_t>> chunks = chunksOf(points.size());
	runStage({"rays", chunks.size(), [&](std::size_t unit) { return static_cast<double>(chunks[unit].size()) * settings.rays; },
			  [&](std::size_t unit) { std::for_each(chunks[unit].begin(), chunks[unit].end(), compute); },
			  [&](std::size_t unit, Archive& archive)
			  {
				  for (std::vector<double>& of_radius : values)
				  {
					  for (const std::size_t i : chunks[unit])
					  {
						  archive(of_radius[i]);
					  }
				  }
			  }},
			 run);
	return values;
}

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
	for (std::size_t pixel = 0; pixel < gbuffer.depth.size(); ++pixel)
	{
		if (std::isfinite(gbuffer.depth[pixel]))
		{
			const auto i = static_cast<int>(pixel);
			reach.add(originOf(pixels(i % gbuffer.width_px, i / gbuffer.width_px), settings, error_m));
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
	const Batches batches(settings);
	const DepthMatter depth_matter = from_depth ? DepthMatter(gbuffer, run) : DepthMatter();

	const auto pixelValue = [&](int x, int y, std::size_t pixel)
	{
		Random random(settings.seed, pixel);
		if (!from_depth)
		{
			ReferenceValue value = atPoint(*tracer, pixels(x, y), glm::mat3(pixels.turn), settings, batches, random);
			if (settings.measure == ReferenceMeasure::bent)
			{
				value.bent = unitOf(glm::dvec3(value.bent) * pixels.turn); // multiplied by the transpose: to view space
			}
			return value;
		}
		const glm::dvec3 position = positionOf(gbuffer, pixels.projector, x, y);
		const Fill fill = [&](const SampleSet& set, Random& r, Scratch& scratch)
		{
			placeVolume(settings, gbuffer.normals[pixel], glm::mat3(1.0F), set, r, scratch);
			depth_matter.sample(position, scratch.directions(), scratch.values);
		};
		return estimate(batches, settings, random, fill);
	};

	std::vector<ReferenceValue> values(gbuffer.depth.size());
	const auto width = static_cast<std::size_t>(gbuffer.width_px);
	computeValues(
		tilesOf(gbuffer), settings, values,
		[&](std::size_t pixel)
		{ values[pixel] = pixelValue(static_cast<int>(pixel % width), static_cast<int>(pixel / width), pixel); },
		run);
	return values;
}

bool isInMatter(const Tracer& tracer, glm::dvec3 position)
{
	static const VoteDirections directions;
	std::array<int8_t, kVotes> sides{};
	tracer.sides(position, {directions.x, directions.y, directions.z}, sides);
	return std::accumulate(sides.begin(), sides.end(), 0) < 0;
}

void matterOfGeometry(const Tracer& tracer, glm::dvec3 origin, const Directions& offsets, std::span<float> matter)
{
	thread_local std::vector<uint8_t> hidden;
	hidden.resize(matter.size());
	tracer.blocked(origin, offsets, 1.0F, hidden);
	for (std::size_t i = 0; i < matter.size(); ++i)
	{
		const glm::dvec3 position = origin + glm::dvec3(glm::vec3(offsets.x[i], offsets.y[i], offsets.z[i]));
		matter[i] = hidden[i] != 0 && isInMatter(tracer, position) ? 1.0F : 0.0F;
	}
}

DepthMatter::DepthMatter(const GBuffer& gbuffer, const RunSettings& run)
	: m_width_px(gbuffer.width_px), m_height_px(gbuffer.height_px)
{
	m_projector.emplace_back(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px);
	const Projector& projector = m_projector.front();
	GBuffer from_depth = gbuffer;
	normalsFromDepth(from_depth, run);
	m_planes.resize(gbuffer.depth.size());
	for (int y = 0; y < m_height_px; ++y)
	{
		for (int x = 0; x < m_width_px; ++x)
		{
			const std::size_t pixel = gbuffer.index(x, y);
			if (!std::isfinite(gbuffer.depth[pixel]))
			{
				m_planes[pixel] = {{0.0, 0.0, 0.0}, -1.0}; // no matter
				continue;
			}
			glm::dvec3 normal(from_depth.normals[pixel]);
			if (glm::dot(normal, projector.lineOf({x + 0.5, y + 0.5}).along) > -1e-6)
			{
				normal = {0.0, 0.0, 1.0}; // edge-on: use a plane across the view instead
			}
			m_planes[pixel] = {normal, glm::dot(normal, positionOf(gbuffer, projector, x, y))};
		}
	}
}

void DepthMatter::sample(glm::dvec3 origin, const Directions& offsets, std::span<float> matter) const
{
	double sum = 0.0;
	std::size_t known = 0;
	for (std::size_t i = 0; i < matter.size(); ++i)
	{
		const glm::dvec3 position = origin + glm::dvec3(glm::vec3(offsets.x[i], offsets.y[i], offsets.z[i]));
		matter[i] = -1.0F; // unknown
		if (position.z < 0.0)
		{
			const glm::dvec2 pixel = m_projector.front().pixelOf(position);
			if (pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < m_width_px && pixel.y < m_height_px)
			{
				const Plane& plane = m_planes[static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(m_width_px) +
											  static_cast<std::size_t>(pixel.x)];
				matter[i] = glm::dot(plane.normal, position) < plane.offset ? 1.0F : 0.0F;
				sum += static_cast<double>(matter[i]);
				known += 1;
			}
		}
	}
	const float mean = known > 0 ? static_cast<float>(sum / static_cast<double>(known)) : 0.0F;
	for (float& m : matter)
	{
		m = m < 0.0F ? mean : m;
	}
}

} // namespace nook
