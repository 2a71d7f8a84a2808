// SPDX-License-Identifier: GPL-3.0-or-later
// One line on a terminal that is written over and over, and gone in the end.
#pragma once

#include "progress_stage.h"

#include <span>

namespace nook
{

class ProgressLine
{
public:
	// Stages, each a part of the one before, with a bar and the time left. Ten times a second at most, but for the beginning of a
	// first stage.
	void show(std::span<const ProgressStage> stages, double now_s);

	void clear();

private:
	bool m_shown = false;
	double m_shown_s = 0.0;
};

} // namespace nook
