// SPDX-License-Identifier: GPL-3.0-or-later
// The GLSL function that reads probes compared with the CPU.
#include "small_levels.h"
#include "testing.h"

#include "bake/probes.h"
#include "shade/gl_context.h"

#include <epoxy/gl.h>

namespace
{

constexpr int kSide = 64; // picture side: 4096 points

// Four floats per pixel.
std::vector<float> paddedOf(const std::vector<glm::dvec3>& values)
{
	std::vector<float> padded;
	for (const glm::dvec3& value : values)
	{
		for (const double number : {value.x, value.y, value.z, 0.0})
		{
			padded.push_back(static_cast<float>(number));
		}
	}
	return padded;
}

struct Asked
{
	std::vector<glm::dvec3> positions; // inside the grid and outside
	std::vector<glm::dvec3> normals;
};

Asked askedOf(const ProbeGrid& grid)
{
	Random random(5);
	Asked asked;
	for (int i = 0; i < kSide * kSide; ++i)
	{
		const glm::dvec3 share{random.uniform(), random.uniform(), random.uniform()};
		const glm::dvec3 at = grid.origin + grid.spacing_m * (glm::dvec3(grid.count) * 1.4 * share - 0.5);
		asked.positions.emplace_back(glm::vec3(at)); // rounded as in the shader
		const glm::dvec3 way{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
		asked.normals.emplace_back(glm::vec3(glm::normalize(way)));
	}
	return asked;
}

std::vector<float> drawnBy(GlApi api, const ProbeGrid& grid, const Asked& asked)
{
	const GlContext context(api);
	const GlTexture positions(kSide, kSide, 4, paddedOf(asked.positions).data());
	const GlTexture normals(kSide, kSide, 4, paddedOf(asked.normals).data());
	unsigned probes = 0;
	constexpr unsigned kUnit = 8; // not used by the pass
	glGenTextures(1, &probes);
	glActiveTexture(GL_TEXTURE0 + kUnit);
	glBindTexture(GL_TEXTURE_3D, probes);
	glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, grid.count.x, grid.count.y, grid.count.z, 0, GL_RGBA, GL_UNSIGNED_BYTE,
				 grid.texels.data());
	glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	glActiveTexture(GL_TEXTURE0);
	const std::string head = api == GlApi::es ? "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp "
												"sampler2D;\nprecision highp sampler3D;\n"
											  : "#version 330 core\n";
	const GlName program = fragmentProgram(head + probesGlsl(grid, "nook test") +
										   "uniform sampler3D probes;\nuniform sampler2D positions;\nuniform sampler2D normals;\n"
										   "out vec4 shown;\nvoid main()\n{\n\tivec2 pixel = ivec2(gl_FragCoord.xy);\n"
										   "\tshown = vec4(nookProbeVisibility(probes, texelFetch(positions, pixel, 0).xyz, "
										   "texelFetch(normals, pixel, 0).xyz));\n}\n");
	glUseProgram(program);
	glUniform1i(glGetUniformLocation(program, "probes"), static_cast<int>(kUnit));
	std::vector<float> values;
	{
		GlPass pass(program);
		pass.bind("positions", positions);
		pass.bind("normals", normals);
		const GlTexture target(PictureShape{PictureFormat::scalar, kSide, kSide, 1, 1});
		pass.draw(target);
		values = readFloats(target);
	}
	glDeleteTextures(1, &probes);
	return values;
}

} // namespace

TEST_CASE("bake: the driver reads probes as the CPU does", "[bake][gl]")
{
	Level level = emptyLevel();
	addBox(level, {-3.0, -1.0, -3.0}, {3.0, 0.0, 3.0});
	addBox(level, {-1.0, 0.0, -1.0}, {1.0, 2.0, 1.0});
	const Tracer tracer(level, {});
	BakeSettings settings{.radius_m = 1.0, .rays = 60};
	const double spacing_m = GENERATE(0.5, 2.5, 100.0); // the last one gives a single probe
	const ProbeGrid grid = bakeProbes(tracer, spacing_m, settings, {});
	const Asked asked = askedOf(grid);
	const GlApi api = GENERATE(GlApi::core, GlApi::es);
	const std::vector<float> drawn = drawnBy(api, grid, asked);
	double most = 0.0;
	std::size_t between = 0;
	for (std::size_t i = 0; i < drawn.size(); ++i)
	{
		const double expected = visibilityAt(grid, asked.positions[i], asked.normals[i]);
		most = std::max(most, std::fabs(static_cast<double>(drawn[i]) - expected));
		between += expected > 0.05 && expected < 0.95 ? 1U : 0U;
	}
	CAPTURE(spacing_m);
	CHECK(most < 1e-4); // 32 bits against 64
	CHECK((spacing_m > 1.0 || between > 500));
}
