// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/aov_gl_volumes.h"

#include <epoxy/gl.h>

#include <array>
#include <cstdint>
#include <numeric>

namespace nook
{
namespace
{

template <class Item> std::span<const std::byte> bytesOf(const std::vector<Item>& items)
{
	return std::as_bytes(std::span(items));
}

} // namespace

GlVolumes::GlVolumes(const PackedVolumes& packed, const nook_volumes::Frame& frame, const AovGlOptions& options)
	: m_packed(packed), m_frame(frame), m_options(options)
{
	std::vector<nook_volumes::SeenCluster> seen;
	for (const nook_volumes::Cluster& cluster : packed.clusters)
	{
		seen.push_back(frame.seen(cluster));
	}
	m_corners = std::make_unique<GlArray>(bytesOf(packed.corners), GL_RGBA16UI, 8);
	m_polygons = std::make_unique<GlArray>(bytesOf(packed.polygons), GL_RG32UI, 8);
	m_clusters = std::make_unique<GlArray>(bytesOf(seen), GL_RGBA32UI, 16);
	m_bounds = options.depth_bounds && !options.storage_buffers && epoxy_has_gl_extension("GL_EXT_depth_bounds_test");
	glGenVertexArrays(1, &m_vertices);
	glBindVertexArray(m_vertices);
	if (options.prisms)
	{
		m_points = std::make_unique<GlArray>(bytesOf(packed.vertices), GL_RGBA16UI, 8);
		m_indices = std::make_unique<GlArray>(bytesOf(packed.indices), GL_R16UI, 2);
		glBindBuffer(GL_ARRAY_BUFFER, m_points->buffer());
		glEnableVertexAttribArray(1);
		glVertexAttribIPointer(1, 4, GL_UNSIGNED_SHORT, 8, nullptr);
		glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, m_indices->buffer());
	}
	if (options.storage_buffers)
	{
		std::vector<int> numbers(packed.clusters.size());
		std::iota(numbers.begin(), numbers.end(), 0);
		m_numbers = std::make_unique<GlArray>(bytesOf(numbers), GL_R32I, 4);
		glGenBuffers(1, &m_commands);
		glBindBuffer(GL_ARRAY_BUFFER, m_numbers->buffer());
		glEnableVertexAttribArray(0);
		glVertexAttribIPointer(0, 1, GL_INT, 4, nullptr);
		glVertexAttribDivisor(0, 1);
	}
}

GlVolumes::~GlVolumes()
{
	glDeleteVertexArrays(1, &m_vertices);
	glDeleteBuffers(1, &m_commands);
}

void GlVolumes::bind() const
{
	glBindVertexArray(m_vertices);
	const std::array<const GlArray*, 3> arrays{m_corners.get(), m_polygons.get(), m_clusters.get()};
	for (unsigned i = 0; i < arrays.size(); ++i)
	{
		arrays[i]->bindTexture(i);
		if (m_options.storage_buffers)
		{
			arrays[i]->bindStorage(i);
		}
	}
}

void GlVolumes::draw(const std::vector<std::size_t>& clusters) const
{
	m_options.storage_buffers ? drawTogether(clusters) : drawOneByOne(clusters);
}

void GlVolumes::drawOneByOne(const std::vector<std::size_t>& clusters) const
{
	for (const std::size_t i : clusters)
	{
		const nook_volumes::Cluster& cluster = m_packed.clusters[i];
		glVertexAttribI1i(0, static_cast<int>(i));
		if (m_bounds)
		{
			double least = 0.0;
			double most = 1.0;
			m_frame.depthBounds(cluster, least, most);
			glDepthBoundsEXT(least, most);
		}
		if (m_options.prisms)
		{
			const auto* const first = reinterpret_cast<const void*>(2 * static_cast<std::uintptr_t>(cluster.first_index));
			glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<int>(cluster.index_count), GL_UNSIGNED_SHORT, first,
									 static_cast<int>(cluster.first_vertex));
			continue;
		}
		glDrawArrays(GL_TRIANGLES, static_cast<int>(12 * cluster.first_corner), static_cast<int>(12 * cluster.corner_count));
	}
}

// One call: the clusters' numbers are an attribute of instances, of which each has one.
void GlVolumes::drawTogether(const std::vector<std::size_t>& clusters) const
{
	std::vector<unsigned> commands; // as glMultiDrawArraysIndirect and glMultiDrawElementsIndirect lay them out
	for (const std::size_t i : clusters)
	{
		const nook_volumes::Cluster& cluster = m_packed.clusters[i];
		const auto number = static_cast<unsigned>(i);
		if (m_options.prisms)
		{
			commands.insert(commands.end(), {cluster.index_count, 1U, cluster.first_index, cluster.first_vertex, number});
			continue;
		}
		commands.insert(commands.end(), {12 * cluster.corner_count, 1U, 12 * cluster.first_corner, number});
	}
	glBindBuffer(GL_DRAW_INDIRECT_BUFFER, m_commands);
	glBufferData(GL_DRAW_INDIRECT_BUFFER, static_cast<GLsizeiptr>(sizeof(unsigned) * commands.size()), commands.data(),
				 GL_STREAM_DRAW);
	if (m_options.prisms)
	{
		glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, nullptr, static_cast<int>(clusters.size()), 0);
		return;
	}
	glMultiDrawArraysIndirect(GL_TRIANGLES, nullptr, static_cast<int>(clusters.size()), 0);
}

} // namespace nook
