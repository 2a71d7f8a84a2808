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
	using vec2 = WideVec2;
	using vec3 = WideVec3;
	using vec4 = WideVec4;
	using ivec2 = glm::ivec2;

	explicit WideBlock(const ShadeBlock& narrow) : from(narrow) {}

	const ShadeBlock from;
#define float Wide
#define NOOK_FIELD(type, name, meaning) type name{from.name};
	NOOK_MODULE_MEMBERS(NOOK_FIELD)
	NOOK_RIVAL_MEMBERS(NOOK_FIELD)
#undef NOOK_FIELD
#undef float
#define NOOK_FIELD(name, value, meaning) int name = from.name;
	NOOK_SHADE_CONSTANTS(NOOK_FIELD)
#undef NOOK_FIELD
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
	vec4 nookPacked(ivec2 cell) const
	{
		return vec4(m_kernels.nookPacked(cell));
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

#include "methods/twins/alchemy.h"
#include "methods/twins/aov_sparse.h"
#include "methods/twins/camera.h"
#include "methods/twins/depth.h"
#include "methods/twins/depth_levels.h"
#include "methods/twins/reconstruct.h"
#include "methods/twins/rivals_bitmask.h"
#include "methods/twins/rivals_crytek.h"
#include "methods/twins/rivals_gtao.h"
#include "methods/twins/rivals_hbao.h"
#include "methods/twins/rivals_sao.h"
#include "methods/twins/rivals_volumetric.h"
#include "methods/twins/shape.h"
#include "methods/twins/slices.h"
#include "methods/twins/statvo.h"
#include "methods/twins/statvo_tables.h"
#include "methods/twins/tables.h"
#include "methods/twins/vo.h"
#include "methods/twins/vo_area.h"

#undef float
#if defined(__clang__)
#pragma clang diagnostic pop
#endif

private:
	const shade_kernels::Kernels& m_kernels;
};

} // namespace wide_kernels
} // namespace nook::stress
