// SPDX-License-Identifier: MIT
#include "scene.h"

#include "gl.h"

#include <glm/gtc/type_ptr.hpp>

#include <cmath>
#include <cstddef>
#include <utility>

namespace
{

constexpr const char* kLevelVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec2 baked;
uniform mat4 camera_from_world;
uniform mat4 projection;
out vec3 view_position;
out vec3 view_normal;
out vec2 mask_uv;
out vec2 sides;

void main()
{
	view_position = (camera_from_world * vec4(position, 1.0)).xyz;
	view_normal = mat3(camera_from_world) * normal;
	mask_uv = uv;
	sides = baked;
	gl_Position = projection * vec4(view_position, 1.0);
}
)";

// Surfaces are two-sided. Without normals in the level, uses those of the triangles.
constexpr const char* kLevelFragment = R"(#version 330 core
in vec3 view_position;
in vec3 view_normal;
in vec2 mask_uv;
uniform sampler2D mask;
uniform vec2 alpha; // factor and cut-off
uniform float moves;
in vec2 sides;
layout(location = 0) out vec4 normal;
layout(location = 1) out vec2 known; // of the side that is seen, and whether it moves

void main()
{
	if (texture(mask, mask_uv).r * alpha.x < alpha.y)
	{
		discard;
	}
	vec3 flat_normal = cross(dFdx(view_position), dFdy(view_position)); // faces the camera
	vec3 n = normalize(dot(view_normal, view_normal) > 0.0 ? view_normal : flat_normal);
	normal = vec4(dot(n, flat_normal) < 0.0 ? -n : n, 0.0);
	known = vec2(gl_FrontFacing ? sides.x : sides.y, moves);
}
)";

// Known occlusion of static surfaces, darkened by the method only as far as moving objects change the method's result. Both of the
// method's pictures use the same samples, so they cancel where nothing moves.
constexpr const char* kKnownFragment = R"(#version 330 core
uniform sampler2D bakes;
uniform sampler2D volumes;
uniform sampler2D screens;
uniform sampler2D stills;
uniform int baked; // 0: nothing, 1: visibility, 2: what is added to that of volumes
uniform bool moves;
out float visibility;

void main()
{
	ivec2 pixel = ivec2(gl_FragCoord.xy);
	vec2 bake = texelFetch(bakes, pixel, 0).rg;
	float by_volumes = baked == 1 ? 1.0 : texelFetch(volumes, pixel, 0).r;
	float known = baked == 1 ? bake.r : baked == 2 ? clamp(by_volumes + bake.r, 0.0, 1.0) : by_volumes;
	float screen = moves ? texelFetch(screens, pixel, 0).r : 1.0;
	float still = moves ? texelFetch(stills, pixel, 0).r : 1.0;
	visibility = bake.g > 0.5 ? min(screen, by_volumes) : known * (screen < still ? screen / still : 1.0);
}
)";

constexpr const char* kShowFragment = R"(#version 330 core
uniform sampler2D visibilities;
uniform sampler2D static_visibilities; // the same ones where there are no others
uniform sampler2D differing; // of half resolution
uniform sampler2D ages; // in the second component; none without a mean over frames
uniform sampler2D depths;
uniform sampler2D normals;
uniform vec3 to_light; // in view space
uniform float cleared;
uniform int show;
out vec4 color;

void main()
{
	ivec2 pixel = ivec2(gl_FragCoord.xy);
	float visibility = min(texelFetch(visibilities, pixel, 0).r, texelFetch(static_visibilities, pixel, 0).r);
	float depth = texelFetch(depths, pixel, 0).r;
	vec3 n = texelFetch(normals, pixel, 0).xyz;
	bool sky = depth == cleared;
	vec3 ambient = vec3(0.33, 0.36, 0.42) * visibility;
	vec3 direct = vec3(0.45, 0.42, 0.36) * max(dot(n, to_light), 0.0);
	color.rgb = sky ? vec3(0.60, 0.75, 0.95) : pow(ambient + direct, vec3(1.0 / 2.2));
	if (show == 1)
	{
		color.rgb = vec3(visibility);
	}
	else if (show == 2)
	{
		color.rgb = vec3(pow(abs(cleared - depth), 0.3));
	}
	else if (show == 3)
	{
		color.rgb = sky ? vec3(0.0) : n * 0.5 + 0.5;
	}
	else if (show == 4)
	{
		color.rgb = vec3(0.5 + 2.0 * (texelFetch(differing, pixel, 0).r - visibility));
	}
	else if (show == 5)
	{
		color.rgb = vec3(texelFetch(ages, pixel, 0).g * 0.1);
	}
	color.a = 1.0;
}
)";

// Clip space x and y as in OpenGL; z_ndc from −1 to 1, or reversed from 1 to 0.
glm::mat4 projectionOf(const Camera& camera, float aspect, bool reversed)
{
	const float n = camera.near_m;
	const float f = camera.far_m;
	const bool endless = std::isinf(f);
	glm::mat4 p(0.0f);
	p[1][1] = camera.orthographic ? 1.0f / camera.half_height_m : 1.0f / std::tan(0.5f * camera.fov_y_rad);
	p[0][0] = p[1][1] / aspect;
	if (camera.orthographic)
	{
		p[2][2] = (reversed ? 1.0f : -2.0f) / (f - n);
		p[3][2] = (reversed ? f : -(f + n)) / (f - n);
		p[3][3] = 1.0f;
		return p;
	}
	p[2][3] = -1.0f;
	p[2][2] = reversed ? (endless ? 0.0f : n / (f - n)) : (endless ? -1.0f : -(f + n) / (f - n));
	p[3][2] = reversed ? (endless ? n : f * n / (f - n)) : (endless ? -2.0f * n : -2.0f * f * n / (f - n));
	return p;
}

unsigned maskTexture(const Mask& mask)
{
	unsigned texture = 0;
	glGenTextures(1, &texture);
	glBindTexture(GL_TEXTURE_2D, texture);
	glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, mask.width, mask.height, 0, GL_RED, GL_UNSIGNED_BYTE, mask.alpha.data());
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, mask.wrap_u);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, mask.wrap_v);
	return texture;
}

} // namespace

Scene::Scene(const LevelFile& level, const std::string& volumes)
	: m_batches(level.batches), m_level_baked(level.baked), m_static(volumes)
{
	m_level_program = programOf(kLevelVertex, kLevelFragment);
	m_show_program = screenProgram(kShowFragment);
	m_known_program = screenProgram(kKnownFragment);
	for (const Mask& mask : level.masks)
	{
		m_masks.push_back(maskTexture(mask));
	}
	m_masks.push_back(maskTexture({1, 1, GL_REPEAT, GL_REPEAT, {255}})); // for batches without a mask
	glGenVertexArrays(1, &m_vertices);
	glBindVertexArray(m_vertices);
	unsigned buffers[2] = {};
	glGenBuffers(2, buffers);
	glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
	glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(level.vertices.size() * sizeof(Vertex)), level.vertices.data(),
				 GL_STATIC_DRAW);
	glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
	glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(level.indices.size() * sizeof(std::uint32_t)),
				 level.indices.data(), GL_STATIC_DRAW);
	const std::size_t offsets[4] = {offsetof(Vertex, position), offsetof(Vertex, normal), offsetof(Vertex, uv),
									offsetof(Vertex, baked)};
	for (unsigned i = 0; i < 4; ++i)
	{
		glEnableVertexAttribArray(i);
		glVertexAttribPointer(i, i < 2 ? 3 : 2, GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<const void*>(offsets[i]));
	}
}

void Scene::resize(int width, int height)
{
	if (width == m_width && height == m_height)
	{
		return;
	}
	m_width = width;
	m_height = height;
	for (unsigned* const texture : {&m_depth, &m_old_depth, &m_normals, &m_old_normals, &m_picture, &m_baked, &m_fixed, &m_known})
	{
		glDeleteTextures(1, texture);
	}
	for (unsigned* const frame : {&m_level_frame, &m_old_level_frame, &m_picture_frame, &m_known_frame})
	{
		glDeleteFramebuffers(1, frame);
	}
	m_depth = screenTexture(GL_DEPTH_COMPONENT32F, width, height);
	m_old_depth = screenTexture(GL_DEPTH_COMPONENT32F, width, height);
	m_normals = screenTexture(GL_RGBA16F, width, height);
	m_old_normals = screenTexture(GL_RGBA16F, width, height);
	m_picture = screenTexture(GL_RGBA8, width, height);
	m_baked = screenTexture(GL_RG16F, width, height);
	m_fixed = screenTexture(GL_R8, width, height);
	m_known = screenTexture(GL_R8, width, height);
	m_level_frame = frameOf(m_normals, m_depth);
	m_old_level_frame = frameOf(m_old_normals, m_old_depth);
	for (const unsigned frame : {m_level_frame, m_old_level_frame})
	{
		const unsigned both[2] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
		glBindFramebuffer(GL_FRAMEBUFFER, frame);
		glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, m_baked, 0);
		glDrawBuffers(2, both);
	}
	m_known_frame = frameOf(m_known);
	m_picture_frame = frameOf(m_picture);
	m_obscurance.resize(width, height);
	m_accumulation.resize(width, height);
	m_static.resize(width, height);
}

void Scene::draw(const Camera& camera, const Settings& settings)
{
	const glm::mat4 camera_from_world = glm::inverse(camera.world_from_camera);
	const float aspect = static_cast<float>(m_width) / static_cast<float>(m_height);
	const glm::mat4 projection = projectionOf(camera, aspect, settings.reversed);
	std::swap(m_depth, m_old_depth);
	std::swap(m_normals, m_old_normals);
	std::swap(m_level_frame, m_old_level_frame);
	const bool accumulates = settings.accumulates();
	if (!accumulates)
	{
		cut();
	}
	const int frame = settings.still_tile ? 0 : m_accumulation.frame();
	const Obscurance::Input input{m_depth, m_normals, settings.reversed, projection, settings.radius_m, frame};
	const Obscurance::Method& method = Obscurance::methods()[settings.method];
	const bool moves = settings.occluder == Occluder::moves && settings.show != Show::difference;
	begin(camera_from_world, projection, settings.reversed);
	drawTriangles(false);
	if (moves) // static geometry comes first, so the depth is its own
	{
		keepStatic(m_obscurance.draw(method, input, settings.half));
	}
	drawTriangles(true);
	unsigned visibility = m_obscurance.draw(method, input, settings.half);
	unsigned differing = visibility;
	if (settings.show == Show::difference)
	{
		(settings.half ? visibility : differing) = m_obscurance.draw(method, input, !settings.half);
	}

	unsigned volumes = visibility; // fallback without volumes
	const bool draws_volumes = settings.occluder == Occluder::both || settings.occluder == Occluder::volumes ||
							   (settings.occluder != Occluder::screen && m_level_baked != Baked::visibility);
	if (draws_volumes && settings.show != Show::difference)
	{
		volumes = m_static.draw({m_depth, m_level_frame, m_normals, settings.reversed, camera_from_world, projection});
	}
	if ((settings.occluder == Occluder::bake || settings.occluder == Occluder::moves) && settings.show != Show::difference)
	{
		visibility = volumes = known(settings.occluder, volumes, visibility, m_fixed);
	}

	unsigned ages = 0;
	if (accumulates)
	{
		const bool checked = settings.accumulate == Accumulate::on;
		visibility = m_accumulation.draw({visibility, m_depth, m_old_depth, m_normals, m_old_normals, settings.reversed, checked,
										  camera_from_world, projection});
		ages = visibility;
	}

	const bool both = settings.occluder == Occluder::both && settings.show != Show::difference;
	visibility = settings.occluder == Occluder::volumes && settings.show != Show::difference ? volumes : visibility;
	const unsigned static_visibility = both ? volumes : visibility;

	glBindFramebuffer(GL_FRAMEBUFFER, m_picture_frame);
	glUseProgram(m_show_program);
	bindTexture(m_show_program, "static_visibilities", 4, static_visibility);
	bindTexture(m_show_program, "visibilities", 0, visibility);
	bindTexture(m_show_program, "depths", 1, m_depth);
	bindTexture(m_show_program, "normals", 2, m_normals);
	bindTexture(m_show_program, "differing", 3, differing);
	bindTexture(m_show_program, "ages", 5, ages);
	const glm::vec3 to_light = glm::mat3(camera_from_world) * glm::normalize(glm::vec3(0.5f, 0.8f, 0.3f));
	glUniform3fv(glGetUniformLocation(m_show_program, "to_light"), 1, glm::value_ptr(to_light));
	glUniform1f(glGetUniformLocation(m_show_program, "cleared"), settings.reversed ? 0.0f : 1.0f);
	glUniform1i(glGetUniformLocation(m_show_program, "show"), static_cast<int>(settings.show));
	glDrawArrays(GL_TRIANGLES, 0, 3);
	if (const unsigned error = glGetError(); error != GL_NO_ERROR)
	{
		throw Failure(4, "OpenGL: found error " + std::to_string(error));
	}
}

void Scene::cut()
{
	m_accumulation.cut();
}

// The method's next picture would overwrite this one.
void Scene::keepStatic(unsigned visibility)
{
	const unsigned frame = frameOf(visibility);
	glBindTexture(GL_TEXTURE_2D, m_fixed);
	glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, m_width, m_height);
	glDeleteFramebuffers(1, &frame);
}

unsigned Scene::known(Occluder occluder, unsigned volumes, unsigned screen, unsigned still)
{
	glBindFramebuffer(GL_FRAMEBUFFER, m_known_frame);
	glUseProgram(m_known_program);
	bindTexture(m_known_program, "bakes", 0, m_baked);
	bindTexture(m_known_program, "volumes", 1, volumes);
	bindTexture(m_known_program, "screens", 2, screen);
	bindTexture(m_known_program, "stills", 3, still);
	glUniform1i(glGetUniformLocation(m_known_program, "baked"), static_cast<int>(m_level_baked));
	glUniform1i(glGetUniformLocation(m_known_program, "moves"), occluder == Occluder::moves ? 1 : 0);
	glDrawArrays(GL_TRIANGLES, 0, 3);
	return m_known;
}

void Scene::begin(const glm::mat4& camera_from_world, const glm::mat4& projection, bool reversed)
{
	if (epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_ARB_clip_control"))
	{
		glClipControl(GL_LOWER_LEFT, reversed ? GL_ZERO_TO_ONE : GL_NEGATIVE_ONE_TO_ONE);
	}
	else if (reversed)
	{
		throw Failure(5, "OpenGL: found no glClipControl, which reversed depth needs");
	}
	glBindFramebuffer(GL_FRAMEBUFFER, m_level_frame);
	glViewport(0, 0, m_width, m_height);
	glDepthFunc(reversed ? GL_GREATER : GL_LESS);
	glClearDepth(reversed ? 0.0 : 1.0);
	glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
	glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
	const float open[4] = {m_level_baked == Baked::difference ? 0.0f : 1.0f, 0.0f, 0.0f, 0.0f}; // sky
	glClearBufferfv(GL_COLOR, 1, open);
	glUseProgram(m_level_program);
	glUniformMatrix4fv(glGetUniformLocation(m_level_program, "camera_from_world"), 1, GL_FALSE, glm::value_ptr(camera_from_world));
	glUniformMatrix4fv(glGetUniformLocation(m_level_program, "projection"), 1, GL_FALSE, glm::value_ptr(projection));
}

void Scene::drawTriangles(bool moving)
{
	glBindFramebuffer(GL_FRAMEBUFFER, m_level_frame);
	glViewport(0, 0, m_width, m_height);
	glEnable(GL_DEPTH_TEST);
	glFrontFace(GL_CCW);
	glUseProgram(m_level_program);
	glUniform1f(glGetUniformLocation(m_level_program, "moves"), moving ? 1.0f : 0.0f);
	glBindVertexArray(m_vertices);
	for (const Batch& batch : m_batches)
	{
		if (batch.moves != moving)
		{
			continue;
		}
		bindTexture(m_level_program, "mask", 0, batch.mask < 0 ? m_masks.back() : m_masks[static_cast<std::size_t>(batch.mask)]);
		glUniform2f(glGetUniformLocation(m_level_program, "alpha"), batch.alpha, batch.cutoff);
		glDrawElements(GL_TRIANGLES, static_cast<int>(batch.index_count), GL_UNSIGNED_INT,
					   reinterpret_cast<const void*>(std::size_t{batch.first_index} * sizeof(std::uint32_t)));
	}
}

void Scene::blitTo(unsigned frame, int width, int height) const
{
	glBindFramebuffer(GL_READ_FRAMEBUFFER, m_picture_frame);
	glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
	glBlitFramebuffer(0, 0, m_width, m_height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

std::vector<std::uint8_t> Scene::pixels() const
{
	const std::size_t row = 3 * static_cast<std::size_t>(m_width);
	std::vector<std::uint8_t> pixels(row * static_cast<std::size_t>(m_height));
	glBindFramebuffer(GL_READ_FRAMEBUFFER, m_picture_frame);
	glPixelStorei(GL_PACK_ALIGNMENT, 1);
	for (int y = 0; y < m_height; ++y) // OpenGL's first row is at the bottom
	{
		glReadPixels(0, m_height - 1 - y, m_width, 1, GL_RGB, GL_UNSIGNED_BYTE, pixels.data() + row * static_cast<std::size_t>(y));
	}
	return pixels;
}

double Scene::milliseconds() const
{
	return m_obscurance.milliseconds();
}
