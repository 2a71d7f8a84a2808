// SPDX-License-Identifier: GPL-3.0-or-later
// A verb that a program calls (capi.cpp): what it reads and makes is in memory, in place of files and of text for people.
#pragma once

#include "nook/nook.h"
#include "scene/gbuffer.h"
#include "scene/load.h"
#include "scene/reference.h"

#include <algorithm>
#include <concepts>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace nook
{

template <class Number> constexpr nook_type typeOf()
{
	return std::same_as<Number, float>      ? NOOK_FLOAT32
		   : std::same_as<Number, double>   ? NOOK_FLOAT64
		   : std::same_as<Number, uint8_t>  ? NOOK_UINT8
		   : std::same_as<Number, int32_t>  ? NOOK_INT32
		   : std::same_as<Number, uint32_t> ? NOOK_UINT32
		   : std::same_as<Number, int64_t>  ? NOOK_INT64
											: NOOK_UINT64;
}

struct MadeArray
{
	std::string name;
	nook_type type = NOOK_FLOAT64;
	std::vector<uint64_t> shape;
	std::shared_ptr<const void> data; // C-contiguous
};

struct Call
{
	Progress progress;
	std::shared_ptr<const LoadedLevel> level;
	std::vector<ReferencePoint> points;
	std::map<std::string, Image> images; // by the names that options have for them
	std::vector<uint8_t> counted;        // pixels of a comparison

	// The results.
	std::vector<MadeArray> arrays;
	std::vector<std::string> warnings;
};

// The call that this thread works for; null in the program.
inline thread_local Call* t_call = nullptr;

// Lets this thread work for a call.
struct Working
{
	explicit Working(Call& call) : before(std::exchange(t_call, &call)) {}
	Working& operator=(Working&&) = delete;
	~Working()
	{
		t_call = before;
	}

	Call* before; // of a caller whose progress callback makes another call
};

// Keeps an array for the caller, if there is one. Values are numbers or vectors of them: give<float>("normals", normals, {n, 3}).
template <class Number, class Value>
void give(const char* name, const std::vector<Value>& values, const std::vector<std::size_t>& shape)
{
	if (t_call != nullptr && !values.empty())
	{
		const auto kept = std::make_shared<const std::vector<Value>>(values);
		t_call->arrays.push_back({name, typeOf<Number>(), {shape.begin(), shape.end()}, {kept, kept->data()}});
	}
}

// Likewise one member of each row.
template <class Number, class Row> void give(const char* name, const std::vector<Row>& rows, Number Row::*member)
{
	std::vector<Number> values(t_call != nullptr ? rows.size() : 0);
	std::transform(rows.begin(), rows.begin() + std::ssize(values), values.begin(),
				   [member](const Row& row) { return row.*member; });
	give<Number>(name, values, {values.size()});
}

// The caller's level, or the one of that name.
inline std::shared_ptr<const LoadedLevel> levelOf(const std::string& name, const LoadSettings& settings, const RunSettings& run)
{
	return t_call != nullptr ? t_call->level : std::make_shared<const LoadedLevel>(loadLevel(name, settings, run));
}

// The caller's picture of that name, or the file.
inline Image imageOf(const std::string& name)
{
	return t_call != nullptr && t_call->images.contains(name) ? t_call->images.at(name) : readImage(name);
}

// The caller's G-buffer, or the file.
inline GBuffer gbufferOf(const std::string& name, const GBufferImport& import)
{
	return t_call != nullptr ? gbufferFrom(t_call->images.at(name), name, import) : readGBuffer(name, import);
}

} // namespace nook
