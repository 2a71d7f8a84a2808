// SPDX-License-Identifier: GPL-3.0-or-later
// G-buffers for tests of methods: planes, and built-in levels.
#pragma once

#include "testing.h"

#include "scene/builtin.h"
#include "scene/gbuffer.h"

namespace nook::test
{

// An infinite plane through (0, 0, -5) in view space, tilted by that angle.
inline GBuffer planeAt(const glm::dmat4& projection, int width, int height, double tilt_deg)
{
	const SinCos tilt = sinCosOf(tilt_deg * kPi / 180.0);
	const glm::dvec3 n(0.6 * tilt.sin, 0.8 * tilt.sin, tilt.cos);
	const Projector projector(projection, width, height);
	GBuffer gbuffer{width, height, {glm::dmat4(1.0), projection}, 0.0, {}, {}};
	for (int y = 0; y < height; ++y)
	{
		for (int x = 0; x < width; ++x)
		{
			const ViewLine line = projector.lineOf({x + 0.5, y + 0.5});
			const double depth = (-5.0 * n.z - glm::dot(n, line.at)) / glm::dot(n, line.along);
			const bool seen = glm::dot(n, line.along) < 0.0 && depth > 0.05 && depth < 1e4;
			gbuffer.depth.push_back(seen ? static_cast<float>(depth) : std::numeric_limits<float>::infinity());
			gbuffer.normals.push_back(seen ? glm::vec3(n) : glm::vec3(0.0F));
		}
	}
	return gbuffer;
}

inline Lens lensOf(double fov_deg)
{
	Lens lens{.fov_y_rad = fov_deg * kPi / 180.0};
	if (fov_deg == 0.0)
	{
		lens.orthographic = true;
		lens.half_height_m = 3.0;
		lens.far_m = 100.0;
	}
	return lens;
}

// Each in turn of planes at any slope, through lenses of any field of view; 0 is a parallel view.
inline GBuffer eachPlane(int width, int height)
{
	const double fov_deg = GENERATE(0.0, 30.0, 60.0, 100.0);
	const double tilt_deg = GENERATE(0.0, 30.0, 60.0, 80.0);
	UNSCOPED_INFO("field of view " << fov_deg << ", turned by " << tilt_deg);
	return planeAt(projectionOf(lensOf(fov_deg), 16.0 / 9.0), width, height, tilt_deg);
}

inline void checkOpen(const std::vector<float>& visibility)
{
	CHECK(*std::min_element(visibility.begin(), visibility.end()) >= 1.0F - 1.0F / 255.0F);
	CHECK(*std::max_element(visibility.begin(), visibility.end()) <= 1.0F);
}

// A floor across a parallel view 10 m below the camera, 6 m wide; `height(x)` of objects on it, in metres.
template <class Height> GBuffer floorWith(int size, Height height)
{
	GBuffer gbuffer{size, size, {glm::dmat4(1.0), projectionOf(lensOf(0.0), 1.0)}, 0.0, {}, {}};
	for (int i = 0; i < size * size; ++i)
	{
		gbuffer.depth.push_back(static_cast<float>(10.0 - height((i % size + 0.5) * 6.0 / size - 3.0)));
		gbuffer.normals.emplace_back(0.0F, 0.0F, 1.0F);
	}
	return gbuffer;
}

// Its right half is that much higher.
inline GBuffer stepOf(int size, double step_m)
{
	return floorWith(size, [=](double x) { return x > 0.0 ? step_m : 0.0; });
}

inline GBuffer builtinView(const std::string& name, int width, int height)
{
	const Level level = builtinLevel(name);
	const Tracer tracer(level, {});
	return castGBuffer(tracer, viewOf(level.cameras[0], width, height), width, height, NormalKind::geometric, {});
}

// The picture in OpenGL's row order: the first row is the bottom one.
inline GBuffer turned(const GBuffer& gbuffer)
{
	GBuffer other = gbuffer;
	const auto width = static_cast<std::size_t>(gbuffer.width_px);
	const auto height = static_cast<std::size_t>(gbuffer.height_px);
	for (std::size_t i = 0; i < width * height; ++i)
	{
		const std::size_t from = (height - 1 - i / width) * width + i % width;
		other.depth[i] = gbuffer.depth[from];
		other.normals[i] = gbuffer.normals[from];
	}
	return other;
}

} // namespace nook::test
