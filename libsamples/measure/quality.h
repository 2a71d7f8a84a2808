// SPDX-License-Identifier: GPL-3.0-or-later
// Pattern → its errors over the ensembles of FORMULAS ("Measures of a pattern"), as shares of the domain's measure (0 to 1).
#pragma once

#include "core/progress.h"
#include "pattern/tile.h"

#include <optional>

namespace nook
{

// Values that a domain does not define are absent.
struct Quality
{
	double plane = 0.0;          // rms error over half-spaces: 24 n_z × 40 c × 97 azimuths; plane² = noise² + bias²
	double noise = 0.0;          // its part that changes with a rotation of the pattern
	double bias = 0.0;           // its part that does not
	double plane_exact = 0.0;    // the same ensemble in closed form, without a grid
	double greatest = 0.0;       // greatest error on the plane grid
	std::optional<double> cliff; // disk: rms over vertical half-planes
	std::optional<double> cliff_greatest;
	std::optional<double> centre;   // disk, ball: rms over planes through the centre
	std::optional<double> crease;   // disk: rms over concave corners of two half-spaces
	std::optional<double> cap;      // directions: spherical-cap discrepancy, the greatest error over caps found on a dense set
	double spread = 0.0;            // relative standard deviation of the cells' integrals
	double smallest_distance = 0.0; // least distance of two points; 0 for a single point
	double energy = 0.0;            // Σ over pairs of d^−energy_exponent; 0 for a single point, infinite for doubled points
	double energy_exponent =
		3.0; // 3 for disk and ball (the potential of the paper's 1/d⁴ force), 1 for directions, or the recipe's
};

// exponent: of the energy; 0: the domain's own.
Quality measurePattern(const Pattern& pattern, const RunSettings& run = {}, double exponent = 0.0);

struct TileQuality
{
	// None where it takes long: of the window with more than 4096 samples, of the variants with more than 2^24 pairs.
	std::optional<double> window;        // rms error of the mean over the variants, on the plane grid; not of slices
	std::optional<double> window_exact;  // in closed form
	std::optional<double> variant_plane; // rms over the variants of their own plane error (closed form)
	std::optional<double> worst_variant; // the greatest of them
	std::optional<double> base_plane;    // the base pattern's plane error (closed form)
};

// The rms error of what is seen behind a filter and a mean over frames, in closed form: over all pixels, frames and `shares` (such
// as those of a filter whose taps are cut off on several sides).
double errorBehind(const PatternTile& tile, const std::vector<TileShares>& shares, const RunSettings& run = {});

TileQuality measureTile(const PatternTile& tile, const Pattern& base, const RunSettings& run = {});

} // namespace nook
