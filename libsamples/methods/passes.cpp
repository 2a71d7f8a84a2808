// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/passes.h"

#include "methods/block.h"
#include "methods/debug_passes.h"
#include "methods/method_table.h"

#include <cassert>

namespace nook
{

namespace
{

using shade_kernels::Kernels;

class Planner
{
public:
	Planner(const ShadeFrame& frame, const ShadeSamples& samples, const ShadeSettings& settings, bool compute)
		: m_settings(settings), m_compute(compute), m_width(frame.width_px), m_height(frame.height_px),
		  m_block(blockOf(frame, samples, settings))
	{
		m_block.cell = settings.half_resolution ? 2 : 1;
	}

	ShadePlan plan()
	{
		const MethodRow& row = rowOf(m_settings.method);
		ShadePass method;
		method.kernel = row.kernel;
		method.of_pixel = true;
		method.block = m_block;
		if (row.moments)
		{
			method.reads.push_back({ShadeSlot::levels, addMoments()});
		}
		else if (m_block.levels > 0)
		{
			method.reads.push_back({ShadeSlot::levels, addDepthLevels()});
		}
		if (row.add_passes != nullptr)
		{
			row.add_passes(m_plan, method, m_block, m_settings, m_compute);
		}
		if (m_settings.debug)
		{
			addDebugView(m_plan, method, m_settings, m_width, m_height);
			return m_plan;
		}
		if (hasBentNormals(m_settings))
		{
			addBent(method);
			return m_plan;
		}
		// Strength and power come last.
		const int shaped = isShaped(m_settings) ? 1 : 0;
		const bool filtered = m_settings.filter != ShadeFilter::none;
		method.block.shaped = filtered || m_settings.half_resolution ? 0 : shaped;
		method.packing = packingForFilter();
		draw(method);
		m_block.shaped = m_settings.half_resolution ? 0 : shaped;
		addFilter();
		if (m_settings.half_resolution)
		{
			m_block.cell = 1;
			m_block.shaped = shaped;
			method.block.shaped = shaped;
			addFullResolution(method);
		}
		return m_plan;
	}

private:
	std::size_t addPicture(const PictureShape& shape)
	{
		m_plan.pictures.push_back(shape);
		return m_plan.pictures.size() - 1;
	}

	ShadePacking packingForFilter() const
	{
		switch (m_settings.filter)
		{
		case ShadeFilter::none: return packingAtEnd();
		case ShadeFilter::bilateral: return ShadePacking::links;
		case ShadeFilter::window: break;
		}
		return ShadePacking::none;
	}

	// Of the last pass over cells.
	ShadePacking packingAtEnd() const
	{
		return m_settings.half_resolution ? ShadePacking::surface : ShadePacking::none;
	}

	// Into a picture of its own, of cells.
	void draw(ShadePass pass)
	{
		const int cell = m_block.cell;
		const bool scalar = pass.packing == ShadePacking::none && pass.kernel.function.index() == 0;
		pass.picture = addPicture(
			{scalar ? PictureFormat::scalar : PictureFormat::quad, (m_width + cell - 1) / cell, (m_height + cell - 1) / cell});
		m_plan.passes.push_back(pass);
	}

	// A pass over the cells of the pass before it.
	ShadePass following(const ShadeKernel& kernel, const ShadeBlock& block, ShadePacking packing) const
	{
		const std::size_t before = m_plan.passes.back().picture;
		ShadePass pass;
		pass.kernel = kernel;
		pass.packing = packing;
		pass.reads = {{m_plan.pictures[before].format == PictureFormat::scalar ? ShadeSlot::cells : ShadeSlot::packed, before}};
		pass.block = block;
		return pass;
	}

	// Moments of depth, of texels of 2 pixels' side and more. Sides are multiples of the last level's texels, so that each texel
	// has four of the level before.
	std::size_t addMoments()
	{
		constexpr int last = 1 << kMomentLevels;
		const auto side = [](int pixels)
		{
			return (pixels + last - 1) / last * last / 2;
		};
		return addLevels({PictureFormat::quad, side(m_width), side(m_height), kMomentLevels},
						 {"moments", "nookMoments", &Kernels::nookMoments});
	}

	// Coarser and coarser depths.
	std::size_t addDepthLevels()
	{
		return addLevels({PictureFormat::scalar, levelSide(m_width, 1), levelSide(m_height, 1), m_block.levels},
						 {"coarser depths", "nookCoarser", &Kernels::nookCoarser});
	}

	// Each level of a picture from the one before, the first one from the depths.
	std::size_t addLevels(const PictureShape& shape, const ShadeKernel& kernel)
	{
		const std::size_t picture = addPicture(shape);
		for (int level = 0; level < shape.levels; ++level)
		{
			ShadePass pass;
			pass.kernel = kernel;
			pass.kernel.name += " " + std::to_string(2 << level); // pixels along a side of a texel
			pass.reads = {{ShadeSlot::levels, picture}};
			pass.picture = picture;
			pass.level = level;
			pass.block = m_block;
			pass.block.level = level;
			m_plan.passes.push_back(pass);
		}
		return picture;
	}

	void addFilter()
	{
		switch (m_settings.filter)
		{
		case ShadeFilter::none: break;
		case ShadeFilter::bilateral:
			assert(m_settings.filter_taps % 2 == 1);
			m_block.taps = m_settings.filter_taps / 2;
			draw(following({"bilateral x", "nookBilateralX", &Kernels::nookBilateralX}, m_block, ShadePacking::none));
			draw(following({"bilateral y", "nookBilateralY", &Kernels::nookBilateralY}, m_block, packingAtEnd()));
			break;
		case ShadeFilter::window: draw(following({"window", "nookWindow", &Kernels::nookWindow}, m_block, packingAtEnd())); break;
		}
	}

	// Bent normals and visibility in one picture, by the same filter.
	void addBent(ShadePass method)
	{
		assert(m_settings.filter != ShadeFilter::window && !m_settings.half_resolution);
		const MethodRow& row = rowOf(m_settings.method);
		const int shaped = isShaped(m_settings) ? 1 : 0;
		if (m_settings.filter == ShadeFilter::none)
		{
			method.kernel = row.bent_kernel;
			method.block.shaped = shaped;
			draw(method);
			return;
		}
		method.kernel = row.open_kernel;
		draw(method);
		m_block.taps = m_settings.filter_taps / 2;
		m_block.shaped = shaped;
		ShadePass pass;
		pass.block = m_block;
		pass.kernel = {"links", "nookBentLinked", &Kernels::nookBentLinked};
		pass.reads = {{ShadeSlot::levels, m_plan.passes.back().picture}};
		draw(pass);
		pass.reads.push_back({ShadeSlot::packed, m_plan.passes.back().picture});
		pass.kernel = {"bilateral x", "nookBentX", &Kernels::nookBentX};
		draw(pass);
		pass.reads.front().picture = m_plan.passes.back().picture;
		pass.kernel = {"bilateral y", "nookBentY", &Kernels::nookBentY};
		draw(pass);
	}

	// From cells of 2 x 2 pixels; `method` itself where no cell shows the pixel's surface.
	void addFullResolution(ShadePass method)
	{
		ShadeBlock half = m_block;
		half.cell = 2;
		ShadePass upsample = following({"upsample", "nookUpsample", &Kernels::nookUpsample}, half, ShadePacking::none);
		upsample.leaves = true;
		draw(upsample);
		method.kernel.name = "fill";
		method.packing = ShadePacking::none;
		method.fills = true;
		method.picture = m_plan.passes.back().picture;
		method.of_pixel = false; // with the samples of its cell
		m_plan.passes.push_back(method);
	}

	const ShadeSettings& m_settings;
	bool m_compute;
	int m_width;
	int m_height;
	ShadeBlock m_block;
	ShadePlan m_plan;
};

} // namespace

bool hasBentNormals(const ShadeSettings& settings)
{
	return settings.slices.bent && rowOf(settings.method).bent_kernel.call[0] != '\0';
}

const char* packingCall(ShadePacking packing)
{
	switch (packing)
	{
	case ShadePacking::none: break;
	case ShadePacking::links: return "nookLinked";
	case ShadePacking::surface: return "nookOfSurface";
	}
	return nullptr;
}

ShadePlan planOf(const ShadeFrame& frame, const ShadeSamples& samples, const ShadeSettings& settings, bool compute)
{
	return Planner(frame, samples, settings, compute).plan();
}

} // namespace nook
