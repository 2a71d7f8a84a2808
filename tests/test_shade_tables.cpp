// SPDX-License-Identifier: GPL-3.0-or-later
// StatVO's tables: their precision, agreement of all ways to compute them, and the effect of skipping layers.
#include "small_samples.h"
#include "small_views.h"
#include "testing.h"

#include "shade/gl_context.h"
#include "shade/run_passes.h"

#include <epoxy/gl.h>

namespace
{

// Reads a layer of counts.
std::vector<std::uint32_t> readCounts(const GlTexture& texture, int layer)
{
	const PictureShape& shape = texture.shape;
	std::vector<std::uint32_t> values(4 * static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.height));
	const GlName frame(glGenFramebuffers, glDeleteFramebuffers);
	glBindFramebuffer(GL_FRAMEBUFFER, frame);
	glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture.name, 0, layer);
	glReadPixels(0, 0, shape.width, shape.height, GL_RGBA_INTEGER, GL_UNSIGNED_INT, values.data());
	checkGlErrors();
	return values;
}

// Runs the passes up to the first one named `end`, or all, on one thread. Returns their pictures.
std::vector<Planes> picturesOf(const GBuffer& gbuffer, const ShadeSettings& settings, const std::string& end)
{
	const ShadeSamples samples = ownSamples(settings);
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings, settings.statvo.builder != TableBuilder::fragments);
	const std::vector<float> depths = finiteDepths(gbuffer);
	shade_kernels::Kernels inputs;
	inputs.depths = depths;
	inputs.normals = gbuffer.normals;
	inputs.samples = samples.samples;
	std::vector<Planes> pictures = picturesFor(plan);
	for (const ShadePass& pass : plan.passes)
	{
		if (pass.kernel.name == end)
		{
			break;
		}
		runPass(pass, inputs, pictures, {1, {}});
	}
	return pictures;
}

// Depths of 1 to 101 m, most of them near: noise on steps.
GBuffer noise(int width, int height)
{
	Lens lens{.fov_y_rad = 1.0};
	const glm::dmat4 projection = projectionOf(lens, static_cast<double>(width) / height);
	GBuffer gbuffer{width, height, {glm::dmat4(1.0), projection}, 0.0, {}, {}};
	const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
	gbuffer.normals.assign(pixels, glm::vec3(0.0F, 0.0F, 1.0F));
	Random random(7);
	for (std::size_t i = 0; i < pixels; ++i)
	{
		const double share = random.uniform();
		gbuffer.depth.push_back(static_cast<float>((i / 97) % 3 == 0 ? 1.0 + 100.0 * share * share : 3.0 + share));
	}
	gbuffer.depth[5] = 1.0F;
	gbuffer.depth[6] = 101.0F;
	return gbuffer;
}

struct Rectangle
{
	std::size_t x0, y0, x1, y1;
};

// Rectangles of 1 x 1 to 256 x 256, in all corners and at random positions.
std::vector<Rectangle> rectangles(std::size_t width, std::size_t height)
{
	std::vector<Rectangle> all;
	for (const std::size_t side : {1U, 2U, 16U, 255U, 256U})
	{
		all.push_back({0, 0, side, side});
		all.push_back({width - side, height - side, width, height});
		all.push_back({width - side, 0, width, side});
	}
	Random random(3);
	for (int i = 0; i < 20000; ++i)
	{
		const std::size_t w = 1 + random.next() % 256;
		const std::size_t h = 1 + random.next() % 256;
		const std::size_t x = random.next() % (width - w + 1);
		const std::size_t y = random.next() % (height - h + 1);
		all.push_back({x, y, x + w, y + h});
	}
	return all;
}

template <typename T> std::vector<T> prefixSums(const std::vector<float>& values, std::size_t width, std::size_t height)
{
	std::vector<T> sums((width + 1) * (height + 1));
	for (std::size_t y = 1; y <= height; ++y)
	{
		T row = 0;
		for (std::size_t x = 1; x <= width; ++x)
		{
			row += static_cast<T>(values[(y - 1) * width + x - 1]);
			sums[y * (width + 1) + x] = sums[(y - 1) * (width + 1) + x] + row;
		}
	}
	return sums;
}

struct TableErrors
{
	double integers = 0.0; // worst error of a mean, relative to the range of depths
	double floats = 0.0;   // with tables of 32-bit floats
};

TableErrors errorsAt(int width_px, int height_px)
{
	const GBuffer gbuffer = noise(width_px, height_px);
	ShadeSettings settings = statVo(1);
	settings.radius_m = 2.0; // gives the nearest pixel the largest possible rectangle
	const std::vector<Planes> pictures = picturesOf(gbuffer, settings, "statvo");
	const ShadePlan plan = planOf(frameOf(gbuffer), ownSamples(settings), settings, true);
	const ShadePass& method = plan.passes.back();
	shade_kernels::Kernels kernels;
	kernels.nook = method.block;
	kernels.range = pictures[method.reads[0].picture].data();
	kernels.tables = pictures[method.reads[1].picture];
	const auto width = static_cast<std::size_t>(width_px);
	const auto height = static_cast<std::size_t>(height_px);
	const std::vector<double> exact = prefixSums<double>(gbuffer.depth, width, height);
	const std::vector<float> single = prefixSums<float>(gbuffer.depth, width, height);
	const double least = static_cast<double>(kernels.nookRange(0).z);
	const double step = static_cast<double>(kernels.nookRange(1).z);
	REQUIRE(step * static_cast<double>(kernels.nookRange(0).w) == Approx(100.0));
	TableErrors errors;
	for (const Rectangle& r : rectangles(width, height))
	{
		const auto mean = [&](const auto& sums)
		{
			const std::size_t row = width + 1;
			return static_cast<double>(sums[r.y1 * row + r.x1] - sums[r.y0 * row + r.x1] - sums[r.y1 * row + r.x0] +
									   sums[r.y0 * row + r.x0]) /
				   static_cast<double>((r.x1 - r.x0) * (r.y1 - r.y0));
		};
		const glm::uvec4 sum = kernels.nookTableBox(glm::ivec4(r.x0, r.y0, r.x1, r.y1), 0);
		REQUIRE(sum.w == (r.x1 - r.x0) * (r.y1 - r.y0));
		const double ours = least + step * (static_cast<double>(sum.z) / sum.w);
		errors.integers = std::max(errors.integers, std::fabs(ours - mean(exact)) / 100.0);
		errors.floats = std::max(errors.floats, std::fabs(mean(single) - mean(exact)) / 100.0);
	}
	return errors;
}

} // namespace

TEST_CASE("statvo: means of rectangles in 3840 x 2160 are right to 1e-4 of the depths, as floats are not", "[shade][statvo]")
{
	const TableErrors errors = errorsAt(3840, 2160);
	WARN("worst error of a mean, share of the depths: integers " << errors.integers << ", 32-bit floats " << errors.floats);
	CHECK(errors.integers <= 1e-5);
	CHECK(errors.floats > 1e-4);
}

TEST_CASE("statvo: tables by scans and by passes of eight entries are the same", "[shade][statvo]")
{
	const GBuffer gbuffer = builtinView("courtyard", 131, 73);
	const int cell = GENERATE(1, 2, 4);
	ShadeSettings settings = statVo(4, cell);
	const std::vector<Planes> scans = picturesOf(gbuffer, settings, "slopes");
	settings.statvo.builder = TableBuilder::fragments;
	const std::vector<Planes> fragments = picturesOf(gbuffer, settings, "slopes");
	REQUIRE(scans.size() == fragments.size());
	std::size_t tables = 0;
	for (std::size_t i = 0; i < scans.size(); ++i)
	{
		for (std::size_t j = 0; scans[i].size() == 4 && j < 4; ++j) // otherwise scratch
		{
			CHECK(scans[i][j].counts == fragments[i][j].counts);
			CHECK(scans[i][j].counts.back() > 0);
			tables += 1;
		}
	}
	CHECK(tables == 4);
}

TEST_CASE("statvo: four leaves make the whole, and each is nearer than its sibling", "[shade][statvo]")
{
	const std::vector<Planes> pictures = picturesOf(builtinView("courtyard", 128, 72), statVo(4), "slopes");
	for (const Planes& planes : pictures)
	{
		if (planes.size() != 4)
		{
			continue;
		}
		const auto last = [&planes](std::size_t table)
		{
			const std::vector<std::uint32_t>& counts = planes[table].counts;
			return std::array<std::uint32_t, 2>{counts[counts.size() - 2], counts.back()}; // sum of depths and count; wraps around
		};
		CHECK(last(0)[1] <= 128 * 72);
		CHECK(last(1)[1] < last(0)[1]);
		CHECK(last(2)[1] < last(1)[1]);
		CHECK(last(3)[1] < last(0)[1] - last(1)[1]);
		CHECK(last(2)[1] > 0);
		CHECK(last(3)[1] > 0);
	}
}

TEST_CASE("statvo: tables that no memory holds are refused", "[shade][statvo]")
{
	GBuffer gbuffer{7680, 4320, {glm::dmat4(1.0), projectionOf(lensOf(60.0), 16.0 / 9.0)}, 0.0, {}, {}};
	ShadeSettings settings = statVo(4);
	CHECK_NOTHROW(planOf(frameOf(gbuffer), ownSamples(settings), settings));
	settings = statVo(64);
	settings.statvo.layering = StatVoLayering::uniform;
	CHECK_THROWS_AS(planOf(frameOf(gbuffer), ownSamples(settings), settings), Error);
}

TEST_CASE("statvo: sums by a compute shader are those of the CPU", "[shade][statvo]")
{
	const GlContext context;
	if (!context.hasCompute())
	{
		WARN("no compute shaders in " << context.renderer());
		return;
	}
	const PictureShape shape{PictureFormat::counts, 700, 301, 1, 3};
	const GlTexture source(PictureShape{PictureFormat::counts, 700, 301, 1, 1});
	GlPass fill("#version 330 core\nlayout(location = 0) out uvec4 value;\nvoid main()\n{\n\tuvec2 at = uvec2(gl_FragCoord.xy);\n"
				"\tvalue = uvec4(at.x * 2654435761u, at.y * 40503u, at.x ^ at.y, 1u) * 1000003u;\n}\n");
	fill.draw(source);
	PicturePlane cpu{700, 301, 4, {}, readCounts(source, 0)};
	for (const int axis : {0, 1})
	{
		PicturePlane sums = cpu;
		scanOnCpu(cpu, axis, sums, {2, {}});
		const GlTexture target(shape);
		GlScan(axis).run(source, target, 2, false);
		CHECK(readCounts(target, 2) == sums.counts);
		CHECK(sums.counts.back() != cpu.counts.back());
	}
}

TEST_CASE("statvo: leaving out layers changes nothing that shows, and leaves out some", "[shade][statvo]")
{
	struct Scene
	{
		const char* name;
		double least; // fraction of pixels without layers
	};
	for (const Scene scene : {Scene{"courtyard", 0.1}, Scene{"suburb", 0.02}, Scene{"nulls", 0.3}})
	{
		const GBuffer gbuffer = builtinView(scene.name, 320, 180);
		for (const bool normal : {true, false})
		{
			ShadeSettings settings = statVo(4, 1, !normal);
			settings.radius_m = 0.25;
			settings.use_normal = normal;
			const std::vector<Planes> pictures = picturesOf(gbuffer, settings, "");
			const PicturePlane& flags = pictures[pictures.size() - 2][0];
			const auto none = std::count(flags.values.begin(), flags.values.end(), 0.0F);
			CAPTURE(scene.name, normal, none, flags.values.size());
			const double share = static_cast<double>(none) / static_cast<double>(flags.values.size());
			CHECK(share >= scene.least);
			settings.statvo.skip = false;
			const std::vector<float> all = shadeOnCpu(gbuffer, ownSamples(settings), settings, {2, {}}).visibility;
			float worst = 0.0F;
			for (std::size_t i = 0; i < all.size(); ++i)
			{
				worst = std::max(worst, std::fabs(all[i] - pictures.back()[0].values[i]));
			}
			CHECK(worst <= 1.0F / 255.0F);
			WARN(scene.name << (normal ? ", with" : ", without") << " the normal: " << 100.0 * share
							<< " % of tiles without layers, worst difference " << worst);
		}
	}
}

// Not in the suite: takes half a minute.
TEST_CASE("statvo: an open plane in 1920 x 1080 reads 1", "[.][statvo-full]")
{
	const std::vector<float> visibility = visibilityOf(eachPlane(1920, 1080), GENERATE(statVo(4), statVo(4, 4, true)));
	WARN("least " << *std::min_element(visibility.begin(), visibility.end()));
	checkOpen(visibility);
}

TEST_CASE("statvo: OpenGL agrees with the CPU, by compute shaders or fragments", "[shade][statvo]")
{
	std::vector<ShadeSettings> all{statVo(4), statVo(2, 2, true), statVo(4, 4), statVo(12)};
	all[1].use_normal = false;
	all[2].half_resolution = true;
	all[3].statvo.layering = StatVoLayering::uniform;
	for (const std::string name : {"courtyard", "suburb", "nulls"})
	{
		for (std::size_t i = 0; i < all.size(); ++i)
		{
			CAPTURE(name, i);
			checkOnGl(builtinView(name, 160, 90), ownSamples(all[i]), all[i]);
		}
	}
	const GBuffer gbuffer = builtinView("suburb", 160, 90);
	ShadeSettings settings = statVo(4);
	settings.statvo.builder = TableBuilder::fragments;
	const std::vector<float> fragments = shadeOnGl(gbuffer, ownSamples(settings), settings).visibility;
	settings.statvo.builder = TableBuilder::compute;
	if (GlContext().hasCompute())
	{
		CHECK(shadeOnGl(gbuffer, ownSamples(settings), settings).visibility == fragments);
	}
}
