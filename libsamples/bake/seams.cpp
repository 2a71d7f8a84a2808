// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: S. Liu, Z. Ferguson, A. Jacobson, Y. Gingold, "Seamless: Seam Erasure and Seam-Aware Decoupling of Shape
// from Mesh Resolution", 2017: texels change as little as possible so that the bilinear values on both sides of a seam agree. They
// integrate along each seam and solve a linear system; here points along it stand for it, and each moves its texels in turn (S.
// Kaczmarz, 1937, with a slack per point, which makes the limit that of least squares).
#include "bake/surface_samples.h"
#include "bake/texture.h"
#include "core/lists.h"
#include "scene/topology.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

constexpr double kFlatEdge = 0.98;      // cosine of 11.5°
constexpr double kPointSlack = 0.25;    // of a point, relative to measured texels; tuned on hands and controllers
constexpr double kEmptyChange = 20.0;   // of texels outside charts, relative to measured ones
constexpr double kPointsPerTexel = 2.0; // along a seam
constexpr int kMostSweeps = 200;
constexpr double kSmallChange = 1e-4; // in a sweep; eight bits resolve 4e-3

// A point of a seam: bilinear weights of one side, and those of the other with a minus.
struct SeamPoint
{
	std::array<std::size_t, 8> texel{}; // page × size² + row × size + column
	std::array<double, 8> weight{};
	double slack = 0.0;
};

class SeamJoiner
{
public:
	SeamJoiner(const Level& level, std::span<const glm::vec2> uvs, std::span<const uint32_t> page_of,
			   std::vector<TextureBake>& pages, int threads)
		: m_level(level), m_uvs(uvs), m_page_of(page_of), m_pages(pages), m_weld(weldPositions(m_level.positions, threads)),
		  m_size(static_cast<std::size_t>(pages.front().size_px))
	{
		const EdgeTable edges(
			mapped(m_level.triangles, [this](glm::uvec3 t) { return glm::uvec3(m_weld[t.x], m_weld[t.y], m_weld[t.z]); }), {},
			m_weld.size(), threads);
		edges.each(0, edges.vertexCount(),
				   [this](std::span<const HalfEdge> edge)
				   {
					   if (isPair(edge) && isSmooth(edge[0].triangle(), edge[1].triangle()))
					   {
						   addSeam(edge[0].triangle(), vertices(edge[0]), edge[1].triangle(), vertices(edge[1]));
					   }
				   });
	}

	// `filled`: texels outside charts start from there.
	void run(const std::vector<std::vector<float>>& filled)
	{
		std::vector<std::vector<uint8_t>> empty; // 1: outside charts
		for (const TextureBake& page : m_pages)
		{
			empty.push_back(mapped(page.texels, [](float texel) { return static_cast<uint8_t>(texel < 0.0F ? 1 : 0); }));
		}
		const std::size_t area = m_size * m_size;
		for (const SeamPoint& point : m_points)
		{
			for (const std::size_t texel : point.texel)
			{
				m_pages[texel / area].texels[texel % area] = filled[texel / area][texel % area];
			}
		}
		const auto changeOf = [&](std::size_t texel)
		{
			return empty[texel / area][texel % area] != 0 ? kEmptyChange : 1.0;
		};
		double most = 1.0;
		for (int sweep = 0; sweep < kMostSweeps && most > kSmallChange && !m_points.empty(); ++sweep)
		{
			most = 0.0;
			for (SeamPoint& point : m_points)
			{
				double apart = kPointSlack * point.slack;
				double square = kPointSlack * kPointSlack;
				for (std::size_t i = 0; i < 8; ++i)
				{
					const std::size_t texel = point.texel[i];
					apart += point.weight[i] * static_cast<double>(m_pages[texel / area].texels[texel % area]);
					square += point.weight[i] * point.weight[i] * changeOf(texel);
				}
				point.slack -= kPointSlack * apart / square;
				for (std::size_t i = 0; i < 8; ++i)
				{
					const std::size_t texel = point.texel[i];
					const double change = changeOf(texel) * point.weight[i] * apart / square;
					float& value = m_pages[texel / area].texels[texel % area];
					value = std::clamp(value - static_cast<float>(change), 0.0F, 1.0F);
					most = std::max(most, std::fabs(change));
				}
			}
		}
	}

private:
	// The ends of an edge in its triangle, the one at the lower welded vertex first.
	std::array<uint32_t, 2> vertices(const HalfEdge& edge) const
	{
		const glm::uvec3 corners = m_level.triangles[edge.triangle()];
		const bool descends = edge.side % 2 != 0;
		int k = 0; // of the higher one
		while (m_weld[corners[k]] != edge.to)
		{
			++k;
		}
		return {corners[(k + (descends ? 1 : 2)) % 3], corners[k]};
	}

	// Does the normal not jump at an edge?
	bool isSmooth(uint32_t a, uint32_t b) const
	{
		const glm::dvec3 of_a = twiceAreaOf(m_level, a);
		const glm::dvec3 of_b = twiceAreaOf(m_level, b);
		return glm::dot(of_a, of_b) > kFlatEdge * glm::length(of_a) * glm::length(of_b);
	}

	void addSeam(uint32_t a, const std::array<uint32_t, 2>& of_a, uint32_t b, const std::array<uint32_t, 2>& of_b)
	{
		const std::size_t page_a = m_page_of.empty() ? 0 : m_page_of[a];
		const std::size_t page_b = m_page_of.empty() ? 0 : m_page_of[b];
		const std::array<glm::dvec2, 2> uv_a{m_uvs[of_a[0]], m_uvs[of_a[1]]};
		const std::array<glm::dvec2, 2> uv_b{m_uvs[of_b[0]], m_uvs[of_b[1]]};
		const double longest = std::max(glm::distance(uv_a[0], uv_a[1]), glm::distance(uv_b[0], uv_b[1]));
		const double count = std::ceil(kPointsPerTexel * static_cast<double>(m_size) * longest);
		for (double i = 0.0; i <= count && count > 0.0 && (page_a != page_b || uv_a != uv_b); i += 1.0)
		{
			SeamPoint& point = m_points.emplace_back();
			addSide(point, 0, page_a, glm::mix(uv_a[0], uv_a[1], i / count), 1.0);
			addSide(point, 4, page_b, glm::mix(uv_b[0], uv_b[1], i / count), -1.0);
		}
	}

	void addSide(SeamPoint& point, std::size_t first, std::size_t page, glm::dvec2 uv, double sign) const
	{
		const glm::dvec2 at = static_cast<double>(m_size) * uv - 0.5;
		for (std::size_t i = 0; i < 4; ++i)
		{
			const glm::dvec2 texel = glm::floor(at) + glm::dvec2(i % 2, i / 2);
			const glm::dvec2 share = 1.0 - glm::abs(at - texel);
			const glm::uvec2 inside(glm::clamp(texel, 0.0, static_cast<double>(m_size) - 1.0));
			point.texel[first + i] = (page * m_size + inside.y) * m_size + inside.x;
			point.weight[first + i] = sign * share.x * share.y;
		}
	}

	const Level& m_level;
	std::span<const glm::vec2> m_uvs;
	std::span<const uint32_t> m_page_of;
	std::vector<TextureBake>& m_pages;
	std::vector<uint32_t> m_weld;
	std::size_t m_size;
	std::vector<SeamPoint> m_points;
};

} // namespace

void finishTextures(const Level& level, std::span<const glm::vec2> uvs, std::span<const uint32_t> page_of,
					std::vector<TextureBake>& pages, int threads)
{
	std::vector<std::vector<float>> filled;
	for (const TextureBake& page : pages)
	{
		filled.push_back(page.texels);
		fillEmpty(filled.back(), page.size_px);
	}
	SeamJoiner(level, uvs, page_of, pages, threads).run(filled);
	for (TextureBake& page : pages)
	{
		fillEmpty(page.texels, page.size_px);
		page.values =
			mapped(page.texels, [](float texel) { return static_cast<uint8_t>(std::clamp(texel, 0.0F, 1.0F) * 255.0F + 0.5F); });
	}
}

} // namespace nook
