// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes for the built-in levels. Solids are closed: adjacent faces use exactly the same positions.
#pragma once

#include "scene/builtin_polygon.h"
#include "scene/level.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <vector>

namespace nook
{

// Position and orientation of a shape; the axes are right-handed and orthonormal.
struct Frame
{
	glm::dvec3 at{0.0};
	glm::dvec3 x{1.0, 0.0, 0.0};
	glm::dvec3 y{0.0, 1.0, 0.0};
	glm::dvec3 z{0.0, 0.0, 1.0};

	glm::dvec3 point(glm::dvec3 p) const
	{
		return at + direction(p);
	}
	glm::dvec3 direction(glm::dvec3 d) const
	{
		return x * d.x + y * d.y + z * d.z;
	}
};

inline const Frame kWorld;

inline Frame frameAt(glm::dvec3 at)
{
	Frame frame;
	frame.at = at;
	return frame;
}

// Rotated about +y, counter-clockwise from above.
Frame turnedFrame(glm::dvec3 at, double angle_rad);

// For extrusions along the world's x: the shape's x is −z of the world, its y is up, its z is x of the world.
Frame sideFrame(glm::dvec3 at);

// For extrusions upward: the shape's x is x of the world, its y is −z, its z is up.
Frame planFrame(glm::dvec3 at);

// Any frame whose y is along `direction`, which may have any length.
Frame frameAlong(glm::dvec3 at, glm::dvec3 direction);

class LevelBuilder
{
public:
	uint32_t addMaterial(const std::string& name);
	// Two-sided, with cut-off ½.
	uint32_t addMasked(const std::string& name, Mask mask);
	// Subsequent geometry belongs to this mesh.
	void beginMesh(const std::string& name, uint32_t material);
	void addCamera(const std::string& name, glm::dvec3 eye, glm::dvec3 target, double fov_y_deg = 60.0);

	uint32_t addVertex(glm::dvec3 position, glm::dvec3 normal, glm::dvec2 uv);
	void addTriangle(uint32_t a, uint32_t b, uint32_t c);
	// Counter-clockwise seen from the front.
	void addQuad(uint32_t a, uint32_t b, uint32_t c, uint32_t d);
	void reserve(std::size_t vertices, std::size_t triangles);

	Level finish();

private:
	Level m_level;
	uint32_t m_material = 0;
};

void addBox(LevelBuilder& builder, const Frame& frame, glm::dvec3 least, glm::dvec3 most);

// Extrudes the polygon in the frame's x and y (see triangulateContours) from z = from to z = to, from < to. Edges of less than 40°
// are smooth.
void addExtrusion(LevelBuilder& builder, const Frame& frame, const std::vector<Contour>& contours, double from, double to);

// Rotates a profile (radius, height) about the frame's y. It either runs from the axis, below, outward and up to the axis again, or
// is a closed counter-clockwise ring without a repeated end point. Edges of less than 50° are smooth.
void addLathe(LevelBuilder& builder, const Frame& frame, std::span<const glm::dvec2> profile, int segments);

// Both ends flat.
void addCylinder(LevelBuilder& builder, glm::dvec3 from, glm::dvec3 to, double radius, int segments);

// Vertices lie on the sphere.
void addSphere(LevelBuilder& builder, glm::dvec3 centre, double radius, int segments);

// A round tube through all points, with the radius at each; both ends flat.
void addTube(LevelBuilder& builder, std::span<const glm::dvec3> points, std::span<const double> radii, int segments);

// One flat quad, corner + right × [0, 1] + up × [0, 1]; the texture repeats that often.
void addCard(LevelBuilder& builder, glm::dvec3 corner, glm::dvec3 right, glm::dvec3 up, glm::dvec2 repeats = {1.0, 1.0});

} // namespace nook
