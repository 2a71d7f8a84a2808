// SPDX-License-Identifier: GPL-3.0-or-later
// nook plan: a command, or a list of levels and steps → the files from which Make, Slurm or Snakemake runs it in shares; and how
// much of such a plan is done.
#include "options.h"
#include "scene_options.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/file.h"
#include "core/lists.h"
#include "core/system.h"
#include "core/text.h"
#include "core/words.h"
#include "farm/plan.h"
#include "scene/builtin.h"
#include "version.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>

namespace nook
{
namespace
{

namespace fs = std::filesystem;

struct PlanOptions
{
	const CLI::App* app = nullptr;
	std::string engine = "make";
	int shares = 1;
	std::string folder;
	std::string program = "nook";
	int minutes = 0;
	int mebibytes = 0;
	bool dry_run = false;
	std::string status;
	Outputs outputs; // --json alone
	std::vector<std::string> words;
};

constexpr std::array<std::string_view, kEngines.size()> kEngineNames{kEngines[0].name, kEngines[1].name, kEngines[2].name};

// Pixels of pictures that earlier commands write.
using PixelsOf = std::map<std::string, double>;

std::string wholeName(const std::string& path)
{
	const fs::path whole = fs::weakly_canonical(fs::absolute(nativePath(path)));
	return (whole.has_filename() ? whole : whole.parent_path()).string();
}

std::string relativeTo(const std::string& path, const std::string& folder)
{
	return nativePath(path).lexically_relative(nativePath(folder)).generic_string();
}

// "--gbuffer=g.exr" and "-og.exr" are two words each.
std::vector<std::string> splitWords(const std::vector<std::string>& words)
{
	std::vector<std::string> split;
	for (const std::string& word : words)
	{
		const std::size_t equals = word.find('=');
		refuseIf(word.find('\n') != std::string::npos || word.find('\0') != std::string::npos,
				 "the command: found a word with a new line in it, expected none");
		if (word.starts_with("--") && equals != std::string::npos)
		{
			split.insert(split.end(), {word.substr(0, equals), word.substr(equals + 1)});
		}
		else if (word.starts_with("-o") && word.size() > 2)
		{
			split.insert(split.end(), {"-o", word.substr(2)});
		}
		else
		{
			split.push_back(word);
		}
	}
	return split;
}

// The verb, with its options as they were given.
struct ParsedCommand
{
	CLI::App nook;
	std::vector<Verb> verbs; // they hold what the options are read into
	CLI::App* verb = nullptr;
	std::string name; // "report error"

	explicit ParsedCommand(const std::vector<std::string>& words)
	{
		nook.allow_windows_style_options(false);
		nook.require_subcommand(1);
		verbs = addVerbs(nook);
		try
		{
			nook.parse(std::vector<std::string>(words.rbegin(), words.rend()));
		}
		catch (const CLI::Success&)
		{
			refuse("the command: found one that asks for help, expected one that writes files");
		}
		catch (const CLI::ParseError& error)
		{
			refuse("the command '" + (words.empty() ? "" : words.front()) + "': " + error.what() + ", expected what nook " +
				   (words.empty() ? "" : words.front()) + " --help lists");
		}
		verb = &nook;
		while (!verb->get_subcommands().empty())
		{
			verb = verb->get_subcommands().front();
			name += (name.empty() ? "" : " ") + verb->get_name();
		}
	}

	bool has(const std::string& option) const
	{
		return verb->get_option_no_throw(option) != nullptr;
	}

	std::vector<std::string> values(const std::string& option) const
	{
		const CLI::Option* const found = verb->get_option_no_throw(option);
		return found != nullptr ? found->results() : std::vector<std::string>{};
	}

	std::optional<double> number(const std::string& option) const
	{
		const std::vector<std::string> found = values(option);
		return found.empty() ? std::nullopt : numberFrom<double>(found.front());
	}
};

void checkForFarm(const ParsedCommand& parsed, int shares)
{
	refuseIf(parsed.name == "plan", "the command: found plan, expected a verb that makes something");
	for (const char* option : {"--share", "--cache", "--depfile", "--progress"})
	{
		refuseIf(!parsed.values(option).empty(),
				 std::string(option) + ": found in the command, expected none: the plan has its own");
	}
	refuseIf(shares > 1 && !parsed.has("--share"),
			 "--shares: found " + std::to_string(shares) + " of nook " + parsed.name +
				 ", expected 1, since that verb has no --share",
			 ExitCode::unsupported);
	std::vector<std::string> written = parsed.values("-o");
	append(written, parsed.values("--json"));
	refuseIf(written.empty(), "the command: found no -o FILE and no --json FILE, expected something to write");
	refuseIf(std::find(written.begin(), written.end(), "-") != written.end(),
			 "-: found standard output in the command, expected files");
}

// The data window of an EXR file's header (OpenEXR's "Technical Introduction": attributes are name, type, size, value).
double pixelsOfExr(const std::string& path)
{
	constexpr std::size_t kHeader = 1U << 16U;
	std::string begin(kHeader, '\0');
	std::FILE* const file = openFile(path, "rb");
	if (file == nullptr)
	{
		return 0.0;
	}
	begin.resize(std::fread(begin.data(), 1, begin.size(), file));
	std::fclose(file);
	constexpr std::string_view attribute("dataWindow\0box2i\0", 17);
	const std::size_t at = begin.find(attribute);
	std::array<int32_t, 4> box{};
	const std::size_t values = at + attribute.size() + 4;
	if (at == std::string::npos || values + sizeof box > begin.size())
	{
		return 0.0;
	}
	std::memcpy(box.data(), begin.data() + values, sizeof box);
	return (static_cast<double>(box[2]) - box[0] + 1.0) * (static_cast<double>(box[3]) - box[1] + 1.0);
}

// The folder may not be there yet, and "out/../a.glb" is then no name of a file.
fs::path placed(const std::string& folder, const std::string& name)
{
	return (nativePath(folder) / nativePath(name)).lexically_normal();
}

double bytesOf(const std::string& folder, const std::string& path)
{
	std::error_code failed;
	const auto bytes = fs::file_size(placed(folder, path), failed);
	return failed ? 0.0 : static_cast<double>(bytes);
}

double trianglesOf(const std::string& folder, const std::string& level)
{
	if (!level.starts_with(kBuiltinPrefix))
	{
		return trianglesOfFile(nativePath(level).extension().string(), bytesOf(folder, level));
	}
	return numberFrom<double>(level.substr(level.rfind(':') + 1)).value_or(10000.0); // as many as the largest has
}

constexpr double kVerticesPerTriangle = 0.75; // with values of their own, as in Sponza

WorkFacts factsOf(const ParsedCommand& parsed, const std::string& folder, const std::vector<std::string>& outputs, PixelsOf& pixels)
{
	WorkFacts facts{.verb = parsed.name};
	facts.triangles = sumOver(parsed.values("LEVEL"), [&folder](const std::string& level) { return trianglesOf(folder, level); });
	for (const char* option : {"--gbuffer", "FILE.exr", "FILE"})
	{
		for (const std::string& name : parsed.values(option))
		{
			const auto planned = pixels.find(plainPath(name));
			facts.pixels += planned != pixels.end() ? planned->second : pixelsOfExr(placed(folder, name).string());
		}
	}
	for (const std::string& name : parsed.values("--points"))
	{
		facts.pixels += bytesOf(folder, name) / 50.0; // six numbers a line
	}
	for (const std::string& size : parsed.values("--size"))
	{
		const glm::ivec2 pixels_of = sizeOf("--size", size);
		facts.pixels = static_cast<double>(pixels_of.x) * pixels_of.y;
	}
	facts.rays = parsed.number("--rays").value_or(256.0);
	const auto given = [&parsed](std::initializer_list<const char*> options)
	{
		return std::any_of(options.begin(), options.end(),
						   [&parsed](const char* option) { return !parsed.values(option).empty(); });
	};
	facts.looks_on = given({"--trim", "--compensate", "--detail"});
	if (parsed.name == "bake")
	{
		const double across = parsed.number("--texture").value_or(0.0);
		facts.pixels = across > 0.0 ? across * across : kVerticesPerTriangle * facts.triangles;
		facts.open_end = given({"--max-error", "--probes"});
	}
	for (const std::string& output : outputs)
	{
		pixels[plainPath(output)] = facts.pixels;
	}
	return facts;
}

// Input files must exist, or be written by the plan.
void checkInputs(const ParsedCommand& parsed, const std::string& folder, const PixelsOf& planned)
{
	for (const char* option : {"LEVEL", "--gbuffer", "--points"})
	{
		for (const std::string& name : parsed.values(option))
		{
			std::error_code failed;
			refuseIf(!name.starts_with(kBuiltinPrefix) && planned.count(plainPath(name)) == 0 &&
						 !fs::is_regular_file(placed(folder, name), failed),
					 name + ": cannot be read: found no such file, expected what the command reads", ExitCode::file);
		}
	}
}

// Checks the words as the verb itself would before any work. Throws Error: usage (words that the verb does not take, options that
// the plan needs for itself), file (no level there), unsupported (a verb that cannot be shared).
PlanCommand planCommandOf(const std::vector<std::string>& given, const std::string& folder, const ListedCommand& choice,
						  PixelsOf& pixels)
{
	const std::vector<std::string> words = splitWords(given);
	const ParsedCommand parsed(words);
	checkForFarm(parsed, choice.shares);
	checkInputs(parsed, folder, pixels);
	PlanCommand command;
	command.name = choice.name;
	command.shares = choice.shares;
	if (parsed.has("--cache"))
	{
		command.identity = identityOf(commandWords(*parsed.verb));
	}
	for (std::size_t i = 0; i < words.size(); ++i)
	{
		command.words.push_back(words[i]);
		const bool output = i > 0 && (words[i - 1] == "-o" || words[i - 1] == "--output" || words[i - 1] == "--json");
		std::error_code failed;
		if (output)
		{
			command.outputs.push_back(words[i]);
		}
		else if (!words[i].empty() && fs::is_regular_file(placed(folder, words[i]), failed) &&
				 pixels.count(plainPath(words[i])) == 0)
		{
			command.inputs.push_back(words[i]);
			for (const std::string& other : filesNextTo(placed(folder, words[i]).string()))
			{
				command.inputs.push_back(relativeTo(other, folder));
			}
		}
	}
	const int threads = static_cast<int>(parsed.number("--threads").value_or(1.0));
	if (parsed.has("--threads") && parsed.values("--threads").empty())
	{
		command.words.insert(command.words.end(), {"--threads", "1"}); // a job may not take all of a machine
	}
	command.needs = guessWork(factsOf(parsed, folder, command.outputs, pixels), threads);
	command.needs.minutes = choice.minutes;
	command.needs.mebibytes = choice.mebibytes;
	return command;
}

bool isPlainName(const std::string& name)
{
	const auto is_plain = [](char letter)
	{
		return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9');
	};
	return !name.empty() && name.size() <= 48 && is_plain(name.front()) &&
		   std::all_of(name.begin(), name.end(),
					   [&](char letter) { return is_plain(letter) || letter == '.' || letter == '_' || letter == '-'; });
}

// One command, which runs here. Its plan is in the folder of -o.
Plan planOfCommand(const PlanOptions& options)
{
	const std::string here = fs::current_path().string();
	const std::string folder = wholeName(options.folder);
	PixelsOf pixels;
	PlanCommand command =
		planCommandOf(options.words, here, {"job", {}, options.shares, options.minutes, options.mebibytes}, pixels);
	for (const std::string& output : command.outputs)
	{
		checkWritable(output);
	}
	return planOf(
		{std::move(command)},
		{"nook " + joinedText(options.words, " "), NOOK_VERSION, options.program, relativeTo(here, folder), options.engine, {}, {}},
		relativeTo(folder, here));
}

// A list of levels, whose steps run in the folder of -o. The plan is in its folder `plan`.
Plan planOfLevels(const PlanOptions& options)
{
	const std::string& list = options.words.front();
	const std::string folder = wholeName(options.folder);
	const std::string here = relativeTo(nativePath(wholeName(list)).parent_path().string(), folder);
	std::vector<PlanCommand> commands;
	PixelsOf pixels;
	for (const ListedCommand& item : readLevelList(readFile(list), list, here))
	{
		try
		{
			refuseIf(!isPlainName(item.name),
					 "found that name of a job, expected letters, digits, '.', '_' and '-', a letter or digit first, at most 48",
					 ExitCode::invalid_input);
			commands.push_back(planCommandOf(item.words, folder, item, pixels));
		}
		catch (const Error& error) // the list is a file: an error in it is one of input
		{
			throw Error(error.code() == ExitCode::usage ? ExitCode::invalid_input : error.code(),
						list + ": " + item.name + ": " + error.what());
		}
	}
	return planOf(std::move(commands),
				  {nativePath(list).filename().string(), NOOK_VERSION, options.program, "..", options.engine, {}, {}}, "plan");
}

// "2 h 5 min", "3.2 s".
std::string durationText(double seconds)
{
	if (seconds < 60.0)
	{
		return roundedText(seconds, 2) + " s";
	}
	const auto minutes = static_cast<uint64_t>(std::ceil(seconds / 60.0));
	return (minutes >= 60 ? std::to_string(minutes / 60) + " h " : "") + std::to_string(minutes % 60) + " min";
}

double coreSeconds(const Plan& plan)
{
	return sumOver(plan.groups, [](const PlanGroup& group)
				   { return group.needs.seconds * group.needs.threads * static_cast<double>(group.count); });
}

std::string planText(const Plan& plan)
{
	std::string text = plan.title + ": " + counted(plan.jobs.size(), "job", "jobs") + ", estimated " +
					   durationText(coreSeconds(plan)) + " of one core\n";
	for (const PlanGroup& group : plan.groups)
	{
		const double overhead = overheadOf(group.needs, group.count);
		text += "  " + group.name + ": " + counted(group.count, "job", "jobs") + " of " +
				(group.needs.known ? "about " : "unknown time, taken as ") + durationText(group.needs.seconds) + " with " +
				std::to_string(group.needs.threads) + (group.needs.threads == 1 ? " thread" : " threads") + "; asks for " +
				std::to_string(minutesToAsk(group.needs)) + " min and " + std::to_string(mebibytesToAsk(group.needs)) +
				" MiB each" +
				(overhead <= kOverhead
					 ? ""
					 : "; together about " + fixedText(overhead, 1) + " times one run, expected " + fixedText(kOverhead, 2) +
						   " or less: --shares " + std::to_string(mostJobs(group.needs, group.count)) + " at most") +
				"\n";
	}
	return text;
}

void addPlanFacts(Facts& summary, const Plan& plan)
{
	summary.text("title", plan.title);
	summary.text("engine", plan.engine);
	summary.whole("jobs", plan.jobs.size());
	summary.number("core_seconds", roundedNumber(coreSeconds(plan), 4));
	std::vector<Facts> groups;
	for (const PlanGroup& group : plan.groups)
	{
		Facts& item = groups.emplace_back();
		item.text("name", group.name);
		item.whole("jobs", group.count);
		item.text("estimated", group.needs.known ? "yes" : "no");
		item.number("seconds", roundedNumber(group.needs.seconds, 4));
		item.number("overhead", roundedNumber(overheadOf(group.needs, group.count), 4));
		item.whole("memory_bytes", static_cast<std::size_t>(group.needs.bytes));
		item.whole("threads", static_cast<std::size_t>(group.needs.threads));
		item.whole("ask_minutes", static_cast<std::size_t>(minutesToAsk(group.needs)));
		item.whole("ask_memory_mib", static_cast<std::size_t>(mebibytesToAsk(group.needs)));
	}
	summary.items("groups", groups);
}

void writePlan(const Plan& plan, const std::string& folder)
{
	const fs::path file = nativePath(folder) / kPlanFile;
	if (fs::exists(file))
	{
		const Plan old = readPlan(readFile(file.string()), file.string());
		refuseIf(old.title != plan.title,
				 folder + ": found the plan of '" + old.title + "', expected that of '" + plan.title + "', or a new folder");
	}
	std::error_code failed;
	fs::create_directories(nativePath(folder), failed);
	refuseIf(bool(failed), folder + ": cannot be made: " + failed.message(), ExitCode::file);
	OutputSet files;
	for (const PlanFile& one : planFiles(plan))
	{
		files.add((nativePath(folder) / one.name).string(), one.text);
	}
	files.commit();
}

void tellStatus(const PlanOptions& options)
{
	const std::string path = (nativePath(options.status) / kPlanFile).string();
	const Plan plan = readPlan(readFile(path), path);
	const std::vector<char> done = doneJobs(plan, options.status);
	const auto count = static_cast<std::size_t>(std::count(done.begin(), done.end(), 1));
	Facts summary = verbFacts("plan");
	summary.text("title", plan.title);
	summary.whole("jobs", plan.jobs.size());
	summary.whole("done", count);
	summary.whole("not_done", plan.jobs.size() - count);
	std::string text = plan.title + ": " + counted(plan.jobs.size(), "job", "jobs") + ", " + std::to_string(count) + " done, " +
					   std::to_string(plan.jobs.size() - count) + " not done\n";
	const std::vector<std::string> names = mapped(indicesWhere(done.size(), [&](std::size_t i) { return done[i] == 0; }),
												  [&](std::size_t i) { return plan.jobs[i].name; });
	text += joinedText(names, "", [](const std::string& name) { return "  " + name + "\n"; });
	summary.texts("left", names);
	writeOutputs(options.outputs, {}, summary.json(), {}, text);
}

void checkForm(const PlanOptions& options)
{
	for (const CLI::Option* option : options.app->get_options())
	{
		refuseIf(!options.status.empty() && option->count() > 0 && option->get_name() != "--status" &&
					 option->get_name() != "--json",
				 "--status: found with " + option->get_name() + ", expected it alone, or with --json");
	}
	refuseIf(
		options.status.empty() && options.words.empty(),
		"the command: found none, expected nook plan OPTIONS -- VERB ARGUMENTS, nook plan OPTIONS LEVELS.json, or --status DIR");
	refuseIf(options.status.empty() && options.folder.empty(), "-o: found none, expected a folder for the plan");
	if (!options.outputs.json.empty())
	{
		checkWritable(options.outputs.json);
	}
}

void run(PlanOptions& options, VerbProgress&)
{
	checkForm(options);
	if (!options.status.empty())
	{
		tellStatus(options);
		return;
	}
	const bool list = options.words.size() == 1 && options.words.front().ends_with(".json");
	refuseIf(list && (options.shares > 1 || options.minutes > 0 || options.mebibytes > 0),
			 "--shares, --minutes, --memory: found with a list of levels, expected them in its steps");
	const Plan plan = list ? planOfLevels(options) : planOfCommand(options);
	const std::string folder = list ? options.folder + "/plan" : options.folder;
	Facts summary = verbFacts("plan");
	addPlanFacts(summary, plan);
	std::string text = planText(plan);
	if (!options.dry_run)
	{
		writePlan(plan, folder);
		const auto* const engine = firstWhere(kEngines, [&](const Engine& e) { return e.name == plan.engine; });
		summary.text("start", engine->start);
		text += folder + ": " + std::string(engine->start) + "\n";
	}
	writeOutputs(options.outputs, {}, summary.json(), {}, text);
}

void declare(CLI::App& app, PlanOptions& options)
{
	options.app = &app;
	app.add_option("COMMAND", options.words, "After --: a verb and its arguments; or a list of levels and steps, LEVELS.json")
		->type_name("WORD");
	addOptions(app,
			   {{"--for", takesIndex(kEngineNames, [&options](std::size_t i) { options.engine = kEngines[i].name; }),
				 "What runs the jobs (default make)"},
				{"--shares", takesWhole(options.shares, 1, kMaxPlanShares), "Shares of the command, a job each (default 1)"},
				{"-o,--output", takesText(options.folder, "DIR"),
				 "The plan's folder; with a list, where its steps run, and the plan is in DIR/plan"},
				{"--program", takesText(options.program, "FILE"), "How the jobs call nook (default nook)"},
				{"--minutes", takesWhole(options.minutes, 1, kMaxMinutes), "Time to ask for per job (default: from an estimate)"},
				{"--memory", takesWhole(options.mebibytes, 1, kMaxMebibytes),
				 "Memory to ask for per job, MiB (default: from an estimate)"},
				{"--dry-run", takesFlag(options.dry_run), "Writes nothing; prints the jobs and what they would ask for"},
				{"--status", takesText(options.status, "DIR"), "Counts the jobs of a plan that are done"}});
	addJson(app, options.outputs.json);
}

} // namespace

Verb addPlanVerb(CLI::App& nook)
{
	return addVerb<PlanOptions>(nook, "plan", "Jobs for Make, Slurm or Snakemake: of a command, or of a list of levels", declare,
								run);
}

} // namespace nook
