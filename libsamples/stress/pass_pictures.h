// SPDX-License-Identifier: GPL-3.0-or-later
// The pictures that the passes of a plan make on the way, for those who look at them.
#pragma once

#include "core/progress.h"
#include "methods/block.h"
#include "methods/passes.h"
#include "shade/shade.h"
#include "shade/table_scan.h"

#include <algorithm>
#include <string>
#include <vector>

namespace nook::stress
{

using Planes = std::vector<PicturePlane>; // levels or layers

inline void keep(PicturePlane& plane, std::size_t at, float value)
{
	plane.values[at] = value;
}
inline void keep(PicturePlane& plane, std::size_t at, const glm::vec4& value)
{
	std::copy_n(&value.x, 4, &plane.values[at]);
}
inline void keep(PicturePlane& plane, std::size_t at, const glm::uvec4& value)
{
	std::copy_n(&value.x, 4, &plane.counts[at]);
}

// Runs the passes up to the first whose name is `end`, on one thread; without one of that name, all.
inline std::vector<Planes> picturesOf(const GBuffer& gbuffer, const ShadeSettings& settings, const std::string& end)
{
	const ShadeSamples samples = ownSamples(settings);
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings, settings.statvo.builder != TableBuilder::fragments);
	const std::vector<float> depths = finiteDepths(gbuffer);
	std::vector<Planes> pictures;
	for (const PictureShape& shape : plan.pictures)
	{
		Planes planes(static_cast<std::size_t>(std::max(shape.levels, shape.layers)));
		for (std::size_t i = 0; i < planes.size(); ++i)
		{
			const int level = shape.levels > 1 ? static_cast<int>(i) : 0;
			planes[i].width = levelSide(shape.width, level);
			planes[i].height = levelSide(shape.height, level);
			planes[i].channels = channelsOf(shape.format);
			const std::size_t size = planes[i].index(0, planes[i].height);
			planes[i].values.resize(shape.format == PictureFormat::counts ? 0 : size);
			planes[i].counts.resize(shape.format == PictureFormat::counts ? size : 0);
		}
		pictures.push_back(planes);
	}
	for (const ShadePass& pass : plan.passes)
	{
		if (pass.kernel.name == end)
		{
			break;
		}
		shade_kernels::Kernels kernels;
		kernels.depths = depths;
		kernels.normals = gbuffer.normals;
		kernels.samples = samples.samples;
		kernels.nook = pass.block;
		for (const ShadeRead& read : pass.reads)
		{
			const Planes& planes = pictures[read.picture];
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
			scanOnCpu(kernels.tables[0], pass.block.table.y, plane, {1, {}});
			continue;
		}
		for (int y = 0; y < plane.height; ++y)
		{
			for (int x = 0; x < plane.width; ++x)
			{
				const glm::ivec2 at(x, y);
				std::visit([&](const auto function)
						   { keep(plane, plane.index(x, y), (kernels.*function)(pass.of_pixel ? kernels.nookPixel(at) : at)); },
						   pass.kernel.function);
			}
		}
	}
	return pictures;
}

} // namespace nook::stress
