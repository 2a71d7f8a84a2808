// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/views.h"

#include "core/error.h"
#include "core/math.h"
#include "scene/camera_choice.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace nook
{
namespace
{

constexpr double kDefaultFov = 60.0; // degrees

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
		if (lens.orthographic)
		{
			throw Error(ExitCode::usage, "--fov: found an orthographic camera '" + camera.name + "', expected a perspective one");
		}
		lens.fov_y_rad = *options.fov_y_deg * (kPi / 180.0);
	}
	if (options.near_m)
	{
		lens.near_m = *options.near_m;
		if (!(lens.near_m < lens.far_m))
		{
			throw Error(ExitCode::usage,
						"--near: found a plane beyond the far one of camera '" + camera.name + "', expected one before it");
		}
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
	for (const glm::dvec2 at :
		 {glm::dvec2(0.0, 0.0), glm::dvec2(1.0, 0.0), glm::dvec2(0.0, 1.0), glm::dvec2(1.0, 1.0), glm::dvec2(0.5, 0.5)})
	{
		const ViewLine line = projector.lineOf({at.x * options.width_px, at.y * options.height_px});
		eye = glm::dvec3(world_from_camera * glm::dvec4(line.at, 1.0));
		if (!(std::max({std::fabs(eye.x), std::fabs(eye.y), std::fabs(eye.z)}) <= kFarthest_m))
		{
			throw Error(ExitCode::invalid_input,
						"camera '" + view.name + "': found rays from beyond 1e15 m, expected them to begin nearer");
		}
	}
	return eye; // the last: the middle
}

} // namespace

void checkCameras(const CameraOptions& options)
{
	if (options.eye && !(glm::length(*options.eye - *options.target) > 0.0))
	{
		throw Error(ExitCode::usage, "--target: found the eye itself, expected another point");
	}
	if (options.camera_from_world && !isRigid(*options.camera_from_world))
	{
		throw Error(ExitCode::usage,
					"--world-to-camera: found a matrix that scales, shears, mirrors or projects, expected a rotation "
					"and a translation, column by column");
	}
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
	const std::filesystem::path path(file);
	std::vector<std::string> files;
	for (int i = 1; i <= count; ++i)
	{
		std::filesystem::path numbered = path;
		numbered.replace_filename(path.stem().string() + "-" + std::to_string(i) + path.extension().string());
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
