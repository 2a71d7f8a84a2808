// SPDX-License-Identifier: GPL-3.0-or-later
// Settings of statistical volumetric obscurance (statvo.glsl).
#pragma once

namespace nook
{

enum class StatVoLayering
{
	adaptive, // SVO §5: by the mean depth around each pixel
	uniform,  // SVO §4: equal parts of the picture's range of depths
};

// How sums are made from cells.
enum class TableBuilder
{
	automatic, // compute shaders where OpenGL has them and runs on a GPU
	compute,   // one work group a row, and one a column
	fragments, // recursive doubling, eight entries a pass
};

struct StatVoSettings
{
	int layers = 4; // adaptive: 1, 2, 4; uniform: 1 to 64
	StatVoLayering layering = StatVoLayering::adaptive;
	bool quadrants = false;
	int cell_px = 1;      // of the tables: 1, 2, 4
	double slope = 1.0;   // of ψ above 1, > 0
	double height = 1.0;  // of the box over the surface, in radii, 0.05 to 100
	int largest_px = 127; // half side of a rectangle at most, 1 to 255
	bool skip = true;     // no layers where a surface is smooth
	TableBuilder builder = TableBuilder::automatic;
};

} // namespace nook
