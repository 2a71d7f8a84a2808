// SPDX-License-Identifier: GPL-3.0-or-later
// A level's cameras → points of their pictures with their neighbours; a curve from sums to occlusion → AOV eq. 14 at these, and the
// curve that makes it least.
#pragma once

#include "core/progress.h"
#include "scene/reference.h"
#include "scene/tracer.h"
#include "volume/volumes.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace nook
{

// A pixel's surface, that of the pixel to its right, and that of the one below; what is seen of sky repeats the first.
struct PictureTriple
{
	std::array<ReferencePoint, 3> points;
	std::array<bool, 3> there{true, false, false};
	int view = 0; // of the cameras that were chosen
};

struct PictureSettings
{
	int views = 8;                      // automatic cameras
	int skipped = 0;                    // that come before them: as many more are chosen, and not used
	int per_view = 1200;                // triples of each, on a grid
	std::array<int, 2> size{1280, 720}; // of the pictures, pixels
};

std::vector<PictureTriple> pictureTriples(const Tracer& tracer, const PictureSettings& settings, const RunSettings& run);

// Sums of volumes and occlusion by rays at a triple's points.
struct TripleValues
{
	std::array<double, 3> sums{};
	std::array<double, 3> occlusions{};
	std::array<bool, 3> there{true, false, false};
};

// AOV eq. 14 over triples, of visibilities that are not rounded to 8 bits.
double pictureError(const Compensation& curve, std::span<const TripleValues> triples);

// What a curve is fitted to.
enum class CurveMeasure
{
	eq14, // AOV's: logarithms of values and of the steps to neighbours
	rmse, // of visibility, at the triples' first points
};

// By either measure; rmse: its square.
double curveError(const Compensation& curve, std::span<const TripleValues> triples, CurveMeasure measure);

// From `start`, whose range it keeps: knot by knot, in ever smaller steps, as long as the error falls. Rising, 0 at 0.
Compensation fitToPictures(const Compensation& start, std::span<const TripleValues> triples,
						   CurveMeasure measure = CurveMeasure::eq14);

} // namespace nook
