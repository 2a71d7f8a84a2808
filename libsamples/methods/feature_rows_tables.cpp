// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of StatVO and of slices.
#include "methods/feature_parts.h"

namespace nook::feature_parts
{
namespace
{

using T = StatVoSettings;

void addLayers(std::vector<FeatureRow>& rows)
{
	FeatureRow& layers = addWhole(rows, kOfLayers, "--layers", 1, 64, member<&S::statvo, &T::layers>(),
								  "StatVO: layers of depth, 1, 2 or 4 (default); uniform: 1 to 64");
	layers.places = kInShade | kInEmit;
	layers.range = "1, 2, 4; uniform: 1 to 64";
	layers.stated = true;
	addChoice(rows, kOfLayers, "--layering", {"adaptive", "uniform"}, member<&S::statvo, &T::layering>(),
			  "StatVO: adaptive (default), by the mean depth around each pixel; or uniform, equal parts of the picture's "
			  "depths")
		.word = [](const S& s)
	{
		return std::string(s.statvo.layering == StatVoLayering::uniform ? "uniform" : "");
	};
	addFlag(rows, kOfLayers, "--quadrants", member<&S::statvo, &T::quadrants>(),
			"StatVO: four parts of the box by themselves; better, and dearer")
		.word = wordIf<"quadrants", &S::statvo, &T::quadrants>;
	addChoice(rows, kOfLayers, "--tables", {"full", "half", "quarter"},
			  {[](const S& s) { return static_cast<double>(s.statvo.cell_px / 2); },
			   [](S& s, double i)
			   {
				   s.statvo.cell_px = 1 << static_cast<int>(i);
			   }},
			  "StatVO: summed-area tables of full (default), half or quarter width and height")
		.word = [](const S& s)
	{
		return s.statvo.cell_px > 1 ? "cells-" + std::to_string(s.statvo.cell_px) : std::string();
	};
}

void addBox(std::vector<FeatureRow>& rows)
{
	addNumber(rows, kOfLayers, "--slope", 1e-3, 1e3, "per height", member<&S::statvo, &T::slope>(),
			  "StatVO: how fast what is farther in front than the box is high stops counting, per height (default 1)");
	addNumber(rows, kOfLayers, "--height", 0.05, 100.0, "radii", member<&S::statvo, &T::height>(),
			  "StatVO: height of the box over the surface, in radii (default 1)");
	addWhole(rows, kOfLayers, "--largest", 1, 255, member<&S::statvo, &T::largest_px>(),
			 "StatVO: half side of the box in the picture at most, in pixels; smaller boxes near the camera, and coarser "
			 "tables the larger it is (default 127)")
		.unit = "px";
	addChoice(rows, kOfLayers, "--skip", kYesNo, yesNo<&S::statvo, &T::skip>(),
			  "StatVO: looks at no layers where a surface is smooth, which changes nothing that shows (default yes)")
		.word = wordIf<"skip", &S::statvo, &T::skip>;
	addChoice(rows, kOfLayers, "--tables-by", {"automatic", "compute", "fragments"}, member<&S::statvo, &T::builder>(),
			  "StatVO, --device gl: sums by compute shaders or by fragments; automatic (default): compute shaders where a "
			  "GPU has them")
		.places = kInShade;
}

void addSlices(std::vector<FeatureRow>& rows)
{
	using P = SliceSettings;
	FeatureRow& slices = addWhole(rows, kOfSlices, "--slices", 1, 16, member<&S::slices, &P::count>(),
								  "Slices: planes through the view ray, 1 (default) to 16");
	slices.places = kInShade | kInEmit;
	slices.stated = true;
	FeatureRow& steps = addWhole(rows, kOfSlices, "--slice-steps", 1, 32, member<&S::slices, &P::steps>(),
								 "Slices: depths on either side of each, 1 to 32 (default 4)");
	steps.places = kInShade | kInEmit;
	steps.stated = true;
	steps.word = [](const S& s)
	{
		return "steps-" + std::to_string(s.slices.steps);
	};
	addNumber(rows, kOfSlices, "--slice-thickness", 1e-3, 1e3, "radii", member<&S::slices, &P::thickness>(),
			  "Slices: how thick surfaces at the reach are, near ones down to 1/32 of it; light comes from "
			  "behind (default 0.65)")
		.setting = "slice_thickness";
	FeatureRow& bent =
		addFlag(rows, kOfSlices, "--bent", member<&S::slices, &P::bent>(),
				"Slices: bent normals as well, the mean directions of what is open; with --filter bilateral or none");
	bent.conflict = "--resolution";
	bent.word = wordIf<"bent", &S::slices, &P::bent>;
}

} // namespace

void addTableRows(std::vector<FeatureRow>& rows)
{
	addLayers(rows);
	addBox(rows);
	addSlices(rows);
}

} // namespace nook::feature_parts
