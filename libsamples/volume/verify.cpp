// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/verify.h"

#include "core/parallel.h"
#include "core/random.h"
#include "scene/camera_choice.h"
#include "volume/drop.h"
#include "volume/evaluate.h"
#include "volume/receivers.h"
#include "volume/sight.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

// A 16 : 9 grid of at least `count` points.
struct Grid
{
	int columns = 1;
	int rows = 1;
};

Grid gridOf(int count)
{
	const int columns = static_cast<int>(std::ceil(std::sqrt(count * 16.0 / 9.0)));
	return {columns, (count + columns - 1) / columns};
}

glm::dvec3 acrossOf(const Level& level, std::size_t triangle)
{
	const glm::uvec3 corner = level.triangles[triangle];
	const glm::dvec3 a = level.positions[corner.x];
	return glm::cross(level.positions[corner.y] - a, level.positions[corner.z] - a);
}

void addViews(const Tracer& tracer, const ReceiverSettings& settings, std::vector<ReferencePoint>& points, const RunSettings& run)
{
	const Grid grid = gridOf(settings.per_view);
	for (const LevelCamera& camera : chooseCameras(tracer, settings.views, run))
	{
		const Eye eye(tracer, camera, grid.columns, grid.rows);
		for (int i = 0; i < grid.columns * grid.rows; ++i)
		{
			if (const auto seen = eye.at(i % grid.columns + 0.5, static_cast<double>(i / grid.columns) + 0.5))
			{
				points.push_back(*seen);
			}
		}
	}
}

// Finds the triangle at a given fraction of the total area.
class ByArea
{
public:
	explicit ByArea(const Level& level) : m_until(level.triangles.size())
	{
		double sum = 0.0;
		for (std::size_t i = 0; i < m_until.size(); ++i)
		{
			const bool there = level.material_list[level.materials[i]].coverage > 0.0;
			sum += there ? glm::length(acrossOf(level, i)) : 0.0;
			m_until[i] = sum;
		}
	}

	bool empty() const
	{
		return m_until.empty() || !(m_until.back() > 0.0);
	}

	std::size_t at(double share) const
	{
		const auto found = std::upper_bound(m_until.begin(), m_until.end(), share * m_until.back());
		return static_cast<std::size_t>(std::min(found, m_until.end() - 1) - m_until.begin());
	}

private:
	std::vector<double> m_until;
};

// On a random side, if that is in the open.
void addIfOpen(const Tracer& tracer, const MaterialSides& materials, glm::dvec3 position, glm::dvec3 normal,
			   std::vector<ReferencePoint>& points)
{
	if (isOpen(tracer, materials, position, normal, static_cast<uint32_t>(points.size())))
	{
		points.push_back({position, normal, 0.0});
	}
}

void addSurfaces(const Tracer& tracer, double distance_m, const ReceiverSettings& settings, const MaterialSides& materials,
				 std::vector<ReferencePoint>& points)
{
	const Level& level = tracer.level();
	const ByArea by_area(level);
	Random random(settings.seed, 0xa0e);
	for (int i = 0; i < settings.by_area + settings.near_creases && !by_area.empty(); ++i)
	{
		const std::size_t triangle = by_area.at(random.uniform());
		const glm::uvec3 corner = level.triangles[triangle];
		const unsigned turn = random.below(3);
		const glm::dvec3 a = level.positions[corner[static_cast<int>(turn)]];
		const glm::dvec3 b = level.positions[corner[static_cast<int>((turn + 1) % 3)]];
		const glm::dvec3 c = level.positions[corner[static_cast<int>((turn + 2) % 3)]];
		double u = random.uniform();
		double v = random.uniform();
		const glm::dvec3 across = acrossOf(level, triangle);
		const double area = glm::length(across);
		if (i >= settings.by_area)
		{
			// Next to the edge a–b, a hundredth of δ away from it, or half of the triangle's height.
			const double height = area / std::max(glm::length(b - a), 1e-300);
			v = std::min(0.5, 0.01 * distance_m / height);
			u *= 1.0 - v;
		}
		const std::size_t material = level.materials[triangle];
		const bool back = level.material_list[material].two_sided || materials.oriented[material] == 0; // see receiverSides()
		const glm::dvec3 normal = across * ((back && random.below(2) == 0 ? -1.0 : 1.0) / area);
		addIfOpen(tracer, materials, pointOf({a, b, c}, u, v), normal, points);
	}
}

} // namespace

std::vector<ReferencePoint> sampleReceivers(const Tracer& tracer, double distance_m, const ReceiverSettings& settings,
											const RunSettings& run, const MaterialSides* materials)
{
	std::vector<ReferencePoint> points;
	if (settings.views > 0 && settings.per_view > 0)
	{
		addViews(tracer, settings, points, run);
	}
	addSurfaces(tracer, distance_m, settings, materials != nullptr ? *materials : materialSides(tracer, run), points);
	return points;
}

std::vector<double> sumsAt(const VolumeSet& volumes, std::span<const ReferencePoint> points, const RunSettings& run)
{
	constexpr std::size_t kBlock = 64;
	const VolumeEvaluator evaluator(volumes, run);
	std::vector<double> sums(points.size());
	ProgressCounter progress(run.progress, "sums", (points.size() + kBlock - 1) / kBlock);
	parallelFor((points.size() + kBlock - 1) / kBlock, run.threads,
				[&](std::size_t block)
				{
					for (std::size_t i = block * kBlock; i < std::min(points.size(), (block + 1) * kBlock); ++i)
					{
						sums[i] = evaluator.occlusion(points[i].position, points[i].normal);
					}
					progress.finishOne();
				});
	return sums;
}

VerifyResult verifyVolumes(const VolumeSet& all, const VolumeSet& kept, std::span<const ReferencePoint> receivers,
						   const RunSettings& run, std::span<const double> behind)
{
	assert(behind.empty() || behind.size() == receivers.size());
	const std::vector<double> before = sumsAt(all, receivers, run);
	const std::vector<double> after = sumsAt(kept, receivers, run);
	VerifyResult result;
	result.receivers = receivers.size();
	for (std::size_t i = 0; i < receivers.size(); ++i)
	{
		const double difference = std::fabs(before[i] - after[i]);
		const double compensated = std::fabs(kept.compensation.at(before[i]) - kept.compensation.at(after[i]));
		result.mean += difference;
		result.mean_compensated += compensated;
		result.greatest_compensated = std::max(result.greatest_compensated, compensated);
		const double from_behind = behind.empty() ? 0.0 : behind[i];
		const double seen = before[i] - from_behind; // sum over all volumes
		const double seen_compensated = std::fabs(kept.compensation.at(std::max(0.0, seen)) - kept.compensation.at(after[i]));
		result.behind += from_behind > kHiddenLeast ? 1U : 0U;
		result.greatest_behind = std::max(result.greatest_behind, from_behind);
		result.greatest_seen = std::max(result.greatest_seen, std::fabs(seen - after[i]));
		result.greatest_seen_compensated = std::max(result.greatest_seen_compensated, seen_compensated);
		result.mean_seen += std::fabs(seen - after[i]);
		if (difference > result.greatest || i == 0)
		{
			result.greatest = difference;
			result.worst_position = receivers[i].position;
			result.worst_normal = receivers[i].normal;
			result.worst_all = before[i];
			result.worst_kept = after[i];
		}
	}
	const double count = std::max(1.0, static_cast<double>(receivers.size()));
	result.mean /= count;
	result.mean_seen /= count;
	result.mean_compensated /= count;
	return result;
}

} // namespace nook
