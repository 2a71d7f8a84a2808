// SPDX-License-Identifier: GPL-3.0-or-later
#include "small_gbuffers.h"

#include "methods/block.h"
#include "shade/shade.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace nook;

namespace
{

// Greatest distance of a normal from `normal` among the pixels with a neighbour on each axis.
double worstError(const GBuffer& gbuffer, const glm::dvec3& normal)
{
	const auto there = [&](int x, int y)
	{
		return x >= 0 && y >= 0 && x < gbuffer.width_px && y < gbuffer.height_px &&
			   std::isfinite(gbuffer.depth[static_cast<std::size_t>(y * gbuffer.width_px + x)]);
	};
	double worst = -1.0; // fails for a picture without such pixels
	for (int y = 0; y < gbuffer.height_px; ++y)
	{
		for (int x = 0; x < gbuffer.width_px; ++x)
		{
			const bool across = there(x - 1, y) || there(x + 1, y) || gbuffer.width_px == 1;
			const bool along = there(x, y - 1) || there(x, y + 1) || gbuffer.height_px == 1;
			if (there(x, y) && across && along)
			{
				const glm::dvec3 found(gbuffer.normals[static_cast<std::size_t>(y * gbuffer.width_px + x)]);
				worst = std::max(worst, glm::length(found - normal));
			}
		}
	}
	return worst;
}

} // namespace

TEST_CASE("scene: normals from the depth of a plane are the plane's", "[gbuffer]")
{
	for (const NamedProjection& projection : projections(1.5))
	{
		for (const double tilt_deg : {0.0, 30.0, 60.0, 80.0})
		{
			for (const double turn_deg : {0.0, 50.0, 170.0, 290.0})
			{
				INFO(projection.name << ", " << tilt_deg << ", " << turn_deg);
				const double tilt = tilt_deg * 0.0174532925199433;
				const double turn = turn_deg * 0.0174532925199433;
				const glm::dvec3 normal(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
				// At 5 m on the axis; further away for parallel rays, which would otherwise meet a plane of 80° behind the camera.
				const double offset = -5.0 * normal.z * (projection.matrix[3][3] == 1.0 ? 10.0 : 1.0);
				GBuffer gbuffer = made(48, 32, projection.matrix, plane(normal, offset));
				normalsFromDepth(gbuffer);
				const double worst = worstError(gbuffer, normal);
				CHECK(worst >= 0.0);
				CHECK(worst < 5e-4);
			}
		}
	}
}

TEST_CASE("scene: normals from depth are right on both sides of an edge", "[gbuffer]")
{
	const glm::dmat4 projection = projectionOf({false, 1.0, 1.0, 0.1, 100.0}, 1.5);
	const glm::dvec3 near_normal = glm::normalize(glm::dvec3(0.5, 0.2, 1.0));
	const glm::dvec3 far_normal = glm::normalize(glm::dvec3(-0.3, 0.6, 1.0));
	const DepthOf near_plane = plane(near_normal, -2.0);
	const DepthOf far_plane = plane(far_normal, -6.0);
	// A slanted silhouette, and sky above the far plane's upper edge.
	const auto isNear = [](int x, int y)
	{
		return 2 * x + y < 60;
	};
	GBuffer gbuffer = made(48, 32, projection,
						   [&](int x, int y, const ViewLine& line)
						   {
							   if (y < 4) // gives each plane's uppermost pixels a neighbour below in the same plane
							   {
								   return std::numeric_limits<double>::infinity();
							   }
							   return isNear(x, y) ? near_plane(x, y, line) : far_plane(x, y, line);
						   });
	normalsFromDepth(gbuffer);
	int wrong = 0;
	for (int y = 4; y < 32; ++y)
	{
		for (int x = 0; x < 48; ++x)
		{
			const glm::dvec3 found(gbuffer.normals[static_cast<std::size_t>(48 * y + x)]);
			wrong += glm::length(found - (isNear(x, y) ? near_normal : far_normal)) > 1e-4 ? 1 : 0;
		}
	}
	CHECK(wrong == 0);
	CHECK(gbuffer.normals[0] == glm::vec3(0.0F));

	// Likewise where the surface is two pixels wide, with a step on either side.
	const DepthOf behind = plane({0.0, 0.0, 1.0}, -20.0);
	GBuffer strip = made(12, 12, projection,
						 [&](int x, int y, const ViewLine& line) {
							 return x == 5 || x == 6 ? near_plane(x, y, line) : x < 5 ? far_plane(x, y, line) : behind(x, y, line);
						 });
	normalsFromDepth(strip);
	for (int y = 0; y < 12; ++y)
	{
		for (const int x : {5, 6})
		{
			CHECK(glm::length(glm::dvec3(strip.normals[static_cast<std::size_t>(12 * y + x)]) - near_normal) < 1e-4);
		}
	}
}

TEST_CASE("scene: normals from depth where there is little to go by", "[gbuffer]")
{
	const glm::dmat4 projection = projectionOf(Lens(), 1.0);
	// An isolated pixel faces the camera.
	GBuffer alone =
		made(5, 5, projection,
			 [](int x, int y, const ViewLine&) { return x == 1 && y == 3 ? 2.0 : std::numeric_limits<double>::infinity(); });
	normalsFromDepth(alone);
	const Projector projector(projection, 5, 5);
	CHECK(glm::length(glm::dvec3(alone.normals[16]) + glm::normalize(projector.lineOf({1.5, 3.5}).along)) < 1e-6);
	CHECK(alone.normals[15] == glm::vec3(0.0F));

	// A single column knows only its vertical slope, and faces the camera otherwise.
	const glm::dvec3 normal = glm::normalize(glm::dvec3(0.0, 1.0, 1.0));
	GBuffer column = made(1, 9, projection, plane(normal, -3.0));
	normalsFromDepth(column);
	const double worst_of_column = worstError(column, normal);
	CHECK(worst_of_column >= 0.0);
	CHECK(worst_of_column < 1e-4);

	GBuffer single = made(1, 1, projection, plane(normal, -3.0));
	normalsFromDepth(single);
	CHECK(glm::length(single.normals[0] - glm::vec3(0.0F, 0.0F, 1.0F)) < 1e-6F);

	GBuffer sky = made(4, 4, projection, [](int, int, const ViewLine&) { return std::numeric_limits<double>::infinity(); });
	normalsFromDepth(sky);
	CHECK(sky.normals == std::vector<glm::vec3>(16, glm::vec3(0.0F)));
}

TEST_CASE("scene: normals from depth are the same on any number of threads, and face the camera", "[gbuffer]")
{
	const glm::dmat4 projection = projectionOf({false, 1.4, 1.0, 0.1, 100.0}, 1.5);
	GBuffer one =
		made(48, 32, projection,
			 [](int x, int y, const ViewLine&) { return 3.0 + std::sin(0.4 * x) * std::cos(0.3 * y) + (x % 7 == 0 ? 2.0 : 0.0); });
	GBuffer many = one;
	normalsFromDepth(one);
	RunSettings run;
	run.threads = 5;
	normalsFromDepth(many, run);
	CHECK(one.normals == many.normals);
	const Projector projector(projection, 48, 32);
	for (int i = 0; i < 48 * 32; ++i)
	{
		const glm::dvec3 normal(one.normals[static_cast<std::size_t>(i)]);
		const ViewLine line = projector.lineOf({i % 48 + 0.5, i / 48 + 0.5}); // NOLINT: whole numbers of pixels
		CHECK(glm::dot(normal, line.along) <= 0.0);
		CHECK(glm::length(normal) == Approx(1.0));
	}
}

TEST_CASE("scene: the kernel's normals from depth are those of the file's", "[gbuffer]")
{
	for (const NamedProjection& projection : projections(1.5))
	{
		INFO(projection.name);
		GBuffer gbuffer =
			made(48, 32, projection.matrix,
				 [](int x, int y, const ViewLine&)
				 {
					 return x > 40 ? std::numeric_limits<double>::infinity()
								   : 3.0 + std::sin(0.4 * x) * std::cos(0.3 * y) + (x % 7 == 0 ? 2.0 : 0.0) + 0.01 * x * y;
				 });
		normalsFromDepth(gbuffer);
		const std::vector<float> depths = finiteDepths(gbuffer);
		shade_kernels::Kernels kernels;
		fillCamera(kernels.nook, gbuffer.view.projection, 48, 32);
		kernels.depths = depths;
		int off = 0;
		for (int i = 0; i < 48 * 32; ++i)
		{
			const auto at = static_cast<std::size_t>(i);
			if (std::isfinite(gbuffer.depth[at]))
			{
				off += glm::length(kernels.nookNormalFromDepth({i % 48, i / 48}) - gbuffer.normals[at]) > 1e-3F ? 1 : 0;
			}
		}
		CHECK(off <= 2); // both sides continue equally badly
	}
}
