// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/camera.h"

#include "core/math.h"
#include "core/system.h"
#include "core/words.h"
#include "scene/camera_choice.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <filesystem>

namespace nook
{
namespace
{

glm::dvec4 rowOf(const glm::dmat4& m, int row)
{
	return {m[0][row], m[1][row], m[2][row], m[3][row]};
}

void refuseCameraIf(bool condition, const std::string& found)
{
	refuseInputIf(condition, "projection", found, "a perspective or parallel projection, column by column, along -z");
}

constexpr double kDefaultFov = 60.0; // degrees

// The corners of a picture and its middle, in widths and heights.
constexpr std::array<glm::dvec2, 5> kChecked{{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}, {0.5, 0.5}}};

// Rotation and translation: lengths stay metres, and nothing is mirrored. Engines print 32-bit numbers, hence the tolerance.
bool isRigid(const glm::dmat4& m)
{
	const glm::dmat3 r(m);
	const glm::dmat3 product = glm::transpose(r) * r;
	for (int column = 0; column < 3; ++column)
	{
		for (int row = 0; row < 3; ++row)
		{
			if (!(std::fabs(product[column][row] - (column == row ? 1.0 : 0.0)) <= 1e-4))
			{
				return false;
			}
		}
	}
	return glm::determinant(r) > 0.0 && m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0 && m[3][3] == 1.0;
}

// The camera's lens with the options' angle and near plane.
Lens lensOf(const CameraOptions& options, const LevelCamera& camera)
{
	Lens lens = camera.lens;
	if (options.fov_y_deg)
	{
		refuseInputIf(lens.orthographic, "--fov", "an orthographic camera '" + camera.name + "'", "a perspective one",
					  ExitCode::usage);
		lens.fov_y_rad = *options.fov_y_deg * (kPi / 180.0);
	}
	if (options.near_m)
	{
		lens.near_m = *options.near_m;
		refuseInputIf(!(lens.near_m < lens.far_m), "--near", "a plane beyond the far one of camera '" + camera.name + "'",
					  "one before it", ExitCode::usage);
	}
	return lens;
}

NamedView viewOfCamera(const CameraOptions& options, LevelCamera camera, bool chosen)
{
	camera.lens = lensOf(options, camera);
	NamedView named{camera.name, chosen, camera.from_outside, viewOf(camera, options.width_px, options.height_px)};
	if (options.projection)
	{
		named.view.projection = *options.projection;
	}
	if (options.camera_from_world)
	{
		named.view.camera_from_world = *options.camera_from_world;
	}
	return named;
}

// The camera that the options place.
LevelCamera givenCamera(const CameraOptions& options)
{
	LevelCamera camera;
	camera.name = "given";
	camera.lens.fov_y_rad = kDefaultFov * (kPi / 180.0);
	if (options.eye)
	{
		camera.world_from_camera = worldFromCamera(*options.eye, *options.target);
	}
	return camera;
}

// Where the rays of the picture's middle begin, in the world. Throws Error (invalid_input) where any of them begins farther away
// than a level can be.
glm::dvec3 checkedEyeOf(const CameraOptions& options, const NamedView& view)
{
	const Projector projector(view.view.projection, options.width_px, options.height_px);
	const glm::dmat4 world_from_camera = glm::inverse(view.view.camera_from_world);
	glm::dvec3 eye(0.0);
	for (const glm::dvec2 at : kChecked)
	{
		const ViewLine line = projector.lineOf({at.x * options.width_px, at.y * options.height_px});
		eye = glm::dvec3(world_from_camera * glm::dvec4(line.at, 1.0));
		refuseInputIf(!(std::max({std::fabs(eye.x), std::fabs(eye.y), std::fabs(eye.z)}) <= kFarthest_m),
					  "camera '" + view.name + "'", "rays from beyond 1e15 m", "them to begin nearer");
	}
	return eye; // the last: the middle
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
		refuseCameraIf(!std::isfinite(length), "a number that is not finite");
		scale *= length;
	}
	// Linearly dependent rows would collapse one dimension. Tuned on near planes down to 1e-7 of the far one.
	refuseCameraIf(!(std::fabs(glm::determinant(projection)) > 1e-14 * scale), "a singular matrix");
	for (const glm::dvec2 at : kChecked)
	{
		const ViewLine line = lineOf({at.x * m_width_px, at.y * m_height_px});
		// Directions are stored as 32-bit numbers whose squares must not overflow; no picture is 1e9 times as wide as deep.
		refuseCameraIf(!(glm::dot(line.along, line.along) <= 1e18) || !std::isfinite(glm::dot(line.at, line.at)),
					   "a picture without one line of sight per pixel");
		const glm::dvec3 far_away = line.at + 1e6 * line.along;
		refuseCameraIf(!(glm::dot(rowOf(projection, 3), glm::dvec4(far_away, 1.0)) > 0.0), "one that looks the other way");
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

void checkCameras(const CameraOptions& options)
{
	refuseInputIf(options.eye && !(glm::length(*options.eye - *options.target) > 0.0), "--target", "the eye itself",
				  "another point", ExitCode::usage);
	refuseInputIf(options.camera_from_world && !isRigid(*options.camera_from_world), "--world-to-camera",
				  "a matrix that scales, shears, mirrors or projects", "a rotation and a translation, column by column",
				  ExitCode::usage);
	if (options.projection)
	{
		const Projector checked(*options.projection, options.width_px, options.height_px);
	}
}

int pictureCount(const CameraOptions& options)
{
	return options.automatic > 0 ? options.automatic : 1;
}

std::vector<std::string> pictureFiles(const std::string& file, int count)
{
	if (count == 1)
	{
		return {file};
	}
	const std::filesystem::path path = nativePath(file);
	std::vector<std::string> files;
	for (int i = 1; i <= count; ++i)
	{
		std::filesystem::path numbered = path;
		numbered.replace_filename(nativePath(path.stem().string() + "-" + std::to_string(i) + path.extension().string()));
		files.push_back(numbered.string());
	}
	return files;
}

std::vector<NamedView> viewsOf(const CameraOptions& options, const Tracer& tracer, const RunSettings& run)
{
	const CamerasOfLevel found = options.eye || options.camera_from_world
									 ? CamerasOfLevel{{givenCamera(options)}, false}
									 : camerasOf(tracer, options.camera, options.automatic, run);
	std::vector<NamedView> views;
	for (const LevelCamera& camera : found.cameras)
	{
		views.push_back(viewOfCamera(options, camera, found.chosen));
		const glm::dvec3 eye = checkedEyeOf(options, views.back()); // with a projection of the options
		if (!found.chosen && !options.allow_inside)
		{
			checkOutside(tracer, eye, camera.name);
		}
	}
	return views;
}

} // namespace nook
