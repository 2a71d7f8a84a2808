// SPDX-License-Identifier: GPL-3.0-or-later
// nook emit: methods and their patterns → one GLSL module, and the C++ header or JavaScript of its uniform block.
#include "scene_options.h"

#include "core/decimal.h"
#include "core/lists.h"
#include "core/system.h"
#include "core/text.h"
#include "emit/module.h"
#include "format/pattern_file.h"
#include "version.h"

#include <algorithm>
#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 8> kModuleFormats{".glsl", ".hlsl", ".wgsl", ".h", ".js", ".cs", ".py", ".json"};
constexpr std::array<std::string_view, 2> kModuleNormals{"texture", "from-depth"};
constexpr std::array<std::string_view, 2> kModuleBlocks{"mixed", "floats"};
constexpr std::array<std::string_view, 2> kModuleMains{"fragment", "compute"};
constexpr std::array<std::string_view, 3> kModuleTextures{"fixed", "macros", "separate"};
constexpr std::array<std::string_view, 2> kTilePlaces{"texture", "array"};

struct EmitOptions
{
	const CLI::App* app = nullptr;
	std::string methods;
	std::string patterns;
	std::string counts;
	ModuleSettings settings;
	std::optional<int> hlsl;
	bool wgsl = false;
	int directions = 128;
	std::string recipe = "rays"; // paper, rays or a file
	Outputs outputs;

	bool given(const char* name) const
	{
		return isGiven(*app, name);
	}
};

bool isHlsl(const EmitOptions& options)
{
	return options.settings.target == GlslTarget::hlsl60;
}
std::string languageOption(const EmitOptions& options)
{
	return isHlsl(options) ? "--hlsl" : options.wgsl ? "--wgsl" : "--glsl";
}
std::string languageText(const EmitOptions& options)
{
	return " " + languageOption(options) + (options.wgsl ? "" : " " + std::string(nameOf(options.settings.target)));
}
bool hasLanguage(const EmitOptions& options)
{
	return options.given("--glsl") || options.given("--hlsl") || options.wgsl;
}

// Standard output gets the module.
bool isShader(const std::string& path)
{
	const std::string_view format = formatOf(path, kModuleFormats);
	return format == ".glsl" || format == ".hlsl" || format == ".wgsl" || path == "-";
}

bool isScript(const std::string& path)
{
	return formatOf(path, kModuleFormats) == ".js";
}

// Does the file define names in a program?
bool hasNamespace(const std::string& path)
{
	return formatOf(path, kModuleFormats) == ".h" || formatOf(path, kModuleFormats) == ".cs";
}

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
	const OptionRules screen = excludes("--methods " + volumeMethods("|"), "a screen-space method");
	addOptions(
		app,
		{{"--methods", takesText(options.methods, "LIST"),
		  "What to emit, with commas between: " + methodNames(isModule) + "; or alone: " + methodNames(isVolumes, " or ") +
			  ", which draw the files of nook volumes",
		  kRequired},
		 {"--patterns", takesText(options.patterns, "FILES"),
		  "Samples of each method but " + methodNames([](const MethodRow& row) { return isModule(row) && !row.domain; }, " and ") +
			  ", in the same order, with commas between: patterns or tiles of nook. " + domainsText(),
		  screen},
		 {"--counts", takesText(options.counts, "LIST"),
		  "Only the first N samples of each pattern, one made with --order progressive, or of each variant of a tile made with "
		  "--progressive (default: all); their weights are computed again",
		  screen},
		 {"--glsl", takesChoice(glslTargets(), settings.target),
		  "Language of the .glsl file: OpenGL 3.3, OpenGL 4.3 (explicit bindings), OpenGL ES 3.0, or Vulkan (GLSL 4.50)"},
		 {"--hlsl", takesChoice(hlslTargets(), options.hlsl),
		  "Language of the .hlsl file instead: HLSL, shader model 6.0 (Direct3D 12, Unity, Unreal)"},
		 {"--wgsl", takesFlag(options.wgsl), "WGSL instead, in a .wgsl file (WebGPU, Bevy, Babylon.js)"},
		 {"--textures", takesChoice(kModuleTextures, settings.textures),
		  "How a .glsl file reads textures: tiles and packed pictures directly (fixed, default); all of them through macros that "
		  "you may define first; or that, with textures apart from their sampler (separate, Vulkan)",
		  screen},
		 {"--tile", takesChoice(kTilePlaces, settings.tile),
		  "Where the samples of a tile are: in a texture (default; the header holds its texels), or in the module itself", screen},
		 {"--depth", takesChoice(kModuleDepths, settings.device_depth),
		  "What the module reads: depth along the view direction (default), or what a depth buffer holds, 0 to 1, of any "
		  "projection; "
		  "then nook_..._settings() of the header sets device_depth, and zero_to_one for Vulkan"},
		 {"--normals", takesChoice(kModuleNormals, settings.normals_from_depth),
		  "Where normals are: in a texture (default), or made of the depths of nine pixels each time that one is asked for",
		  screen},
		 {"--block", takesChoice(kModuleBlocks, settings.float_block),
		  "The uniform block: with integers among its floats (default), or of floats alone, for engines that fill no others",
		  screen},
		 {"--namespace", takesText(settings.header_namespace, "NAME"),
		  "Of the header's tiles and settings: for programs with several modules of a method (default: none)", screen},
		 directionsRow(options.directions, needs("--methods " + maskMethod(), maskMethod(), "with another method")),
		 recipeRow(options.recipe, screen)});
	addOptions(app, featureOptions(
						kInEmit, [](const FeatureRow&) { return true; }, settings.shade, screen));
	addOptions(app,
			   {{"--gather", takesFlag(settings.gather),
				 "nookGather as well: what a renderer reads that shades one of several samples of a pixel (MSAA), from five "
				 "pixels, without halos",
				 screen},
				{"--main", takesChoice(kModuleMains, settings.main),
				 "A complete shader with the entry point main, instead of a file to include; NOOK_PASS selects the pass of the "
				 "method or of its filter",
				 screen}});
	addOutputs(app, options.outputs, kModuleFormats);
	options.app = &app;
}

std::vector<ShadeMethod> methodsOf(const std::string& list)
{
	std::vector<ShadeMethod> methods;
	for (const std::string& name : partsOf(list))
	{
		const MethodRow* const row = methodNamed(name);
		refuseValueIf(row == nullptr || !isModule(*row), "--methods", name,
					  "some of " + methodNames(isModule) + ", or " + methodNames(isVolumes, " or ") + " alone");
		const ShadeMethod method = row->method;
		refuseValueIf(std::find(methods.begin(), methods.end(), method) != methods.end(), "--methods", name, "every method once");
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
		const std::optional<std::size_t> count = numberFrom<std::size_t>(text);
		refuseValueIf(!count || *count < 1 || *count > kMaxCount, "--counts", text, "whole numbers from 1 to 4096, one a method");
		counts.push_back(*count);
	}
	refuseValueIf(!counts.empty() && counts.size() != methods, "--counts", options.counts,
				  "as many numbers as methods, " + std::to_string(methods));
	return counts;
}

// Numbers are in the header as well; what else is said of features shapes the GLSL alone.
bool isOfHeader(const FeatureRow* feature)
{
	return feature->kind == FeatureKind::number;
}

std::vector<std::string> inputsOf(const EmitOptions& options, std::vector<std::string> patterns)
{
	if (isRecipeFile(options.recipe))
	{
		patterns.push_back(options.recipe);
	}
	return patterns;
}

// One language per run, since the header's presets depend on it, and only what it can do.
void checkLanguage(const EmitOptions& options)
{
	const ModuleSettings& settings = options.settings;
	const std::string name = languageOption(options);
	if (isHlsl(options) || options.wgsl)
	{
		refuseGiven(*options.app, {"--glsl"}, "with " + name + ", expected one language per run");
		refuseGiven(*options.app, {"--textures"}, "with " + name + ", whose textures always are separate");
	}
	refuseIf(options.hlsl && options.wgsl, "--wgsl: found with --hlsl, expected one language per run");
	for (const std::string& path : options.outputs.files)
	{
		const std::string_view format = formatOf(path, kModuleFormats);
		if (isShader(path) && !hasLanguage(options))
		{
			const std::string missing(path == "-" ? "glsl" : format.substr(1));
			refuse("--" + missing + ": missing, expected one for the ." + missing + " file");
		}
		refuseIf(isShader(path) && path != "-" && format.substr(1) != name.substr(2),
				 path + ": found with " + name + ", expected -o FILE." + name.substr(2));
	}
	const std::string found = ": found --glsl " + std::string(nameOf(settings.target));
	refuseIf(settings.main == ModuleMain::compute && !hasCompute(settings.target),
			 "--main compute" + found + ", which has no compute shaders, expected --glsl 430, vulkan or --hlsl");
	refuseIf(settings.textures == ModuleTextures::separate && settings.target != GlslTarget::vulkan,
			 "--textures separate" + found + ", expected --glsl vulkan");
}

// Every option that would change nothing is a mistake.
void check(const EmitOptions& options, const std::vector<ShadeMethod>& methods, const std::vector<std::string>& patterns)
{
	refuseValueIf(std::count(patterns.begin(), patterns.end(), "") > 0, "--patterns", options.patterns,
				  "names of files with commas between them");
	checkOutputs(options.outputs, kModuleFormats, inputsOf(options, patterns));
	const auto needed = static_cast<std::size_t>(std::count_if(methods.begin(), methods.end(), takesPattern));
	const auto most = needed + static_cast<std::size_t>(std::count_if(methods.begin(), methods.end(), mayTakeTile));
	refuseValueIf(patterns.size() != needed && patterns.size() != most, "--patterns", options.patterns,
				  "as many files as methods that take one, " + std::to_string(needed) +
					  (most > needed ? "; " + std::to_string(most) + " with those that may" : ""));
	const std::vector<std::string>& files = options.outputs.files;
	const std::string& space = options.settings.header_namespace;
	refuseValueIf(options.given("--namespace") && !isIdentifier(space), "--namespace", space,
				  "letters, digits and single underscores, a letter first");
	refuseIf(options.given("--namespace") && std::none_of(files.begin(), files.end(), hasNamespace),
			 "--namespace: found without a .h or .cs file, expected -o FILE.h as well");
	const bool module = std::any_of(files.begin(), files.end(), isShader);
	const bool glsl = module || ((options.given("--glsl") || options.wgsl) && std::any_of(files.begin(), files.end(), isScript));
	checkLanguage(options);
	const GivenFeatures given = givenFeatures(*options.app, kInEmit);
	if (!glsl && !files.empty())
	{
		const std::string language = languageOption(options).substr(2);
		const std::string without = "without a ." + language + " file, expected -o FILE." + language + " as well";
		refuseGiven(*options.app, {"--glsl", "--hlsl", "--wgsl", "--textures", "--depth", "--normals", "--gather", "--main"},
					without);
		for (const FeatureRow* const row : given)
		{
			refuseIf(!isOfHeader(row), std::string(row->option) + ": found " + without);
		}
	}
	checkEmitFeatures(given, options.settings.shade, methods);
	if (patterns.size() > needed)
	{
		refuseSlicesWithTile(given);
	}
	refuseIf(options.settings.gather && options.given("--main"),
			 "--main: found with --gather, which is a function for your shaders, expected one of the two");
	refuseIf(methods.size() > 1 && options.given("--main"),
			 "--main: found with " + std::to_string(methods.size()) + " methods, expected one method");
}

std::string featuresOf(const EmitOptions& options, bool of_header)
{
	GivenFeatures some = givenFeatures(*options.app, kInEmit);
	std::erase_if(some, [of_header](const FeatureRow* row) { return isOfHeader(row) != of_header; });
	return featuresText(*options.app, some);
}

// The command that makes the files again, less their folders.
std::string emitCommand(const EmitOptions& options, const std::vector<std::string>& patterns, bool glsl)
{
	const std::string names =
		joinedText(patterns, ",", [](const std::string& path) { return nativePath(path).filename().string(); });
	const ModuleSettings& settings = options.settings;
	std::string command = "nook emit --methods " + options.methods + (names.empty() ? "" : " --patterns " + names);
	command += options.counts.empty() ? "" : " --counts " + options.counts;
	command += settings.tile == TilePlace::array ? " --tile array" : "";
	command += settings.float_block ? " --block floats" : "";
	command += settings.header_namespace.empty() ? "" : " --namespace " + settings.header_namespace;
	command += options.given("--recipe")
				   ? " --recipe " + (isRecipeFile(options.recipe) ? nativePath(options.recipe).filename().string() : options.recipe)
				   : "";
	command += featuresOf(options, true);
	command += settings.device_depth ? " --depth device" : ""; // which settings of headers are preset to
	if (glsl)
	{
		command += settings.normals_from_depth ? " --normals from-depth" : "";
		command += featuresOf(options, false);
		command += settings.gather ? " --gather" : "";
		command += settings.main ? " --main " + std::string(kModuleMains[static_cast<std::size_t>(*settings.main)]) : "";
		command += options.given("--textures")
					   ? " --textures " + std::string(kModuleTextures[static_cast<std::size_t>(settings.textures)])
					   : "";
	}
	if (glsl || settings.device_depth)
	{
		command += languageText(options);
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
		method.shade = withRecipe(*method.shade, method.recipe, 1.0, givenFeatures(*options.app, kInEmit));
		takeFrom(*method.recipe, *method.shade);
	}
	std::string base;
	if (pattern != nullptr)
	{
		base = readSamples(*pattern, count, settings.shade, method);
		if (settings.shade.volume.paired && takesFeature(rowOf(one), featureOf("--paired")))
		{
			method.variants = mapped(method.variants, pairedPattern); // opposite samples beside one another
		}
	}
	settings.methods.push_back(std::move(method));
	return base;
}

// The module that draws the files of nook volumes.
void emitVolumes(const EmitOptions& options, bool mask)
{
	checkOutputs(options.outputs, kModuleFormats, {});
	checkLanguage(options);
	const GlslTarget target = options.settings.target;
	refuseIf(!drawsVolumes(target, mask),
			 options.methods + ": found" + languageText(options) +
				 ", which has no logic operations on render targets, expected --glsl 330, 430, vulkan or --hlsl");
	for (const std::string& path : options.outputs.files)
	{
		refuseIf(!isShader(path), path + ": found no shader, expected one alone: nook_volumes_draw.h fills the block");
	}
	std::string command = "nook emit --methods " + options.methods;
	command += options.settings.device_depth ? " --depth device" : "";
	command += options.given("--directions") ? " --directions " + std::to_string(options.directions) : "";
	command += languageText(options);
	Facts facts = verbFacts("emit");
	facts.text("command", command);
	facts.text("method", options.methods);
	const AovTextSettings text{target, mask ? options.directions : 0, options.settings.device_depth};
	writeOutputs(options.outputs,
				 [&](const std::string&) {
					 return volumesGlsl(text, {command, NOOK_VERSION, {}, {}});
				 },
				 facts.json(), {});
}

void run(EmitOptions& options, VerbProgress&)
{
	options.settings.target = options.wgsl ? GlslTarget::wgsl : options.hlsl ? GlslTarget::hlsl60 : options.settings.target;
	if (const MethodRow* const row = methodNamed(options.methods); row != nullptr && row->kind == MethodKind::volumes)
	{
		emitVolumes(options, row->masks);
		return;
	}
	const std::vector<ShadeMethod> methods = methodsOf(options.methods);
	const std::vector<std::string> patterns = partsOf(options.patterns);
	const std::vector<std::size_t> counts = countsOf(options, patterns.size());
	check(options, methods, patterns);
	ModuleSettings& settings = options.settings;
	std::string bases;
	bool tiles = false;
	std::vector<Facts> items;
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
		Facts& item = items.emplace_back();
		item.text("method", nameOf(method.method));
		item.whole("samples", method.variants.empty() ? 0 : method.variants.front().count());
		item.whole("variants", method.variants.size());
	}
	checkWindows(settings);
	refuseIf(!tiles && options.given("--tile"), "--tile: found with patterns alone, expected a tile among --patterns");
	refuseIf(settings.normals_from_depth && !readsNormals(settings),
			 "--normals from-depth: found a module that asks for no normal, expected one that does");
	const auto contextOf = [&](bool glsl)
	{
		return EmitContext{emitCommand(options, patterns, glsl), NOOK_VERSION, {}, bases};
	};
	const std::string shader = hasLanguage(options) ? moduleGlsl(settings, contextOf(true)) : "";
	const std::string embedded = isHlsl(options) ? "" : shader; // in JavaScript
	const auto bytesOf = [&](const std::string& path)
	{
		const std::string_view format = formatOf(path, kModuleFormats);
		return isShader(path)      ? shader
			   : isScript(path)    ? moduleScript(settings, contextOf(!embedded.empty()), embedded)
			   : format == ".cs"   ? moduleSharp(settings, contextOf(false))
			   : format == ".py"   ? modulePython(settings, contextOf(false))
			   : format == ".json" ? moduleJson(settings, contextOf(false))
								   : moduleHeader(settings, contextOf(false));
	};
	Facts facts = verbFacts("emit");
	facts.text("command", emitCommand(options, patterns, hasLanguage(options)));
	facts.items("methods", std::move(items));
	writeOutputs(options.outputs, bytesOf, facts.json(), inputsOf(options, patterns));
}

} // namespace

Verb addEmitVerb(CLI::App& nook)
{
	return addVerb<EmitOptions>(nook, "emit",
								"Writes methods and their patterns as a GLSL or HLSL module, and its uniform block for C++, "
								"JavaScript, C#, Python or as JSON",
								declare, run);
}

} // namespace nook
