// SPDX-License-Identifier: GPL-3.0-or-later
// nook emit: methods and their patterns → one GLSL module, and the C++ header or JavaScript of its uniform block.
#include "emit_options.h"
#include "emit_samples.h"
#include "emit_volumes.h"
#include "summary.h"
#include "volume_methods.h"

#include "core/error.h"
#include "core/file.h"
#include "core/system.h"
#include "core/text.h"
#include "emit/module.h"
#include "format/pattern_file.h"
#include "version.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 2> kTilePlaces{"texture", "array"};

bool isModule(const MethodRow& row)
{
	return row.emitted && row.kind == MethodKind::screen;
}

bool isVolumes(const MethodRow& row)
{
	return row.emitted && row.kind == MethodKind::volumes;
}

// "vo-line and vo-area take the disk, vo-point the ball, …".
std::string domainsText()
{
	std::string text;
	for (const Domain domain : {Domain::disk, Domain::ball, Domain::sphere, Domain::hemisphere})
	{
		const std::string names =
			methodNames([domain](const MethodRow& row) { return isModule(row) && row.domain == domain; }, " and ");
		if (!names.empty())
		{
			text += (text.empty() ? names + " take" : ", " + names) + " the " + std::string(nameOf(domain));
		}
	}
	return text;
}

void declare(CLI::App& app, EmitOptions& options)
{
	ModuleSettings& settings = options.settings;
	addText(app, "--methods", options.methods, "LIST",
			"What to emit, with commas between: " + methodNames(isModule) + "; or alone: " + methodNames(isVolumes, " or ") +
				", which draw the files of nook volumes")
		->required();
	addText(app, "--patterns", options.patterns, "FILES",
			"Samples of each method but " +
				methodNames([](const MethodRow& row) { return isModule(row) && !row.domain; }, " and ") +
				", in the same order, with commas between: patterns or tiles of nook. " + domainsText());
	addText(app, "--counts", options.counts, "LIST",
			"Only the first N samples of each pattern, one made with --order progressive, or of each variant of a tile made with "
			"--progressive (default: all); their weights are computed again");
	options.glsl = addChoiceText(
		app, "--glsl", glslTargets(), [&settings](std::size_t i) { settings.target = static_cast<GlslTarget>(i); },
		"Language of the .glsl file: OpenGL 3.3, OpenGL 4.3 (explicit bindings), OpenGL ES 3.0, or Vulkan (GLSL 4.50)");
	options.tile = addChoiceText(
		app, "--tile", kTilePlaces, [&settings](std::size_t i) { settings.tile = static_cast<TilePlace>(i); },
		"Where the samples of a tile are: in a texture (default; the header holds its texels), or in the module itself");
	options.depth = addChoiceText(
		app, "--depth", kModuleDepths, [&settings](std::size_t i) { settings.device_depth = i == 1; },
		"What the module reads: depth along the view direction (default), or what a depth buffer holds, 0 to 1, of any projection; "
		"then nook_..._settings() of the header sets device_depth, and zero_to_one for Vulkan");
	options.normals = addChoiceText(
		app, "--normals", kModuleNormals, [&settings](std::size_t i) { settings.normals_from_depth = i == 1; },
		"Where normals are: in a texture (default), or made of the depths of nine pixels each time that one is asked for");
	options.block = addChoiceText(
		app, "--block", kModuleBlocks, [&settings](std::size_t i) { settings.float_block = i == 1; },
		"The uniform block: with integers among its floats (default), or of floats alone, for engines that fill no others");
	options.space = addText(app, "--namespace", settings.header_namespace, "NAME",
							"Of the header's tiles and settings: for programs with several modules of a method (default: none)");
	options.directions_option = addDirections(app, options.directions);
	options.recipe_option = addRecipe(app, options.recipe);
	options.features = addFeatures(
		app, kInEmit, [](const FeatureRow&) { return true; }, settings.shade);
	options.gather =
		app.add_flag("--gather", settings.gather,
					 "nookGather as well: what a renderer reads that shades one of several samples of a pixel (MSAA), from "
					 "five pixels, without halos");
	options.main = app.add_flag("--main", settings.main, "A whole fragment shader of the one method, instead of a file to include");
	addOutputs(app, options.outputs, kModuleFormats);
}

std::vector<ShadeMethod> methodsOf(const std::string& list)
{
	std::vector<ShadeMethod> methods;
	for (const std::string& name : partsOf(list))
	{
		const MethodRow* const row = methodNamed(name);
		if (row == nullptr || !isModule(*row))
		{
			refuseValue("--methods", name,
						"some of " + methodNames(isModule) + ", or " + methodNames(isVolumes, " or ") + " alone");
		}
		const ShadeMethod method = row->method;
		if (std::find(methods.begin(), methods.end(), method) != methods.end())
		{
			refuseValue("--methods", name, "every method once");
		}
		methods.push_back(method);
	}
	return methods;
}

// One a method, or none at all.
std::vector<std::size_t> countsOf(const EmitOptions& options, std::size_t methods)
{
	std::vector<std::size_t> counts;
	for (const std::string& text : partsOf(options.counts))
	{
		std::size_t count = 0;
		const std::from_chars_result read = std::from_chars(text.data(), text.data() + text.size(), count);
		if (read.ec != std::errc{} || read.ptr != text.data() + text.size() || count < 1 || count > kMaxCount)
		{
			refuseValue("--counts", text, "whole numbers from 1 to 4096, one a method");
		}
		counts.push_back(count);
	}
	if (!counts.empty() && counts.size() != methods)
	{
		refuseValue("--counts", options.counts, "as many numbers as methods, " + std::to_string(methods));
	}
	return counts;
}

// Numbers are in the header as well; what else is said of features shapes the GLSL alone.
bool isOfHeader(const FeatureOption& feature)
{
	return feature.row->kind == FeatureKind::number;
}

std::vector<std::string> inputsOf(const EmitOptions& options, std::vector<std::string> patterns)
{
	if (isRecipeFile(options.recipe))
	{
		patterns.push_back(options.recipe.name);
	}
	return patterns;
}

// Every option that would change nothing is a mistake.
void check(const EmitOptions& options, const std::vector<ShadeMethod>& methods, const std::vector<std::string>& patterns)
{
	if (std::count(patterns.begin(), patterns.end(), "") > 0)
	{
		refuseValue("--patterns", options.patterns, "names of files with commas between them");
	}
	checkOutputs(options.outputs, kModuleFormats, inputsOf(options, patterns));
	const auto needed = static_cast<std::size_t>(std::count_if(methods.begin(), methods.end(), takesPattern));
	const auto most = needed + static_cast<std::size_t>(std::count_if(methods.begin(), methods.end(), mayTakeTile));
	if (patterns.size() != needed && patterns.size() != most)
	{
		refuseValue("--patterns", options.patterns,
					"as many files as methods that take one, " + std::to_string(needed) +
						(most > needed ? "; " + std::to_string(most) + " with those that may" : ""));
	}
	const auto refuse = [](const CLI::Option& option, const std::string& found, const std::string& expected)
	{
		if (option.count() > 0)
		{
			throw Error(ExitCode::usage, option.get_name() + ": found " + found + ", expected " + expected);
		}
	};
	const std::vector<std::string>& files = options.outputs.files;
	if (const std::string& space = options.settings.header_namespace; options.space->count() > 0 && !isIdentifier(space))
	{
		refuseValue("--namespace", space, "letters, digits and single underscores, a letter first");
	}
	if (std::none_of(files.begin(), files.end(), isHeader))
	{
		refuse(*options.space, "without a .h file", "-o FILE.h as well");
	}
	const bool module = std::any_of(files.begin(), files.end(), isGlsl);
	const bool glsl = module || (options.glsl->count() > 0 && std::any_of(files.begin(), files.end(), isScript));
	if (module && options.glsl->count() == 0)
	{
		throw Error(ExitCode::usage, "--glsl: missing, expected one for the .glsl file");
	}
	if (!glsl && !files.empty())
	{
		for (const CLI::Option* const option : {options.glsl, options.depth, options.normals, options.gather, options.main})
		{
			refuse(*option, "without a .glsl file", "-o FILE.glsl as well");
		}
		for (const FeatureOption& feature : options.features)
		{
			if (!isOfHeader(feature))
			{
				refuse(*feature.option, "without a .glsl file", "-o FILE.glsl as well");
			}
		}
	}
	checkEmitFeatures(options.features, options.settings.shade, methods);
	if (patterns.size() > needed)
	{
		refuseSlicesBesideTile(options.features);
	}
	const bool passes = options.settings.shade.filter != ShadeFilter::none || options.settings.shade.half_resolution ||
						hasPasses(rowOf(methods.front()), options.settings.shade);
	if (passes || options.settings.gather)
	{
		refuse(*options.main, "with a method or a filter that needs several passes", "one of one pass");
	}
	if (methods.size() > 1)
	{
		refuse(*options.main, "with " + std::to_string(methods.size()) + " methods", "one method");
	}
}

std::string featuresOf(const EmitOptions& options, bool of_header)
{
	std::vector<FeatureOption> some;
	std::copy_if(options.features.begin(), options.features.end(), std::back_inserter(some),
				 [of_header](const FeatureOption& one) { return isOfHeader(one) == of_header; });
	return featuresText(some);
}

// The command that makes the files again, less their folders.
std::string commandOf(const EmitOptions& options, const std::vector<std::string>& patterns, bool glsl)
{
	std::string names;
	for (const std::string& path : patterns)
	{
		names += (names.empty() ? "" : ",") + nativePath(path).filename().string();
	}
	const ModuleSettings& settings = options.settings;
	std::string command = "nook emit --methods " + options.methods + (names.empty() ? "" : " --patterns " + names);
	command += options.counts.empty() ? "" : " --counts " + options.counts;
	command += settings.tile == TilePlace::array ? " --tile array" : "";
	command += settings.float_block ? " --block floats" : "";
	command += settings.header_namespace.empty() ? "" : " --namespace " + settings.header_namespace;
	command += options.recipe_option->count() > 0
				   ? " --recipe " +
						 (isRecipeFile(options.recipe) ? nativePath(options.recipe.name).filename().string() : options.recipe.name)
				   : "";
	command += featuresOf(options, true);
	command += settings.device_depth ? " --depth device" : ""; // which settings of headers are preset to
	if (glsl)
	{
		command += settings.normals_from_depth ? " --normals from-depth" : "";
		command += featuresOf(options, false);
		command += settings.gather ? " --gather" : "";
		command += settings.main ? " --main" : "";
	}
	if (glsl || settings.device_depth)
	{
		command += " --glsl " + std::string(glslTargets()[static_cast<std::size_t>(settings.target)]);
	}
	return command;
}

// Adds a method to the module, with the samples of a file where it is given one; returns the command that made these.
std::string addMethod(EmitOptions& options, ShadeMethod one, const std::string* pattern, std::optional<std::size_t> count)
{
	ModuleSettings& settings = options.settings;
	ModuleMethod method{one, {}};
	method.recipe = chosenRecipe(options.recipe, one);
	if (method.recipe)
	{
		method.shade = settings.shade;
		method.shade->method = one;
		method.shade = withRecipe(*method.shade, method.recipe, 1.0, options.features);
		takeFrom(*method.recipe, *method.shade);
	}
	std::string base;
	if (pattern != nullptr)
	{
		base = readSamples(*pattern, count, settings.shade, method);
		if (settings.shade.volume.paired && takesFeature(rowOf(one), featureOf("--paired")))
		{
			for (Pattern& variant : method.variants) // opposite samples beside one another
			{
				variant = pairedPattern(variant);
			}
		}
	}
	settings.methods.push_back(std::move(method));
	return base;
}

void run(EmitOptions& options)
{
	const std::vector<ShadeMethod> methods = methodsOf(options.methods);
	const std::vector<std::string> patterns = partsOf(options.patterns);
	const std::vector<std::size_t> counts = countsOf(options, patterns.size());
	check(options, methods, patterns);
	ModuleSettings& settings = options.settings;
	std::string bases;
	bool tiles = false;
	std::vector<Summary> items;
	std::size_t next = 0;
	const auto needed = static_cast<std::size_t>(std::count_if(methods.begin(), methods.end(), takesPattern));
	for (const ShadeMethod one : methods)
	{
		const bool takes = takesPattern(one) || (mayTakeTile(one) && patterns.size() > needed);
		const std::string base = addMethod(options, one, takes ? &patterns[next] : nullptr,
										   !takes || counts.empty() ? std::nullopt : std::optional(counts[next]));
		next += takes ? 1 : 0;
		const ModuleMethod& method = settings.methods.back();
		bases += base.empty() ? "" : (bases.empty() ? "" : "; ") + base;
		tiles = tiles || method.variants.size() > 1;
		Summary item;
		item.text("method", nameOf(method.method));
		item.whole("samples", method.variants.empty() ? 0 : method.variants.front().count());
		item.whole("variants", method.variants.size());
		items.push_back(item);
	}
	checkWindows(settings);
	if (!tiles && options.tile->count() > 0)
	{
		throw Error(ExitCode::usage, "--tile: found with patterns alone, expected a tile among --patterns");
	}
	if (settings.normals_from_depth && !readsNormals(settings))
	{
		throw Error(ExitCode::usage, "--normals from-depth: found a module that asks for no normal, expected one that does");
	}
	const auto contextOf = [&](bool glsl)
	{
		return EmitContext{commandOf(options, patterns, glsl), NOOK_VERSION, {}, bases};
	};
	const std::string glsl = options.glsl->count() > 0 ? moduleGlsl(settings, contextOf(true)) : "";
	OutputSet files;
	for (const std::string& path : options.outputs.files)
	{
		files.add(path, isGlsl(path)     ? glsl
						: isScript(path) ? moduleScript(settings, contextOf(!glsl.empty()), glsl)
										 : moduleHeader(settings, contextOf(false)));
	}
	Summary summary("emit");
	summary.text("command", commandOf(options, patterns, options.glsl->count() > 0));
	summary.items("methods", items);
	addSide(files, options.outputs, summary.json(), inputsOf(options, patterns));
	files.commit();
}

} // namespace

Verb addEmitVerb(CLI::App& nook)
{
	const auto options = std::make_shared<EmitOptions>();
	CLI::App* const app =
		nook.add_subcommand("emit", "Writes methods and their patterns as a GLSL module, a C++ header and a JavaScript module");
	declare(*app, *options);
	return {app, [options, app](VerbProgress&)
			{
				if (isOfVolumes(*options))
				{
					emitVolumes(*options, *app);
					return;
				}
				checkDirections(*options->directions_option, options->directions, false);
				run(*options);
			}};
}

} // namespace nook
