// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/error.h"
#include "shade/assets.h"
#include "shade/block.h"
#include "shade/gl_context.h"
#include "shade/gl_scan.h"
#include "shade/pass_times.h"
#include "shade/passes.h"

#include <array>
#include <memory>
#include <string>

namespace nook
{
namespace
{

constexpr const char* kPrelude = R"(#version 330 core
#define NOOK_SKY 1e30f
layout(std140) uniform NookBlock
{
	vec4 size;
	vec4 across_x;
	vec4 across_y;
	vec4 w;
	vec4 origin;
	ivec4 rect;
	vec4 depth;
	vec4 error;
	vec4 radius;
	vec4 alchemy;
	vec4 volume;
	vec4 limits;
	ivec4 count;
	ivec4 features;
	ivec4 bands;
	ivec4 grid;
	vec4 statvo;
	ivec4 layers;
	ivec4 table;
	ivec4 march;
	vec4 rival;
} nook;
uniform sampler2D nook_depths;
uniform sampler2D nook_normals;
uniform sampler2D nook_samples;
uniform sampler2D nook_cells;
uniform sampler2D nook_levels;
uniform highp usampler2DArray nook_tables;
uniform sampler2D nook_range;

float nookDepth(ivec2 pixel)
{
	return texelFetch(nook_depths, pixel, 0).r;
}
vec3 nookNormal(ivec2 pixel)
{
	return texelFetch(nook_normals, pixel, 0).xyz;
}
int nookVariant(ivec2 pixel)
{
	ivec2 cell = pixel / nook.grid.x;
	int own = (cell.y % nook.count.y) * nook.count.y + cell.x % nook.count.y;
	return (own + nook.march.w) % (nook.count.y * nook.count.y);
}
vec4 nookSample(int row, int i)
{
	return texelFetch(nook_samples, ivec2(i, row), 0);
}
float nookVisibility(ivec2 cell)
{
	return texelFetch(nook_cells, cell, 0).r;
}
vec4 nookLevel(ivec2 texel, int level)
{
	return texelFetch(nook_levels, texel, level);
}
uvec4 nookTable(ivec2 texel, int table)
{
	return texelFetch(nook_tables, ivec3(texel, table), 0);
}
vec4 nookRange(int i)
{
	return texelFetch(nook_range, ivec2(i, 0), 0);
}
)";

constexpr std::array<const char*, 3> kTypes{"float", "vec4", "uvec4"}; // in the order of PictureFormat

std::string statVoText()
{
	return std::string(assets::tables_glsl) + std::string(assets::statvo_tables_glsl) + std::string(assets::statvo_flags_glsl) +
		   std::string(assets::statvo_glsl);
}

// Puts in the whole numbers of the block, as a module has them: renderers on a CPU walk through both sides of an if.
std::string withConstants(std::string text, const ShadeBlock& block)
{
	struct Member
	{
		const char* name;
		glm::ivec4 values;
	};
	for (const Member& member : {Member{"count", block.count}, Member{"layers", block.layers}, Member{"table", block.table}})
	{
		for (int i = 0; i < 4; ++i)
		{
			const std::string name = std::string("nook.") + member.name + "." + "xyzw"[i];
			const std::string value = "(" + std::to_string(member.values[i]) + ")";
			for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + value.size()))
			{
				text.replace(at, name.size(), value);
			}
		}
	}
	return text;
}

// Methods to compare with, each in a text of its own, StatVO, and the debug views.
std::string rivalsText(const ShadePass& pass)
{
	const std::string_view call = pass.kernel.call;
	if (call == "nookCrytek")
	{
		return std::string(assets::rivals_crytek_glsl);
	}
	if (call == "nookVolumetric")
	{
		return std::string(assets::rivals_volumetric_glsl);
	}
	if (call == "nookHbao")
	{
		return std::string(assets::rivals_hbao_glsl);
	}
	if (call == "nookDebugLayers")
	{
		return std::string(assets::rivals_sao_glsl) + std::string(assets::debug_glsl) + statVoText() +
			   std::string(assets::debug_statvo_glsl);
	}
	if (call.substr(0, 9) == "nookDebug")
	{
		return std::string(assets::rivals_sao_glsl) + std::string(assets::debug_glsl);
	}
	if (call.substr(0, 8) == "nookStat" || call.substr(0, 9) == "nookTable")
	{
		return withConstants(statVoText(), pass.block);
	}
	return call == "nookSao" ? std::string(assets::rivals_sao_glsl) : "";
}

std::string sourceOf(const ShadePlan& plan, const ShadePass& pass)
{
	const std::string type = kTypes[static_cast<std::size_t>(plan.pictures[pass.picture].format)];
	const std::string call = std::string(pass.kernel.call) + (pass.of_pixel ? "(nookPixel(at))" : "(at)");
	const std::string text = std::string(kPrelude) + std::string(assets::camera_glsl) + std::string(assets::depth_glsl) +
							 std::string(assets::depth_levels_glsl) + std::string(assets::vo_glsl) +
							 std::string(assets::vo_area_glsl) + std::string(assets::alchemy_glsl) +
							 std::string(assets::reconstruct_glsl) + rivalsText(pass) + "layout(location = 0) out " + type +
							 " nook_out;\nvoid main()\n{\n\tivec2 at = ivec2(gl_FragCoord.xy);\n";
	if (pass.fills)
	{
		return text + "\tnook_out = nookVisibility(at);\n\tif (nook_out < 0.0)\n\t{\n\t\tnook_out = " + call + ";\n\t}\n}\n";
	}
	return text + "\tnook_out = " + call + ";\n}\n";
}

constexpr std::array<const char*, 4> kSamplers{"nook_cells", "nook_levels", "nook_tables",
											   "nook_range"}; // in the order of ShadeSlot

// Throws Error (unsupported) where compute shaders are asked for and not there.
bool usesCompute(const GlContext& context, const ShadeSettings& settings)
{
	const TableBuilder builder = settings.statvo.builder;
	if (builder == TableBuilder::compute && !context.hasCompute())
	{
		throw Error(ExitCode::unsupported, "OpenGL: found no compute shaders in " + context.renderer() + ", expected OpenGL 4.3");
	}
	const bool automatic = context.hasCompute() && !context.isSoftware(); // llvmpipe: five times slower by compute shaders
	return builder == TableBuilder::compute || (builder == TableBuilder::automatic && automatic);
}

} // namespace

Shaded shadeOnGl(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings, const DrawSettings& drawing)
{
	const GlContext context(GlApi::core, drawing.gl_device);
	const bool compute = usesCompute(context, settings);
	const ShadePlan plan = planOf(gbuffer, samples, settings, compute);
	std::vector<glm::vec4> normals(gbuffer.normals.size());
	for (std::size_t i = 0; i < normals.size(); ++i)
	{
		normals[i] = glm::vec4(gbuffer.normals[i], 0.0F);
	}
	// Row 0 of the texture is the picture's upper one; gl_FragCoord counts the same way, since nothing is shown.
	const GlTexture depth_texture(gbuffer.width_px, gbuffer.height_px, 1, finiteDepths(gbuffer).data());
	const GlTexture normal_texture(gbuffer.width_px, gbuffer.height_px, 4, &normals[0].x);
	const GlTexture sample_texture(samples.count, samples.size * samples.size, 4, &samples.samples[0].x);
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
			std::unique_ptr<GlScan>& scan = scans[static_cast<std::size_t>(pass.block.table.y)];
			scan = scan ? std::move(scan) : std::make_unique<GlScan>(pass.block.table.y);
			programs.push_back(nullptr);
			continue;
		}
		auto program = std::make_unique<GlPass>(sourceOf(plan, pass));
		program->bind("nook_depths", depth_texture);
		program->bind("nook_normals", normal_texture);
		program->bind("nook_samples", sample_texture);
		for (const ShadeRead& read : pass.reads)
		{
			program->bind(kSamplers[static_cast<std::size_t>(read.slot)], *pictures[read.picture]);
		}
		program->bindBlock("NookBlock", std::as_bytes(std::span(&pass.block, 1)));
		programs.push_back(std::move(program));
	}
	PassTimes times(plan);
	for (int repetition = 0; repetition < PassTimes::drawings(drawing); ++repetition)
	{
		for (std::size_t i = 0; i < programs.size(); ++i)
		{
			const ShadePass& pass = plan.passes[i];
			const GlTexture& target = *pictures[pass.picture];
			const bool timer = !context.isSoftware();
			times.add(i, pass.scans ? scans[static_cast<std::size_t>(pass.block.table.y)]->run(
										  *pictures[pass.reads.front().picture], target, pass.layer, timer)
									: programs[i]->draw(target, pass.level, pass.layer, timer));
		}
	}
	Shaded shaded{
		readScalar(*pictures[plan.passes.back().picture]), context.renderer(), 0.0, {}, compute ? "compute" : "fragments"};
	times.finish(drawing, shaded);
	return shaded;
}

} // namespace nook
