// SPDX-License-Identifier: GPL-3.0-or-later
// Options as every verb declares them: one declaration gives the parser, the check and the line of help.
#pragma once

#include "core/file.h"
#include "core/part_file.h"
#include "pattern/recipe.h"
#include "verb_progress.h"

#include <CLI/CLI.hpp>

#include <glm/mat4x4.hpp>

#include <functional>
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

Verb addPatternVerb(CLI::App& nook);
Verb addTileVerb(CLI::App& nook);
Verb addTuneVerb(CLI::App& nook);
Verb addFitVerb(CLI::App& nook);
Verb addVolumesVerb(CLI::App& nook);
Verb addBakeVerb(CLI::App& nook);
Verb addBatchVerb(CLI::App& nook);
Verb addCatalogueVerb(CLI::App& nook);
Verb addCompareVerb(CLI::App& nook);
Verb addEmitVerb(CLI::App& nook);
Verb addGBufferVerb(CLI::App& nook);
Verb addInfoVerb(CLI::App& nook);
Verb addLevelVerb(CLI::App& nook);
Verb addPlanVerb(CLI::App& nook);
Verb addMergeVerb(CLI::App& nook);
Verb addReferenceVerb(CLI::App& nook);
Verb addReportVerb(CLI::App& nook);
Verb addShadeVerb(CLI::App& nook);
Verb addStressVerb(CLI::App& nook);

// What stands between commas; nothing of an empty list.
std::vector<std::string> partsOf(const std::string& list);

// Throws Error (usage).
[[noreturn]] void refuse(const std::string& message);

// "found X, expected Y" for an option. Throws Error (usage).
[[noreturn]] void refuseValue(const std::string& option, const std::string& found, const std::string& expected);

// What needs a component that is not in this build. Throws Error (unsupported).
[[noreturn]] void refuseWithout(const std::string& component, const std::string& what);

// Plain decimal numbers within a range; anything else is refused.
CLI::Option* addWhole(CLI::App& app, const std::string& names, const std::function<void(int)>& take, int least, int most,
					  const std::string& help);
CLI::Option* addWhole(CLI::App& app, const std::string& names, int& value, int least, int most, const std::string& help);
// The same for numbers that may be larger.
CLI::Option* addLong(CLI::App& app, const std::string& names, const std::function<void(uint64_t)>& take, uint64_t least,
					 uint64_t most, const std::string& help);
CLI::Option* addSeed(CLI::App& app, uint32_t& value);
CLI::Option* addNumber(CLI::App& app, const std::string& names, const std::function<void(double)>& take, double least, double most,
					   const std::string& help);
CLI::Option* addNumber(CLI::App& app, const std::string& names, double& value, double least, double most, const std::string& help);
// 16 numbers in one argument, commas or blanks between them, column by column; or the word identity. All are finite.
CLI::Option* addMatrix(CLI::App& app, const std::string& names, std::optional<glm::dmat4>& value, const std::string& help);
CLI::Option* addText(CLI::App& app, const std::string& names, std::string& value, const std::string& kind, const std::string& help);

CLI::Option* addChoiceText(CLI::App& app, const std::string& option, std::span<const std::string_view> names,
						   const std::function<void(std::size_t)>& choose, const std::string& help);

template <class Enum> CLI::Option* addChoice(CLI::App& app, const std::string& option, Enum& value, const std::string& help)
{
	return addChoiceText(
		app, option, namesOf<Enum>(), [&value](std::size_t i) { value = static_cast<Enum>(i); }, help);
}

// --domain, of those of which there are patterns.
CLI::Option* addDomain(CLI::App& app, Domain& value, const std::string& help);

// "1-64" or "7".
struct CountRange
{
	int first = 1;
	int last = 64;
};
CLI::Option* addCounts(CLI::App& app, const std::string& option, CountRange& value, int most, const std::string& help);

// What verbs that make files share.
struct Outputs
{
	std::vector<std::string> files;   // of -o
	std::string json;                 // of --json, or empty
	std::string depfile;              // of --depfile, or empty
	std::string progress;             // of --progress, or empty
	std::optional<PartNumber> part{}; // of --part, or none
};
void addOutputs(CLI::App& app, Outputs& outputs, std::span<const std::string_view> endings);
void addJson(CLI::App& app, std::string& json);
CLI::Option* addThreads(CLI::App& app, int& threads);

CLI::Option* addProgress(CLI::App& app, std::string& progress);

// --part, of verbs whose work is in stages of units (core/work_units.h); runVerb() does the rest.
CLI::Option* addPart(CLI::App& app, std::optional<PartNumber>& part);

// --cache of the same verbs; runVerb() does the rest.
void addUnitCache(CLI::App& app);

// That option, where it is given; null where it is not, or the verb has none, or one of its own.
const CLI::Option* givenUnitCache(const CLI::App& app);

// One file NAME.part and nothing else, or Error (usage).
void checkPartOutputs(const Outputs& outputs, const std::vector<std::string>& inputs);

// Before any work: refuses no output at all, endings that are not known, one file named twice (or also as input), folders that do
// not take it, and names that a depfile cannot hold where there is to be one. Of a part as checkPartOutputs().
void checkOutputs(const Outputs& outputs, std::span<const std::string_view> endings, const std::vector<std::string>& inputs = {});

// The same of verbs that need no output: names and folders alone.
void checkNames(const Outputs& outputs, const std::vector<std::string>& inputs);

// Whether a verb may print what it has to say: none of the outputs is standard output.
bool isStdoutFree(const Outputs& outputs);

// As soon as it is known what was read, a level's buffers say: refuses outputs among it, and names as above.
void checkRead(const Outputs& outputs, const std::vector<std::string>& read);

// No two of `written` are one file, and none is a file of `read`, by whatever name. Throws Error (usage) that names both.
void checkDistinct(const std::vector<std::string>& written, const std::vector<std::string>& read);

// Empty (none given) or an identifier.
void checkName(const std::string& name);

// Adds the summary and the list of files read, where they are asked for.
void addSide(OutputSet& files, const Outputs& outputs, const std::string& summary, const std::vector<std::string>& read);

} // namespace nook
