// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/passes.h"

#include "shade/block.h"

#include <cassert>

namespace nook
{
namespace
{

using shade_kernels::Kernels;

ShadeKernel kernelOf(ShadeMethod method)
{
	switch (method)
	{
	case ShadeMethod::vo_line: return {"vo-line", "nookVoLine", &Kernels::nookVoLine};
	case ShadeMethod::vo_point: return {"vo-point", "nookVoPoint", &Kernels::nookVoPoint};
	case ShadeMethod::alchemy: break;
	}
	return {"alchemy", "nookAlchemy", &Kernels::nookAlchemy};
}

} // namespace

std::vector<ShadePass> passesOf(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings)
{
	ShadeBlock block = blockOf(gbuffer, samples, settings);
	const int cell = settings.half_resolution ? 2 : 1;
	block.grid.x = cell;
	std::vector<ShadePass> passes(1);
	passes[0].kernel = kernelOf(settings.method);
	passes[0].of_pixel = true;
	passes[0].block = block;
	const auto add = [&passes](const ShadeKernel& kernel, const ShadeBlock& own)
	{
		ShadePass pass;
		pass.kernel = kernel;
		pass.reads_visibility = true;
		pass.block = own;
		passes.push_back(pass);
	};
	switch (settings.filter)
	{
	case ShadeFilter::none: break;
	case ShadeFilter::bilateral:
		assert(settings.filter_taps % 2 == 1);
		for (const int axis : {0, 1})
		{
			ShadeBlock own = block;
			own.grid = {cell, settings.filter_taps / 2, axis, 0};
			add({axis == 0 ? "bilateral x" : "bilateral y", "nookBilateral", &Kernels::nookBilateral}, own);
		}
		break;
	case ShadeFilter::window: add({"window", "nookWindow", &Kernels::nookWindow}, block); break;
	}
	for (ShadePass& pass : passes)
	{
		pass.width = (gbuffer.width_px + cell - 1) / cell;
		pass.height = (gbuffer.height_px + cell - 1) / cell;
	}
	if (settings.half_resolution)
	{
		add({"upsample", "nookUpsample", &Kernels::nookUpsample}, block);
		passes.back().width = gbuffer.width_px;
		passes.back().height = gbuffer.height_px;
		block.grid.x = 1;
		add(passes[0].kernel, block);
		passes.back().kernel.name = "fill";
		passes.back().fills = true;
		passes.back().width = gbuffer.width_px;
		passes.back().height = gbuffer.height_px;
	}
	return passes;
}

} // namespace nook
