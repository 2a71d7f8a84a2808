// SPDX-License-Identifier: GPL-3.0-or-later
// Pattern → which rotations and reflections leave it as it is, and on which rings or shells its samples lie.
#pragma once

#include "pattern/pattern.h"

#include <vector>

namespace nook
{

// Samples at (nearly) the same distance from the centre; for directions at the same height z.
struct Ring
{
	double radius = 0.0; // mean
	int samples = 0;
	double weight = 0.0; // sum
};

struct Symmetry
{
	int order = 1; // disk, hemisphere: rotations about the axis that map the pattern to itself; ball, sphere: the same in space
	bool mirrored = false;   // disk, hemisphere: a reflection does too
	bool antipodal = false;  // −p is a sample for every sample p
	std::vector<Ring> rings; // from the inside out
};

// tolerance: greatest distance between a moved sample and the sample it lands on, in radii of the domain.
Symmetry findSymmetry(const Pattern& pattern, double tolerance = 0.02);

} // namespace nook
