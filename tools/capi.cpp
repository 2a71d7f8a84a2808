// SPDX-License-Identifier: GPL-3.0-or-later
// The C API, include/nook/nook.h: handles, arrays of callers and errors around the calls of verbs (call.h).
//
// A handle is a number that is never used again, not an address: whatever a caller passes, the library finds its object or knows
// that there is none, and an object lives as long as a call uses it.
#include "call.h"
#include "scene_options.h"

#include "core/decimal.h"
#include "core/image.h"
#include "core/lists.h"
#include "core/parallel.h"
#include "core/text.h"
#include "nook/nook.h"
#include "scene/load_parts.h"
#include "version.h"

#include <algorithm>
#include <any>
#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <new>

namespace nook
{
namespace
{

struct Cancelled
{
	const char* why;
};

thread_local std::string t_error;

// A folder that goes with the last copy of its path.
using Folder = std::shared_ptr<const std::string>;
Folder temporaryFolder()
{
	const auto remove = [](const std::string* path)
	{
		std::error_code ignored;
		std::filesystem::remove_all(*path, ignored);
		delete path; // NOLINT: of a shared pointer
	};
	auto path = std::make_unique<std::string>((std::filesystem::temp_directory_path() / "nook-XXXXXX").string());
	refuseIf(::mkdtemp(path->data()) == nullptr, *path + ": cannot be created, expected a folder for temporary files (TMPDIR)",
			 ExitCode::file);
	return {path.release(), remove};
}

struct OptionsData
{
	std::mutex mutex;
	std::vector<std::pair<std::string, std::string>> values;
	std::vector<Folder> folders;
	nook_progress progress = nullptr;
	void* user = nullptr;
};

struct LevelData
{
	std::string name;               // of the file, or empty
	std::vector<std::string> words; // options that it was loaded with
	std::shared_ptr<const LoadedLevel> loaded;
	std::vector<uint32_t> vertices; // of a level from arrays: the index of each vertex among those given
	std::size_t given = 0;          // how many these were
};

struct ResultData
{
	std::vector<MadeArray> arrays;
	std::map<std::string, std::string, std::less<>> files; // by ending
	std::string facts;
	std::string warnings;
};

class Handles
{
public:
	// Throws Error (usage) where a handle is none, or of something else.
	template <class Data> std::shared_ptr<Data> find(const void* handle, const char* what)
	{
		const std::lock_guard lock(m_mutex);
		const auto found = m_objects.find(handle);
		const auto* const data = found != m_objects.end() ? std::any_cast<std::shared_ptr<Data>>(&found->second) : nullptr;
		refuseIf(data == nullptr,
				 std::string(what) + ": found " + (handle == nullptr ? "null" : "no handle that is in use") + ", expected " + what);
		return *data;
	}
	template <class Handle, class Data> void add(Handle** to, std::shared_ptr<Data> data)
	{
		const std::lock_guard lock(m_mutex);
		m_last += 16;
		const auto handle = reinterpret_cast<Handle*>(m_last); // NOLINT: a number
		m_objects.emplace(handle, std::move(data));
		*to = handle;
	}
	void remove(const void* handle) noexcept
	{
		std::map<const void*, std::any>::node_type last; // destroyed after the lock
		const std::lock_guard lock(m_mutex);
		last = m_objects.extract(handle);
	}

private:
	std::mutex m_mutex;
	std::map<const void*, std::any> m_objects; // shared pointers
	uintptr_t m_last = 4096;
};

Handles& handles()
{
	static Handles* const all = new Handles; // never destroyed: threads may outlive main()
	return *all;
}

void require(const void* pointer, const char* what)
{
	refuseIf(pointer == nullptr, std::string(what) + ": found null, expected a pointer");
}

nook_status failed(nook_status status, const char* message) noexcept
{
	try
	{
		t_error = oneLine(message);
	}
	catch (...)
	{
		t_error.clear();
	}
	return status;
}

// Runs a function of the API: no exception passes.
template <class Body> nook_status guarded(const Body& body) noexcept
{
	try
	{
		t_error.clear();
		body();
		return NOOK_OK;
	}
	catch (const Cancelled& cancelled)
	{
		return failed(NOOK_CANCELLED, cancelled.why);
	}
	catch (const Error& error)
	{
		return failed(static_cast<nook_status>(error.code()), error.what());
	}
	catch (const std::bad_alloc&)
	{
		return failed(NOOK_FAILED, "memory: found none left, expected a smaller task");
	}
	catch (const std::exception& error)
	{
		return failed(NOOK_FAILED, error.what());
	}
	catch (...)
	{
		return failed(NOOK_FAILED, "found an error of another kind, expected none");
	}
}

// ---- Arrays of callers ----

constexpr uint64_t kAny = 0;                        // of a dimension
constexpr uint64_t kMostItems = uint64_t{1} << 40U; // of an array; more is a mistake
constexpr double kMostFloat = 3e38;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// An array whose type and shape are sound.
class GivenArray
{
public:
	// Throws Error (usage).
	GivenArray(const nook_array* array, const char* name, std::initializer_list<uint64_t> shape) : m_name(name)
	{
		require(array, name);
		m_array = *array;
		bool good = m_array.dimensions == std::ssize(shape) && m_array.type >= NOOK_FLOAT32 && m_array.type <= NOOK_UINT64 &&
					m_array.data != nullptr;
		std::string found = "type " + std::to_string(m_array.type) + (m_array.data == nullptr ? " without data" : "") + " of shape";
		std::string expected = "a type of nook_type of shape";
		for (std::size_t i = 0; i < shape.size(); ++i)
		{
			const uint64_t count = m_array.shape[i];
			const uint64_t wanted = *(shape.begin() + i);
			good = good && count > 0 && (wanted == kAny || count == wanted) && count <= kMostItems / m_items;
			m_items *= good ? count : 1;
			found += static_cast<int64_t>(i) < m_array.dimensions ? " " + std::to_string(count) : "";
			expected += wanted == kAny ? " any" : " " + std::to_string(wanted);
		}
		refuseIf(!good,
				 m_name + ": found " + std::to_string(m_array.dimensions) + " dimensions, " + found + ", expected " + expected);
	}

	uint64_t along(std::size_t dimension) const
	{
		return m_array.shape[dimension];
	}
	bool isWhole() const
	{
		return m_array.type > NOOK_FLOAT64;
	}

	// Calls take(item, number) for all items in order, which are from `least` to `most`; else throws Error (invalid_input).
	// Anything passes where `most` is kNoLimit.
	template <class Take> void visit(double least, double most, const Take& take) const
	{
		constexpr std::array kReaders{&numberAt<float>,    &numberAt<double>,  &numberAt<uint8_t>, &numberAt<int32_t>,
									  &numberAt<uint32_t>, &numberAt<int64_t>, &numberAt<uint64_t>};
		const auto read = kReaders[static_cast<std::size_t>(m_array.type - NOOK_FLOAT32)];
		for (uint64_t item = 0; item < m_items; ++item)
		{
			const double number = read(m_array.data, item);
			if (!(number >= least && number <= most) && most < kNoLimit)
			{
				throw Error(ExitCode::invalid_input, m_name + ": row " + std::to_string(item / (m_items / m_array.shape[0])) +
														 ": found " + numberText(number) + ", expected numbers from " +
														 numberText(least) + " to " + numberText(most));
			}
			take(item, number);
		}
	}

	// Rows of as many numbers as a vector has.
	template <class Vector> std::vector<Vector> vectors(double least, double most) const
	{
		constexpr auto kLength = static_cast<uint64_t>(Vector::length());
		std::vector<Vector> rows(m_items / kLength);
		visit(least, most,
			  [&](uint64_t item, double number)
			  { rows[item / kLength][static_cast<int>(item % kLength)] = static_cast<typename Vector::value_type>(number); });
		return rows;
	}

private:
	template <class Number> static double numberAt(const void* data, uint64_t item)
	{
		Number value{};
		std::memcpy(&value, static_cast<const char*>(data) + item * sizeof value, sizeof value); // may be misaligned
		return static_cast<double>(value);
	}

	std::string m_name;
	nook_array m_array{};
	uint64_t m_items = 1;
};

// A picture of one channel; absolute values to `most`.
Image imageOf(const nook_array* array, const char* name, const char* channel, double most)
{
	const GivenArray given(array, name, {kAny, kAny});
	refuseIf(given.along(0) > kMaxImageValues / given.along(1), std::string(name) + ": found " + std::to_string(given.along(1)) +
																	"x" + std::to_string(given.along(0)) +
																	" pixels, expected at most " + std::to_string(kMaxImageValues));
	Image image{static_cast<int>(given.along(1)), static_cast<int>(given.along(0)), {channel}, {}, {}, {}};
	image.values.resize(given.along(0) * given.along(1));
	given.visit(-most, most, [&image](uint64_t item, double number) { image.values[item] = static_cast<float>(number); });
	return image;
}

// Writes a matrix as the program's options take it.
std::string matrixText(const nook_array* array, const char* name)
{
	std::string text;
	GivenArray(array, name, {16})
		.visit(-1e300, 1e300, [&text](uint64_t i, double number) { text += (i == 0 ? "" : ",") + numberText(number); });
	return text;
}

// ---- Calls ----

// Passes progress on, and throws once the callback has asked to cancel. While it runs, reports of other threads are left out: they
// must not wait for a callback that makes a call of its own, whose loops may take up their work.
Progress progressOf(nook_progress callback, void* user)
{
	struct State
	{
		std::atomic_flag busy;
		std::atomic<const char*> cancelled = nullptr;
	};
	if (callback == nullptr)
	{
		return {};
	}
	return [callback, user, state = std::make_shared<State>()](std::string_view stage, double share)
	{
		if (state->cancelled == nullptr && !state->busy.test_and_set())
		{
			try
			{
				if (callback(user, std::string(stage).c_str(), share) != 0)
				{
					state->cancelled = "cancelled by the progress callback";
				}
			}
			catch (...)
			{
				state->cancelled = "progress: found a callback that throws, expected one that returns";
			}
			state->busy.clear();
		}
		if (const char* const why = state->cancelled; why != nullptr && share < 1.0)
		{
			throw Cancelled{why};
		}
	};
}

// Options of files and of text, of which a call makes none.
constexpr std::array<std::string_view, 8> kOfFiles{"json", "depfile", "progress", "cache", "share", "timing", "help", "diff"};

// A copy of a caller's options.
struct GivenOptions
{
	explicit GivenOptions(const nook_options* options)
	{
		if (options == nullptr)
		{
			return;
		}
		data = handles().find<OptionsData>(options, "options");
		const std::lock_guard lock(data->mutex);
		for (const auto& [name, value] : data->values)
		{
			const std::string start = "--" + name + "=";
			std::string* const before = firstWhere(words, [&start](const std::string& word) { return word.starts_with(start); });
			if (name == "output")
			{
				endings.push_back(value);
			}
			else if (name == "patterns" && before != nullptr)
			{
				*before += "," + value;
			}
			else
			{
				words.push_back(start + value);
			}
		}
		progress = progressOf(data->progress, data->user);
	}

	// Throws Error (usage) for options that `app` does not have, too.
	void parse(CLI::App& app, std::vector<std::string> all) const
	{
		for (const std::string& word : words)
		{
			const std::string name = word.substr(2, word.find('=') - 2);
			refuseValueIf(app.get_option_no_throw("--" + name) == nullptr ||
							  std::find(kOfFiles.begin(), kOfFiles.end(), name) != kOfFiles.end(),
						  "option", name, "one that this call has");
			all.push_back(word);
		}
		try
		{
			std::reverse(all.begin(), all.end()); // the last first, as CLI11 takes them
			app.parse(std::move(all));
		}
		catch (const CLI::ParseError& error)
		{
			refuse(error.what());
		}
	}

	std::shared_ptr<OptionsData> data; // keeps its files
	std::vector<std::string> words;    // "--rays=64"
	std::vector<std::string> endings;
	Progress progress;
};

// Values per vertex in the order of the caller's vertices; NaN for those without a triangle.
void orderAsGiven(const LevelData& level, std::vector<MadeArray>& arrays)
{
	const bool is_split =
		std::any_of(arrays.begin(), arrays.end(), [](const MadeArray& array) { return array.name == "triangles"; });
	if (level.given == level.vertices.size() || is_split)
	{
		return;
	}
	for (MadeArray& array : arrays)
	{
		if (array.type != NOOK_FLOAT32 || array.shape[0] != level.vertices.size())
		{
			continue;
		}
		const std::size_t columns = array.shape.size() > 1 ? array.shape[1] : 1;
		const auto all = std::make_shared<std::vector<float>>(level.given * columns, std::numeric_limits<float>::quiet_NaN());
		const auto* const values = static_cast<const float*>(array.data.get());
		for (std::size_t i = 0; i < level.vertices.size(); ++i)
		{
			std::copy_n(values + i * columns, columns, all->begin() + static_cast<std::ptrdiff_t>(level.vertices[i] * columns));
		}
		array.shape[0] = level.given;
		array.data = {all, all->data()};
	}
}

// A verb to run: what it works on, and its words before options.
struct Prepared
{
	Call call;
	std::vector<std::string> words;
	std::shared_ptr<const LevelData> level;
	bool per_vertex = false; // its arrays of floats are per vertex of the level

	void take(const nook_level* handle, bool gives_vertices = false)
	{
		per_vertex = gives_vertices;
		level = handles().find<LevelData>(handle, "level");
		call.level = level->loaded;
		words.push_back(level->name.empty() ? "arrays" : level->name);
		append(words, level->words);
	}
};

void runCalled(Verb (*add)(CLI::App& app), Prepared& prepared, const GivenOptions& options, nook_result** result)
{
	const Folder folder = temporaryFolder();
	const std::string facts = *folder + "/facts";
	prepared.words.push_back("--json=" + facts);
	for (const std::string& ending : options.endings)
	{
		refuseValueIf(ending.size() < 2 || ending[0] != '.' || ending.find('/') != std::string::npos, "output", ending,
					  "the ending of a file: .json");
		prepared.words.push_back("--output=" + *folder + "/result" + ending);
	}
	CLI::App app;
	const Verb verb = add(app);
	std::exception_ptr difference; // which leaves a result
	try
	{
		prepared.call.progress = options.progress;
		const Working working(prepared.call);
		options.parse(*verb.app, prepared.words);
		VerbProgress progress;
		verb.run(progress);
	}
	catch (const Error& error)
	{
		if (error.code() != ExitCode::difference)
		{
			throw;
		}
		difference = std::current_exception();
	}
	const auto data = std::make_shared<ResultData>();
	data->facts = readFile(facts);
	for (const std::string& ending : options.endings)
	{
		data->files[ending] = readFile(*folder + "/result" + ending);
	}
	data->arrays = std::move(prepared.call.arrays);
	if (prepared.per_vertex)
	{
		orderAsGiven(*prepared.level, data->arrays);
	}
	data->warnings = joinedText(prepared.call.warnings, "\n");
	handles().add(result, data);
	if (difference)
	{
		std::rethrow_exception(difference);
	}
}

// Runs a verb and gives its result. `prepare` takes the caller's arrays and level.
template <class Prepare>
nook_status called(Verb (*add)(CLI::App& app), const nook_options* options, nook_result** result, const Prepare& prepare) noexcept
{
	const auto body = [&]
	{
		require(result, "result");
		Prepared prepared;
		prepare(prepared);
		const GivenOptions given(options);
		if (prepared.level != nullptr)
		{
			CLI::App loading;
			LoadSettings load;
			addLoadOptions(loading, load);
			for (const std::string& word : given.words)
			{
				const std::string name = word.substr(2, word.find('=') - 2);
				refuseIf(loading.get_option_no_throw("--" + name) != nullptr,
						 name + ": found with a level that is loaded, expected it where the level is");
			}
		}
		runCalled(add, prepared, given, result);
	};
	return guarded(body);
}

void setOption(nook_options* options, const char* name, const std::string& value)
{
	const auto data = handles().find<OptionsData>(options, "options");
	require(name, "name");
	const std::lock_guard lock(data->mutex);
	data->values.emplace_back(name, value);
}

Level levelOf(const nook_array* positions, const nook_array* triangles, const nook_array* normals, const nook_array* uvs,
			  const std::string& name, bool two_sided)
{
	Level level;
	level.name = name;
	level.positions = GivenArray(positions, "positions", {kAny, 3}).vectors<glm::dvec3>(-kFarthest_m, kFarthest_m);
	const std::size_t vertices = level.positions.size();
	const GivenArray corners(triangles, "triangles", {kAny, 3});
	refuseIf(!corners.isWhole() || corners.along(0) > kMaxTriangles || vertices > 3 * kMaxTriangles,
			 "triangles: found " + std::to_string(corners.along(0)) + " of " + std::to_string(vertices) + " vertices" +
				 (corners.isWhole() ? "" : " as floating-point numbers") + ", expected whole numbers, at most " +
				 std::to_string(kMaxTriangles));
	level.triangles = corners.vectors<glm::uvec3>(0.0, static_cast<double>(vertices - 1));
	level.normals = normals != nullptr ? GivenArray(normals, "normals", {vertices, 3}).vectors<glm::vec3>(-1e15, 1e15)
									   : std::vector<glm::vec3>(vertices, glm::vec3(0.0F));
	for (glm::vec3& normal : level.normals)
	{
		const double length = glm::length(glm::dvec3(normal));
		normal = length > 0.0 ? glm::vec3(glm::dvec3(normal) / length) : normal;
	}
	level.uvs = uvs != nullptr ? GivenArray(uvs, "uvs", {vertices, 2}).vectors<glm::vec2>(-1e9, 1e9)
							   : std::vector<glm::vec2>(vertices, glm::vec2(0.0F));
	level.material_list.emplace_back().two_sided = two_sided;
	level.materials.resize(level.triangles.size(), 0);
	level.meshes.push_back({name, 0, level.triangles.size()});
	return level;
}

} // namespace

} // namespace nook

using namespace nook;

nook_status nook_require(uint32_t abi)
{
	const auto body = [abi]
	{
		refuseIf(abi != NOOK_ABI,
				 "nook " NOOK_VERSION ": found an interface of version " + std::to_string(NOOK_ABI) + ", expected " +
					 std::to_string(abi),
				 static_cast<ExitCode>(NOOK_WRONG_VERSION));
	};
	return guarded(body);
}

const char* nook_version()
{
	return NOOK_VERSION;
}

const char* nook_error()
{
	return t_error.c_str();
}

nook_status nook_options_create(nook_options** options)
{
	const auto body = [&]
	{
		require(options, "options");
		handles().add(options, std::make_shared<OptionsData>());
	};
	return guarded(body);
}

void nook_options_destroy(nook_options* options)
{
	handles().remove(options);
}

nook_status nook_options_set(nook_options* options, const char* name, const char* value)
{
	const auto body = [&]
	{
		require(value, "value");
		setOption(options, name, value);
	};
	return guarded(body);
}

nook_status nook_options_number(nook_options* options, const char* name, double value)
{
	return guarded([&] { setOption(options, name, numberText(value)); });
}

nook_status nook_options_file(nook_options* options, const char* name, const char* file_name, const void* bytes, size_t size)
{
	const auto body = [&]
	{
		require(file_name, "file_name");
		require(bytes, "bytes");
		const std::string file = file_name;
		refuseValueIf(file.empty() || file[0] == '.' || file[0] == '-' || file.find_first_of("/,") != std::string::npos,
					  "file_name", file, "a name without folder and comma: disk.json");
		refuseIf(size > kMaxFileBytes,
				 "size: found " + std::to_string(size) + " bytes, expected at most " + std::to_string(kMaxFileBytes));
		const Folder folder = temporaryFolder();
		const std::string path = *folder + "/" + file;
		writeFile(path, {static_cast<const char*>(bytes), size});
		const auto data = handles().find<OptionsData>(options, "options");
		setOption(options, name, path);
		const std::lock_guard lock(data->mutex);
		data->folders.push_back(folder);
	};
	return guarded(body);
}

nook_status nook_options_progress(nook_options* options, nook_progress progress, void* user)
{
	const auto body = [&]
	{
		const auto data = handles().find<OptionsData>(options, "options");
		const std::lock_guard lock(data->mutex);
		data->progress = progress;
		data->user = user;
	};
	return guarded(body);
}

nook_status nook_level_create(const nook_array* positions, const nook_array* triangles, const nook_array* normals,
							  const nook_array* uvs, const nook_options* options, nook_level** level)
{
	const auto body = [&]
	{
		require(level, "level");
		const GivenOptions given(options);
		CLI::App app;
		std::string name = "arrays";
		bool strict = false;
		bool two_sided = false;
		int threads = availableThreads();
		addOptions(app, {{"--name", takesText(name, "NAME"), "Of the level, for files made of it"},
						 {"--strict", takesFlag(strict), "Anything odd that is found in the level is an error"},
						 {"--two-sided", takesFlag(two_sided), "Triangles are seen from both sides"},
						 threadsRow(threads)});
		given.parse(app, {});
		Level arrays = levelOf(positions, triangles, normals, uvs, name, two_sided);
		const auto data = std::make_shared<LevelData>();
		data->given = arrays.positions.size();
		data->loaded =
			std::make_shared<LoadedLevel>(loadLevel(std::move(arrays), strict, data->vertices, {threads, given.progress, nullptr}));
		handles().add(level, data);
	};
	return guarded(body);
}

nook_status nook_level_load(const char* path, const nook_options* options, nook_level** level)
{
	const auto body = [&]
	{
		require(path, "path");
		require(level, "level");
		const GivenOptions given(options);
		CLI::App app;
		LoadSettings load;
		int threads = availableThreads();
		addLoadOptions(app, load);
		addOptions(app, {threadsRow(threads)});
		given.parse(app, {});
		const auto data = std::make_shared<LevelData>();
		data->name = (path[0] == '-' ? "./" : "") + std::string(path); // not an option of later calls
		data->words = given.words;
		std::erase_if(data->words, [](const std::string& word) { return word.starts_with("--threads="); });
		data->loaded = std::make_shared<LoadedLevel>(loadLevel(data->name, load, {threads, given.progress, nullptr}));
		handles().add(level, data);
	};
	return guarded(body);
}

nook_status nook_level_describe(const nook_level* level, nook_result** result)
{
	const auto body = [&]
	{
		require(result, "result");
		const auto loaded = handles().find<LevelData>(level, "level")->loaded;
		const Level& described = loaded->level;
		Call call;
		{
			const Working working(call);
			give<double>("positions", described.positions, {described.positions.size(), 3});
			give<uint32_t>("triangles", described.triangles, {described.triangles.size(), 3});
			give<float>("normals", described.normals, {described.normals.size(), 3});
			give<float>("uvs", described.uvs, {described.uvs.size(), 2});
		}
		Facts facts = verbFacts("level");
		addLevelFacts(facts, *loaded);
		const auto data = std::make_shared<ResultData>();
		data->arrays = std::move(call.arrays);
		data->facts = facts.json();
		handles().add(result, data);
	};
	return guarded(body);
}

void nook_level_destroy(nook_level* level)
{
	handles().remove(level);
}

nook_status nook_run_pattern(const nook_options* options, nook_result** result)
{
	return called(addPatternVerb, options, result, [](Prepared&) {});
}

nook_status nook_run_tile(const nook_options* options, nook_result** result)
{
	return called(addTileVerb, options, result, [](Prepared&) {});
}

nook_status nook_run_emit(const nook_options* options, nook_result** result)
{
	return called(addEmitVerb, options, result, [](Prepared&) {});
}

nook_status nook_run_bake(const nook_level* level, const nook_options* options, nook_result** result)
{
	return called(addBakeVerb, options, result, [level](Prepared& prepared) { prepared.take(level, true); });
}

nook_status nook_run_volumes(const nook_level* level, const nook_options* options, nook_result** result)
{
	return called(addVolumesVerb, options, result, [level](Prepared& prepared) { prepared.take(level); });
}

nook_status nook_run_gbuffer(const nook_level* level, const nook_options* options, nook_result** result)
{
	return called(addGBufferVerb, options, result, [level](Prepared& prepared) { prepared.take(level); });
}

nook_status nook_run_visibility(const nook_level* level, const nook_array* positions, const nook_array* normals,
								const nook_options* options, nook_result** result)
{
	const auto prepare = [&](Prepared& prepared)
	{
		prepared.take(level);
		prepared.words.emplace_back("--points=points");
		using Vectors = std::vector<glm::dvec3>;
		const Vectors at = GivenArray(positions, "positions", {kAny, 3}).vectors<glm::dvec3>(-kFarthest_m, kFarthest_m);
		const Vectors about = GivenArray(normals, "normals", {at.size(), 3}).vectors<glm::dvec3>(-1e15, 1e15);
		for (std::size_t i = 0; i < at.size(); ++i)
		{
			const std::optional<ReferencePoint> point = pointOf(at[i], about[i]);
			refuseIf(!point, "normals: row " + std::to_string(i) + ": found no direction, expected a vector that is not 0",
					 ExitCode::invalid_input);
			prepared.call.points.push_back(*point);
		}
	};
	return called(addReferenceVerb, options, result, prepare);
}

nook_status nook_run_shade(const nook_array* depth, const nook_array* normals, const nook_array* projection,
						   const nook_array* world_to_camera, const nook_options* options, nook_result** result)
{
	const auto prepare = [&](Prepared& prepared)
	{
		Image image = imageOf(depth, "depth", "Z", kNoLimit);
		if (normals != nullptr)
		{
			const GivenArray given(normals, "normals",
								   {static_cast<uint64_t>(image.height_px), static_cast<uint64_t>(image.width_px), 3});
			image.channels = {"Z", "N.X", "N.Y", "N.Z"};
			std::vector<float> values;
			for (const glm::vec3& normal : given.vectors<glm::vec3>(-kMostFloat, kNoLimit))
			{
				values.insert(values.end(), {image.values[values.size() / 4], normal.x, normal.y, normal.z});
			}
			image.values = std::move(values);
		}
		prepared.call.images.emplace("arrays", std::move(image));
		prepared.words = {"arrays"};
		for (const auto& [matrix, name] : {std::pair(projection, "projection"), {world_to_camera, "world-to-camera"}})
		{
			if (matrix != nullptr)
			{
				prepared.words.push_back("--" + std::string(name) + "=" + matrixText(matrix, name));
			}
		}
	};
	return called(addShadeVerb, options, result, prepare);
}

nook_status nook_run_compare(const nook_array* test, const nook_array* reference, const nook_array* mask,
							 const nook_options* options, nook_result** result)
{
	const auto prepare = [&](Prepared& prepared)
	{
		Call& call = prepared.call;
		const Image& known =
			call.images.emplace("reference", imageOf(reference, "reference", "visibility", kMostFloat)).first->second;
		call.images.emplace("test", imageOf(test, "test", "visibility", kMostFloat));
		prepared.words = {"test", "reference"};
		if (mask != nullptr)
		{
			GivenArray(mask, "mask", {static_cast<uint64_t>(known.height_px), static_cast<uint64_t>(known.width_px)})
				.visit(-kMostFloat, kMostFloat, [&](uint64_t, double value) { call.counted.push_back(value != 0.0 ? 1 : 0); });
			refuseIf(std::count(call.counted.begin(), call.counted.end(), 1) == 0,
					 "mask: found zeros alone, expected a pixel that counts", ExitCode::invalid_input);
		}
	};
	return called(addCompareVerb, options, result, prepare);
}

nook_status nook_result_array(const nook_result* result, const char* name, nook_array* array)
{
	const auto body = [&]
	{
		require(name, "name");
		require(array, "array");
		const auto data = handles().find<ResultData>(result, "result");
		const MadeArray* const found = firstWhere(data->arrays, [name](const MadeArray& made) { return made.name == name; });
		refuseValueIf(found == nullptr, "array", name, "one that this result has (nook_result_name)");
		*array = {found->data.get(), found->type, static_cast<int32_t>(found->shape.size()), {}};
		std::copy(found->shape.begin(), found->shape.end(), array->shape);
	};
	return guarded(body);
}

const char* nook_result_name(const nook_result* result, size_t index)
{
	const char* name = nullptr;
	const auto body = [&]
	{
		const auto data = handles().find<ResultData>(result, "result");
		name = index < data->arrays.size() ? data->arrays[index].name.c_str() : nullptr;
	};
	guarded(body);
	return name;
}

nook_status nook_result_file(const nook_result* result, const char* ending, const char** bytes, size_t* size)
{
	const auto body = [&]
	{
		require(ending, "ending");
		require(bytes, "bytes");
		require(size, "size");
		const auto data = handles().find<ResultData>(result, "result");
		const auto found = data->files.find(std::string_view(ending));
		refuseValueIf(found == data->files.end(), "ending", ending, "one that was an \"output\" of the call");
		*bytes = found->second.data();
		*size = found->second.size();
	};
	return guarded(body);
}

nook_status nook_result_facts(const nook_result* result, const char** json, const char** warnings)
{
	const auto body = [&]
	{
		const auto data = handles().find<ResultData>(result, "result");
		if (json != nullptr)
		{
			*json = data->facts.c_str();
		}
		if (warnings != nullptr)
		{
			*warnings = data->warnings.c_str();
		}
	};
	return guarded(body);
}

void nook_result_destroy(nook_result* result)
{
	handles().remove(result);
}
