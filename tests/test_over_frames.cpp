// SPDX-License-Identifier: GPL-3.0-or-later
// The mean over frames: which history is read, which is rejected, and how it is weighted.
#include "small_views.h"

#include "scene/builtin.h"
#include "scene/tracer.h"
#include "study/error_report.h"

#include <catch2/catch.hpp>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

using namespace nook;

namespace
{

constexpr int kFrameWidth = 96;
constexpr int kFrameHeight = 54;

std::vector<GBuffer> framesOf(const std::string& name, Motion motion, int count)
{
	const Level level = builtinLevel(name);
	const Tracer tracer(level, RunSettings{2, {}});
	std::vector<GBuffer> frames;
	for (int i = 0; i < count; ++i)
	{
		const LevelCamera camera = cameraOfFrame(level.cameras.front(), stepOf(motion, 1.0), i, kFrameWidth, kFrameHeight);
		frames.push_back(castGBuffer(tracer, viewOf(camera, kFrameWidth, kFrameHeight), kFrameWidth, kFrameHeight,
									 NormalKind::geometric, {2, {}}));
	}
	return frames;
}

// A smooth function attached to the surface: it depends on the world position.
std::vector<double> paintedOn(const GBuffer& gbuffer)
{
	const Projector projector(gbuffer.view.projection, kFrameWidth, kFrameHeight);
	const glm::dmat4 world = glm::inverse(gbuffer.view.camera_from_world);
	std::vector<double> values(gbuffer.depth.size(), 0.0);
	for (std::size_t i = 0; i < values.size(); ++i)
	{
		if (std::isfinite(gbuffer.depth[i]))
		{
			const glm::dvec3 p(world * glm::dvec4(positionOf(gbuffer, projector, static_cast<int>(i) % kFrameWidth,
															 static_cast<int>(i) / kFrameWidth),
												  1.0));
			values[i] = 0.05 * p.x + 0.03 * p.y - 0.04 * p.z;
		}
	}
	return values;
}

} // namespace

TEST_CASE("over frames: history is read where the surface was, and not where it was hidden", "[report]")
{
	for (const Motion motion : {Motion::still, Motion::pan, Motion::walk})
	{
		const std::vector<GBuffer> frames = framesOf("courtyard", motion, 2);
		const std::vector<HistoryTexels> history = historyOf(frames[1], frames[0]);
		const std::vector<double> before = paintedOn(frames[0]);
		const std::vector<double> now = paintedOn(frames[1]);
		const Projector projector(frames[1].view.projection, kFrameWidth, kFrameHeight);
		std::size_t uncovered = 0;
		std::size_t surfaces = 0;
		std::size_t off = 0;
		for (std::size_t i = 0; i < history.size(); ++i)
		{
			if (!std::isfinite(frames[1].depth[i]))
			{
				CHECK_FALSE(history[i].any);
				continue;
			}
			surfaces += 1;
			uncovered += history[i].any ? 0U : 1U;
			double read = 0.0;
			double sum = 0.0;
			for (std::size_t tap = 0; tap < 4; ++tap)
			{
				read += history[i].weights[tap] * before[history[i].texels[tap]];
				sum += history[i].weights[tap];
			}
			CHECK(sum == Approx(history[i].any ? 1.0 : 0.0).margin(1e-12));
			// At most one texel around the pixel, whose footprint is long at grazing angles; the painted values change by at most
			// 0.08 per metre.
			const glm::dvec3 at =
				positionOf(frames[1], projector, static_cast<int>(i) % kFrameWidth, static_cast<int>(i) / kFrameWidth);
			const double facing = std::fabs(glm::dot(glm::normalize(at), glm::dvec3(frames[1].normals[i])));
			const double texel_m = 2.0 / (kFrameWidth * frames[1].view.projection[0][0]) * -at.z / std::max(facing, 0.01);
			off += history[i].any && std::fabs(read - now[i]) > 0.08 * texel_m ? 1U : 0U;
			CHECK((!history[i].any || std::fabs(read - now[i]) < 0.08 * 3.0 * texel_m));
		}
		INFO(nameOf(motion));
		CHECK(off * 50 < surfaces);
		CHECK((motion == Motion::still ? uncovered == 0 : uncovered > surfaces / 500));
		CHECK(uncovered < surfaces / 8);
	}
}

TEST_CASE("over frames: the first frames count alike, then the newest by alpha", "[report]")
{
	std::vector<HistoryTexels> same(2);
	for (std::size_t i = 0; i < 2; ++i)
	{
		same[i] = {{i, i, i, i}, {1.0, 0.0, 0.0, 0.0}, i == 0}; // the second pixel is always new
	}
	FrameMean mean(0.25);
	mean.add({1.0, 1.0}, {});
	CHECK(mean.change() == 0.0);
	mean.add({3.0, 3.0}, same);
	CHECK(mean.mean() == std::vector<double>{2.0, 3.0});
	CHECK(mean.change() == Approx(1.0));
	CHECK(mean.ages() == std::vector<int>{2, 1});
	mean.add({5.0, 5.0}, same);
	CHECK(mean.mean()[0] == Approx(3.0));
	mean.add({7.0, 7.0}, same);
	CHECK(mean.mean()[0] == Approx(4.0));
	mean.add({0.0, 0.0}, same);
	CHECK(mean.mean()[0] == Approx(3.0)); // 3/4 of 4
	CHECK(mean.mean()[1] == 0.0);
	FrameMean newest(1.0);
	newest.add({1.0, 1.0}, {});
	newest.add({0.25, 0.5}, same);
	CHECK(newest.mean() == std::vector<double>{0.25, 0.5});
}
