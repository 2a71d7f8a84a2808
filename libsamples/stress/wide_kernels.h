// SPDX-License-Identifier: GPL-3.0-or-later
// The shared kernels once more, with the numbers of wide.h in place of floats.
#pragma once

#include "methods/kernels.h"
#include "stress/wide.h"

#include <glm/common.hpp>

namespace nook::stress
{

// ShadeBlock in wide numbers: members of the same names.
struct WideBlock
{
	explicit WideBlock(const ShadeBlock& b)
		: size(b.size), across_x(b.across_x), across_y(b.across_y), w(b.w), origin(b.origin), rect(b.rect), depth(b.depth),
		  error(b.error), radius(b.radius), alchemy(b.alchemy), volume(b.volume), limits(b.limits), count(b.count),
		  features(b.features), bands(b.bands), grid(b.grid), statvo(b.statvo), layers(b.layers), table(b.table), slices(b.slices), march(b.march),
		  rival(b.rival)
	{
	}

	WideVec4 size, across_x, across_y, w, origin;
	glm::ivec4 rect;
	WideVec4 depth, error, radius, alchemy, volume, limits;
	glm::ivec4 count, features, bands, grid;
	WideVec4 statvo;
	glm::ivec4 layers, table;
	WideVec4 slices;
	glm::ivec4 march;
	WideVec4 rival;
};

namespace wide_kernels
{

using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::uint;
using glm::uvec4;
using stress::clamp;
using stress::max;
using stress::min;
using vec2 = WideVec2;
using vec3 = WideVec3;
using vec4 = WideVec4;

inline int clamp(int a, int least, int most)
{
	return glm::clamp(a, least, most);
}
inline int max(int a, int b)
{
	return glm::max(a, b);
}
inline int min(int a, int b)
{
	return glm::min(a, b);
}
inline uint min(uint a, uint b)
{
	return glm::min(a, b);
}

// As shade_kernels::Kernels, whose pictures it reads.
class Kernels
{
public:
	explicit Kernels(const shade_kernels::Kernels& kernels) : nook(kernels.nook), m_kernels(kernels) {}

	WideBlock nook;

#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wkeyword-macro"
#endif
#define float Wide

	float nookDepth(ivec2 pixel) const
	{
		return m_kernels.nookDepth(pixel);
	}
	vec3 nookNormal(ivec2 pixel) const
	{
		return vec3(m_kernels.nookNormal(pixel));
	}
	int nookVariant(ivec2 pixel) const
	{
		return m_kernels.nookVariant(pixel);
	}
	vec4 nookSample(int row, int i) const
	{
		return vec4(m_kernels.nookSample(row, i));
	}
	float nookVisibility(ivec2 cell) const
	{
		return m_kernels.nookVisibility(cell);
	}
	vec4 nookLevel(ivec2 texel, int level) const
	{
		return vec4(m_kernels.nookLevel(texel, level));
	}
	uvec4 nookTable(ivec2 texel, int table) const
	{
		return m_kernels.nookTable(texel, table);
	}
	vec4 nookRange(int i) const
	{
		return vec4(m_kernels.nookRange(i));
	}

#include "methods/kernels/alchemy.glsl"
#include "methods/kernels/aov_sparse.glsl"
#include "methods/kernels/camera.glsl"
#include "methods/kernels/depth.glsl"
#include "methods/kernels/depth_levels.glsl"
#include "methods/kernels/reconstruct.glsl"
#include "methods/kernels/rivals_crytek.glsl"
#include "methods/kernels/rivals_hbao.glsl"
#include "methods/kernels/rivals_sao.glsl"
#include "methods/kernels/rivals_volumetric.glsl"
#include "methods/kernels/slices.glsl"
#include "methods/kernels/statvo.glsl"
#include "methods/kernels/statvo_tables.glsl"
#include "methods/kernels/tables.glsl"
#include "methods/kernels/vo.glsl"
#include "methods/kernels/vo_area.glsl"

#undef float
#if defined(__clang__)
#pragma clang diagnostic pop
#endif

private:
	const shade_kernels::Kernels& m_kernels;
};

} // namespace wide_kernels
} // namespace nook::stress
