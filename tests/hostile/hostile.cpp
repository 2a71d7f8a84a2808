// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: nook_hostile NOOK CODES [--record] [--all] [--share N] [--slow FACTOR] [--only GROUP] [--write FOLDER]
// Writes hostile files (corpus.h) and runs nook on each. It must end by itself, in time proportional to the file's size, with the
// exit code recorded in CODES, at most one line of error, no remaining files or processes, and without reading anything elsewhere.
// --record writes CODES, with --only just that group; --all runs volumes and gbuffer on every level that can be read, else on some;
// --share: one file in N of each group of more than 50, and all of the others; --slow: for a build with sanitizers.
// --write runs nothing, and writes the first file of each case as FOLDER/GROUP/NUMBER.
#include "corpus.h"
#include "run.h"

#include "../hostile_pictures.h"
#include "../level_files.h"
#include "../temporary_folder.h"

#include "core/file.h"
#include "methods/recipes.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>

#include <arpa/inet.h>
#include <sys/inotify.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace nook::hostile
{
namespace
{

struct Settings
{
	std::string nook;
	std::string codes;
	bool record = false;
	bool all = false;
	std::size_t share = 1;
	double slow = 1.0;
	std::string only;
	std::string write; // folder
};

// Result of one file.
struct Result
{
	std::size_t index = 0;
	int code = -1;
	double processor_s = 0.0;
	long resident_kb = 0;
	double size_mb = 0.0;
};

// The folder outside and the listener: both detect access.
class Watched
{
public:
	explicit Watched(const TemporaryFolder& folder)
		: m_events(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)),
		  m_listener(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0))
	{
		bait.folder = folder / "bait";
		std::filesystem::create_directory(bait.folder);
		writeFile(bait.folder + "/a.mtl", "newmtl net\nd 0.5\n");
		writeFile(bait.folder + "/mask.png", blackPng(4, 4));
		writeFile(bait.folder + "/b.bin", cubeBuffer());
		sockaddr_in address{};
		address.sin_family = AF_INET;
		address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
		socklen_t size = sizeof address;
		if (::bind(m_listener, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(m_listener, 8) != 0 ||
			::getsockname(m_listener, reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
			::inotify_add_watch(m_events, bait.folder.c_str(), IN_OPEN | IN_ACCESS) < 0)
		{
			throw std::runtime_error("nobody can be listened for");
		}
		bait.port = ntohs(address.sin_port);
	}

	// Name of a file opened since the last call, or "".
	std::string opened()
	{
		alignas(inotify_event) std::array<char, 65536> buffer{};
		std::string name;
		for (ssize_t got = 0; (got = ::read(m_events, buffer.data(), buffer.size())) > 0;)
		{
			for (ssize_t at = 0; at < got;)
			{
				inotify_event event{};
				std::memcpy(&event, buffer.data() + at, sizeof event);
				if ((event.mask & IN_ISDIR) == 0)
				{
					name = buffer.data() + at + static_cast<ssize_t>(sizeof event);
				}
				at += static_cast<ssize_t>(sizeof event + event.len);
			}
		}
		return name;
	}

	bool connected() const
	{
		return ::accept(m_listener, nullptr, nullptr) >= 0;
	}

	Bait bait;

private:
	int m_events;
	int m_listener;
};

void problem(const Case& one, const std::string& verb, const std::string& text)
{
	std::cout << "FAILED: " + one.group + ": " + one.what.substr(0, 100) + ": " + verb + ": " + text + "\n" << std::flush;
}

// Valid UTF-8 without terminal control characters.
bool isPlain(const std::string& text)
{
	try
	{
		nlohmann::json(text).dump();
	}
	catch (const nlohmann::json::exception&)
	{
		return false;
	}
	return std::none_of(text.begin(), text.end(),
						[](char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7F; });
}

// One of several lanes: runs every nth file, each in its own folder.
class Lane
{
public:
	Lane(const Settings& settings, const std::string& folder) : m_settings(settings), m_folder(folder) {}

	bool take(std::size_t index, const Case& one, std::ostream& results)
	{
		const std::string level = write(one);
		Result result{index, -1, 0.0, 0, sizeMb(one)};
		const Ended info = tried(one, readerOf(one, level), one.codes, result.size_mb);
		results << index << ' ' << info.code << ' ' << info.processor_s << ' ' << info.resident_kb << ' ' << result.size_mb << '\n';
		const bool is_level = level.find(".json") == std::string::npos && level.find(".exr") == std::string::npos &&
							  level.find(".csv") == std::string::npos;
		if (info.code == 0 && is_level && !one.group.starts_with("volumes"))
		{
			m_levels += 1;
			if (m_settings.all || m_levels % 4 == 1)
			{
				tried(one, {m_settings.nook, "volumes", level, "--distance", "0.1", "-o", "out.glb"}, "03", result.size_mb + 100.0);
			}
			if (m_settings.all || m_levels % 16 == 1)
			{
				tried(one, {m_settings.nook, "gbuffer", level, "--camera", "auto:1", "--size", "8x8", "-o", "out.exr"}, "03",
					  result.size_mb + 100.0);
			}
		}
		std::filesystem::remove_all(m_folder + "/level");
		return m_failures == 0;
	}

private:
	// The command that reads the file without writing.
	std::vector<std::string> readerOf(const Case& one, const std::string& file) const
	{
		if (one.group.starts_with("plan/"))
		{
			return {m_settings.nook, "plan", "--status", "../level"};
		}
		if (one.group.starts_with("levels/"))
		{
			return {m_settings.nook, "plan", file, "--dry-run", "-o", "jobs"};
		}
		return {m_settings.nook, "info", file};
	}

	std::string write(const Case& one)
	{
		const std::string folder = m_folder + "/level";
		std::filesystem::create_directories(folder + "/in");
		std::filesystem::create_directories(m_folder + "/work");
		std::filesystem::current_path(m_folder + "/work");
		m_bytes = 0;
		for (const auto& [name, bytes] : one.files)
		{
			m_bytes += bytes.size();
			std::ofstream(folder + "/" + name, std::ios::binary) << bytes;
		}
		if (!one.link.empty())
		{
			std::filesystem::create_symlink("../../bait", folder + "/" + one.link);
		}
		return "../level/" + one.files.front().first;
	}

	double sizeMb(const Case& one) const
	{
		return 1e-6 * static_cast<double>(m_bytes) + one.decoded_mb;
	}

	Ended tried(const Case& one, const std::vector<std::string>& arguments, const std::string& codes, double size_mb)
	{
		const double most_s = m_settings.slow * (2.0 + size_mb / 100.0);
		const std::string& verb = arguments[1];
		const Ended ended = run(arguments, 15.0 * most_s);
		const auto bad = [&](const std::string& text)
		{
			m_failures += 1;
			problem(one, verb, text);
		};
		if (ended.code < 0 || codes.find(static_cast<char>('0' + ended.code)) == std::string::npos)
		{
			bad("found " + (ended.code < 0 ? ended.how : "exit code " + std::to_string(ended.code)) + ", expected one of " + codes +
				": " + ended.error);
		}
		if (ended.code != 0 && (std::count(ended.error.begin(), ended.error.end(), '\n') != 1 ||
								!ended.error.starts_with("nook: ") || ended.error.back() != '\n'))
		{
			bad("found '" + ended.error + "', expected one line");
		}
		if (ended.code == 0 ? !ended.error.empty() && !ended.error.starts_with("nook: warning: ") : !ended.out.empty())
		{
			bad("found output where none is expected: " + ended.error + ended.out);
		}
		if (!isPlain(ended.error) || !isPlain(ended.out))
		{
			bad("found bytes that steer a terminal, or no UTF-8: " + ended.error + ended.out);
		}
		if (ended.processor_s > most_s)
		{
			bad("found " + std::to_string(ended.processor_s) + " s of processor time, expected at most " + std::to_string(most_s));
		}
		if (ended.left_process)
		{
			bad("found a process that lives on");
		}
		const std::string expected = ended.code == 0 && arguments.back().starts_with("out.") ? arguments.back() : "";
		std::string found;
		for (const auto& entry : std::filesystem::directory_iterator("."))
		{
			found += entry.path().filename().string();
			std::filesystem::remove_all(entry.path());
		}
		if (found != expected)
		{
			bad("found the files '" + found + "', expected '" + expected + "'");
		}
		return ended;
	}

	const Settings& m_settings;
	std::string m_folder;
	std::size_t m_bytes = 0;
	std::size_t m_levels = 0;
	std::size_t m_failures = 0;
};

Seeds makeSeeds(const Settings& settings, const TemporaryFolder& folder)
{
	std::filesystem::current_path(folder / "bait/..");
	const std::vector<std::vector<std::string>> commands{
		{"pattern", "--domain", "disk", "--count", "2", "--starts", "1", "-o", "pattern.json", "-o", "pattern.csv"},
		{"tile", "--pattern", "pattern.json", "--size", "2", "--kind", "even", "-o", "tile.json"},
		{"tile", "--pattern", "pattern.json", "--size", "2", "--filter", "box:2", "--frames", "2", "--moves", "--starts", "1", "-o",
		 "frames.json"},
		{"volumes", "cube.obj", "--distance", "0.5", "--no-drop", "-o", "volumes.glb"},
		{"plan", "--shares", "3", "-o", "jobs", "--", "volumes", "cube.obj", "--distance", "0.5", "-o", "planned.glb"}};
	writeFile("cube.obj", cubeObj());
	for (std::vector<std::string> command : commands)
	{
		command.insert(command.begin(), settings.nook);
		const Ended ended = run(command, 100.0 * settings.slow);
		if (ended.code != 0)
		{
			throw std::runtime_error(command[1] + ": no seed: " + ended.error);
		}
	}
	// In the format of `nook fit`, without running it.
	writeFile("recipes.json",
			  recipesFile({*recipeFor(raysRecipes(), ShadeMethod::slices), *recipeFor(raysRecipes(), ShadeMethod::alchemy)}, "0"));
	Seeds seeds;
	for (const char* const name : {"pattern.json", "pattern.csv", "tile.json", "frames.json", "recipes.json", "volumes.glb"})
	{
		seeds[name] = readFile(name);
	}
	seeds["plan.json"] = readFile("jobs/plan.json");
	return seeds;
}

// Runs everything in lanes, each a process that adopts orphans of its programs; false if any lane failed.
bool runLanes(const Settings& settings, const Cases& cases, const std::vector<std::size_t>& chosen, const TemporaryFolder& folder,
			  std::size_t lanes)
{
	std::vector<pid_t> processes;
	for (std::size_t number = 0; number < lanes; ++number)
	{
		const pid_t process = ::fork();
		if (process != 0)
		{
			processes.push_back(process);
			continue;
		}
		const std::string own = folder / ("lane" + std::to_string(number));
		std::filesystem::create_directory(own);
		std::ofstream results(own + ".results");
		Lane lane(settings, own);
		bool good = true;
		for (std::size_t i = number; i < chosen.size(); i += lanes)
		{
			good = lane.take(chosen[i], cases[chosen[i]], results);
		}
		results.close();
		::_exit(good ? 0 : 1);
	}
	bool good = true;
	for (const pid_t process : processes)
	{
		int status = 0;
		::waitpid(process, &status, 0);
		good = good && status == 0;
	}
	return good;
}

std::vector<Result> readResults(const TemporaryFolder& folder, std::size_t lanes)
{
	std::vector<Result> results;
	for (std::size_t number = 0; number < lanes; ++number)
	{
		std::ifstream file(folder / ("lane" + std::to_string(number) + ".results"));
		for (Result one; file >> one.index >> one.code >> one.processor_s >> one.resident_kb >> one.size_mb;)
		{
			results.push_back(one);
		}
	}
	std::sort(results.begin(), results.end(), [](const Result& a, const Result& b) { return a.index < b.index; });
	return results;
}

// "3x41 0 3x2" for the codes of a group, in order.
std::string codesText(const std::vector<int>& codes)
{
	std::string text;
	for (std::size_t i = 0, end = 0; i < codes.size(); i = end)
	{
		for (end = i; end < codes.size() && codes[end] == codes[i]; ++end)
		{
		}
		text += (i == 0 ? "" : " ") + std::to_string(codes[i]) + (end - i > 1 ? "x" + std::to_string(end - i) : "");
	}
	return text;
}

// Parses that text.
std::vector<int> codesOf(const std::string& text)
{
	std::vector<int> codes;
	std::istringstream words(text);
	for (std::string word; words >> word;)
	{
		const std::size_t times = word.find('x');
		codes.insert(codes.end(), times == std::string::npos ? 1 : std::stoul(word.substr(times + 1)), std::stoi(word));
	}
	return codes;
}

// The codes of each group; empty if the file does not exist.
std::map<std::string, std::vector<int>> readCodes(const std::string& path)
{
	std::map<std::string, std::vector<int>> groups;
	std::ifstream file(path);
	for (std::string line; std::getline(file, line);)
	{
		groups[line.substr(0, line.find(' '))] = codesOf(line.substr(line.find(' ') + 1));
	}
	return groups;
}

void recordCodes(const Settings& settings, const Cases& cases, const std::vector<Result>& results)
{
	std::map<std::string, std::vector<int>> found;
	for (const Result& result : results)
	{
		found[cases[result.index].group].push_back(result.code);
	}
	// Keeps the codes of groups that did not run.
	std::map<std::string, std::vector<int>> groups =
		settings.only.empty() ? std::map<std::string, std::vector<int>>() : readCodes(settings.codes);
	for (auto& [group, codes] : found)
	{
		groups[group] = std::move(codes);
	}
	std::ofstream file(settings.codes);
	for (const auto& [group, codes] : groups)
	{
		file << group << ' ' << codesText(codes) << '\n';
	}
}

// Number of each case within its group.
std::vector<std::size_t> placesInGroups(const Cases& cases, std::map<std::string, std::size_t>& sizes)
{
	std::vector<std::size_t> places;
	for (const Case& one : cases)
	{
		places.push_back(sizes[one.group]++);
	}
	return places;
}

bool compareCodes(const Settings& settings, const Cases& cases, const std::vector<Result>& results)
{
	std::map<std::string, std::vector<int>> expected = readCodes(settings.codes);
	std::map<std::string, std::size_t> sizes;
	const std::vector<std::size_t> places = placesInGroups(cases, sizes);
	bool good = !expected.empty() && (!settings.only.empty() || sizes.size() == expected.size());
	for (const auto& [group, size] : sizes)
	{
		if (expected[group].size() != size)
		{
			std::cout << "FAILED: " << group << ": found " << size << " files, expected " << expected[group].size() << "\n";
			return false;
		}
	}
	for (const Result& result : results)
	{
		const Case& one = cases[result.index];
		const int code = expected[one.group][places[result.index]];
		if (result.code != code)
		{
			problem(one, "info", "found exit code " + std::to_string(result.code) + ", expected " + std::to_string(code));
			good = false;
		}
	}
	return good;
}

// The cases to run: all of small groups, one in N of the others.
std::vector<std::size_t> shareOf(const Cases& cases, std::size_t share)
{
	constexpr std::size_t kSmall = 50;
	std::map<std::string, std::size_t> sizes;
	const std::vector<std::size_t> places = placesInGroups(cases, sizes);
	std::vector<std::size_t> chosen;
	for (std::size_t i = 0; i < cases.size(); ++i)
	{
		if (sizes[cases[i].group] <= kSmall || places[i] % share == 0)
		{
			chosen.push_back(i);
		}
	}
	return chosen;
}

void printTable(const Cases& cases, const std::vector<Result>& results)
{
	std::map<std::string, std::vector<const Result*>> groups;
	for (const Result& result : results)
	{
		const std::string& group = cases[result.index].group;
		groups[group.substr(0, group.find('/'))].push_back(&result);
		groups["~all"].push_back(&result);
	}
	std::printf("| files | number | read | refused | slowest, s | largest, MB |\n| --- | --- | --- | --- | --- | --- |\n");
	for (const auto& [name, members] : groups)
	{
		const auto read = std::count_if(members.begin(), members.end(), [](const Result* one) { return one->code == 0; });
		double slowest = 0.0;
		long largest = 0;
		for (const Result* one : members)
		{
			slowest = std::max(slowest, one->processor_s);
			largest = std::max(largest, one->resident_kb);
		}
		std::printf("| %s | %zu | %zu | %zu | %.2f | %ld |\n", name == "~all" ? "all" : name.c_str(), members.size(),
					static_cast<std::size_t>(read), members.size() - static_cast<std::size_t>(read), slowest, largest / 1000);
	}
}

// Checks that the watch would detect an access.
bool seesBait(const Settings& settings, const TemporaryFolder& folder, Watched& watched)
{
	std::filesystem::create_directory(folder / "control");
	std::filesystem::current_path(folder / "control");
	writeFile("a.obj", "mtllib ../bait/a.mtl\nusemtl net\n" + cubeObj());
	const Ended ended = run({settings.nook, "info", "a.obj", "--allow-outside"}, 60.0 * settings.slow);
	return ended.code == 0 && watched.opened() == "a.mtl";
}

bool test(const Settings& settings)
{
	const TemporaryFolder folder;
	Watched watched(folder);
	Cases all;
	addGltf(all, watched.bait);
	addText(all);
	addPictures(all);
	addOurs(all, makeSeeds(settings, folder));
	addNames(all, watched.bait);
	Cases cases;
	std::copy_if(all.begin(), all.end(), std::back_inserter(cases),
				 [&](const Case& one) { return one.group.starts_with(settings.only); });
	if (!settings.write.empty())
	{
		for (std::size_t i = 0; i < cases.size(); ++i)
		{
			const std::string into = settings.write + "/" + cases[i].group.substr(0, cases[i].group.find('/'));
			std::filesystem::create_directories(into);
			std::ofstream(into + "/" + std::to_string(i), std::ios::binary) << cases[i].files.front().second;
		}
		return true;
	}
	watched.opened();
	const std::size_t lanes = static_cast<std::size_t>(std::max(1L, ::sysconf(_SC_NPROCESSORS_ONLN)));
	const std::vector<std::size_t> chosen = shareOf(cases, settings.share);
	bool good = runLanes(settings, cases, chosen, folder, lanes);
	const auto expect = [&](bool holds, const std::string& text)
	{
		if (!holds)
		{
			std::cout << "FAILED: " << text << "\n";
			good = false;
		}
	};
	const std::string opened = watched.opened();
	expect(opened.empty(), "outside of levels' folders: found that " + opened + " was opened, expected nothing");
	expect(!watched.connected(), "network: found a connection, expected none");
	expect(seesBait(settings, folder, watched),
		   "the watch: saw nothing where it should have, expected --allow-outside to open a file");
	const std::vector<Result> results = readResults(folder, lanes);
	expect(results.size() == chosen.size() && !chosen.empty(),
		   "found " + std::to_string(results.size()) + " results of " + std::to_string(chosen.size()) + " files");
	printTable(cases, results);
	std::fflush(stdout);
	if (settings.record)
	{
		recordCodes(settings, cases, results);
		return good;
	}
	return compareCodes(settings, cases, results) && good;
}

std::string absolute(const std::string& path)
{
	return std::filesystem::absolute(path).string();
}

// How much slower than a second per GB this machine allocates memory: 1 on most, 4 on some virtual machines.
double memorySlowness()
{
	constexpr std::size_t kBytes = 256U << 20U;
	void* const memory = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
	if (memory == MAP_FAILED)
	{
		return 1.0;
	}
	const std::clock_t begin = std::clock();
	for (std::size_t at = 0; at < kBytes; at += 4096)
	{
		static_cast<volatile char*>(memory)[at] = 1;
	}
	const double taken_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
	munmap(memory, kBytes);
	return std::max(1.0, 4.0 * taken_s);
}

} // namespace
} // namespace nook::hostile

int main(int argc, char** argv)
{
	nook::hostile::Settings settings;
	CLI::App app;
	app.add_option("NOOK", settings.nook)->required()->transform(nook::hostile::absolute);
	app.add_option("CODES", settings.codes)->required()->transform(nook::hostile::absolute);
	app.add_flag("--record", settings.record);
	app.add_flag("--all", settings.all);
	app.add_option("--share", settings.share)->check(CLI::PositiveNumber);
	app.add_option("--slow", settings.slow);
	app.add_option("--only", settings.only);
	app.add_option("--write", settings.write)->transform(nook::hostile::absolute);
	CLI11_PARSE(app, argc, argv);
	const double memory = nook::hostile::memorySlowness();
	if (memory > 1.0)
	{
		std::printf("memory comes %.1f times slower than a second a GB here: so much longer may a file take\n", memory);
		settings.slow *= memory;
	}
	return nook::hostile::test(settings) ? 0 : 1;
}
