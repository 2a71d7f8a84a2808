// SPDX-License-Identifier: GPL-3.0-or-later
// The directions of a receiver that polygons cover, as bits.
#pragma once

#include "methods/aov_text.h"
#include "methods/volume_kernels.h"
#include "volume/lanes.h"
#include "volume/volumes.h"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace nook
{

constexpr std::size_t kMostFours = kMaxOccluderCorners / 4;

// A polygon whose volume contains the receiver, for masks.
struct Held
{
	uint32_t index = 0;
	glm::vec3 front{0.0F};
	float height = 0.0F; // of the receiver above the polygon, m
	std::size_t fours = 0;
	std::array<Vectors, kMostFours> from; // corners relative to the receiver
	std::array<Vectors, kMostFours> to;   // the next ones
};

using MaskBits = std::array<glm::uvec4, kMostDirections / 128>;

// a.y * b.z - b.y * a.z. Products of 32-bit floats are exact in 64 bits, as the kernel's split ones nearly are.
inline Floats exactProducts(Floats ay, Floats bz, Floats by, Floats az)
{
	const Doubles left = __builtin_convertvector(ay, Doubles) * __builtin_convertvector(bz, Doubles);
	return __builtin_convertvector(left - __builtin_convertvector(by, Doubles) * __builtin_convertvector(az, Doubles), Floats);
}

// A receiver of masks. Its functions return what those of mask.glsl do, but compute the frame once per receiver, and only rays that
// no edge has ruled out.
class MaskReceiver
{
public:
	MaskReceiver(glm::vec3 normal, const MaskTables& tables, float reach)
		: m_normal(normal), m_x(m_kernels.nookTangent(normal, 0)), m_y(m_kernels.nookTangent(normal, 1)), m_tables(tables),
		  m_fours(static_cast<int>(tables.rays.size() / 128)), m_reach(reach)
	{
	}

	// Removes the bits that nookMaskBits() has for the polygon.
	void cover(const Held& held, const Occluder& polygon, MaskBits& open)
	{
		const float side = held.height < 0.0F ? -1.0F : 1.0F;
		const float least = std::fabs(held.height) / m_reach;
		const glm::vec3 down =
			glm::vec3(glm::dot(held.front, m_x), glm::dot(held.front, m_y), glm::dot(held.front, m_normal)) * -side;
		if (down.z < 0.0F && least * least > down.x * down.x + down.y * down.y + 1e-3F)
		{
			return; // no ray of the hemisphere reaches the plane
		}
		MaskBits bits = open;
		for (std::size_t i = 0; i < held.fours; ++i)
		{
			if (!cutByEdges(held.from[i], held.to[i], side, bits))
			{
				return;
			}
		}
		const float shift = m_kernels.nookShift(static_cast<int>(polygon.first_corner));
		for (int word = 0; word < 4 * m_fours; ++word)
		{
			uint32_t& left = open[static_cast<std::size_t>(word / 4)][word % 4];
			uint32_t asked = bits[static_cast<std::size_t>(word / 4)][word % 4];
			if (asked != 0 && polygon.alpha < 1.0F)
			{
				asked &= m_kernels.nookMaskShare(word, polygon.alpha, shift);
			}
			for (; asked != 0; asked &= asked - 1)
			{
				const int i = std::countr_zero(asked);
				const glm::vec3& ray = m_tables.rays[static_cast<std::size_t>(32 * word + i)];
				left &= ~(uint32_t{glm::dot(ray, down) > least} << i);
			}
		}
	}

private:
	// nookInsideEdge() of nookInward(). Returns false if no bit remains.
	bool cutByEdges(const Vectors& from, const Vectors& to, float side, MaskBits& bits)
	{
		const Vectors across{exactProducts(to.y, from.z, from.y, to.z), exactProducts(to.z, from.x, from.z, to.x),
							 exactProducts(to.x, from.y, from.x, to.y)};
		const Vectors inward{dotOf(across, allOf(m_x)) * side, dotOf(across, allOf(m_y)) * side,
							 dotOf(across, allOf(m_normal)) * side};
		const Floats size = magnitudeOf(inward.x) + magnitudeOf(inward.y) + magnitudeOf(inward.z);
		const Floats sign = inward.z != 0.0F ? inward.z : inward.y != 0.0F ? inward.y : inward.x;
		const int texels = m_kernels.nookHalfSpaces();
		const float half_side = 0.5F * static_cast<float>(texels);
		const Floats positive = half_side / (size > 1e-37F ? size : Floats{} + 1e-37F);
		const Floats scale = sign < 0.0F ? -positive : positive;
		const Ints x = __builtin_convertvector(half_side + scale * (inward.x + inward.y), Ints);
		const Ints y = __builtin_convertvector(half_side + scale * (inward.x - inward.y), Ints);
		for (std::size_t i = 0; i < 4; ++i)
		{
			if (!(size[i] > 0.0F))
			{
				continue;
			}
			const glm::uvec4 other(sign[i] < 0.0F ? ~0U : 0U);
			const int texel = std::min(y[i], texels - 1) * texels + std::min(x[i], texels - 1);
			uint32_t any = 0;
			for (int four = 0; four < m_fours; ++four)
			{
				glm::uvec4& cut = bits[static_cast<std::size_t>(four)];
				cut &= m_tables.half_spaces[static_cast<std::size_t>(four * texels * texels + texel)] ^ other;
				any |= cut.x | cut.y | cut.z | cut.w;
			}
			if (any == 0)
			{
				return false;
			}
		}
		return true;
	}

	volume_kernels::Kernels m_kernels;
	glm::vec3 m_normal;
	glm::vec3 m_x;
	glm::vec3 m_y;
	const MaskTables& m_tables;
	int m_fours;
	float m_reach;
};

} // namespace nook
