// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV), §5.
#include "core/error.h"
#include "core/lists.h"
#include "methods/block.h"
#include "methods/kernels.h"
#include "shade/aov_gl_parts.h"
#include "shade/run_passes.h"

#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace nook
{

nook_volumes::Header headerOf(const VolumeSet& volumes, bool compensate)
{
	nook_volumes::Header header{};
	header.version = nook_volumes::kVersion;
	header.flags = volumes.exact_bounds ? nook_volumes::kExactBounds : 0;
	header.distance = volumes.distance_m;
	header.ray_distance = volumes.ray_distance_m;
	header.plane_error = volumes.plane_error_m;
	header.sum_range = compensate ? volumes.compensation.range : 1.0;
	for (std::size_t i = 0; i < nook_volumes::kKnots; ++i)
	{
		const double place = static_cast<double>(i) / static_cast<double>(nook_volumes::kKnots - 1);
		header.occlusion[i] = compensate ? volumes.compensation.occlusion[i] : place;
	}
	return header;
}

nook_volumes::Camera cameraOf(const GBuffer& gbuffer, int every_px)
{
	nook_volumes::Camera camera;
	std::copy_n(glm::value_ptr(gbuffer.view.camera_from_world), 16, camera.camera_from_world);
	std::copy_n(glm::value_ptr(gbuffer.view.projection), 16, camera.projection);
	camera.width = gbuffer.width_px;
	camera.height = gbuffer.height_px;
	camera.every = every_px;
	camera.position_error = gbuffer.view_error_m;
	if (!gbuffer.depth_error_m.empty())
	{
		ShadeBlock block;
		block.w_slope = static_cast<float>(-camera.projection[11]);
		block.w_start = static_cast<float>(camera.projection[15]);
		fillMeasuredError(block, gbuffer.depth, gbuffer.depth_error_m);
		camera.depth_step = static_cast<double>(block.depth_step);
		camera.depth_share = std::max(static_cast<double>(block.depth_share), camera.depth_share);
	}
	double nearest = std::numeric_limits<double>::infinity();
	double farthest = 0.0;
	for (const float depth : gbuffer.depth)
	{
		if (std::isfinite(depth))
		{
			nearest = std::min(nearest, static_cast<double>(depth));
			farthest = std::max(farthest, static_cast<double>(depth));
		}
	}
	nearest = std::min(nearest, 1e15); // everything is sky
	camera.nearest = nearest * (1.0 - 1e-6);
	camera.farthest = std::max(farthest, nearest) * (1.0 + 1e-6);
	// Rows run downward, and so does y. z = a · depth + b is −w at the nearest depth and w at the farthest.
	double* const p = camera.projection;
	for (int column = 0; column < 4; ++column)
	{
		p[4 * column + 1] = -p[4 * column + 1];
		p[4 * column + 2] = 0.0;
	}
	const double least = -p[11] * camera.nearest + p[15];
	const double most = -p[11] * camera.farthest + p[15];
	const double a = (least + most) / (camera.farthest - camera.nearest);
	p[10] = -a;
	p[14] = -least - a * camera.nearest;
	return camera;
}

namespace
{

// An array for shaders: a buffer and its buffer texture.
class GlArray
{
public:
	// `format` is the texel format and `texel` its size in bytes. Throws Error (unsupported) for more texels than OpenGL supports.
	GlArray(std::span<const std::byte> bytes, unsigned format, std::size_t texel)
		: buffer(glGenBuffers, glDeleteBuffers), m_texture(glGenTextures, glDeleteTextures)
	{
		int most = 0;
		glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
		refuseIf(bytes.size() / texel > static_cast<std::size_t>(most),
				 "OpenGL: found " + std::to_string(bytes.size() / texel) +
					 " corners, polygons or clusters of volumes, expected at most " + std::to_string(most),
				 ExitCode::unsupported);
		glBindBuffer(GL_TEXTURE_BUFFER, buffer);
		glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(std::max(bytes.size(), texel)), nullptr, GL_STATIC_DRAW);
		glBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
		glActiveTexture(GL_TEXTURE15);
		glBindTexture(GL_TEXTURE_BUFFER, m_texture);
		glTexBuffer(GL_TEXTURE_BUFFER, format, buffer);
		checkGlErrors();
	}

	// Binds it to the shaders' unit and, in OpenGL 4.3, to the storage of that number.
	void bind(unsigned unit, bool storage) const
	{
		glActiveTexture(GL_TEXTURE0 + unit);
		glBindTexture(GL_TEXTURE_BUFFER, m_texture);
		if (storage)
		{
			glBindBufferBase(GL_SHADER_STORAGE_BUFFER, unit, buffer);
		}
	}

	const GlName buffer;

private:
	GlName m_texture;
};

// Textures that the programs read, by unit.
constexpr std::array<const char*, 9> kAovUnits{"nook_corners", "nook_polygons",  "nook_clusters", "nook_depths",     "nook_normals",
											   "nook_sums",    "nook_more_sums", "nook_cells",    "nook_half_spaces"};

// A program whose block `NookVolumes` has binding 0.
GlName aovProgram(GlName program)
{
	const unsigned block = glGetUniformBlockIndex(program, "NookVolumes");
	if (block != GL_INVALID_INDEX)
	{
		glUniformBlockBinding(program, block, 0);
	}
	glUseProgram(program);
	for (std::size_t i = 0; i < kAovUnits.size(); ++i)
	{
		glUniform1i(glGetUniformLocation(program, kAovUnits[i]), static_cast<int>(i));
	}
	checkGlErrors();
	return program;
}

// An empty texture used as render target.
GlName targetOf(unsigned stored, unsigned channels, unsigned type, int width, int height)
{
	GlName name(glGenTextures, glDeleteTextures);
	glActiveTexture(GL_TEXTURE15);
	glBindTexture(GL_TEXTURE_2D, name);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	glTexImage2D(GL_TEXTURE_2D, 0, static_cast<int>(stored), width, height, 0, channels, type, nullptr);
	checkGlErrors();
	return name;
}

// Render targets drawn into together; depth: with stencil, 0: none. It stays bound.
GlName glFrameOf(std::span<const unsigned> colours, unsigned depth)
{
	GlName name(glGenFramebuffers, glDeleteFramebuffers);
	glBindFramebuffer(GL_FRAMEBUFFER, name);
	std::vector<unsigned> places;
	for (const unsigned colour : colours)
	{
		places.push_back(GL_COLOR_ATTACHMENT0 + static_cast<unsigned>(places.size()));
		glFramebufferTexture2D(GL_FRAMEBUFFER, places.back(), GL_TEXTURE_2D, colour, 0);
	}
	glDrawBuffers(static_cast<int>(places.size()), places.data());
	if (depth != 0)
	{
		glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
	}
	refuseIf(glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE,
			 "OpenGL: found no pictures of that format to draw into, expected some", ExitCode::unsupported);
	return name;
}

// Converts linear depth to depth buffer values.
constexpr const char* kDepthPass = R"(#version 330 core
uniform sampler2D nook_depths;
uniform int nook_every;
uniform vec4 nook_z; // z = x · depth + y, w = z · depth + w
void main()
{
	float depth = texelFetch(nook_depths, ivec2(gl_FragCoord.xy) * nook_every, 0).r;
	gl_FragDepth = depth < 1e30 ? 0.5 + 0.5 * (nook_z.x * depth + nook_z.y) / (nook_z.z * depth + nook_z.w) : 1.0;
}
)";

// For sums, or for bits in as many 32-bit channels as needed.
GlName volumeTarget(const AovSettings& settings, int bits, int width, int height)
{
	if (!settings.mask)
	{
		const AovTarget target = settings.target;
		const unsigned stored = target == AovTarget::r16f ? GL_R16F : target == AovTarget::r8 ? GL_R8 : GL_R32F;
		return targetOf(stored, GL_RED, GL_FLOAT, width, height);
	}
	const unsigned stored = bits <= 32 ? GL_R32UI : bits <= 64 ? GL_RG32UI : GL_RGBA32UI;
	const unsigned channels = bits <= 32 ? GL_RED_INTEGER : bits <= 64 ? GL_RG_INTEGER : GL_RGBA_INTEGER;
	return targetOf(stored, channels, GL_UNSIGNED_INT, width, height);
}

void bindTexture(unsigned unit, unsigned name)
{
	glActiveTexture(GL_TEXTURE0 + unit);
	glBindTexture(GL_TEXTURE_2D, name);
}

template <class Item> std::span<const std::byte> bytesOf(const std::vector<Item>& items)
{
	return std::as_bytes(std::span(items));
}

// Render targets for volumes (one pixel per cell, or all pixels) and the resulting visibility.

class AovPicture
{
public:
	// Throws Error (unsupported) for a skewed camera.
	AovPicture(const GBuffer& gbuffer, const nook_volumes::Header& header, const AovSettings& settings, int every_px)
		: result(PictureShape{PictureFormat::scalar, (gbuffer.width_px + every_px - 1) / every_px,
							  (gbuffer.height_px + every_px - 1) / every_px}),
		  m_mask(settings.mask), m_every_px(every_px), m_camera(cameraOf(gbuffer, every_px)), m_block(glGenBuffers, glDeleteBuffers)
	{
		const char* const problem = frame.set(header, m_camera);
		if (problem != nullptr)
		{
			throw Error(ExitCode::unsupported, std::string("camera: found ") + problem +
												   ", expected a right-handed one, column by column, without a skew");
		}
		m_depth_stencil = targetOf(GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, result.shape.width,
								   result.shape.height);
		std::vector<unsigned> sums;
		for (int first = 0; first < (settings.mask ? settings.directions : 1); first += 128)
		{
			// Above 128 directions there are two targets, the second with all four channels; unused ones stay 0.
			m_sums.push_back(
				volumeTarget(settings, first > 0 ? 128 : settings.directions, result.shape.width, result.shape.height));
			sums.push_back(m_sums.back());
		}
		m_volume_frame = glFrameOf(sums, m_depth_stencil);
		m_result_frame = glFrameOf(std::array<unsigned, 1>{result.name}, m_depth_stencil);
		glBindBuffer(GL_UNIFORM_BUFFER, m_block);
		glBufferData(GL_UNIFORM_BUFFER, sizeof frame.block, &frame.block, GL_STATIC_DRAW);
	}

	nook_volumes::Frame frame;
	const GlTexture result;

	// Binds the uniform block and this picture's textures.
	void bind() const
	{
		glBindBufferBase(GL_UNIFORM_BUFFER, 0, m_block);
		bindTexture(5, m_sums[0]);
		bindTexture(6, m_sums.back());
		bindTexture(7, result.name);
	}

	// Draws the depth buffer from the bound linear depths; leaves the depth test enabled and depth writes disabled.
	void drawDepth(unsigned program) const
	{
		const double* const p = m_camera.projection;
		glBindFramebuffer(GL_FRAMEBUFFER, m_volume_frame);
		glViewport(0, 0, result.shape.width, result.shape.height);
		glUseProgram(program);
		glUniform4f(glGetUniformLocation(program, "nook_z"), static_cast<float>(-p[10]), static_cast<float>(p[14]),
					static_cast<float>(-p[11]), static_cast<float>(p[15]));
		glUniform1i(glGetUniformLocation(program, "nook_every"), m_every_px);
		glDisable(GL_BLEND);
		glDisable(GL_CULL_FACE);
		glEnable(GL_DEPTH_TEST);
		glDepthFunc(GL_ALWAYS);
		glDepthMask(GL_TRUE);
		glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
		glDrawArrays(GL_TRIANGLES, 0, 3);
		glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
		glDepthMask(GL_FALSE);
	}

	// Call before drawing volumes: clears the sums or bits and draws into them.
	void beginVolumes() const
	{
		glBindFramebuffer(GL_FRAMEBUFFER, m_volume_frame);
		glViewport(0, 0, result.shape.width, result.shape.height);
		const std::array<float, 4> none{};
		const std::array<unsigned, 4> no_bits{};
		for (std::size_t i = 0; i < m_sums.size(); ++i)
		{
			if (m_mask)
			{
				glClearBufferuiv(GL_COLOR, static_cast<int>(i), no_bits.data());
				continue;
			}
			glClearBufferfv(GL_COLOR, static_cast<int>(i), none.data());
		}
	}

	// Draws into the visibility from here on.
	void useResult() const
	{
		glBindFramebuffer(GL_FRAMEBUFFER, m_result_frame);
		glViewport(0, 0, result.shape.width, result.shape.height);
	}

private:
	bool m_mask;
	int m_every_px;
	nook_volumes::Camera m_camera;
	GlName m_depth_stencil;
	std::vector<GlName> m_sums;
	GlName m_volume_frame, m_result_frame;
	GlName m_block;
};

// Packed volumes on the GPU, and draw calls for their clusters.

class GlVolumes
{
public:
	// The volumes of one frame. Keeps references to both arguments, which must outlive it. Throws like GlArray.
	GlVolumes(const PackedVolumes& packed, const nook_volumes::Frame& frame, const AovGlOptions& options)
		: has_depth_bounds(options.depth_bounds && !options.storage_buffers && epoxy_has_gl_extension("GL_EXT_depth_bounds_test")),
		  m_packed(packed), m_frame(frame), m_options(options), m_vertices(glGenVertexArrays, glDeleteVertexArrays)
	{
		const auto seen = mapped(packed.clusters, [&](const nook_volumes::Cluster& cluster) { return frame.seen(cluster); });
		m_corners = std::make_unique<GlArray>(bytesOf(packed.corners), GL_RGBA16UI, 8);
		m_polygons = std::make_unique<GlArray>(bytesOf(packed.polygons), GL_RG32UI, 8);
		m_clusters = std::make_unique<GlArray>(bytesOf(seen), GL_RGBA32UI, 16);
		glBindVertexArray(m_vertices);
		if (options.prisms)
		{
			m_points = std::make_unique<GlArray>(bytesOf(packed.vertices), GL_RGBA16UI, 8);
			m_indices = std::make_unique<GlArray>(bytesOf(packed.indices), GL_R16UI, 2);
			glBindBuffer(GL_ARRAY_BUFFER, m_points->buffer);
			glEnableVertexAttribArray(1);
			glVertexAttribIPointer(1, 4, GL_UNSIGNED_SHORT, 8, nullptr);
			glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, m_indices->buffer);
		}
		if (options.storage_buffers)
		{
			m_numbers = std::make_unique<GlArray>(bytesOf(countingFrom(0, packed.clusters.size())), GL_R32I, 4);
			m_commands = GlName(glGenBuffers, glDeleteBuffers);
			glBindBuffer(GL_ARRAY_BUFFER, m_numbers->buffer);
			glEnableVertexAttribArray(0);
			glVertexAttribIPointer(0, 1, GL_INT, 4, nullptr);
			glVertexAttribDivisor(0, 1);
		}
	}

	// Call before drawing: binds the shaders' arrays and the vertex attributes.
	void bind() const
	{
		glBindVertexArray(m_vertices);
		const std::array<const GlArray*, 3> arrays{m_corners.get(), m_polygons.get(), m_clusters.get()};
		for (unsigned i = 0; i < arrays.size(); ++i)
		{
			arrays[i]->bind(i, m_options.storage_buffers);
		}
	}

	// Uses the current state and program.
	void draw(const std::vector<std::size_t>& clusters) const
	{
		m_options.storage_buffers ? drawTogether(clusters) : drawOneByOne(clusters);
	}

	const bool has_depth_bounds; // available and requested; the caller must then enable the test around draw()

private:
	void drawOneByOne(const std::vector<std::size_t>& clusters) const
	{
		for (const std::size_t i : clusters)
		{
			const nook_volumes::Cluster& cluster = m_packed.clusters[i];
			glVertexAttribI1i(0, static_cast<int>(i));
			if (has_depth_bounds)
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

	// A single draw call: cluster numbers are an instanced attribute, with one instance per cluster.
	void drawTogether(const std::vector<std::size_t>& clusters) const
	{
		std::vector<unsigned> commands; // in the layout of glMultiDrawArraysIndirect and glMultiDrawElementsIndirect
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

	const PackedVolumes& m_packed;
	const nook_volumes::Frame& m_frame;
	AovGlOptions m_options;
	std::unique_ptr<GlArray> m_corners, m_polygons, m_clusters, m_points, m_indices, m_numbers;
	GlName m_vertices;
	GlName m_commands;
};

class Drawer
{
public:
	Drawer(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const AovGlOptions& options)
		: m_gbuffer(gbuffer), m_settings(settings), m_options(options), m_packed(packVolumes(volumes, {options.prisms}, {})),
		  m_header(headerOf(volumes, settings.compensate)),
		  m_text(aovText(
			  {options.storage_buffers ? GlslTarget::gl430 : GlslTarget::gl330, settings.mask ? settings.directions : 0, false}))
	{
		// Clamped bounds cut volumes where they still occlude, and front and back faces would lose different parts.
		m_options.choose_faces = options.choose_faces && volumes.exact_bounds;
		m_header.plane_error = std::max(m_header.plane_error, m_packed.plane_error_m);
		m_picture = std::make_unique<AovPicture>(gbuffer, m_header, settings, settings.every_px);
		if (settings.every_px > 1)
		{
			m_whole = std::make_unique<AovPicture>(gbuffer, m_header, settings, 1);
		}
		choose(volumes);
		upload();
	}

	std::vector<PassTime> draw(bool timer)
	{
		m_volumes->bind();
		bindTexture(3, m_depths->name);
		bindTexture(4, m_normals->name);
		bindTexture(8, m_half_spaces);
		m_picture->bind();
		counts.fragments = 0;
		std::vector<PassTime> times;
		times.push_back({"depth", secondsOf([this] { m_picture->drawDepth(m_depth_program); }, timer)});
		times.push_back({"volumes", secondsOf([this] { drawVolumes(*m_picture); }, timer)});
		times.push_back({"resolve", secondsOf([this] { resolve(*m_picture); }, timer)});
		if (m_whole)
		{
			glEnable(GL_STENCIL_TEST);
			times.push_back({"reconstruction", secondsOf([this] { reconstruct(); }, timer)});
			m_whole->bind();
			times.push_back({"depth, pixels alone", secondsOf([this] { m_whole->drawDepth(m_depth_program); }, timer)});
			times.push_back({"volumes, pixels alone", secondsOf([this] { drawVolumes(*m_whole); }, timer)});
			times.push_back({"resolve, pixels alone", secondsOf([this] { counts.pixels_alone = resolve(*m_whole); }, timer)});
			glDisable(GL_STENCIL_TEST);
		}
		return times;
	}

	std::vector<float> visibility() const
	{
		return readFloats((m_whole ? m_whole : m_picture)->result);
	}

	AovCounts counts;

private:
	void choose(const VolumeSet& volumes)
	{
		counts.volumes = volumes.occluders.polygons.size();
		for (std::size_t i = 0; i < m_packed.clusters.size(); ++i)
		{
			const nook_volumes::Cluster& cluster = m_packed.clusters[i];
			if (m_settings.cull && !m_picture->frame.inSight(cluster))
			{
				continue;
			}
			const bool around = m_options.back_faces || m_picture->frame.holdsEye(cluster);
			if (m_options.choose_faces || !around)
			{
				m_before.push_back(i);
			}
			if (m_options.choose_faces || around)
			{
				m_around.push_back(i);
			}
			counts.clusters_drawn += 1;
			counts.volumes_drawn += cluster.polygon_count;
		}
	}

	void upload()
	{
		const int width = m_gbuffer.width_px;
		const int height = m_gbuffer.height_px;
		const auto normals = mapped(m_gbuffer.normals, [](const glm::vec3& normal) { return glm::vec4(normal, 0.0F); });
		m_depths = std::make_unique<GlTexture>(width, height, 1, finiteDepths(m_gbuffer).data());
		m_normals = std::make_unique<GlTexture>(width, height, 4, &normals[0].x);
		m_volumes = std::make_unique<GlVolumes>(m_packed, m_picture->frame, m_options);
		const std::string head = m_options.storage_buffers ? "#version 430 core\n" : "#version 330 core\n";
		const std::string vertex = head + "#define NOOK_VERTEX\n" + (m_options.prisms ? "#define NOOK_PRISMS\n" : "") +
								   (m_options.choose_faces ? "#define NOOK_CHOOSE_FACES\n" : "");
		m_depth_program = aovProgram(fragmentProgram(kDepthPass));
		m_volume_program =
			aovProgram(linkedProgram({compiledShader(GL_VERTEX_SHADER, vertex + m_text),
									  compiledShader(GL_FRAGMENT_SHADER, head + "#define NOOK_FRAGMENT\n" + m_text)}));
		m_resolve_program = aovProgram(fragmentProgram(head + "#define NOOK_RESOLVE\n" + m_text));
		if (m_whole)
		{
			m_sparse_program = aovProgram(fragmentProgram(head + "#define NOOK_SPARSE\n" + m_text));
		}
		if (m_settings.mask)
		{
			drawHalfSpaces(head);
		}
		m_query = GlName(glGenQueries, glDeleteQueries);
		checkGlErrors();
	}

	void drawHalfSpaces(const std::string& head)
	{
		constexpr int kSide = 64; // nookHalfSpaces
		const int height = (m_settings.directions + 127) / 128 * kSide;
		m_half_spaces = targetOf(GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, kSide, height);
		const GlName frame = glFrameOf(std::array<unsigned, 1>{m_half_spaces}, 0);
		const GlName program = aovProgram(fragmentProgram(head + "#define NOOK_HALF_SPACES\n" + m_text));
		glUseProgram(program);
		glViewport(0, 0, kSide, height);
		m_volumes->bind();
		glDrawArrays(GL_TRIANGLES, 0, 3);
	}

	// Requires the depth test to be enabled.
	void drawVolumes(const AovPicture& picture)
	{
		picture.beginVolumes();
		glUseProgram(m_volume_program);
		glEnable(GL_DEPTH_CLAMP);
		glEnable(GL_CULL_FACE);
		glFrontFace(picture.frame.mirrored() ? GL_CW : GL_CCW);
		glEnable(m_settings.mask ? GL_COLOR_LOGIC_OP : GL_BLEND);
		glBlendFunc(GL_ONE, GL_ONE);
		glLogicOp(GL_OR);
		if (m_volumes->has_depth_bounds)
		{
			glEnable(GL_DEPTH_BOUNDS_TEST_EXT);
		}
		glBeginQuery(GL_SAMPLES_PASSED, m_query);
		glCullFace(GL_BACK);
		glDepthFunc(GL_LEQUAL);
		drawFaces(1, m_before);
		glCullFace(GL_FRONT);
		glDepthFunc(GL_GEQUAL);
		drawFaces(2, m_around);
		glEndQuery(GL_SAMPLES_PASSED);
		if (m_volumes->has_depth_bounds)
		{
			glDisable(GL_DEPTH_BOUNDS_TEST_EXT);
		}
		glDisable(GL_BLEND);
		glDisable(GL_COLOR_LOGIC_OP);
		glDisable(GL_CULL_FACE);
		glDisable(GL_DEPTH_CLAMP);
		glDisable(GL_DEPTH_TEST);
		counts.fragments += passed();
	}

	// Result of the last query.
	uint64_t passed() const
	{
		std::uint64_t passed = 0;
		glGetQueryObjectui64v(m_query, GL_QUERY_RESULT, &passed);
		return passed;
	}

	// Returns the number of pixels drawn.
	uint64_t resolve(const AovPicture& picture) const
	{
		picture.useResult();
		glUseProgram(m_resolve_program);
		glBeginQuery(GL_SAMPLES_PASSED, m_query);
		glDrawArrays(GL_TRIANGLES, 0, 3);
		glEndQuery(GL_SAMPLES_PASSED);
		return passed();
	}

	// Draws all pixels that the cells determine and sets their stencil to 1; the others still have 0.
	void reconstruct() const
	{
		m_whole->useResult();
		const int none = 0;
		glClearBufferiv(GL_STENCIL, 0, &none);
		glStencilFunc(GL_ALWAYS, 1, 255);
		glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
		glUseProgram(m_sparse_program);
		glDrawArrays(GL_TRIANGLES, 0, 3);
		glStencilFunc(GL_EQUAL, 0, 255);
		glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
	}

	// faces: 1 front, 2 back.
	void drawFaces(int faces, const std::vector<std::size_t>& clusters) const
	{
		if (m_options.choose_faces)
		{
			glUniform1i(glGetUniformLocation(m_volume_program, "nook_faces"), faces);
		}
		m_volumes->draw(clusters);
	}

	const GBuffer& m_gbuffer;
	AovSettings m_settings;
	AovGlOptions m_options;
	PackedVolumes m_packed;
	nook_volumes::Header m_header;
	std::string m_text;
	std::vector<std::size_t> m_before; // visible clusters drawn by their front faces: all, or without a choice per volume those
									   // that do not contain the eye
	std::vector<std::size_t> m_around; // visible clusters drawn by their back faces
	std::unique_ptr<GlTexture> m_depths, m_normals;
	std::unique_ptr<AovPicture> m_picture; // one pixel per cell
	std::unique_ptr<AovPicture> m_whole;   // all pixels, if that is a different picture
	std::unique_ptr<GlVolumes> m_volumes;
	GlName m_half_spaces; // masks: their table
	GlName m_depth_program, m_volume_program, m_resolve_program, m_sparse_program;
	GlName m_query;
};

} // namespace

AovShaded aovOnGl(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const DrawSettings& drawing,
				  const AovGlOptions& options)
{
	const GlContext context(GlApi::core, drawing.gl_device);
	refuseIf(options.storage_buffers && !context.hasCompute(),
			 "OpenGL: found no storage buffers in " + context.renderer() + ", expected OpenGL 4.3", ExitCode::unsupported);
	Drawer drawer(gbuffer, volumes, settings, options);
	const bool timer = !context.isSoftware();
	warmUp(context, drawing.repetitions, [&] { drawer.draw(timer); });
	const auto times = listOf(static_cast<std::size_t>(drawing.repetitions) + 1, [&](std::size_t) { return drawer.draw(timer); });
	AovShaded made{{drawer.visibility(), context.renderer(), 0.0, {}, {}}, drawer.counts};
	setTimes(made.shaded, times);
	return made;
}

AovShaded aovOnGl(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const DrawSettings& drawing)
{
	AovGlOptions options{.choose_faces = settings.choose_faces};
	return aovOnGl(gbuffer, volumes, settings, drawing, options);
}

} // namespace nook
