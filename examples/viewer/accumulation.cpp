// SPDX-License-Identifier: MIT
// This work is based on:
// D. Nehab, P. V. Sander, J. Lawrence, N. Tatarchuk, J. R. Isidoro, "Accelerating Real-Time Shading with Reverse Reprojection
// Caching", Graphics Hardware 2007: reads history where the surface was, and accepts it if the depth there matches the surface's.
#include "accumulation.h"

#include "gl.h"

#include <glm/gtc/type_ptr.hpp>

#include <cstddef>

namespace
{

constexpr const char* kFragment = R"(#version 330 core
uniform sampler2D visibilities; // of this frame
uniform sampler2D depths;
uniform sampler2D normals;
uniform sampler2D old_means;
uniform sampler2D old_depths;
uniform sampler2D old_normals;
uniform mat4 projection;
uniform mat4 old_projection;
uniform mat4 old_from_now; // view spaces
uniform bool reversed;
uniform bool checked;
uniform bool cut;
out vec2 mean; // visibility, and how many frames it is of

// A mean of so many frames, then weight 1/10 for the newest: what the tile was made for (nook tile --ema 0.1).
const float kMostFrames = 10.0;

// Where a texel's surface is in view space, for projections without a skew: perspective or parallel, infinite, reversed, jittered.
// Row 0 is at NDC y = -1; where yours is at 1, turn y here and in main().
vec3 positionOf(mat4 p, ivec2 texel, float device_depth)
{
	vec2 ndc = (vec2(texel) + 0.5) * 2.0 / vec2(textureSize(depths, 0)) - 1.0;
	float z_ndc = reversed ? device_depth : 2.0 * device_depth - 1.0;
	float z = (p[3][2] - z_ndc * p[3][3]) / (z_ndc * p[2][3] - p[2][2]);
	float w = p[2][3] * z + p[3][3];
	return vec3((ndc.x * w - p[2][0] * z - p[3][0]) / p[0][0], (ndc.y * w - p[2][1] * z - p[3][1]) / p[1][1], z);
}

// Does a texel of the frame before show the surface at `position` with normal n, in its view space? It does where it lies in the same
// plane and faces the same way. Depths by themselves differ too much where a floor is seen at a low angle. `most`: how far off the
// plane. Both tests are needed: of a groove narrower than a pixel the floor would take the wall's history for its own, and the wall
// nothing of the floor's, so that the groove darkens while the camera moves.
bool showsSurface(ivec2 texel, vec3 position, vec3 n, float most)
{
	vec3 there = positionOf(old_projection, texel, texelFetch(old_depths, texel, 0).r);
	bool beside = abs(dot(n, there - position)) <= most; // false for sky, too, which may be at infinity
	return beside && dot(n, texelFetch(old_normals, texel, 0).xyz) > 0.8;
}

void main()
{
	ivec2 pixel = ivec2(gl_FragCoord.xy);
	mean = vec2(texelFetch(visibilities, pixel, 0).r, 1.0);
	float device_depth = texelFetch(depths, pixel, 0).r;
	if (cut || device_depth == (reversed ? 0.0 : 1.0))
	{
		return;
	}
	// Where the pixel's surface was in the frame before.
	vec3 position = (old_from_now * vec4(positionOf(projection, pixel, device_depth), 1.0)).xyz;
	vec3 n = mat3(old_from_now) * texelFetch(normals, pixel, 0).xyz;
	vec4 clip = old_projection * vec4(position, 1.0);
	if (clip.w <= 0.0)
	{
		return;
	}
	ivec2 size = textureSize(depths, 0);
	vec2 at = (clip.xy / clip.w * 0.5 + 0.5) * vec2(size) - 0.5;
	ivec2 corner = ivec2(floor(at));
	vec2 share = at - vec2(corner);
	float texel_size = 2.0 * clip.w / (abs(old_projection[1][1]) * float(size.y)); // at that depth: round surfaces bend by less
	vec2 sum = vec2(0.0);
	float weights = 0.0;
	for (int i = 0; i < 4; ++i)
	{
		ivec2 offset = ivec2(i & 1, i >> 1);
		ivec2 texel = corner + offset;
		bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size));
		if (inside && (!checked || showsSurface(texel, position, n, texel_size)))
		{
			vec2 weight = mix(1.0 - share, share, vec2(offset));
			sum += weight.x * weight.y * texelFetch(old_means, texel, 0).rg;
			weights += weight.x * weight.y;
		}
	}
	if (weights < 0.25)
	{
		return; // just uncovered, or outside of the old picture
	}
	vec2 old = sum / weights;
	float frames = min(old.y + 1.0, kMostFrames);
	mean = vec2(mix(old.x, mean.x, 1.0 / frames), frames);
}
)";

} // namespace

Accumulation::Accumulation() : m_program(screenProgram(kFragment))
{
	glGenVertexArrays(1, &m_vertices);
}

void Accumulation::resize(int width, int height)
{
	m_width = width;
	m_height = height;
	for (std::size_t i = 0; i < m_means.size(); ++i)
	{
		glDeleteTextures(1, &m_means[i]);
		glDeleteFramebuffers(1, &m_targets[i]);
		m_means[i] = screenTexture(GL_RG16F, width, height); // 8 bits would get stuck 5/255 away from the mean
		m_targets[i] = frameOf(m_means[i]);
	}
	cut();
}

void Accumulation::cut()
{
	m_frame = 0;
}

int Accumulation::frame() const
{
	return m_frame;
}

unsigned Accumulation::draw(const Input& input)
{
	const auto matrix = [&](const char* name, const glm::mat4& value)
	{
		glUniformMatrix4fv(glGetUniformLocation(m_program, name), 1, GL_FALSE, glm::value_ptr(value));
	};
	const auto flag = [&](const char* name, bool value)
	{
		glUniform1i(glGetUniformLocation(m_program, name), value ? 1 : 0);
	};
	const std::size_t now = static_cast<std::size_t>(m_frame % 2);
	glBindFramebuffer(GL_FRAMEBUFFER, m_targets[now]);
	glViewport(0, 0, m_width, m_height);
	glDisable(GL_DEPTH_TEST);
	glBindVertexArray(m_vertices);
	glUseProgram(m_program);
	bindTexture(m_program, "visibilities", 0, input.visibility);
	bindTexture(m_program, "depths", 1, input.depth);
	bindTexture(m_program, "normals", 2, input.normals);
	bindTexture(m_program, "old_means", 3, m_means[1 - now]);
	bindTexture(m_program, "old_depths", 4, input.old_depth);
	bindTexture(m_program, "old_normals", 5, input.old_normals);
	matrix("projection", input.projection);
	matrix("old_projection", m_old_projection);
	matrix("old_from_now", m_old_camera_from_world * glm::inverse(input.camera_from_world));
	flag("reversed", input.reversed);
	flag("checked", input.checked);
	flag("cut", m_frame == 0);
	glDrawArrays(GL_TRIANGLES, 0, 3);
	m_old_camera_from_world = input.camera_from_world;
	m_old_projection = input.projection;
	m_frame = (m_frame + 1) % (1 << 30);
	return m_means[now];
}
