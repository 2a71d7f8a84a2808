// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes drawn by OpenGL compared with a reference that evaluates every volume at every pixel.
#include "picture_errors.h"
#include "small_gbuffers.h"
#include "small_volumes.h"
#include "testing.h"

#include "shade/aov_gl_parts.h"
#include "volume/evaluate.h"

#include <glm/gtc/matrix_transform.hpp>

namespace
{

GBuffer castOf(const Level& level, const View& view, int width, int height)
{
	const Tracer tracer(level, {});
	return castGBuffer(tracer, view, width, height, NormalKind::geometric, {});
}

AovSettings exact()
{
	AovSettings settings{.target = AovTarget::r32f};
	return settings;
}

void isTwin(const GBuffer& gbuffer, const VolumeSet& set, const AovGlOptions& options, const std::string& what)
{
	const std::vector<float> expected = visibilityOf(gbuffer, set, true);
	const AovShaded drawn = aovOnGl(gbuffer, set, exact(), {}, options);
	const Difference difference = differenceOf(drawn.shaded.visibility, expected);
	INFO(what << ": mean " << difference.mean << ", beyond 1/255: " << difference.beyond << ", most " << difference.worst << ", "
			  << drawn.counts.fragments << " fragments of " << drawn.counts.volumes_drawn << " volumes");
	CHECK(difference.mean <= 1e-4);
	CHECK(difference.beyond <= 0.001);
	CHECK(*std::min_element(expected.begin(), expected.end()) < 0.7F);
}

} // namespace

TEST_CASE("aov on OpenGL: the sum of all volumes, by both layouts and both kinds of buffers", "[aov_gl]")
{
	const Level level = builtinLevel("cornell");
	const GBuffer gbuffer = castOf(level, viewOf(level.cameras.front(), 64, 48), 64, 48);
	const bool two_sided = GENERATE(false, true);
	const VolumeSet set = volumesOf(level, 0.4, 8, two_sided);
	for (const bool storage : {false, true})
	{
		for (const bool prisms : {false, true})
		{
			isTwin(gbuffer, set, {storage, prisms, true, false},
				   std::string(storage ? "storage buffers" : "textures") + (prisms ? ", prisms" : ", polygons"));
		}
	}
	isTwin(gbuffer, set, {false, false, true, true, false}, "back faces");
	isTwin(gbuffer, set, {false, false, true, false, false}, "front faces of clusters that do not hold the eye");
}

TEST_CASE("aov on OpenGL: a hair behind the planes of volumes of one side", "[aov_gl]")
{
	const Level level = builtinLevel("cornell");
	const GBuffer gbuffer = castOf(level, viewOf(level.cameras.front(), 64, 48), 64, 48);
	VolumeSet set = volumesOf(level, 0.4, 8);
	// Moves all surfaces that far behind the planes of volumes that face the camera's side.
	const View& view = gbuffer.view;
	const glm::dvec3 toward(glm::inverse(view.camera_from_world) * glm::dvec4(0.0, 0.0, 1.0, 0.0));
	for (glm::dvec3& corner : set.occluders.corners)
	{
		corner += 0.6 * kVolumeBias * set.distance_m * toward;
	}
	const bool prisms = GENERATE(false, true);
	isTwin(gbuffer, set, {false, prisms, true, false}, prisms ? "prisms" : "polygons");
}

TEST_CASE("aov on OpenGL: any projection, and an eye within volumes", "[aov_gl]")
{
	const Level level = builtinLevel("cornell");
	const VolumeSet set = volumesOf(level, 0.5, 4);
	const NamedProjection projection = GENERATE(from_range(projections(4.0 / 3.0)));
	// From inside the box, where most volumes contain the eye.
	const glm::dvec3 eye = GENERATE(glm::dvec3(0.1, 0.3, 0.2), glm::dvec3(0.4, 0.9, -0.3));
	const glm::dmat4 view = glm::inverse(worldFromCamera(eye, {-0.2, 0.1, -0.4}));
	isTwin(castOf(level, {view, projection.matrix}, 48, 36), set, {}, projection.name);
}

TEST_CASE("aov on OpenGL: as on the CPU, clamped bounds, masks and one pixel of many, too", "[aov_gl]")
{
	const Level level = builtinLevel("cornell");
	const GBuffer gbuffer = castOf(level, viewOf(level.cameras.front(), 61, 46), 61, 46);
	const bool exact_bounds = GENERATE(false, true);
	VolumeSet set = volumesOf(level, 0.6, 8, exact_bounds);
	set.exact_bounds = exact_bounds;
	const int every_px = GENERATE(1, 3, 5);
	const int directions = GENERATE(0, 32, 64, 128, 160, 192, 256);
	AovSettings settings = exact();
	settings.every_px = every_px;
	settings.mask = directions > 0;
	settings.directions = std::max(directions, 32);
	const AovShaded expected = aovOnCpu(gbuffer, set, settings, {2, {}});
	const AovShaded drawn = aovOnGl(gbuffer, set, settings);
	const Difference difference = differenceOf(drawn.shaded.visibility, expected.shaded.visibility);
	INFO(every_px << " px, " << directions << " directions: mean " << difference.mean << ", beyond 1/255 " << difference.beyond
				  << ", most " << difference.worst);
	// A direction that just misses an edge or a threshold changes one bit; and AOV's clamp cuts volumes where they
	// still occlude, so a pixel at the cut is a step.
	CHECK(difference.mean <= 1e-4);
	CHECK(difference.beyond <= (settings.mask || !exact_bounds ? 0.01 : 0.001));
	// Both draw the same pixels individually, except at a threshold of the rule.
	CHECK(drawn.counts.pixels_alone * 100 >= expected.counts.pixels_alone * 99);
	CHECK(drawn.counts.pixels_alone * 99 <= expected.counts.pixels_alone * 100);
	CHECK((drawn.counts.pixels_alone > 0) == (every_px > 1));
	CHECK(drawn.counts.fragments >= expected.counts.fragments);
}

TEST_CASE("aov on OpenGL: fewer bits of the sum change it by less than their steps", "[aov_gl]")
{
	const Level level = builtinLevel("courtyard");
	const GBuffer gbuffer = castOf(level, viewOf(level.cameras.front(), 32, 18), 32, 18);
	const VolumeSet set = volumesOf(level, 1.0, 64);
	const std::vector<float> expected = aovOnCpu(gbuffer, set, exact(), {2, {}}).shaded.visibility;
	const AovTarget target = GENERATE(AovTarget::r32f, AovTarget::r16f, AovTarget::r8);
	AovSettings settings = exact();
	settings.target = target;
	const AovShaded drawn = aovOnGl(gbuffer, set, settings);
	const Difference difference = differenceOf(drawn.shaded.visibility, expected);
	INFO("mean " << difference.mean << ", beyond 1/255 " << difference.beyond << ", most " << difference.worst << ", "
				 << drawn.counts.fragments << " fragments");
	CHECK(difference.mean <= (target == AovTarget::r32f ? 1e-4 : target == AovTarget::r16f ? 1e-3 : 1e-2));
	// Without depth bounds, which not every driver supports.
	const AovShaded unbound = aovOnGl(gbuffer, set, settings, {}, {false, false, false, false});
	CHECK(unbound.shaded.visibility == drawn.shaded.visibility);
	CHECK(unbound.counts.fragments >= drawn.counts.fragments);
	settings.cull = false;
	const AovShaded all = aovOnGl(gbuffer, set, settings);
	CHECK(all.shaded.visibility == drawn.shaded.visibility);
	CHECK(all.counts.volumes_drawn == set.occluders.polygons.size());
	CHECK(drawn.counts.volumes_drawn < all.counts.volumes_drawn);
	CHECK(drawn.counts.fragments <= all.counts.fragments);
}

TEST_CASE("aov on OpenGL: far from the origin as at it", "[aov_gl]")
{
	Level level = builtinLevel("cornell");
	LevelCamera camera = level.cameras.front();
	const GBuffer near = castOf(level, viewOf(camera, 48, 36), 48, 36);
	const std::vector<float> expected = aovOnGl(near, volumesOf(level, 0.4, 8), exact()).shaded.visibility;
	const glm::dvec3 moved(1e5, -131072.0, 65536.0);
	for (glm::dvec3& position : level.positions)
	{
		position += moved;
	}
	GBuffer far = near;
	far.view.camera_from_world = near.view.camera_from_world * glm::translate(glm::dmat4(1.0), -moved);
	const Difference difference = differenceOf(aovOnGl(far, volumesOf(level, 0.4, 8), exact()).shaded.visibility, expected);
	INFO("mean " << difference.mean << ", most " << difference.worst);
	CHECK(difference.mean <= 1e-5);
	CHECK(difference.worst <= 1e-3);
}

TEST_CASE("aov on OpenGL: volumes that are cut, by both layouts and both kinds of buffers, and masks of them", "[aov_gl][trim]")
{
	const Level level = builtinLevel("cornell");
	const GBuffer gbuffer = castOf(level, viewOf(level.cameras.front(), 64, 48), 64, 48);
	const bool two_sided = GENERATE(false, true);
	VolumeSet set = volumesOf(level, 0.6, 8, two_sided);
	const AovShaded whole = aovOnGl(gbuffer, set, exact());
	for (std::size_t i = 0; i < set.occluders.polygons.size(); ++i)
	{
		set.occluders.polygons[i].reach = static_cast<float>(i % 4 + 1) / 4.0F;
		set.occluders.polygons[i].side_reach = set.occluders.polygons[i].reach * static_cast<float>(i % 3 + 5) / 8.0F;
	}
	const std::vector<float> expected = visibilityOf(gbuffer, set, true);
	CHECK(differenceOf(whole.shaded.visibility, expected).mean > 0.001);
	for (const bool storage : {false, true})
	{
		for (const bool prisms : {false, true})
		{
			const AovShaded drawn = aovOnGl(gbuffer, set, exact(), {}, {storage, prisms, true, false});
			const Difference difference = differenceOf(drawn.shaded.visibility, expected);
			INFO((storage ? "storage" : "textures")
				 << (prisms ? ", prisms" : ", polygons") << ": mean " << difference.mean << ", beyond 1/255: " << difference.beyond
				 << ", most " << difference.worst << ", " << drawn.counts.fragments << " of " << whole.counts.fragments
				 << " fragments");
			// A pixel at a cut is a step, and prisms are rounded.
			CHECK(difference.mean <= 5e-4);
			CHECK(difference.beyond <= 0.01);
			CHECK(drawn.counts.fragments < whole.counts.fragments);
		}
	}
	AovSettings masks = exact();
	masks.mask = true;
	const AovShaded on_cpu = aovOnCpu(gbuffer, set, masks, {2, {}});
	const Difference difference = differenceOf(aovOnGl(gbuffer, set, masks).shaded.visibility, on_cpu.shaded.visibility);
	INFO("masks: mean " << difference.mean << ", beyond 1/255: " << difference.beyond << ", most " << difference.worst);
	CHECK(difference.mean <= 2e-4);
	CHECK(difference.beyond <= 0.01);
}

TEST_CASE("aov on OpenGL: faces chosen volume by volume: the same picture, fewer fragments", "[aov_gl]")
{
	const Level level = builtinLevel("cornell");
	const VolumeSet set = volumesOf(level, 0.4, 8);
	const GBuffer gbuffer = castOf(level, viewOf(level.cameras.front(), 64, 48), 64, 48);
	// Without depth bounds, which leave out much the same fragments where a driver has them.
	const int every_px = GENERATE(1, 3);
	AovSettings settings = exact();
	settings.every_px = every_px;
	const AovShaded front = aovOnGl(gbuffer, set, settings, {}, {false, false, false, false, false});
	const AovShaded back = aovOnGl(gbuffer, set, settings, {}, {false, false, false, true, false});
	const bool storage = GENERATE(false, true);
	const bool prisms = GENERATE(false, true);
	const AovShaded chosen = aovOnGl(gbuffer, set, settings, {}, {storage, prisms, false, false, true});
	INFO(every_px << " px, " << front.counts.fragments << " fragments of front faces, " << back.counts.fragments
				  << " of back faces, " << chosen.counts.fragments << " chosen");
	CHECK(differenceOf(chosen.shaded.visibility, front.shaded.visibility).worst <= (prisms ? 0.01 : 1e-5));
	CHECK(10 * chosen.counts.fragments < 9 * std::min(front.counts.fragments, back.counts.fragments));
}

TEST_CASE("aov on OpenGL: volumes that float before a surface, or lie behind one, have no fragments", "[aov_gl]")
{
	// Looking down -z at a wall 4 m away; polygons with a reach of 0.2 m, 2 m in front of it, 2 m behind it, and on it.
	const auto square = [](double z, double half)
	{
		return std::vector<glm::dvec3>{{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
	};
	GBuffer gbuffer;
	gbuffer.width_px = 32;
	gbuffer.height_px = 24;
	gbuffer.view = {glm::dmat4(1.0), glm::perspective(1.0, 4.0 / 3.0, 0.1, 100.0)};
	gbuffer.depth.assign(32 * 24, 4.0F);
	gbuffer.normals.assign(32 * 24, glm::vec3(0.0F, 0.0F, 1.0F));
	const double z = GENERATE(-2.0, -6.0, -3.9);
	VolumeSet set;
	set.distance_m = 0.2;
	set.exact_bounds = true; // required for choosing faces
	set.occluders.corners = square(z, 0.5);
	set.occluders.polygons = {{0, 4, 0, 1.0F, true}};
	clusterVolumes(set, {}, {});
	AovSettings all = exact();
	all.cull = false; // otherwise whole clusters are culled
	const uint64_t chosen = aovOnGl(gbuffer, set, all).counts.fragments;
	const uint64_t front = aovOnGl(gbuffer, set, all, {}, {false, false, false, false, false}).counts.fragments;
	const uint64_t back = aovOnGl(gbuffer, set, all, {}, {false, false, false, true, false}).counts.fragments;
	INFO("at " << z << ": " << chosen << " chosen, " << front << " front, " << back << " back");
	CHECK((front > 0) == (z > -5.0));
	CHECK((back > 0) == (z < -3.0));
	CHECK((chosen > 0) == (z == -3.9));
}
