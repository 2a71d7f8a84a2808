// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/debug_passes.h"

#include "methods/method_table.h"

#include <array>
#include <cassert>
#include <string>

namespace nook
{
namespace
{

using shade_kernels::Kernels;

class DebugPlanner
{
public:
	DebugPlanner(ShadePlan& plan, const ShadePass& method, int width_px, int height_px)
		: m_plan(plan), m_method(method), m_width(width_px), m_height(height_px)
	{
	}

	// Of all pixels.
	void draw(const ShadeKernel& kernel, const std::vector<ShadeRead>& reads, const ShadeBlock& block)
	{
		ShadePass pass;
		pass.kernel = kernel;
		pass.reads = reads;
		pass.block = block;
		pass.picture = addPicture({PictureFormat::scalar, m_width, m_height});
		m_plan.passes.push_back(pass);
	}
	void draw(const ShadeKernel& kernel)
	{
		draw(kernel, m_method.reads, m_method.block);
	}

	// The method again and again, with one variant after the other at each pixel.
	void addNoise(int variants)
	{
		const int cell = m_method.block.cell;
		const int area = m_method.block.window * m_method.block.window;
		PictureShape shape{PictureFormat::scalar, (m_width + cell - 1) / cell, (m_height + cell - 1) / cell};
		const std::size_t estimate = addPicture(shape);
		shape.format = PictureFormat::quad;
		const std::array<std::size_t, 2> sums{addPicture(shape), addPicture(shape)};
		for (int i = 0; i < variants; ++i)
		{
			ShadePass variant = m_method;
			variant.kernel.name += " " + std::to_string(i + 1);
			variant.picture = estimate;
			variant.block.variant = variant.block.variant / area * area + i; // of the frame's own tile
			m_plan.passes.push_back(variant);
			ShadePass scatter;
			scatter.kernel = {"scatter " + std::to_string(i + 1), "nookDebugScatter", &Kernels::nookDebugScatter};
			scatter.reads = {{ShadeSlot::cells, estimate}, {ShadeSlot::levels, sums[static_cast<std::size_t>(1 - i % 2)]}};
			scatter.picture = sums[static_cast<std::size_t>(i % 2)];
			scatter.block = m_method.block;
			scatter.block.variants = i;
			m_plan.passes.push_back(scatter);
		}
		ShadeBlock block = m_method.block;
		block.variants = variants;
		draw({"noise", "nookDebugNoise", &Kernels::nookDebugNoise},
			 {{ShadeSlot::levels, sums[static_cast<std::size_t>((variants - 1) % 2)]}}, block);
	}

private:
	std::size_t addPicture(const PictureShape& shape)
	{
		m_plan.pictures.push_back(shape);
		return m_plan.pictures.size() - 1;
	}

	ShadePlan& m_plan;
	const ShadePass& m_method;
	int m_width;
	int m_height;
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

void addDebugView(ShadePlan& plan, const ShadePass& method, const ShadeSettings& settings, int width_px, int height_px)
{
	assert(settings.debug && debugShows(*settings.debug, settings));
	const MethodRow& row = rowOf(settings.method);
	DebugPlanner planner(plan, method, width_px, height_px);
	switch (*settings.debug)
	{
	case DebugView::edges: planner.draw({"edges", "nookDebugEdges", &Kernels::nookDebugEdges}); break;
	case DebugView::lod: planner.draw(row.lod_view); break;
	case DebugView::layers: planner.draw(row.layers_view); break;
	case DebugView::samples: planner.draw(row.samples_view); break;
	case DebugView::noise:
	{
		const int side = method.block.window;
		planner.addNoise(row.noise_variants > 0 ? row.noise_variants : side * side);
		break;
	}
	}
}

} // namespace nook
