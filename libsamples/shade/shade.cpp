// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade.h"

#include "core/error.h"
#include "core/number.h"
#include "core/parallel.h"
#include "shade/block.h"
#include "shade/depth_format.h"
#include "shade/pass_times.h"
#include "shade/passes.h"
#include "shade/statvo_passes.h"
#include "shade/table_scan.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

namespace nook
{
namespace
{

float narrow(double value)
{
	return static_cast<float>(value);
}

// One row of the projection → what camera.glsl takes of it.
glm::vec4 acrossOf(const glm::dmat4& p, int row)
{
	const int other = 1 - row;
	if (p[other][row] != 0.0 || p[0][3] != 0.0 || p[1][3] != 0.0 || p[row][row] == 0.0)
	{
		throw Error(ExitCode::unsupported,
					"projection: found one with a skew, expected x and y of the picture to depend on x and y alone");
	}
	return {narrow(1.0 / p[row][row]), narrow(p[2][row] / p[row][row]), narrow(-p[3][row] / p[row][row]), 0.0F};
}

// Coarser levels beside the picture.
int levelsOf(const ShadeBlock& block, const ShadeSettings& settings)
{
	const int wanted = settings.method == ShadeMethod::sao ? settings.rival.levels : settings.depth_levels;
	const int longer = std::max(block.rect.z, block.rect.w) + 1;
	int levels = 0;
	while (levels < wanted && longer >> (levels + 1) > 0)
	{
		levels += 1;
	}
	return settings.method == ShadeMethod::vo_area ? kMomentLevels : levels;
}

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

bool takesPattern(ShadeMethod method)
{
	return method != ShadeMethod::statvo && method != ShadeMethod::hbao && method != ShadeMethod::sao;
}

Domain domainOf(ShadeMethod method)
{
	assert(takesPattern(method));
	switch (method)
	{
	case ShadeMethod::vo_line:
	case ShadeMethod::vo_area: return Domain::disk;
	case ShadeMethod::vo_point:
	case ShadeMethod::crytek: return Domain::ball;
	default: return Domain::hemisphere;
	}
}

void fillCamera(ShadeBlock& block, const glm::dmat4& projection, int width_px, int height_px)
{
	block.size = glm::vec4(glm::dvec4(width_px, height_px, 1.0 / width_px, 1.0 / height_px));
	block.across_x = acrossOf(projection, 0);
	block.across_y = acrossOf(projection, 1);
	block.w = {narrow(-projection[2][3]), narrow(projection[3][3]), 0.0F, 0.0F};
	block.rect = {0, 0, width_px - 1, height_px - 1};
}

ShadeBlock blockOf(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings)
{
	assert(settings.radius_m > 0.0 && gbuffer.normals.size() == gbuffer.depth.size());
	ShadeBlock block;
	fillCamera(block, gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px);
	fillDepth(block, gbuffer.view.projection, settings.depth);
	if (!gbuffer.depth_error_m.empty())
	{
		fillMeasuredError(block, gbuffer);
	}
	block.error.z = narrow(normalError(settings.normal_bits));
	block.radius = {narrow(settings.radius_m), 0.0F, 0.0F, 0.0F};
	block.alchemy = glm::vec4(glm::dvec4(settings.sigma, settings.contrast, settings.beta, settings.epsilon));
	block.count = {samples.count, samples.size, settings.use_normal ? 1 : 0, settings.cut ? 1 : 0};
	const VoSettings& volume = settings.volume;
	block.volume = {narrow(volume.thickness_m), narrow(volume.second_radius_m > 0.0 ? volume.second_radius_m : settings.radius_m),
					0.0F, 0.0F};
	block.features = {static_cast<int>(volume.radii), volume.quadratic ? 1 : 0, volume.paired ? 1 : 0,
					  volume.thickness_m > 0.0 ? 1 : 0};
	const BandSettings& bands = settings.bands;
	const double most_px = settings.max_radius_px > 0.0 ? settings.max_radius_px : gbuffer.height_px;
	if (settings.min_radius_px > most_px)
	{
		throw Error(ExitCode::usage, "--min-pixels: found " + numberText(settings.min_radius_px) + ", expected at most " +
										 numberText(most_px) + ", the picture's height where --max-pixels says nothing else");
	}
	block.limits = {narrow(bands.first_px), narrow(bands.second_px), narrow(most_px), narrow(settings.min_radius_px)};
	block.bands = {(samples.count + bands.count - 1) / bands.count, (2 * samples.count + bands.count - 1) / bands.count,
				   bands.count, 0};
	block.grid.w = levelsOf(block, settings);
	fillStatVo(block, settings);
	fillRivals(block, settings);
	return block;
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
	const ShadePlan plan = planOf(gbuffer, samples, settings, settings.statvo.builder != TableBuilder::fragments);
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
