// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes drawn by OpenGL against a twin that asks every volume at every pixel.
#include "small_gbuffers.h"
#include "small_volumes.h"

#include "core/error.h"
#include "shade/aov_gl_parts.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>

using namespace nook;
using namespace nook::test;

namespace
{

GBuffer castOf(const Level& level, const View& view, int width, int height)
{
	const Tracer tracer(level, {});
	return castGBuffer(tracer, view, width, height, NormalKind::geometric, {});
}

struct Difference
{
	double mean = 0.0;
	double within = 0.0; // share of pixels that differ by at most 1/255
	double most = 0.0;
};

Difference differenceOf(const std::vector<float>& a, const std::vector<float>& b)
{
	Difference difference;
	for (std::size_t i = 0; i < a.size(); ++i)
	{
		const double one = std::fabs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
		difference.mean += one;
		difference.within += one <= 1.0 / 255.0 ? 1.0 : 0.0;
		difference.most = std::max(difference.most, one);
	}
	difference.mean /= static_cast<double>(a.size());
	difference.within /= static_cast<double>(a.size());
	return difference;
}

AovSettings exact()
{
	AovSettings settings;
	settings.target = AovTarget::r32f;
	return settings;
}

void isTwin(const GBuffer& gbuffer, const VolumeSet& set, const AovGlOptions& options, const std::string& what)
{
	const std::vector<float> expected = visibilityOf(gbuffer, set, true);
	const AovShaded drawn = aovOnGl(gbuffer, set, exact(), {}, options);
	const Difference difference = differenceOf(drawn.shaded.visibility, expected);
	INFO(what << ": mean " << difference.mean << ", within 1/255: " << difference.within << ", most " << difference.most << ", "
			  << drawn.counts.fragments << " fragments of " << drawn.counts.volumes_drawn << " volumes");
	CHECK(difference.mean <= 1e-4);
	CHECK(difference.within >= 0.999);
	CHECK(*std::min_element(expected.begin(), expected.end()) < 0.7F);
}

} // namespace

TEST_CASE("aov on OpenGL: the sum of all volumes, by both layouts and both kinds of buffers", "[aov_gl]")
{
	const Level level = builtinLevel("cornell");
	const GBuffer gbuffer = castOf(level, viewOf(level.cameras.front(), 64, 48), 64, 48);
	for (const bool two_sided : {false, true})
	{
		const VolumeSet set = volumesOf(level, 0.4, 8, two_sided);
		for (const bool storage : {false, true})
		{
			for (const bool prisms : {false, true})
			{
				isTwin(gbuffer, set, {storage, prisms, false},
					   std::string(storage ? "storage buffers" : "textures") + (prisms ? ", prisms" : ", polygons"));
			}
		}
		isTwin(gbuffer, set, {false, false, true}, "back faces");
	}
}

TEST_CASE("aov on OpenGL: any projection, and an eye within volumes", "[aov_gl]")
{
	const Level level = builtinLevel("cornell");
	const VolumeSet set = volumesOf(level, 0.5, 4);
	for (const NamedProjection& projection : projections(4.0 / 3.0))
	{
		// From inside the box, where most volumes hold the eye.
		for (const glm::dvec3 eye : {glm::dvec3(0.1, 0.3, 0.2), glm::dvec3(0.4, 0.9, -0.3)})
		{
			const glm::dmat4 view = glm::inverse(worldFromCamera(eye, {-0.2, 0.1, -0.4}));
			isTwin(castOf(level, {view, projection.matrix}, 48, 36), set, {}, projection.name);
		}
	}
}
