// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/cpu_passes.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>

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

// Levels or layers of a picture.
Planes planesOf(const PictureShape& shape)
{
	Planes planes(static_cast<std::size_t>(std::max(shape.levels, shape.layers)));
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

// Connects the pictures that the pass reads.
void connect(const ShadePass& pass, const std::vector<Planes>& pictures, shade_kernels::Kernels& kernels)
{
	kernels.nook = pass.block;
	for (const ShadeRead& read : pass.reads)
	{
		const Planes& planes = pictures[read.picture];
		switch (read.slot)
		{
		case ShadeSlot::cells: kernels.cells = planes.data(); break;
		case ShadeSlot::packed: kernels.packed = planes.data(); break;
		case ShadeSlot::levels: kernels.levels = planes; break;
		case ShadeSlot::tables: kernels.tables = planes; break;
		case ShadeSlot::range: kernels.range = planes.data(); break;
		}
	}
}

void drawAt(const ShadePass& pass, shade_kernels::Kernels& kernels, glm::ivec2 at, PicturePlane& plane, std::size_t index)
{
	const glm::ivec2 place = pass.of_pixel ? kernels.nookPixel(at) : at;
	if (pass.packing == ShadePacking::none)
	{
		std::visit([&](const auto function) { store(plane, index, (kernels.*function)(place)); }, pass.kernel.function);
		return;
	}
	const float visibility = (kernels.*std::get<0>(pass.kernel.function))(place);
	store(plane, index,
		  pass.packing == ShadePacking::links ? kernels.nookLinked(at, visibility) : kernels.nookOfSurface(at, visibility));
}

// Processes rows in parallel.
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
			if (!pass.fills || plane.values[index] < 0.0F)
			{
				drawAt(pass, own, at, plane, index);
			}
		}
		progress.finishOne();
	};
	parallelFor(height, run.threads, row);
}

} // namespace

std::vector<Planes> picturesFor(const ShadePlan& plan)
{
	std::vector<Planes> pictures;
	for (const PictureShape& shape : plan.pictures)
	{
		pictures.push_back(planesOf(shape));
	}
	return pictures;
}

void runPass(const ShadePass& pass, const shade_kernels::Kernels& inputs, std::vector<Planes>& pictures, const RunSettings& run)
{
	shade_kernels::Kernels kernels = inputs;
	connect(pass, pictures, kernels);
	PicturePlane& plane = pictures[pass.picture][static_cast<std::size_t>(pass.level + pass.layer)];
	if (pass.scans)
	{
		scanOnCpu(kernels.tables[0], pass.block.axis, plane, run);
	}
	else
	{
		draw(pass, kernels, plane, run);
	}
}

namespace
{

constexpr std::size_t kBand = 64; // columns summed at a time per thread

} // namespace

void scanOnCpu(const PicturePlane& source, int axis, PicturePlane& target, const RunSettings& run)
{
	assert(source.counts.size() == target.counts.size() && source.width == target.width);
	const std::size_t row = source.index(0, 1);
	const auto height = static_cast<std::size_t>(source.height);
	if (axis == 0)
	{
		parallelFor(height, run.threads,
					[&](std::size_t y)
					{
						std::array<std::uint32_t, 4> sum{};
						for (std::size_t i = y * row; i < (y + 1) * row; ++i)
						{
							sum[i % 4] += source.counts[i];
							target.counts[i] = sum[i % 4];
						}
					});
		return;
	}
	parallelFor((row / 4 + kBand - 1) / kBand, run.threads,
				[&](std::size_t band)
				{
					const std::size_t first = 4 * kBand * band;
					const std::size_t end = std::min(row, first + 4 * kBand);
					for (std::size_t y = 0; y < height; ++y)
					{
						for (std::size_t i = y * row + first; i < y * row + end; ++i)
						{
							target.counts[i] = source.counts[i] + (y > 0 ? target.counts[i - row] : 0U);
						}
					}
				});
}

} // namespace nook
