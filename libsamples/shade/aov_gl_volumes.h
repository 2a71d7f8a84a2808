// SPDX-License-Identifier: GPL-3.0-or-later
// Packed volumes on the GPU, and draw calls for clusters of them.
#pragma once

#include "shade/aov_gl_parts.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace nook
{

class GlVolumes
{
public:
	// Of a frame. Both are kept references to and must outlive it. Throws as GlArray.
	GlVolumes(const PackedVolumes& packed, const nook_volumes::Frame& frame, const AovGlOptions& options);
	~GlVolumes();
	GlVolumes(const GlVolumes&) = delete;
	GlVolumes& operator=(const GlVolumes&) = delete;

	// Before drawing: the arrays for the shaders, the vertices' attributes.
	void bind() const;

	// With the states and the program that are set.
	void draw(const std::vector<std::size_t>& clusters) const;

	// Is the depth bounds test there, and wanted? Then it has to be enabled around draw().
	bool hasDepthBounds() const
	{
		return m_bounds;
	}

private:
	void drawOneByOne(const std::vector<std::size_t>& clusters) const;
	void drawTogether(const std::vector<std::size_t>& clusters) const;

	const PackedVolumes& m_packed;
	const nook_volumes::Frame& m_frame;
	AovGlOptions m_options;
	std::unique_ptr<GlArray> m_corners, m_polygons, m_clusters, m_points, m_indices, m_numbers;
	bool m_bounds = false;
	unsigned m_vertices = 0;
	unsigned m_commands = 0;
};

} // namespace nook
