// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade.h"

#include "core/error.h"
#include "core/lists.h"
#include "core/parallel.h"
#include "methods/kernels.h"
#include "methods/passes.h"
#include "shade/gl_context.h"
#include "shade/run_passes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cmath>
#include <memory>
#include <span>

namespace nook
{

ShadeFrame frameOf(const GBuffer& gbuffer)
{
	assert(gbuffer.normals.size() == gbuffer.depth.size());
	return {gbuffer.width_px, gbuffer.height_px, gbuffer.view.projection, gbuffer.depth, gbuffer.depth_error_m};
}

std::vector<float> finiteDepths(const GBuffer& gbuffer)
{
	std::vector<float> depths = gbuffer.depth;
	for (float& depth : depths)
	{
		depth = std::isfinite(depth) ? depth : NOOK_SKY;
	}
	return depths;
}

Shaded shadeOnCpu(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, const RunSettings& run,
				  const DrawSettings& drawing)
{
	const std::vector<float> depths = finiteDepths(gbuffer);
	shade_kernels::Kernels inputs;
	inputs.depths = depths;
	inputs.normals = gbuffer.normals;
	inputs.samples = samples.samples;
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings, settings.statvo.builder != TableBuilder::fragments);
	std::vector<Planes> pictures = picturesFor(plan);
	std::vector<std::vector<PassTime>> drawings(static_cast<std::size_t>(drawing.repetitions) + 1);
	for (std::vector<PassTime>& times : drawings)
	{
		for (const ShadePass& pass : plan.passes)
		{
			const auto start = std::chrono::steady_clock::now();
			runPass(pass, inputs, pictures, run);
			times.push_back({pass.kernel.name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
		}
	}
	Shaded shaded;
	shaded.renderer = "CPU";
	shaded.tables_by = settings.statvo.builder == TableBuilder::fragments ? "fragments" : "scans";
	PicturePlane& last = pictures[plan.passes.back().picture][0];
	setResult(shaded, std::move(last.values), last.channels == 4);
	setTimes(shaded, drawings);
	return shaded;
}

LimitedRadii limitedRadii(const GBuffer& gbuffer, const ShadeSettings& settings)
{
	shade_kernels::Kernels kernels;
	kernels.nook = blockOf(frameOf(gbuffer), {1, 1, {glm::vec4(0.0F)}}, settings);
	const float radius = kernels.nook.radius;
	LimitedRadii limited;
	for (const float depth : gbuffer.depth)
	{
		if (std::isfinite(depth))
		{
			const float used = kernels.nookRadius(radius, depth);
			limited.near += used < radius ? 1U : 0U;
			limited.far += used > radius ? 1U : 0U;
		}
	}
	return limited;
}

namespace
{

void store(PicturePlane& plane, std::size_t at, float value)
{
	plane.values[at] = value;
}
void store(PicturePlane& plane, std::size_t at, const glm::vec4& value)
{
	std::copy_n(&value.x, 4, plane.values.begin() + static_cast<std::ptrdiff_t>(at));
}
void store(PicturePlane& plane, std::size_t at, const glm::uvec4& value)
{
	std::copy_n(&value.x, 4, plane.counts.begin() + static_cast<std::ptrdiff_t>(at));
}

// Levels or layers of a picture.
Planes planesOf(const PictureShape& shape)
{
	Planes planes(static_cast<std::size_t>(std::max(shape.levels, shape.layers)));
	for (std::size_t i = 0; i < planes.size(); ++i)
	{
		const int level = shape.levels > 1 ? static_cast<int>(i) : 0;
		PicturePlane& plane = planes[i];
		plane.width = levelSide(shape.width, level);
		plane.height = levelSide(shape.height, level);
		plane.channels = channelsOf(shape.format);
		const std::size_t size = plane.index(0, plane.height);
		plane.values.resize(shape.format == PictureFormat::counts ? 0 : size);
		plane.counts.resize(shape.format == PictureFormat::counts ? size : 0);
	}
	return planes;
}

// Connects the pictures that the pass reads.
void connect(const ShadePass& pass, const std::vector<Planes>& pictures, shade_kernels::Kernels& kernels)
{
	kernels.nook = pass.block;
	for (const ShadeRead& read : pass.reads)
	{
		const Planes& planes = pictures[read.picture];
		switch (read.slot)
		{
		case ShadeSlot::cells: kernels.cells = planes.data(); break;
		case ShadeSlot::packed: kernels.packed = planes.data(); break;
		case ShadeSlot::levels: kernels.levels = planes; break;
		case ShadeSlot::tables: kernels.tables = planes; break;
		case ShadeSlot::range: kernels.range = planes.data(); break;
		}
	}
}

void drawAt(const ShadePass& pass, shade_kernels::Kernels& kernels, glm::ivec2 at, PicturePlane& plane, std::size_t index)
{
	const glm::ivec2 place = pass.of_pixel ? kernels.nookPixel(at) : at;
	if (pass.packing == ShadePacking::none)
	{
		std::visit([&](const auto function) { store(plane, index, (kernels.*function)(place)); }, pass.kernel.function);
		return;
	}
	const float visibility = (kernels.*std::get<0>(pass.kernel.function))(place);
	store(plane, index,
		  pass.packing == ShadePacking::links ? kernels.nookLinked(at, visibility) : kernels.nookOfSurface(at, visibility));
}

// Processes rows in parallel.
void draw(const ShadePass& pass, const shade_kernels::Kernels& kernels, PicturePlane& plane, const RunSettings& run)
{
	const auto height = static_cast<std::size_t>(plane.height);
	ProgressCounter progress(run.progress, pass.kernel.name, height);
	const auto row = [&](std::size_t y)
	{
		shade_kernels::Kernels own = kernels;
		for (int x = 0; x < plane.width; ++x)
		{
			const glm::ivec2 at(x, static_cast<int>(y));
			const std::size_t index = plane.index(at.x, at.y);
			if (!pass.fills || plane.values[index] < 0.0F)
			{
				drawAt(pass, own, at, plane, index);
			}
		}
		progress.finishOne();
	};
	parallelFor(height, run.threads, row);
}

constexpr std::array<const char*, 5> kSamplers{"nook_cells", "nook_packed", "nook_levels", "nook_tables",
											   "nook_range"}; // in the order of ShadeSlot

// Throws Error (unsupported) if compute shaders are requested but not available.
bool usesCompute(const GlContext& context, const ShadeSettings& settings)
{
	const TableBuilder builder = settings.statvo.builder;
	refuseIf(builder == TableBuilder::compute && !context.hasCompute(),
			 "OpenGL: found no compute shaders in " + context.renderer() + ", expected OpenGL 4.3", ExitCode::unsupported);
	const bool automatic = context.hasCompute() && !context.isSoftware(); // on llvmpipe, compute shaders are five times slower
	return builder == TableBuilder::compute || (builder == TableBuilder::automatic && automatic);
}

// A G-buffer and its samples on the GPU. Row 0 is the top row, also in gl_FragCoord, since nothing is displayed.
struct Inputs
{
	GlTexture depths;
	GlTexture normals;
	GlTexture samples;
	GlLeft left;

	Inputs(const GBuffer& gbuffer, const ShadeSamples& of, std::span<const glm::vec4> four)
		: depths(gbuffer.width_px, gbuffer.height_px, 1, finiteDepths(gbuffer).data()),
		  normals(gbuffer.width_px, gbuffer.height_px, 4, &four[0].x),
		  samples(of.count, static_cast<int>(of.samples.size()) / of.count, 4, &of.samples[0].x),
		  left(gbuffer.width_px, gbuffer.height_px)
	{
	}
};

// Sets up a pass with its inputs.
std::unique_ptr<GlPass> programOf(GlSession& session, const ShadePass& pass, const ShadePlan& plan, const Inputs& inputs,
								  std::span<const std::unique_ptr<GlTexture>> pictures)
{
	auto program = std::make_unique<GlPass>(session.program(glSourceOf(pass, plan.pictures[pass.picture].format)));
	program->bind("nook_depths", inputs.depths);
	program->bind("nook_normals", inputs.normals);
	program->bind("nook_samples", inputs.samples);
	for (const ShadeRead& read : pass.reads)
	{
		program->bind(kSamplers[static_cast<std::size_t>(read.slot)], *pictures[read.picture]);
	}
	if (pass.leaves || pass.fills)
	{
		program->use(inputs.left, pass.fills);
	}
	program->bindBlock("NookBlock", std::as_bytes(std::span(&pass.block, 1)));
	return program;
}

} // namespace

std::vector<Planes> picturesFor(const ShadePlan& plan)
{
	return mapped(plan.pictures, [](const PictureShape& shape) { return planesOf(shape); });
}

void runPass(const ShadePass& pass, const shade_kernels::Kernels& inputs, std::vector<Planes>& pictures, const RunSettings& run)
{
	shade_kernels::Kernels kernels = inputs;
	connect(pass, pictures, kernels);
	PicturePlane& plane = pictures[pass.picture][static_cast<std::size_t>(pass.level + pass.layer)];
	if (pass.scans)
	{
		scanOnCpu(kernels.tables[0], pass.block.axis, plane, run);
	}
	else
	{
		draw(pass, kernels, plane, run);
	}
}

void scanOnCpu(const PicturePlane& source, int axis, PicturePlane& target, const RunSettings& run)
{
	assert(source.counts.size() == target.counts.size() && source.width == target.width);
	const std::size_t row = source.index(0, 1);
	const auto height = static_cast<std::size_t>(source.height);
	if (axis == 0)
	{
		parallelFor(height, run.threads,
					[&](std::size_t y)
					{
						std::array<std::uint32_t, 4> sum{};
						for (std::size_t i = y * row; i < (y + 1) * row; ++i)
						{
							sum[i % 4] += source.counts[i];
							target.counts[i] = sum[i % 4];
						}
					});
		return;
	}
	constexpr std::size_t kBand = 64; // columns summed at a time per thread
	parallelFor((row / 4 + kBand - 1) / kBand, run.threads,
				[&](std::size_t band)
				{
					const std::size_t first = 4 * kBand * band;
					const std::size_t end = std::min(row, first + 4 * kBand);
					for (std::size_t y = 0; y < height; ++y)
					{
						for (std::size_t i = y * row + first; i < y * row + end; ++i)
						{
							target.counts[i] = source.counts[i] + (y > 0 ? target.counts[i - row] : 0U);
						}
					}
				});
}

PassTime passTimeOf(const std::string& name, std::vector<double> seconds)
{
	seconds.erase(seconds.begin(), seconds.begin() + (seconds.size() > 1 ? 1 : 0));
	const std::vector<double> drawings = seconds;
	const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
	std::nth_element(seconds.begin(), middle, seconds.end());
	return {name, *middle, drawings};
}

void setResult(Shaded& shaded, std::vector<float> values, bool quads)
{
	if (!quads)
	{
		shaded.visibility = std::move(values);
		return;
	}
	for (std::size_t i = 0; i < values.size(); i += 4)
	{
		shaded.bent.emplace_back(values[i], values[i + 1], values[i + 2]);
		shaded.visibility.push_back(values[i + 3]);
	}
}

void setTimes(Shaded& shaded, const std::vector<std::vector<PassTime>>& drawings)
{
	for (std::size_t pass = 0; pass < drawings.front().size(); ++pass)
	{
		const auto seconds = mapped(drawings, [&](const std::vector<PassTime>& drawn) { return drawn[pass].seconds; });
		shaded.passes.push_back(passTimeOf(drawings.front()[pass].name, seconds));
		shaded.seconds += shaded.passes.back().seconds;
	}
}

Shaded shadeOnGl(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, const DrawSettings& drawing)
{
	std::optional<GlSession> own;
	GlSession& session = drawing.session != nullptr ? *drawing.session : own.emplace(drawing.gl_device);
	const GlContext& context = session.use();
	const bool compute = usesCompute(context, settings);
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings, compute);
	const auto normals = mapped(gbuffer.normals, [](const glm::vec3& normal) { return glm::vec4(normal, 0.0F); });
	const Inputs inputs(gbuffer, samples, normals);
	std::vector<std::unique_ptr<GlTexture>> pictures =
		mapped(plan.pictures, [&](const PictureShape& shape) { return std::make_unique<GlTexture>(shape); });
	std::array<std::unique_ptr<GlScan>, 2> scans;
	std::vector<std::unique_ptr<GlPass>> programs; // null for scans
	for (const ShadePass& pass : plan.passes)
	{
		if (pass.scans)
		{
			std::unique_ptr<GlScan>& scan = scans[static_cast<std::size_t>(pass.block.axis)];
			scan = scan ? std::move(scan) : std::make_unique<GlScan>(pass.block.axis);
			programs.push_back(nullptr);
			continue;
		}
		programs.push_back(programOf(session, pass, plan, inputs, pictures));
	}
	const auto draw = [&]
	{
		std::vector<PassTime> times;
		for (std::size_t i = 0; i < programs.size(); ++i)
		{
			const ShadePass& pass = plan.passes[i];
			const GlTexture& target = *pictures[pass.picture];
			const bool timer = !context.isSoftware();
			times.push_back({pass.kernel.name, pass.scans ? scans[static_cast<std::size_t>(pass.block.axis)]->run(
																*pictures[pass.reads.front().picture], target, pass.layer, timer)
														  : programs[i]->draw(target, pass.level, pass.layer, timer)});
		}
		return times;
	};
	warmUp(context, drawing.repetitions, draw);
	const auto times = listOf(static_cast<std::size_t>(drawing.repetitions) + 1, [&](std::size_t) { return draw(); });
	Shaded shaded;
	shaded.renderer = context.renderer();
	shaded.tables_by = compute ? "compute" : "fragments";
	const GlTexture& last = *pictures[plan.passes.back().picture];
	const bool quads = last.shape.format == PictureFormat::quad;
	setResult(shaded, readFloats(last), quads);
	setTimes(shaded, times);
	return shaded;
}

} // namespace nook
