// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/builtin.h"

#include "core/error.h"
#include "scene/builtin_levels.h"

#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <utility>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 7> kNames = {"cornell", "courtyard", "suburb", "foliage", "heightfield", "cave", "nulls"};

[[noreturn]] void refuseName(std::string_view name)
{
	std::string listed;
	for (const std::string_view known : kNames)
	{
		listed += std::string(listed.empty() ? "" : ", ") + std::string(known);
	}
	throw Error(ExitCode::usage,
				"builtin: found '" + std::string(name) + "', expected one of " + listed + ", heightfield:N or cave:N");
}

// A level with a selectable number of triangles: "heightfield:N".
struct SizedLevel
{
	std::string_view name;
	Level (*make)(std::size_t triangles);
	std::size_t triangles; // default
	std::size_t least;
	std::size_t most;
};

constexpr std::array<SizedLevel, 2> kSized = {
	{{"heightfield", makeHeightfield, kDefaultHeightfieldTriangles, 2, kMaxHeightfieldTriangles},
	 {"cave", makeCave, kDefaultCaveTriangles, kMinCaveTriangles, kMaxCaveTriangles}}};

std::size_t triangleCount(std::string_view text, const SizedLevel& level)
{
	std::size_t count = 0;
	const std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), count);
	if (result.ec != std::errc{} || result.ptr != text.data() + text.size() || count < level.least || count > level.most)
	{
		throw Error(ExitCode::usage, "builtin:" + std::string(level.name) + ": found '" + std::string(text) + "', expected " +
										 std::to_string(level.least) + " to " + std::to_string(level.most) + " triangles");
	}
	return count;
}

std::optional<Level> sizedLevel(std::string_view name)
{
	for (const SizedLevel& level : kSized)
	{
		if (name == level.name)
		{
			return level.make(level.triangles);
		}
		if (name.starts_with(level.name) && name.substr(level.name.size()).starts_with(":"))
		{
			return level.make(triangleCount(name.substr(level.name.size() + 1), level));
		}
	}
	return std::nullopt;
}

} // namespace

std::span<const std::string_view> builtinNames()
{
	return kNames;
}

Level builtinLevel(std::string_view name)
{
	Level level;
	if (name == "cornell")
	{
		level = makeCornell();
	}
	else if (name == "courtyard")
	{
		level = makeCourtyard();
	}
	else if (name == "suburb")
	{
		level = makeSuburb();
	}
	else if (name == "foliage")
	{
		level = makeFoliage();
	}
	else if (name == "nulls")
	{
		level = makeNulls();
	}
	else if (std::optional<Level> sized = sizedLevel(name))
	{
		level = std::move(*sized);
	}
	else
	{
		refuseName(name);
	}
	level.name = std::string(kBuiltinPrefix) + std::string(name);
	return level;
}

} // namespace nook
