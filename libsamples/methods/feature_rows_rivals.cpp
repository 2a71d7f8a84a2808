// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the methods to compare with.
#include "methods/feature_parts.h"

#include "core/number.h"

namespace nook::feature_parts
{
namespace
{

using R = RivalSettings;

void addHorizon(std::vector<FeatureRow>& rows)
{
	addNumber(rows, kOfRange, "--crytek-range", 1e-3, 1e6, "radii", member<&S::rival, &R::range>(),
			  "crytek: what is that many radii in front counts as 1/2 (default 2.7)");
	addWhole(rows, kOfHorizon, "--hbao-directions", 1, 64, member<&S::rival, &R::directions>(),
			 "hbao: directions in the picture (default 6)");
	addWhole(rows, kOfHorizon, "--hbao-steps", 1, 64, member<&S::rival, &R::steps>(),
			 "hbao: steps along each direction (default 6)");
	addNumber(rows, kOfHorizon, "--hbao-angle-bias", 0.0, 89.0, "degrees", member<&S::rival, &R::angle_bias_deg>(),
			  "hbao: degrees over the tangent plane that count for nothing (default 30)")
		.word = [](const S& s)
	{
		const bool published = s.rival.angle_bias_deg == R{}.angle_bias_deg;
		return published ? std::string() : "bias-" + numberText(s.rival.angle_bias_deg);
	};
}

void addSpiral(std::vector<FeatureRow>& rows)
{
	addWhole(rows, kOfSpiral, "--sao-samples", 1, 256, member<&S::rival, &R::spiral_samples>(),
			 "sao: samples of the spiral (default 11)");
	addWhole(rows, kOfSpiral, "--sao-turns", 1, 256, member<&S::rival, &R::spiral_turns>(), "sao: turns of the spiral (default 7)");
	addNumber(rows, kOfSpiral, "--sao-intensity", 1e-6, 1e6, "", member<&S::rival, &R::intensity>(),
			  "sao: factor of the obscurance, with lengths in units of the radius (default 1)");
	addNumber(rows, kOfSpiral, "--sao-bias", 0.0, 1.0, "radii", member<&S::rival, &R::bias>(),
			  "sao: height over the tangent plane that counts for nothing, in radii (default 0.012)");
	addNumber(rows, kOfSpiral, "--sao-epsilon", 1e-12, 1e6, "radii²", member<&S::rival, &R::epsilon>(),
			  "sao: keeps the quotient finite, in squares of the radius (default 0.01)");
	addWhole(rows, kOfSpiral, "--sao-levels", 0, 8, member<&S::rival, &R::levels>(),
			 "sao: coarser depths for samples that are far away (default 5)");
}

void addPlanes(std::vector<FeatureRow>& rows)
{
	addWhole(rows, kOfGtao, "--gtao-slices", 1, 16, member<&S::rival, &R::gtao_slices>(),
			 "gtao: planes through the view ray (default 3)");
	addWhole(rows, kOfGtao, "--gtao-steps", 1, 32, member<&S::rival, &R::gtao_steps>(),
			 "gtao: depths on either side of each (default 6)");
	addNumber(rows, kOfGtao, "--gtao-falloff", 0.0, 0.99, "radii", member<&S::rival, &R::gtao_falloff>(),
			  "gtao: radii from which on horizons fade to the tangent (default 0.385)");
	addNumber(rows, kOfGtao, "--gtao-thickness", 0.0, 1.0, "", member<&S::rival, &R::gtao_thickness>(),
			  "gtao: share of the way down that a step below the horizon brings it (default 0.01)");
	addWhole(rows, kOfBitmask, "--bitmask-slices", 1, 16, member<&S::rival, &R::bitmask_slices>(),
			 "bitmask: planes through the view ray (default 3)");
	addWhole(rows, kOfBitmask, "--bitmask-steps", 1, 32, member<&S::rival, &R::bitmask_steps>(),
			 "bitmask: depths on either side of each (default 6)");
	addNumber(rows, kOfBitmask, "--bitmask-thickness", 1e-3, 1e3, "radii", member<&S::rival, &R::bitmask_thickness>(),
			  "bitmask: how thick surfaces are (default 0.25)");
	addChoice(rows, kOfBitmask, "--bitmask-hit", {"half", "whole", "touched"}, member<&S::rival, &R::bitmask_hit>(),
			  "bitmask: how much of a sector a surface covers before that counts as covered: half of it (default), all "
			  "of it, or any part")
		.places = kInShade;
}

} // namespace

void addRivalRows(std::vector<FeatureRow>& rows)
{
	addHorizon(rows);
	addSpiral(rows);
	addPlanes(rows);
}

} // namespace nook::feature_parts
