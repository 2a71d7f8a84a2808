// SPDX-License-Identifier: GPL-3.0-or-later
// Running sums along the rows or columns of a picture of counts, by a compute shader.
#pragma once

#include "shade/gl_context.h"

namespace nook
{

class GlScan
{
public:
	// Along x (0) or y (1). Requires a context with compute shaders.
	explicit GlScan(int axis);
	~GlScan();
	GlScan(const GlScan&) = delete;
	GlScan& operator=(const GlScan&) = delete;

	// Layer 0 of one picture → a layer of another one of the same size; waits for the end. The seconds, as GlPass::draw.
	double run(const GlTexture& source, const GlTexture& target, int layer, bool timer);

private:
	int m_axis;
	unsigned m_program = 0;
};

} // namespace nook
