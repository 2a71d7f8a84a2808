// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/probes.h"

#include "core/number.h"
#include "format/ktx2.h"

namespace nook
{
namespace
{

std::string listed(glm::dvec3 v)
{
	return numberText(v.x) + " " + numberText(v.y) + " " + numberText(v.z);
}

// A number with a point or an exponent, as GLSL ES wants it.
std::string real(double value)
{
	const std::string text = numberText(value);
	return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string vector(glm::dvec3 v)
{
	return "vec3(" + real(v.x) + ", " + real(v.y) + ", " + real(v.z) + ")";
}

} // namespace

std::string probesKtx2(const ProbeGrid& grid, std::string_view writer)
{
	Ktx2Texture texture;
	texture.texel = Ktx2Texel::rgba8_unorm;
	texture.width = static_cast<uint32_t>(grid.count.x);
	texture.height = static_cast<uint32_t>(grid.count.y);
	texture.depth = static_cast<uint32_t>(grid.count.z);
	texture.notes = {{"KTXwriter", std::string(writer)},
					 {"Layout", "visibility for the normal n = (255 a - 1) / 254 + dot(rgb - 0.5, n); a = 0: inside matter"},
					 {"nook:origin_m", listed(grid.origin)},
					 {"nook:spacing_m", numberText(grid.spacing_m)}};
	texture.bytes.reserve(4 * grid.texels.size());
	for (const std::array<uint8_t, 4>& texel : grid.texels)
	{
		texture.bytes.append(reinterpret_cast<const char*>(texel.data()), texel.size());
	}
	return ktx2Bytes(texture);
}

std::string probesGlsl(const ProbeGrid& grid, std::string_view writer)
{
	const std::string count =
		std::to_string(grid.count.x) + ", " + std::to_string(grid.count.y) + ", " + std::to_string(grid.count.z);
	std::string text = "// SPDX-License-Identifier: MIT\n// Made by " + std::string(writer) + ": nook bake --probes.\n";
	text += "const vec3 NOOK_PROBE_ORIGIN = " + vector(grid.origin) + "; // of the first probe, metres, the level's world space\n";
	text += "const float NOOK_PROBE_SPACING = " + real(grid.spacing_m) + ";\n";
	text += "const ivec3 NOOK_PROBE_COUNT = ivec3(" + count + ");\n";
	// Step by step as visibilityAt() in probes.cpp.
	return text + R"(
// Visibility in [0, 1] at a point with a unit normal, both in the level's world space. `probes` is the KTX2 file's texture.
float nookProbeVisibility(sampler3D probes, vec3 position, vec3 normal)
{
	vec3 at = clamp((position - NOOK_PROBE_ORIGIN) / NOOK_PROBE_SPACING, vec3(0.0), vec3(NOOK_PROBE_COUNT - ivec3(1)));
	ivec3 first = min(ivec3(at), max(NOOK_PROBE_COUNT - ivec3(2), ivec3(0)));
	vec3 share = at - vec3(first);
	float sum = 0.0;
	float weights = 0.0;
	for (int i = 0; i < 8; ++i)
	{
		ivec3 offset = ivec3(i & 1, (i >> 1) & 1, i >> 2);
		ivec3 probe = min(first + offset, NOOK_PROBE_COUNT - ivec3(1));
		vec4 texel = texelFetch(probes, probe, 0);
		vec3 trilinear = mix(vec3(1.0) - share, share, vec3(offset));
		vec3 way = NOOK_PROBE_ORIGIN + NOOK_PROBE_SPACING * vec3(probe) - position;
		float facing = 0.5 + 0.5 * dot(way, normal) / max(length(way), 1e-6 * NOOK_PROBE_SPACING);
		float weight = (trilinear.x * trilinear.y * trilinear.z + 1e-4) * (facing * facing + 0.05);
		weight = texel.w == 0.0 ? 0.0 : weight; // inside matter
		sum += weight * ((255.0 * texel.w - 1.0) / 254.0 + dot(texel.xyz - vec3(0.5), normal));
		weights += weight;
	}
	return weights > 0.0 ? clamp(sum / weights, 0.0, 1.0) : 1.0;
}
)";
}

} // namespace nook
