// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV), §5.
#include "core/error.h"
#include "shade/aov_gl_volumes.h"
#include "shade/block.h"
#include "shade/gl_context.h"
#include "shade/gl_parts.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <memory>

namespace nook
{
namespace
{

// Depth as a depth buffer holds it, from linear depth.
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

constexpr const char* kFullScreen = R"(#version 330 core
void main()
{
	gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

std::unique_ptr<GlTarget> sumTarget(AovTarget target, int width, int height)
{
	const unsigned stored = target == AovTarget::r16f ? GL_R16F : target == AovTarget::r8 ? GL_R8 : GL_R32F;
	return std::make_unique<GlTarget>(stored, GL_RED, GL_FLOAT, width, height);
}

// 32 bits a channel, as many channels as that takes.
std::unique_ptr<GlTarget> bitsTarget(int bits, int width, int height)
{
	const unsigned stored = bits <= 32 ? GL_R32UI : bits <= 64 ? GL_RG32UI : GL_RGBA32UI;
	const unsigned channels = bits <= 32 ? GL_RED_INTEGER : bits <= 64 ? GL_RG_INTEGER : GL_RGBA_INTEGER;
	return std::make_unique<GlTarget>(stored, channels, GL_UNSIGNED_INT, width, height);
}

// Medians of all but the first drawing, where there are more.
void setTimes(Shaded& shaded, std::vector<std::vector<PassTime>>& drawings)
{
	if (drawings.size() > 1)
	{
		drawings.erase(drawings.begin());
	}
	for (std::size_t pass = 0; pass < drawings.front().size(); ++pass)
	{
		std::vector<double> seconds;
		for (const std::vector<PassTime>& drawn : drawings)
		{
			seconds.push_back(drawn[pass].seconds);
		}
		const std::vector<double> in_order = seconds;
		std::sort(seconds.begin(), seconds.end());
		shaded.passes.push_back({drawings.front()[pass].name, seconds[seconds.size() / 2], in_order});
		shaded.seconds += shaded.passes.back().seconds;
	}
}

class Drawer
{
public:
	Drawer(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const AovGlOptions& options)
		: m_gbuffer(gbuffer), m_settings(settings), m_options(options), m_packed(packVolumes(volumes, {options.prisms}, {})),
		  m_camera(cameraOf(gbuffer, settings.every_px)), m_header(headerOf(volumes, settings.compensate)),
		  m_text(aovText({options.storage_buffers, settings.mask ? settings.directions : 0, false})),
		  m_columns((gbuffer.width_px + settings.every_px - 1) / settings.every_px),
		  m_rows((gbuffer.height_px + settings.every_px - 1) / settings.every_px)
	{
		// Volumes of clamped bounds are cut where they may still take light: front faces and back ones would differ in what is
		// lost.
		m_options.choose_faces = options.choose_faces && volumes.exact_bounds;
		m_header.plane_error = std::max(m_header.plane_error, m_packed.plane_error_m);
		const char* const problem = m_frame.set(m_header, m_camera);
		if (problem != nullptr)
		{
			throw Error(ExitCode::unsupported,
						std::string("camera: found ") + problem + ", expected x and y of the picture to depend on x and y alone");
		}
		choose(volumes);
		upload();
	}

	~Drawer()
	{
		glDeleteBuffers(1, &m_block);
		glDeleteQueries(1, &m_query);
	}
	Drawer(const Drawer&) = delete;
	Drawer& operator=(const Drawer&) = delete;

	std::vector<PassTime> draw(bool timer)
	{
		glViewport(0, 0, m_columns, m_rows);
		glBindBufferBase(GL_UNIFORM_BUFFER, 0, m_block);
		m_volumes->bind();
		bindTexture(3, m_depths->name());
		bindTexture(4, m_normals->name());
		bindTexture(5, m_sums[0]->name());
		bindTexture(6, m_sums.back()->name());
		bindTexture(7, m_result->name());
		std::vector<PassTime> times;
		times.push_back({"depth", secondsOf([this] { drawDepth(); }, timer)});
		times.push_back({"volumes", secondsOf([this] { drawVolumes(); }, timer)});
		times.push_back({"resolve", secondsOf([this] { fill(*m_result_frame, *m_resolve_program); }, timer)});
		if (m_whole)
		{
			glViewport(0, 0, m_gbuffer.width_px, m_gbuffer.height_px);
			times.push_back({"reconstruction", secondsOf([this] { fill(*m_whole_frame, *m_sparse_program); }, timer)});
		}
		return times;
	}

	std::vector<float> visibility() const
	{
		return readScalar(m_whole ? *m_whole : *m_result);
	}

	AovCounts counts() const
	{
		return m_counts;
	}

private:
	static void bindTexture(unsigned unit, unsigned name)
	{
		glActiveTexture(GL_TEXTURE0 + unit);
		glBindTexture(GL_TEXTURE_2D, name);
	}

	void choose(const VolumeSet& volumes)
	{
		m_counts.volumes = volumes.occluders.polygons.size();
		for (std::size_t i = 0; i < m_packed.clusters.size(); ++i)
		{
			const nook_volumes::Cluster& cluster = m_packed.clusters[i];
			if (m_settings.cull && !m_frame.inSight(cluster))
			{
				continue;
			}
			const bool around = m_options.back_faces || m_frame.holdsEye(cluster);
			if (m_options.choose_faces || !around)
			{
				m_before.push_back(i);
			}
			if (m_options.choose_faces || around)
			{
				m_around.push_back(i);
			}
			m_counts.clusters_drawn += 1;
			m_counts.volumes_drawn += cluster.polygon_count;
		}
	}

	void upload()
	{
		const int width = m_gbuffer.width_px;
		const int height = m_gbuffer.height_px;
		std::vector<glm::vec4> normals(m_gbuffer.normals.size());
		for (std::size_t i = 0; i < normals.size(); ++i)
		{
			normals[i] = glm::vec4(m_gbuffer.normals[i], 0.0F);
		}
		m_depths = std::make_unique<GlTexture>(width, height, 1, finiteDepths(m_gbuffer).data());
		m_normals = std::make_unique<GlTexture>(width, height, 4, &normals[0].x);
		m_hardware = std::make_unique<GlTarget>(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, m_columns, m_rows);
		std::vector<unsigned> sums;
		for (int first = 0; first < (m_settings.mask ? m_settings.directions : 1); first += 128)
		{
			m_sums.push_back(m_settings.mask ? bitsTarget(first > 0 ? 128 : m_settings.directions, m_columns, m_rows)
											 : sumTarget(m_settings.target, m_columns, m_rows));
			sums.push_back(m_sums.back()->name());
		}
		m_result = std::make_unique<GlTexture>(PictureShape{PictureFormat::scalar, m_columns, m_rows});
		m_volume_frame = std::make_unique<GlFrame>(sums, m_hardware->name());
		if (m_settings.every_px > 1)
		{
			m_whole = std::make_unique<GlTexture>(PictureShape{PictureFormat::scalar, width, height});
			m_whole_frame = std::make_unique<GlFrame>(std::array{m_whole->name()}, 0U);
		}
		m_result_frame = std::make_unique<GlFrame>(std::array{m_result->name()}, 0U);
		m_volumes = std::make_unique<GlVolumes>(m_packed, m_frame, m_options);
		const std::string head = m_options.storage_buffers ? "#version 430 core\n" : "#version 330 core\n";
		const std::string vertex = head + "#define NOOK_VERTEX\n" + (m_options.prisms ? "#define NOOK_PRISMS\n" : "") +
								   (m_options.choose_faces ? "#define NOOK_CHOOSE_FACES\n" : "");
		m_depth_program = std::make_unique<GlProgram>(kFullScreen, kDepthPass);
		m_volume_program = std::make_unique<GlProgram>(vertex + m_text, head + "#define NOOK_FRAGMENT\n" + m_text);
		m_resolve_program = std::make_unique<GlProgram>(kFullScreen, head + "#define NOOK_RESOLVE\n" + m_text);
		if (m_whole)
		{
			m_sparse_program = std::make_unique<GlProgram>(kFullScreen, head + "#define NOOK_SPARSE\n" + m_text);
		}
		glGenBuffers(1, &m_block);
		glBindBuffer(GL_UNIFORM_BUFFER, m_block);
		glBufferData(GL_UNIFORM_BUFFER, sizeof m_frame.block, &m_frame.block, GL_STATIC_DRAW);
		glGenQueries(1, &m_query);
		checkGlErrors();
	}

	void drawDepth() const
	{
		const double* const p = m_camera.projection;
		m_volume_frame->use();
		glUseProgram(m_depth_program->name());
		glUniform4f(glGetUniformLocation(m_depth_program->name(), "nook_z"), static_cast<float>(-p[10]), static_cast<float>(p[14]),
					static_cast<float>(-p[11]), static_cast<float>(p[15]));
		glUniform1i(glGetUniformLocation(m_depth_program->name(), "nook_every"), m_settings.every_px);
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

	void drawVolumes()
	{
		m_volume_frame->use();
		const std::array<float, 4> none{};
		const std::array<unsigned, 4> no_bits{};
		for (std::size_t i = 0; i < m_sums.size(); ++i)
		{
			if (m_settings.mask)
			{
				glClearBufferuiv(GL_COLOR, static_cast<int>(i), no_bits.data());
				continue;
			}
			glClearBufferfv(GL_COLOR, static_cast<int>(i), none.data());
		}
		glUseProgram(m_volume_program->name());
		glEnable(GL_DEPTH_CLAMP);
		glEnable(GL_CULL_FACE);
		glFrontFace(m_frame.mirrored() ? GL_CW : GL_CCW);
		glEnable(m_settings.mask ? GL_COLOR_LOGIC_OP : GL_BLEND);
		glBlendFunc(GL_ONE, GL_ONE);
		glLogicOp(GL_OR);
		if (m_volumes->hasDepthBounds())
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
		if (m_volumes->hasDepthBounds())
		{
			glDisable(GL_DEPTH_BOUNDS_TEST_EXT);
		}
		glDisable(GL_BLEND);
		glDisable(GL_COLOR_LOGIC_OP);
		glDisable(GL_CULL_FACE);
		glDisable(GL_DEPTH_CLAMP);
		glDisable(GL_DEPTH_TEST);
		std::uint64_t passed = 0;
		glGetQueryObjectui64v(m_query, GL_QUERY_RESULT, &passed);
		m_counts.fragments = passed;
	}

	// faces: 1 front, 2 back.
	void drawFaces(int faces, const std::vector<std::size_t>& clusters) const
	{
		if (m_options.choose_faces)
		{
			glUniform1i(glGetUniformLocation(m_volume_program->name(), "nook_faces"), faces);
		}
		m_volumes->draw(clusters);
	}

	static void fill(const GlFrame& frame, const GlProgram& program)
	{
		frame.use();
		glUseProgram(program.name());
		glDrawArrays(GL_TRIANGLES, 0, 3);
	}

	const GBuffer& m_gbuffer;
	AovSettings m_settings;
	AovGlOptions m_options;
	PackedVolumes m_packed;
	nook_volumes::Camera m_camera;
	nook_volumes::Header m_header;
	std::string m_text;
	nook_volumes::Frame m_frame;
	std::vector<std::size_t> m_before; // clusters in sight that are drawn by their front faces: where these are not chosen for each
									   // volume, those that do not hold the eye
	std::vector<std::size_t> m_around; // by their back ones
	int m_columns;                     // of the picture that volumes are drawn into
	int m_rows;
	std::unique_ptr<GlTexture> m_depths, m_normals;
	std::unique_ptr<GlTexture> m_result, m_whole; // of the pixels that are drawn, and of all where that is another one
	std::unique_ptr<GlTarget> m_hardware;
	std::vector<std::unique_ptr<GlTarget>> m_sums;
	std::unique_ptr<GlFrame> m_volume_frame, m_result_frame, m_whole_frame;
	std::unique_ptr<GlVolumes> m_volumes;
	std::unique_ptr<GlProgram> m_depth_program, m_volume_program, m_resolve_program, m_sparse_program;
	unsigned m_block = 0;
	unsigned m_query = 0;
	AovCounts m_counts;
};

} // namespace

AovShaded aovOnGl(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const DrawSettings& drawing,
				  const AovGlOptions& options)
{
	const GlContext context(GlApi::core, drawing.gl_device);
	if (options.storage_buffers && !context.hasCompute())
	{
		throw Error(ExitCode::unsupported, "OpenGL: found no storage buffers in " + context.renderer() + ", expected OpenGL 4.3");
	}
	Drawer drawer(gbuffer, volumes, settings, options);
	std::vector<std::vector<PassTime>> times;
	for (int repetition = 0; repetition <= drawing.repetitions; ++repetition)
	{
		times.push_back(drawer.draw(!context.isSoftware()));
	}
	AovShaded made{{drawer.visibility(), context.renderer(), 0.0, {}, {}}, drawer.counts()};
	setTimes(made.shaded, times);
	return made;
}

AovShaded aovOnGl(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const DrawSettings& drawing)
{
	AovGlOptions options;
	options.choose_faces = settings.choose_faces;
	return aovOnGl(gbuffer, volumes, settings, drawing, options);
}

} // namespace nook
