// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture_errors.h"
#include "small_volumes.h"
#include "testing.h"

#include "image/compare.h"
#include "methods/aov_text.h"
#include "methods/block.h"
#include "scene/reference.h"
#include "shade/shade.h"
#include "volume/evaluate.h"

namespace
{

void add(VolumeSet& set, const Corners& corners, bool two_sided = false, float alpha = 1.0F)
{
	set.occluders.add({.alpha = alpha, .two_sided = two_sided}, corners);
}

// The wall x = 0, which faces +x, with its foot at y = 0; in columns × rows of rectangles.
VolumeSet wall(int columns, int rows, double half_width = 50.0, double height = 50.0)
{
	VolumeSet set = setOf({}, 1.0);
	for (int c = 0; c < columns; ++c)
	{
		for (int r = 0; r < rows; ++r)
		{
			const double z0 = half_width * (2.0 * c / columns - 1.0);
			const double z1 = half_width * (2.0 * (c + 1) / columns - 1.0);
			const double y0 = height * r / rows;
			const double y1 = height * (r + 1) / rows;
			add(set, {{0, y0, z0}, {0, y1, z0}, {0, y1, z1}, {0, y0, z1}});
		}
	}
	return set;
}

// Share of the directions that the polygons cover at a receiver, each direction tested against each polygon, in 64 bits; below 0
// where a polygon is too close to the receiver.
double coveredAt(const VolumeSet& set, glm::dvec3 position, glm::dvec3 normal, int count)
{
	const std::vector<glm::vec3>& rays = maskTablesOf(count).rays;
	std::vector<uint8_t> covered(rays.size());
	volume_kernels::Kernels kernels;
	const glm::dvec3 x(kernels.nookTangent(glm::vec3(normal), 0));
	const glm::dvec3 y(kernels.nookTangent(glm::vec3(normal), 1));
	for (const Occluder& polygon : set.occluders.polygons)
	{
		const std::span<const glm::dvec3> corners = set.occluders.cornersOf(polygon);
		const glm::dvec3 front = frontOf(corners);
		const double height = -glm::dot(front, corners[0] - position);
		if (std::fabs(height) < 2e-4 * set.distance_m)
		{
			return -1.0; // lifted
		}
		const double side = height < 0.0 ? -1.0 : 1.0;
		for (std::size_t i = 0; i < rays.size(); ++i)
		{
			const glm::dvec3 ray = glm::dvec3(rays[i].x) * x + glm::dvec3(rays[i].y) * y + glm::dvec3(rays[i].z) * normal;
			const uint32_t share = kernels.nookMaskShare(static_cast<int>(i / 32), polygon.alpha,
														 kernels.nookShift(static_cast<int>(polygon.first_corner)));
			bool crosses = (polygon.alpha == 1.0F || (share >> (i % 32) & 1U) != 0) && (polygon.two_sided || height > 0.0) &&
						   -side * glm::dot(front, ray) * set.distance_m > std::fabs(height);
			for (std::size_t k = 0; crosses && k < corners.size(); ++k)
			{
				const glm::dvec3 from = corners[k] - position;
				const glm::dvec3 to = corners[(k + 1) % corners.size()] - position;
				crosses = side * glm::dot(glm::cross(to, from), ray) >= 0.0;
			}
			covered[i] |= crosses ? 1 : 0;
		}
	}
	return static_cast<double>(std::count(covered.begin(), covered.end(), 1)) / count;
}

// Ray-traced visibility with the linear falloff 1 - t/reach of a floor point at that distance from an endless wall.
double raysNextToWall(double distance, double reach)
{
	constexpr int kSteps = 400;
	double sum = 0.0;
	for (int i = 0; i < kSteps; ++i)
	{
		const double radius = std::sqrt((i + 0.5) / kSteps);
		for (int k = 0; k < kSteps; ++k)
		{
			const double across = radius * std::cos(2.0 * 3.14159265358979 * (k + 0.5) / kSteps);
			sum += across * reach > distance ? 1.0 - distance / (across * reach) : 0.0;
		}
	}
	return sum / (kSteps * kSteps);
}

struct SmallView
{
	Level level;
	GBuffer gbuffer;
};

SmallView viewOfLevel(const std::string& name)
{
	SmallView view{builtinLevel(name), {}};
	const Tracer tracer(view.level, {});
	view.gbuffer = castGBuffer(tracer, viewOf(view.level.cameras.front(), 96, 54), 96, 54, NormalKind::geometric, {});
	return view;
}

// Evaluates nookSparse from one pixel of every cell; −1 where it leaves a pixel to be drawn.
std::vector<float> sparseOf(const GBuffer& gbuffer, const std::vector<float>& visibility, double distance_m, int every_px)
{
	ShadeSettings settings;
	settings.radius_m = distance_m;
	const std::vector<float> depths = finiteDepths(gbuffer);
	const auto width = static_cast<std::size_t>(gbuffer.width_px);
	PicturePlane cells;
	cells.width = (gbuffer.width_px + every_px - 1) / every_px;
	cells.height = (gbuffer.height_px + every_px - 1) / every_px;
	for (int i = 0; i < cells.width * cells.height; ++i)
	{
		const int x = i % cells.width * every_px;
		const int y = i / cells.width * every_px;
		cells.values.push_back(visibility[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)]);
	}
	shade_kernels::Kernels kernels;
	kernels.nook = blockOf(frameOf(gbuffer), {}, settings);
	kernels.nook.cell = every_px;
	kernels.depths = depths;
	kernels.normals = gbuffer.normals;
	kernels.cells = &cells;
	std::vector<float> filtered;
	for (int i = 0; i < gbuffer.width_px * gbuffer.height_px; ++i)
	{
		filtered.push_back(kernels.nookSparse({i % gbuffer.width_px, i / gbuffer.width_px}));
	}
	return filtered;
}

std::vector<float> linearReference(const SmallView& view, double radius_m)
{
	const Tracer tracer(view.level, {});
	ReferenceSettings settings{.falloff = Falloff::linear, .radius_m = radius_m, .rays = 1000};
	const std::vector<float> visibility = mapped(referenceOfGBuffer(&tracer, view.gbuffer, settings, {4, {}}),
												 [](const ReferenceValue& value) { return static_cast<float>(value.visibility); });
	return visibility;
}

} // namespace

TEST_CASE("aov: a floor beside a wall is half covered, less the share of the reach that it is away", "[aov]")
{
	const VolumeSet set = wall(1, 1);
	const VolumeEvaluator evaluator(set, {}, true);
	for (const double distance : {0.001, 0.1, 0.5, 0.9})
	{
		CHECK(evaluator.occlusion({distance, 0, 0}, {0, 1, 0}) == Approx(0.5 * (1.0 - distance)).epsilon(0.025));
	}
	CHECK(evaluator.occlusion({1.1, 0, 0}, {0, 1, 0}) == 0.0);
	CHECK(evaluator.occlusion({-0.1, 0, 0}, {0, 1, 0}) == 0.0); // behind it
	CHECK(evaluator.occlusion({0, 1, 0}, {1, 0, 0}) == 0.0);    // itself
	CHECK(evaluator.occlusion({0, 1, 0}, glm::normalize(glm::dvec3(1, 0.4, 0))) == 0.0);
}

TEST_CASE("aov: at a crease, a hair behind a wall's plane is as a hair before it", "[aov]")
{
	VolumeSet set;
	add(set, {{0, 0, 1}, {0, 0, -1}, {0, 1, -1}, {0, 1, 1}}); // faces +x
	const VolumeEvaluator evaluator(set, {}, true);
	const double bias_m = kVolumeBias * set.distance_m;
	const double before = evaluator.occlusion({0.5 * bias_m, 0, 0}, {0, 1, 0});
	REQUIRE(before > 0.2);
	for (const double share : {0.99, 0.7, 0.3, 0.01})
	{
		INFO(share);
		CHECK(evaluator.occlusion({-share * bias_m, 0, 0}, {0, 1, 0}) == Approx(before).epsilon(1e-3));
	}
	CHECK(evaluator.occlusion({-1.5 * bias_m, 0, 0}, {0, 1, 0}) == 0.0);
}

TEST_CASE("aov: a disk above has the form factor r^2 / (r^2 + h^2)", "[aov]")
{
	VolumeSet set;
	set.distance_m = 1000.0; // no noticeable falloff except that of the height
	// A regular polygon of 16 corners whose area is the disk's.
	constexpr double kPi = 3.14159265358979;
	const double radius = std::sqrt(kPi / (8.0 * std::sin(kPi / 8.0)));
	std::vector<glm::dvec3> corners;
	for (int i = 0; i < 16; ++i)
	{
		corners.emplace_back(radius * std::cos(i * kPi / 8.0), 1.0, radius * std::sin(i * kPi / 8.0));
	}
	add(set, corners); // faces down
	const VolumeEvaluator evaluator(set, {}, true);
	CHECK(evaluator.occlusion({0, 0, 0}, {0, 1, 0}) / (1.0 - 1.0 / 1000.0) == Approx(0.5).margin(1e-3));
}

TEST_CASE("aov: two sides darken both, alike", "[aov]")
{
	VolumeSet set;
	add(set, {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}, true, 0.5F);
	const VolumeEvaluator evaluator(set, {}, true);
	const double under = evaluator.occlusion({0.2, 0.6, 0.1}, {0, 1, 0});
	CHECK(under > 0.1);
	CHECK(evaluator.occlusion({0.2, 1.4, 0.1}, {0, -1, 0}) == Approx(under).epsilon(1e-5));
	CHECK(evaluator.occlusion({0.2, 1.4, 0.1}, {0, 1, 0}) == 0.0);
	CHECK(evaluator.mask({0.2, 0.6, 0.1}, {0, 1, 0}, 256).visibility == Approx(1.0 - 0.5 * under).margin(0.2));
}

TEST_CASE("aov: sums of many receivers at once are those of each alone, and may stop when they suffice", "[aov]")
{
	const SmallView view = viewOfLevel("cornell");
	VolumeSet set = volumesOf(view.level, 0.7, 16);
	set.compensation = {1.0, {0.0, 0.5}};
	std::fill(set.compensation.occlusion.begin() + 8, set.compensation.occlusion.end(), 0.5);
	const double enough = set.compensation.enough();
	REQUIRE(enough == 0.25);
	CHECK(set.compensation.at(enough) == set.compensation.at(2.0));
	const VolumeEvaluator evaluator(set, {});
	Random random(7, 0);
	std::vector<VolumeReceiver> receivers;
	for (int i = 0; i < 100; ++i)
	{
		const glm::dvec3 at = set.occluders.corners[random.below(static_cast<uint32_t>(set.occluders.corners.size()))];
		receivers.push_back({at + 0.2 * glm::dvec3(random.uniform(), random.uniform(), random.uniform()), {0, 1, 0}});
	}
	std::vector<VolumeSum> all(receivers.size());
	std::vector<VolumeSum> few(receivers.size());
	evaluator.sums(receivers, all);
	evaluator.sums(receivers, few, false, enough);
	std::size_t stopped = 0;
	for (std::size_t i = 0; i < receivers.size(); ++i)
	{
		REQUIRE(all[i].occlusion == evaluator.occlusion(receivers[i].position, receivers[i].normal));
		REQUIRE(set.compensation.at(few[i].occlusion) == set.compensation.at(all[i].occlusion));
		stopped += few[i].volumes < all[i].volumes ? 1U : 0U;
	}
	CHECK(stopped > 0);
}

TEST_CASE("aov: what the tree finds is what every volume says, on any number of threads", "[aov]")
{
	const SmallView view = viewOfLevel("cornell");
	VolumeSet set = volumesOf(view.level, 0.7, 16);
	set.plane_error_m = 0.0;
	const AovSettings plain{false, 128, 1, false, AovTarget::r16f, true};
	const AovShaded one = aovOnCpu(view.gbuffer, set, plain, {1, {}});
	const AovShaded four = aovOnCpu(view.gbuffer, set, plain, {4, {}});
	CHECK(one.shaded.visibility == four.shaded.visibility);
	CHECK(one.counts.fragments == four.counts.fragments);
	CHECK(one.counts.fragments > 1'000);
	const std::vector<float> expected = visibilityOf(view.gbuffer, set, false);
	double most = 0.0;
	for (std::size_t i = 0; i < expected.size(); ++i)
	{
		most = std::max(most, std::fabs(static_cast<double>(expected[i]) - static_cast<double>(one.shaded.visibility[i])));
	}
	CHECK(most < 1e-6);
}

TEST_CASE("aov: the curve is applied to the sum, not to each volume", "[aov]")
{
	const SmallView view = viewOfLevel("cornell");
	const VolumeSet set = setOf(trianglesOf(view.level), 0.6, false);
	AovSettings settings{.compensate = false};
	const std::vector<float> plain = aovOnCpu(view.gbuffer, set, settings, {4, {}}).shaded.visibility;
	settings.compensate = true;
	const std::vector<float> compensated = aovOnCpu(view.gbuffer, set, settings, {4, {}}).shaded.visibility;
	for (std::size_t i = 0; i < plain.size(); ++i)
	{
		const auto occlusion = 1.0 - static_cast<double>(plain[i]);
		if (occlusion < 1.0)
		{
			CHECK(static_cast<double>(compensated[i]) == Approx(1.0 - set.compensation.at(occlusion)).margin(1e-6));
		}
	}
}

TEST_CASE("aov-mask: directions share the hemisphere evenly, and thresholds the unit interval", "[aov]")
{
	const int count = GENERATE(32, 96, 128, 256);
	const std::vector<glm::vec4> directions = maskDirections(count);
	glm::dvec3 mean(0.0);
	double threshold = 0.0;
	for (const glm::vec4& d : directions)
	{
		CHECK(glm::length(glm::vec3(d)) == Approx(1.0F).margin(1e-6));
		CHECK((d.z > 0.0F && d.w > 0.0F && d.w < 1.0F));
		CHECK((&d == directions.data() || (&d)[-1].z > d.z));
		mean += glm::dvec3(d) / static_cast<double>(count);
		threshold += static_cast<double>(d.w) / count;
	}
	// Weighted by the cosine, the mean direction is 2/3 of the normal.
	CHECK(glm::length(mean - glm::dvec3(0, 0, 2.0 / 3.0)) < 0.5 / std::sqrt(count));
	CHECK(threshold == Approx(0.5).margin(1.0 / count + 0.02));
}

TEST_CASE("aov-mask: the linear falloff beside a wall, as rays have it", "[aov]")
{
	const VolumeSet set = wall(1, 1);
	const VolumeEvaluator evaluator(set, {}, true);
	const double distance = GENERATE(0.01, 0.1, 0.3, 0.5, 0.8);
	const double expected = raysNextToWall(distance, 1.0);
	CHECK(1.0 - evaluator.mask({distance, 0, 0}, {0, 1, 0}, 256).visibility == Approx(expected).margin(0.02));
	CHECK(1.0 - evaluator.mask({distance, 0, 0}, {0, 1, 0}, 32).visibility == Approx(expected).margin(0.08));
}

TEST_CASE("aov-mask: polygons cover the directions that cross them, but for a few at their edges", "[aov]")
{
	const Level level = builtinLevel("cornell");
	Random random(5);
	double covered = 0.0;
	double off_by = 0.0;
	int samples = 0;
	for (const double distance_m : {0.1, 0.5, 2.0})
	{
		const VolumeSet set = volumesOf(level, distance_m, 8, true);
		const VolumeEvaluator evaluator(set, {}, true);
		for (int sample = 0; sample < 300; ++sample)
		{
			const glm::dvec3 corner = set.occluders.corners[random.below(static_cast<uint32_t>(set.occluders.corners.size()))];
			const auto off = [&]
			{
				return random.uniform() - 0.5;
			};
			const glm::dvec3 at = corner + distance_m * glm::dvec3(off(), off(), off());
			const glm::dvec3 normal = glm::normalize(glm::dvec3(off(), off(), off()));
			for (const int count : {32, 96, 256})
			{
				const double expected = coveredAt(set, at, normal, count);
				if (expected >= 0.0)
				{
					const double found = 1.0 - evaluator.mask(at, normal, count).visibility;
					CHECK(found == Approx(expected).margin(0.07));
					off_by += std::fabs(found - expected);
					covered += expected;
					samples += 1;
				}
			}
		}
	}
	INFO("mean " << covered / samples << ", off by " << off_by / samples);
	CHECK(covered > 0.05 * samples);
	CHECK(off_by < 0.003 * samples);
}

TEST_CASE("aov-mask: a tessellated wall covers the same directions, and two walls behind one another no more", "[aov]")
{
	const VolumeSet whole = wall(1, 1, 2.0, 2.0);
	const VolumeSet pieces = wall(40, 25, 2.0, 2.0);
	VolumeSet twice = whole;
	add(twice, {{-0.05, 0, -2}, {-0.05, 2, -2}, {-0.05, 2, 2}, {-0.05, 0, 2}});
	const VolumeEvaluator of_whole(whole, {}, true);
	const VolumeEvaluator of_pieces(pieces, {}, true);
	const VolumeEvaluator of_twice(twice, {}, true);
	for (int i = 1; i < 30; ++i)
	{
		const glm::dvec3 at(0.025 * i, 0.01 * i, 0.3 - 0.02 * i);
		const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.3, 1.0, 0.01 * i));
		const double visibility = of_whole.mask(at, normal, 256).visibility;
		CHECK(visibility < 1.0);
		CHECK(of_pieces.mask(at, normal, 256).visibility == Approx(visibility).margin(1.5 / 256)); // the table rounds each edge
		CHECK(of_twice.mask(at, normal, 256).visibility == visibility);
		CHECK((i > 20 || of_twice.occlusion(at, normal) > 1.5 * of_whole.occlusion(at, normal)));
	}
}

TEST_CASE("aov-mask: leaves in front of leaves cover more than one leaf does", "[aov]")
{
	VolumeSet set;
	for (int i = 0; i < 12; ++i)
	{
		const double y = 0.01 + 0.001 * i;
		add(set, {{-9, y, -9}, {9, y, -9}, {9, y, 9}, {-9, y, 9}}, true, 0.25F);
	}
	const double one_layer = 0.25 * 0.97;
	const VolumeEvaluator evaluator(set, {}, true);
	const double covered = 1.0 - evaluator.mask({0, 0, 0}, {0, 1, 0}, 256).visibility;
	CHECK(covered > 3.0 * one_layer);
	CHECK(covered == Approx(0.97 * (1.0 - std::pow(0.75, 12))).margin(0.06));
}

TEST_CASE("aov: close to rays, and masks at less than half of the plain sum's error", "[aov]")
{
	for (const std::string& name : {std::string("cornell"), std::string("courtyard")})
	{
		const SmallView view = viewOfLevel(name);
		const VolumeSet set = setOf(trianglesOf(view.level), 0.6, false);
		AovSettings settings{.compensate = false};
		const std::vector<float> sum = aovOnCpu(view.gbuffer, set, settings, {4, {}}).shaded.visibility;
		settings.mask = true;
		settings.directions = 256;
		const std::vector<float> mask = aovOnCpu(view.gbuffer, set, settings, {4, {}}).shaded.visibility;
		const double of_sum = rmseOf(sum, linearReference(view, 1.0));
		const double of_mask = rmseOf(mask, linearReference(view, 0.6));
		INFO(name << ": RMSE of the sum " << of_sum << ", of the mask " << of_mask);
		CHECK(of_mask < 0.5 * of_sum);
		CHECK(of_mask < 0.02);
		CHECK(of_sum < 0.15);
	}
}

TEST_CASE("aov: one pixel of nine or of twenty-five, and those that these do not tell, are close to all of them", "[aov]")
{
	const SmallView view = viewOfLevel("cornell");
	const VolumeSet set = setOf(trianglesOf(view.level), 0.6, false);
	AovSettings settings;
	const AovShaded all = aovOnCpu(view.gbuffer, set, settings, {4, {}});
	const std::size_t pixels = all.shaded.visibility.size();
	for (const int every_px : {3, 5})
	{
		settings.every_px = every_px;
		const AovShaded few = aovOnCpu(view.gbuffer, set, settings, {4, {}});
		const double error = rmseOf(few.shaded.visibility, all.shaded.visibility);
		std::size_t alone = 0;
		std::size_t others = 0;
		const std::vector<float> filtered = sparseOf(view.gbuffer, all.shaded.visibility, set.distance_m, every_px);
		for (std::size_t i = 0; i < pixels; ++i)
		{
			alone += filtered[i] < 0.0F ? 1U : 0U;
			others += few.shaded.visibility[i] != (filtered[i] < 0.0F ? all.shaded.visibility[i] : filtered[i]) ? 1U : 0U;
		}
		INFO(every_px << ": RMSE " << error << ", " << few.counts.pixels_alone << " of " << pixels << " pixels alone, "
					  << few.counts.fragments << " of " << all.counts.fragments);
		CHECK(error > 0.0);
		CHECK(error < (every_px == 3 ? 0.03 : 0.07));
		CHECK(few.counts.pixels_alone > 0);
		CHECK(few.counts.pixels_alone < pixels / 2);
		// Individually drawn pixels match the drawing without cells, and all others match the filter applied to the cells' pixels.
		CHECK(alone == few.counts.pixels_alone);
		CHECK(others == 0);
		CHECK(few.counts.fragments < all.counts.fragments);
	}
	CHECK(all.counts.pixels_alone == 0);
}
