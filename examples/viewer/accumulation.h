// SPDX-License-Identifier: MIT
// Averages visibility over frames, reading each pixel's history where its surface was in the previous frame. Independent of nook:
// an engine with temporal accumulation already has this pass.
#pragma once

#include <glm/mat4x4.hpp>

#include <array>

class Accumulation
{
public:
	// Needs a current context, like everything here; its OpenGL objects are destroyed with the context.
	Accumulation();

	void resize(int width, int height);

	// Forgets all frames. Call when visibility changes at once: another camera, method or radius.
	void cut();

	// Number of the next frame since the cut.
	int frame() const;

	struct Input
	{
		unsigned visibility = 0; // texture: this frame's, filtered
		unsigned depth = 0;      // texture: depth buffer
		unsigned old_depth = 0;  // texture: the previous frame's depth buffer
		unsigned normals = 0;    // texture: unit, in view space
		unsigned old_normals = 0;
		bool reversed = false; // 1 near, 0 far, z_ndc from 0 to 1
		bool checked = true;   // false: accept history of any surface, which leaves ghosts
		glm::mat4 camera_from_world{1.0f};
		glm::mat4 projection{1.0f}; // without a skew; includes the frame's jitter
	};
	// Returns a texture, RG16F: the mean, and its number of frames.
	unsigned draw(const Input& input);

private:
	unsigned m_program = 0;
	unsigned m_vertices = 0;
	std::array<unsigned, 2> m_means{}; // alternately read and written
	std::array<unsigned, 2> m_targets{};
	glm::mat4 m_old_camera_from_world{1.0f};
	glm::mat4 m_old_projection{1.0f};
	int m_frame = 0;
	int m_width = 0;
	int m_height = 0;
};
