// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/error.h"
#include "methods/block.h"
#include "methods/passes.h"
#include "shade/gl_context.h"
#include "shade/pass_times.h"
#include "shade/shade.h"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace nook
{
namespace
{

constexpr std::array<const char*, 5> kSamplers{"nook_cells", "nook_packed", "nook_levels", "nook_tables",
											   "nook_range"}; // in the order of ShadeSlot

// Throws Error (unsupported) if compute shaders are requested but not available.
bool usesCompute(const GlContext& context, const ShadeSettings& settings)
{
	const TableBuilder builder = settings.statvo.builder;
	if (builder == TableBuilder::compute && !context.hasCompute())
	{
		throw Error(ExitCode::unsupported, "OpenGL: found no compute shaders in " + context.renderer() + ", expected OpenGL 4.3");
	}
	const bool automatic = context.hasCompute() && !context.isSoftware(); // on llvmpipe, compute shaders are five times slower
	return builder == TableBuilder::compute || (builder == TableBuilder::automatic && automatic);
}

// A G-buffer and its samples on the GPU. Row 0 of a texture is the top row; gl_FragCoord counts the same way, since nothing is
// displayed.
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
	if (pass.leaves)
	{
		program->leave(inputs.left);
	}
	if (pass.fills)
	{
		program->fill(inputs.left);
	}
	program->bindBlock("NookBlock", std::as_bytes(std::span(&pass.block, 1)));
	return program;
}

} // namespace

Shaded shadeOnGl(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, const DrawSettings& drawing)
{
	std::optional<GlSession> own;
	GlSession& session = drawing.session != nullptr ? *drawing.session : own.emplace(drawing.gl_device);
	const GlContext& context = session.use();
	const bool compute = usesCompute(context, settings);
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings, compute);
	std::vector<glm::vec4> normals(gbuffer.normals.size());
	for (std::size_t i = 0; i < normals.size(); ++i)
	{
		normals[i] = glm::vec4(gbuffer.normals[i], 0.0F);
	}
	const Inputs inputs(gbuffer, samples, normals);
	std::vector<std::unique_ptr<GlTexture>> pictures;
	for (const PictureShape& shape : plan.pictures)
	{
		pictures.push_back(std::make_unique<GlTexture>(shape));
	}
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
	const auto draw = [&](PassTimes& times)
	{
		for (std::size_t i = 0; i < programs.size(); ++i)
		{
			const ShadePass& pass = plan.passes[i];
			const GlTexture& target = *pictures[pass.picture];
			const bool timer = !context.isSoftware();
			times.add(i, pass.scans ? scans[static_cast<std::size_t>(pass.block.axis)]->run(*pictures[pass.reads.front().picture],
																							target, pass.layer, timer)
									: programs[i]->draw(target, pass.level, pass.layer, timer));
		}
	};
	PassTimes cold(plan);
	warmUp(context, drawing.repetitions, [&] { draw(cold); });
	PassTimes times(plan);
	for (int repetition = 0; repetition < PassTimes::drawings(drawing); ++repetition)
	{
		draw(times);
	}
	Shaded shaded;
	shaded.renderer = context.renderer();
	shaded.tables_by = compute ? "compute" : "fragments";
	const GlTexture& last = *pictures[plan.passes.back().picture];
	const bool quads = last.shape().format == PictureFormat::quad;
	setResult(shaded, quads ? readQuads(last) : readScalar(last), quads);
	times.finish(shaded);
	return shaded;
}

} // namespace nook
