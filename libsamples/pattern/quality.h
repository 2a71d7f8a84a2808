// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of a pattern over the ensembles of FORMULAS ("Measures of a pattern"), as fractions of the domain's measure (0 to 1).
#pragma once

#include "core/facts.h"
#include "core/progress.h"
#include "pattern/pattern.h"
#include "pattern/tile.h"

#include <optional>
#include <vector>

namespace nook
{

// Measures that are undefined for a domain are absent.
struct Quality
{
	double plane = 0.0;          // rms error over half-spaces: 24 n_z × 40 c × 97 azimuths; plane² = noise² + bias²
	double noise = 0.0;          // the part that depends on the pattern's rotation
	double bias = 0.0;           // the part that does not
	double plane_exact = 0.0;    // the same ensemble in closed form, without a grid
	double greatest = 0.0;       // greatest error on the plane grid
	std::optional<double> cliff; // disk: rms over vertical half-planes
	std::optional<double> cliff_greatest;
	std::optional<double> centre;   // disk, ball: rms over planes through the centre
	std::optional<double> crease;   // disk: rms over concave corners of two half-spaces
	std::optional<double> cap;      // directions: spherical-cap discrepancy, the greatest error found over a dense set of caps
	double spread = 0.0;            // relative standard deviation of the cells' integrals
	double smallest_distance = 0.0; // smallest distance between two points; 0 for a single point
	double energy = 0.0;            // Σ over pairs of d^−energy_exponent; 0 for a single point, infinite for duplicate points
	double energy_exponent =
		3.0; // 3 for disk and ball (the potential of the paper's 1/d⁴ force), 1 for directions, or the recipe's
};

// exponent: of the energy; 0: the domain's default.
Quality measurePattern(const Pattern& pattern, const RunSettings& run = {}, double exponent = 0.0);

struct TileQuality
{
	// Absent if too expensive: `window` above 4096 samples, the variants' measures above 2^24 pairs.
	std::optional<double> window;        // rms error of the mean over the variants, on the plane grid; absent for slices
	std::optional<double> window_exact;  // in closed form
	std::optional<double> variant_plane; // rms over the variants of their own plane error (closed form)
	std::optional<double> worst_variant; // the greatest variant_plane of a single variant
	std::optional<double> base_plane;    // the base pattern's plane error (closed form)
};

// Closed-form rms error behind a filter and a mean over frames: over all pixels, frames and `shares` (for example those of a filter
// with taps cut off on several sides).
double errorBehind(const PatternTile& tile, const std::vector<TileShares>& shares, const RunSettings& run = {});

// For each filter its name, "binomial:3", and the error behind it, or nothing where that takes more than so many steps; with frames
// also of the mean over them, "binomial:3, frames", and of half of its taps, cut off by an edge, "binomial:3, half".
std::vector<Measure> measuresBehind(const PatternTile& tile, const std::vector<TileFilter>& filters, double ema, double most_steps,
									const RunSettings& run);

TileQuality measureTile(const PatternTile& tile, const Pattern& base, const RunSettings& run = {});

// The occluders that patterns are judged by, and a pattern's estimate for each.

// The exact fraction of the domain's measure where n·x ≤ c. n is a unit vector; only the hemisphere depends on its z.
double freeShare(Domain domain, double n_z, double c);

// A pattern prepared for many evaluations.
class Estimator
{
public:
	explicit Estimator(const Pattern& pattern);

	// The pattern's estimate of that fraction. Lines are clipped analytically (n_z > 0); a point on the plane counts half.
	double estimate(const glm::dvec3& n, double c) const;

	// Lines against a vertical plane: total weight of those with m·p > d, half where equal. m is a unit vector in the plane.
	double estimateBeyond(double m_x, double m_y, double d) const;

	// Lines against two half-spaces through the centre whose union is occupied: n1, n2 with n_z > 0.
	double estimateCorner(const glm::dvec3& n1, const glm::dvec3& n2) const;

private:
	double linesFree(const glm::dvec3& n, double c) const;

	bool m_lines;
	std::vector<double> m_x;
	std::vector<double> m_y;
	std::vector<double> m_z;    // points only
	std::vector<double> m_half; // half length of the line
	std::vector<double> m_weight;
};

} // namespace nook
