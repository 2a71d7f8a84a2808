// SPDX-License-Identifier: MIT
// A level and a camera → depth, normals, and the picture that is shown: what an engine has anyway.
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
	difference, // of half and full resolution: lighter where half sees less obscurance, darker where more; four times as much
	ages,       // frames that a pixel's mean is of: white where it has all that it can have
};

// What darkens: the screen-space method, the level's volumes, or both. Both see the same creases, so the lesser visibility counts,
// not the product: nothing is darkened twice. `bake` is what the level's vertices know, with its volumes where they hold a
// difference to these; `moves` is that, or the volumes, and the method for what moves alone.
enum class Occluder
{
	screen,
	both,
	volumes,
	bake,
	moves,
};

// The mean of visibility over frames.
enum class Accumulate
{
	off,
	on,
	unchecked, // with ghosts: without a look at whether history is of the same surface
};

struct Settings
{
	Accumulate accumulate = Accumulate::off;
	bool still_tile = false; // frames accumulate the samples of the tile's first one, not the next ones each time
	Occluder occluder = Occluder::screen;
	std::size_t method = 0; // of Obscurance::methods()
	Show show = Show::lit;
	bool half = false;     // resolution of the obscurance
	bool reversed = false; // depth: 1 near, 0 far; needs glClipControl
	float radius_m = 0.5f;

	bool accumulates() const
	{
		return accumulate != Accumulate::off && show != Show::difference;
	}
};

// Throws Failure (4) for what the driver does not take. What it makes of OpenGL goes with the context.
class Scene
{
public:
	Scene(const LevelFile& level, const std::string& volumes);

	void resize(int width, int height);
	void draw(const Camera& camera, const Settings& settings);
	void cut(); // frames before this one do not count any more
	void blitTo(unsigned frame, int width, int height) const;

	std::vector<std::uint8_t> pixels() const; // RGB, rows from the top
	double milliseconds() const;              // as Obscurance

private:
	void begin(const glm::mat4& camera_from_world, const glm::mat4& projection, bool reversed);
	void drawTriangles(bool moving);
	void keepStill(unsigned visibility);
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
	unsigned m_old_depth = 0; // of the frame before; the two change places
	unsigned m_normals = 0;
	unsigned m_old_normals = 0;
	unsigned m_picture = 0;
	unsigned m_baked = 0; // RG16F: what the vertices know, and whether it moves
	unsigned m_still = 0; // the method without what moves
	unsigned m_known = 0;
	unsigned m_level_frame = 0;
	unsigned m_old_level_frame = 0;
	unsigned m_picture_frame = 0;
	unsigned m_known_frame = 0;
	int m_width = 0;
	int m_height = 0;
};
