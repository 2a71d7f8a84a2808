// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/assets.h"
#include "shade/block.h"
#include "shade/gl_context.h"

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
} nook;
uniform sampler2D nook_depths;
uniform sampler2D nook_normals;
uniform sampler2D nook_samples;
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
	return (pixel.y % nook.count.y) * nook.count.y + pixel.x % nook.count.y;
}
vec4 nookSample(int row, int i)
{
	return texelFetch(nook_samples, ivec2(i, row), 0);
}
)";

const char* callOf(ShadeMethod method)
{
	switch (method)
	{
	case ShadeMethod::vo_line: return "nookVoLine";
	case ShadeMethod::vo_point: return "nookVoPoint";
	case ShadeMethod::alchemy: break;
	}
	return "nookAlchemy";
}

} // namespace

Shaded shadeOnGl(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings)
{
	const ShadeBlock block = blockOf(gbuffer, samples, settings);
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
	GlPass pass(std::string(kPrelude) + std::string(assets::camera_glsl) + std::string(assets::vo_glsl) +
				std::string(assets::alchemy_glsl) + "void main()\n{\n\tnook_visibility = " + callOf(settings.method) +
				"(ivec2(gl_FragCoord.xy));\n}\n");
	pass.bind("nook_depths", depth_texture);
	pass.bind("nook_normals", normal_texture);
	pass.bind("nook_samples", sample_texture);
	pass.bindBlock("NookBlock", std::as_bytes(std::span(&block, 1)));
	Shaded shaded{{}, context.renderer(), 0.0};
	shaded.visibility = pass.draw(gbuffer.width_px, gbuffer.height_px, shaded.seconds);
	return shaded;
}

} // namespace nook
