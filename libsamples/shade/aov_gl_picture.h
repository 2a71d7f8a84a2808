// SPDX-License-Identifier: GPL-3.0-or-later
// What volumes are drawn into: one pixel of every cell, or all pixels; and the visibility that comes of it.
#pragma once

#include "shade/aov_gl_parts.h"
#include "shade/gl_context.h"

#include <memory>
#include <vector>

namespace nook
{

class AovPicture
{
public:
	// Throws Error (unsupported) for a camera with a skew.
	AovPicture(const GBuffer& gbuffer, const nook_volumes::Header& header, const AovSettings& settings, int every_px);
	~AovPicture();
	AovPicture(const AovPicture&) = delete;
	AovPicture& operator=(const AovPicture&) = delete;

	const nook_volumes::Frame& frame() const
	{
		return m_frame;
	}
	const GlTexture& result() const
	{
		return *m_result;
	}

	// The shaders' block, and what they read of this picture.
	void bind() const;

	// Draws the depth buffer from the linear depths that are bound (aovDepthProgram), and leaves the depth test on, without
	// writing.
	void drawDepth(const GlProgram& program) const;

	// Before volumes: draws go to their sums or bits, which are none yet.
	void beginVolumes() const;

	// Draws go to the visibility.
	void useResult() const;

private:
	bool m_mask;
	int m_every_px;
	int m_columns;
	int m_rows;
	nook_volumes::Camera m_camera;
	nook_volumes::Frame m_frame;
	std::unique_ptr<GlTarget> m_depth_stencil;
	std::vector<std::unique_ptr<GlTarget>> m_sums;
	std::unique_ptr<GlTexture> m_result;
	std::unique_ptr<GlFrame> m_volume_frame, m_result_frame;
	unsigned m_block = 0;
};

void bindTexture(unsigned unit, unsigned name);

// A triangle over the whole picture.
extern const char* const kFullScreen;

// Depth as a depth buffer holds it, from linear depth.
std::unique_ptr<GlProgram> aovDepthProgram();

} // namespace nook
