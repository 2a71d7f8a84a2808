// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/over_frames.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace nook
{

template <> std::span<const std::string_view> namesOf<Motion>()
{
	static constexpr std::array<std::string_view, 3> kNames{"still", "pan", "walk"};
	return kNames;
}

namespace
{

constexpr double kSameNormal = 0.8; // cosine, 37°
constexpr double kPan_px = 1.5;
constexpr double kWalk_radii = 0.04;

} // namespace

MotionStep stepOf(Motion motion, double radius_m)
{
	return {motion == Motion::pan ? kPan_px : 0.0, motion == Motion::walk ? kWalk_radii * radius_m : 0.0};
}

LevelCamera cameraOfFrame(const LevelCamera& first, const MotionStep& step, int frame, int width_px, int height_px)
{
	LevelCamera camera = first;
	const double pixel = 2.0 / (width_px * viewOf(first, width_px, height_px).projection[0][0]); // radians
	const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), -frame * step.turn_px * pixel, glm::dvec3(0.0, 1.0, 0.0));
	camera.world_from_camera = first.world_from_camera * glm::translate(glm::dmat4(1.0), {frame * step.side_m, 0.0, 0.0}) * turn;
	return camera;
}

namespace
{

// Returns the four texels around a place, in that frame's view space, less those that lie off the plane of the pixel by more than a
// texel's width.
HistoryTexels texelsAt(const GBuffer& before, const Projector& projector, const glm::dvec3& position, const glm::dvec3& normal,
					   double width_m)
{
	HistoryTexels history;
	const glm::dvec2 at = projector.pixelOf(position) - 0.5;
	const glm::dvec2 corner = glm::floor(at + 1e-6);
	const glm::dvec2 share = glm::max(at - corner, 0.0);
	double sum = 0.0;
	for (std::size_t tap = 0; tap < 4; ++tap)
	{
		const glm::dvec2 step(static_cast<double>(tap % 2), static_cast<double>(tap / 2));
		const glm::dvec2 place = corner + step;
		if (!(place.x >= 0.0 && place.y >= 0.0 && place.x < before.width_px && place.y < before.height_px))
		{
			continue;
		}
		const std::size_t from =
			static_cast<std::size_t>(place.y) * static_cast<std::size_t>(before.width_px) + static_cast<std::size_t>(place.x);
		if (!std::isfinite(before.depth[from]))
		{
			continue;
		}
		const glm::dvec3 there = positionOf(before, projector, static_cast<int>(place.x), static_cast<int>(place.y)) - position;
		if (std::fabs(glm::dot(there, normal)) <= width_m && glm::dot(glm::dvec3(before.normals[from]), normal) >= kSameNormal)
		{
			history.texels[tap] = from;
			history.weights[tap] = (step.x > 0.0 ? share.x : 1.0 - share.x) * (step.y > 0.0 ? share.y : 1.0 - share.y);
			sum += history.weights[tap];
		}
	}
	history.any = sum > 1e-3;
	for (double& weight : history.weights)
	{
		weight = history.any ? weight / sum : 0.0;
	}
	return history;
}

} // namespace

std::vector<HistoryTexels> historyOf(const GBuffer& now, const GBuffer& before)
{
	const int width = now.width_px;
	const Projector projector(now.view.projection, width, now.height_px);
	const glm::dmat4 before_from_now = before.view.camera_from_world * glm::inverse(now.view.camera_from_world);
	const Projector before_projector(before.view.projection, width, now.height_px);
	const glm::dmat3 turn(before_from_now);
	const double texel = 2.0 / (width * now.view.projection[0][0]); // at a depth of 1, or at any without perspective
	std::vector<HistoryTexels> history(now.depth.size());
	for (std::size_t i = 0; i < history.size(); ++i)
	{
		if (!std::isfinite(now.depth[i]))
		{
			continue;
		}
		const int x = static_cast<int>(i) % width;
		const int y = static_cast<int>(i) / width;
		const glm::dvec3 position(before_from_now * glm::dvec4(positionOf(now, projector, x, y), 1.0));
		if (position.z < 0.0)
		{
			const double width_m = texel * (now.view.projection[2][3] != 0.0 ? -position.z : 1.0);
			history[i] = texelsAt(before, before_projector, position, turn * glm::dvec3(now.normals[i]), width_m);
		}
	}
	return history;
}

FrameMean::FrameMean(double ema) : m_ema(ema) {}

void FrameMean::add(std::vector<double> frame, std::span<const HistoryTexels> history)
{
	std::vector<int> ages(frame.size(), 1);
	double squares = 0.0;
	std::size_t pixels = 0;
	for (std::size_t i = 0; i < history.size(); ++i)
	{
		const HistoryTexels& source = history[i];
		if (!source.any)
		{
			continue;
		}
		double old = 0.0;
		int age = 0;
		for (std::size_t tap = 0; tap < 4; ++tap)
		{
			old += source.weights[tap] * m_mean[source.texels[tap]];
			age = source.weights[tap] > 0.0 ? std::max(age, m_ages[source.texels[tap]]) : age;
		}
		ages[i] = age + 1;
		const double change = std::max(m_ema, 1.0 / ages[i]) * (frame[i] - old);
		frame[i] = old + change;
		squares += change * change;
		pixels += 1;
	}
	m_change = pixels > 0 ? std::sqrt(squares / static_cast<double>(pixels)) : 0.0;
	m_mean = std::move(frame);
	m_ages = std::move(ages);
}

const std::vector<double>& FrameMean::mean() const
{
	return m_mean;
}

const std::vector<int>& FrameMean::ages() const
{
	return m_ages;
}

double FrameMean::change() const
{
	return m_change;
}

} // namespace nook
