// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/passes.h"

#include "methods/method_table.h"

#include <array>
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
			addDebugView(method);
			return m_plan;
		}
		if (hasBentNormals(m_settings))
		{
			addBent(method);
			return m_plan;
		}
		// Strength and power are applied last.
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

	// Packing of the last pass over cells.
	ShadePacking packingAtEnd() const
	{
		return m_settings.half_resolution ? ShadePacking::surface : ShadePacking::none;
	}

	// Draws into a new picture of cells.
	void draw(ShadePass pass)
	{
		const int cell = m_block.cell;
		const bool scalar = pass.packing == ShadePacking::none && pass.kernel.function.index() == 0;
		pass.picture = m_plan.addPicture(
			{scalar ? PictureFormat::scalar : PictureFormat::quad, (m_width + cell - 1) / cell, (m_height + cell - 1) / cell});
		m_plan.passes.push_back(pass);
	}

	// A pass over the cells of the previous pass.
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

	// Depth moments with texels of 2 × 2 pixels and more. Sizes are multiples of the last level's texels, so that each texel covers
	// four of the previous level.
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

	// Coarser depth levels.
	std::size_t addDepthLevels()
	{
		return addLevels({PictureFormat::scalar, levelSide(m_width, 1), levelSide(m_height, 1), m_block.levels},
						 {"coarser depths", "nookCoarser", &Kernels::nookCoarser});
	}

	// Makes each level of a picture from the previous one, the first from the depths.
	std::size_t addLevels(const PictureShape& shape, const ShadeKernel& kernel)
	{
		const std::size_t picture = m_plan.addPicture(shape);
		for (int level = 0; level < shape.levels; ++level)
		{
			ShadePass& pass = m_plan.addPass(kernel, {{ShadeSlot::levels, picture}}, picture, m_block);
			pass.kernel.name += " " + std::to_string(2 << level); // side of a texel in pixels
			pass.level = level;
			pass.block.level = level;
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

	// Bent normals and visibility in one picture, with the same filter.
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

	// Upsamples cells of 2 × 2 pixels; runs `method` itself where no cell shows the pixel's surface.
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
		method.of_pixel = false; // with its cell's samples
		m_plan.passes.push_back(method);
	}

	// Covers all pixels.
	void drawPixels(const ShadeKernel& kernel, const std::vector<ShadeRead>& reads, const ShadeBlock& block)
	{
		const std::size_t picture = m_plan.addPicture({PictureFormat::scalar, m_width, m_height});
		m_plan.addPass(kernel, reads, picture, block);
	}

	// A debug view in place of the passes that draw visibility and filter it, after those that `method` reads.
	void addDebugView(const ShadePass& method)
	{
		assert(debugShows(*m_settings.debug, m_settings));
		const MethodRow& row = rowOf(m_settings.method);
		const int side = method.block.window;
		switch (*m_settings.debug)
		{
		case DebugView::edges: drawPixels({"edges", "nookDebugEdges", &Kernels::nookDebugEdges}, method.reads, method.block); break;
		case DebugView::lod: drawPixels(row.lod_view, method.reads, method.block); break;
		case DebugView::layers: drawPixels(row.layers_view, method.reads, method.block); break;
		case DebugView::samples: drawPixels(row.samples_view, method.reads, method.block); break;
		case DebugView::noise: addNoise(method, row.noise_variants > 0 ? row.noise_variants : side * side); break;
		}
	}

	// Draws the method once per variant at each pixel.
	void addNoise(const ShadePass& method, int variants)
	{
		const int cell = method.block.cell;
		const int area = method.block.window * method.block.window;
		PictureShape shape{PictureFormat::scalar, (m_width + cell - 1) / cell, (m_height + cell - 1) / cell};
		const std::size_t estimate = m_plan.addPicture(shape);
		shape.format = PictureFormat::quad;
		const std::array<std::size_t, 2> sums{m_plan.addPicture(shape), m_plan.addPicture(shape)};
		ShadeBlock block = method.block;
		for (int i = 0; i < variants; ++i)
		{
			ShadePass& variant = m_plan.passes.emplace_back(method);
			variant.kernel.name += " " + std::to_string(i + 1);
			variant.picture = estimate;
			variant.block.variant = variant.block.variant / area * area + i; // within the frame's own tile
			block.variants = i;
			m_plan.addPass({"scatter " + std::to_string(i + 1), "nookDebugScatter", &Kernels::nookDebugScatter},
						   {{ShadeSlot::cells, estimate}, {ShadeSlot::levels, sums[static_cast<std::size_t>(1 - i % 2)]}},
						   sums[static_cast<std::size_t>(i % 2)], block);
		}
		block.variants = variants;
		drawPixels({"noise", "nookDebugNoise", &Kernels::nookDebugNoise},
				   {{ShadeSlot::levels, sums[static_cast<std::size_t>((variants - 1) % 2)]}}, block);
	}

	const ShadeSettings& m_settings;
	bool m_compute;
	int m_width;
	int m_height;
	ShadeBlock m_block;
	ShadePlan m_plan;
};

} // namespace

bool debugShows(DebugView view, const ShadeSettings& settings)
{
	const MethodRow& row = rowOf(settings.method);
	switch (view)
	{
	case DebugView::edges: break;
	case DebugView::lod: return row.lod_view.call[0] != '\0' && hasPasses(row, settings);
	case DebugView::layers: return row.layers_view.call[0] != '\0';
	case DebugView::samples:
	case DebugView::noise: return hasNoise(row);
	}
	return true;
}

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
