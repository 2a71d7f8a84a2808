// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade.h"

#include "core/error.h"
#include "core/parallel.h"
#include "shade/block.h"

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

float kernel(shade_kernels::Kernels& kernels, ShadeMethod method, glm::ivec2 pixel)
{
	switch (method)
	{
	case ShadeMethod::vo_line: return kernels.nookVoLine(pixel);
	case ShadeMethod::vo_point: return kernels.nookVoPoint(pixel);
	case ShadeMethod::alchemy: break;
	}
	return kernels.nookAlchemy(pixel);
}

} // namespace

Domain domainOf(ShadeMethod method)
{
	switch (method)
	{
	case ShadeMethod::vo_line: return Domain::disk;
	case ShadeMethod::vo_point: return Domain::ball;
	case ShadeMethod::alchemy: break;
	}
	return Domain::hemisphere;
}

ShadeSamples samplesOf(ShadeMethod method, const std::vector<Pattern>& variants)
{
	ShadeSamples samples;
	while (static_cast<std::size_t>(samples.size * samples.size) < variants.size())
	{
		samples.size += 1;
	}
	assert(static_cast<std::size_t>(samples.size * samples.size) == variants.size());
	samples.count = static_cast<int>(variants.front().count());
	for (const Pattern& pattern : variants)
	{
		assert(pattern.domain == domainOf(method) && pattern.count() == variants.front().count());
		for (std::size_t i = 0; i < pattern.count(); ++i)
		{
			const glm::dvec3& p = pattern.points[i];
			const double third = method == ShadeMethod::vo_line ? std::sqrt(std::max(0.0, 1.0 - p.x * p.x - p.y * p.y)) : p.z;
			samples.samples.emplace_back(p.x, p.y, third, pattern.weights[i]);
		}
	}
	return samples;
}

ShadeBlock blockOf(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings)
{
	assert(settings.radius_m > 0.0 && gbuffer.normals.size() == gbuffer.depth.size());
	const glm::dmat4& p = gbuffer.view.projection;
	const double width = gbuffer.width_px;
	const double height = gbuffer.height_px;
	ShadeBlock block;
	block.size = glm::vec4(glm::dvec4(width, height, 1.0 / width, 1.0 / height));
	block.across_x = acrossOf(p, 0);
	block.across_y = acrossOf(p, 1);
	block.w = {narrow(-p[2][3]), narrow(p[3][3]), 0.0F, 0.0F};
	block.radius = {narrow(settings.radius_m), 0.0F, 0.0F, 0.0F};
	block.alchemy = glm::vec4(glm::dvec4(settings.sigma, settings.contrast, settings.beta, settings.epsilon));
	block.count = {samples.count, samples.size, settings.use_normal ? 1 : 0, settings.cut ? 1 : 0};
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

Shaded shadeOnCpu(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, const RunSettings& run)
{
	const std::vector<float> depths = finiteDepths(gbuffer);
	shade_kernels::Kernels kernels;
	kernels.nook = blockOf(gbuffer, samples, settings);
	kernels.depths = depths;
	kernels.normals = gbuffer.normals;
	kernels.samples = samples.samples;
	Shaded shaded{std::vector<float>(depths.size()), "CPU", 0.0};
	ProgressCounter progress(run.progress, "shading", static_cast<std::size_t>(gbuffer.height_px));
	const auto start = std::chrono::steady_clock::now();
	const auto row = [&](std::size_t y)
	{
		shade_kernels::Kernels own = kernels;
		for (int x = 0; x < gbuffer.width_px; ++x)
		{
			const auto pixel = y * static_cast<std::size_t>(gbuffer.width_px) + static_cast<std::size_t>(x);
			shaded.visibility[pixel] = kernel(own, settings.method, {x, static_cast<int>(y)});
		}
		progress.finishOne();
	};
	parallelFor(static_cast<std::size_t>(gbuffer.height_px), run.threads, row);
	shaded.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	return shaded;
}

} // namespace nook
