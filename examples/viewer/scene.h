// SPDX-License-Identifier: MIT
// Draws depth, normals and the displayed picture of a level: what an engine already has.
#pragma once

#include "accumulation.h"
#include "level_file.h"
#include "obscurance.h"
#include "static_occlusion.h"

#include <cstdint>
#include <string>
#include <vector>

enum class Show
{
	lit,        // a simple light × visibility
	visibility, // 1 is white
	depth,
	normals,
	difference, // between half and full resolution, amplified four times: lighter where half has less obscurance, darker where it
				// has more
	ages,       // number of frames in a pixel's mean: white at the maximum
};

// Source of occlusion: the screen-space method, the level's volumes, or both. Both see the same creases, so they are combined by
// the minimum, not the product, to avoid darkening twice. `bake` uses the level's vertex values, added to its volumes if they are
// differences; `moves` uses these or the volumes, and the method only for moving objects.
enum class Occluder
{
	screen,
	both,
	volumes,
	bake,
	moves,
};

// Averaging of visibility over frames.
enum class Accumulate
{
	off,
	on,
	unchecked, // with ghosts: does not check that history is from the same surface
};

struct Settings
{
	Accumulate accumulate = Accumulate::off;
	bool still_tile = false; // accumulate the samples of the tile's first frame instead of each frame's own
	Occluder occluder = Occluder::screen;
	std::size_t method = 0; // index into Obscurance::methods()
	Show show = Show::lit;
	bool half = false;     // resolution of the obscurance
	bool reversed = false; // depth: 1 near, 0 far; needs glClipControl
	float radius_m = 0.5f;

	bool accumulates() const
	{
		return accumulate != Accumulate::off && show != Show::difference;
	}
};

// Throws Failure (4) if the driver lacks a feature. Its OpenGL objects are destroyed with the context.
class Scene
{
public:
	Scene(const LevelFile& level, const std::string& volumes);

	void resize(int width, int height);
	void draw(const Camera& camera, const Settings& settings);
	void cut(); // previous frames no longer count
	void blitTo(unsigned frame, int width, int height) const;

	std::vector<std::uint8_t> pixels() const; // RGB, rows from the top
	double milliseconds() const;              // as in Obscurance

private:
	void begin(const glm::mat4& camera_from_world, const glm::mat4& projection, bool reversed);
	void drawTriangles(bool moving);
	void keepStatic(unsigned visibility);
	unsigned known(Occluder occluder, unsigned volumes, unsigned screen, unsigned still);

	std::vector<Batch> m_batches;
	std::vector<unsigned> m_masks;
	Baked m_level_baked;
	Obscurance m_obscurance;
	Accumulation m_accumulation;
	StaticOcclusion m_static;
	unsigned m_level_program = 0;
	unsigned m_show_program = 0;
	unsigned m_known_program = 0;
	unsigned m_vertices = 0;
	unsigned m_depth = 0;
	unsigned m_old_depth = 0; // the previous frame's; the two are swapped
	unsigned m_normals = 0;
	unsigned m_old_normals = 0;
	unsigned m_picture = 0;
	unsigned m_baked = 0; // RG16F: vertex values, and whether the surface moves
	unsigned m_fixed = 0; // the method without moving objects
	unsigned m_known = 0;
	unsigned m_level_frame = 0;
	unsigned m_old_level_frame = 0;
	unsigned m_picture_frame = 0;
	unsigned m_known_frame = 0;
	int m_width = 0;
	int m_height = 0;
};
