// SPDX-License-Identifier: GPL-3.0-or-later
// nook.h for C++17 and later: handles that clean up, exceptions, vectors. Header-only.
//
//	nook::Level level = nook::Level::load("level.glb");
//	nook::Result baked = nook::bake(level, nook::Options().set("radius", 2.0));
//	std::vector<float> visibility = baked.values<float>("visibility");
#ifndef NOOK_NOOK_HPP
#define NOOK_NOOK_HPP

#include "nook/nook.h"

#include <array>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace nook
{
inline namespace api
{

// what(): one line; status(): one of nook_status.
class Failure : public std::runtime_error
{
public:
	Failure(nook_status status, const std::string& message) : std::runtime_error(message), m_status(status) {}
	nook_status status() const
	{
		return m_status;
	}

private:
	nook_status m_status;
};

inline void check(nook_status status)
{
	if (status != NOOK_OK)
	{
		throw Failure(status, nook_error());
	}
}

// Numbers that a nook_array can hold.
template <class Number>
inline constexpr bool isArrayNumber = std::is_floating_point_v<Number> ? sizeof(Number) == 4 || sizeof(Number) == 8
																	   : std::is_integral_v<Number> &&
																			 !std::is_same_v<Number, bool> &&
																			 (sizeof(Number) == 4 || sizeof(Number) == 8 ||
																			  (sizeof(Number) == 1 && std::is_unsigned_v<Number>));

template <class Number> constexpr nook_type arrayType()
{
	static_assert(isArrayNumber<Number>, "expected float, double, an unsigned byte, or a whole number of 32 or 64 bits");
	if constexpr (std::is_floating_point_v<Number>)
	{
		return sizeof(Number) == 4 ? NOOK_FLOAT32 : NOOK_FLOAT64;
	}
	else if constexpr (sizeof(Number) == 1)
	{
		return NOOK_UINT8;
	}
	else if constexpr (sizeof(Number) == 4)
	{
		return std::is_signed_v<Number> ? NOOK_INT32 : NOOK_UINT32;
	}
	else
	{
		return std::is_signed_v<Number> ? NOOK_INT64 : NOOK_UINT64;
	}
}

// A view of numbers that lie one after the other: array(points.data(), {points.size() / 3, 3}).
template <class Number> nook_array array(const Number* data, std::initializer_list<uint64_t> shape)
{
	nook_array made{data, arrayType<Number>(), static_cast<int32_t>(shape.size()), {}};
	for (std::size_t i = 0; i < shape.size(); ++i)
	{
		made.shape[i] = *(shape.begin() + i);
	}
	return made;
}

class Options
{
public:
	Options()
	{
		nook_options* made = nullptr;
		check(nook_options_create(&made));
		m_handle.reset(made, nook_options_destroy);
	}
	Options& set(const char* name, const std::string& value)
	{
		check(nook_options_set(get(), name, value.c_str()));
		return *this;
	}
	Options& set(const char* name, const char* value)
	{
		return set(name, std::string(value));
	}
	template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>> Options& set(const char* name, Number value)
	{
		if constexpr (std::is_same_v<Number, bool>)
		{
			return set(name, value ? "true" : "false");
		}
		else
		{
			check(nook_options_number(get(), name, static_cast<double>(value)));
			return *this;
		}
	}
	Options& file(const char* name, const char* file_name, std::string_view bytes)
	{
		check(nook_options_file(get(), name, file_name, bytes.data(), bytes.size()));
		return *this;
	}
	// Returns true to go on; an exception ends the work, too. It is called from other threads.
	Options& progress(std::function<bool(const char* stage, double share)> callback)
	{
		m_progress = std::make_shared<std::function<bool(const char*, double)>>(std::move(callback));
		const auto call = [](void* user, const char* stage, double share) -> int32_t
		{
			return (*static_cast<std::function<bool(const char*, double)>*>(user))(stage, share) ? 0 : 1;
		};
		check(nook_options_progress(get(), call, m_progress.get()));
		return *this;
	}
	nook_options* get() const
	{
		return m_handle.get();
	}

private:
	std::shared_ptr<std::function<bool(const char*, double)>> m_progress;
	std::shared_ptr<nook_options> m_handle;
};

class Result
{
public:
	explicit Result(nook_result* handle) : m_handle(handle, nook_result_destroy) {}
	nook_array array(const char* name) const
	{
		nook_array found{};
		check(nook_result_array(get(), name, &found));
		return found;
	}
	// A copy; Number is that of the array.
	template <class Number> std::vector<Number> values(const char* name) const
	{
		const nook_array found = array(name);
		if (found.type != arrayType<Number>())
		{
			throw Failure(NOOK_USAGE, "array: found numbers of another type");
		}
		std::size_t count = 1;
		for (int32_t i = 0; i < found.dimensions; ++i)
		{
			count *= found.shape[i];
		}
		std::vector<Number> numbers(count);
		std::memcpy(numbers.data(), found.data, count * sizeof(Number));
		return numbers;
	}
	// Valid as long as the result.
	std::string_view file(const char* ending) const
	{
		const char* bytes = nullptr;
		std::size_t size = 0;
		check(nook_result_file(get(), ending, &bytes, &size));
		return {bytes, size};
	}
	std::string_view facts() const
	{
		const char* json = nullptr;
		check(nook_result_facts(get(), &json, nullptr));
		return json;
	}
	// A line each, or empty.
	std::string_view warnings() const
	{
		const char* lines = nullptr;
		check(nook_result_facts(get(), nullptr, &lines));
		return lines;
	}
	// Names of its arrays.
	std::vector<std::string> names() const
	{
		std::vector<std::string> found;
		while (const char* name = nook_result_name(get(), found.size()))
		{
			found.emplace_back(name);
		}
		return found;
	}
	nook_result* get() const
	{
		return m_handle.get();
	}

private:
	std::shared_ptr<nook_result> m_handle;
};

// Calls a function of nook.h whose last argument is the result.
template <class Function, class... Arguments> Result call(Function function, Arguments... arguments)
{
	nook_result* made = nullptr;
	check(function(arguments..., &made));
	return Result(made);
}

class Level
{
public:
	explicit Level(nook_level* handle) : m_handle(handle, nook_level_destroy) {}
	static Level load(const std::string& path, const Options& options = {})
	{
		nook_level* made = nullptr;
		check(nook_level_load(path.c_str(), options.get(), &made));
		return Level(made);
	}
	// Three numbers per vertex, three indices per triangle.
	template <class Number, class Index>
	static Level create(const std::vector<Number>& positions, const std::vector<Index>& triangles, const Options& options = {})
	{
		return create(positions, triangles, std::vector<Number>(), std::vector<Number>(), options);
	}
	// Also three numbers of the normal and two texture coordinates per vertex; either may be empty.
	template <class Number, class Index>
	static Level create(const std::vector<Number>& positions, const std::vector<Index>& triangles,
						const std::vector<Number>& normals, const std::vector<Number>& uvs, const Options& options = {})
	{
		const nook_array given[]{rows(positions, 3), rows(triangles, 3), rows(normals, 3), rows(uvs, 2)};
		nook_level* made = nullptr;
		check(nook_level_create(&given[0], &given[1], normals.empty() ? nullptr : &given[2], uvs.empty() ? nullptr : &given[3],
								options.get(), &made));
		return Level(made);
	}
	// Arrays positions, triangles, normals, uvs; facts: what was found in the level.
	Result describe() const
	{
		return call(nook_level_describe, get());
	}
	nook_level* get() const
	{
		return m_handle.get();
	}

private:
	template <class Number> static nook_array rows(const std::vector<Number>& values, std::size_t columns)
	{
		if (values.size() % columns != 0)
		{
			throw Failure(NOOK_USAGE, "Level::create: found " + std::to_string(values.size()) +
										  " numbers, expected a multiple of " + std::to_string(columns));
		}
		return array(values.data(), {values.size() / columns, columns});
	}

	std::shared_ptr<nook_level> m_handle;
};

inline Result pattern(const Options& options)
{
	return call(nook_run_pattern, options.get());
}
inline Result tile(const Options& options)
{
	return call(nook_run_tile, options.get());
}
inline Result emit(const Options& options)
{
	return call(nook_run_emit, options.get());
}
inline Result bake(const Level& level, const Options& options)
{
	return call(nook_run_bake, level.get(), options.get());
}
inline Result volumes(const Level& level, const Options& options)
{
	return call(nook_run_volumes, level.get(), options.get());
}
inline Result gbuffer(const Level& level, const Options& options = {})
{
	return call(nook_run_gbuffer, level.get(), options.get());
}
inline Result visibility(const Level& level, const nook_array& positions, const nook_array& normals, const Options& options)
{
	return call(nook_run_visibility, level.get(), &positions, &normals, options.get());
}
// As nook_run_shade takes them.
inline Result shade(const nook_array& depth, const nook_array* normals, const nook_array* projection,
					const nook_array* world_to_camera, const Options& options)
{
	return call(nook_run_shade, &depth, normals, projection, world_to_camera, options.get());
}
// `gbuffer`: a result of gbuffer().
inline Result shade(const Result& gbuffer, const Options& options)
{
	const nook_array depth = gbuffer.array("depth");
	const nook_array normals = gbuffer.array("normals");
	const nook_array projection = gbuffer.array("projection");
	const nook_array camera = gbuffer.array("world_to_camera");
	return shade(depth, &normals, &projection, &camera, options);
}
// mask: 0 where a pixel does not count.
inline Result compare(const nook_array& test, const nook_array& reference, const nook_array* mask, const Options& options = {})
{
	return call(nook_run_compare, &test, &reference, mask, options.get());
}
inline Result compare(const nook_array& test, const nook_array& reference, const Options& options = {})
{
	return compare(test, reference, nullptr, options);
}

} // namespace api
} // namespace nook

#endif // NOOK_NOOK_HPP
