// SPDX-License-Identifier: GPL-3.0-or-later
// Any camera, any format: the same view through projections of every kind, quantised depth and normals, the far end, rectangles of
// a texture, guard bands, and the near plane.
#include "small_formats.h"
#include "small_samples.h"
#include "testing.h"

#include <cstdio>

namespace
{

constexpr std::array kSampled{ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::alchemy};
constexpr std::array<const char*, 3> kNames{"vo-line", "vo-point", "alchemy"};
constexpr int kSceneWidth = 160;
constexpr int kSceneHeight = 90;

struct Views
{
	Level level;
	Tracer tracer;
	glm::dmat4 camera;
	std::vector<Convention> conventions;

	explicit Views(const std::string& name)
		: level(builtinLevel(name)), tracer(level, {}),
		  camera(viewOf(level.cameras[0], kSceneWidth, kSceneHeight).camera_from_world),
		  conventions(test::conventions(viewOf(level.cameras[0], kSceneWidth, kSceneHeight).projection,
										projectionOf(lensOf(0.0), static_cast<double>(kSceneWidth) / kSceneHeight), kSceneWidth,
										kSceneHeight))
	{
	}

	GBuffer of(const Convention& convention) const
	{
		return castGBuffer(tracer, {camera, convention.projection}, kSceneWidth, kSceneHeight, NormalKind::geometric, {2, {}});
	}
};

// Bound on how much depth quantisation may change visibility by lines: the lines' ends and the slack, each by less than E(depth) +
// E(depth + r), times w / 2z for each line, relative to the open half above the tangent plane.
double boundOf(shade_kernels::Kernels& kernels, const ShadeSamples& samples, float depth, double radius)
{
	const double sum = sumOver(samples.samples, [](const glm::vec4& line) { return static_cast<double>(line.w / line.z); });
	return 2.0 * sum * static_cast<double>(kernels.nookSlack(depth, static_cast<float>(radius))) / radius;
}

float leastOf(const std::vector<float>& values)
{
	return *std::min_element(values.begin(), values.end());
}

GBuffer cut(const GBuffer& gbuffer, int x0, int y0, int width, int height)
{
	GBuffer part{width, height, gbuffer.view, 0.0, {}, {}};
	for (int y = y0; y < y0 + height; ++y)
	{
		for (int x = x0; x < x0 + width; ++x)
		{
			const auto i = static_cast<std::size_t>(y * gbuffer.width_px + x);
			part.depth.push_back(gbuffer.depth[i]);
			part.normals.push_back(gbuffer.normals[i]);
		}
	}
	// NDC of the part = NDC of the whole, scaled and shifted.
	glm::dmat4& p = part.view.projection;
	const glm::dvec2 share(static_cast<double>(gbuffer.width_px) / width, static_cast<double>(gbuffer.height_px) / height);
	const glm::dvec2 middle(2.0 * (x0 + 0.5 * width) / gbuffer.width_px - 1.0, 1.0 - 2.0 * (y0 + 0.5 * height) / gbuffer.height_px);
	for (int column = 0; column < 4; ++column)
	{
		p[column][0] = share.x * (p[column][0] - middle.x * p[column][3]);
		p[column][1] = share.y * (p[column][1] - middle.y * p[column][3]);
	}
	return part;
}

std::vector<float> cut(const std::vector<float>& values, int whole, int x0, int y0, int width, int height)
{
	std::vector<float> part;
	for (int y = y0; y < y0 + height; ++y)
	{
		part.insert(part.end(), values.begin() + y * whole + x0, values.begin() + y * whole + x0 + width);
	}
	return part;
}

} // namespace

TEST_CASE("camera: device depth of any projection and format is read within its own error, and its far end is sky", "[shade]")
{
	const double aspect = static_cast<double>(kSceneWidth) / kSceneHeight;
	for (const Convention& convention :
		 conventions(projectionOf(lensOf(60.0), aspect), projectionOf(lensOf(0.0), aspect), kSceneWidth, kSceneHeight))
	{
		for (const int bits : {16, 24, 32})
		{
			shade_kernels::Kernels kernels = depthKernels(convention, bits);
			CAPTURE(convention.name, bits);
			CHECK(kernels.nookLinear(deviceOf(std::numeric_limits<double>::infinity(), convention, bits)) == NOOK_SKY);
			double widest = 0.0;
			for (double depth = 0.1; depth < 199.0; depth *= 1.0037)
			{
				const float read = kernels.nookLinear(deviceOf(depth, convention, bits));
				const auto error = static_cast<double>(kernels.nookDepthError(static_cast<float>(depth)));
				if (read < NOOK_SKY && error < 0.1 * depth) // steps that grow along the way are longer than at the start
				{
					REQUIRE(std::fabs(static_cast<double>(read) - depth) <= 1.11 * error);
					widest = std::max(widest, std::fabs(static_cast<double>(read) - depth) / error);
				}
				else
				{
					REQUIRE(bits == 16);
					REQUIRE(depth > 30.0);
				}
			}
			CHECK(widest > (bits == 32 ? 0.01 : 0.3)); // the bound is not vacuous
		}
	}
	ShadeBlock block;
	glm::dmat4 projection = projectionOf(lensOf(60.0), 1.0);
	projection[2][2] = 0.0;
	projection[3][2] = 0.0; // one value for all depths
	CHECK_THROWS_AS(fillDepth(block, projection, {true, ClipRange::zero_to_one, 24}), Error);
	CHECK_NOTHROW(fillDepth(block, projection, {false, ClipRange::zero_to_one, 32}));
	projection = projectionOf(lensOf(60.0), 1.0);
	projection[0][2] = 0.1; // a tilted near plane
	CHECK_THROWS_AS(fillDepth(block, projection, {true, ClipRange::zero_to_one, 24}), Error);
}

TEST_CASE("camera: the same view through every projection and format, within the bound that the format has", "[shade]")
{
	const Views views("courtyard");
	for (const Convention& convention : views.conventions)
	{
		const GBuffer gbuffer = views.of(convention);
		for (std::size_t m = 0; m < kSampled.size(); ++m)
		{
			const ShadeSamples samples = samplesFor(kSampled[m], 9);
			ShadeSettings settings = settingsFor(kSampled[m]);
			const std::vector<float> truth = visibilityOf(gbuffer, samples, settings);
			for (const int bits : {16, 24, 32})
			{
				settings.depth = formatOf(convention, bits);
				const std::vector<float> found = visibilityOf(through(gbuffer, convention, bits), samples, settings);
				const Difference difference = differenceOf(found, truth);
				CAPTURE(convention.name, bits, kNames[m], difference.mean, difference.worst);
				CHECK(difference.mean <= (bits == 16 ? 0.015 : 1.5e-4));
				CHECK(difference.beyond <= (bits == 16 ? 0.3 : 5e-4));
				if (kSampled[m] != ShadeMethod::vo_line)
				{
					continue;
				}
				shade_kernels::Kernels kernels = depthKernels(convention, bits);
				std::size_t outside = 0; // samples on the edge between two pixels may fall to either
				std::size_t darker = 0;
				for (std::size_t i = 0; i < truth.size(); ++i)
				{
					if (std::isfinite(gbuffer.depth[i]))
					{
						const auto change = static_cast<double>(found[i] - truth[i]);
						outside += std::fabs(change) > boundOf(kernels, samples, gbuffer.depth[i], 0.5) + 1e-4 ? 1U : 0U;
						darker += change < -1e-4 ? 1U : 0U;
					}
				}
				CHECK(outside <= truth.size() / 1000);
				CHECK(darker <= truth.size() / 200);
			}
		}
	}
}

TEST_CASE("camera: no format makes an open plane occlude itself", "[shade]")
{
	const double aspect = 16.0 / 9.0;
	double without = 1.0;
	for (const Convention& convention : conventions(projectionOf(lensOf(60.0), aspect), projectionOf(lensOf(0.0), aspect), 96, 54))
	{
		for (const ShadeMethod method : kSampled)
		{
			const ShadeSamples samples = samplesFor(method, 9);
			for (const int bits : {16, 24, 32})
			{
				for (const double tilt : {0.0, 60.0, 80.0})
				{
					const GBuffer plane = through(planeAt(convention.projection, 96, 54, tilt), convention, bits);
					ShadeSettings settings = settingsFor(method);
					settings.beta = 0.0;
					settings.depth = formatOf(convention, bits);
					CAPTURE(convention.name, static_cast<int>(method), bits, tilt);
					CHECK(leastOf(visibilityOf(plane, samples, settings)) >= 1.0F - 1.0F / 255.0F);
					settings.depth = {};
					without = std::min(without, static_cast<double>(leastOf(visibilityOf(plane, samples, settings))));
				}
			}
		}
	}
	CHECK(without < 0.9); // the test would detect it
}

TEST_CASE("camera: normals of 8 bits", "[shade]")
{
	const glm::dmat4 projection = projectionOf(lensOf(60.0), 16.0 / 9.0);
	double without = 1.0;
	for (const ShadeMethod method : kSampled)
	{
		const ShadeSamples samples = samplesFor(method, 9);
		for (const int bits : {8, 10, 16})
		{
			for (const double tilt : {0.0, 20.0, 60.0, 80.0})
			{
				const GBuffer plane = withNormals(planeAt(projection, 96, 54, tilt), bits);
				ShadeSettings settings = settingsFor(method);
				settings.beta = 0.0;
				settings.normal_bits = bits;
				CAPTURE(static_cast<int>(method), bits, tilt);
				// Rotating the plane by an angle a removes a / pi of the half ball: at most 0.55 / 255 with 8 bits, about twice
				// that with nine lines. Of nine points, one on the plane may be on either side.
				const std::vector<float> found = visibilityOf(plane, samples, settings);
				CHECK(leastOf(found) >= (method == ShadeMethod::vo_point ? 1.0F - 1.01F / 9.0F : 1.0F - 1.25F / 255.0F));
				CHECK(std::accumulate(found.begin(), found.end(), 0.0) >= (1.0 - 1.0 / 255.0) * static_cast<double>(found.size()));
				settings.normal_bits = 32;
				without = std::min(without, static_cast<double>(leastOf(visibilityOf(plane, samples, settings))));
			}
		}
	}
	CHECK(without < 0.98); // Alchemy's 1 / v.v amplifies small differences
}

TEST_CASE("camera: sky is no neighbour", "[shade]")
{
	const glm::dmat4 projection = projectionOf(lensOf(60.0), 16.0 / 9.0);
	GBuffer gbuffer = planeAt(projection, 96, 54, 20.0);
	for (std::size_t i = 0; i < gbuffer.depth.size(); ++i)
	{
		if ((i % 96 / 7 + i / 96 / 5) % 2 == 0) // in patches
		{
			gbuffer.depth[i] = std::numeric_limits<float>::infinity();
			gbuffer.normals[i] = glm::vec3(0.0F);
		}
	}
	for (const Convention& convention : conventions(projection, projection, 96, 54))
	{
		for (const ShadeMethod method : kSampled)
		{
			ShadeSettings settings = settingsFor(method);
			settings.beta = 0.0;
			settings.depth = formatOf(convention, 24);
			if (convention.name != std::string("off-centre") && convention.name != std::string("jittered"))
			{
				CAPTURE(convention.name, static_cast<int>(method));
				CHECK(leastOf(visibilityOf(through(gbuffer, convention, 24), samplesFor(method, 9), settings)) >=
					  1.0F - 1.0F / 255.0F);
			}
		}
	}
}

TEST_CASE("camera: a rectangle of a texture is shaded as the picture alone, whatever lies around it", "[shade]")
{
	const GBuffer whole = builtinView("courtyard", 128, 96);
	const int x0 = 32;
	const int y0 = 24;
	const GBuffer part = cut(whole, x0, y0, 64, 48);
	for (const ShadeMethod method : kSampled)
	{
		const ShadeSamples samples = samplesFor(method, 9);
		const ShadeSettings settings = settingsFor(method);
		const std::vector<float> expected = visibilityOf(part, samples, settings);
		InTexture texture(part, samples, settings, {x0, y0});
		shade_kernels::Kernels& kernels = texture.kernels;
		std::size_t other = 0;
		for (int y = 0; y < 48; ++y)
		{
			for (int x = 0; x < 64; ++x)
			{
				const glm::ivec2 pixel(x0 + x, y0 + y);
				const float found = method == ShadeMethod::vo_line    ? kernels.nookVoLine(pixel)
									: method == ShadeMethod::vo_point ? kernels.nookVoPoint(pixel)
																	  : kernels.nookAlchemy(pixel);
				other += found == expected[static_cast<std::size_t>(y * 64 + x)] ? 0U : 1U;
			}
		}
		CAPTURE(static_cast<int>(method));
		CHECK(other == 0); // powers of two: the arithmetic is bit-identical
	}
}

TEST_CASE("camera: with a guard band as wide as the radius the picture's border is that of a larger picture", "[shade]")
{
	const GBuffer whole = builtinView("courtyard", 256, 128);
	ShadeSettings settings;
	settings.max_radius_px = 20.0;
	const ShadeSamples samples = samplesFor(ShadeMethod::vo_line, 9);
	const std::vector<float> truth = cut(visibilityOf(whole, samples, settings), 256, 64, 32, 128, 64);
	double last = 1.0;
	for (const int guard : {0, 3, 6, 12})
	{
		const int width = 128 + 2 * guard;
		const std::vector<float> drawn = visibilityOf(cut(whole, 64 - guard, 32 - guard, width, 64 + 2 * guard), samples, settings);
		const Difference difference = differenceOf(cut(drawn, width, guard, guard, 128, 64), truth);
		CAPTURE(guard, difference.mean, difference.beyond);
		CHECK(difference.mean < 0.75 * last);
		last = difference.mean;
	}
	CHECK(last < 1e-6); // samples on the edge between two pixels, where the projections differ by rounding
}

TEST_CASE("camera: radii near the camera and far away are held within limits in pixels", "[shade]")
{
	const glm::dmat4 projection = projectionOf(lensOf(60.0), 1.0);
	GBuffer any{100, 100, {glm::dmat4(1.0), projection}, 0.0, std::vector<float>(10000, 1.0F), std::vector<glm::vec3>(10000)};
	ShadeSettings settings;
	const ShadeSamples samples = samplesFor(ShadeMethod::vo_line, 4);
	shade_kernels::Kernels kernels;
	kernels.nook = blockOf(frameOf(any), samples, settings);
	// r px = 0.5 m * 50 px / (depth tan 30 degrees)
	CHECK(kernels.nookRadius(0.5F, 1.0F) == 0.5F);
	CHECK(kernels.nookRadius(0.5F, 0.1F) * kernels.nookScale(0.1F).x == Approx(100.0)); // the picture's height
	settings.max_radius_px = 32.0;
	settings.min_radius_px = 2.0;
	kernels.nook = blockOf(frameOf(any), samples, settings);
	CHECK(kernels.nookRadius(0.5F, 1.0F) * kernels.nookScale(1.0F).x == Approx(32.0));
	CHECK(kernels.nookRadius(0.5F, 5.0F) == 0.5F);
	CHECK(kernels.nookRadius(0.5F, 100.0F) * kernels.nookScale(100.0F).x == Approx(2.0));
	kernels.nook.across_y.x *= -1.0F; // rows from the bottom
	CHECK(kernels.nookRadius(0.5F, 100.0F) * kernels.nookScale(100.0F).x == Approx(2.0));
	CHECK(limitedRadii(any, settings) == LimitedRadii{10000, 0});
	any.depth.assign(10000, std::numeric_limits<float>::infinity());
	any.depth[7] = 100.0F;
	CHECK(limitedRadii(any, settings) == LimitedRadii{0, 1});
}

// The table of docs/measurements/shading.md: nook_tests "camera: figures of formats"
TEST_CASE("camera: figures of formats", "[.figures]")
{
	const Views views("courtyard");
	for (const std::size_t which : {0U, 2U, 3U, 4U, 7U})
	{
		const Convention& convention = views.conventions[which];
		const GBuffer gbuffer = views.of(convention);
		for (const int bits : {16, 24, 32})
		{
			const GBuffer coarse = through(gbuffer, convention, bits);
			shade_kernels::Kernels kernels = depthKernels(convention, bits);
			std::printf("%-18s %2d: half a step at 5 m %.2g m, at 50 m %.2g m;", convention.name, bits,
						static_cast<double>(kernels.nookDepthError(5.0F)), static_cast<double>(kernels.nookDepthError(50.0F)));
			for (std::size_t m = 0; m < kSampled.size(); ++m)
			{
				const ShadeSamples samples = samplesFor(kSampled[m], 9);
				ShadeSettings settings = settingsFor(kSampled[m]);
				const std::vector<float> truth = visibilityOf(gbuffer, samples, settings);
				settings.depth = formatOf(convention, bits);
				const Difference difference = differenceOf(visibilityOf(coarse, samples, settings), truth);
				settings.depth = {};
				const Difference without = differenceOf(visibilityOf(coarse, samples, settings), truth);
				std::printf(" %s %.1g (signed %+.1g; without slack %.1g, %+.1g)", kNames[m], difference.mean,
							difference.signed_mean, without.mean, without.signed_mean);
			}
			std::printf("\n");
		}
	}
	const GBuffer gbuffer = builtinView("courtyard", kSceneWidth, kSceneHeight);
	const glm::dmat4 projection = projectionOf(lensOf(60.0), 16.0 / 9.0);
	for (const int bits : {8, 10, 16})
	{
		std::printf("normals of %2d bits:", bits);
		for (std::size_t m = 0; m < kSampled.size(); ++m)
		{
			const ShadeSamples samples = samplesFor(kSampled[m], 9);
			ShadeSettings settings = settingsFor(kSampled[m]);
			const Difference without =
				differenceOf(visibilityOf(withNormals(gbuffer, bits), samples, settings), visibilityOf(gbuffer, samples, settings));
			settings.beta = 0.0;
			float least[2] = {1.0F, 1.0F};
			for (const double tilt : {0.0, 20.0, 60.0, 80.0})
			{
				const GBuffer plane = withNormals(planeAt(projection, 96, 54, tilt), bits);
				settings.normal_bits = 32;
				least[0] = std::min(least[0], leastOf(visibilityOf(plane, samples, settings)));
				settings.normal_bits = bits;
				least[1] = std::min(least[1], leastOf(visibilityOf(plane, samples, settings)));
			}
			std::printf(" %s mean %.1g, least of planes %.4f, told of the bits %.4f;", kNames[m], without.mean,
						static_cast<double>(least[0]), static_cast<double>(least[1]));
		}
		std::printf("\n");
	}
	const GBuffer whole = builtinView("courtyard", 256, 128);
	const ShadeSamples samples = samplesFor(ShadeMethod::vo_line, 9);
	const std::vector<float> truth = cut(visibilityOf(whole, samples, {}), 256, 64, 32, 128, 64);
	for (const int guard : {0, 3, 6, 12, 24})
	{
		const int width = 128 + 2 * guard;
		const std::vector<float> drawn = visibilityOf(cut(whole, 64 - guard, 32 - guard, width, 64 + 2 * guard), samples, {});
		const Difference difference = differenceOf(cut(drawn, width, guard, guard, 128, 64), truth);
		std::printf("guard band of %2d pixels: mean %.1g worst %.2f pixels that differ %.4f\n", guard, difference.mean,
					difference.worst, difference.beyond);
	}
}
