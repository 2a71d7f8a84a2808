// SPDX-License-Identifier: GPL-3.0-or-later
// Bakes a level partly into a texture and partly at its vertices: each chart of triangles gets what errs least for the bytes.
#pragma once

#include "bake/unwrap.h"

#include <functional>

namespace nook
{

struct AutoSettings
{
	double rmse = 0.0;     // > 0: as few bytes as that error takes
	std::size_t bytes = 0; // > 0: at most so many are added, with the least error
	int margin_px = 3;     // of charts
	bool one_side = false; // a texture darkens both sides of sheets, as colours do
};

// A glTF primitive at a place.
struct AutoPiece
{
	GltfCost cost;            // with the values of a vertex
	std::size_t vertices = 0; // of the primitive
	bool takes_texture = true;
};

struct AutoShare // of the surface
{
	std::size_t triangles = 0;
	double area_m2 = 0.0;
	double rmse = 0.0; // at the check's points, with the noise of their rays
};

struct AutoBake
{
	Unwrapped unwrapped;            // kNoPage: values at the vertices
	std::vector<TextureBake> pages; // none if nothing is textured
	VertexBake vertices;            // of the unwrapped level; the front of textured triangles is 1
	double expected_rmse = 0.0;     // of the choice, without the noise of rays
	std::size_t bytes = 0;          // added
	std::size_t value_bytes = 0;    // by values at the vertices alone
	bool is_short = false;          // the error asked for was not reached
	BakeCheck check;
	AutoShare textured;
	AutoShare at_vertices;
};

// `level`: with the triangles of all pieces. `turned`: 1 for each triangle of the pieces in order that the file has the other way
// round, so that a texture cannot be on its front; empty: none. bytesOf(): bytes that a result adds to the file. Same result for
// any thread count. Progress stages of its parts.
AutoBake bakeAuto(const Tracer& tracer, const Level& level, std::span<const UnwrapPiece> pieces, std::span<const AutoPiece> costs,
				  std::span<const uint8_t> turned, const BakeSettings& settings, const AutoSettings& wanted,
				  const std::function<std::size_t(const AutoBake&)>& bytesOf, const RunSettings& run);

} // namespace nook
