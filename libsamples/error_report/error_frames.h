// SPDX-License-Identifier: GPL-3.0-or-later
// What a mean over frames makes of methods, with a camera that stands, pans or walks. For error_measure.cpp.
#pragma once

#include "error_report/error_report.h"
#include "pattern/tile.h"

#include <functional>

namespace nook
{

struct FramesCandidate
{
	Candidate candidate;
	std::optional<PatternTile> tile; // none: its own samples, the same in every frame
};

// 1, 8 and 32 as far as there are so many, and the last.
std::vector<int> shownFrames(int frames);

// A tile of at most 8 frames for the candidate's filter and its number of samples; none for what takes no tile.
std::optional<PatternTile> frameTile(const Candidate& candidate, int frames, double ema, const RunSettings& run);

// Rows of one motion. `reference`: of a camera, of the view's size.
void addFrames(FramesPart& part, LevelBench& bench, const LevelCamera& camera, const ViewSettings& how, Motion motion,
			   const std::vector<FramesCandidate>& candidates, const MeasureSettings& measure,
			   const std::function<Reference(const LevelCamera&)>& reference, const RunSettings& run, ProgressCounter& progress);

} // namespace nook
