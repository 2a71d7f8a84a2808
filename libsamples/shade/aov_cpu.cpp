// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV), §5.
#include "shade/aov.h"

#include "core/lists.h"
#include "core/parallel.h"
#include "core/round.h"
#include "methods/block.h"
#include "methods/kernels.h"
#include "methods/method_table.h"
#include "shade/run_passes.h"
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

// Visibility of single pixels. Thread-safe.
class Pixels
{
public:
	Pixels(const GBuffer& gbuffer, const VolumeEvaluator& evaluator, const VolumeSet& volumes, const AovSettings& settings)
		: m_gbuffer(gbuffer), m_projector(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px),
		  m_world_from_camera(glm::inverse(gbuffer.view.camera_from_world)), m_evaluator(evaluator), m_volumes(volumes),
		  m_settings(settings)
	{
		assert(gbuffer.normals.size() == gbuffer.depth.size());
	}

	// Adds the number of volumes that contain the pixel to `held`.
	float at(int x, int y, uint64_t& held) const
	{
		const std::size_t i = m_gbuffer.index(x, y);
		if (!std::isfinite(m_gbuffer.depth[i]))
		{
			return 1.0F;
		}
		const double rounding_m = m_gbuffer.depth_error_m.empty() ? static_cast<double>(m_gbuffer.depth[i]) * kUnitRoundoff
																  : static_cast<double>(m_gbuffer.depth_error_m[i]);
		const double error_m = rounding_m + m_gbuffer.view_error_m; // of the position
		const glm::dvec3 position(m_world_from_camera * glm::dvec4(positionOf(m_gbuffer, m_projector, x, y), 1.0));
		const glm::dvec3 normal = glm::normalize(glm::dmat3(m_world_from_camera) * glm::dvec3(m_gbuffer.normals[i]));
		if (m_settings.mask)
		{
			const VolumeMask mask = m_evaluator.mask(position, normal, m_settings.directions, error_m);
			held += mask.volumes;
			return static_cast<float>(mask.visibility);
		}
		VolumeSum sum;
		const VolumeReceiver receiver{position, normal, error_m};
		m_evaluator.sums({&receiver, 1}, {&sum, 1});
		held += sum.volumes;
		const double occlusion = m_settings.compensate ? m_volumes.compensation.at(sum.occlusion) : std::min(sum.occlusion, 1.0);
		return static_cast<float>(1.0 - occlusion);
	}

private:
	const GBuffer& m_gbuffer;
	Projector m_projector;
	glm::dmat4 m_world_from_camera;
	const VolumeEvaluator& m_evaluator;
	const VolumeSet& m_volumes;
	const AovSettings& m_settings;
};

// Shades the upper left pixel of every cell of `every_px`; returns the number of containing volumes.
uint64_t evaluate(const Pixels& pixels, const AovSettings& settings, const RunSettings& run, PicturePlane& cells)
{
	const auto rows = static_cast<std::size_t>(cells.height);
	std::vector<uint64_t> held(rows);
	ProgressCounter progress(run.progress, std::string(volumeRow(settings.mask).name), rows);
	const auto row = [&](std::size_t y)
	{
		for (int x = 0; x < cells.width; ++x)
		{
			const int cell_y = static_cast<int>(y);
			cells.values[cells.index(x, cell_y)] = pixels.at(x * settings.every_px, cell_y * settings.every_px, held[y]);
		}
		progress.finishOne();
	};
	parallelFor(rows, run.threads, row);
	return std::accumulate(held.begin(), held.end(), uint64_t{0});
}

// Reconstructs all pixels from the cells (aov_sparse.glsl); -1 where that fails.
std::vector<float> reconstruct(const GBuffer& gbuffer, const PicturePlane& cells, double distance_m, int every_px,
							   const RunSettings& run)
{
	ShadeSettings settings;
	settings.radius_m = distance_m;
	const std::vector<float> depths = finiteDepths(gbuffer);
	shade_kernels::Kernels kernels;
	kernels.nook = blockOf(frameOf(gbuffer), {}, settings);
	kernels.nook.cell = every_px;
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

struct VolumeCount
{
	uint64_t pixels = 0;
	uint64_t held = 0; // total number of containing volumes
};

// Evaluates the pixels whose visibility is < 0.
VolumeCount evaluateAlone(const Pixels& pixels, const GBuffer& gbuffer, const RunSettings& run, std::vector<float>& visibility)
{
	const auto rows = static_cast<std::size_t>(gbuffer.height_px);
	const auto width = static_cast<std::size_t>(gbuffer.width_px);
	std::vector<uint64_t> held(rows);
	std::vector<uint64_t> alone(rows);
	const auto row = [&](std::size_t y)
	{
		for (std::size_t x = 0; x < width; ++x)
		{
			float& value = visibility[y * width + x];
			if (value < 0.0F)
			{
				value = pixels.at(static_cast<int>(x), static_cast<int>(y), held[y]);
				alone[y] += 1;
			}
		}
	};
	parallelFor(rows, run.threads, row);
	return {std::accumulate(alone.begin(), alone.end(), uint64_t{0}), std::accumulate(held.begin(), held.end(), uint64_t{0})};
}

PassTime timeOf(const std::string& name, const std::function<void()>& draw, int repetitions)
{
	std::vector<double> seconds;
	for (int i = 0; i <= repetitions; ++i)
	{
		const auto start = std::chrono::steady_clock::now();
		draw();
		seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
	}
	return passTimeOf(name, seconds);
}

} // namespace

AovShaded aovOnCpu(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const RunSettings& run,
				   const DrawSettings& drawing)
{
	const int every_px = settings.every_px;
	assert(every_px == 1 || every_px == 3 || every_px == 5);
	const VolumeEvaluator evaluator(volumes, run, settings.mask);
	PicturePlane cells;
	cells.width = (gbuffer.width_px + every_px - 1) / every_px;
	cells.height = (gbuffer.height_px + every_px - 1) / every_px;
	cells.values.resize(cells.index(0, cells.height));

	AovShaded result;
	result.counts.volumes = volumes.occluders.polygons.size();
	Shaded& shaded = result.shaded;
	shaded.renderer = "CPU";
	const Pixels pixels(gbuffer, evaluator, volumes, settings);
	uint64_t of_cells = 0;
	const auto fill_cells = [&]
	{
		of_cells = evaluate(pixels, settings, run, cells);
		result.counts.fragments = of_cells;
	};
	shaded.passes.push_back(timeOf("volumes", fill_cells, drawing.repetitions));
	if (every_px > 1)
	{
		std::vector<float> filtered;
		const auto fill = [&]
		{
			filtered = reconstruct(gbuffer, cells, volumes.distance_m, every_px, run);
		};
		shaded.passes.push_back(timeOf("reconstruction", fill, drawing.repetitions));
		const auto fill_rest = [&]
		{
			shaded.visibility = filtered;
			const VolumeCount rest = evaluateAlone(pixels, gbuffer, run, shaded.visibility);
			result.counts.fragments = of_cells + rest.held;
			result.counts.pixels_alone = rest.pixels;
		};
		shaded.passes.push_back(timeOf("pixels alone", fill_rest, drawing.repetitions));
	}
	else
	{
		shaded.visibility = cells.values;
	}
	shaded.seconds = sumOver(shaded.passes, [](const PassTime& pass) { return pass.seconds; });
	return result;
}

} // namespace nook
