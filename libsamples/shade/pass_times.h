// SPDX-License-Identifier: GPL-3.0-or-later
// Times of a plan's passes over several drawings.
#pragma once

#include "methods/passes.h"
#include "shade/shade.h"

#include <string>
#include <vector>

namespace nook
{

// The median, without the first of several drawings, which is a warm-up. Requires at least one.
PassTime passTimeOf(const std::string& name, std::vector<double> seconds);

// Stores the last pass's result: visibility, or bent normals and visibility as four values per pixel.
void setResult(Shaded& shaded, std::vector<float> values, bool quads);

class PassTimes
{
public:
	explicit PassTimes(const ShadePlan& plan);

	// Including the warm-up.
	static int drawings(const DrawSettings& settings);

	void add(std::size_t pass, double seconds);

	// Stores the medians and their sum.
	void finish(Shaded& shaded) const;

private:
	std::vector<std::string> m_names;
	std::vector<std::vector<double>> m_seconds;
};

} // namespace nook
