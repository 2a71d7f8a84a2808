// SPDX-License-Identifier: GPL-3.0-or-later
// A slow twin of slices.glsl with one layer more. It says the same in the same order; see there for papers and reasons.
#include "error_report/second_layer.h"

#include "core/parallel.h"
#include "methods/block.h"
#include "methods/kernels.h"
#include "methods/settings.h"
#include "scene/camera.h"
#include "scene/hit_normal.h"
#include "shade/shade.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

using shade_kernels::Kernels;

// A surface of a kind beyond a distance along a ray; infinity where there is none.
double beyond(const Tracer& tracer, const glm::dvec3& eye, const glm::dvec3& along, double distance, SecondSurface which)
{
	const double length = glm::length(along);
	for (int tries = 0; tries < 64; ++tries)
	{
		const double from = distance + distance * 1e-6 + tracer.error() / length;
		const RayHit hit = tracer.nearest(eye + along * from, along, std::numeric_limits<double>::infinity());
		if (!hit.hit)
		{
			break;
		}
		distance = from + hit.distance;
		if (which == SecondSurface::any || hit.front)
		{
			return distance;
		}
	}
	return std::numeric_limits<double>::infinity();
}

// What a pixel's slices share.
struct Place
{
	glm::ivec2 pixel{};
	glm::vec3 n{};
	glm::vec3 centre{};
	glm::vec3 sight{};
	glm::vec3 v{};
	glm::vec2 scale{};
	float radius = 0.0F;
};

// One slice: nookSlice, a layer after the other.
class Slice
{
public:
	Slice(Kernels& kernels, const Place& place, glm::vec3 o, float jitter)
		: m_kernels(kernels), m_place(place), m_o(o), m_jitter(jitter), m_beside(glm::cross(o, place.v)),
		  m_within(glm::dot(place.n, o), glm::dot(place.n, place.v)), m_square(std::max(glm::dot(m_within, m_within), 1e-4F)),
		  m_aside(glm::dot(place.n, m_beside) / m_square)
	{
		const float facing = std::max(m_within.y, 0.0F);
		const float size = std::max(std::sqrt(m_within.x * m_within.x + facing * facing), 1e-6F);
		m_turn = {m_within.x / size, facing / size, kernels.nookSliceAngle(m_within.x, facing)};
		m_way = glm::vec2(o.x - o.z * place.sight.x, o.y - o.z * place.sight.y) * place.radius;
		const glm::vec2 across = m_way * place.scale;
		m_pixels = std::sqrt(glm::dot(across, across));
	}

	// Covers what `depths` see and no layer before.
	void cover(std::span<const float> depths, float thickness)
	{
		const int steps = m_kernels.nook.steps;
		for (int k = 0; k < 2 * steps; ++k)
		{
			const float side = k % 2 == 0 ? 1.0F : -1.0F;
			const float moved = m_jitter + 0.5F * static_cast<float>(k % 2);
			const float share = (static_cast<float>(k / 2) + moved - std::floor(moved)) / static_cast<float>(steps);
			step(depths, thickness, side, share);
		}
	}

	// The open part and the whole.
	glm::vec2 sum()
	{
		const float whole = std::sqrt(m_square) * (m_turn.y + m_turn.z * m_turn.x);
		return {whole * (1.0F - m_closed / 32.0F), whole};
	}

private:
	void step(std::span<const float> depths, float thickness, float side, float share)
	{
		Kernels& k = m_kernels;
		const float place = k.nookSliceStep(share * share * share, m_pixels);
		const glm::ivec2 wanted = k.nookBeside(m_place.pixel, m_way * (side * place), m_place.scale);
		const glm::ivec2 there = k.nookInside(wanted);
		const float surface = depths[static_cast<std::size_t>(there.y * (k.nook.last.x + 1) + there.x)];
		if (!(surface < NOOK_SKY))
		{
			return;
		}
		const glm::vec3 d = (k.nookPosition(there, surface) - m_place.centre) / m_place.radius;
		const float apart = glm::dot(d, d);
		const float slide = glm::dot(d, m_beside) * m_aside;
		const float x = glm::dot(d, m_o) + slide * m_within.x;
		const float y = glm::dot(d, m_place.v) + slide * m_within.y;
		if (!(apart < 1.0F && x * side > 0.0F))
		{
			return;
		}
		const glm::vec3 away = k.nookPosition(there, 1.0F) - k.nookPosition(there, 0.0F);
		const float thick = thickness * (0.03125F + 0.96875F * std::sqrt(apart)) / std::sqrt(glm::dot(away, away));
		const float front = k.nookSliceShare(x, y, side, m_turn);
		const float back = k.nookSliceShare(x + thick * glm::dot(away, m_o), y + thick * glm::dot(away, m_place.v), side, m_turn);
		const int first = static_cast<int>(std::floor(32.0F * std::min(front, back) + 0.5F));
		const int end = static_cast<int>(std::floor(32.0F * std::max(front, back) + 0.5F));
		const unsigned fresh = k.nookSliceBitsBelow(end) & ~k.nookSliceBitsBelow(first) & ~m_covered;
		m_covered |= fresh;
		const float last = std::max(share - 1.0F / static_cast<float>(k.nook.steps), 0.0F);
		const float before = k.nookSliceStep(last * last * last, m_pixels) / place;
		const float known = there == wanted ? 1.0F : 0.5F;
		const float counts = known * (1.0F - (1.0F + 2.0F * before) / 3.0F * std::sqrt(apart));
		m_closed += static_cast<float>(k.nookSliceBitCount(fresh)) * counts;
	}

	Kernels& m_kernels;
	const Place& m_place;
	glm::vec3 m_o;
	float m_jitter;
	glm::vec3 m_beside;
	glm::vec2 m_within;
	float m_square;
	float m_aside;
	glm::vec3 m_turn{};
	glm::vec2 m_way{};
	float m_pixels = 0.0F;
	unsigned m_covered = 0;
	float m_closed = 0.0F;
};

float visibilityAt(Kernels& k, glm::ivec2 pixel, float depth, std::span<const float> second, const LayersSettings& settings)
{
	Place place;
	place.pixel = pixel;
	place.radius = k.nookRadius(k.nook.radius, depth);
	place.scale = k.nookScale(depth);
	place.n = k.nookNormal(pixel);
	place.centre = k.nookPosition(pixel, depth);
	place.sight = k.nookPosition(pixel, 0.0F) - k.nookPosition(pixel, 1.0F);
	place.v = place.sight / std::sqrt(glm::dot(place.sight, place.sight));
	const glm::vec3 across = k.nookSliceAcross(place.v);
	const glm::vec3 up = glm::cross(place.v, across);
	glm::vec2 sum(0.0F);
	for (int i = 0; i < settings.slices; ++i)
	{
		const glm::vec2 own = k.nookSliceSample(pixel, i);
		const float angle = own.x * 3.14159265F / static_cast<float>(settings.slices);
		Slice slice(k, place, across * std::cos(angle) + up * std::sin(angle), own.y);
		slice.cover(k.depths, static_cast<float>(settings.thickness));
		slice.cover(second, static_cast<float>(settings.second_thickness));
		sum += slice.sum();
	}
	return sum.y > 0.0F ? sum.x / sum.y : 1.0F;
}

} // namespace

std::vector<float> secondDepths(const Tracer& tracer, const GBuffer& gbuffer, SecondSurface which, const RunSettings& run)
{
	const Projector projector(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px);
	const glm::dmat4 world_from_camera = glm::inverse(gbuffer.view.camera_from_world);
	const glm::dmat3 turn_to_world(world_from_camera);
	const auto width = static_cast<std::size_t>(gbuffer.width_px);
	std::vector<float> depths(gbuffer.depth.size(), std::numeric_limits<float>::infinity());
	const auto row = [&](std::size_t y)
	{
		for (std::size_t x = 0; x < width; ++x)
		{
			const auto first = static_cast<double>(gbuffer.depth[y * width + x]);
			if (std::isfinite(first))
			{
				const ViewLine line = projector.lineOf({static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5});
				const glm::dvec3 eye(world_from_camera * glm::dvec4(line.at, 1.0));
				depths[y * width + x] = static_cast<float>(beyond(tracer, eye, turn_to_world * line.along, first, which));
			}
		}
	};
	parallelFor(static_cast<std::size_t>(gbuffer.height_px), run.threads, row);
	return depths;
}

std::vector<float> layersVisibility(const GBuffer& gbuffer, std::span<const float> second, const LayersSettings& settings,
									const RunSettings& run)
{
	ShadeSettings shade;
	shade.method = ShadeMethod::slices;
	shade.radius_m = settings.radius_m;
	shade.slices.count = settings.slices;
	shade.slices.steps = settings.steps;
	const std::vector<float> depths = finiteDepths(gbuffer);
	Kernels kernels;
	kernels.nook = blockOf(frameOf(gbuffer), ownSamples(shade), shade);
	kernels.depths = depths;
	kernels.normals = gbuffer.normals;
	std::vector<float> visibility(gbuffer.depth.size(), 1.0F);
	const auto row = [&](std::size_t i)
	{
		Kernels own = kernels;
		const int y = static_cast<int>(i) * settings.every_px;
		for (int x = 0; x < gbuffer.width_px; x += settings.every_px)
		{
			const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(gbuffer.width_px) + static_cast<std::size_t>(x);
			if (depths[at] < NOOK_SKY)
			{
				visibility[at] = visibilityAt(own, {x, y}, depths[at], second, settings);
			}
		}
	};
	parallelFor(static_cast<std::size_t>((gbuffer.height_px + settings.every_px - 1) / settings.every_px), run.threads, row);
	return visibility;
}

} // namespace nook
