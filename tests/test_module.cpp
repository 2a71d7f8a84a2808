// SPDX-License-Identifier: GPL-3.0-or-later
// Emitted GLSL modules: every combination compiles in a foreign shader; the emitted header fills the block as our own code does.
#include "small_modules.h"
#include "small_views.h"
#include "testing.h"

#include "methods/kernel_text.h"
#include "shade/shade.h"

#include <regex>

namespace
{

constexpr std::array kEmitted{ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::alchemy};
constexpr std::array kTargets{GlslTarget::gl330, GlslTarget::gl430, GlslTarget::es300, GlslTarget::vulkan};

ModuleMethod methodOf(ShadeMethod method, int count, int window)
{
	const Domain domain = domainOf(method);
	if (window == 1)
	{
		return {method, {scatteredPattern(domain, count)}};
	}
	return {method, scatteredTile(domain, window, count, false).variants};
}

constexpr std::array<const char*, 4> kVersions{"#version 330 core\n", "#version 430 core\n",
											   "#version 300 es\nprecision mediump float;\n", "#version 450\n"};

// A shader of an engine that knows only the name of nook's function, and has names of its own that a careless module would also
// use.
std::string foreignShader(GlslTarget target, const std::string& module, const std::string& call)
{
	return std::string(kVersions[static_cast<std::size_t>(target)]) +
		   "layout(location = 0) out highp vec4 colour;\nconst float radius = 2.0;\nvec3 position(vec2 uv) { return vec3(uv, "
		   "radius); }\n"
		   "float scale = 1.0;\n#define SAMPLES 3\n" +
		   module + module + // tests the include guard
		   "void main()\n{\n\tivec2 size = ivec2(3);\n\tfloat depth = 0.0 * position(vec2(size)).x * scale;\n\tcolour = vec4(" +
		   call + " + depth);\n}\n";
}

// Names of macros, functions, uniforms, blocks and constants of a module.
std::vector<std::string> globalNames(const std::string& text)
{
	static const std::regex declaration(
		R"((?:^|\n)(?:#define |(?:layout\([^)]*\) )?(?:uniform|const|out|in) (?:\w+ )?|(?:void|float|int|[iu]?vec[234]) )(\w+))");
	std::vector<std::string> names;
	for (std::sregex_iterator it(text.begin(), text.end(), declaration), end; it != end; ++it)
	{
		names.push_back((*it)[1]);
	}
	return names;
}

const std::array<const char*, 3> kCalls{"nookVoLine", "nookVoPoint", "nookAlchemy"};

// A camera as an engine holds it: 90 degrees high, twice as wide, near 0.1. The table in docs/reference/modules.md says what to
// pass, and the engine's sources which row its textures begin with.
struct EngineCamera
{
	const char* engines;
	double up;      // the projection's second diagonal entry; the first is 1/2
	double z;       // its third
	double w;       // below that
	double z_start; // third row, fourth column
	bool rows;      // memory holds rows of a matrix for column vectors
	bool left_handed;
	bool zero_to_one;
	int first_row_ndc_y;
	bool top_first; // row 0 of a texture that the engine draws shows the top of the scene
};

constexpr double kNear = 0.1 / (0.1 - 100.0); // near / (near - far) with far = 100
constexpr double kTwice = 2 * kNear;
constexpr std::array kEngineCameras{
	EngineCamera{"Direct3D; bgfx with z from 0 to 1", 1, 1 - kNear, 1, 100 * kNear, false, true, true, 1, true},
	EngineCamera{
		"Unity, camera.projectionMatrix, on OpenGL also through GL.GetGPUProjectionMatrix; three.js; Babylon.js, right-handed", 1,
		kTwice - 1, -1, 100 * kTwice, false, false, false, -1, false},
	EngineCamera{"Unity, GL.GetGPUProjectionMatrix: reversed, upside down", -1, -kNear, -1, -100 * kNear, false, false, true, 1,
				 false},
	EngineCamera{"Unreal: reversed, infinite", 1, 0, 1, 0.1, false, true, true, 1, true},
	EngineCamera{"Godot 4.3, RenderSceneData.get_cam_projection: reversed, upside down", -1, -kNear, -1, -100 * kNear, false, false,
				 true, -1, true},
	EngineCamera{"Godot 4.3, Compatibility: reversed without clip control, upside down", -1, 1 - kTwice, -1, -100 * kTwice, false,
				 false, false, -1, true},
	EngineCamera{"three.js, reversedDepthBuffer", 1, -kNear, -1, -100 * kNear, false, false, true, -1, false},
	EngineCamera{"Babylon.js, left-handed; bgfx on OpenGL", 1, 1 - kTwice, 1, 100 * kTwice, false, true, false, -1, false},
	EngineCamera{"Babylon.js, WebGPU, left-handed: turns y of what it draws into textures", 1, 1 - kNear, 1, 100 * kNear, false,
				 true, true, -1, false},
	EngineCamera{"Babylon.js, WebGPU, right-handed", 1, kNear - 1, -1, 100 * kNear, false, false, true, -1, false},
	EngineCamera{"OGRE: rows", 1, kTwice - 1, -1, 100 * kTwice, true, false, false, 1, true},
	EngineCamera{"Filament: reversed, infinite", 1, 0, -1, 0.1, false, false, true, 1, true},
	EngineCamera{"Filament, OpenGL", 1, 0, -1, 0.1, false, false, true, -1, false},
};

} // namespace

TEST_CASE("module: every combination compiles, and takes no name but its own", "[emit]")
{
	REQUIRE(toolExists("glslangValidator"));
	std::size_t compiled = 0;
	for (unsigned chosen = 1; chosen < 8; ++chosen)
	{
		for (const GlslTarget target : kTargets)
		{
			for (const unsigned variant : {0U, 1U, 2U, 3U})
			{
				ModuleSettings settings;
				settings.target = target;
				settings.shade.use_normal = variant != 1;
				settings.shade.cut = variant == 1;
				settings.device_depth = variant == 2;
				settings.tile = variant == 3 ? TilePlace::array : TilePlace::texture;
				settings.shade.filter = variant == 3 ? ShadeFilter::window : ShadeFilter::none;
				std::string call = variant == 3 ? "nookWindow(ivec2(1))" : "0.0";
				for (std::size_t m = 0; m < kEmitted.size(); ++m)
				{
					if ((chosen >> m & 1U) != 0)
					{
						settings.methods.push_back(methodOf(kEmitted[m], 5 + static_cast<int>(m), variant < 2 ? 1 : 4));
						call += std::string(" + ") + kCalls[m] + "(ivec2(gl_FragCoord.xy))";
					}
				}
				const std::string module = moduleGlsl(settings, contextOf("nook emit"));
				CHECK(module == moduleGlsl(settings, contextOf("nook emit")));
				CHECK(module.find("#include") == std::string::npos);
				CHECK_FALSE(std::regex_search(module, std::regex("\n\t[^/\n]*nook\\.(count|grid)")));
				CHECK((module.find("nook_normals") != std::string::npos) ==
					  (settings.shade.use_normal || (chosen & 4U) != 0 || variant == 3));
				CHECK((module.find("nookLinear") != std::string::npos) == settings.device_depth);
				const std::vector<std::string> names = globalNames(module);
				CHECK(names.size() > 8);
				for (const std::string& name : names)
				{
					CHECK((name.starts_with("nook") || name.starts_with("NOOK")));
				}
				const bool whole = settings.methods.size() == 1 && variant == 2;
				settings.main = whole ? std::optional(ModuleMain::fragment) : std::nullopt;
				const std::string shader =
					whole ? moduleGlsl(settings, contextOf("nook emit")) : foreignShader(target, module, call);
				CAPTURE(chosen, static_cast<int>(target), variant);
				requireCompiles(shader, target);
				compiled += 1;
			}
		}
	}
	CHECK(compiled == 7U * 4U * 4U);
}

TEST_CASE("module: refuses another version of the language, in words", "[emit]")
{
	const TemporaryFolder folder;
	ModuleSettings settings;
	settings.methods = {methodOf(ShadeMethod::vo_line, 4, 1)};
	settings.target = GlslTarget::gl430;
	writeFile(folder / "m.frag", foreignShader(GlslTarget::gl330, moduleGlsl(settings, contextOf("nook emit")), "0.0"));
	CHECK_FALSE(passes("glslangValidator '" + folder / "m.frag" + "'", folder));
	const std::string log = readFile(folder / "log");
	CHECK((log.find("this module needs") != std::string::npos && log.find("430") != std::string::npos));
}

TEST_CASE("module: kernels with values in them keep the blocks that are asked for", "[emit]")
{
	const std::string text = "float f(int a)\n{\n#if NOOK_X == 1\n\tg(a);\n\t#if !NOOK_Y\n\th(a);\n\t#endif\n#elif NOOK_Y\n"
							 "\ti(NOOK_Y);\n#else\n\tj(a);\n#endif\n\treturn NOOK_XY * NOOK_X; // NOOK_X\n}\n";
	const auto with = [&text](const char* x, const char* y)
	{
		return resolved(text, {{"NOOK_X", x}, {"NOOK_Y", y}});
	};
	CHECK(with("1", "0") == "float f(int a)\n{\n\tg(a);\n\th(a);\n\treturn NOOK_XY * 1; // 1\n}\n");
	CHECK(with("1", "2") == "float f(int a)\n{\n\tg(a);\n\treturn NOOK_XY * 1; // 1\n}\n");
	CHECK(with("0", "2") == "float f(int a)\n{\n\ti(2);\n\treturn NOOK_XY * 0; // 0\n}\n");
	CHECK(with("0", "0") == "float f(int a)\n{\n\tj(a);\n\treturn NOOK_XY * 0; // 0\n}\n");
	CHECK_THROWS_AS(with("nook_pass.x", "0"), Error);
	CHECK_THROWS_AS(resolved("#if NOOK_X\n#endif\n", {}), Error);
	CHECK_THROWS_AS(resolved("#if NOOK_X && NOOK_Y\n#endif\n", {{"NOOK_X", "1"}, {"NOOK_Y", "1"}}), Error);
}

TEST_CASE("module: functions of kernels are found however a formatter lays them out", "[emit]")
{
	const KernelText kernels = parseKernels(
		{"// Licence.\n\n// Of g.\nfloat g(int a) {\n  if (a > 0) { return 1.0f; } // }\n  return 2.0f; }\nint h()\n{\n"
		 "    return 3; }\n"});
	REQUIRE(kernels.functions.size() == 2);
	CHECK(kernels.functions[0].name == "g");
	CHECK(kernels.functions[0].comment == "// Of g.\n");
	CHECK(kernels.functions[0].text == "float g(int a) {\n  if (a > 0) { return 1.0f; } // }\n  return 2.0f; }\n");
	CHECK(kernels.functions[1].name == "h");
	CHECK(renamed("a.b + b // b\n", {{"b", "c"}}) == "a.b + c // b\n");
	CHECK_THROWS_AS(parseKernels({"?\n"}), Error);
}

TEST_CASE("module: the table of members is the block", "[emit]")
{
	MemberPlace place;
	for (const BlockMember& member : blockMembers(true))
	{
		CAPTURE(member.name);
		place = placeOf(member, place.end);
		CHECK(member.offset == place.offset);
	}
	CHECK(placeOf({"vec2", "", "", 0}, 4).offset == 8);
	CHECK(placeOf({"ivec4", "", "", 0}, 20).end == 48);
	CHECK(placeOf({"float", "", "", 0}, 28).end == 32);
}

TEST_CASE("module: the emitted header fills the block as our own code does", "[emit]")
{
	glm::dmat4 reversed = projectionOf(lensOf(60.0), 1.5);
	reversed[2][2] = 0.0; // infinite and reversed
	reversed[3][2] = 0.1;
	glm::dmat4 off = projectionOf(lensOf(75.0), 16.0 / 9.0);
	off[2][0] = 0.13; // off-centre, and jittered
	off[2][1] = -0.07;
	glm::dmat4 flat = projectionOf(lensOf(0.0), 2.0);
	flat[3][0] = 0.25;
	flat[3][1] = -0.5;
	for (const glm::dmat4& projection : {projectionOf(lensOf(30.0), 1.0), reversed, off, flat})
	{
		GBuffer gbuffer;
		gbuffer.width_px = 321;
		gbuffer.height_px = 180;
		gbuffer.view.projection = projection;
		ShadeSettings shade;
		shade.method = ShadeMethod::statvo; // fills a part of the block that no other method uses
		shade.radius_m = 0.7;
		shade.sigma = 1.3;
		shade.contrast = 1.1;
		shade.beta = 3e-4;
		shade.epsilon = 2e-4;
		const ShadeBlock ours = blockOf(frameOf(gbuffer), {1, 1, {glm::vec4(0.0F)}}, shade);
		nook_settings settings;
		settings.width = 321;
		settings.height = 180;
		settings.first_row_ndc_y = 1;
		settings.radius = 0.7;
		settings.sigma = 1.3;
		settings.contrast = 1.1;
		settings.beta = 3e-4;
		settings.epsilon = 2e-4;
		double numbers[16];
		std::memcpy(numbers, &projection, sizeof numbers);
		nook_block theirs{};
		REQUIRE(nook_fill(theirs, numbers, settings) == nullptr);
		std::size_t end = 0;
		for (const BlockMember& member : blockMembers())
		{
			CAPTURE(member.name);
			CHECK(std::memcmp(reinterpret_cast<const char*>(&theirs) + member.offset,
							  reinterpret_cast<const char*>(&ours) + member.offset, placeOf(member, end).end - end) == 0);
			end = placeOf(member, end).end;
		}
		CHECK((end + 15) / 16 * 16 == sizeof theirs);
		settings.first_row_ndc_y = 0;
		CHECK(nook_fill(theirs, numbers, settings) != nullptr);
		settings.first_row_ndc_y = 1;
		numbers[4] = 0.1; // a skew
		CHECK(nook_fill(theirs, numbers, settings) != nullptr);
	}
	// Defaults agree between the header and nook.
	const nook_settings theirs;
	const ShadeSettings ours;
	CHECK(theirs.radius == ours.radius_m);
	CHECK((theirs.sigma == ours.sigma && theirs.contrast == ours.contrast));
	CHECK((theirs.beta == ours.beta && theirs.epsilon == ours.epsilon));
}

TEST_CASE("module: cameras of every convention give the rays and depths of one", "[emit]")
{
	const EngineCamera engine = GENERATE(from_range(kEngineCameras));
	CAPTURE(engine.engines);
	const double columns[16] = {0.5, 0, 0, 0, 0, engine.up, 0, 0, 0, 0, engine.z, engine.w, 0, 0, engine.z_start, 0};
	double memory[16]; // the engine's
	double passed[16];
	for (int i = 0; i < 16; ++i)
	{
		memory[i] = columns[engine.rows ? i % 4 * 4 + i / 4 : i];
		passed[i] = engine.left_handed && i >= 8 && i < 12 ? -columns[i] : columns[i];
	}
	nook_settings settings{.width = 640,
						   .height = 320,
						   .first_row_ndc_y = engine.first_row_ndc_y,
						   .device_depth = true,
						   .zero_to_one = engine.zero_to_one};
	nook_block block{};
	REQUIRE(nook_fill(block, passed, settings) == nullptr);
	CHECK(block.across_x[0] == 2.0F);
	CHECK(block.across_y[0] == (engine.top_first ? 1.0F : -1.0F));
	for (const double depth : {0.2, 1.0, 10.0, 90.0})
	{
		const double z = engine.left_handed ? depth : -depth; // in the engine's own view space and memory
		const auto row = [&](int i)
		{
			return columns[8 + i] * z + columns[12 + i];
		};
		const double ndc = row(2) / row(3);
		const double t = std::fabs((engine.zero_to_one ? ndc : 0.5 * ndc + 0.5) - block.far_end);
		const double linear = (block.depth[0] + block.depth[1] * t) / (block.depth[2] + block.depth[3] * t);
		CHECK(linear == Approx(depth).epsilon(1e-4));
	}
	if (engine.left_handed || engine.rows) // as it is in memory, it is refused
	{
		CHECK(nook_fill(block, memory, settings) != nullptr);
	}
}

TEST_CASE("module: the header compiles as C++17 without a warning", "[emit]")
{
	const TemporaryFolder folder;
	ModuleSettings settings;
	settings.methods = {methodOf(ShadeMethod::vo_line, 5, 4), methodOf(ShadeMethod::alchemy, 7, 1)};
	writeFile(folder / "one.h", moduleHeader(settings, contextOf("nook emit")));
	settings.methods = {methodOf(ShadeMethod::vo_point, 6, 4)};
	writeFile(folder / "two.h", moduleHeader(settings, contextOf("nook emit")));
	settings.methods = {methodOf(ShadeMethod::vo_line, 9, 4)};
	settings.methods.front().recipe = *recipeFor(raysRecipes(), ShadeMethod::vo_line);
	settings.header_namespace = "finest"; // in addition to another module of vo-line
	writeFile(folder / "three.h", moduleHeader(settings, contextOf("nook emit")));
	writeFile(
		folder / "both.cpp",
		"#include \"one.h\"\n#include \"two.h\"\n#include \"one.h\"\n#include \"three.h\"\nint main()\n{\n\tconst float p[16] = "
		"{1, 0, 0, 0, 0, 1, 0, 0, "
		"0, 0, -1, -1, 0, 0, -1, 0};\n\tnook_settings s;\n\ts.width = 640;\n\ts.height = 360;\n\tnook_block b{};\n"
		"\treturn nook_fill(b, p, s) == nullptr && b.across_y[0] == -1.0f && nook_vo_line_tile[79][3] > 0.0f && "
		"nook_vo_point_tile_height == "
		"6 && finest::nook_vo_line_tile_height == 9 && nook_vo_line_tile_height == 5 && "
		"finest::nook_vo_line_settings(2.0).radius > 0.0 ? 0 : 1;\n}\n");
	for (const std::string compiler : {"g++", "clang++"})
	{
		if (toolExists(compiler))
		{
			CHECK(passes(
				compiler +
					" -std=c++17 -Wall -Wextra -Werror -pedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion '" +
					folder / "both.cpp" + "' -o '" + folder / "both" + "' && '" + folder / "both" + "'",
				folder));
		}
	}
}
