// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake.h"

#include "bake/surface_samples.h"
#include "core/costs.h"
#include "core/math.h"
#include "core/parallel.h"
#include "core/system.h"
#include "core/work_units.h"
#include "scene/describe.h"
#include "scene/load_parts.h"
#include "scene/topology.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <system_error>
#include <utility>

namespace nook
{
namespace
{

// The position and side that each value represents: its first vertex with a normal.
std::vector<ReferencePoint> pointsOf(const Level& level, const Unknowns& unknowns)
{
	const std::vector<glm::vec3> normals = vertexNormals(level);
	std::vector<ReferencePoint> points(unknowns.count, {glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0});
	std::vector<uint8_t> done(unknowns.count, 0);
	const auto put = [&](uint32_t i, glm::dvec3 position, glm::dvec3 normal)
	{
		if (done[i] == 0)
		{
			points[i] = {position, normal, 0.0};
			done[i] = 1;
		}
	};
	for (std::size_t v = 0; v < normals.size(); ++v)
	{
		if (normals[v] != glm::vec3(0.0F))
		{
			const glm::dvec3 normal = glm::normalize(glm::dvec3(normals[v]));
			put(unknowns.of_vertex[v], level.positions[v], normal);
			put(unknowns.of_back[v], level.positions[v], -normal);
		}
	}
	return points;
}

VertexBake atPoints(const Tracer& tracer, const Unknowns& unknowns, const BakeSettings& settings, const RunSettings& run)
{
	const Level& level = surfaceOf(tracer, settings);
	std::vector<ReferencePoint> points = pointsOf(level, unknowns);
	for (ReferencePoint& point : points)
	{
		point = startOf(tracer, point, point.normal, settings);
	}
	ReferenceSettings how = raysOf(settings, settings.rays, settings.seed);
	how.measure = settings.bent ? ReferenceMeasure::bent : ReferenceMeasure::obscurance;
	const std::vector<ReferenceValue> values = referenceAtPoints(tracer, points, how, run);
	VertexBake bake;
	FittedValues at_points;
	double squares = 0.0;
	for (const ReferenceValue& value : values)
	{
		squares += value.standard_error * value.standard_error;
		bake.rays += static_cast<std::size_t>(value.rays);
		at_points.values.push_back(static_cast<float>(value.visibility));
		if (settings.bent)
		{
			at_points.bent.emplace_back(value.bent);
		}
	}
	bake.points = values.size();
	at_points.standard_error = std::sqrt(squares / static_cast<double>(values.size()));
	take(bake, level, unknowns, at_points);
	return bake;
}

VertexBake overSurface(const Tracer& tracer, const Unknowns& unknowns, const BakeSettings& settings, const RunSettings& run)
{
	const Level& level = surfaceOf(tracer, settings);
	const std::vector<double> areas = areasOf(level);
	const int rays = std::min(settings.rays, kRaysOfPoint);
	const double all = static_cast<double>(unknowns.count) * settings.rays;
	const SamplePlaces places(level, samplesOfTriangles(areas, static_cast<std::size_t>(std::ceil(all / rays))), settings.seed);
	if (isShare(run)) // without the samples of other shares there is nothing to fit, and a block of them at a time is enough
	{
		std::vector<SurfaceSample> block;
		const auto place_block = [&](std::size_t first, std::size_t size)
		{
			block.resize(size);
			places.place(first, block);
			return std::span(block);
		};
		traceSamples(tracer, level, places.count(), place_block, settings, rays, settings.seed, run, "rays");
		VertexBake none;
		const FittedValues nothing{std::vector<float>(unknowns.count, 1.0F),
								   std::vector<glm::dvec3>(settings.bent ? unknowns.count : 0, glm::dvec3(0.0)), 0.0};
		take(none, level, unknowns, nothing);
		return none;
	}
	std::vector<SurfaceSample> samples = places.all();
	traceSamples(tracer, level, samples, settings, rays, settings.seed, run, "rays");
	const ProgressCounter stage(run.progress, "fit");
	const FittedValues fitted = fitValues(level, areas, unknowns, samples, settings);
	VertexBake bake;
	bake.points = samples.size();
	bake.rays = samples.size() * static_cast<std::size_t>(rays);
	countUnseen(samples, bake);
	take(bake, level, unknowns, fitted);
	return bake;
}

constexpr std::size_t kVotes = 9;
constexpr int kNeeded = 7; // tolerates a leak or a flipped sheet; otherwise backs on all sides

// Interpolates the values of the sample's side.
template <class Value>
Value valueAt(const Level& baked, const SurfaceSample& sample, const std::vector<Value>& front, const std::vector<Value>& back)
{
	return interpolated(sample.back && !back.empty() ? back : front, baked.triangles[sample.triangle], sample.b, sample.c);
}

constexpr double kSameDepth = 1e-3; // relative depth: above the precision of 24-bit depth in a level, below visible contact

// Value of the side that was hit; NaN if a vertex has none.
float valueOf(const Level& level, const BakedValues& baked, const RayHit& hit)
{
	const glm::uvec3 triangle = level.triangles[hit.triangle];
	const glm::vec2 at(hit.barycentric);
	const float value = interpolated(hit.front ? baked.front : baked.back, triangle, at.x, at.y);
	const Material& material = level.material_list[level.materials[hit.triangle]];
	const auto image = static_cast<std::size_t>(std::max(material.occlusion, 0));
	if (material.occlusion < 0 || image >= baked.pages.size() || baked.pages[image].width_px == 0 ||
		(!hit.front && material.two_sided))
	{
		return value;
	}
	const auto texture = alphaAt(baked.pages[image], glm::dvec2(interpolated(baked.uvs, triangle, at.x, at.y)));
	return value * static_cast<float>(texture);
}

} // namespace

VertexBake bakeVertices(const Tracer& tracer, const BakeSettings& settings, const RunSettings& run)
{
	assert(settings.rays >= 1 && settings.radius_m > 0.0 && settings.normals != NormalKind::from_depth);
	if (settings.max_error > 0.0)
	{
		return refineBake(tracer, settings, run);
	}
	const Unknowns unknowns = unknownsOf(surfaceOf(tracer, settings), settings.sides);
	VertexBake bake =
		settings.fit == BakeFit::points ? atPoints(tracer, unknowns, settings, run) : overSurface(tracer, unknowns, settings, run);
	bake.unknowns = unknowns.count;
	return bake;
}

std::size_t alignSheets(Level& level, int threads)
{
	const auto isSheet = [&level](std::size_t t)
	{
		return level.material_list[level.materials[t]].two_sided;
	};
	if (std::none_of(level.material_list.begin(), level.material_list.end(), [](const auto& one) { return one.two_sided; }))
	{
		return 0;
	}
	const std::vector<uint32_t> places = weldPositions(level.positions, threads);
	std::vector<glm::dvec3> sums(level.positions.size(), glm::dvec3(0.0));
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		for (int corner = 0; isSheet(t) && corner < 3; ++corner)
		{
			sums[places[level.triangles[t][corner]]] += twiceAreaOf(level, t);
		}
	}
	std::size_t turned = 0;
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		const glm::dvec3 own = isSheet(t) ? twiceAreaOf(level, t) : glm::dvec3(0.0);
		bool against = own != glm::dvec3(0.0);
		for (int corner = 0; against && corner < 3; ++corner)
		{
			against = glm::dot(own, sums[places[level.triangles[t][corner]]]) < 0.0;
		}
		if (against)
		{
			std::swap(level.triangles[t].y, level.triangles[t].z);
			turned += 1;
		}
	}
	return turned;
}

void turnBack(Level& level, VertexBake& bake, std::span<const uint8_t> turned)
{
	if (turned.empty())
	{
		return;
	}
	std::vector<uint8_t> seen(level.positions.size(), 0); // 1: by a triangle that was not turned
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		glm::uvec3& corner = level.triangles[t];
		const bool is_turned = turned[bake.refined ? bake.split.origins[t] : t] != 0;
		for (int k = 0; k < 3; ++k)
		{
			seen[corner[k]] |= is_turned ? 2U : 1U;
		}
		if (is_turned)
		{
			std::swap(corner.y, corner.z);
		}
	}
	for (std::size_t v = 0; v < seen.size() && !bake.back.empty(); ++v)
	{
		if (seen[v] == 2)
		{
			std::swap(bake.visibility[v], bake.back[v]);
			if (!bake.bent_back.empty())
			{
				std::swap(bake.bent[v], bake.bent_back[v]);
			}
		}
	}
}

bool takesValues(const std::string& path, const Level& level)
{
	const std::string ending = endingOf(path);
	return (ending == ".gltf" || ending == ".glb") &&
		   std::none_of(level.meshes.begin(), level.meshes.end(), [](const Mesh& mesh) { return mesh.around; });
}

bool isBuried(const Tracer& tracer, glm::dvec3 origin, glm::dvec3 normal)
{
	std::array<float, kVotes> x{};
	std::array<float, kVotes> y{};
	std::array<float, kVotes> z{};
	const glm::dvec3 other = std::fabs(normal.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
	const glm::dvec3 tangent = glm::normalize(glm::cross(other, normal));
	const glm::dvec3 bitangent = glm::cross(normal, tangent);
	const double golden_rad = kPi * (3.0 - std::sqrt(5.0));
	for (std::size_t i = 0; i < kVotes; ++i)
	{
		const double square = static_cast<double>(i) / static_cast<double>(kVotes); // radius in the disk
		const SinCos a = sinCosOf(golden_rad * static_cast<double>(i));
		const double radius = std::sqrt(square);
		const glm::dvec3 direction = radius * a.cos * tangent + radius * a.sin * bitangent + std::sqrt(1.0 - square) * normal;
		x[i] = static_cast<float>(direction.x);
		y[i] = static_cast<float>(direction.y);
		z[i] = static_cast<float>(direction.z);
	}
	std::array<int8_t, kVotes> sides{};
	const auto some = [&](std::size_t first, std::size_t count)
	{
		const Directions directions{std::span(x).subspan(first, count), std::span(y).subspan(first, count),
									std::span(z).subspan(first, count)};
		tracer.sides(origin, directions, std::span(sides).subspan(first, count));
	};
	// Most points are in the open, where two directions suffice.
	some(0, 2);
	if (sides[0] >= 0 && sides[1] >= 0)
	{
		return false;
	}
	some(2, kVotes - 2);
	return std::accumulate(sides.begin(), sides.end(), 0) <= -kNeeded;
}

BakeCheck checkValues(const Tracer& tracer, const Level& baked, const std::function<double(const SurfaceSample&)>& valueOf,
					  const BakeSettings& settings, std::size_t points, const RunSettings& run,
					  const std::function<glm::dvec3(const SurfaceSample&)>& bentOf)
{
	constexpr int kRays = 1024;              // standard error of about 0.006, which adds 1 % to a root mean square of 0.05
	constexpr uint32_t kOther = 0x5eed0ffUL; // a sequence that the bake does not use
	std::vector<SurfaceSample> samples = placeByArea(baked, areasOf(baked), points, settings.seed ^ kOther);
	traceSamples(tracer, baked, samples, settings, kRays, settings.seed ^ kOther, run, "check");
	BakeCheck check;
	for (const SurfaceSample& sample : samples)
	{
		check.missed += sample.missed ? 1U : 0U;
		if (sample.buried)
		{
			check.buried += 1;
			continue;
		}
		const double off = valueOf(sample) - static_cast<double>(sample.visibility);
		check.points += 1;
		check.rmse += off * off;
		check.rmse_seen += sample.shut ? 0.0 : off * off;
		check.shut += sample.shut ? 1U : 0U;
		check.bias += off;
		check.rmse_without += static_cast<double>(sample.visibility) * static_cast<double>(sample.visibility);
		check.standard_error += static_cast<double>(sample.standard_error) * static_cast<double>(sample.standard_error);
		if (bentOf)
		{
			check.angle_rad += std::acos(std::clamp(glm::dot(bentOf(sample), glm::dvec3(sample.bent)), -1.0, 1.0));
		}
	}
	const auto count = static_cast<double>(std::max<std::size_t>(check.points, 1));
	check.rays = samples.size() * static_cast<std::size_t>(kRays);
	check.rmse = std::sqrt(check.rmse / count);
	check.rmse_seen = std::sqrt(check.rmse_seen / static_cast<double>(std::max<std::size_t>(check.points - check.shut, 1)));
	check.rmse_without = settings.base ? std::sqrt(check.rmse_without / count) : 0.0;
	check.bias /= count;
	check.standard_error = std::sqrt(check.standard_error / count);
	check.angle_rad /= count;
	return check;
}

BakeCheck checkBake(const Tracer& tracer, const Level& baked, const VertexBake& bake, const BakeSettings& settings,
					std::size_t points, const RunSettings& run)
{
	assert(bake.visibility.size() == baked.positions.size());
	const auto valueOf = [&](const SurfaceSample& sample)
	{
		return static_cast<double>(valueAt(baked, sample, bake.visibility, bake.back));
	};
	if (!settings.bent)
	{
		return checkValues(tracer, baked, valueOf, settings, points, run);
	}
	const auto bentOf = [&](const SurfaceSample& sample)
	{
		const glm::dvec3 bent(valueAt(baked, sample, bake.bent, bake.bent_back));
		const double length = glm::length(bent);
		return length > 0.0 ? bent / length : bent;
	};
	return checkValues(tracer, baked, valueOf, settings, points, run, bentOf);
}

std::vector<uint8_t> alignStatic(GBuffer& fixed, const GBuffer& gbuffer)
{
	assert(fixed.depth.size() == gbuffer.depth.size());
	std::vector<uint8_t> same(gbuffer.depth.size(), 0);
	for (std::size_t i = 0; i < same.size(); ++i)
	{
		const auto here = static_cast<double>(gbuffer.depth[i]);
		const auto there = static_cast<double>(fixed.depth[i]);
		const double unsure = gbuffer.depth_error_m.empty() ? 0.0 : static_cast<double>(gbuffer.depth_error_m[i]);
		const bool sky = std::isinf(here) && std::isinf(there);
		if (sky || std::fabs(here - there) <= kSameDepth * here + 4.0 * unsure) // false if one is infinite
		{
			same[i] = 1;
			fixed.depth[i] = gbuffer.depth[i];
			fixed.normals[i] = gbuffer.normals[i];
		}
	}
	fixed.view_error_m = gbuffer.view_error_m;
	fixed.depth_error_m = gbuffer.depth_error_m;
	return same;
}

BakedPicture bakedPicture(const Tracer& tracer, const BakedValues& baked, const GBuffer& gbuffer, const RunSettings& run)
{
	const std::size_t count = gbuffer.depth.size();
	assert(gbuffer.normals.size() == count && baked.front.size() == tracer.level().positions.size());
	BakedPicture picture;
	picture.fixed = castGBuffer(tracer, gbuffer.view, gbuffer.width_px, gbuffer.height_px, NormalKind::geometric, run);
	picture.is_baked = alignStatic(picture.fixed, gbuffer);
	picture.values.assign(count, 0.0F);
	const Projector projector(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px);
	const glm::dmat4 world_from_camera = glm::inverse(gbuffer.view.camera_from_world);
	const glm::dmat3 turn_to_world(world_from_camera);
	const auto width = static_cast<std::size_t>(gbuffer.width_px);
	ProgressCounter progress(run.progress, "baked pixels", static_cast<std::size_t>(gbuffer.height_px));
	const auto row = [&](std::size_t y)
	{
		for (std::size_t i = y * width; i < (y + 1) * width; ++i)
		{
			if (picture.is_baked[i] == 0 || std::isinf(gbuffer.depth[i]))
			{
				picture.is_baked[i] = 0;
				continue;
			}
			const ViewLine line = projector.lineOf({static_cast<double>(i - y * width) + 0.5, static_cast<double>(y) + 0.5});
			const RayHit hit = tracer.nearest(glm::dvec3(world_from_camera * glm::dvec4(line.at, 1.0)), turn_to_world * line.along,
											  std::numeric_limits<double>::infinity());
			const float value = hit.hit ? valueOf(tracer.level(), baked, hit) : std::numeric_limits<float>::quiet_NaN();
			picture.is_baked[i] = std::isnan(value) ? 0 : 1;
			picture.values[i] = std::isnan(value) ? 0.0F : value;
		}
		progress.finishOne();
	};
	parallelFor(static_cast<std::size_t>(gbuffer.height_px), run.threads, row);
	return picture;
}

AssetEstimate bakeEstimate(const Level& level, const LevelFacts& facts)
{
	std::vector<uint8_t> sides(level.positions.size(), 1); // per vertex
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		for (int corner = 0; corner < 3 && level.material_list[level.materials[t]].two_sided; ++corner)
		{
			sides[level.triangles[t][corner]] = 2;
		}
	}
	std::error_code none;
	const std::uintmax_t size = level.files.empty() ? 0 : std::filesystem::file_size(nativePath(level.files.front()), none);
	const auto values = static_cast<double>(unknownsOf(level, BakeSides::separate, facts.place_of).count);
	AssetEstimate bake;
	bake.bytes = cost::kBakeVertex_bytes * std::accumulate(sides.begin(), sides.end(), 0.0);
	bake.seconds = (BakeSettings{}.rays * values + cost::kBakeCheck_rays) *
				   (cost::kBakeRay_s + cost::kBakeNear_s * std::log2(1.0 + facts.near) +
					cost::kBakeLeaves_s * std::log2(1.0 + facts.near_cover));
	bake.memory_bytes = cost::kLeast_memory + cost::kBakeTriangle_memory * static_cast<double>(level.triangles.size()) +
						cost::kBakeValue_memory * values + cost::kBakeFile_memory * (none ? 0.0 : static_cast<double>(size));
	return bake;
}

} // namespace nook
