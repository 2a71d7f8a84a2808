// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of a command before it runs → time and memory that it may take. A guess to plan with, not a bound.
#pragma once

#include "farm/plan.h"

#include <string>

namespace nook
{

struct WorkFacts
{
	std::string verb;
	double triangles = 0.0;
	double file_bytes = 0.0; // of what is read
	double pixels = 0.0;     // or points
	double rays = 0.0;       // of a pixel
};

struct WorkGuess
{
	JobNeeds needs;
	double load_seconds = 0.0; // what each part takes again: the level is read, its tree is built
};

WorkGuess guessWork(const WorkFacts& facts, int threads);

// Triangles of a level's file, by its format and size.
double trianglesOfFile(const std::string& ending, double bytes);

} // namespace nook
