// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras: where they stand, and any 4×4 projection.
// View space: right-handed, the camera looks down −z, y up, metres. depth = −z.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <limits>
#include <string>

namespace nook
{

// How a level's camera sees; its projection follows once the image's shape is known.
struct Lens
{
	bool orthographic = false;
	double fov_y_rad = 1.0;     // perspective: whole vertical angle, in (0, π)
	double half_height_m = 1.0; // orthographic: half the picture's height
	double near_m = 0.1;
	double far_m = std::numeric_limits<double>::infinity();
};

struct LevelCamera
{
	std::string name;
	glm::dmat4 world_from_camera{1.0}; // rigid: rotation and translation
	Lens lens;
	bool from_outside = false; // chosen (camera_choice.h), and not a place where one stands
};

// A camera for one image: column-major matrices, clip space as OpenGL's for x and y; any depth convention.
struct View
{
	glm::dmat4 camera_from_world{1.0};
	glm::dmat4 projection{1.0};
};

// A camera at `eye` that looks at `target`; +y is up, unless that is the view direction, then −z. Requires eye ≠ target.
glm::dmat4 worldFromCamera(glm::dvec3 eye, glm::dvec3 target);

// OpenGL's clip space (z from −w to w); far may be infinite. `aspect` = width / height.
glm::dmat4 projectionOf(const Lens& lens, double aspect);

View viewOf(const LevelCamera& camera, int width_px, int height_px);

// All points of view space that a point of the picture shows, by depth d > 0: at + along · d (z component −d).
// For a perspective camera `at` is the eye wherever the projection puts it (0 for usual ones).
struct ViewLine
{
	glm::dvec3 at{0.0};
	glm::dvec3 along{0.0, 0.0, -1.0};
};

// Turns points of the picture into lines and back, for any projection that has lines: perspective or parallel, off-centre,
// reversed, infinite. Throws Error (invalid_input) for a matrix that has none (singular, not finite).
class Projector
{
public:
	Projector(const glm::dmat4& projection, int width_px, int height_px);

	// Of a position in pixels: (0, 0) is the picture's upper left corner, (0.5, 0.5) the centre of its first pixel.
	ViewLine lineOf(glm::dvec2 pixel) const;

	// Position in pixels of a view-space point. Requires depth > 0.
	glm::dvec2 pixelOf(glm::dvec3 view_position) const;

	// Depth in metres on a line of lineOf() whose depth after the division by w is z_ndc, in whatever clip range the matrix makes;
	// +inf where the projection has infinity there.
	double depthOfDevice(double z_ndc, const ViewLine& line) const;

private:
	glm::dmat4 m_projection;
	double m_width_px;
	double m_height_px;
};

} // namespace nook
