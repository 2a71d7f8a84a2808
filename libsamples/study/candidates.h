// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that can be drawn for a picture's obscurance: methods with their counts, samples, filters, resolutions and features,
// as one list with names. `nook report error` measures all of it, `nook tune` searches it.
#pragma once

#include "methods/candidate_axes.h"
#include "methods/method_table.h"
#include "methods/recipes.h"
#include "pattern/tile.h"
#include "shade/asset_kinds.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

enum class CandidateKind
{
	screen, // a screen-space method
	asset,  // made of the level before: occlusion volumes, masks, bakes, ... (shade/asset_kinds.h)
	rays,   // Embree on the CPU; never on the renderer at hand
};

// Lengths are in radii of the reference, so that one list serves every level.
struct Candidate : AssetSettings
{
	CandidateKind kind = CandidateKind::screen;
	Origin origin = Origin::ours;

	// screen. radius_m, volume.thickness_m of `shade` are left alone: see the ratios, or the recipe in place of them.
	ShadeSettings shade;
	double radius_ratio = 1.0;          // radius of the method / radius of the reference's rays
	double thickness_ratio = 0.0;       // of volumetric obscurance, in radii of the method; 0: without end
	std::optional<MethodRecipe> recipe; // all lengths, and what else it names
	SampleSource source = SampleSource::own;
	int count = 0;          // samples, layers or directions (MethodRow::set_count); rays: rays
	bool only_form = false; // of a paper, and nook has no other

	const AssetKind* asset = nullptr; // kind asset, with the AssetSettings

	// Unique, the same from run to run: "vo-line 9 tile bilateral-5 half", "statvo 4 skip", "aov built third", "bake 0.1", "rays
	// 64".
	std::string name() const;

	// Its group in charts: the name of its row, or "rays".
	std::string method() const;

	// Row of the method table; null for bakes and rays.
	const MethodRow* row() const;

	// "half", "third"; "full".
	std::string resolution() const;
};

// In a fixed order, names unique: methods in the order of their table, then bakes, then rays.
std::vector<Candidate> candidateGrid(GridSize size);

// Returns the method at its best: most samples, no filter, full resolution. A candidate approximates this picture. Volumes are
// drawn in every pixel; bakes and rays are their own definition.
Candidate definitionOf(const Candidate& candidate);

// Settings with lengths for a reference of that radius. Requires kind screen.
ShadeSettings shadeSettingsOf(const Candidate& candidate, double radius_m);

// Samples for `settings` (of shadeSettingsOf). The recipe alone decides every bit; seconds for large tiles.
ShadeSamples samplesOf(const Candidate& candidate, const ShadeSettings& settings, const RunSettings& run);

// The same, made once. Not for several threads at a time.
class SampleStore
{
public:
	const ShadeSamples& samplesOf(const Candidate& candidate, const ShadeSettings& settings, const RunSettings& run);

private:
	std::map<std::string, ShadeSamples> m_made;
};

// The pattern and the tile of it that those samples are of. Requires a source other than `own`.
struct CandidatePattern
{
	Recipe recipe;
	Pattern pattern;
	bool tiled = false; // false: `variants` are of no tile recipe (uniform)
	TileRecipe tile;
	std::vector<Pattern> variants; // 16
};
CandidatePattern patternOf(const Candidate& candidate, const RunSettings& run);

} // namespace nook
