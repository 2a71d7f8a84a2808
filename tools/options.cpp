// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include "components.h"

#include "core/decimal.h"
#include "core/depfile.h"
#include "core/error.h"
#include "core/file.h"
#include "core/number.h"
#include "core/text.h"
#include "format/pattern_file.h"
#include "scene/builtin.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <unordered_map>

namespace nook
{
namespace
{

// The whole text as a number in decimal. CLI11's own conversions read 010 as eight and let blanks pass.
template <class Number> std::optional<Number> parsed(const std::string& text)
{
	Number value{};
	const char* const end = text.data() + text.size();
	std::from_chars_result result{};
	if constexpr (std::is_floating_point_v<Number>)
	{
		result = readDecimal(text.data(), end, value);
	}
	else
	{
		result = std::from_chars(text.data(), end, value);
	}
	if (result.ec != std::errc{} || result.ptr != end)
	{
		return std::nullopt;
	}
	return value;
}

// "--count" of "-n,--count".
std::string longName(const std::string& names)
{
	return names.substr(names.rfind(',') + 1);
}

// What becomes a file.
std::vector<std::string> writtenBy(const Outputs& outputs)
{
	std::vector<std::string> written = outputs.files;
	for (const std::string& path : {outputs.json, outputs.depfile, outputs.progress})
	{
		if (!path.empty())
		{
			written.push_back(path);
		}
	}
	return written;
}

// The rule for those that were read; standard output depends on nothing.
std::string depfileOf(const Outputs& outputs, const std::vector<std::string>& read)
{
	std::vector<std::string> targets = outputs.files;
	std::erase(targets, "-");
	std::vector<std::string> sources;
	for (const std::string& path : read)
	{
		if (!path.starts_with(kBuiltinPrefix) && std::find(sources.begin(), sources.end(), path) == sources.end())
		{
			sources.push_back(path);
		}
	}
	return depfileText(targets, sources);
}

} // namespace

std::vector<std::string> partsOf(const std::string& list)
{
	std::vector<std::string> parts;
	for (std::size_t begin = 0; !list.empty() && begin <= list.size();)
	{
		const std::size_t end = std::min(list.find(',', begin), list.size());
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
	throw Error(ExitCode::usage, option + ": found '" + found + "', expected " + expected);
}

namespace
{

// CLI11 hands over whatever follows; a name that begins with a dash is far more likely a forgotten value.
void checkText(const std::string& name, const std::string& text, const std::string& kind)
{
	if (text.empty() || (text.size() > 1 && text[0] == '-'))
	{
		refuseValue(name, text, kind);
	}
}

} // namespace

CLI::Option* addText(CLI::App& app, const std::string& names, std::string& value, const std::string& kind, const std::string& help)
{
	const auto take = [&value, names, kind](const std::string& text)
	{
		checkText(longName(names), text, kind);
		value = text;
	};
	return app.add_option_function<std::string>(names, take, help)->type_name(kind);
}

CLI::Option* addWhole(CLI::App& app, const std::string& names, const std::function<void(int)>& take, int least, int most,
					  const std::string& help)
{
	const auto check = [take, names, least, most](const std::string& text)
	{
		const std::optional<int> number = parsed<int>(text);
		if (!number || *number < least || *number > most)
		{
			refuseValue(longName(names), text, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
		}
		take(*number);
	};
	return app.add_option_function<std::string>(names, check, help)->type_name("N");
}

CLI::Option* addWhole(CLI::App& app, const std::string& names, int& value, int least, int most, const std::string& help)
{
	return addWhole(
		app, names, [&value](int number) { value = number; }, least, most, help);
}

CLI::Option* addLong(CLI::App& app, const std::string& names, const std::function<void(uint64_t)>& take, uint64_t least,
					 uint64_t most, const std::string& help)
{
	const auto check = [take, names, least, most](const std::string& text)
	{
		const std::optional<uint64_t> number = parsed<uint64_t>(text);
		if (!number || *number < least || *number > most)
		{
			refuseValue(longName(names), text, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
		}
		take(*number);
	};
	return app.add_option_function<std::string>(names, check, help)->type_name("N");
}

CLI::Option* addSeed(CLI::App& app, uint32_t& value)
{
	const auto take = [&value](const std::string& text)
	{
		const std::optional<uint32_t> number = parsed<uint32_t>(text);
		if (!number)
		{
			refuseValue("--seed", text, "a whole number from 0 to 4294967295");
		}
		value = *number;
	};
	return app.add_option_function<std::string>("--seed", take, "Seed of everything random (default 1)")->type_name("S");
}

CLI::Option* addNumber(CLI::App& app, const std::string& names, const std::function<void(double)>& take, double least, double most,
					   const std::string& help)
{
	const auto check = [take, names, least, most](const std::string& text)
	{
		const std::optional<double> number = parsed<double>(text);
		if (!number || !(*number >= least && *number <= most))
		{
			refuseValue(longName(names), text, "a number from " + numberText(least) + " to " + numberText(most));
		}
		take(*number);
	};
	return app.add_option_function<std::string>(names, check, help)->type_name("X");
}

CLI::Option* addNumber(CLI::App& app, const std::string& names, double& value, double least, double most, const std::string& help)
{
	return addNumber(
		app, names, [&value](double number) { value = number; }, least, most, help);
}

CLI::Option* addMatrix(CLI::App& app, const std::string& names, std::optional<glm::dmat4>& value, const std::string& help)
{
	const auto take = [&value, names](const std::string& text)
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
			const std::optional<double> number = parsed<double>(text.substr(at, end - at));
			if (!number || !std::isfinite(*number))
			{
				refuseValue(longName(names), text.substr(at, end - at), "16 finite numbers, column by column, with commas between");
			}
			if (count < 16)
			{
				matrix[count / 4][count % 4] = *number;
			}
			count += 1;
		}
		if (count != 16)
		{
			refuseValue(longName(names), std::to_string(count) + (count == 1 ? " number" : " numbers"),
						"16 finite numbers, column by column, with commas between");
		}
		value = matrix;
	};
	return app.add_option_function<std::string>(names, take, help)->type_name("16 NUMBERS");
}

CLI::Option* addDomain(CLI::App& app, Domain& value, const std::string& help)
{
	return addChoiceText(
		app, "--domain", patternDomains(), [&value](std::size_t i) { value = static_cast<Domain>(i); }, help);
}

CLI::Option* addChoiceText(CLI::App& app, const std::string& option, std::span<const std::string_view> names,
						   const std::function<void(std::size_t)>& choose, const std::string& help)
{
	std::string listed;
	std::string spoken;
	for (std::size_t i = 0; i < names.size(); ++i)
	{
		listed += std::string(i == 0 ? "" : "|") + std::string(names[i]);
		spoken += std::string(i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + std::string(names[i]);
	}
	const auto take = [option, names = std::vector(names.begin(), names.end()), choose, spoken](const std::string& text)
	{
		const auto found = std::find(names.begin(), names.end(), text);
		if (found == names.end())
		{
			refuseValue(option, text, spoken);
		}
		choose(static_cast<std::size_t>(found - names.begin()));
	};
	return app.add_option_function<std::string>(option, take, help)->type_name(listed);
}

CLI::Option* addCounts(CLI::App& app, const std::string& option, CountRange& value, int most, const std::string& help)
{
	const auto take = [&value, option, most](const std::string& text)
	{
		const std::size_t dash = text.find('-');
		const std::optional<int> first = parsed<int>(text.substr(0, dash));
		const std::optional<int> last = dash == std::string::npos ? first : parsed<int>(text.substr(dash + 1));
		if (!first || !last || *first < 1 || *last < *first || *last > most)
		{
			refuseValue(option, text, "FIRST-LAST or one number, from 1 to " + std::to_string(most));
		}
		value = {*first, *last};
	};
	return app.add_option_function<std::string>(option, take, help)->type_name("FIRST-LAST");
}

void addJson(CLI::App& app, std::string& json)
{
	addText(app, "--json", json, "FILE", "Machine-readable summary; - is standard output");
}

void addOutputs(CLI::App& app, Outputs& outputs, std::span<const std::string_view> endings)
{
	std::string listed;
	for (const std::string_view ending : endings)
	{
		listed += " " + std::string(ending);
	}
	const auto take = [&outputs](const std::vector<std::string>& files)
	{
		for (const std::string& file : files)
		{
			if (file.empty() || (file.size() > 1 && file[0] == '-'))
			{
				refuseValue("-o", file, "FILE");
			}
		}
		outputs.files = files;
	};
	app.add_option_function<std::vector<std::string>>("-o,--output", take,
													  "File to write, may be repeated; its ending picks the format:" + listed)
		->type_name("FILE")
		->allow_extra_args(false);
	addJson(app, outputs.json);
	addText(app, "--depfile", outputs.depfile, "FILE", "Lists the files that were read, as a rule for Make or Ninja");
}

CLI::Option* addThreads(CLI::App& app, int& threads)
{
	return addWhole(app, "--threads", threads, 1, 1024,
					"Threads, 1 to 1024 (default: all processors); never changes a byte of what is made");
}

CLI::Option* addProgress(CLI::App& app, std::string& progress)
{
	return addText(app, "--progress", progress, "FILE",
				   "Stages, shares done and seconds left while it works, a JSON object a line; - is standard output");
}

namespace
{

constexpr const char* kUnitCacheHelp =
	"Keeps what is done while it works: a run that was killed goes on where it was, with the same bytes";

} // namespace

void addUnitCache(CLI::App& app)
{
	const auto check = [](const std::string& folder)
	{
		checkText("--cache", folder, "FOLDER");
	};
	app.add_option_function<std::string>("--cache", check, kUnitCacheHelp)->type_name("FOLDER");
}

const CLI::Option* givenUnitCache(const CLI::App& app)
{
	const CLI::Option* const option = app.get_option_no_throw("--cache");
	return option != nullptr && option->count() > 0 && option->get_description() == kUnitCacheHelp ? option : nullptr;
}

CLI::Option* addPart(CLI::App& app, std::optional<PartNumber>& part)
{
	const auto take = [&part](const std::string& text)
	{
		const std::size_t slash = text.find('/');
		const int of = slash == std::string::npos ? 0 : parsed<int>(text.substr(slash + 1)).value_or(0);
		const int number = parsed<int>(text.substr(0, slash)).value_or(0);
		if (number < 1 || number > of || of > kMostParts)
		{
			refuseValue("--part", text, "K/N, whole numbers with 1 <= K <= N <= " + std::to_string(kMostParts));
		}
		part = PartNumber{number, of};
	};
	return app
		.add_option_function<std::string>(
			"--part", take,
			"The Kth of N shares of the work, into the one file of -o (NAME.part); nook merge puts them "
			"together")
		->type_name("K/N");
}

void checkPartOutputs(const Outputs& outputs, const std::vector<std::string>& inputs)
{
	static constexpr std::array<std::string_view, 1> kPartFormats{".part"};
	const bool others = !outputs.json.empty() || !outputs.depfile.empty();
	if (outputs.files.size() != 1 || others)
	{
		throw Error(ExitCode::usage, std::string("--part: found ") +
										 (others                  ? outputs.json.empty() ? "--depfile" : "--json"
										  : outputs.files.empty() ? "no output"
																  : "several outputs") +
										 ", expected -o NAME.part alone");
	}
	formatOf(outputs.files.front(), kPartFormats);
	checkNames(outputs, inputs);
}

void checkOutputs(const Outputs& outputs, std::span<const std::string_view> endings, const std::vector<std::string>& inputs)
{
	if (outputs.part)
	{
		checkPartOutputs(outputs, inputs);
		return;
	}
	if (outputs.files.empty() && outputs.json.empty())
	{
		throw Error(ExitCode::usage, "-o: nothing to write, expected -o FILE or --json FILE");
	}
	const bool to_files =
		std::any_of(outputs.files.begin(), outputs.files.end(), [](const std::string& path) { return path != "-"; });
	if (!outputs.depfile.empty() && !to_files)
	{
		throw Error(ExitCode::usage, "--depfile: nothing depends on the files read, expected -o FILE as well");
	}
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

void checkDistinct(const std::vector<std::string>& written, const std::vector<std::string>& read)
{
	if (written.empty())
	{
		return;
	}
	std::unordered_map<std::string, std::string> seen; // name by identity
	for (const std::string& path : read)
	{
		if (!path.starts_with(kBuiltinPrefix))
		{
			seen.try_emplace(fileIdentity(path), path);
		}
	}
	for (const std::string& path : written)
	{
		const auto [other, is_new] = seen.try_emplace(fileIdentity(path), path);
		if (!is_new)
		{
			const std::string found = other->second == path ? "named twice" : "found the same file as " + other->second;
			throw Error(ExitCode::usage, path + ": " + found + ", expected another file for every input and output");
		}
	}
}

void checkName(const std::string& name)
{
	if (!name.empty() && !isIdentifier(name))
	{
		refuseValue("--name", name, "letters, digits and single underscores, a letter first");
	}
}

void addSide(OutputSet& files, const Outputs& outputs, const std::string& summary, const std::vector<std::string>& read)
{
	if (!outputs.json.empty())
	{
		files.add(outputs.json, summary);
	}
	if (!outputs.depfile.empty())
	{
		files.add(outputs.depfile, depfileOf(outputs, read));
	}
}

} // namespace nook
