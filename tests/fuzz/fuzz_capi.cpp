// SPDX-License-Identifier: GPL-3.0-or-later
// Programs of calls to the C API: the input chooses functions, handles, arrays and options, also wrong ones. Each call gives a
// status and a line, and nothing crashes.
#include "fuzz.h"

#include "nook/nook.h"

#include <array>
#include <limits>
#include <thread>
#include <vector>

namespace
{

using nook::fuzz::Bytes;

constexpr std::array kNames{"radius",   "rays",      "seed",      "domain",    "count",     "starts",    "order",
							"size",     "camera",    "eye",       "target",    "fov",       "method",    "radius",
							"rays",     "two-sided", "strict",    "threads",   "ignore",    "name",      "output",
							"distance", "up",        "unit",      "max-error", "occluders", "receivers", "falloff",
							"variants", "kind",      "max-error", "glsl",      "methods",   "detail",    ""};
constexpr std::array kValues{"1",      "2",      "4",    "0.5",   "0",      "-1",      "nan",     "disk",   "ball",
							 "main",   "auto:1", "8x8",  "true",  "false",  "vo-line", "alchemy", "slices", "0,1,2",
							 ".json",  ".csv",   ".glb", ".glsl", ".exr",   "330",     "*",       "arrays", "constant",
							 "linear", "1e300",  "",     "even",  "statvo", "a,b",     "../.x",   "16"};

constexpr std::array kLevels{"builtin:cornell", "builtin:heightfield:-1", "none.obj", "", ".", "builtin:"};
constexpr std::array kNumbers{0.5, 2.0, -1.0, 0.0, 1e300, std::numeric_limits<double>::quiet_NaN()};

// An array whose memory holds what its type and shape promise; where they promise too much there is none.
class Array
{
public:
	explicit Array(Bytes& bytes)
	{
		const auto kind = bytes.number<std::uint8_t>();
		m_array.type = kind % 8 == 0 ? bytes.number<std::int32_t>() : 1 + kind % 7;
		m_array.dimensions = kind < 16 ? bytes.number<std::int8_t>() : 1 + kind % 2;
		std::uint64_t size = 8;
		for (std::uint64_t& side : m_array.shape)
		{
			const auto choice = bytes.number<std::uint8_t>();
			side = choice == 255 ? bytes.number<std::uint64_t>() : choice == 254 ? 16 : choice % 13;
			size = side != 0 && size < 1'000'000 && side < 1'000'000 ? size * side : side == 0 ? size : 1'000'000'000;
		}
		m_is_null = kind == 255;
		if (size < 1'000'000)
		{
			m_memory.resize(size);
			const auto scale = bytes.number<std::int8_t>();
			for (std::uint64_t i = 0; i + 8 <= size; i += 8)
			{
				put(i, bytes, scale);
			}
			m_array.data = m_memory.data();
		}
	}
	const nook_array* get() const
	{
		return m_is_null ? nullptr : &m_array;
	}

private:
	void put(std::uint64_t at, Bytes& bytes, int scale)
	{
		const auto small = bytes.number<std::int8_t>();
		const double real = scale == -128 ? bytes.number<double>() : 0.1 * small * scale;
		const auto single = static_cast<float>(std::abs(real) < 1e30 ? real : 0.0);
		const std::uint64_t whole = scale == -127 ? bytes.number<std::uint64_t>() : static_cast<std::uint64_t>(small & 7);
		switch (m_array.type)
		{
		case NOOK_FLOAT64: std::memcpy(m_memory.data() + at, &real, 8); break;
		case NOOK_FLOAT32:
			std::memcpy(m_memory.data() + at, &single, 4);
			std::memcpy(m_memory.data() + at + 4, &single, 4);
			break;
		case NOOK_INT32:
		case NOOK_UINT32:
			std::memcpy(m_memory.data() + at, &whole, 4);
			std::memcpy(m_memory.data() + at + 4, &whole, 4);
			break;
		default: std::memcpy(m_memory.data() + at, &whole, 8);
		}
	}

	std::vector<char> m_memory;
	nook_array m_array{};
	bool m_is_null = false;
};

std::int32_t onProgress(void* user, const char*, double)
{
	auto& calls = *static_cast<int*>(user);
	calls += 1;
	if (calls % 1024 == 1000)
	{
		throw 1;
	}
	return calls % 64 == 63 ? 1 : 0;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	Bytes bytes(data, size);
	static int calls = 0;
	// Handles that were made and some that never were; destroyed ones stay among them.
	std::vector<nook_options*> options{nullptr, reinterpret_cast<nook_options*>(8)};
	std::vector<nook_level*> levels{nullptr, reinterpret_cast<nook_level*>(4112)};
	std::vector<nook_result*> results{nullptr};
	const auto one = [&bytes](const auto& handles)
	{
		return handles[handles.size() - 1 - bytes.number<std::uint8_t>() % handles.size()];
	};
	const auto check = [](nook_status status)
	{
		const std::string line = nook_error();
		if ((status == NOOK_OK) != line.empty() || line.find_first_of("\n\r") != std::string::npos || status < 0 ||
			status > NOOK_WRONG_VERSION)
		{
			std::abort();
		}
		return status == NOOK_OK;
	};
	for (int step = 0; step < 24; ++step)
	{
		nook_result* result = nullptr;
		const auto choice = bytes.number<std::uint8_t>() % 25;
		if (choice < 6)
		{
			nook_options* made = nullptr;
			check(nook_options_create(&made));
			options.push_back(made);
			check(nook_options_set(made, "threads", "1"));
			for (int count = bytes.number<std::uint8_t>() % 5; count > 0; --count)
			{
				const char* const name = kNames[bytes.number<std::uint8_t>() % kNames.size()];
				check(nook_options_set(made, name, kValues[bytes.number<std::uint8_t>() % kValues.size()]));
			}
			if (choice == 5)
			{
				check(nook_options_progress(made, onProgress, &calls));
			}
			continue;
		}
		switch (choice)
		{
		case 6:
		case 7:
		case 8:
		{
			const Array positions(bytes);
			const Array triangles(bytes);
			const Array normals(bytes);
			const Array uvs(bytes);
			nook_level* level = nullptr;
			check(nook_level_create(positions.get(), triangles.get(), choice == 6 ? nullptr : normals.get(),
									choice == 6 ? nullptr : uvs.get(), one(options), &level));
			levels.push_back(level);
			break;
		}
		case 9: check(nook_level_describe(one(levels), &result)); break;
		case 10: check(nook_run_bake(one(levels), one(options), &result)); break;
		case 11: check(nook_run_volumes(one(levels), one(options), &result)); break;
		case 12: check(nook_run_gbuffer(one(levels), one(options), &result)); break;
		case 13:
		{
			const Array positions(bytes);
			const Array normals(bytes);
			check(nook_run_visibility(one(levels), positions.get(), normals.get(), one(options), &result));
			break;
		}
		case 14:
		{
			const Array depth(bytes);
			const Array normals(bytes);
			const Array projection(bytes);
			check(nook_run_shade(depth.get(), normals.get(), projection.get(), nullptr, one(options), &result));
			break;
		}
		case 15:
		{
			const Array test(bytes);
			const Array reference(bytes);
			check(nook_run_compare(test.get(), reference.get(), nullptr, one(options), &result));
			break;
		}
		case 16:
		{
			const std::string file = bytes.text(64);
			check(nook_options_file(one(options), "pattern", bytes.text(12).c_str(), file.data(), file.size()));
			break;
		}
		case 17:
		{
			nook_array array{};
			if (check(nook_result_array(one(results), nook_result_name(one(results), bytes.number<std::uint8_t>() % 4), &array)) &&
				array.data == nullptr)
			{
				std::abort();
			}
			const char* text = nullptr;
			check(nook_result_facts(one(results), &text, nullptr));
			break;
		}
		case 18: check(nook_run_emit(one(options), &result)); break;
		case 19:
		{
			nook_level* level = nullptr;
			check(nook_level_load(kLevels[bytes.number<std::uint8_t>() % kLevels.size()], one(options), &level));
			levels.push_back(level);
			break;
		}
		case 20:
		{
			check(nook_options_number(one(options), kNames[bytes.number<std::uint8_t>() % kNames.size()],
									  kNumbers[bytes.number<std::uint8_t>() % kNumbers.size()]));
			check(nook_require(bytes.number<std::uint8_t>() % 3));
			break;
		}
		case 21:
		case 22:
		{
			// Few samples and starts, or an error; a pattern's file is that of the next tile.
			nook_options* const made = one(options);
			check(nook_options_set(made, "starts", "1"));
			check(choice == 21 ? nook_run_pattern(made, &result) : nook_run_tile(made, &result));
			const char* file = nullptr;
			std::size_t length = 0;
			if (check(nook_result_file(one(results), ".json", &file, &length)))
			{
				check(nook_options_file(one(options), "pattern", "pattern.json", file, length));
			}
			break;
		}
		case 23:
		{
			// Two threads on one handle, which one of them may destroy.
			nook_level* const level = one(levels);
			nook_result* const held = one(results);
			const bool ends = bytes.number<std::uint8_t>() % 2 == 0;
			std::thread other(
				[&]
				{
					nook_result* described = nullptr;
					check(nook_level_describe(level, &described));
					nook_result_destroy(described);
					if (ends)
					{
						nook_level_destroy(level);
						nook_result_destroy(held);
					}
				});
			check(nook_level_describe(level, &result));
			const char* text = nullptr;
			check(nook_result_facts(held, nullptr, &text));
			other.join();
			break;
		}
		default:
			nook_options_destroy(one(options));
			nook_level_destroy(one(levels));
			nook_result_destroy(one(results));
		}
		results.push_back(result);
	}
	for (std::size_t i = 1; i < options.size(); ++i)
	{
		nook_options_destroy(options[i]);
	}
	for (nook_level* const level : levels)
	{
		nook_level_destroy(level);
	}
	for (nook_result* const result : results)
	{
		nook_result_destroy(result);
	}
	return 0;
}
