// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade.h"

#include "core/error.h"
#include "core/number.h"
#include "core/parallel.h"
#include "methods/block.h"
#include "methods/depth_format.h"
#include "methods/passes.h"
#include "methods/statvo_passes.h"
#include "shade/pass_times.h"
#include "shade/table_scan.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

namespace nook
{
namespace
{

void store(PicturePlane& plane, std::size_t at, float value)
{
	plane.values[at] = value;
}
void store(PicturePlane& plane, std::size_t at, const glm::vec4& value)
{
	std::copy_n(&value.x, 4, plane.values.begin() + static_cast<std::ptrdiff_t>(at));
}
void store(PicturePlane& plane, std::size_t at, const glm::uvec4& value)
{
	std::copy_n(&value.x, 4, plane.counts.begin() + static_cast<std::ptrdiff_t>(at));
}

// Levels, or layers, of a picture.
std::vector<PicturePlane> planesOf(const PictureShape& shape)
{
	std::vector<PicturePlane> planes(static_cast<std::size_t>(std::max(shape.levels, shape.layers)));
	for (std::size_t i = 0; i < planes.size(); ++i)
	{
		const int level = shape.levels > 1 ? static_cast<int>(i) : 0;
		PicturePlane& plane = planes[i];
		plane.width = levelSide(shape.width, level);
		plane.height = levelSide(shape.height, level);
		plane.channels = channelsOf(shape.format);
		const std::size_t size = plane.index(0, plane.height);
		plane.values.resize(shape.format == PictureFormat::counts ? 0 : size);
		plane.counts.resize(shape.format == PictureFormat::counts ? size : 0);
	}
	return planes;
}

// Rows in parallel.
void draw(const ShadePass& pass, const shade_kernels::Kernels& kernels, PicturePlane& plane, const RunSettings& run)
{
	const auto height = static_cast<std::size_t>(plane.height);
	ProgressCounter progress(run.progress, pass.kernel.name, height);
	const auto row = [&](std::size_t y)
	{
		shade_kernels::Kernels own = kernels;
		for (int x = 0; x < plane.width; ++x)
		{
			const glm::ivec2 at(x, static_cast<int>(y));
			const std::size_t index = plane.index(at.x, at.y);
			if (pass.fills && own.nookVisibility(at) >= 0.0F)
			{
				store(plane, index, own.nookVisibility(at));
				continue;
			}
			std::visit([&](const auto function) { store(plane, index, (own.*function)(pass.of_pixel ? own.nookPixel(at) : at)); },
					   pass.kernel.function);
		}
		progress.finishOne();
	};
	parallelFor(height, run.threads, row);
}

} // namespace

ShadeFrame frameOf(const GBuffer& gbuffer)
{
	assert(gbuffer.normals.size() == gbuffer.depth.size());
	return {gbuffer.width_px, gbuffer.height_px, gbuffer.view.projection, gbuffer.depth, gbuffer.depth_error_m};
}

std::vector<float> finiteDepths(const GBuffer& gbuffer)
{
	std::vector<float> depths = gbuffer.depth;
	for (float& depth : depths)
	{
		depth = std::isfinite(depth) ? depth : NOOK_SKY;
	}
	return depths;
}

Shaded shadeOnCpu(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, const RunSettings& run,
				  const DrawSettings& drawing)
{
	const std::vector<float> depths = finiteDepths(gbuffer);
	shade_kernels::Kernels inputs;
	inputs.depths = depths;
	inputs.normals = gbuffer.normals;
	inputs.samples = samples.samples;
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings, settings.statvo.builder != TableBuilder::fragments);
	std::vector<std::vector<PicturePlane>> pictures;
	for (const PictureShape& shape : plan.pictures)
	{
		pictures.push_back(planesOf(shape));
	}
	PassTimes times(plan);
	for (int repetition = 0; repetition < times.drawings(drawing); ++repetition)
	{
		for (std::size_t i = 0; i < plan.passes.size(); ++i)
		{
			const ShadePass& pass = plan.passes[i];
			const auto start = std::chrono::steady_clock::now();
			shade_kernels::Kernels kernels = inputs;
			kernels.nook = pass.block;
			for (const ShadeRead& read : pass.reads)
			{
				const std::vector<PicturePlane>& planes = pictures[read.picture];
				switch (read.slot)
				{
				case ShadeSlot::cells: kernels.cells = planes.data(); break;
				case ShadeSlot::levels: kernels.levels = planes; break;
				case ShadeSlot::tables: kernels.tables = planes; break;
				case ShadeSlot::range: kernels.range = planes.data(); break;
				}
			}
			PicturePlane& plane = pictures[pass.picture][static_cast<std::size_t>(pass.level + pass.layer)];
			if (pass.scans)
			{
				scanOnCpu(kernels.tables[0], pass.block.table.y, plane, run);
			}
			else
			{
				draw(pass, kernels, plane, run);
			}
			times.add(i, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
		}
	}
	Shaded shaded{pictures[plan.passes.back().picture][0].values,
				  "CPU",
				  0.0,
				  {},
				  settings.statvo.builder == TableBuilder::fragments ? "fragments" : "scans"};
	times.finish(shaded);
	return shaded;
}

} // namespace nook
