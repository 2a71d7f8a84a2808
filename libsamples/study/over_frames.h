// SPDX-License-Identifier: GPL-3.0-or-later
// A camera that stands or moves, and the mean over frames that an engine keeps: α · new + (1 − α) · old, old being read where each
// surface was in the frame before.
#pragma once

#include "pattern/recipe.h"
#include "scene/gbuffer.h"

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace nook
{

enum class Motion
{
	still,
	pan,  // turns to the right about its own upright axis
	walk, // moves to its right
};
template <> std::span<const std::string_view> namesOf<Motion>();

// Each frame.
struct MotionStep
{
	double turn_px = 0.0; // pixels at the picture's centre
	double side_m = 0.0;
};

// Pans by 1.5 pixels or walks by a 25th of the radius: neither is a whole number of pixels.
MotionStep stepOf(Motion motion, double radius_m);

// The camera of a frame, from 0.
LevelCamera cameraOfFrame(const LevelCamera& first, const MotionStep& step, int frame, int width_px, int height_px);

// Where a pixel's surface was in the frame before: up to four texels with weights of sum 1; those that lie off the pixel's plane
// by more than a texel, or face elsewhere, are left out. None: it was hidden, or outside.
struct HistoryTexels
{
	std::array<std::size_t, 4> texels{};
	std::array<double, 4> weights{};
	bool any = false;
};

// Both pictures have one size.
std::vector<HistoryTexels> historyOf(const GBuffer& now, const GBuffer& before);

// The running mean over one camera's pictures, in order.
class FrameMean
{
public:
	// ema: α, above 0, at most 1. The first 1/α frames of a pixel count alike.
	explicit FrameMean(double ema);

	// A frame, and where its surfaces were in the one before; of the first frame, or after a cut, nothing.
	void add(std::vector<double> frame, std::span<const HistoryTexels> history);

	const std::vector<double>& mean() const;
	const std::vector<int>& ages() const; // frames in each pixel's mean

	// rms by which the mean of a surface changed with the last frame, over pixels that have a history; 0 where none has.
	double change() const;

private:
	double m_ema;
	double m_change = 0.0;
	std::vector<double> m_mean;
	std::vector<int> m_ages;
};

} // namespace nook
