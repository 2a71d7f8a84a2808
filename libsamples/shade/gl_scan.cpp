// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: W. D. Hillis, G. L. Steele, "Data Parallel Algorithms", CACM 1986 (sums by doubling distances).
#include "shade/gl_scan.h"

#include "shade/gl_parts.h"

#include <epoxy/gl.h>

#include <string>

namespace nook
{
namespace
{

// One work group a row or column; 256 entries at a time, with what came before them carried along.
constexpr const char* kSource = R"(
layout(local_size_x = 256) in;
uniform highp usampler2DArray nook_source;
layout(rgba32ui) writeonly uniform uimage2D nook_target;
shared uvec4 nook_sums[2][256];
void main()
{
	int line = int(gl_WorkGroupID.x);
	int lane = int(gl_LocalInvocationID.x);
	ivec2 size = textureSize(nook_source, 0).xy;
	int count = AXIS == 0 ? size.x : size.y;
	uvec4 before = uvec4(0u);
	for (int first = 0; first < count; first += 256)
	{
		int at = first + lane;
		ivec2 texel = AXIS == 0 ? ivec2(at, line) : ivec2(line, at);
		nook_sums[0][lane] = at < count ? texelFetch(nook_source, ivec3(texel, 0), 0) : uvec4(0u);
		int from = 0;
		barrier();
		for (int stride = 1; stride < 256; stride *= 2)
		{
			uvec4 sum = nook_sums[from][lane];
			if (lane >= stride)
			{
				sum += nook_sums[from][lane - stride];
			}
			nook_sums[1 - from][lane] = sum;
			from = 1 - from;
			barrier();
		}
		if (at < count)
		{
			imageStore(nook_target, texel, before + nook_sums[from][lane]);
		}
		before += nook_sums[from][255];
		barrier();
	}
}
)";

} // namespace

GlScan::GlScan(int axis)
	: m_axis(axis), m_program(linkedProgram(
						{compiledShader(GL_COMPUTE_SHADER, "#version 430 core\n#define AXIS " + std::to_string(axis) + kSource)}))
{
}

GlScan::~GlScan()
{
	glDeleteProgram(m_program);
}

double GlScan::run(const GlTexture& source, const GlTexture& target, int layer, bool timer)
{
	glUseProgram(m_program);
	glActiveTexture(GL_TEXTURE0);
	glBindTexture(source.target(), source.name());
	glUniform1i(glGetUniformLocation(m_program, "nook_source"), 0);
	glUniform1i(glGetUniformLocation(m_program, "nook_target"), 0);
	glBindImageTexture(0, target.name(), 0, GL_FALSE, layer, GL_WRITE_ONLY, GL_RGBA32UI);
	const PictureShape& shape = target.shape();
	const auto lines = static_cast<unsigned>(m_axis == 0 ? shape.height : shape.width);
	return secondsOf(
		[lines]
		{
			glDispatchCompute(lines, 1, 1);
			glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
		},
		timer);
}

} // namespace nook
