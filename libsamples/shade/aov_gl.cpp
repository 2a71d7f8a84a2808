// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV), §5.
#include "core/error.h"
#include "methods/block.h"
#include "shade/aov_gl_picture.h"
#include "shade/aov_gl_volumes.h"
#include "shade/gl_context.h"
#include "shade/gl_parts.h"
#include "shade/pass_times.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <memory>

namespace nook
{
namespace
{

void setTimes(Shaded& shaded, const std::vector<std::vector<PassTime>>& drawings)
{
	for (std::size_t pass = 0; pass < drawings.front().size(); ++pass)
	{
		std::vector<double> seconds;
		for (const std::vector<PassTime>& drawn : drawings)
		{
			seconds.push_back(drawn[pass].seconds);
		}
		shaded.passes.push_back(passTimeOf(drawings.front()[pass].name, seconds));
		shaded.seconds += shaded.passes.back().seconds;
	}
}

class Drawer
{
public:
	Drawer(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const AovGlOptions& options)
		: m_gbuffer(gbuffer), m_settings(settings), m_options(options), m_packed(packVolumes(volumes, {options.prisms}, {})),
		  m_header(headerOf(volumes, settings.compensate)),
		  m_text(aovText({options.storage_buffers, settings.mask ? settings.directions : 0, false}))
	{
		// Volumes of clamped bounds are cut where they may still take light: front faces and back ones would differ in what is
		// lost.
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

	~Drawer()
	{
		glDeleteQueries(1, &m_query);
	}
	Drawer(const Drawer&) = delete;
	Drawer& operator=(const Drawer&) = delete;

	std::vector<PassTime> draw(bool timer)
	{
		m_volumes->bind();
		bindTexture(3, m_depths->name());
		bindTexture(4, m_normals->name());
		m_picture->bind();
		m_counts.fragments = 0;
		std::vector<PassTime> times;
		times.push_back({"depth", secondsOf([this] { m_picture->drawDepth(*m_depth_program); }, timer)});
		times.push_back({"volumes", secondsOf([this] { drawVolumes(*m_picture); }, timer)});
		times.push_back({"resolve", secondsOf([this] { resolve(*m_picture); }, timer)});
		if (m_whole)
		{
			glEnable(GL_STENCIL_TEST);
			times.push_back({"reconstruction", secondsOf([this] { reconstruct(); }, timer)});
			m_whole->bind();
			times.push_back({"depth, pixels alone", secondsOf([this] { m_whole->drawDepth(*m_depth_program); }, timer)});
			times.push_back({"volumes, pixels alone", secondsOf([this] { drawVolumes(*m_whole); }, timer)});
			times.push_back({"resolve, pixels alone", secondsOf([this] { m_counts.pixels_alone = resolve(*m_whole); }, timer)});
			glDisable(GL_STENCIL_TEST);
		}
		return times;
	}

	std::vector<float> visibility() const
	{
		return readScalar((m_whole ? m_whole : m_picture)->result());
	}

	AovCounts counts() const
	{
		return m_counts;
	}

private:
	void choose(const VolumeSet& volumes)
	{
		m_counts.volumes = volumes.occluders.polygons.size();
		for (std::size_t i = 0; i < m_packed.clusters.size(); ++i)
		{
			const nook_volumes::Cluster& cluster = m_packed.clusters[i];
			if (m_settings.cull && !m_picture->frame().inSight(cluster))
			{
				continue;
			}
			const bool around = m_options.back_faces || m_picture->frame().holdsEye(cluster);
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
		m_volumes = std::make_unique<GlVolumes>(m_packed, m_picture->frame(), m_options);
		const std::string head = m_options.storage_buffers ? "#version 430 core\n" : "#version 330 core\n";
		const std::string vertex = head + "#define NOOK_VERTEX\n" + (m_options.prisms ? "#define NOOK_PRISMS\n" : "") +
								   (m_options.choose_faces ? "#define NOOK_CHOOSE_FACES\n" : "");
		m_depth_program = aovDepthProgram();
		m_volume_program = std::make_unique<GlProgram>(vertex + m_text, head + "#define NOOK_FRAGMENT\n" + m_text);
		m_resolve_program = std::make_unique<GlProgram>(kFullScreen, head + "#define NOOK_RESOLVE\n" + m_text);
		if (m_whole)
		{
			m_sparse_program = std::make_unique<GlProgram>(kFullScreen, head + "#define NOOK_SPARSE\n" + m_text);
		}
		glGenQueries(1, &m_query);
		checkGlErrors();
	}

	// With the depth test on.
	void drawVolumes(const AovPicture& picture)
	{
		picture.beginVolumes();
		glUseProgram(m_volume_program->name());
		glEnable(GL_DEPTH_CLAMP);
		glEnable(GL_CULL_FACE);
		glFrontFace(picture.frame().mirrored() ? GL_CW : GL_CCW);
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
		m_counts.fragments += passed();
	}

	// Of the last query.
	uint64_t passed() const
	{
		std::uint64_t passed = 0;
		glGetQueryObjectui64v(m_query, GL_QUERY_RESULT, &passed);
		return passed;
	}

	// → pixels that it drew.
	uint64_t resolve(const AovPicture& picture) const
	{
		picture.useResult();
		glUseProgram(m_resolve_program->name());
		glBeginQuery(GL_SAMPLES_PASSED, m_query);
		glDrawArrays(GL_TRIANGLES, 0, 3);
		glEndQuery(GL_SAMPLES_PASSED);
		return passed();
	}

	// All pixels that the cells tell; their stencil is 1, and the others are left to draw where it is 0.
	void reconstruct() const
	{
		m_whole->useResult();
		const int none = 0;
		glClearBufferiv(GL_STENCIL, 0, &none);
		glStencilFunc(GL_ALWAYS, 1, 255);
		glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
		glUseProgram(m_sparse_program->name());
		glDrawArrays(GL_TRIANGLES, 0, 3);
		glStencilFunc(GL_EQUAL, 0, 255);
		glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
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

	const GBuffer& m_gbuffer;
	AovSettings m_settings;
	AovGlOptions m_options;
	PackedVolumes m_packed;
	nook_volumes::Header m_header;
	std::string m_text;
	std::vector<std::size_t> m_before; // clusters in sight that are drawn by their front faces: where these are not chosen for each
									   // volume, those that do not hold the eye
	std::vector<std::size_t> m_around; // by their back ones
	std::unique_ptr<GlTexture> m_depths, m_normals;
	std::unique_ptr<AovPicture> m_picture; // of the cells
	std::unique_ptr<AovPicture> m_whole;   // of all pixels, where that is another one
	std::unique_ptr<GlVolumes> m_volumes;
	std::unique_ptr<GlProgram> m_depth_program, m_volume_program, m_resolve_program, m_sparse_program;
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
