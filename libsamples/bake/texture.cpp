// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/texture.h"

#include "bake/surface_samples.h"
#include "core/decimal.h"
#include "core/image.h"
#include "core/lists.h"
#include "core/words.h"
#include "format/arrays.h"
#include "scene/topology.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace nook
{

namespace
{

constexpr int kRings = 4; // as far as bilinear filters read in the first two mipmaps

void addRing(std::vector<float>& values, int size_px)
{
	const std::vector<float> before = values;
	const auto at = [&](int x, int y)
	{
		return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_px) + static_cast<std::size_t>(x);
	};
	for (int y = 0; y < size_px; ++y)
	{
		for (int x = 0; x < size_px; ++x)
		{
			if (before[at(x, y)] >= 0.0F)
			{
				continue;
			}
			float sum = 0.0F;
			float count = 0.0F;
			for (int v = std::max(0, y - 1); v <= std::min(size_px - 1, y + 1); ++v)
			{
				for (int u = std::max(0, x - 1); u <= std::min(size_px - 1, x + 1); ++u)
				{
					if (before[at(u, v)] >= 0.0F)
					{
						sum += before[at(u, v)];
						count += 1.0F;
					}
				}
			}
			if (count > 0.0F)
			{
				values[at(x, y)] = sum / count;
			}
		}
	}
}

// Averages filled texels 2 × 2 down to one texel; empty texels then take the coarser level's value.
void pull(std::vector<float>& values, int size_px)
{
	if (size_px <= 1)
	{
		values[0] = values[0] < 0.0F ? 1.0F : values[0];
		return;
	}
	const int half = (size_px + 1) / 2;
	std::vector<float> sums(static_cast<std::size_t>(half) * static_cast<std::size_t>(half), 0.0F);
	std::vector<float> counts(sums.size(), 0.0F);
	const auto parentOf = [&](std::size_t i)
	{
		const auto size = static_cast<std::size_t>(size_px);
		return i / size / 2 * static_cast<std::size_t>(half) + i % size / 2;
	};
	for (std::size_t i = 0; i < values.size(); ++i)
	{
		if (values[i] >= 0.0F)
		{
			sums[parentOf(i)] += values[i];
			counts[parentOf(i)] += 1.0F;
		}
	}
	for (std::size_t i = 0; i < sums.size(); ++i)
	{
		sums[i] = counts[i] > 0.0F ? sums[i] / counts[i] : -1.0F;
	}
	pull(sums, half);
	for (std::size_t i = 0; i < values.size(); ++i)
	{
		values[i] = values[i] < 0.0F ? sums[parentOf(i)] : values[i];
	}
}

// In texels: adjacent triangles of a chart overlap only by rounding.
constexpr double kWellInside_px = 0.1;

constexpr uint32_t kNoTriangle = ~uint32_t{0};
constexpr int kSamplesAcross = 4; // per texel, in each direction

// Joins vertices with the same position and coordinates.
void joinVertices(const Level& level, std::span<const glm::vec2> uvs, Groups& groups)
{
	std::vector<uint32_t> order = countingFrom(0U, uvs.size());
	const auto key = [&](uint32_t v)
	{
		const glm::dvec3 p = level.positions[v];
		return std::tuple(uvs[v].x, uvs[v].y, p.x, p.y, p.z);
	};
	std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
	for (std::size_t i = 1; i < order.size(); ++i)
	{
		if (key(order[i]) == key(order[i - 1]))
		{
			groups.join(order[i - 1], order[i]);
		}
	}
}

// Chart number of each triangle, from 0. Triangles that share vertices, or positions with the same coordinates, form one chart.
std::vector<uint32_t> chartsOf(const Level& level, std::span<const glm::vec2> uvs, std::size_t& count)
{
	Groups groups(uvs.size());
	joinVertices(level, uvs, groups);
	for (const glm::uvec3& t : level.triangles)
	{
		groups.join(t.x, t.y);
		groups.join(t.x, t.z);
	}
	std::vector<uint32_t> number(uvs.size(), kNoTriangle);
	std::vector<uint32_t> charts;
	charts.reserve(level.triangles.size());
	count = 0;
	for (const glm::uvec3& t : level.triangles)
	{
		uint32_t& chart = number[groups.rootOf(t.x)];
		if (chart == kNoTriangle)
		{
			chart = static_cast<uint32_t>(count++);
		}
		charts.push_back(chart);
	}
	return charts;
}

// Barycentric weights at a position in the texture; not finite if the triangle has no area there.
glm::dvec3 weightsAt(std::span<const glm::vec2> uvs, const glm::uvec3& triangle, glm::dvec2 uv)
{
	return weightsIn(glm::dvec2(uvs[triangle.x]), glm::dvec2(uvs[triangle.y]), glm::dvec2(uvs[triangle.z]), uv);
}

// Returns the triangle under each texel sample in rows [first_row, first_row + rows), or kNoTriangle: kSamplesAcross × size_px per
// row. Adds to `overlaps` the samples well inside two triangles, and marks in `hit` the triangles that own a sample.
std::vector<uint32_t> rasterise(const Level& level, std::span<const glm::vec2> uvs, int size_px, int first_row, int rows,
								std::size_t& overlaps, std::vector<uint8_t>& hit)
{
	const int across = kSamplesAcross * size_px;
	const int top = kSamplesAcross * first_row;
	const int bottom = top + kSamplesAcross * rows;
	std::vector<uint32_t> owner(static_cast<std::size_t>(across) * static_cast<std::size_t>(bottom - top), kNoTriangle);
	std::vector<uint8_t> well(owner.size(), 0);
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		const glm::uvec3 corner = level.triangles[t];
		const glm::dvec2 a = static_cast<double>(across) * glm::dvec2(uvs[corner.x]);
		const glm::dvec2 b = static_cast<double>(across) * glm::dvec2(uvs[corner.y]);
		const glm::dvec2 c = static_cast<double>(across) * glm::dvec2(uvs[corner.z]);
		const glm::dvec2 least = glm::min(a, glm::min(b, c));
		const glm::dvec2 most = glm::max(a, glm::max(b, c));
		const double twice = std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
		const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
		// Samples are at cell centres; a weight times the height above the opposite edge is at least weight × twice / longest.
		const double well_inside = kSamplesAcross * kWellInside_px * longest / twice;
		const int x0 = std::max(0, static_cast<int>(std::ceil(least.x - 0.5)));
		const int x1 = std::min(across - 1, static_cast<int>(std::floor(most.x - 0.5)));
		const int y0 = std::max(top, static_cast<int>(std::ceil(least.y - 0.5)));
		const int y1 = std::min(bottom - 1, static_cast<int>(std::floor(most.y - 0.5)));
		for (int y = y0; y <= y1; ++y)
		{
			for (int x = x0; x <= x1; ++x)
			{
				const glm::dvec3 weights = weightsAt(uvs, corner, glm::dvec2(x + 0.5, y + 0.5) / static_cast<double>(across));
				const double inside = std::min({weights.x, weights.y, weights.z});
				if (!(inside >= 0.0)) // also rejects NaN
				{
					continue;
				}
				const std::size_t i =
					static_cast<std::size_t>(y - top) * static_cast<std::size_t>(across) + static_cast<std::size_t>(x);
				const bool is_well = inside > well_inside;
				overlaps += is_well && well[i] != 0 ? 1U : 0U;
				hit[t] = 1;
				if (owner[i] == kNoTriangle || (is_well && well[i] == 0))
				{
					owner[i] = static_cast<uint32_t>(t);
				}
				well[i] = is_well ? 1 : well[i];
			}
		}
	}
	return owner;
}

constexpr int kRowsAtOnce = 64;
constexpr std::size_t kSamplesOfTexel = std::size_t{kSamplesAcross} * kSamplesAcross;
constexpr std::size_t kRayedOfTexel = 4; // samples per texel that get rays: enough of both sides for a soft edge

void refuseUvsIf(bool condition, const Level& level, const std::string& found, const std::string& expected)
{
	refuseInputIf(condition, level.name + ": texture coordinates", found, expected);
}

void checkUvs(const Level& level, std::span<const glm::vec2> uvs)
{
	glm::vec2 least(1e30F);
	glm::vec2 most(-1e30F);
	std::size_t flat = 0;
	bool finite = true;
	for (const glm::uvec3& t : level.triangles)
	{
		for (int corner = 0; corner < 3; ++corner)
		{
			const glm::vec2 uv = uvs[t[corner]];
			finite = finite && std::isfinite(uv.x) && std::isfinite(uv.y);
			least = glm::min(least, uv);
			most = glm::max(most, uv);
		}
		flat += uvs[t.x] == uvs[t.y] || uvs[t.y] == uvs[t.z] || uvs[t.z] == uvs[t.x] ? 1U : 0U;
	}
	refuseUvsIf(!finite, level, "none at some vertices", "a set for all of them");
	refuseUvsIf(least == most, level, "none", "a set of their own for the texture, in a format that has them");
	constexpr float kRounding = 1e-5F;
	const auto text = [](float value)
	{
		return numberText(static_cast<double>(value));
	};
	refuseUvsIf(least.x < -kRounding || least.y < -kRounding || most.x > 1.0F + kRounding || most.y > 1.0F + kRounding, level,
				"some from (" + text(least.x) + ", " + text(least.y) + ") to (" + text(most.x) + ", " + text(most.y) + ")",
				"all from 0 to 1");
	refuseUvsIf(2 * flat > level.triangles.size(), level, std::to_string(flat) + " triangles without an area in the texture",
				"charts of all triangles");
}

// The samples of one texel that get rays: in its largest chart, spread over that chart's part of the texel.
class TexelSamples
{
public:
	TexelSamples(std::span<const uint32_t> owners, std::span<const uint32_t> charts, int size_px)
		: m_owners(owners), m_charts(charts), m_across(static_cast<std::size_t>(kSamplesAcross * size_px))
	{
	}

	// Indices into `owners`; sets `shared` if the texel has another chart too.
	std::span<const std::size_t> at(std::size_t x, std::size_t row, bool& shared)
	{
		m_found.clear();
		for (std::size_t i = 0; i < kSamplesOfTexel; ++i)
		{
			const std::size_t place =
				(kSamplesAcross * row + i / kSamplesAcross) * m_across + kSamplesAcross * x + i % kSamplesAcross;
			if (m_owners[place] != kNoTriangle)
			{
				m_found.push_back(place);
			}
		}
		const std::size_t all = m_found.size();
		const uint32_t chart = largestChart();
		std::erase_if(m_found, [&](std::size_t place) { return m_charts[m_owners[place]] != chart; });
		shared = m_found.size() < all;
		const std::size_t kept = std::min(kRayedOfTexel, m_found.size());
		for (std::size_t i = 0; i < kept; ++i)
		{
			m_found[i] = m_found[(2 * i + 1) * m_found.size() / (2 * kept)];
		}
		m_found.resize(kept);
		return m_found;
	}

private:
	uint32_t largestChart() const
	{
		uint32_t best = kNoTriangle;
		std::ptrdiff_t most = 0;
		for (const std::size_t place : m_found)
		{
			const uint32_t chart = m_charts[m_owners[place]];
			const std::ptrdiff_t count = std::count_if(m_found.begin(), m_found.end(),
													   [&](std::size_t other) { return m_charts[m_owners[other]] == chart; });
			if (count > most || (count == most && chart < best))
			{
				best = chart;
				most = count;
			}
		}
		return best;
	}

	std::span<const uint32_t> m_owners;
	std::span<const uint32_t> m_charts;
	std::size_t m_across;
	std::vector<std::size_t> m_found;
};

// Samples of some rows of texels in order, and the texel of each.
struct RowSamples
{
	std::vector<SurfaceSample> samples;
	std::vector<std::size_t> texel_of;
};

RowSamples samplesOf(const Level& level, std::span<const glm::vec2> uvs, std::span<const uint32_t> owners,
					 std::span<const uint32_t> charts, int first, int rows, TextureBake& bake)
{
	const auto size = static_cast<std::size_t>(bake.size_px);
	const auto across = static_cast<std::size_t>(kSamplesAcross) * size;
	TexelSamples texels(owners, charts, bake.size_px);
	RowSamples all;
	for (std::size_t i = 0; i < static_cast<std::size_t>(rows) * size; ++i)
	{
		bool shared = false;
		const std::span<const std::size_t> places = texels.at(i % size, i / size, shared);
		bake.covered += places.empty() ? 0U : 1U;
		bake.shared += shared ? 1U : 0U;
		for (const std::size_t place : places)
		{
			const glm::dvec2 uv(static_cast<double>(place % across) + 0.5,
								static_cast<double>(place / across + static_cast<std::size_t>(kSamplesAcross * first)) + 0.5);
			const glm::dvec3 weights = weightsAt(uvs, level.triangles[owners[place]], uv / static_cast<double>(across));
			SurfaceSample& sample = all.samples.emplace_back();
			sample.triangle = owners[place];
			sample.b = static_cast<float>(std::clamp(weights.y, 0.0, 1.0));
			sample.c = static_cast<float>(std::clamp(weights.z, 0.0, 1.0 - static_cast<double>(sample.b)));
			all.texel_of.push_back(static_cast<std::size_t>(first) * size + i);
		}
	}
	return all;
}

// Averages each texel's samples except buried ones, and accumulates their squared standard errors.
void addMeans(const RowSamples& all, TextureBake& bake, double& squares)
{
	for (std::size_t begin = 0; begin < all.samples.size();)
	{
		double sum = 0.0;
		double error = 0.0;
		double count = 0.0;
		std::size_t end = begin;
		for (; end < all.samples.size() && all.texel_of[end] == all.texel_of[begin]; ++end)
		{
			const SurfaceSample& sample = all.samples[end];
			sum += sample.buried ? 0.0 : static_cast<double>(sample.visibility);
			error += sample.buried ? 0.0 : static_cast<double>(sample.standard_error) * static_cast<double>(sample.standard_error);
			count += sample.buried ? 0.0 : 1.0;
		}
		bake.buried += count == 0.0 ? 1U : 0U;
		if (count > 0.0)
		{
			bake.texels[all.texel_of[begin]] = static_cast<float>(sum / count);
			squares += error / (count * count);
		}
		begin = end;
	}
}

// This work is based on: Khronos Group, "Khronos Data Format Specification 1.3", section 20.4, BC4.

// Blocks of 4 × 4 texels: the greatest and the least value, and which of eight between them each texel has.
std::string blocksOf(const std::vector<float>& texels, std::size_t size)
{
	std::string bytes;
	for (std::size_t i = 0, across = (size + 3) / 4; i < across * across; ++i)
	{
		const auto valueAt = [&](std::size_t j)
		{
			const std::size_t x = std::min(i % across * 4 + j % 4, size - 1);
			const std::size_t y = std::min(i / across * 4 + j / 4, size - 1);
			return 255.0F * std::clamp(texels[y * size + x], 0.0F, 1.0F);
		};
		const std::vector<float> values = listOf(16, valueAt);
		const auto [least, most] = std::minmax_element(values.begin(), values.end());
		const auto low = std::lround(*least);
		const auto high = std::lround(*most);
		auto block = static_cast<uint64_t>(high) | static_cast<uint64_t>(low) << 8U;
		for (std::size_t j = 0; j < values.size() && high > low; ++j)
		{
			const float share = (static_cast<float>(high) - values[j]) / static_cast<float>(high - low);
			const auto step = static_cast<uint64_t>(std::clamp(std::lround(7.0F * share), 0L, 7L));
			block |= (step == 0 ? 0 : step == 7 ? 1 : step + 1) << (16 + 3 * j); // the least is number 1
		}
		for (unsigned shift = 0; shift < 64; shift += 8)
		{
			bytes += static_cast<char>(block >> shift & 255U);
		}
	}
	return bytes;
}

// The next mipmap: each texel is the mean of those that it covers, at least partly.
std::vector<float> halved(const std::vector<float>& texels, std::size_t size)
{
	const std::size_t half = size / 2;
	const auto meanAt = [&](std::size_t i)
	{
		float sum = 0.0F;
		float count = 0.0F;
		for (std::size_t y = i / half * size / half; y * half < (i / half + 1) * size; ++y)
		{
			for (std::size_t x = i % half * size / half; x * half < (i % half + 1) * size; ++x)
			{
				sum += texels[y * size + x];
				count += 1.0F;
			}
		}
		return sum / count;
	};
	return listOf(half * half, meanAt);
}

} // namespace

void fillEmpty(std::vector<float>& values, int size_px)
{
	for (int ring = 0; ring < kRings; ++ring)
	{
		addRing(values, size_px);
	}
	pull(values, size_px);
}

TextureBake bakeTexture(const Tracer& tracer, std::span<const glm::vec2> uvs, int size_px, const BakeSettings& settings,
						const RunSettings& run)
{
	const Level& level = surfaceOf(tracer, settings);
	assert(size_px >= kLeastTexture_px && size_px <= kMostTexture_px && uvs.size() == level.positions.size());
	checkUvs(level, uvs);
	TextureBake bake;
	bake.size_px = size_px;
	const std::vector<uint32_t> charts = chartsOf(level, uvs, bake.charts);
	const auto size = static_cast<std::size_t>(size_px);
	const int rays = std::max(1, settings.rays / static_cast<int>(kRayedOfTexel));
	bake.texels.assign(size * size, -1.0F);
	std::vector<uint8_t> hit(level.triangles.size(), 0);
	std::size_t overlaps = 0;
	double squares = 0.0;
	ProgressCounter progress(run.progress, "texels", size);
	for (int first = 0; first < size_px; first += kRowsAtOnce)
	{
		const int rows = std::min(kRowsAtOnce, size_px - first);
		const std::vector<uint32_t> owners = rasterise(level, uvs, size_px, first, rows, overlaps, hit);
		refuseUvsIf(overlaps > 0, level, "triangles that overlap in the texture", "a place of its own for each");
		RowSamples all = samplesOf(level, uvs, owners, charts, first, rows, bake);
		const auto seed = settings.seed + static_cast<uint32_t>(first) * 0x9e3779b9U; // a different sequence per block of rows
		traceSamples(tracer, level, all.samples, settings, rays, seed, withoutProgress(run), "rays");
		bake.rays += all.samples.size() * static_cast<std::size_t>(rays);
		addMeans(all, bake, squares);
		progress.finish(static_cast<std::size_t>(rows));
	}
	bake.missed = static_cast<std::size_t>(std::count(hit.begin(), hit.end(), uint8_t{0}));
	bake.standard_error = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(bake.covered - bake.buried, 1)));
	return bake;
}

std::vector<Mask> masksOf(std::span<const TextureBake> pages)
{
	return mapped(pages, [](const TextureBake& page)
				  { return Mask{"", page.size_px, page.size_px, Wrap::clamp, Wrap::clamp, page.values, false}; });
}

BakeCheck checkTexture(const Tracer& tracer, std::span<const glm::vec2> uvs, std::span<const TextureBake> pages,
					   std::span<const uint32_t> page_of, const BakeSettings& settings, std::size_t points, const RunSettings& run)
{
	const std::vector<Mask> masks = masksOf(pages);
	const Level& level = surfaceOf(tracer, settings);
	const auto valueOf = [&](const SurfaceSample& sample)
	{
		return alphaAt(masks[page_of.empty() ? 0 : page_of[sample.triangle]],
					   glm::dvec2(interpolated(uvs, level.triangles[sample.triangle], sample.b, sample.c)));
	};
	return checkValues(tracer, level, valueOf, settings, points, run);
}

std::string textureFile(const TextureBake& bake, std::string_view ending, std::string_view writer)
{
	if (ending == ".png")
	{
		return pngBytes(bake.size_px, bake.size_px,
						listOf(3 * bake.values.size(), [&](std::size_t i) { return bake.values[i / 3]; }), {});
	}
	if (ending == ".exr")
	{
		Image image;
		image.width_px = image.height_px = bake.size_px;
		image.channels = {"Y"};
		image.values = bake.texels;
		return exrBytes(std::move(image));
	}
	Ktx2Texture texture;
	texture.texel = Ktx2Texel::bc4_unorm;
	texture.width = texture.height = static_cast<uint32_t>(bake.size_px);
	texture.notes = {{"KTXorientation", "rd"}, {"KTXswizzle", "rrr1"}, {"KTXwriter", std::string(writer)}};
	auto size = static_cast<std::size_t>(bake.size_px);
	texture.bytes = blocksOf(bake.texels, size);
	for (std::vector<float> level = bake.texels; size > 1; size /= 2)
	{
		level = halved(level, size);
		texture.mips.push_back(blocksOf(level, size / 2));
	}
	return ktx2Bytes(texture);
}

} // namespace nook
