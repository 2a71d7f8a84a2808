// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras: their position, and any 4×4 projection.
// View space is right-handed, the camera looks down −z, y up, metres. depth = −z.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <limits>
#include <string>

namespace nook
{

// A level's lens; the projection follows once the image's aspect ratio is known.
struct Lens
{
	bool orthographic = false;
	double fov_y_rad = 1.0;     // perspective: full vertical angle, in (0, π)
	double half_height_m = 1.0; // orthographic: half the picture's height
	double near_m = 0.1;
	double far_m = std::numeric_limits<double>::infinity();
};

struct LevelCamera
{
	std::string name;
	glm::dmat4 world_from_camera{1.0}; // rigid transform
	Lens lens;
	bool from_outside = false; // automatic camera (camera_choice.h) not at a place where a person could stand
};

// A camera for one image: column-major matrices; clip space x and y as in OpenGL, any depth convention.
struct View
{
	glm::dmat4 camera_from_world{1.0};
	glm::dmat4 projection{1.0};
};

// A camera at `eye` that looks at `target`; +y is up or, if that is the view direction, −z. Requires eye ≠ target.
glm::dmat4 worldFromCamera(glm::dvec3 eye, glm::dvec3 target);

// OpenGL clip space (z from −w to w); far may be infinite. `aspect` = width / height.
glm::dmat4 projectionOf(const Lens& lens, double aspect);

View viewOf(const LevelCamera& camera, int width_px, int height_px);

// All view-space points shown at a position of the picture, by depth d > 0: at + along · d (z component −d).
// For a perspective camera `at` is the eye, wherever the projection puts it (usually 0).
struct ViewLine
{
	glm::dvec3 at{0.0};
	glm::dvec3 along{0.0, 0.0, -1.0};
};

// Converts picture positions to lines and back, for any projection: perspective or parallel, off-centre, reversed, infinite. Throws
// Error (invalid_input) for a matrix without such lines (singular, not finite).
class Projector
{
public:
	Projector(const glm::dmat4& projection, int width_px, int height_px);

	// The position is in pixels: (0, 0) is the picture's upper left corner, (0.5, 0.5) the centre of its first pixel.
	ViewLine lineOf(glm::dvec2 pixel) const;

	// Position in pixels of a view-space point. Requires depth > 0.
	glm::dvec2 pixelOf(glm::dvec3 view_position) const;

	// Depth in metres on a line from lineOf() where z after the division by w is z_ndc, in the matrix's clip range; +inf if the
	// projection maps infinity there.
	double depthOfDevice(double z_ndc, const ViewLine& line) const;

private:
	glm::dmat4 m_projection;
	double m_width_px;
	double m_height_px;
};

} // namespace nook
