// SPDX-License-Identifier: GPL-3.0-or-later
// Options as every verb declares them: one row gives the parser, the check, what goes with what, and the line of help.
#pragma once

#include "core/facts.h"
#include "core/file.h"
#include "core/work_units.h"
#include "pattern/recipe.h"
#include "pattern/tile_filter.h"
#include "verb_progress.h"

#include <CLI/CLI.hpp>

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// A verb of the command line, and what it does once its options have been parsed.
struct Verb
{
	CLI::App* app = nullptr;
	std::function<void(VerbProgress& progress)> run;
};

// Adds a verb: `declare` states its options, `run` gets them once they are parsed.
template <class Options>
Verb addVerb(CLI::App& nook, const std::string& name, const std::string& help, void (*declare)(CLI::App& app, Options& options),
			 void (*run)(Options& options, VerbProgress& progress))
{
	const auto options = std::make_shared<Options>();
	CLI::App* const app = nook.add_subcommand(name, help);
	declare(*app, *options);
	return {app, [options, run](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

Verb addPatternVerb(CLI::App& nook);
Verb addTileVerb(CLI::App& nook);
Verb addTuneVerb(CLI::App& nook);
Verb addFitVerb(CLI::App& nook);
Verb addVolumesVerb(CLI::App& nook);
Verb addBakeVerb(CLI::App& nook);
Verb addCatalogueVerb(CLI::App& nook);
Verb addCompareVerb(CLI::App& nook);
Verb addEmitVerb(CLI::App& nook);
Verb addGBufferVerb(CLI::App& nook);
Verb addInfoVerb(CLI::App& nook);
Verb addLevelVerb(CLI::App& nook);
Verb addPlanVerb(CLI::App& nook);
Verb addReferenceVerb(CLI::App& nook);
Verb addReportVerb(CLI::App& nook);
Verb addShadeVerb(CLI::App& nook);

// `nook report error` and `times`, and both or ones that end with 5 where the component reports is not in this build.
Verb addReportError(CLI::App& report);
Verb addReportTimes(CLI::App& report);
std::vector<Verb> addMeasuredReports(CLI::App& report);

// In the order of the help.
std::vector<Verb> addVerbs(CLI::App& nook);

// The facts of --json, beginning with schema, verb and version.
Facts verbFacts(std::string_view verb);

// The parts of a list; none of an empty list.
std::vector<std::string> partsOf(const std::string& list, char between = ',');

// Throws Error (usage).
[[noreturn]] void refuse(const std::string& message);

// "found X, expected Y" for an option. Throws Error (usage).
[[noreturn]] void refuseValue(const std::string& option, const std::string& found, const std::string& expected);
void refuseValueIf(bool condition, const std::string& option, const std::string& found, const std::string& expected);

// For something that needs a component that is not in this build. Throws Error (unsupported).
[[noreturn]] void refuseWithout(const std::string& component, const std::string& what);

// Adds an option of that name and help, whose value it parses, checks and stores.
using OptionValue = std::function<CLI::Option*(CLI::App& app, const std::string& names, const std::string& help)>;

// A condition names one option or several, "--cell or --cells", each with values if only these count: "--falloff alchemy|linear".
// It is broken with "--x: found FOUND, expected EXPECTED", of which rules state what is not standard.
struct OptionRule
{
	std::string condition;
	std::string expected{}; // of needs: "both"; of excludes: "one of them"
	std::string found{};    // of needs: "without --falloff alchemy|linear"; of excludes: "with --falloff linear"
};

struct OptionRules
{
	bool required = false;
	std::vector<OptionRule> excludes{}; // the option is given only where none of these holds
	std::vector<OptionRule> needs{};    // and all of these do
};

inline const OptionRules kRequired{.required = true};
OptionRules needs(const std::string& condition, const std::string& expected = {}, const std::string& found = {});
OptionRules excludes(const std::string& condition, const std::string& expected = {}, const std::string& found = {});

struct OptionRow
{
	std::string names; // "-o,--output", "--radius", "LEVEL"
	OptionValue value;
	std::string help;
	OptionRules rules{};
};

// Checks rules as the options are parsed. Throws Error (usage) from there.
void addOptions(CLI::App& app, const std::vector<OptionRow>& rows);

bool isGiven(const CLI::App& app, const std::string& name);

// Throws Error (usage) with "found MESSAGE" for the first of these options that is given.
template <class Names = std::initializer_list<std::string_view>>
void refuseGiven(const CLI::App& app, const Names& names, const std::string& message)
{
	for (const std::string_view name : names)
	{
		if (isGiven(app, std::string(name)))
		{
			refuse(std::string(name) + ": found " + message);
		}
	}
}

// Values of rows. What they store into must outlive parsing. A variable may be optional: set where the option is given.
OptionValue takesFlag(bool& value, bool given = true);
OptionValue takesFlag(const std::function<void()>& take);
OptionValue takesText(std::string& value, const std::string& kind);
OptionValue takesBytes(uint64_t& value); // "512MiB", "2GiB" or a number, above 0
OptionValue takesMatrix(std::optional<glm::dmat4>& value);
// Any other text: `take` gets the option's name and the text, and throws Error (usage).
using TakeText = std::function<void(const std::string& name, const std::string& text)>;
OptionValue takesParsed(const std::string& kind, const TakeText& take);
OptionValue takesEach(const std::string& kind, const TakeText& take); // may be repeated

OptionValue takesIndex(std::span<const std::string_view> names, const std::function<void(std::size_t)>& choose);

// Plain decimal numbers within a range; anything else is refused.
OptionValue takesWholeBy(const std::function<void(uint64_t)>& take, uint64_t least, uint64_t most, const std::string& kind = "N");
OptionValue takesNumberBy(const std::function<void(double)>& take, double least, double most, const std::string& kind = "X");

// The type of a variable's value, which may be optional.
template <class Variable> struct ValueOf
{
	using Type = Variable;
};
template <class Value> struct ValueOf<std::optional<Value>>
{
	using Type = Value;
};

template <class Whole> OptionValue takesWhole(Whole& value, uint64_t least, uint64_t most, const std::string& kind = "N")
{
	return takesWholeBy([&value](uint64_t number) { value = static_cast<typename ValueOf<Whole>::Type>(number); }, least, most,
						kind);
}

template <class Number> OptionValue takesNumber(Number& value, double least, double most, const std::string& kind = "X")
{
	return takesNumberBy([&value](double number) { value = number; }, least, most, kind);
}

// The value whose place among `names` is that of the word: an enumerator, an index, or whether it is the second of two.
template <class Value> OptionValue takesChoice(std::span<const std::string_view> names, Value& value)
{
	return takesIndex(names, [&value](std::size_t i) { value = static_cast<typename ValueOf<Value>::Type>(i); });
}

// A value that `parse` makes of the option's name and the text.
template <class Variable, class Value>
OptionValue takesParsed(const std::string& kind, Variable& value, Value (*parse)(const std::string& name, const std::string& text))
{
	return takesParsed(kind, [&value, parse](const std::string& name, const std::string& text) { value = parse(name, text); });
}
template <class Value>
OptionValue takesEach(const std::string& kind, std::vector<Value>& values,
					  Value (*parse)(const std::string& name, const std::string& text))
{
	return takesEach(kind,
					 [&values, parse](const std::string& name, const std::string& text) { values.push_back(parse(name, text)); });
}

// "1-64" or "7".
struct CountRange
{
	int first = 1;
	int last = 64;
};
OptionValue takesCounts(CountRange& value, int most);

OptionRow seedRow(uint32_t& value);
OptionRow glDeviceRow(std::optional<int>& device, OptionRules rules = {});

// --filter and --ema, of nook tile and nook info: what an engine does with a tile's variants behind the pass that reads them.
OptionRow filterRow(std::vector<std::string>& names, const std::string& help);
OptionRow emaRow(double& ema, OptionRules rules = {});

// NAME or NAME@SHARE each; "file:KERNEL.json" is read, with a warning where its taps do not sum to 1. Throws Error.
std::vector<TileFilter> readFilters(const std::vector<std::string>& names);

// Outputs of verbs that make files.
struct Outputs
{
	std::vector<std::string> files;   // of -o
	std::string json;                 // of --json, or empty
	std::string depfile;              // of --depfile, or empty
	std::string progress;             // of --progress, or empty
	std::optional<WorkShare> share{}; // of --share, or none
	int threads = 0;                  // of --threads, or 0
};
void addOutputs(CLI::App& app, Outputs& outputs, std::span<const std::string_view> endings);
void addJson(CLI::App& app, std::string& json);

// --cache; runVerb() does the rest.
void addCache(CLI::App& app);

// --threads and --progress; --cache and --share as well for verbs whose work is in stages of units (core/work_units.h).
void addRun(CLI::App& app, Outputs& outputs, bool shares = false);
OptionRow threadsRow(int& threads);

// "K/N", or nothing if that is no share.
std::optional<WorkShare> shareOf(const std::string& text);

// Before any work: refuses no output at all, endings that are not known, one file named twice (or also as input), folders that do
// not take it, and names that a depfile cannot hold where there is to be one. Inputs that are not given are empty.
void checkOutputs(const Outputs& outputs, std::span<const std::string_view> endings, const std::vector<std::string>& inputs = {});

// Likewise for verbs that need no output; and the check of names and folders alone.
void checkAnyOutputs(const Outputs& outputs, std::span<const std::string_view> endings, const std::vector<std::string>& inputs);
void checkNames(const Outputs& outputs, const std::vector<std::string>& inputs);

// Whether a verb may print what it has to say: none of the outputs is standard output.
bool isStdoutFree(const Outputs& outputs);

// Once all files read are known, a level's buffers included: refuses outputs among them, and names as above.
void checkRead(const Outputs& outputs, const std::vector<std::string>& read);

// The outputs with each file replaced by those that it stands for.
Outputs expanded(Outputs outputs, const std::function<std::vector<std::string>(const std::string& file)>& filesOf);

double meanOf(const std::vector<float>& values);

// "a, b or c".
std::string spokenList(std::span<const std::string_view> names);

// Empty (none given) or an identifier.
void checkName(const std::string& name);

// For a caller (call.h): points and weights, of that shape before their coordinates.
void giveSamples(std::span<const Pattern> variants, std::vector<std::size_t> shape);

// Adds the facts and the list of files read, where they are asked for, and the lines for people where standard output is free.
void addSide(OutputSet& files, const Outputs& outputs, const std::string& facts, const std::vector<std::string>& read,
			 const std::string& lines = {});

// Writes all files of -o, and the above.
void writeOutputs(const Outputs& outputs, const std::function<std::string(const std::string& path)>& bytesOf,
				  const std::string& facts, const std::vector<std::string>& read, const std::string& lines = {});

// The verb's words and arguments in one order, without outputs, threads, progress, cache and share: what identifies a command.
std::vector<std::string> commandWords(const CLI::App& verb);

// The identity of results in a store (core/work_units.h): the version, then the command.
std::vector<std::string> identityOf(std::vector<std::string> command);

// A line on standard error.
void warn(const std::string& message);

} // namespace nook
