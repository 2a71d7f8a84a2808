// SPDX-License-Identifier: MIT
// Visibility of one frame → its mean over frames, each pixel's history read where its surface was in the frame before.
// It knows nothing of nook: an engine that accumulates anything else has this pass already.
#pragma once

#include <glm/mat4x4.hpp>

#include <array>

class Accumulation
{
public:
	// Needs a current context, as all else here; what it makes there goes with the context.
	Accumulation();

	void resize(int width, int height);

	// Forgets all frames: the next one is the first. For whatever changes visibility at once: another camera, method or radius.
	void cut();

	// Of the frame that is drawn next, counted since the cut.
	int frame() const;

	struct Input
	{
		unsigned visibility = 0; // texture: of this frame, filtered
		unsigned depth = 0;      // texture: a depth buffer as it is
		unsigned old_depth = 0;  // texture: that of the frame before, of the same kind
		unsigned normals = 0;    // texture: unit, in view space
		unsigned old_normals = 0;
		bool reversed = false; // 1 near, 0 far, z_ndc from 0 to 1
		bool checked = true;   // false: history is taken from whatever surface was there, which leaves ghosts
		glm::mat4 camera_from_world{1.0f};
		glm::mat4 projection{1.0f}; // without a skew; the frames' jitter, where there is one, is in it
	};
	// Returns a texture, RG16F: the mean, and how many frames are in it.
	unsigned draw(const Input& input);

private:
	unsigned m_program = 0;
	unsigned m_vertices = 0;
	std::array<unsigned, 2> m_means{}; // in turn: read, written
	std::array<unsigned, 2> m_targets{};
	glm::mat4 m_old_camera_from_world{1.0f};
	glm::mat4 m_old_projection{1.0f};
	int m_frame = 0;
	int m_width = 0;
	int m_height = 0;
};
