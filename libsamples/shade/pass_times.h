// SPDX-License-Identifier: GPL-3.0-or-later
// How long each pass of a plan took, over several drawings.
#pragma once

#include "methods/passes.h"
#include "shade/shade.h"

#include <string>
#include <vector>

namespace nook
{

// The median, without the first of several, which warmed up. Requires one.
PassTime passTimeOf(const std::string& name, std::vector<double> seconds);

// What the last pass drew: visibility; or bent normals and visibility, four numbers a pixel.
void setResult(Shaded& shaded, std::vector<float> values, bool quads);

class PassTimes
{
public:
	explicit PassTimes(const ShadePlan& plan);

	// With the one that warms up.
	static int drawings(const DrawSettings& settings);

	void add(std::size_t pass, double seconds);

	// The medians, and the sum of them.
	void finish(Shaded& shaded) const;

private:
	std::vector<std::string> m_names;
	std::vector<std::vector<double>> m_seconds;
};

} // namespace nook
