// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/texture.h"

#include "bake/charts.h"
#include "bake/surface_samples.h"
#include "bake/texture_fill.h"
#include "core/error.h"
#include "core/number.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

constexpr int kRowsAtOnce = 64;
constexpr std::size_t kSamplesOfTexel = std::size_t{kSamplesAcross} * kSamplesAcross;
constexpr std::size_t kRayedOfTexel = 4; // samples that get rays, of those of a texel: enough of both for a soft edge

[[noreturn]] void refuseUvs(const Level& level, const std::string& found, const std::string& expected)
{
	throw Error(ExitCode::invalid_input, level.name + ": texture coordinates: found " + found + ", expected " + expected);
}

void checkUvs(const Level& level, std::span<const glm::vec2> uvs)
{
	glm::vec2 least(1e30F);
	glm::vec2 most(-1e30F);
	std::size_t flat = 0;
	for (const glm::uvec3& t : level.triangles)
	{
		for (int corner = 0; corner < 3; ++corner)
		{
			const glm::vec2 uv = uvs[t[corner]];
			if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
			{
				refuseUvs(level, "none at some vertices", "a set for all of them");
			}
			least = glm::min(least, uv);
			most = glm::max(most, uv);
		}
		flat += uvs[t.x] == uvs[t.y] || uvs[t.y] == uvs[t.z] || uvs[t.z] == uvs[t.x] ? 1U : 0U;
	}
	if (least == most)
	{
		refuseUvs(level, "none", "a set of their own for the texture, in a format that has them");
	}
	constexpr float kRounding = 1e-5F;
	if (least.x < -kRounding || least.y < -kRounding || most.x > 1.0F + kRounding || most.y > 1.0F + kRounding)
	{
		const auto text = [](float value)
		{
			return numberText(static_cast<double>(value));
		};
		refuseUvs(level, "some from (" + text(least.x) + ", " + text(least.y) + ") to (" + text(most.x) + ", " + text(most.y) + ")",
				  "all from 0 to 1");
	}
	if (2 * flat > level.triangles.size())
	{
		refuseUvs(level, std::to_string(flat) + " triangles without an area in the texture", "charts of all triangles");
	}
}

// Samples of one texel that get rays: of its largest chart, spread over what it has of it.
class TexelSamples
{
public:
	TexelSamples(std::span<const uint32_t> owners, std::span<const uint32_t> charts, int size_px)
		: m_owners(owners), m_charts(charts), m_across(static_cast<std::size_t>(kSamplesAcross * size_px))
	{
	}

	// Places in `owners`; `shared` becomes whether there is another chart, too.
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

SurfaceSample sampleAt(const Level& level, std::span<const glm::vec2> uvs, uint32_t triangle, glm::dvec2 uv)
{
	const glm::dvec3 weights = weightsAt(level, uvs, triangle, uv);
	SurfaceSample sample;
	sample.triangle = triangle;
	sample.b = static_cast<float>(std::clamp(weights.y, 0.0, 1.0));
	sample.c = static_cast<float>(std::clamp(weights.z, 0.0, 1.0 - static_cast<double>(sample.b)));
	return sample;
}

// Samples of some rows of texels, in their order, and the texel of each.
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
			all.samples.push_back(sampleAt(level, uvs, owners[place], uv / static_cast<double>(across)));
			all.texel_of.push_back(static_cast<std::size_t>(first) * size + i);
		}
	}
	return all;
}

// The mean of each texel's samples, but for buried ones; adds up the squares of their standard errors.
void addMeans(const RowSamples& all, std::vector<float>& values, TextureBake& bake, double& squares)
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
			values[all.texel_of[begin]] = static_cast<float>(sum / count);
			squares += error / (count * count);
		}
		begin = end;
	}
}

} // namespace

TextureBake bakeTexture(const Tracer& tracer, std::span<const glm::vec2> uvs, int size_px, const BakeSettings& settings,
						const RunSettings& run)
{
	assert(size_px >= kLeastTexture_px && size_px <= kMostTexture_px && uvs.size() == tracer.level().positions.size());
	const Level& level = tracer.level();
	checkUvs(level, uvs);
	TextureBake bake;
	bake.size_px = size_px;
	const std::vector<uint32_t> charts = chartsOf(level, uvs, bake.charts);
	const auto size = static_cast<std::size_t>(size_px);
	const int rays = std::max(1, settings.rays / static_cast<int>(kRayedOfTexel));
	std::vector<float> values(size * size, -1.0F);
	std::vector<uint8_t> hit(level.triangles.size(), 0);
	std::size_t overlaps = 0;
	double squares = 0.0;
	ProgressCounter progress(run.progress, "texels", size);
	for (int first = 0; first < size_px; first += kRowsAtOnce)
	{
		const int rows = std::min(kRowsAtOnce, size_px - first);
		const std::vector<uint32_t> owners = rasterise(level, uvs, size_px, first, rows, overlaps, hit);
		if (overlaps > 0)
		{
			refuseUvs(level, "triangles that overlap in the texture", "a place of its own for each");
		}
		RowSamples all = samplesOf(level, uvs, owners, charts, first, rows, bake);
		const auto seed = settings.seed + static_cast<uint32_t>(first) * 0x9e3779b9U; // another sequence for each block of rows
		traceSamples(tracer, level, all.samples, settings, rays, seed, silentStage(run), "rays");
		bake.rays += all.samples.size() * static_cast<std::size_t>(rays);
		addMeans(all, values, bake, squares);
		progress.finish(static_cast<std::size_t>(rows));
	}
	bake.missed = static_cast<std::size_t>(std::count(hit.begin(), hit.end(), uint8_t{0}));
	bake.standard_error = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(bake.covered - bake.buried, 1)));
	fillEmpty(values, size_px);
	bake.values.reserve(values.size());
	for (const float value : values)
	{
		bake.values.push_back(static_cast<uint8_t>(std::clamp(value, 0.0F, 1.0F) * 255.0F + 0.5F));
	}
	return bake;
}

BakeCheck checkTexture(const Tracer& tracer, std::span<const glm::vec2> uvs, const TextureBake& bake, const BakeSettings& settings,
					   std::size_t points, const RunSettings& run)
{
	Mask mask; // one channel, read as a texture unit reads it
	mask.width_px = bake.size_px;
	mask.height_px = bake.size_px;
	mask.wrap_u = Wrap::clamp;
	mask.wrap_v = Wrap::clamp;
	mask.alpha = bake.values;
	const Level& level = tracer.level();
	const auto valueOf = [&](const SurfaceSample& sample)
	{
		const glm::uvec3 t = level.triangles[sample.triangle];
		const glm::vec2 uv = (1.0F - sample.b - sample.c) * uvs[t.x] + sample.b * uvs[t.y] + sample.c * uvs[t.z];
		return alphaAt(mask, glm::dvec2(uv));
	};
	return checkValues(tracer, level, valueOf, settings, points, run);
}

} // namespace nook
