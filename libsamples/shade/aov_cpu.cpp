// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV), §5.
#include "shade/aov.h"

#include "core/parallel.h"
#include "shade/block.h"
#include "shade/kernels.h"
#include "volume/directions.h"
#include "volume/evaluate.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <functional>
#include <numeric>

namespace nook
{
namespace
{

constexpr double kUnitRoundoff = 0x1p-24;

// The surface that a pixel shows, in the world.
struct Receiver
{
	glm::dvec3 position{0.0};
	glm::dvec3 normal{0.0};
	double error_m = 0.0; // by which the position may be off
};

class Receivers
{
public:
	explicit Receivers(const GBuffer& gbuffer)
		: m_gbuffer(gbuffer), m_projector(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px),
		  m_world_from_camera(glm::inverse(gbuffer.view.camera_from_world))
	{
		assert(gbuffer.normals.size() == gbuffer.depth.size());
	}

	bool any(int x, int y) const
	{
		return std::isfinite(m_gbuffer.depth[index(x, y)]);
	}

	Receiver at(int x, int y) const
	{
		const std::size_t i = index(x, y);
		const double rounding_m = m_gbuffer.depth_error_m.empty() ? static_cast<double>(m_gbuffer.depth[i]) * kUnitRoundoff
																  : static_cast<double>(m_gbuffer.depth_error_m[i]);
		return {glm::dvec3(m_world_from_camera * glm::dvec4(positionOf(m_gbuffer, m_projector, x, y), 1.0)),
				glm::normalize(glm::dmat3(m_world_from_camera) * glm::dvec3(m_gbuffer.normals[i])),
				rounding_m + m_gbuffer.view_error_m};
	}

private:
	std::size_t index(int x, int y) const
	{
		return static_cast<std::size_t>(y) * static_cast<std::size_t>(m_gbuffer.width_px) + static_cast<std::size_t>(x);
	}

	const GBuffer& m_gbuffer;
	Projector m_projector;
	glm::dmat4 m_world_from_camera;
};

// One pixel of every cell of settings.every_px, its upper left one → the volumes that hold them.
uint64_t evaluate(const Receivers& receivers, const VolumeEvaluator& evaluator, const VolumeSet& volumes,
				  const AovSettings& settings, const RunSettings& run, PicturePlane& cells)
{
	const std::vector<glm::vec4> directions = settings.mask ? maskDirections(settings.directions) : std::vector<glm::vec4>{};
	const auto rows = static_cast<std::size_t>(cells.height);
	std::vector<uint64_t> held(rows);
	ProgressCounter progress(run.progress, settings.mask ? "aov-mask" : "aov", rows);
	const auto row = [&](std::size_t y)
	{
		for (int x = 0; x < cells.width; ++x)
		{
			const int pixel_x = x * settings.every_px;
			const int pixel_y = static_cast<int>(y) * settings.every_px;
			double visibility = 1.0;
			if (receivers.any(pixel_x, pixel_y))
			{
				const Receiver at = receivers.at(pixel_x, pixel_y);
				if (settings.mask)
				{
					const VolumeMask mask = evaluator.mask(at.position, at.normal, directions, at.error_m);
					visibility = mask.visibility;
					held[y] += mask.volumes;
				}
				else
				{
					const VolumeSum sum = evaluator.sum(at.position, at.normal, at.error_m);
					visibility =
						1.0 - (settings.compensate ? volumes.compensation.at(sum.occlusion) : std::min(sum.occlusion, 1.0));
					held[y] += sum.volumes;
				}
			}
			cells.values[cells.index(x, static_cast<int>(y))] = static_cast<float>(visibility);
		}
		progress.finishOne();
	};
	parallelFor(rows, run.threads, row);
	return std::accumulate(held.begin(), held.end(), uint64_t{0});
}

// All pixels from those of the cells (aov_sparse.glsl).
std::vector<float> reconstruct(const GBuffer& gbuffer, const PicturePlane& cells, double distance_m, int every_px,
							   const RunSettings& run)
{
	ShadeSettings settings;
	settings.radius_m = distance_m;
	const std::vector<float> depths = finiteDepths(gbuffer);
	shade_kernels::Kernels kernels;
	kernels.nook = blockOf(gbuffer, {}, settings);
	kernels.nook.grid.x = every_px;
	kernels.depths = depths;
	kernels.normals = gbuffer.normals;
	kernels.cells = &cells;
	std::vector<float> visibility(gbuffer.depth.size());
	const auto width = static_cast<std::size_t>(gbuffer.width_px);
	const auto row = [&](std::size_t y)
	{
		shade_kernels::Kernels own = kernels;
		for (std::size_t x = 0; x < width; ++x)
		{
			visibility[y * width + x] = own.nookSparse({static_cast<int>(x), static_cast<int>(y)});
		}
	};
	parallelFor(static_cast<std::size_t>(gbuffer.height_px), run.threads, row);
	return visibility;
}

// Without the drawing that warmed up.
PassTime timeOf(const std::string& name, const std::function<void()>& draw, int repetitions)
{
	std::vector<double> seconds;
	for (int i = 0; i <= repetitions; ++i)
	{
		const auto start = std::chrono::steady_clock::now();
		draw();
		seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
	}
	seconds.erase(seconds.begin(), seconds.begin() + (repetitions > 0 ? 1 : 0));
	const std::vector<double> drawings = seconds;
	const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
	std::nth_element(seconds.begin(), middle, seconds.end());
	return {name, *middle, drawings};
}

} // namespace

AovShaded aovOnCpu(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const RunSettings& run,
				   const DrawSettings& drawing)
{
	const int every_px = settings.every_px;
	assert(every_px == 1 || every_px == 3 || every_px == 5);
	const Receivers receivers(gbuffer);
	const VolumeEvaluator evaluator(volumes, run);
	PicturePlane cells;
	cells.width = (gbuffer.width_px + every_px - 1) / every_px;
	cells.height = (gbuffer.height_px + every_px - 1) / every_px;
	cells.values.resize(cells.index(0, cells.height));

	AovShaded result;
	result.counts.volumes = volumes.occluders.polygons.size();
	Shaded& shaded = result.shaded;
	shaded.renderer = "CPU";
	const auto fill_cells = [&]
	{
		result.counts.fragments = evaluate(receivers, evaluator, volumes, settings, run, cells);
	};
	shaded.passes.push_back(timeOf("volumes", fill_cells, drawing.repetitions));
	if (every_px > 1)
	{
		const auto fill = [&]
		{
			shaded.visibility = reconstruct(gbuffer, cells, volumes.distance_m, every_px, run);
		};
		shaded.passes.push_back(timeOf("reconstruction", fill, drawing.repetitions));
	}
	else
	{
		shaded.visibility = cells.values;
	}
	for (const PassTime& pass : shaded.passes)
	{
		shaded.seconds += pass.seconds;
	}
	return result;
}

} // namespace nook
