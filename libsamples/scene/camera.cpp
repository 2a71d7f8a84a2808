// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/camera.h"

#include "core/error.h"
#include "core/math.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

glm::dvec4 rowOf(const glm::dmat4& m, int row)
{
	return {m[0][row], m[1][row], m[2][row], m[3][row]};
}

[[noreturn]] void refuseCamera(const std::string& found)
{
	throw Error(ExitCode::invalid_input,
				"projection: found " + found + ", expected a perspective or parallel projection, column by column, along -z");
}

} // namespace

glm::dmat4 worldFromCamera(glm::dvec3 eye, glm::dvec3 target)
{
	assert(eye != target);
	const glm::dvec3 back = glm::normalize(eye - target);
	const bool vertical = std::fabs(back.y) > 1.0 - 1e-12;
	const glm::dvec3 right = glm::normalize(glm::cross(vertical ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(0.0, 1.0, 0.0), back));
	const glm::dvec3 up = glm::cross(back, right);
	return {glm::dvec4(right, 0.0), glm::dvec4(up, 0.0), glm::dvec4(back, 0.0), glm::dvec4(eye, 1.0)};
}

glm::dmat4 projectionOf(const Lens& lens, double aspect)
{
	glm::dmat4 p(0.0);
	const double n = lens.near_m;
	const double f = lens.far_m;
	if (lens.orthographic)
	{
		p[0][0] = 1.0 / (lens.half_height_m * aspect);
		p[1][1] = 1.0 / lens.half_height_m;
		p[2][2] = -2.0 / (f - n);
		p[3][2] = -(f + n) / (f - n);
		p[3][3] = 1.0;
		return p;
	}
	const SinCos half = sinCosOf(0.5 * lens.fov_y_rad);
	const double focal = half.cos / half.sin;
	p[0][0] = focal / aspect;
	p[1][1] = focal;
	p[2][2] = std::isinf(f) ? -1.0 : -(f + n) / (f - n);
	p[3][2] = std::isinf(f) ? -2.0 * n : -2.0 * f * n / (f - n);
	p[2][3] = -1.0;
	return p;
}

View viewOf(const LevelCamera& camera, int width_px, int height_px)
{
	return {glm::inverse(camera.world_from_camera), projectionOf(camera.lens, static_cast<double>(width_px) / height_px)};
}

Projector::Projector(const glm::dmat4& projection, int width_px, int height_px)
	: m_projection(projection), m_width_px(width_px), m_height_px(height_px)
{
	double scale = 1.0;
	for (int row = 0; row < 4; ++row)
	{
		const double length = glm::length(rowOf(projection, row));
		if (!std::isfinite(length))
		{
			refuseCamera("a number that is not finite");
		}
		scale *= length;
	}
	// Linearly dependent rows would collapse one dimension. Tuned on near planes down to 1e-7 of the far one.
	if (!(std::fabs(glm::determinant(projection)) > 1e-14 * scale))
	{
		refuseCamera("a singular matrix");
	}
	for (const glm::dvec2 corner :
		 {glm::dvec2(0.0, 0.0), glm::dvec2(1.0, 0.0), glm::dvec2(0.0, 1.0), glm::dvec2(1.0, 1.0), glm::dvec2(0.5, 0.5)})
	{
		const ViewLine line = lineOf({corner.x * m_width_px, corner.y * m_height_px});
		// Directions are stored as 32-bit numbers whose squares must not overflow; no picture is 1e9 times as wide as deep.
		if (!(glm::dot(line.along, line.along) <= 1e18) || !std::isfinite(glm::dot(line.at, line.at)))
		{
			refuseCamera("a picture without one line of sight per pixel");
		}
		const glm::dvec3 far_away = line.at + 1e6 * line.along;
		if (!(glm::dot(rowOf(projection, 3), glm::dvec4(far_away, 1.0)) > 0.0))
		{
			refuseCamera("one that looks the other way");
		}
	}
}

ViewLine Projector::lineOf(glm::dvec2 pixel) const
{
	// Two planes that contain every point shown there: rows 0 and 1 of the projection minus the position times row 3.
	const glm::dvec4 w = rowOf(m_projection, 3);
	const glm::dvec4 a = rowOf(m_projection, 0) - (2.0 * pixel.x / m_width_px - 1.0) * w;
	const glm::dvec4 b = rowOf(m_projection, 1) - (1.0 - 2.0 * pixel.y / m_height_px) * w;
	const double det = a.x * b.y - a.y * b.x;
	ViewLine line;
	line.along = {(a.z * b.y - a.y * b.z) / det, (a.x * b.z - a.z * b.x) / det, -1.0};
	line.at = {(a.y * b.w - a.w * b.y) / det, (a.w * b.x - a.x * b.w) / det, 0.0};
	return line;
}

glm::dvec2 Projector::pixelOf(glm::dvec3 view_position) const
{
	const glm::dvec4 clip = m_projection * glm::dvec4(view_position, 1.0);
	return {0.5 * (clip.x / clip.w + 1.0) * m_width_px, 0.5 * (1.0 - clip.y / clip.w) * m_height_px};
}

double Projector::depthOfDevice(double z_ndc, const ViewLine& line) const
{
	const glm::dvec4 plane = rowOf(m_projection, 2) - z_ndc * rowOf(m_projection, 3);
	const double rise = glm::dot(plane, glm::dvec4(line.along, 0.0));
	const double start = glm::dot(plane, glm::dvec4(line.at, 1.0));
	return rise == 0.0 ? std::numeric_limits<double>::infinity() : -start / rise;
}

} // namespace nook
