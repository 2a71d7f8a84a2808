// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/unwrap.h"

#include "core/lists.h"
#include "core/words.h"
#include "scene/ray_triangle.h"
#include "scene/topology.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace nook
{
namespace
{

// Packs at the size of texels that is asked for, or the least one that fits; sets texel_m and size_px.
std::vector<ChartPlace> place(std::span<const FlatChart> flat, std::span<const ScaledChart> scaled, UnwrapSettings settings,
							  int threads, Unwrapped& made, const std::string& name)
{
	const auto take = [&](std::vector<ChartPlace> places, double density)
	{
		made.texel_m = 1.0 / density;
		made.size_px = settings.size_px;
		return places;
	};
	const auto refuseSize = [&]
	{
		refuseInput(name + ": unwrap",
					std::to_string(scaled.size()) + " charts that " + counted(settings.pages, "page", "pages") + " of " +
						std::to_string(settings.size_px) + " texels do not hold",
					"larger texels, a larger texture, more pages or a smaller margin");
	};
	double area = 0.0;
	for (const ScaledChart& one : scaled)
	{
		for (const glm::uvec3& t : flat[one.chart].triangles)
		{
			area += one.scale * one.scale * areaIn(flat[one.chart].points, t);
		}
	}
	if (settings.texel_m > 0.0)
	{
		const bool any_size = settings.size_px == 0;
		const int most = any_size ? kMostTexture_px : settings.size_px;
		for (settings.size_px = any_size ? kLeastTexture_px : most; settings.size_px <= most; settings.size_px *= 2)
		{
			if (auto places = packCharts(flat, scaled, 1.0 / settings.texel_m, settings, threads))
			{
				return take(std::move(*places), 1.0 / settings.texel_m);
			}
		}
		settings.size_px = most;
		refuseSize();
	}
	// Halves the interval between a density that fits and one that does not.
	double fits = 0.0;
	double too_many = std::sqrt(static_cast<double>(settings.pages) * settings.size_px * settings.size_px / area);
	const double least = 1e-4 * too_many;
	std::vector<ChartPlace> best;
	for (double density = 0.85 * too_many; too_many > 1.01 * fits; density = fits > 0.0 ? 0.5 * (fits + too_many) : 0.75 * too_many)
	{
		if (auto places = packCharts(flat, scaled, density, settings, threads))
		{
			fits = density;
			best = std::move(*places);
			continue;
		}
		too_many = density;
		if (too_many < least)
		{
			refuseSize();
		}
	}
	return take(std::move(best), fits);
}

// For each piece the first with the same triangles, or if that has no area, the first that has one.
std::vector<std::size_t> chartedPieces(const Level& level, std::span<const UnwrapPiece> pieces)
{
	std::vector<std::size_t> charted(pieces.size());
	std::vector<double> areas(pieces.size(), 0.0); // of the charted ones
	for (std::size_t p = 0; p < pieces.size(); ++p)
	{
		const std::size_t first = std::min(pieces[p].like, p);
		charted[first] = areas[first] > 0.0 ? charted[first] : p;
		for (std::size_t i = 0; charted[first] == p && i < pieces[p].triangles.size(); ++i)
		{
			areas[first] += glm::length(twiceAreaOf(level, pieces[p].triangles[i]));
		}
	}
	for (std::size_t p = pieces.size(); p-- > 0;)
	{
		charted[p] = charted[std::min(pieces[p].like, p)];
	}
	return charted;
}

} // namespace

ChartedLevel chartLevel(const Level& level, std::span<const UnwrapPiece> pieces, const RunSettings& run)
{
	const ProgressCounter stage(run.progress, "charts");
	ChartedLevel made;
	const std::vector<std::size_t> charted = chartedPieces(level, pieces);
	const std::vector<Chart> charts = chartsOf(level, pieces, charted, run.threads);
	std::vector<std::size_t> first_of{0}; // triangle of each piece with charts of its own
	for (std::size_t p = 0; p < pieces.size(); ++p)
	{
		first_of.push_back(first_of.back() + (charted[p] == p ? pieces[p].triangles.size() : 0));
	}
	std::vector<std::pair<uint32_t, uint32_t>> chart_of(first_of.back(), {kNoIndex, 0}); // and the number in it
	std::vector<std::vector<uint32_t>> of_piece(pieces.size());
	made.flat = mapped(charts, [](const Chart& chart) { return chart.flat; });
	for (uint32_t c = 0; c < charts.size(); ++c)
	{
		for (uint32_t i = 0; i < charts[c].triangles.size(); ++i)
		{
			chart_of[charts[c].triangles[i]] = {c, i};
		}
		const auto next = std::upper_bound(first_of.begin(), first_of.end(), charts[c].triangles[0]);
		of_piece[static_cast<std::size_t>(next - first_of.begin()) - 1].push_back(c);
	}
	for (std::size_t p = 0; p < pieces.size(); ++p)
	{
		const std::size_t from = charted[p];
		std::unordered_map<uint32_t, uint32_t> placed; // chart → index into `scaled`
		for (const uint32_t c : of_piece[from])
		{
			const double there =
				sumOver(charts[c].triangles, [&](const uint32_t t)
						{ return 0.5 * glm::length(twiceAreaOf(level, pieces[p].triangles[t - first_of[from]])); });
			if (there > 0.0 && there < kFarthest_m * kFarthest_m)
			{
				placed[c] = static_cast<uint32_t>(made.scaled.size());
				made.scaled.push_back({c, std::sqrt(there / charts[c].area)});
				made.areas_m2.push_back(there);
				made.stretches.push_back(charts[c].stretch * there / charts[c].area);
			}
		}
		for (std::size_t i = 0; i < pieces[p].triangles.size(); ++i)
		{
			const auto [chart, number] = chart_of[first_of[from] + i];
			const auto found = placed.find(chart);
			made.of_triangle.push_back(found == placed.end() ? kNoIndex : found->second);
			made.number.push_back(number);
		}
	}
	refuseInputIf(made.scaled.empty(), level.name + ": unwrap", "no triangle with an area", "a surface");
	return made;
}

Unwrapped packLevel(const Level& level, std::span<const UnwrapPiece> pieces, const ChartedLevel& charted,
					std::span<const double> densities, const UnwrapSettings& settings, const RunSettings& run)
{
	assert(settings.texel_m > 0.0 || settings.size_px > 0);
	const ProgressCounter stage(run.progress, "pages");
	Unwrapped made;
	std::vector<ScaledChart> packed;
	std::vector<uint32_t> place_of(charted.scaled.size(), kNoIndex); // index into `packed`
	double area = 0.0;
	double stretch = 0.0;
	for (std::size_t i = 0; i < charted.scaled.size(); ++i)
	{
		const double density = densities.empty() ? 1.0 : densities[i];
		if (density > 0.0)
		{
			place_of[i] = static_cast<uint32_t>(packed.size());
			packed.push_back({charted.scaled[i].chart, density * charted.scaled[i].scale});
			area += charted.areas_m2[i] * density * density;
			stretch += charted.stretches[i] * density * density;
		}
	}
	std::vector<ChartPlace> places;
	if (!packed.empty())
	{
		places = place(charted.flat, packed, settings, run.threads, made, level.name);
		made.stretch = std::sqrt(stretch / area);
	}
	made.charts = packed.size();
	for (const ChartPlace& one : places)
	{
		made.pages = std::max<std::size_t>(made.pages, one.page + std::size_t{1});
	}
	const double across = made.texel_m * made.size_px;
	made.coverage = packed.empty() ? 0.0 : area / (static_cast<double>(made.pages) * across * across);
	made.level.name = level.name;
	made.level.material_list = level.material_list;
	std::unordered_map<uint64_t, uint32_t> known; // vertices by their chart's vertex and the level's
	uint32_t first = 0;
	std::vector<uint32_t> first_point(packed.size());
	for (std::size_t i = 0; i < packed.size(); ++i)
	{
		first_point[i] = first;
		first += static_cast<uint32_t>(charted.flat[packed[i].chart].points.size());
	}
	std::size_t next = 0;
	for (const UnwrapPiece& piece : pieces)
	{
		known.clear();
		for (const uint32_t t : piece.triangles)
		{
			const uint32_t scaled = charted.of_triangle[next];
			const uint32_t at_page = scaled == kNoIndex ? kNoIndex : place_of[scaled];
			const bool none = at_page == kNoIndex;
			const glm::uvec3 corners = level.triangles[t];
			glm::uvec3 triangle(0);
			for (int k = 0; k < 3; ++k)
			{
				const FlatChart* const chart = none ? nullptr : &charted.flat[packed[at_page].chart];
				const uint32_t point = none ? 0 : chart->triangles[charted.number[next]][k];
				const uint64_t key = none ? kNoIndex : first_point[at_page] + point;
				const auto [at, is_new] =
					known.try_emplace(key << 32U | corners[k], static_cast<uint32_t>(made.level.positions.size()));
				if (is_new)
				{
					made.level.positions.push_back(level.positions[corners[k]]);
					made.level.normals.push_back(level.normals[corners[k]]);
					made.level.uvs.push_back(
						none ? glm::vec2(0.0F)
							 : glm::vec2(places[at_page].at(chart->points[point]) / static_cast<double>(made.size_px)));
				}
				triangle[k] = at->second;
			}
			made.level.triangles.push_back(triangle);
			made.level.materials.push_back(level.materials[t]);
			made.page_of.push_back(none ? kNoPage : places[at_page].page);
			next += 1;
		}
	}
	made.level.meshes.push_back({level.name, 0, made.level.triangles.size()});
	return made;
}

Unwrapped unwrap(const Level& level, std::span<const UnwrapPiece> pieces, const UnwrapSettings& settings, const RunSettings& run)
{
	return packLevel(level, pieces, chartLevel(level, pieces, run), {}, settings, run);
}

std::vector<UnwrapPiece> piecesOf(std::span<const GltfPlace> places)
{
	std::map<std::tuple<std::size_t, std::size_t, bool>, std::size_t> known;
	std::vector<UnwrapPiece> pieces;
	for (const GltfPlace& place : places)
	{
		const auto [at, is_new] = known.try_emplace({place.mesh, place.primitive, place.mirrored}, pieces.size());
		pieces.push_back({place.triangles, is_new ? SIZE_MAX : at->second});
	}
	return pieces;
}

std::vector<TextureBake> bakePages(const Tracer& tracer, const Unwrapped& unwrapped, BakeSettings settings, const RunSettings& run)
{
	const auto partWith = [&](const auto& isWanted)
	{
		return partOf(unwrapped.level, mapped(unwrapped.page_of, [&](uint32_t page) { return uint8_t{isWanted(page)}; }),
					  run.threads);
	};
	std::vector<TextureBake> pages;
	for (std::size_t page = 0; page < unwrapped.pages; ++page)
	{
		const LevelPart part = partWith([page](uint32_t of) { return of == page; });
		settings.receivers = &part.level;
		pages.push_back(bakeTexture(tracer, part.level.uvs, unwrapped.size_px, settings, run));
	}
	const LevelPart textured = partWith([](uint32_t of) { return of != kNoPage; });
	std::vector<uint32_t> page_of = unwrapped.page_of;
	std::erase(page_of, kNoPage);
	finishTextures(textured.level, textured.level.uvs, page_of, pages, run.threads);
	return pages;
}

std::vector<GltfCharts> chartsOf(std::span<const GltfPlace> places, const Unwrapped& unwrapped, bool with_rest)
{
	std::vector<GltfCharts> charts;
	std::vector<uint32_t> number(unwrapped.level.positions.size(), kNoIndex); // in the primitive, or among the copies
	std::size_t triangle = 0;
	for (const GltfPlace& place : places)
	{
		GltfCharts& made = charts.emplace_back();
		made.uvs.resize(with_rest ? 0 : place.count, glm::vec2(0.0F));
		made.pages.resize(unwrapped.pages);
		made.page_vertices.resize(with_rest ? unwrapped.pages : 0);
		std::vector<bool> is_taken(place.count, with_rest); // by a chart
		std::size_t page = 0;
		for (const glm::uvec3 file : place.corners)
		{
			const glm::uvec3 corner = unwrapped.level.triangles[triangle];
			const bool is_flat = unwrapped.page_of[triangle] == kNoPage;
			page = is_flat ? page : unwrapped.page_of[triangle];
			triangle += 1;
			const bool rests = with_rest && is_flat;
			for (int k = 0; k < 3; ++k)
			{
				const uint32_t v = corner[place.mirrored ? (3 - k) % 3 : k];
				if (number[v] == kNoIndex)
				{
					const bool is_copied = !rests && is_taken[file[k]];
					number[v] = is_copied ? static_cast<uint32_t>(made.uvs.size()) : file[k];
					if (is_copied)
					{
						made.copied.emplace_back(file[k], file[k]);
						made.uvs.emplace_back();
					}
					if (with_rest)
					{
						(rests ? made.rest_vertices : made.page_vertices[page]).emplace_back(number[v], v);
					}
					if (!rests)
					{
						is_taken[file[k]] = true;
						made.uvs[number[v]] = unwrapped.level.uvs[v];
					}
				}
				(rests ? made.rest : made.pages[page]).push_back(number[v]);
			}
		}
	}
	return charts;
}

} // namespace nook
