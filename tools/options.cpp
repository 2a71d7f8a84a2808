// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include "call.h"
#include "core/decimal.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/text.h"
#include "format/pattern_file.h"
#include "format/tile_json.h"
#include "scene/builtin.h"
#include "version.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <unordered_map>

namespace nook
{
namespace
{

// "--count" of "-n,--count".
std::string longName(const std::string& names)
{
	return names.substr(names.rfind(',') + 1);
}

// All files that the outputs name.
std::vector<std::string> writtenBy(const Outputs& outputs)
{
	std::vector<std::string> written = outputs.files;
	written.insert(written.end(), {outputs.json, outputs.depfile, outputs.progress});
	std::erase(written, "");
	return written;
}

// Not a level of the program's own, nor an input that is not given.
bool isFile(const std::string& path)
{
	return !path.empty() && !path.starts_with(kBuiltinPrefix);
}

// The rule for those that were read; standard output depends on nothing.
std::string depfileOf(const Outputs& outputs, const std::vector<std::string>& read)
{
	std::vector<std::string> targets = outputs.files;
	std::erase(targets, "-");
	std::vector<std::string> sources;
	for (const std::string& path : itemsWhere(read, isFile))
	{
		addOnce(sources, path);
	}
	return depfileText(targets, sources);
}

// CLI11 hands over whatever follows; a name that begins with a dash is far more likely a forgotten value.
void checkText(const std::string& name, const std::string& text, const std::string& kind)
{
	refuseValueIf(text.empty() || (text.size() > 1 && text[0] == '-'), name, text, kind);
}

// A condition's option as it is given, "--falloff linear", if that is one of its values; else empty.
std::string givenAs(const CLI::App& app, const std::string& condition)
{
	const std::size_t blank = std::min(condition.find(' '), condition.size());
	const CLI::Option* const option = app.get_option(condition.substr(0, blank));
	if (option->count() == 0 || blank == condition.size())
	{
		return option->count() > 0 ? condition : "";
	}
	const std::string values = "|" + condition.substr(blank + 1) + "|";
	const std::string& value = option->results().front();
	return values.find("|" + value + "|") != std::string::npos ? condition.substr(0, blank + 1) + value : "";
}

// The first of a condition's options that is given; empty: the condition does not hold.
std::string holding(const CLI::App& app, const std::string& condition)
{
	constexpr std::string_view kOr = " or ";
	std::string given;
	for (std::size_t begin = 0; given.empty() && begin < condition.size();)
	{
		const std::size_t end = std::min(condition.find(kOr, begin), condition.size());
		given = givenAs(app, condition.substr(begin, end - begin));
		begin = std::min(end + kOr.size(), condition.size());
	}
	return given;
}

void checkRules(const CLI::App& app, const std::string& name, const OptionRules& rules)
{
	const auto refuseBy = [&](const OptionRule& rule, const std::string& found, const std::string& expected)
	{
		refuse(name + ": found " + (rule.found.empty() ? found : rule.found) + ", expected " +
			   (rule.expected.empty() ? expected : rule.expected));
	};
	for (const OptionRule& rule : rules.excludes)
	{
		if (const std::string other = holding(app, rule.condition); !other.empty())
		{
			refuseBy(rule, "with " + other, "one of them");
		}
	}
	for (const OptionRule& rule : rules.needs)
	{
		if (holding(app, rule.condition).empty())
		{
			refuseBy(rule, "without " + rule.condition, "both");
		}
	}
}

// No two of `written` are one file, and none is a file of `read`, by whatever name. Throws Error (usage) that names both.
void checkDistinct(const std::vector<std::string>& written, const std::vector<std::string>& read)
{
	if (written.empty())
	{
		return;
	}
	std::unordered_map<std::string, std::string> seen; // name by identity
	for (const std::string& path : itemsWhere(read, isFile))
	{
		seen.try_emplace(fileIdentity(path), path);
	}
	for (const std::string& path : written)
	{
		const auto [other, is_new] = seen.try_emplace(fileIdentity(path), path);
		if (!is_new)
		{
			const std::string found = other->second == path ? "named twice" : "found the same file as " + other->second;
			refuse(path + ": " + found + ", expected another file for every input and output");
		}
	}
}

// A number within a range.
template <class Number>
OptionValue takesWithin(const std::function<void(Number)>& take, Number least, Number most, const std::string& kind,
						const std::string& expected)
{
	const auto check = [take, least, most, expected](const std::string& name, const std::string& text)
	{
		const std::optional<Number> number = numberFrom<Number>(text);
		refuseValueIf(!number || !(*number >= least && *number <= most), name, text, expected);
		take(*number);
	};
	return takesParsed(kind, check);
}

} // namespace

Facts verbFacts(std::string_view verb)
{
	Facts facts;
	facts.text("schema", "nook.summary/1");
	facts.text("verb", verb);
	facts.text("version", NOOK_VERSION);
	return facts;
}

std::vector<std::string> partsOf(const std::string& list, char between)
{
	std::vector<std::string> parts;
	for (std::size_t begin = 0; !list.empty() && begin <= list.size();)
	{
		const std::size_t end = std::min(list.find(between, begin), list.size());
		parts.push_back(list.substr(begin, end - begin));
		begin = end + 1;
	}
	return parts;
}

void refuse(const std::string& message)
{
	throw Error(ExitCode::usage, message);
}

void refuseValue(const std::string& option, const std::string& found, const std::string& expected)
{
	refuse(option + ": found '" + found + "', expected " + expected);
}

void refuseValueIf(bool condition, const std::string& option, const std::string& found, const std::string& expected)
{
	if (condition)
	{
		refuseValue(option, found, expected);
	}
}

OptionRules needs(const std::string& condition, const std::string& expected, const std::string& found)
{
	return {.needs = {{condition, expected, found}}};
}

OptionRules excludes(const std::string& condition, const std::string& expected, const std::string& found)
{
	return {.excludes = {{condition, expected, found}}};
}

void addOptions(CLI::App& app, const std::vector<OptionRow>& rows)
{
	for (const OptionRow& row : rows)
	{
		CLI::Option* const option = row.value(app, row.names, row.help);
		option->required(row.rules.required);
		if (!row.rules.needs.empty() || !row.rules.excludes.empty())
		{
			// Values of all options are known, though not yet checked, by the time that CLI11 calls this.
			option->each([&app, name = longName(row.names), rules = row.rules](const std::string&)
						 { checkRules(app, name, rules); });
		}
	}
}

bool isGiven(const CLI::App& app, const std::string& name)
{
	return app.get_option(name)->count() > 0;
}

OptionValue takesFlag(bool& value, bool given)
{
	return takesFlag([&value, given] { value = given; });
}

OptionValue takesFlag(const std::function<void()>& take)
{
	return [take](CLI::App& app, const std::string& names, const std::string& help)
	{
		return app.add_flag_callback(names, take, help);
	};
}

OptionValue takesText(std::string& value, const std::string& kind)
{
	const auto take = [&value, kind](const std::string& name, const std::string& text)
	{
		checkText(name, text, kind);
		value = text;
	};
	return takesParsed(kind, take);
}

OptionValue takesBytes(uint64_t& value)
{
	const auto take = [&value](const std::string& option, const std::string& text)
	{
		constexpr std::array<std::string_view, 4> kUnits{"", "KiB", "MiB", "GiB"};
		constexpr std::array<uint64_t, 4> kBytes{1, uint64_t{1} << 10U, uint64_t{1} << 20U, uint64_t{1} << 30U};
		uint64_t number = 0;
		const std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), number);
		const std::string_view unit(result.ptr, static_cast<std::size_t>(text.data() + text.size() - result.ptr));
		const auto* const found = std::find(kUnits.begin(), kUnits.end(), unit);
		const auto at = static_cast<std::size_t>(found - kUnits.begin());
		refuseValueIf(result.ec != std::errc{} || found == kUnits.end() || number == 0 ||
						  number > (uint64_t{1} << 50U) / kBytes[at],
					  option, text, "a number of bytes, KiB, MiB or GiB: 2GiB");
		value = number * kBytes[at];
	};
	return takesParsed("SIZE", take);
}

OptionValue takesIndex(std::span<const std::string_view> names, const std::function<void(std::size_t)>& choose)
{
	const auto take = [names = std::vector(names.begin(), names.end()), choose](const std::string& option, const std::string& text)
	{
		const auto found = std::find(names.begin(), names.end(), text);
		refuseValueIf(found == names.end(), option, text, spokenList(names));
		choose(static_cast<std::size_t>(found - names.begin()));
	};
	return takesParsed(joinedText(names, "|"), take);
}

OptionValue takesParsed(const std::string& kind, const TakeText& take)
{
	return [kind, take](CLI::App& app, const std::string& names, const std::string& help)
	{
		CLI::Option* const option = app.add_option_function<std::string>(
			names, [](const std::string&) {}, help);
		// Takes the value before the option's rules are checked, so that a bad value is what is reported first.
		return option->each([name = longName(names), take](const std::string& text) { take(name, text); })->type_name(kind);
	};
}

OptionValue takesEach(const std::string& kind, const TakeText& take)
{
	return [kind, take](CLI::App& app, const std::string& names, const std::string& help)
	{
		const auto all = [name = longName(names), take](const std::vector<std::string>& texts)
		{
			for (const std::string& text : texts)
			{
				take(name, text);
			}
		};
		CLI::Option* const option = app.add_option_function<std::vector<std::string>>(names, all, help)->type_name(kind);
		return option->get_positional() ? option : option->allow_extra_args(false);
	};
}

OptionValue takesWholeBy(const std::function<void(uint64_t)>& take, uint64_t least, uint64_t most, const std::string& kind)
{
	return takesWithin(take, least, most, kind, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
}

OptionValue takesNumberBy(const std::function<void(double)>& take, double least, double most, const std::string& kind)
{
	return takesWithin(take, least, most, kind, "a number from " + numberText(least) + " to " + numberText(most));
}

OptionValue takesMatrix(std::optional<glm::dmat4>& value)
{
	const auto take = [&value](const std::string& name, const std::string& text)
	{
		if (text == "identity")
		{
			value = glm::dmat4(1.0);
			return;
		}
		const std::string_view between = ", \t\n";
		glm::dmat4 matrix(0.0);
		int count = 0;
		std::size_t end = 0;
		for (std::size_t at = text.find_first_not_of(between); at != std::string::npos; at = text.find_first_not_of(between, end))
		{
			end = std::min(text.find_first_of(between, at), text.size());
			const std::optional<double> number = numberFrom<double>(text.substr(at, end - at));
			refuseValueIf(!number || !std::isfinite(*number), name, text.substr(at, end - at),
						  "16 finite numbers, column by column, with commas between");
			if (count < 16)
			{
				matrix[count / 4][count % 4] = *number;
			}
			count += 1;
		}
		refuseValueIf(count != 16, name, std::to_string(count) + (count == 1 ? " number" : " numbers"),
					  "16 finite numbers, column by column, with commas between");
		value = matrix;
	};
	return takesParsed("16 NUMBERS", take);
}

OptionValue takesCounts(CountRange& value, int most)
{
	const auto take = [&value, most](const std::string& name, const std::string& text)
	{
		const std::size_t dash = text.find('-');
		const std::optional<int> first = numberFrom<int>(text.substr(0, dash));
		const std::optional<int> last = dash == std::string::npos ? first : numberFrom<int>(text.substr(dash + 1));
		refuseValueIf(!first || !last || *first < 1 || *last < *first || *last > most, name, text,
					  "FIRST-LAST or one number, from 1 to " + std::to_string(most));
		value = {*first, *last};
	};
	return takesParsed("FIRST-LAST", take);
}

OptionRow seedRow(uint32_t& value)
{
	return {"--seed", takesWhole(value, 0, std::numeric_limits<uint32_t>::max(), "S"), "Seed of everything random (default 1)"};
}

OptionRow glDeviceRow(std::optional<int>& device, OptionRules rules)
{
	return {"--gl-device", takesWhole(device, 0, 255),
			"Number in EGL's list, from 0 (default: its first GPU, else the driver's choice)", std::move(rules)};
}

OptionRow filterRow(std::vector<std::string>& names, const std::string& help)
{
	return {"--filter", takesEach("KERNEL", [&names](const std::string&, const std::string& text) { names.push_back(text); }),
			help};
}

OptionRow emaRow(double& ema, OptionRules rules)
{
	return {"--ema", takesNumber(ema, 1e-6, 1.0), "Weight of the newest frame in the mean over frames (default 0.1)",
			std::move(rules)};
}

std::vector<TileFilter> readFilters(const std::vector<std::string>& names)
{
	std::vector<std::string> warnings;
	std::vector<TileFilter> filters = filtersOf(names, warnings);
	for (const std::string& warning : warnings)
	{
		warn(warning);
	}
	return filters;
}

void addJson(CLI::App& app, std::string& json)
{
	addOptions(app, {{"--json", takesText(json, "FILE"), "Machine-readable summary; - is standard output"}});
}

void addOutputs(CLI::App& app, Outputs& outputs, std::span<const std::string_view> endings)
{
	const auto take = [&outputs](const std::string&, const std::string& file)
	{
		checkText("-o", file, "FILE");
		outputs.files.push_back(file);
	};
	addOptions(app, {{"-o,--output", takesEach("FILE", take),
					  "File to write, may be repeated; its ending picks the format: " + joinedText(endings, " ")}});
	addJson(app, outputs.json);
	addOptions(app,
			   {{"--depfile", takesText(outputs.depfile, "FILE"), "Lists the files that were read, as a rule for Make or Ninja"}});
}

void addCache(CLI::App& app)
{
	const auto check = [](const std::string& name, const std::string& folder)
	{
		checkText(name, folder, "DIR");
	};
	addOptions(app, {{"--cache", takesParsed("DIR", check),
					  "Folder for finished work: a run that was killed continues from it, with the same bytes"}});
}

std::optional<WorkShare> shareOf(const std::string& text)
{
	const std::size_t slash = text.find('/');
	const int of = slash == std::string::npos ? 0 : numberFrom<int>(text.substr(slash + 1)).value_or(0);
	const int number = numberFrom<int>(text.substr(0, slash)).value_or(0);
	return number >= 1 && number <= of && of <= kMaxShares ? std::optional(WorkShare{number, of}) : std::nullopt;
}

OptionRow threadsRow(int& threads)
{
	return {"--threads", takesWhole(threads, 1, 1024),
			"Threads, 1 to 1024 (default: all processors); never changes a byte of what is made"};
}

void addRun(CLI::App& app, Outputs& outputs, bool shares)
{
	addOptions(app, {threadsRow(outputs.threads),
					 {"--progress", takesText(outputs.progress, "FILE"),
					  "Stages, shares done and seconds left while it works, a JSON object a line; - is standard output"}});
	if (!shares)
	{
		return;
	}
	addCache(app);
	const auto take = [&share = outputs.share](const std::string& name, const std::string& text)
	{
		share = shareOf(text);
		refuseValueIf(!share, name, text, "K/N, whole numbers with 1 <= K <= N <= " + std::to_string(kMaxShares));
	};
	addOptions(app, {{"--share", takesParsed("K/N", take),
					  "Computes the Kth of N shares of the work into --cache and writes no output; the same command without "
					  "--share then writes it"}});
}

void checkOutputs(const Outputs& outputs, std::span<const std::string_view> endings, const std::vector<std::string>& inputs)
{
	refuseIf(outputs.files.empty() && outputs.json.empty(), "-o: nothing to write, expected -o FILE or --json FILE");
	const bool to_files =
		std::any_of(outputs.files.begin(), outputs.files.end(), [](const std::string& path) { return path != "-"; });
	refuseIf(!outputs.depfile.empty() && !to_files, "--depfile: nothing depends on the files read, expected -o FILE as well");
	for (const std::string& path : outputs.files)
	{
		const std::string_view ending = formatOf(path, endings);
		if (!kHasLevels && (ending == ".exr" || ending == ".png"))
		{
			refuseWithout("levels", path);
		}
	}
	checkNames(outputs, inputs);
}

void checkAnyOutputs(const Outputs& outputs, std::span<const std::string_view> endings, const std::vector<std::string>& inputs)
{
	if (outputs.files.empty() && outputs.json.empty())
	{
		checkNames(outputs, inputs);
		return;
	}
	checkOutputs(outputs, endings, inputs);
}

void checkNames(const Outputs& outputs, const std::vector<std::string>& inputs)
{
	checkRead(outputs, inputs);
	for (const std::string& path : writtenBy(outputs))
	{
		checkWritable(path);
	}
}

bool isStdoutFree(const Outputs& outputs)
{
	const std::vector<std::string> written = writtenBy(outputs);
	return std::find(written.begin(), written.end(), "-") == written.end();
}

void checkRead(const Outputs& outputs, const std::vector<std::string>& read)
{
	checkDistinct(writtenBy(outputs), read);
	if (!outputs.depfile.empty())
	{
		depfileOf(outputs, read); // refuses names
	}
}

Outputs expanded(Outputs outputs, const std::function<std::vector<std::string>(const std::string& file)>& filesOf)
{
	for (const std::string& file : std::exchange(outputs.files, {}))
	{
		append(outputs.files, filesOf(file));
	}
	return outputs;
}

double meanOf(const std::vector<float>& values)
{
	return sumOver(values, [](float value) { return static_cast<double>(value); }) / static_cast<double>(values.size());
}

std::string spokenList(std::span<const std::string_view> names)
{
	const std::string first = joinedText(names.first(names.size() - 1), ", ");
	return first + (first.empty() ? "" : " or ") + std::string(names.back());
}

void checkName(const std::string& name)
{
	refuseValueIf(!name.empty() && !isIdentifier(name), "--name", name, "letters, digits and single underscores, a letter first");
}

void giveSamples(std::span<const Pattern> variants, std::vector<std::size_t> shape)
{
	std::vector<double> points;
	std::vector<double> weights;
	const std::size_t columns = variants.front().domain == Domain::disk ? 2 : 3;
	for (const Pattern& variant : variants)
	{
		for (const glm::dvec3& point : variant.points)
		{
			points.insert(points.end(), &point.x, &point.x + columns);
		}
		append(weights, variant.weights);
	}
	give<double>("weights", weights, shape);
	shape.push_back(columns);
	give<double>("points", points, shape);
}

void addSide(OutputSet& files, const Outputs& outputs, const std::string& facts, const std::vector<std::string>& read,
			 const std::string& lines)
{
	if (!outputs.json.empty())
	{
		files.add(outputs.json, facts);
	}
	if (!outputs.depfile.empty())
	{
		files.add(outputs.depfile, depfileOf(outputs, read));
	}
	if (!lines.empty() && t_call == nullptr && isStdoutFree(outputs))
	{
		files.add("-", lines);
	}
}

void writeOutputs(const Outputs& outputs, const std::function<std::string(const std::string& path)>& bytesOf,
				  const std::string& facts, const std::vector<std::string>& read, const std::string& lines)
{
	OutputSet files;
	for (const std::string& path : outputs.files)
	{
		files.add(path, bytesOf(path));
	}
	addSide(files, outputs, facts, read, lines);
	files.commit();
}

void warn(const std::string& message)
{
	if (t_call != nullptr)
	{
		t_call->warnings.push_back(oneLine(message));
		return;
	}
	std::fprintf(stderr, "nook: warning: %s\n", oneLine(message).c_str());
}

} // namespace nook
