// SPDX-License-Identifier: GPL-3.0-or-later
// Levels → times of every screen-space method on one renderer, and how far its pictures are from the CPU's: `nook report times`.
#pragma once

#include "core/progress.h"
#include "study/measure_view.h"

#include <glm/vec2.hpp>

#include <optional>
#include <string>
#include <vector>

namespace nook
{

// A picture agrees with its CPU twin if at most this share of its pixels differs by more than 1/255. Renderers round differently,
// so a depth on the border of a sector, a layer or a radius may fall to either side. On llvmpipe one pixel of 130,000 does, in
// slices on Sponza; the rest is a margin for GPUs.
inline constexpr double kUnlikeShare = 0.002;

struct TimesSettings
{
	std::vector<std::string> levels; // files, or "builtin:NAME"; at least one; each from its first camera, or an automatic one
	std::vector<glm::ivec2> sizes;   // at least one
	std::vector<double> radii_px;    // at every pixel; 0: by depth, for suggestedRadius() the level; at least one
	bool check = false;              // also draws the pictures of the first size on the CPU
	GridSize grid = GridSize::quick;
	std::vector<std::string> only; // whole words with which names of candidates begin; empty: all
	double seconds = 0.0;          // no picture is begun later; 0: no limit
	MeasureSettings measure;
};

struct TimedPicture
{
	std::string level;
	glm::ivec2 size{0};
	double radius_px = 0.0;
	Candidate candidate;
	Measurement measured;       // without visibility
	std::optional<double> most; // greatest difference to the CPU
	double unlike = 0.0;        // share of pixels that differ by more than 1/255
	std::string failure;        // why there is no time; empty: there is one
};

struct TimesReport
{
	RendererFacts renderer;
	std::vector<TimedPicture> pictures; // size by size
	std::size_t left_out = 0;           // pictures for which no time was left
	std::vector<std::string> files;     // that the levels were read from
};

// Throws Error: unsupported where there is no renderer; usage for words with which no candidate's name begins.
TimesReport measureTimes(const TimesSettings& settings, const RunSettings& run);

} // namespace nook
