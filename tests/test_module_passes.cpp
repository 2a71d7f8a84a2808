// SPDX-License-Identifier: GPL-3.0-or-later
// Emitted modules with several passes: an engine that follows their list of passes draws what nook shade draws on the CPU.
#include "picture_errors.h"
#include "small_modules.h"
#include "small_views.h"
#include "testing.h"

#include "pattern/recipe.h"
#include "shade/gl_context.h"
#include "shade/shade.h"

#include <epoxy/gl.h>

#include <regex>

namespace
{

constexpr std::array<const char*, 4> kVersionLines{"#version 330 core\n", "#version 430 core\n", "#version 300 es\n",
												   "#version 450\n"};
constexpr std::array<const char*, 3> kTypes{"float", "vec4", "uvec4"};
constexpr std::array<const char*, 5> kSlots{"nook_cells", "nook_packed", "nook_levels", "nook_tables", "nook_range"};

// Requires the program that was bound last to be in use.
void setPass(const glm::ivec4& values, bool floats)
{
	GLint current = 0;
	glGetIntegerv(GL_CURRENT_PROGRAM, &current);
	const int place = glGetUniformLocation(static_cast<GLuint>(current), "nook_pass");
	const glm::vec4 numbers(values);
	floats ? glUniform4f(place, numbers.x, numbers.y, numbers.z, numbers.w)
		   : glUniform4i(place, values.x, values.y, values.z, values.w);
}

std::string shaderOf(const ModuleSettings& settings, const std::string& module, PictureFormat format, const std::string& call)
{
	return std::string(kVersionLines[static_cast<std::size_t>(settings.target)]) + module + "layout(location = 0) out highp " +
		   kTypes[static_cast<std::size_t>(format)] +
		   " colour;\nvoid main()\n{\n\tivec2 at = ivec2(gl_FragCoord.xy);\n\tcolour = " + call + ";\n}\n";
}

std::unique_ptr<GlTexture> tileOf(const ShadeSamples& samples)
{
	const std::vector<glm::vec4> texels = tileTexels(samples);
	return std::make_unique<GlTexture>(static_cast<int>(texels.size()) / samples.count, samples.count, 4, &texels[0].x);
}

// The module with a counter of its depth reads, including reads of coarser levels if `levels` hold depth.
std::string counting(std::string module, bool levels)
{
	std::vector<std::string> fetches{"texelFetch(nook_depths, pixel, 0)"};
	fetches.resize(levels ? 2 : 1, "texelFetch(nook_levels, texel, level)");
	for (const std::string& fetch : fetches)
	{
		const std::size_t at = module.find(fetch);
		module = at == std::string::npos ? module : module.replace(at, fetch.size(), "(nook_reads += 1, " + fetch + ")");
	}
	return "int nook_reads = 0;\n" + module;
}

// If `counts` is given, stores the maximum count of each pass by its call.
std::vector<float> drawn(const GBuffer& gbuffer, const ModuleSettings& settings, int first_row_ndc_y = 1, int frame = 0,
						 std::map<std::string, int>* counts = nullptr)
{
	const std::string module = moduleGlsl(settings, contextOf("nook emit"));
	const ShadeSamples samples = samplesFor(settings);
	const ShadePlan plan = planOf(frameOf(gbuffer), samples, settings.shade, false);
	const std::vector<float> block = bytesFor(passBlockFor(gbuffer, settings.shade, first_row_ndc_y, frame), settings.float_block);
	const std::vector<glm::vec4> four = mapped(gbuffer.normals, [](const glm::vec3& normal) { return glm::vec4(normal, 0.0F); });
	const GlTexture depths(gbuffer.width_px, gbuffer.height_px, 1, finiteDepths(gbuffer).data());
	const GlTexture normals(gbuffer.width_px, gbuffer.height_px, 4, &four[0].x);
	const std::unique_ptr<GlTexture> tile = tileOf(samples);
	const std::vector<std::unique_ptr<GlTexture>> pictures =
		mapped(plan.pictures, [](const PictureShape& shape) { return std::make_unique<GlTexture>(shape); });
	std::string entry;
	std::vector<std::string> calls;
	std::vector<ShadeRead> upsampled;
	for (const ShadePass& pass : plan.passes)
	{
		if (std::string(pass.kernel.call) == "nookUpsample") // a part of nook...Full
		{
			upsampled = pass.reads;
			continue;
		}
		entry = pass.of_pixel ? pass.kernel.call : entry;
		const PictureFormat format = plan.pictures[pass.picture].format;
		const std::string call = passCallOf(pass, entry, settings.shade.half_resolution);
		const auto draw = [&](GlPass& program, const GlTexture& picture, int level, int layer)
		{
			program.bind("nook_normals", normals);
			for (const char* const name :
				 {"nook_vo_line_tile", "nook_vo_point_tile", "nook_vo_area_tile", "nook_alchemy_tile", "nook_slices_tile"})
			{
				program.bind(name, *tile);
			}
			std::vector<ShadeRead> reads = pass.reads;
			if (pass.fills)
			{
				reads.insert(reads.end(), upsampled.begin(), upsampled.end());
			}
			for (const ShadeRead& read : reads)
			{
				program.bind(kSlots[static_cast<std::size_t>(read.slot)], *pictures[read.picture]);
			}
			program.bindBlock("nook_block", std::as_bytes(std::span(block)));
			program.bind("nook_depths", depths);
			setPass(modulePassOf(pass.block, pass.kernel.call), settings.float_block);
			program.draw(picture, level, layer);
		};
		if (counts != nullptr && pass.level == 0)
		{
			const PictureShape& shape = plan.pictures[pass.picture];
			const GlTexture picture(PictureShape{PictureFormat::scalar, shape.width, shape.height});
			GlPass program(std::string(kVersionLines[static_cast<std::size_t>(settings.target)]) +
						   counting(module, rowOf(settings.shade.method).moments || settings.shade.depth_levels > 0) +
						   "out highp float colour;\nvoid main()\n{\n\tivec2 at = ivec2(gl_FragCoord.xy);\n\t" +
						   kTypes[static_cast<std::size_t>(format)] + " value = " + call + ";\n\tcolour = float(nook_reads);\n}\n");
			draw(program, picture, 0, 0);
			const std::vector<float> reads = readFloats(picture);
			int& most = (*counts)[pass.fills ? entry + "Full" : moduleCallOf(pass)];
			most = std::max(most, static_cast<int>(*std::max_element(reads.begin(), reads.end())));
		}
		GlPass program(settings.main ? withDefinitions(module, "#define NOOK_PASS " + passNumber(calls, call) + "\n")
									 : shaderOf(settings, module, format, call));
		draw(program, *pictures[pass.picture], pass.level, pass.layer);
	}
	const GlTexture& last = *pictures[plan.passes.back().picture];
	return last.shape.format == PictureFormat::quad ? readFloats(last) : readFloats(last);
}

// With row 0 at the bottom, turned back.
std::vector<float> drawnTurned(const GBuffer& gbuffer, const ModuleSettings& settings)
{
	std::vector<float> picture = drawn(turned(gbuffer), settings, -1);
	const int width = gbuffer.width_px;
	const int last = gbuffer.height_px - 1;
	for (int y = 0; y < last - y; ++y)
	{
		std::swap_ranges(picture.begin() + y * width, picture.begin() + (y + 1) * width, picture.begin() + (last - y) * width);
	}
	return picture;
}

// The depth reads stated in a module's introduction, by call.
int statedReads(const std::string& module, const std::string& call)
{
	std::smatch match;
	const std::regex alone("\n//   \\w+ " + call +
						   "\\(ivec2 pixel\\):[^\n]*(?:\n//       [^\n]*)*?\n//       depth reads per pixel: at most (\\d+)");
	const std::regex pass("\\n//   " + call + "\\([^)]*\\)[^\\n]*(?:\\n//       [^\\n]*)*?\\b(\\d+) depth reads? per texel");
	return std::regex_search(module, match, pass) || std::regex_search(module, match, alone) ? std::stoi(match[1]) : 0;
}

} // namespace

TEST_CASE("module: its head states the depth reads of each pass", "[emit]")
{
	const GBuffer gbuffer = builtinView("courtyard", 128, 72);
	std::vector<PassCase> cases = passCases();
	for (const ShadeMethod method : {ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::alchemy, ShadeMethod::slices})
	{
		PassCase one{"one pass", {}};
		one.shade.method = method;
		one.shade.volume = {0.4, 0.2, 0.1, TwoRadii::product, 0.3, 0.1};
		one.shade.slices = {3, 5};
		cases.push_back(one);
		one.name = "one pass, normals from depth";
		cases.push_back(one);
	}
	PassCase bent{"bent normals", {}};
	bent.shade.method = ShadeMethod::slices;
	bent.shade.slices.bent = true;
	bent.shade.filter = ShadeFilter::bilateral;
	cases.push_back(bent);
	bent.shade.filter = ShadeFilter::none;
	cases.push_back(bent);
	const GlContext context;
	for (const PassCase& one : cases)
	{
		ModuleSettings settings = moduleOf(one, GlslTarget::gl330);
		settings.normals_from_depth = std::string(one.name).ends_with("from depth");
		std::map<std::string, int> counts;
		drawn(gbuffer, settings, 1, 0, &counts);
		const std::string module = moduleGlsl(settings, contextOf("nook emit"));
		CHECK(counts.size() > 0);
		for (const auto& [call, count] : counts)
		{
			CAPTURE(one.name, call, count);
			const int stated = statedReads(module, call);
			if (call == "nookStatCells") // per table, on two lines
			{
				CHECK(module.find("1 depth read per pixel") != std::string::npos);
				CHECK(count <= 2 * one.shade.statvo.cell_px * one.shade.statvo.cell_px);
			}
			else if (call.ends_with("Full")) // plus those of the method, at edges
			{
				CHECK(stated == 1);
				CHECK(count >= stated);
			}
			else if (one.shade.bands.count > 1 && call == "nookAlchemyLinked") // all bands, for a large radius
			{
				CHECK(count <= stated);
			}
			else
			{
				CHECK(count == stated);
			}
		}
	}
}

TEST_CASE("module: bent normals drawn as the module's head says are those of nook shade", "[emit]")
{
	const GBuffer gbuffer = builtinView("courtyard", 128, 72);
	const GlslTarget target = GENERATE(GlslTarget::gl330, GlslTarget::gl430, GlslTarget::es300);
	const GlContext context(target == GlslTarget::es300 ? GlApi::es : GlApi::core);
	for (const ShadeFilter filter : {ShadeFilter::none, ShadeFilter::bilateral})
	{
		for (const bool tiled : {false, true})
		{
			ModuleSettings settings;
			settings.target = target;
			settings.shade.method = ShadeMethod::slices;
			settings.shade.radius_m = 0.8;
			settings.shade.slices.bent = true;
			settings.shade.slices.steps = 4;
			settings.shade.filter = filter;
			settings.methods = {{ShadeMethod::slices, {}}};
			if (tiled)
			{
				settings.methods.front().variants = {4, slicePattern(1)};
				for (std::size_t i = 0; i < 4; ++i)
				{
					settings.methods.front().variants[i].points[0] = {(static_cast<double>(i) + 0.5) / 4.0, 0.2, 0.0};
				}
			}
			const Shaded cpu = shadeOnCpu(gbuffer, samplesFor(settings), settings.shade, {2, {}});
			const std::vector<float> gl = drawn(gbuffer, settings);
			std::vector<float> expected;
			for (std::size_t i = 0; i < cpu.bent.size(); ++i)
			{
				expected.insert(expected.end(), {cpu.bent[i].x, cpu.bent[i].y, cpu.bent[i].z, cpu.visibility[i]});
			}
			CAPTURE(static_cast<int>(target), static_cast<int>(filter), tiled, context.renderer());
			checkSamePicture(expected, gl);
		}
	}
}

TEST_CASE("module: nothing of bent normals is in it without --bent, and its codes are with it", "[emit]")
{
	ModuleSettings settings;
	settings.shade.method = ShadeMethod::slices;
	settings.methods = {{ShadeMethod::slices, {}}};
	const std::string without = moduleGlsl(settings, contextOf("nook emit"));
	for (const char* const name : {"Bent", "nookSliceToward", "nookSliceSum"})
	{
		CHECK(without.find(name) == std::string::npos);
	}
	settings.shade.slices.bent = true;
	const std::string with = moduleGlsl(settings, contextOf("nook emit"));
	for (const char* const name :
		 {"vec4 nookSlicesBent(ivec2 pixel)", "vec4 nookBentCoded(", "vec4 nookBentDecoded(", "float nookConeAngle("})
	{
		CHECK(with.find(name) != std::string::npos);
	}
	CHECK(with.find("float nookSlices(") == std::string::npos);
}

TEST_CASE("module: passes drawn as the module's head says and whole shaders make the picture of nook shade", "[emit]")
{
	const GBuffer gbuffer = builtinView("courtyard", 128, 72);
	const GlslTarget target = GENERATE(GlslTarget::gl330, GlslTarget::gl430, GlslTarget::es300);
	const GlContext context(target == GlslTarget::es300 ? GlApi::es : GlApi::core);
	for (const PassCase& one : passCases())
	{
		ModuleSettings settings = moduleOf(one, target);
		const std::vector<float> cpu = shadeOnCpu(gbuffer, samplesFor(settings), settings.shade, {2, {}}).visibility;
		const std::vector<float> gl = drawn(gbuffer, settings);
		CAPTURE(one.name, static_cast<int>(target), context.renderer());
		checkSamePicture(cpu, gl);
		ModuleSettings whole = settings;
		whole.main = ModuleMain::fragment;
		whole.tile = TilePlace::array;
		whole.textures = target == GlslTarget::gl430 ? ModuleTextures::macros : ModuleTextures::fixed;
		checkSamePicture(cpu, drawn(gbuffer, whole));
		settings.float_block = true; // the same to the bit
		CHECK(drawn(gbuffer, settings) == gl);
		CHECK(moduleGlsl(settings, contextOf("nook emit")).find("\tivec2 first;") == std::string::npos);
	}
}

TEST_CASE("module: a compute shader's bindings are where its text puts them", "[emit]")
{
	const GBuffer gbuffer = builtinView("courtyard", 129, 75); // no multiple of a group
	const GlContext context;
	if (!context.hasCompute())
	{
		WARN("no compute shaders in " << context.renderer());
		return;
	}
	for (const ShadeMethod method : {ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::alchemy, ShadeMethod::slices})
	{
		ModuleSettings settings = moduleOf(method, ShadeFilter::none, GlslTarget::gl430);
		settings.main = ModuleMain::compute;
		settings.tile = TilePlace::array;
		const std::string text = withDefinitions(moduleGlsl(settings, contextOf("nook emit")), "#define NOOK_OUT_FORMAT r32f\n");
		const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
		const char* const source = text.c_str();
		glShaderSource(shader, 1, &source, nullptr);
		glCompileShader(shader);
		const GLuint program = glCreateProgram();
		glAttachShader(program, shader);
		glLinkProgram(program);
		GLint linked = 0;
		glGetProgramiv(program, GL_LINK_STATUS, &linked);
		REQUIRE(linked == GL_TRUE);
		glUseProgram(program);
		const std::vector<float> block = bytesFor(passBlockFor(gbuffer, settings.shade, 1, 0), false);
		GLuint buffer = 0;
		glGenBuffers(1, &buffer);
		glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer);
		glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(block.size() * 4), block.data(), GL_STATIC_DRAW);
		const std::vector<glm::vec4> four =
			mapped(gbuffer.normals, [](const glm::vec3& normal) { return glm::vec4(normal, 0.0F); });
		const GlTexture depths(gbuffer.width_px, gbuffer.height_px, 1, finiteDepths(gbuffer).data());
		const GlTexture normals(gbuffer.width_px, gbuffer.height_px, 4, &four[0].x);
		const GlTexture picture(PictureShape{PictureFormat::scalar, gbuffer.width_px, gbuffer.height_px});
		glActiveTexture(GL_TEXTURE1);
		glBindTexture(GL_TEXTURE_2D, depths.name);
		glActiveTexture(GL_TEXTURE2);
		glBindTexture(GL_TEXTURE_2D, normals.name);
		glBindImageTexture(0, picture.name, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
		glDispatchCompute((129 + 7) / 8, (75 + 7) / 8, 1);
		glMemoryBarrier(GL_ALL_BARRIER_BITS);
		CAPTURE(static_cast<int>(method), context.renderer());
		REQUIRE(glGetError() == GL_NO_ERROR);
		checkSamePicture(shadeOnCpu(gbuffer, samplesFor(settings), settings.shade, {2, {}}).visibility, readFloats(picture));
		glDeleteBuffers(1, &buffer);
		glDeleteProgram(program);
		glDeleteShader(shader);
	}
}

TEST_CASE("module: with row 0 at the bottom the picture is that of nook shade, turned", "[emit]")
{
	const GBuffer gbuffer = builtinView("courtyard", 128, 75); // not a multiple of the window
	const GlContext context;
	for (const ShadeMethod method : {ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::alchemy, ShadeMethod::slices})
	{
		for (const ShadeFilter filter : {ShadeFilter::none, ShadeFilter::window, ShadeFilter::bilateral})
		{
			const ModuleSettings settings = moduleOf(method, filter, GlslTarget::gl330);
			const std::vector<float> above = shadeOnCpu(gbuffer, samplesFor(settings), settings.shade, {2, {}}).visibility;
			CAPTURE(static_cast<int>(method), static_cast<int>(filter), context.renderer());
			checkSamePicture(above, drawnTurned(gbuffer, settings));
		}
	}
}

TEST_CASE("module: tiles of several frames draw those of nook shade", "[emit]")
{
	const GBuffer gbuffer = builtinView("courtyard", 96, 54);
	struct Shown
	{
		ShadeSamples samples;
		ShadeSettings shade;
		std::vector<float> cpu;
	};
	std::vector<Shown> shown;
	for (const GlslTarget target : {GlslTarget::gl330, GlslTarget::gl430, GlslTarget::es300})
	{
		const GlContext context(target == GlslTarget::es300 ? GlApi::es : GlApi::core);
		for (const bool moves : {false, true})
		{
			PatternTile tile = scatteredTile(Domain::disk, 3, 5, false);
			tile.frames = 4;
			tile.moves = moves ? tileMoves(3, 4) : std::vector<glm::ivec2>{};
			for (int i = 9; i < 9 * layersOf(tile); ++i)
			{
				tile.variants.push_back(scatteredPattern(Domain::disk, 5, static_cast<uint64_t>(i) + 1));
			}
			std::vector<float> first;
			for (const int frame : {0, 1, 3, 6})
			{
				for (const bool half : {false, true})
				{
					ModuleSettings settings;
					settings.target = target;
					settings.shade.radius_m = 0.8;
					settings.shade.half_resolution = half;
					settings.shade.filter = half ? ShadeFilter::bilateral : ShadeFilter::none;
					settings.tile = frame == 3 ? TilePlace::array : TilePlace::texture;
					settings.float_block = frame == 6;
					settings.methods = {{ShadeMethod::vo_line, tile.variants}};
					settings.methods.front().frames = tile.frames;
					settings.methods.front().moves = tile.moves;
					ShadeSamples samples = samplesFor(settings);
					samples.variant = variantOfFrame(tile, frame);
					const std::vector<float> cpu = shadeOnCpu(gbuffer, samples, settings.shade, {2, {}}).visibility;
					CAPTURE(moves, frame, half, static_cast<int>(target), context.renderer());
					checkSamePicture(cpu, drawn(gbuffer, settings, 1, frame));
					shown.push_back({samples, settings.shade, cpu});
					first = first.empty() ? cpu : first;
					CHECK((frame == 0 || half || cpu != first));
				}
			}
		}
	}
	for (std::size_t i = 0; i < shown.size() / 3; ++i) // for one target: the same text that nook shade draws
	{
		checkSamePicture(shown[i].cpu, shadeOnGl(gbuffer, shown[i].samples, shown[i].shade).visibility);
	}
	nook_settings settings;
	settings.width = settings.height = 1;
	settings.frame = -1;
	nook_block block{};
	double numbers[16];
	std::memcpy(numbers, &gbuffer.view.projection, sizeof numbers);
	CHECK(nook_fill(block, numbers, settings) != nullptr);
	settings.frame = 16777216;
	CHECK(nook_fill(block, numbers, settings) == nullptr);
}

TEST_CASE("module: slices of a tile over frames draw those of nook shade", "[emit]")
{
	const GBuffer gbuffer = builtinView("courtyard", 96, 54);
	TileRecipe recipe{.filters = {tileFilterNamed("bilateral:5")}, .frames = 4};
	const PatternTile tile = generateTile(slicePattern(2), recipe, RunSettings{2, {}});
	const GlslTarget target = GENERATE(GlslTarget::gl330, GlslTarget::gl430, GlslTarget::es300);
	const GlContext context(target == GlslTarget::es300 ? GlApi::es : GlApi::core);
	for (const int frame : {0, 3})
	{
		ModuleSettings settings;
		settings.target = target;
		settings.shade.method = ShadeMethod::slices;
		settings.shade.radius_m = 0.8;
		settings.shade.filter = ShadeFilter::bilateral;
		settings.tile = frame == 3 ? TilePlace::array : TilePlace::texture;
		settings.methods = {{ShadeMethod::slices, tile.variants}};
		settings.methods.front().frames = tile.frames;
		ShadeSamples samples = samplesFor(settings);
		samples.variant = variantOfFrame(tile, frame);
		CAPTURE(frame, static_cast<int>(target), context.renderer());
		checkSamePicture(shadeOnCpu(gbuffer, samples, settings.shade, {2, {}}).visibility, drawn(gbuffer, settings, 1, frame));
	}
}

TEST_CASE("module: normals from depth draw the picture of nook shade --normals from-depth", "[emit]")
{
	const GBuffer gbuffer = builtinView("courtyard", 128, 75);
	GBuffer made = gbuffer;
	normalsFromDepth(made);
	GBuffer without = gbuffer;
	without.normals.assign(without.normals.size(), glm::vec3(0.0F)); // not read by this module
	const GlContext context;
	for (const ShadeMethod method : {ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::alchemy, ShadeMethod::slices})
	{
		for (const ShadeFilter filter : {ShadeFilter::none, ShadeFilter::window, ShadeFilter::bilateral})
		{
			ModuleSettings settings = moduleOf(method, filter, GlslTarget::gl330);
			settings.normals_from_depth = true;
			CHECK(moduleGlsl(settings, contextOf("nook emit")).find("nook_normals") == std::string::npos);
			const std::vector<float> cpu = shadeOnCpu(made, samplesFor(settings), settings.shade, {2, {}}).visibility;
			CAPTURE(static_cast<int>(method), static_cast<int>(filter), context.renderer());
			checkSamePicture(cpu, drawn(without, settings));
			checkSamePicture(cpu, drawnTurned(without, settings));
		}
	}
}

TEST_CASE("module: with normals from depth an open plane reads 1", "[emit]")
{
	glm::dmat4 off = projectionOf(lensOf(75.0), 96.0 / 54.0);
	off[2][0] = 0.13;
	off[2][1] = -0.07;
	const GlContext context;
	for (const glm::dmat4& projection : {projectionOf(lensOf(60.0), 96.0 / 54.0), off, projectionOf(lensOf(0.0), 96.0 / 54.0)})
	{
		for (const double tilt_deg : {0.0, 30.0, 60.0, 75.0})
		{
			for (const ShadeMethod method : {ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::slices})
			{
				ModuleSettings settings = moduleOf(method, ShadeFilter::none, GlslTarget::gl330);
				settings.normals_from_depth = true;
				CAPTURE(static_cast<int>(method), tilt_deg, projection[2][3], context.renderer());
				const std::vector<float> picture = drawn(planeAt(projection, 96, 54, tilt_deg), settings);
				CHECK(*std::min_element(picture.begin(), picture.end()) >= 1.0F - 1.0F / 255.0F);
			}
		}
	}
}

TEST_CASE("module: passes compile for every target, and for Vulkan", "[emit]")
{
	const GlslTarget target = GENERATE(GlslTarget::gl330, GlslTarget::gl430, GlslTarget::es300, GlslTarget::vulkan);
	const bool other = GENERATE(false, true);
	const PassCase one = GENERATE(from_range(passCases()));
	ModuleSettings settings = moduleOf(one, target);
	settings.gather = true;
	settings.float_block = other;
	settings.normals_from_depth = other;
	settings.device_depth = other;
	if (other && mayTakeTile(one.shade.method))
	{
		settings.methods.front().variants = generateTile(slicePattern(2), {}, RunSettings{2, {}}).variants;
	}
	if (other && settings.methods.front().variants.size() > 1)
	{
		settings.methods.front().frames = 4; // of 2 x 2 pixels
	}
	const std::string module = moduleGlsl(settings, contextOf("nook emit"));
	const ShadePlan plan = planOf(frameOf(builtinView("cornell", 32, 32)), samplesFor(settings), settings.shade, false);
	std::string entry;
	std::string calls = "vec4(nookGather(at, vec3(0.0, 0.0, -1.0), vec3(0.0, 0.0, 1.0)))";
	for (const ShadePass& pass : plan.passes)
	{
		entry = pass.of_pixel ? pass.kernel.call : entry;
		calls += " + vec4(" + passCallOf(pass, entry, settings.shade.half_resolution) + ")";
	}
	CAPTURE(one.name, other, static_cast<int>(target));
	requireCompiles(shaderOf(settings, module, PictureFormat::quad, calls), target);
}
