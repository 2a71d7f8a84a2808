// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes for the built-in levels. Solids are closed: adjacent faces use exactly the same positions.
#pragma once

#include "core/random.h"
#include "scene/level.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <vector>

namespace nook
{

// An outline, counter-clockwise, or a hole in one, clockwise. Contours of a polygon must not touch each other or themselves, nor
// contain three consecutive collinear points.
using Contour = std::vector<glm::dvec2>;

// Points of an arc including both ends; clockwise if `to_rad` is smaller.
Contour arcOf(glm::dvec2 centre, double radius, double from_rad, double to_rad, int steps);

Contour rectangleOf(glm::dvec2 least, glm::dvec2 most);

// Reverses a contour.
Contour holeOf(Contour contour);

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

	Level finish();

private:
	Level m_level;
	uint32_t m_material = 0;
};

void addBox(LevelBuilder& builder, const Frame& frame, glm::dvec3 least, glm::dvec3 most);

// Extrudes the polygon in the frame's x and y from z = from to z = to, from < to. Edges of less than 40° are smooth.
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

// Plinth, turned base, swelling shaft, neck, capital and abacus; 3.6 m × `scale` high, 0.94 m wide.
void addColumn(LevelBuilder& builder, glm::dvec3 foot, double scale, int segments);

// Rail, plate and turned balusters 0.4 m apart between two points of a level floor, 0.95 m high; a pedestal at the start and, if it
// is the last of a row, at the end.
void addBalustrade(LevelBuilder& builder, glm::dvec3 from, glm::dvec3 to, bool last = true);

// Side outline of a flight of stairs, from (x, y) upward to the right, down to y − buried; counter-clockwise. The right end is
// vertical, at x + (steps − 1) × tread + landing.
Contour stairsOf(glm::dvec2 foot, int steps, double riser, double tread, double landing, double buried);

// An opening with a round top; counter-clockwise; `spring` is where the round part begins.
Contour archwayOf(double middle, double half_width, double bottom, double spring, int steps);

// Half a ring around a round arch.
Contour archivoltOf(glm::dvec2 centre, double inner, double outer, int steps);

// A vase with an open mouth, `height` tall.
void addUrn(LevelBuilder& builder, glm::dvec3 foot, double height, int segments);

// 0.9 m tall, with hoops.
void addBarrel(LevelBuilder& builder, glm::dvec3 foot, int segments);

// A cube of that width made of boards around a box, rotated.
void addCrate(LevelBuilder& builder, glm::dvec3 foot, double width, double angle_rad);

// A twig with leaves, growing upward from the middle of the lower edge.
Mask leafMask();

// Blades of grass, from the lower edge upward.
Mask grassMask();

// One period of chain link: two crossing wires, as thick as `width` of the period; tiles seamlessly.
Mask chainLinkMask(double width);

// The given number of cards of that size in an ellipsoid, denser outside, fronts outward. The builder's mesh must be masked.
void addLeaves(LevelBuilder& builder, Random& random, glm::dvec3 centre, glm::dvec3 radii, double size, int count);

struct TreeSize
{
	double trunk_height; // metres, up to where branches start to end
	double trunk_radius; // metres
	int branches;
	double reach; // length of the branches, metres
	double card;  // size of a card, metres
	int cards;    // per branch
};

// Wood goes to one mesh and leaves to the next; `leaves` is a masked material.
void addTree(LevelBuilder& builder, Random& random, glm::dvec3 foot, const TreeSize& size, uint32_t bark, uint32_t leaves);

// Upright cards on a level floor within `radius`.
void addGrass(LevelBuilder& builder, Random& random, glm::dvec3 centre, double radius, double size, int count);

} // namespace nook
