// SPDX-License-Identifier: GPL-3.0-or-later
// nook bake: a level → the same level with visibility at its vertices.
#include "bake_options.h"
#include "scene_summary.h"

#include "bake/probes.h"
#include "bake/sheets.h"
#include "bake/texture.h"
#include "core/image.h"
#include "core/math.h"
#include "core/text.h"
#include "core/work_units.h"
#include "format/pattern_file.h"
#include "scene/level_glb.h"
#include "scene/second_uvs.h"
#include "version.h"

#include <cstdio>
#include <optional>

namespace nook
{
namespace
{

constexpr std::size_t kCheckPoints = 4096;

void addResult(Summary& summary, const BakeOptions& options, const VertexBake& bake, std::size_t bytes)
{
	double sum = 0.0;
	for (const float value : bake.visibility)
	{
		sum += static_cast<double>(value);
	}
	if (bake.refined)
	{
		summary.whole("baked_triangles", bake.refined->triangles.size());
		summary.whole("triangles_above", bake.above);
		summary.number("area_above_m2", bake.area_above_m2);
		summary.text("stopped_by", bake.capped ? "max-vertices" : bake.above > 0 ? "shortest-edge" : "max-error");
	}
	summary.whole("vertices", bake.visibility.size());
	summary.whole("values", bake.unknowns);
	summary.whole("points", bake.points);
	summary.whole("buried_points", bake.buried);
	summary.whole("shut_points", bake.shut);
	summary.whole("rays", bake.rays);
	summary.whole("bytes", bytes);
	summary.number(options.beside.path.empty() ? "mean_visibility" : "mean_difference",
				   sum / static_cast<double>(bake.visibility.size()));
	summary.number("rms_standard_error", bake.standard_error);
}

std::string refinementLine(const VertexBake& bake, double max_error)
{
	if (!bake.refined)
	{
		return "";
	}
	return "refined: " + std::to_string(bake.refined->triangles.size()) + " triangles, " + std::to_string(bake.above) +
		   " of them with errors above " + roundedText(max_error, 3) + ", " + roundedText(bake.area_above_m2, 3) + " m2\n";
}

std::string describe(const VertexBake& bake, const BakeCheck& check, std::size_t bytes)
{
	return "bake: " + std::to_string(bake.visibility.size()) + " vertices, " + std::to_string(bake.rays) + " rays from " +
		   std::to_string(bake.points) + " points (" + std::to_string(bake.buried) + " inside matter, " +
		   std::to_string(bake.shut) + " shut in)\n" + "standard error: " + roundedText(bake.standard_error, 3) +
		   " at the vertices\n" + "error: RMSE " + roundedText(check.rmse, 3) + ", bias " + roundedText(check.bias, 3) +
		   " against rays at " + std::to_string(check.points) + " other points of the surface\n" +
		   "file: " + std::to_string(bytes) + " bytes\n";
}

std::string bentLine(const BakeOptions& options, const BakeCheck& check)
{
	return options.settings.bent
			   ? "bent normals: " + roundedText(check.angle_rad * 180.0 / kPi, 3) + " degrees from those of rays in the mean\n"
			   : "";
}

void addCheck(Summary& summary, const BakeCheck& check)
{
	summary.whole("check_points", check.points);
	summary.whole("check_buried", check.buried);
	summary.whole("check_shut", check.shut);
	summary.whole("check_rays", check.rays);
	summary.number("check_standard_error", check.standard_error);
	summary.number("rmse", check.rmse);
	summary.number("rmse_seen", check.rmse_seen);
	summary.number("bias", check.bias);
}

// What a run has made.
struct Made
{
	std::vector<std::string> bytes; // a file each of the outputs, in their order
	std::string lines;
	std::vector<std::string> warnings;
};

Made makeVertices(const BakeOptions& options, const Tracer& tracer, Summary& summary, const RunSettings& how)
{
	const VertexBake bake = bakeVertices(tracer, options.settings, how);
	const Level& baked = bake.refined ? *bake.refined : tracer.level();
	const BakeCheck check = checkBake(tracer, baked, bake, options.settings, kCheckPoints, how);
	finishUnits(how);
	const std::string bytes =
		levelGlb(baked, "nook " NOOK_VERSION,
				 {bake.visibility, options.color, {}, {}, bake.back, bake.bent, bake.bent_back, kindOf(options.beside)});
	addResult(summary, options, bake, bytes.size());
	addCheck(summary, check);
	if (options.settings.beside)
	{
		summary.number("rmse_of_volumes", check.rmse_without);
	}
	if (options.settings.bent)
	{
		summary.number("bent_angle_deg", check.angle_rad * 180.0 / kPi);
	}
	Made made{std::vector<std::string>(options.outputs.files.size(), bytes),
			  refinementLine(bake, options.settings.max_error) + describe(bake, check, bytes.size()) + bentLine(options, check),
			  {}};
	if (bake.capped)
	{
		made.warnings.push_back("--max-vertices: " + std::to_string(options.settings.max_vertices) + " left " +
								std::to_string(bake.above) + " triangles with errors above " +
								roundedText(options.settings.max_error, 3));
	}
	if (options.settings.beside && !(check.rmse < check.rmse_without))
	{
		made.warnings.push_back(options.beside.path + ": found an RMSE of " + roundedText(check.rmse, 3) +
								" with the difference baked, expected less than the " + roundedText(check.rmse_without, 3) +
								" of the volumes alone; more --rays may help");
	}
	return made;
}

Made makeTexture(const BakeOptions& options, const Tracer& tracer, Summary& summary, const RunSettings& how)
{
	const Level& level = tracer.level();
	const std::vector<glm::vec2> second = loadSecondUvs(options.level.level, options.level.load, level, how);
	const std::vector<glm::vec2>& uvs = second.empty() ? level.uvs : second;
	const TextureBake bake = bakeTexture(tracer, uvs, options.texture_px, options.settings, how);
	const BakeCheck check = checkTexture(tracer, uvs, bake, options.settings, kCheckPoints, how);
	finishUnits(how);
	std::vector<uint8_t> rgb;
	rgb.reserve(3 * bake.values.size());
	for (const uint8_t value : bake.values)
	{
		rgb.insert(rgb.end(), {value, value, value});
	}
	const std::string png = pngBytes(bake.size_px, bake.size_px, rgb, {});
	const std::string bytes = levelGlb(level, "nook " NOOK_VERSION, {{}, false, uvs, png, {}, {}, {}});
	summary.text("coordinates", second.empty() ? "first" : "second");
	summary.whole("texels_across", static_cast<std::size_t>(bake.size_px));
	summary.whole("charts", bake.charts);
	summary.whole("covered_texels", bake.covered);
	summary.whole("shared_texels", bake.shared);
	summary.whole("buried_texels", bake.buried);
	summary.whole("missed_triangles", bake.missed);
	summary.whole("rays", bake.rays);
	summary.whole("bytes", bytes.size());
	summary.whole("png_bytes", png.size());
	summary.number("rms_standard_error", bake.standard_error);
	addCheck(summary, check);
	const std::string lines = "texture: " + std::to_string(bake.size_px) + " x " + std::to_string(bake.size_px) + " texels, " +
							  std::to_string(bake.covered) + " of them in " + std::to_string(bake.charts) + " charts, " +
							  std::to_string(bake.shared) + " in more than one, " + std::to_string(bake.buried) +
							  " inside matter\n" + "triangles without a texel: " + std::to_string(bake.missed) + "\n" +
							  "standard error: " + roundedText(bake.standard_error, 3) + " of a texel\n" + "error: RMSE " +
							  roundedText(check.rmse, 3) + ", bias " + roundedText(check.bias, 3) + " against rays at " +
							  std::to_string(check.points) + " points of the surface\n" + "file: " + std::to_string(bytes.size()) +
							  " bytes\n";
	return {std::vector<std::string>(options.outputs.files.size(), bytes), lines, {}};
}

Made makeProbes(const BakeOptions& options, const Tracer& tracer, Summary& summary, const RunSettings& how)
{
	const ProbeGrid grid = bakeProbes(tracer, options.probes_m, options.settings, how);
	const BakeCheck check = checkProbes(tracer, grid, options.settings, kCheckPoints, how);
	finishUnits(how);
	Made made;
	for (const std::string& path : options.outputs.files)
	{
		made.bytes.push_back(formatOf(path, kProbeFormats) == ".glsl" ? probesGlsl(grid, "nook " NOOK_VERSION)
																	  : probesKtx2(grid, "nook " NOOK_VERSION));
	}
	const std::vector<double> count{static_cast<double>(grid.count.x), static_cast<double>(grid.count.y),
									static_cast<double>(grid.count.z)};
	summary.number("spacing_m", grid.spacing_m);
	summary.numbers("origin_m", {grid.origin.x, grid.origin.y, grid.origin.z});
	summary.numbers("count", count);
	summary.whole("probes", grid.texels.size());
	summary.whole("buried_probes", grid.buried);
	summary.whole("rays", grid.rays);
	summary.whole("bytes", 4 * grid.texels.size());
	summary.number("rms_standard_error", grid.standard_error);
	addCheck(summary, check);
	made.lines = "probes: " + std::to_string(grid.count.x) + " x " + std::to_string(grid.count.y) + " x " +
				 std::to_string(grid.count.z) + ", " + std::to_string(grid.buried) + " inside matter, " +
				 std::to_string(4 * grid.texels.size()) + " bytes\n" + "standard error: " + roundedText(grid.standard_error, 3) +
				 " of the mean over normals\n" + "error: RMSE " + roundedText(check.rmse, 3) + ", bias " +
				 roundedText(check.bias, 3) + " against rays at " + std::to_string(check.points) + " points in the open\n";
	return made;
}

// The level alone, or the level and volumes.
std::vector<std::string> inputsOf(const BakeOptions& options)
{
	std::vector<std::string> inputs{options.level.level};
	if (!options.beside.path.empty())
	{
		inputs.push_back(options.beside.path);
	}
	return inputs;
}

void run(BakeOptions& options, VerbProgress& progress)
{
	settleBake(options);
	const bool probes = options.probes_m > 0.0;
	checkOutputs(options.outputs, probes ? std::span<const std::string_view>(kProbeFormats) : kBakeFormats, inputsOf(options));
	const RunSettings how = progress.start("bake", options.threads, options.outputs.progress);
	LoadedLevel loaded = loadLevel(options.level.level, options.level.load, how);
	checkRead(options.outputs, loaded.level.files);
	std::vector<std::string> read = loaded.level.files;
	std::optional<Beside> beside;
	if (!options.beside.path.empty())
	{
		beside.emplace(options.beside, how);
		read.push_back(options.beside.path);
		options.settings.beside = [&beside](glm::dvec3 position, glm::dvec3 normal)
		{
			return beside->visibilityAt(position, normal);
		};
	}
	addInputs(read, how);
	const std::size_t turned = alignSheets(loaded.level, how.threads);
	const Tracer tracer(loaded.level, how);
	Summary summary("bake");
	addLevelFacts(summary, loaded);
	summary.whole("turned_triangles", turned);
	addBakeSettings(summary, options);
	const Made made = probes                   ? makeProbes(options, tracer, summary, how)
					  : options.texture_px > 0 ? makeTexture(options, tracer, summary, how)
											   : makeVertices(options, tracer, summary, how);
	OutputSet files;
	for (std::size_t i = 0; i < made.bytes.size(); ++i)
	{
		files.add(options.outputs.files[i], made.bytes[i]);
	}
	addSide(files, options.outputs, summary.json(), read);
	if (options.outputs.json.empty() && isStdoutFree(options.outputs))
	{
		files.add("-", made.lines);
	}
	files.commit();
	for (const std::string& warning : made.warnings)
	{
		std::fprintf(stderr, "nook: warning: %s\n", oneLine(warning).c_str());
	}
}

} // namespace

Verb addBakeVerb(CLI::App& nook)
{
	const auto options = std::make_shared<BakeOptions>();
	CLI::App* const app = nook.add_subcommand(
		"bake", "Visibility by rays, at a level's vertices, fitted to its surface, in a texture, or at probes of a grid");
	addBakeOptions(*app, *options);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
