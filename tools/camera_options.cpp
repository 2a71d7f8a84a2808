// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera_options.h"

#include "options.h"
#include "place_options.h"

#include "core/error.h"
#include "core/image.h"
#include "core/math.h"
#include "scene/camera_choice.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

namespace nook
{
namespace
{

constexpr int kMaxSide = 32768;
constexpr int kMaxAutomatic = 64;
constexpr double kDefaultFov = 60.0; // degrees
constexpr std::string_view kAutoViews = "auto:";

template <class Number> std::optional<Number> numberOf(std::string_view text)
{
	Number value{};
	const std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), value);
	if (result.ec != std::errc{} || result.ptr != text.data() + text.size())
	{
		return std::nullopt;
	}
	return value;
}

void addPosition(CLI::App& app, const std::string& name, std::optional<glm::dvec3>& value, const std::string& help)
{
	const auto take = [&value, name](const std::string& text)
	{
		value = positionOf(name, text);
	};
	app.add_option_function<std::string>(name, take, help)->type_name("X,Y,Z");
}

void addOptional(CLI::App& app, const std::string& name, std::optional<double>& value, double least, double most,
				 const std::string& expected, const std::string& help)
{
	const auto take = [&value, name, least, most, expected](const std::string& text)
	{
		const std::optional<double> number = numberOf<double>(text);
		if (!number || !(*number >= least && *number <= most))
		{
			refuseValue(name, text, expected);
		}
		value = *number;
	};
	app.add_option_function<std::string>(name, take, help)->type_name("X");
}

void refuseTogether(bool both, const std::string& first, const std::string& second)
{
	if (both)
	{
		throw Error(ExitCode::usage, first + ": found " + second + " as well, expected one of them");
	}
}

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

// What --fov and --near change of a camera's lens.
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

// A camera that the options place, not the level.
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

void addCameraChoice(CLI::App& app, CameraOptions& options)
{
	const auto take = [&options](const std::string& text)
	{
		if (text.empty() || text[0] == '-')
		{
			refuseValue("--camera", text, "NAME or auto:K");
		}
		options.camera = text;
		options.automatic = 0;
		if (text.substr(0, kAutoViews.size()) == kAutoViews)
		{
			const std::optional<int> count = numberOf<int>(std::string_view(text).substr(kAutoViews.size()));
			if (!count || *count < 1 || *count > kMaxAutomatic)
			{
				refuseValue("--camera", text, "auto:K with K from 1 to " + std::to_string(kMaxAutomatic));
			}
			options.automatic = *count;
		}
	};
	app.add_option_function<std::string>(
		   "--camera", take,
		   "A camera of the level by name (default: its first, or auto:1 where it has none), or auto:K: "
		   "the K most informative views, the same ones each time; for K > 1 the names of outputs get -1, "
		   "-2, ... before their ending")
		->type_name("NAME|auto:K");
}

void addPictureSize(CLI::App& app, CameraOptions& options, const std::string& standard)
{
	const auto take = [&options](const std::string& text)
	{
		const std::size_t cross = text.find('x');
		const std::optional<int> width = numberOf<int>(std::string_view(text).substr(0, cross));
		const std::optional<int> height =
			cross == std::string::npos ? std::nullopt : numberOf<int>(std::string_view(text).substr(cross + 1));
		const auto isSide = [](std::optional<int> side)
		{
			return side && *side >= 1 && *side <= kMaxSide;
		};
		// A G-buffer has four channels.
		if (!isSide(width) || !isSide(height) ||
			static_cast<std::size_t>(*width) * static_cast<std::size_t>(*height) > kMaxImageValues / 4)
		{
			refuseValue("--size", text,
						"WxH, each from 1 to " + std::to_string(kMaxSide) + ", at most " + std::to_string(kMaxImageValues / 4) +
							" pixels");
		}
		options.width_px = *width;
		options.height_px = *height;
	};
	app.add_option_function<std::string>("--size", take, "Width and height of the picture in pixels (default " + standard + ")")
		->type_name("WxH");
}

void addCameraOptions(CLI::App& app, CameraOptions& options)
{
	addCameraChoice(app, options);
	addPosition(app, "--eye", options.eye, "Where the camera stands, in the level's metres; needs --target");
	addPosition(app, "--target", options.target, "What the camera looks at; +y is up in the picture");
	addOptional(app, "--fov", options.fov_y_deg, 0.01, 179.0, "degrees from 0.01 to 179",
				"Whole vertical angle of view in degrees (default: the camera's own; 60 with --eye or --world-to-camera)");
	addOptional(app, "--near", options.near_m, 1e-6, 1e6, "metres from 0.000001 to 1000000",
				"Near plane of the projection in metres (default: the camera's own, else 0.1); rays are not cut by it");
	addMatrix(app, "--projection", options.projection,
			  "A projection of any kind instead of the camera's: OpenGL's x and y, any depth (reversed, infinite, orthographic, "
			  "off-centre); 16 numbers, column by column");
	addMatrix(app, "--world-to-camera", options.camera_from_world,
			  "Where the camera stands, as a rotation and translation: 16 numbers, column by column; it looks down its -z");
	addPictureSize(app, options);
	app.add_flag("--allow-inside", options.allow_inside,
				 "Accept a camera inside something solid, for levels whose faces are turned round");
}

void checkCameraOptions(const CameraOptions& options)
{
	refuseTogether(!options.camera.empty() && options.eye.has_value(), "--eye", "--camera");
	refuseTogether(!options.camera.empty() && options.camera_from_world.has_value(), "--world-to-camera", "--camera");
	refuseTogether(options.eye.has_value() && options.camera_from_world.has_value(), "--world-to-camera", "--eye");
	refuseTogether(options.projection.has_value() && options.fov_y_deg.has_value(), "--projection", "--fov");
	refuseTogether(options.projection.has_value() && options.near_m.has_value(), "--projection", "--near");
	if (options.eye.has_value() != options.target.has_value())
	{
		throw Error(ExitCode::usage, std::string(options.eye ? "--eye" : "--target") + ": found alone, expected " +
										 (options.eye ? "--target" : "--eye") + " as well");
	}
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
