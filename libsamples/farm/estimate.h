// SPDX-License-Identifier: GPL-3.0-or-later
// The facts of a command before it runs → time and memory that it may take: an estimate to plan with, not a bound.
#pragma once

#include "farm/plan.h"

#include <string>

namespace nook
{

struct WorkFacts
{
	std::string verb;
	double triangles = 0.0;
	double pixels = 0.0;   // or points
	double rays = 0.0;     // of a pixel
	bool looks_on = false; // volumes that are trimmed, compensated, simplified or dropped by sight
	bool open_end = false; // nobody knows how much
};

JobNeeds guessWork(const WorkFacts& facts, int threads);

// Processor time of so many jobs that share out a command, each of which takes `needs`, over that of one job; 1 where that is
// unknown.
double overheadOf(const JobNeeds& needs, std::size_t jobs);

// The most jobs that stay below this overhead; more do more of what each does by itself than they save.
inline constexpr double kOverhead = 1.15;
std::size_t mostJobs(const JobNeeds& needs, std::size_t jobs);

// Triangles of a level's file, by its format and size.
double trianglesOfFile(const std::string& ending, double bytes);

} // namespace nook
