// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/assets.h"
#include "shade/block.h"
#include "shade/gl_context.h"
#include "shade/passes.h"

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
	vec4 radius;
	vec4 alchemy;
	ivec4 count;
	ivec4 grid;
} nook;
uniform sampler2D nook_depths;
uniform sampler2D nook_normals;
uniform sampler2D nook_samples;
uniform sampler2D nook_cells;
layout(location = 0) out float nook_visibility;

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
	return (cell.y % nook.count.y) * nook.count.y + cell.x % nook.count.y;
}
vec4 nookSample(int row, int i)
{
	return texelFetch(nook_samples, ivec2(i, row), 0);
}
float nookVisibility(ivec2 cell)
{
	return texelFetch(nook_cells, cell, 0).r;
}
)";

std::string sourceOf(const ShadePass& pass)
{
	const std::string value = pass.fills ? "nookVisibility(at)" : "-1.0";
	return std::string(kPrelude) + std::string(assets::camera_glsl) + std::string(assets::vo_glsl) +
		   std::string(assets::alchemy_glsl) + std::string(assets::reconstruct_glsl) +
		   "void main()\n{\n\tivec2 at = ivec2(gl_FragCoord.xy);\n\tnook_visibility = " + value +
		   ";\n\tif (nook_visibility < 0.0)\n\t{\n\t\tnook_visibility = " + pass.kernel.call +
		   (pass.of_pixel ? "(nookPixel(at))" : "(at)") + ";\n\t}\n}\n";
}

} // namespace

Shaded shadeOnGl(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings)
{
	const std::vector<ShadePass> passes = passesOf(gbuffer, samples, settings);
	const GlContext context;
	std::vector<glm::vec4> normals(gbuffer.normals.size());
	for (std::size_t i = 0; i < normals.size(); ++i)
	{
		normals[i] = glm::vec4(gbuffer.normals[i], 0.0F);
	}
	// Row 0 of the texture is the picture's upper one; gl_FragCoord counts the same way, since nothing is shown.
	const GlTexture depth_texture(gbuffer.width_px, gbuffer.height_px, 1, finiteDepths(gbuffer).data());
	const GlTexture normal_texture(gbuffer.width_px, gbuffer.height_px, 4, &normals[0].x);
	const GlTexture sample_texture(samples.count, samples.size * samples.size, 4, &samples.samples[0].x);
	Shaded shaded{{}, context.renderer(), 0.0, {}};
	std::unique_ptr<GlTexture> before;
	for (const ShadePass& pass : passes)
	{
		GlPass program(sourceOf(pass));
		auto target = std::make_unique<GlTexture>(pass.width, pass.height, 1, nullptr);
		program.bind("nook_depths", depth_texture);
		program.bind("nook_normals", normal_texture);
		program.bind("nook_samples", sample_texture);
		if (pass.reads_visibility)
		{
			program.bind("nook_cells", *before);
		}
		program.bindBlock("NookBlock", std::as_bytes(std::span(&pass.block, 1)));
		const double seconds = program.draw(*target, &pass == &passes.back() ? &shaded.visibility : nullptr);
		shaded.passes.push_back({pass.kernel.name, seconds});
		shaded.seconds += seconds;
		before = std::move(target);
	}
	return shaded;
}

} // namespace nook
