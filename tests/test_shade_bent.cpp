// SPDX-License-Identifier: GPL-3.0-or-later
// Bent normals of slices: sums of directions in closed form, planes, a corner, rays, and the CPU compared with OpenGL.
#include "small_gbuffers.h"
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "scene/reference.h"
#include "scene/tracer.h"

namespace
{

ShadeSettings settingsOf(int slices, int steps, double radius_m)
{
	ShadeSettings settings = settingsFor(ShadeMethod::slices, radius_m);
	settings.slices.count = slices;
	settings.slices.steps = steps;
	settings.slices.bent = true;
	return settings;
}

Shaded drawn(const GBuffer& gbuffer, const ShadeSettings& settings)
{
	return shadeOnCpu(gbuffer, ownSamples(settings), settings, {2, {}});
}

double degreesBetween(const glm::vec3& a, const glm::vec3& b)
{
	const glm::dvec3 p(a);
	const glm::dvec3 q(b);
	return 2.0 * std::atan2(glm::length(p - q), glm::length(p + q)) * 180.0 / kPi;
}

// Over pixels with a surface.
double meanDegrees(const GBuffer& gbuffer, const std::vector<glm::vec3>& a, const std::vector<ReferenceValue>& rays)
{
	double sum = 0.0;
	std::size_t count = 0;
	for (std::size_t i = 0; i < a.size(); ++i)
	{
		if (std::isfinite(gbuffer.depth[i]))
		{
			sum += degreesBetween(a[i], rays[i].bent);
			count += 1;
		}
	}
	return sum / static_cast<double>(count);
}

glm::vec3 turnOf(double normal)
{
	const SinCos turn = sinCosOf(normal);
	return glm::vec3(glm::dvec3(turn.sin, turn.cos, normal));
}

// A corner of two infinite planes that meet at a right angle in x = 0, 5 m away, each at 45 degrees to the view.
GBuffer corner(int width, int height)
{
	Lens lens{.orthographic = true, .half_height_m = 3.0};
	GBuffer gbuffer{width, height, {glm::dmat4(1.0), projectionOf(lens, static_cast<double>(width) / height)}, 0.0, {}, {}};
	const double s = std::sqrt(0.5);
	for (int i = 0; i < width * height; ++i)
	{
		const double x = (i % width + 0.5 - 0.5 * width) * 6.0 / height;
		gbuffer.depth.push_back(static_cast<float>(5.0 - std::fabs(x)));
		gbuffer.normals.emplace_back(glm::dvec3(x < 0.0 ? s : -s, 0.0, s));
	}
	return gbuffer;
}

} // namespace

TEST_CASE("shade bent: the direction before a share, and the sum of the directions of bits, against integrals", "[shade]")
{
	shade_kernels::Kernels kernels;
	const double normal = GENERATE(-1.5, -1.2, -0.3, 0.0, 0.8, 1.2, 1.5);
	const glm::vec3 turn = turnOf(normal);
	const double most = std::fabs(normal) > 1.25 ? 0.4 : 0.04;
	const int parts = 64000;
	std::vector<double> measure{0.0};
	std::vector<glm::dvec2> moment{glm::dvec2(0.0)};
	for (int i = 0; i < parts; ++i)
	{
		const double t = normal + kPi * ((i + 0.5) / parts - 0.5);
		const SinCos at = sinCosOf(t);
		const double weight = std::cos(t - normal) * std::fabs(at.sin) * kPi / parts;
		measure.push_back(measure.back() + weight);
		moment.push_back(moment.back() + weight * glm::dvec2(at.sin, at.cos));
	}
	const auto placeOf = [&](double share)
	{
		return std::upper_bound(measure.begin(), measure.end() - 1, share * measure.back()) - measure.begin();
	};
	for (int bit = 1; bit < 31; ++bit)
	{
		const glm::vec2 found = kernels.nookSliceToward(static_cast<float>(bit) / 31.0F, turn);
		const double expected = normal + kPi * (static_cast<double>(placeOf(bit / 31.0)) / parts - 0.5);
		CAPTURE(normal, bit);
		REQUIRE(std::fabs(std::atan2(static_cast<double>(found.x), static_cast<double>(found.y)) - expected) * 180.0 / kPi < most);
	}
	for (const auto& [bits, first, end] : {std::tuple{0x7FFFFFFFU, 0, 31}, {0x00FFFF00U, 8, 24}, {0x78000000U, 20, 31}})
	{
		const auto from = static_cast<std::size_t>(placeOf(bits == 0x78000000U ? 27.0 / 31.0 : first / 31.0));
		const std::size_t to = end == 31 ? moment.size() - 1 : static_cast<std::size_t>(placeOf(end / 31.0));
		const glm::dvec2 expected = moment[to] - moment[bits == 0x7FFFFFFFU ? 0 : from];
		const glm::vec2 found = kernels.nookSliceSum(bits, first, end, turn);
		CAPTURE(normal, bits);
		REQUIRE(glm::distance(glm::dvec2(found), expected) < 0.002);
	}
}

TEST_CASE("shade bent: on an open plane it is the normal, at any slope, through nine projections and in the corners", "[shade]")
{
	std::vector<glm::dmat4> all{projectionOf(lensOf(100.0), 16.0 / 9.0)};
	for (const NamedProjection& projection : projections(16.0 / 9.0))
	{
		all.push_back(projection.matrix);
	}
	REQUIRE(all.size() == 9);
	for (std::size_t p = 0; p < all.size(); ++p)
	{
		for (const double tilt : {0.0, 30.0, 60.0, 80.0})
		{
			const GBuffer gbuffer = planeAt(all[p], 128, 72, tilt);
			const Shaded shaded = drawn(gbuffer, settingsOf(1, 4, 0.5));
			double worst = 0.0;
			for (std::size_t i = 0; i < shaded.bent.size(); ++i)
			{
				worst =
					std::isfinite(gbuffer.depth[i]) ? std::max(worst, degreesBetween(shaded.bent[i], gbuffer.normals[i])) : worst;
			}
			CAPTURE(p, tilt, worst);
			CHECK(worst < 0.5);
			CHECK(*std::min_element(shaded.visibility.begin(), shaded.visibility.end()) >= 1.0F - 1.0F / 255.0F);
		}
	}
}

// Half of the hemisphere is open: the sums of its directions are 2/3 away from the wall and pi/3 along the normal.
TEST_CASE("shade bent: beside a wall without end it leans away by atan(2/pi)", "[shade]")
{
	const GBuffer gbuffer = corner(1024, 1024);
	ShadeSettings settings = settingsOf(16, 32, 300.0);
	settings.max_radius_px = 60000.0; // distances in the picture are negligible compared with the reach
	shade_kernels::Kernels kernels = kernelsOver(gbuffer, ownSamples(settings), settings);
	const int x = GENERATE(520, 528, 500);
	glm::dvec3 sum(0.0);
	double open = 0.0;
	for (int i = 0; i < 16; ++i)
	{
		const glm::vec4 one = kernels.nookSlicesOpen({x / 4 * 4 + i % 4, 512 + i / 4});
		sum += glm::dvec3(one.x, one.y, one.z) / 16.0;
		open += static_cast<double>(one.w) / 16.0;
	}
	const double s = std::sqrt(0.5);
	const double away = x < 512 ? -1.0 : 1.0;
	const glm::dvec3 n(-away * s, 0.0, s);
	const glm::dvec3 from_wall(away * s, 0.0, s);
	const glm::dvec3 expected = glm::normalize(2.0 / kPi * from_wall + n);
	CAPTURE(x, open, sum.x, sum.y, sum.z);
	CHECK(open == Approx(0.5).margin(0.04));
	CHECK(degreesBetween(glm::normalize(sum), expected) < 3.0);
	CHECK(glm::length(sum) == Approx(std::sqrt(1.0 / 9.0 + 4.0 / (9.0 * kPi * kPi))).margin(0.02));
}

TEST_CASE("shade bent: nearer to the rays' bent normal than the normal, and visibility as without", "[shade]")
{
	for (const std::string name : {"courtyard", "suburb"})
	{
		const Level level = builtinLevel(name);
		const Tracer tracer(level, {});
		const GBuffer gbuffer = castGBuffer(tracer, viewOf(level.cameras[0], 160, 90), 160, 90, NormalKind::geometric, {});
		ReferenceSettings reference{.measure = ReferenceMeasure::bent, .falloff = Falloff::linear, .radius_m = 1.5, .rays = 64};
		const std::vector<ReferenceValue> rays = referenceOfGBuffer(&tracer, gbuffer, reference, {2, {}});
		const double plain = meanDegrees(gbuffer, gbuffer.normals, rays);
		double few = 0.0;
		for (const auto& [slices, steps] : {std::pair{1, 4}, {3, 6}})
		{
			ShadeSettings settings = settingsOf(slices, steps, 1.5);
			settings.filter = ShadeFilter::bilateral;
			settings.power = 1.3;
			const Shaded shaded = drawn(gbuffer, settings);
			const double ours = meanDegrees(gbuffer, shaded.bent, rays);
			CAPTURE(name, slices, ours, plain);
			CHECK(ours < (slices == 1 ? 0.92 : 0.8) * plain);
			CHECK((few == 0.0 || ours < few));
			few = ours;
			settings.slices.bent = false;
			CHECK(drawn(gbuffer, settings).visibility == shaded.visibility);
			for (std::size_t i = 0; i < shaded.bent.size(); ++i)
			{
				if (!std::isfinite(gbuffer.depth[i]))
				{
					REQUIRE(shaded.bent[i] == glm::vec3(0.0F));
					continue;
				}
				REQUIRE(std::fabs(glm::length(shaded.bent[i]) - 1.0F) < 1e-5F);
				REQUIRE(glm::dot(shaded.bent[i], gbuffer.normals[i]) > -1e-5F);
			}
		}
	}
}

TEST_CASE("shade bent: OpenGL agrees with the CPU", "[shade]")
{
	for (const std::string name : {"courtyard", "suburb", "nulls"})
	{
		const GBuffer gbuffer = builtinView(name, 160, 90);
		ShadeSettings settings = settingsOf(name == "nulls" ? 3 : 1, 4, 1.0);
		settings.filter = name == "suburb" ? ShadeFilter::bilateral : ShadeFilter::none;
		const ShadeSamples samples = ownSamples(settings);
		const Shaded cpu = shadeOnCpu(gbuffer, samples, settings, {2, {}});
		const Shaded gl = shadeOnGl(gbuffer, samples, settings);
		checkSamePicture(cpu.visibility, gl.visibility);
		std::size_t off = 0;
		for (std::size_t i = 0; i < cpu.bent.size(); ++i)
		{
			if (!std::isfinite(gbuffer.depth[i]))
			{
				REQUIRE(gl.bent[i] == glm::vec3(0.0F));
				continue;
			}
			off += degreesBetween(cpu.bent[i], gl.bent[i]) > 0.5 ? 1U : 0U;
		}
		CAPTURE(name, gl.renderer, off);
		CHECK(off * 500 <= cpu.bent.size());
	}
}

TEST_CASE("shade bent: as eight bits of an octahedron, within a degree", "[shade]")
{
	shade_kernels::Kernels kernels;
	double worst = 0.0;
	for (int i = 0; i < 5000; ++i)
	{
		const double z = 1.0 - 2.0 * (i + 0.5) / 5000.0;
		const SinCos turn = sinCosOf(2.399963 * i);
		const double across = std::sqrt(1.0 - z * z);
		const glm::vec3 bent(glm::dvec3(across * turn.cos, across * turn.sin, z));
		glm::vec4 code = kernels.nookBentCoded(glm::vec4(bent, 0.25F));
		for (int axis = 0; axis < 4; ++axis)
		{
			REQUIRE((code[axis] >= 0.0F && code[axis] <= 1.0F));
			code[axis] = std::floor(code[axis] * 255.0F + 0.5F) / 255.0F;
		}
		const glm::vec4 back = kernels.nookBentDecoded(code);
		worst = std::max(worst, degreesBetween({back.x, back.y, back.z}, bent));
		REQUIRE(std::fabs(back.w - 0.25F) < 0.002F);
	}
	CHECK(worst < 1.0);
	CHECK(kernels.nookConeAngle(0.25F) == Approx(kPi / 6.0));
}

TEST_CASE("shade slices: a scene a hundred times smaller or larger, with its radius, is the same picture", "[shade]")
{
	const GBuffer gbuffer = builtinView("courtyard", 160, 90);
	const Shaded own = drawn(gbuffer, settingsOf(1, 4, 1.0));
	const double scale = GENERATE(0.01, 100.0);
	GBuffer other = gbuffer;
	other.view.projection[3][2] *= scale; // near and far
	for (float& depth : other.depth)
	{
		depth = static_cast<float>(static_cast<double>(depth) * scale);
	}
	for (float& error : other.depth_error_m)
	{
		error = static_cast<float>(static_cast<double>(error) * scale);
	}
	const Shaded scaled = drawn(other, settingsOf(1, 4, scale));
	checkSamePicture(own.visibility, scaled.visibility);
	std::size_t off = 0;
	for (std::size_t i = 0; i < own.bent.size(); ++i)
	{
		off += std::isfinite(gbuffer.depth[i]) && degreesBetween(own.bent[i], scaled.bent[i]) > 0.5 ? 1U : 0U;
	}
	CAPTURE(scale, off);
	CHECK(off * 500 <= own.bent.size());
}
