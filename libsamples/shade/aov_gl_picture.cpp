// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/aov_gl_picture.h"

#include "core/error.h"

#include <epoxy/gl.h>

#include <array>

namespace nook
{

const char* const kFullScreen = R"(#version 330 core
void main()
{
	gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

namespace
{

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

} // namespace

void bindTexture(unsigned unit, unsigned name)
{
	glActiveTexture(GL_TEXTURE0 + unit);
	glBindTexture(GL_TEXTURE_2D, name);
}

std::unique_ptr<GlProgram> aovDepthProgram()
{
	return std::make_unique<GlProgram>(kFullScreen, kDepthPass);
}

AovPicture::AovPicture(const GBuffer& gbuffer, const nook_volumes::Header& header, const AovSettings& settings, int every_px)
	: m_mask(settings.mask), m_every_px(every_px), m_columns((gbuffer.width_px + every_px - 1) / every_px),
	  m_rows((gbuffer.height_px + every_px - 1) / every_px), m_camera(cameraOf(gbuffer, every_px))
{
	const char* const problem = m_frame.set(header, m_camera);
	if (problem != nullptr)
	{
		throw Error(ExitCode::unsupported,
					std::string("camera: found ") + problem + ", expected a right-handed one, column by column, without a skew");
	}
	m_depth_stencil =
		std::make_unique<GlTarget>(GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, m_columns, m_rows);
	std::vector<unsigned> sums;
	for (int first = 0; first < (settings.mask ? settings.directions : 1); first += 128)
	{
		// Beyond 128 there are two targets, the second with all four channels: what it does not need stays 0.
		m_sums.push_back(settings.mask ? bitsTarget(first > 0 ? 128 : settings.directions, m_columns, m_rows)
									   : sumTarget(settings.target, m_columns, m_rows));
		sums.push_back(m_sums.back()->name());
	}
	m_result = std::make_unique<GlTexture>(PictureShape{PictureFormat::scalar, m_columns, m_rows});
	m_volume_frame = std::make_unique<GlFrame>(sums, m_depth_stencil->name());
	m_result_frame = std::make_unique<GlFrame>(std::array{m_result->name()}, m_depth_stencil->name());
	glGenBuffers(1, &m_block);
	glBindBuffer(GL_UNIFORM_BUFFER, m_block);
	glBufferData(GL_UNIFORM_BUFFER, sizeof m_frame.block, &m_frame.block, GL_STATIC_DRAW);
}

AovPicture::~AovPicture()
{
	glDeleteBuffers(1, &m_block);
}

void AovPicture::bind() const
{
	glBindBufferBase(GL_UNIFORM_BUFFER, 0, m_block);
	bindTexture(5, m_sums[0]->name());
	bindTexture(6, m_sums.back()->name());
	bindTexture(7, m_result->name());
}

void AovPicture::drawDepth(const GlProgram& program) const
{
	const double* const p = m_camera.projection;
	m_volume_frame->use();
	glViewport(0, 0, m_columns, m_rows);
	glUseProgram(program.name());
	glUniform4f(glGetUniformLocation(program.name(), "nook_z"), static_cast<float>(-p[10]), static_cast<float>(p[14]),
				static_cast<float>(-p[11]), static_cast<float>(p[15]));
	glUniform1i(glGetUniformLocation(program.name(), "nook_every"), m_every_px);
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

void AovPicture::beginVolumes() const
{
	m_volume_frame->use();
	glViewport(0, 0, m_columns, m_rows);
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

void AovPicture::useResult() const
{
	m_result_frame->use();
	glViewport(0, 0, m_columns, m_rows);
}

} // namespace nook
