// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: H. Everett, "Generalized Lagrange Multiplier Method for Solving Problems of Optimum Allocation of
// Resources", 1963: each chart minimises error + λ bytes by itself; λ follows from the budget.
#include "bake/auto.h"

#include "bake/surface_samples.h"
#include "core/lists.h"
#include "core/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

constexpr int kTrialRays = 64;         // per texel of the trial
constexpr double kTrialTexels = 2e6;   // most of the trial
constexpr int kCoarsest = -2;          // texels of a chart: those of the trial, times 2^-k
constexpr int kFinest = 3;             // a 32nd of the radius, as the shortest edges of --max-error
constexpr int kVertices = kFinest + 1; // no texture
constexpr double kOrder = 1.5;         // the squared error falls with the texel size to that power; measured on furnished rooms
constexpr double kLeastSquare = 1e-5;  // of a texture: 8 bits and rays
constexpr double kWorthATry = 1e-4;    // squared error at the vertices
constexpr int kPage_px = 4096;
constexpr double kTexelsOfPage = 8e6; // half of it
constexpr int kTries = 6;
constexpr double kEnough = 1.02;       // of the error asked for, or of the least
constexpr double kPointsOfTexel = 4.0; // to measure errors, per texel of the trial
constexpr double kFewestPoints = 262144.0;
constexpr double kMostPoints = 1048576.0;
constexpr uint32_t kOther = 0x5eed0ffeU; // a sequence that neither the fit nor the check uses
constexpr std::size_t kCheckPoints = 4096;
constexpr std::size_t kShort = 65535; // vertices of 16-bit indices

// Measurements of a chart.
struct ChartFacts
{
	double weight = 0.0;      // points on its front
	double at_vertices = 0.0; // mean squared error of the front
	double in_texture = 0.0;  // mean squared error at texels of the trial's size
	double area_m2 = 0.0;
	double across_m = 0.0; // its longer side
	std::size_t piece = 0;
	std::size_t triangles = 0;
	std::size_t vertices = 0;
	bool is_open = false; // may have a texture
};

struct Choice
{
	std::vector<int> levels; // per chart
	double bytes = 0.0;      // more than with values alone
	double square = 0.0;     // sum of squared errors over the area
	bool is_short = false;   // no choice has as little error as was asked for
};

class Chooser
{
public:
	Chooser(const Tracer& tracer, const Level& level, std::span<const UnwrapPiece> pieces, std::span<const AutoPiece> costs,
			std::span<const uint8_t> turned, const BakeSettings& settings, const AutoSettings& wanted, const RunSettings& run)
		: m_tracer(tracer), m_level(level), m_pieces(pieces), m_costs(costs), m_settings(settings), m_wanted(wanted), m_run(run),
		  m_charted(chartLevel(level, pieces, run)), m_charts(m_charted.scaled.size())
	{
		for (std::size_t p = 0, t = 0; p < pieces.size(); ++p)
		{
			for (std::size_t i = 0; i < pieces[p].triangles.size(); ++i, ++t)
			{
				if (const uint32_t chart = m_charted.of_triangle[t]; chart != kNoIndex)
				{
					m_charts[chart].piece = p;
					m_charts[chart].triangles += 1;
					m_charts[chart].is_open = costs[p].takes_texture &&
											  (m_charts[chart].triangles == 1 || m_charts[chart].is_open) &&
											  (turned.empty() || turned[t] == 0);
				}
			}
		}
		for (std::size_t c = 0; c < m_charts.size(); ++c)
		{
			const FlatChart& flat = m_charted.flat[m_charted.scaled[c].chart];
			m_charts[c].area_m2 = m_charted.areas_m2[c];
			m_charts[c].across_m = m_charted.scaled[c].scale * std::max(flat.size.x, flat.size.y);
			m_charts[c].vertices = flat.points.size();
		}
	}

	AutoBake run(const std::function<std::size_t(const AutoBake&)>& bytesOf)
	{
		sample();
		AutoBake none = bakeAt(std::vector<int>(m_charts.size(), kVertices), m_settings.rays);
		none.bytes = bytesOf(none);
		measureVertices(none);
		AutoBake best = std::move(none);
		const std::size_t base = best.bytes;
		const bool is_enough = m_wanted.bytes == 0 && best.expected_rmse <= m_wanted.rmse;
		if (!is_enough && tryTexture())
		{
			const bool by_bytes = m_wanted.bytes > 0;
			const double limit = by_bytes ? static_cast<double>(m_wanted.bytes - std::min(m_wanted.bytes, base)) : m_wanted.rmse;
			double aim = limit;
			for (int i = 0; i < kTries; ++i)
			{
				const Choice choice = choose(aim);
				if (std::all_of(choice.levels.begin(), choice.levels.end(), [](int level) { return level == kVertices; }))
				{
					break;
				}
				AutoBake made = bakeAt(choice.levels, m_settings.rays);
				made.bytes = bytesOf(made);
				const auto added = static_cast<double>(made.bytes - std::min(base, made.bytes));
				measureTextures(made, choice);
				m_texel_bytes = std::max(0.05, m_texel_bytes * (1.0 + (added - choice.bytes) / std::max(1.0, texelBytes(choice))));
				const bool fits = by_bytes ? made.bytes <= m_wanted.bytes : made.expected_rmse <= kEnough * limit;
				const bool is_last = (fits && (!by_bytes || added > 0.85 * limit || i > 1)) || (choice.is_short && i > 0);
				aim = fits ? limit : 0.96 * (i > 1 ? aim : limit);
				if ((fits || !by_bytes) && made.expected_rmse < best.expected_rmse)
				{
					best = std::move(made);
				}
				if (is_last)
				{
					break;
				}
			}
		}
		best.value_bytes = base;
		best.is_short = m_wanted.bytes == 0 && best.expected_rmse > kEnough * m_wanted.rmse;
		check(best);
		return best;
	}

private:
	// Levels of detail → a packed level, whose textures are not baked: one page, or several if there are many texels.
	Unwrapped pack(const std::vector<int>& levels) const
	{
		double texels = 0.0;
		std::vector<double> densities;
		for (std::size_t c = 0; c < levels.size(); ++c)
		{
			densities.push_back(levels[c] == kVertices ? 0.0 : std::exp2(static_cast<double>(levels[c])));
			texels += levels[c] == kVertices ? 0.0 : texelsOf(m_charts[c], levels[c]);
		}
		UnwrapSettings settings{m_trial_m, 0, 1, m_wanted.margin_px};
		if (texels > kTexelsOfPage)
		{
			settings.size_px = kPage_px;
			settings.pages = static_cast<std::size_t>(4.0 * texels / kTexelsOfPage);
		}
		return packLevel(m_level, m_pieces, m_charted, densities, settings, m_run);
	}

	// Points for the fit, as many as for values at the vertices, and others to measure the error of its result.
	void sample()
	{
		const Level level = pack(std::vector<int>(m_charts.size(), kVertices)).level;
		m_areas = areasOf(level);
		const double all_m2 = sumOver(m_areas);
		const double across_m = glm::distance(m_tracer.bounds().least, m_tracer.bounds().most);
		m_trial_m = std::max(std::isfinite(m_settings.radius_m) ? 0.25 * m_settings.radius_m : across_m / 512.0,
							 std::sqrt(all_m2 / kTrialTexels));
		const int rays = std::min(m_settings.rays, kRaysOfPoint);
		const auto unknowns = static_cast<double>(unknownsOf(level, m_settings.sides).count);
		const auto count = static_cast<std::size_t>(std::ceil(unknowns * m_settings.rays / rays));
		m_samples = SamplePlaces(level, samplesOfTriangles(m_areas, count), m_settings.seed).all();
		traceSamples(m_tracer, level, m_samples, m_settings, rays, m_settings.seed, m_run, "rays");
		const double points = std::clamp(kPointsOfTexel * all_m2 / (m_trial_m * m_trial_m), kFewestPoints, kMostPoints);
		m_points = placeByArea(level, m_areas, static_cast<std::size_t>(points), m_settings.seed ^ kOther);
		traceSamples(m_tracer, level, m_points, m_settings, kRaysOfPoint, m_settings.seed ^ kOther, m_run, "rays");
		m_rays = m_samples.size() * static_cast<std::size_t>(rays) + m_points.size() * std::size_t{kRaysOfPoint};
		std::erase_if(m_points, [](const SurfaceSample& point) { return point.buried || point.shut; });
	}

	// Is it on the side that gets a texture?
	bool isFront(const SurfaceSample& sample) const
	{
		return !sample.back || m_wanted.one_side;
	}

	bool isTextured(const AutoBake& bake, const SurfaceSample& sample) const
	{
		return isFront(sample) && bake.unwrapped.page_of[sample.triangle] != kNoPage;
	}

	// Bakes a choice: textures, and values at the vertices of the rest.
	AutoBake bakeAt(const std::vector<int>& levels, int rays)
	{
		AutoBake made;
		made.unwrapped = pack(levels);
		const Level& level = made.unwrapped.level;
		if (made.unwrapped.charts > 0)
		{
			BakeSettings settings = m_settings;
			settings.rays = rays;
			made.pages = bakePages(m_tracer, made.unwrapped, settings, m_run);
		}
		const Unknowns unknowns = unknownsOf(level, m_settings.sides);
		std::vector<SurfaceSample> samples = m_samples;
		for (SurfaceSample& sample : samples)
		{
			sample.shut = sample.shut || isTextured(made, sample); // nearly without weight
		}
		const ProgressCounter stage(m_run.progress, "fit");
		take(made.vertices, level, unknowns, fitValues(level, m_areas, unknowns, samples, m_settings));
		made.vertices.unknowns = unknowns.count;
		made.vertices.points = m_samples.size();
		made.vertices.rays = m_rays + sumOver(made.pages, [](const TextureBake& page) { return page.rays; });
		countUnseen(m_samples, made.vertices);
		for (std::size_t t = 0; t < level.triangles.size(); ++t)
		{
			for (int k = 0; made.unwrapped.page_of[t] != kNoPage && k < 3; ++k)
			{
				made.vertices.visibility[level.triangles[t][k]] = 1.0F;
			}
		}
		return made;
	}

	double valueAt(const AutoBake& bake, std::span<const Mask> masks, const SurfaceSample& sample) const
	{
		const Level& level = bake.unwrapped.level;
		const glm::uvec3 triangle = level.triangles[sample.triangle];
		if (isTextured(bake, sample))
		{
			return alphaAt(masks[bake.unwrapped.page_of[sample.triangle]],
						   glm::dvec2(interpolated(level.uvs, triangle, sample.b, sample.c)));
		}
		const bool back = sample.back && !bake.vertices.back.empty();
		return static_cast<double>(
			interpolated(back ? bake.vertices.back : bake.vertices.visibility, triangle, sample.b, sample.c));
	}

	// Sums of the points' squared errors without the rays' noise: of the fronts of each chart, and of all.
	double squaresOf(const AutoBake& bake, std::vector<double>& of_chart) const
	{
		const std::vector<Mask> masks = masksOf(bake.pages);
		of_chart.assign(m_charts.size(), 0.0);
		double all = 0.0;
		for (const SurfaceSample& point : m_points)
		{
			const double off = valueAt(bake, masks, point) - static_cast<double>(point.visibility);
			const auto unsure = static_cast<double>(point.standard_error);
			all += off * off - unsure * unsure;
			if (const uint32_t chart = m_charted.of_triangle[point.triangle]; chart != kNoIndex && isFront(point))
			{
				of_chart[chart] += off * off - unsure * unsure;
			}
		}
		return all;
	}

	double weight() const
	{
		return static_cast<double>(std::max<std::size_t>(m_points.size(), 1));
	}

	void setExpected(AutoBake& bake, double square) const
	{
		bake.expected_rmse = std::sqrt(std::max(0.0, square) / weight());
	}

	void measureVertices(AutoBake& none)
	{
		std::vector<double> of_chart;
		m_square = squaresOf(none, of_chart);
		setExpected(none, m_square);
		for (const SurfaceSample& point : m_points)
		{
			if (const uint32_t chart = m_charted.of_triangle[point.triangle]; chart != kNoIndex && isFront(point))
			{
				m_charts[chart].weight += 1.0;
			}
		}
		for (std::size_t c = 0; c < m_charts.size(); ++c)
		{
			ChartFacts& chart = m_charts[c];
			chart.at_vertices = chart.weight > 0.0 ? std::max(0.0, of_chart[c] / chart.weight) : 0.0;
			chart.is_open = chart.is_open && chart.at_vertices > kWorthATry && fitsPage(chart, 0);
		}
	}

	// Bakes all charts that may gain, with few rays, to see how far a texture is from them. False if there are none.
	bool tryTexture()
	{
		const std::vector<int> levels = mapped(m_charts, [](const ChartFacts& chart) { return chart.is_open ? 0 : kVertices; });
		if (std::all_of(levels.begin(), levels.end(), [](int level) { return level == kVertices; }))
		{
			return false;
		}
		AutoBake trial = bakeAt(levels, std::min(kTrialRays, m_settings.rays));
		measureTextures(trial, {levels, 0.0, 0.0});
		const double texels = sumOver(m_charts, [&](const ChartFacts& chart) { return chart.is_open ? texelsOf(chart, 0) : 0.0; });
		m_texel_bytes = static_cast<double>(
							sumOver(trial.pages, [](const TextureBake& page) { return textureFile(page, ".png", "").size(); })) /
						texels;
		return true;
	}

	// Reads the errors of a bake's textures as those of the trial's texels.
	void measureTextures(AutoBake& bake, const Choice& choice)
	{
		std::vector<double> of_chart;
		setExpected(bake, squaresOf(bake, of_chart));
		for (std::size_t c = 0; c < m_charts.size(); ++c)
		{
			if (choice.levels[c] <= kFinest && m_charts[c].weight > 0.0)
			{
				m_charts[c].in_texture =
					std::max(kLeastSquare, of_chart[c] / m_charts[c].weight) * std::exp2(kOrder * choice.levels[c]);
			}
		}
	}

	double texelsOf(const ChartFacts& chart, int level) const
	{
		const double across = std::sqrt(chart.area_m2) / m_trial_m * std::exp2(static_cast<double>(level)) + m_wanted.margin_px;
		return across * across;
	}

	bool fitsPage(const ChartFacts& chart, int level) const
	{
		const int margins = 2 * (m_wanted.margin_px + 1);
		return chart.across_m / m_trial_m * std::exp2(static_cast<double>(level)) + margins <= static_cast<double>(kPage_px);
	}

	double texelBytes(const Choice& choice) const
	{
		double bytes = 0.0;
		for (std::size_t c = 0; c < m_charts.size(); ++c)
		{
			bytes += choice.levels[c] <= kFinest ? m_texel_bytes * texelsOf(m_charts[c], choice.levels[c]) : 0.0;
		}
		return bytes;
	}

	// Minimises error + price · bytes.
	Choice chooseAt(double price) const
	{
		Choice choice{std::vector<int>(m_charts.size(), kVertices), 0.0, m_square};
		struct Piece
		{
			double gain = 0.0;
			double bytes = 0.0;
			double square = 0.0;
			std::vector<std::size_t> charts;
		};
		std::vector<Piece> pieces(m_pieces.size());
		for (std::size_t c = 0; c < m_charts.size(); ++c)
		{
			const ChartFacts& chart = m_charts[c];
			const GltfCost& cost = m_costs[chart.piece].cost;
			Piece& piece = pieces[chart.piece];
			double best = 0.0;
			double bytes = 0.0;
			double square = 0.0;
			for (int level = kCoarsest; chart.is_open && level <= kFinest && fitsPage(chart, level); ++level)
			{
				const double here = static_cast<double>(chart.vertices * (cost.vertex_bytes + 4) + 6 * chart.triangles) +
									m_texel_bytes * texelsOf(chart, level);
				const double saved =
					chart.weight * (chart.at_vertices - std::max(kLeastSquare, chart.in_texture * std::exp2(-kOrder * level)));
				if (saved - price * here > best)
				{
					best = saved - price * here;
					bytes = here;
					square = saved;
					choice.levels[c] = level;
				}
			}
			if (best > 0.0)
			{
				piece.gain += best;
				piece.bytes += bytes;
				piece.square += square;
				piece.charts.push_back(c);
			}
		}
		for (std::size_t p = 0, first = 0; p < pieces.size(); first += m_pieces[p].triangles.size(), ++p)
		{
			const double rest = pieces[p].charts.empty() ? 0.0 : restBytes(p, first, choice);
			if (pieces[p].gain <= price * rest)
			{
				for (const std::size_t c : pieces[p].charts)
				{
					choice.levels[c] = kVertices;
				}
				continue;
			}
			choice.bytes += pieces[p].bytes + rest;
			choice.square -= pieces[p].square;
		}
		return choice;
	}

	// Indices of a piece's triangles that keep values, of which `first` is the number of the piece's first.
	double restBytes(std::size_t piece, std::size_t first, const Choice& choice) const
	{
		const std::vector<bool> rests = listOf(m_pieces[piece].triangles.size(),
											   [&](std::size_t i)
											   {
												   const uint32_t chart = m_charted.of_triangle[first + i];
												   return chart == kNoIndex || choice.levels[chart] == kVertices;
											   });
		const std::size_t count = m_costs[piece].cost.has_list ? runsOf(rests).others.size() : rests.size();
		return static_cast<double>(count) * (m_costs[piece].vertices <= kShort ? 6.0 : 12.0);
	}

	double rmseOf(const Choice& choice) const
	{
		return std::sqrt(std::max(0.0, choice.square) / weight());
	}

	// The price at which the choice fits: bytes, or the error. An error that no price reaches is replaced by one close to the
	// least.
	Choice choose(double aim) const
	{
		constexpr double kLowest = -60.0;
		const double least = m_wanted.bytes > 0 ? 0.0 : kEnough * rmseOf(chooseAt(std::exp2(kLowest) * weight()));
		const bool is_short = aim < least;
		aim = std::max(aim, least);
		double low = 0.0; // its logarithm: too many bytes, or as little error
		double high = 0.0;
		const auto fits = [&](double price)
		{
			const Choice choice = chooseAt(std::exp2(price) * weight());
			return m_wanted.bytes > 0 ? choice.bytes <= aim : rmseOf(choice) > aim;
		};
		low = kLowest;
		for (int i = 0; i < 40; ++i)
		{
			const double middle = 0.5 * (low + high);
			(fits(middle) ? high : low) = middle;
		}
		Choice choice = chooseAt(std::exp2(m_wanted.bytes > 0 ? high : low) * weight());
		choice.is_short = is_short;
		return choice;
	}

	// Errors of the result at other points, of all and of each kind.
	void check(AutoBake& bake)
	{
		const std::vector<Mask> masks = masksOf(bake.pages);
		std::array<double, 2> squares{};
		std::array<double, 2> counts{};
		const auto valueOf = [&](const SurfaceSample& sample)
		{
			const double value = valueAt(bake, masks, sample);
			const double off = value - static_cast<double>(sample.visibility);
			const std::size_t kind = isTextured(bake, sample) ? 0 : 1;
			squares[kind] += off * off;
			counts[kind] += 1.0;
			return value;
		};
		bake.check = checkValues(m_tracer, bake.unwrapped.level, valueOf, m_settings, kCheckPoints, m_run);
		bake.textured.rmse = std::sqrt(squares[0] / std::max(counts[0], 1.0));
		bake.at_vertices.rmse = std::sqrt(squares[1] / std::max(counts[1], 1.0));
		for (std::size_t t = 0; t < m_areas.size(); ++t)
		{
			AutoShare& share = bake.unwrapped.page_of[t] == kNoPage ? bake.at_vertices : bake.textured;
			share.triangles += 1;
			share.area_m2 += m_areas[t];
		}
	}

	const Tracer& m_tracer;
	const Level& m_level;
	std::span<const UnwrapPiece> m_pieces;
	std::span<const AutoPiece> m_costs;
	const BakeSettings& m_settings;
	const AutoSettings& m_wanted;
	const RunSettings& m_run;
	ChartedLevel m_charted;
	std::vector<ChartFacts> m_charts;
	std::vector<double> m_areas;
	std::vector<SurfaceSample> m_samples;
	std::vector<SurfaceSample> m_points; // those that count
	double m_square = 0.0;               // sum of squared errors with values alone
	double m_trial_m = 1.0;
	double m_texel_bytes = 0.5;
	std::size_t m_rays = 0;
};

} // namespace

AutoBake bakeAuto(const Tracer& tracer, const Level& level, std::span<const UnwrapPiece> pieces, std::span<const AutoPiece> costs,
				  std::span<const uint8_t> turned, const BakeSettings& settings, const AutoSettings& wanted,
				  const std::function<std::size_t(const AutoBake&)>& bytesOf, const RunSettings& run)
{
	assert((wanted.rmse > 0.0) != (wanted.bytes > 0));
	return Chooser(tracer, level, pieces, costs, turned, settings, wanted, run).run(bytesOf);
}

} // namespace nook
