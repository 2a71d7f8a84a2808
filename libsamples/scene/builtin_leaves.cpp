// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/builtin_leaves.h"

#include "core/math.h"
#include "core/sequence.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <functional>

namespace nook
{
namespace
{

// Coverage of each texel from 4 × 4 points; (0, 0) is the lower left corner of the picture, (1, 1) the upper right one.
Mask drawMask(const std::string& name, int size, const std::function<bool(glm::dvec2)>& inside)
{
	Mask mask;
	mask.name = name;
	mask.width_px = size;
	mask.height_px = size;
	for (int y = 0; y < size; ++y)
	{
		for (int x = 0; x < size; ++x)
		{
			int count = 0;
			for (int k = 0; k < 16; ++k)
			{
				const double px = (x + 0.125 + 0.25 * (k % 4)) / size;
				const double py = 1.0 - (y + 0.125 + 0.25 * (k / 4)) / size;
				count += inside({px, py}) ? 1 : 0;
			}
			mask.alpha.push_back(static_cast<uint8_t>((count * 255 + 8) / 16));
		}
	}
	return mask;
}

// A pointed blade from `foot` to `tip`: widest at a third of its length.
struct Blade
{
	glm::dvec2 foot;
	glm::dvec2 tip;
	double half_width;
};

bool isInside(const Blade& blade, glm::dvec2 p)
{
	const glm::dvec2 along = blade.tip - blade.foot;
	const double length2 = glm::dot(along, along);
	const double t = glm::dot(p - blade.foot, along) / length2;
	if (t <= 0.0 || t >= 1.0)
	{
		return false;
	}
	const double across = (along.x * (p.y - blade.foot.y) - along.y * (p.x - blade.foot.x)) / std::sqrt(length2);
	const double root = std::sqrt(t);
	// √t (1 − t) has its maximum 0.385 at t = 1/3.
	return std::fabs(across) <= blade.half_width * root * (1.0 - t) * (1.0 / 0.385);
}

bool isInsideAny(const std::vector<Blade>& blades, glm::dvec2 p)
{
	for (const Blade& blade : blades)
	{
		if (isInside(blade, p))
		{
			return true;
		}
	}
	return false;
}

glm::dvec2 directionOf(double angle_rad)
{
	const SinCos at = sinCosOf(angle_rad);
	return {at.cos, at.sin};
}

// Leaves on both sides of a twig and one at its end.
void addTwig(std::vector<Blade>& blades, glm::dvec2 foot, double angle_rad, double length, int pairs)
{
	const glm::dvec2 along = directionOf(angle_rad);
	blades.push_back({foot - 0.02 * along, foot + 1.1 * length * along, 0.008});
	const double leaf = 0.30 * length + 0.07;
	for (int i = 0; i < pairs; ++i)
	{
		const glm::dvec2 at = foot + (0.18 + 0.72 * i / pairs) * length * along;
		const double size = leaf * (1.0 - 0.25 * i / pairs);
		for (const double side : {-1.0, 1.0})
		{
			const glm::dvec2 out = directionOf(angle_rad + side * (1.05 - 0.25 * i / pairs));
			blades.push_back({at, at + size * out, 0.26 * size});
		}
	}
	blades.push_back({foot + 0.8 * length * along, foot + (0.8 * length + leaf) * along, 0.26 * leaf});
}

struct Limb
{
	std::vector<glm::dvec3> points;
	std::vector<double> radii;
};

// Starts at `from` in direction `way` and bends upward; tapers to a third of its thickness.
Limb limbOf(glm::dvec3 from, glm::dvec3 way, double length, double radius, Random& random)
{
	Limb limb;
	glm::dvec3 at = from;
	glm::dvec3 along = glm::normalize(way);
	const int steps = 5;
	for (int i = 0; i <= steps; ++i)
	{
		limb.points.push_back(at);
		limb.radii.push_back(radius * (1.0 - 0.67 * i / steps));
		const double x = random.uniform() - 0.5;
		const double y = random.uniform() - 0.2;
		const double z = random.uniform() - 0.5;
		along = glm::normalize(along + 0.35 * glm::dvec3(x, y, z));
		at += along * (length / steps);
	}
	return limb;
}

} // namespace

Mask leafMask()
{
	std::vector<Blade> blades;
	const glm::dvec2 foot = {0.5, 0.02};
	addTwig(blades, foot, 0.5 * kPi, 0.70, 5);
	addTwig(blades, foot + glm::dvec2(0.0, 0.16), 0.5 * kPi + 0.75, 0.38, 3);
	addTwig(blades, foot + glm::dvec2(0.0, 0.24), 0.5 * kPi - 0.80, 0.38, 3);
	Mask mask = drawMask("leaves", 192, [&](glm::dvec2 p) { return isInsideAny(blades, p); });
	mask.wrap_u = Wrap::clamp;
	mask.wrap_v = Wrap::clamp;
	return mask;
}

Mask grassMask()
{
	std::vector<Blade> blades;
	for (unsigned i = 0; i < 18; ++i)
	{
		const double x = 0.08 + 0.84 * radicalInverse(i + 1, 2);
		const double height = 0.45 + 0.5 * radicalInverse(i + 1, 3);
		const double lean = 0.5 * (radicalInverse(i + 1, 5) - 0.5);
		blades.push_back({{x, -0.25},
						  {0.04 + 0.92 * (x + lean * 0.6 < 0.0   ? 0.0
										  : x + lean * 0.6 > 1.0 ? 1.0
																 : x + lean * 0.6),
						   height},
						  0.022});
	}
	Mask mask = drawMask("grass", 128, [&](glm::dvec2 p) { return isInsideAny(blades, p); });
	mask.wrap_u = Wrap::clamp;
	mask.wrap_v = Wrap::clamp;
	return mask;
}

Mask chainLinkMask(double width)
{
	// The distance across a diagonal wire is 1/√2 of the distance along an axis.
	const double half = 0.5 * width * std::sqrt(2.0);
	const auto isWire = [half](glm::dvec2 p)
	{
		const double up = fraction(p.x - p.y + 0.5);
		const double down = fraction(p.x + p.y + 0.5);
		return std::fabs(up - 0.5) <= half || std::fabs(down - 0.5) <= half;
	};
	return drawMask("chain link", 96, isWire);
}

void addLeaves(LevelBuilder& builder, Random& random, glm::dvec3 centre, glm::dvec3 radii, double size, int count)
{
	for (int i = 0; i < count; ++i)
	{
		// A direction and a distance; √ puts more of them near the outside.
		const double height = 2.0 * random.uniform() - 1.0;
		const SinCos turn = sinCosOf(2.0 * kPi * random.uniform());
		const double flat = std::sqrt(1.0 - height * height);
		const glm::dvec3 out = {flat * turn.cos, height, flat * turn.sin};
		const double reach = std::sqrt(0.15 + 0.85 * random.uniform());
		const glm::dvec3 at = centre + radii * out * reach;
		// The card hangs outward and down, rotated at random.
		const SinCos roll = sinCosOf(2.0 * kPi * random.uniform());
		const double droop = 0.3 + 0.5 * random.uniform();
		const glm::dvec3 normal = glm::normalize(out + glm::dvec3(0.0, droop, 0.0));
		const Frame frame = frameAlong(at, normal);
		const double scale = size * (0.75 + 0.5 * random.uniform());
		const glm::dvec3 right = scale * (frame.x * roll.cos + frame.z * roll.sin);
		const glm::dvec3 up = glm::cross(normal, right);
		addCard(builder, at - 0.5 * right - 0.3 * up, right, up);
	}
}

void addGrass(LevelBuilder& builder, Random& random, glm::dvec3 centre, double radius, double size, int count)
{
	for (int i = 0; i < count; ++i)
	{
		const double reach = radius * std::sqrt(random.uniform());
		const SinCos around = sinCosOf(2.0 * kPi * random.uniform());
		const SinCos turn = sinCosOf(2.0 * kPi * random.uniform());
		const double scale = size * (0.7 + 0.6 * random.uniform());
		const double lean = 0.25 * (random.uniform() - 0.5);
		const glm::dvec3 right = {scale * turn.cos, 0.0, scale * turn.sin};
		const glm::dvec3 up = {-lean * scale * turn.sin, scale * 0.8, lean * scale * turn.cos};
		const glm::dvec3 foot = centre + glm::dvec3(reach * around.cos, -0.01, reach * around.sin);
		addCard(builder, foot - 0.5 * right, right, up);
	}
}

void addTree(LevelBuilder& builder, Random& random, glm::dvec3 foot, const TreeSize& size, uint32_t bark, uint32_t leaves)
{
	const auto rise = [&](double x, double share, double z)
	{
		return foot + glm::dvec3(x, share * size.trunk_height, z);
	};
	const std::array<glm::dvec3, 6> trunk = {rise(0.0, -0.05, 0.0),  rise(0.0, 0.03, 0.0),   rise(0.03, 0.12, 0.02),
											 rise(0.10, 0.45, 0.05), rise(0.05, 0.8, -0.04), rise(0.12, 1.15, -0.02)};
	const double r = size.trunk_radius;
	const std::array<double, 6> radii = {1.9 * r, 1.6 * r, 1.1 * r, 0.95 * r, 0.8 * r, 0.4 * r};
	builder.beginMesh("trunk", bark);
	addTube(builder, trunk, radii, 16);
	std::vector<glm::dvec3> tips;
	for (int i = 0; i < size.branches; ++i)
	{
		const double share = 0.62 + 0.5 * i / size.branches;
		const SinCos around = sinCosOf(2.39996 * i + 0.4 * random.uniform());
		const double lift = 0.35 + 0.9 * i / size.branches;
		const double length = size.reach * (1.0 - 0.25 * i / size.branches);
		const glm::dvec3 way = {around.cos, lift, around.sin};
		const Limb branch = limbOf(rise(0.07, share, 0.0), way, length, 0.42 * r, random);
		addTube(builder, branch.points, branch.radii, 8);
		tips.push_back(branch.points.back());
		for (const int from : {2, 3})
		{
			const double x = random.uniform() - 0.5;
			const double z = random.uniform() - 0.5;
			const glm::dvec3 side = glm::dvec3(around.cos + 1.6 * x, 0.5, around.sin + 1.6 * z);
			const Limb twig = limbOf(branch.points[static_cast<std::size_t>(from)], side, 0.55 * length, 0.16 * r, random);
			addTube(builder, twig.points, twig.radii, 6);
			tips.push_back(twig.points.back());
		}
	}
	builder.beginMesh("leaves", leaves);
	for (const glm::dvec3 tip : tips)
	{
		addLeaves(builder, random, tip, glm::dvec3(0.32, 0.24, 0.32) * size.reach, size.card, size.cards / 3);
	}
}

} // namespace nook
