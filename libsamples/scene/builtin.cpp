// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/builtin.h"

#include "core/error.h"
#include "scene/builtin_levels.h"

#include <array>
#include <charconv>
#include <string>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 6> kNames = {"cornell", "courtyard", "suburb", "foliage", "heightfield", "nulls"};

[[noreturn]] void refuseName(std::string_view name)
{
	std::string listed;
	for (const std::string_view known : kNames)
	{
		listed += std::string(listed.empty() ? "" : ", ") + std::string(known);
	}
	throw Error(ExitCode::usage, "builtin: found '" + std::string(name) + "', expected one of " + listed + " or heightfield:N");
}

// The number of "heightfield:N".
std::size_t triangleCount(std::string_view text)
{
	std::size_t count = 0;
	const std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), count);
	if (result.ec != std::errc{} || result.ptr != text.data() + text.size() || count < 2 || count > kMaxHeightfieldTriangles)
	{
		throw Error(ExitCode::usage, "builtin:heightfield: found '" + std::string(text) + "', expected 2 to " +
										 std::to_string(kMaxHeightfieldTriangles) + " triangles");
	}
	return count;
}

} // namespace

std::span<const std::string_view> builtinNames()
{
	return kNames;
}

Level builtinLevel(std::string_view name)
{
	const std::string_view sized = "heightfield:";
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
	else if (name == "heightfield")
	{
		level = makeHeightfield(kDefaultHeightfieldTriangles);
	}
	else if (name.substr(0, sized.size()) == sized)
	{
		level = makeHeightfield(triangleCount(name.substr(sized.size())));
	}
	else if (name == "nulls")
	{
		level = makeNulls();
	}
	else
	{
		refuseName(name);
	}
	level.name = std::string(kBuiltinPrefix) + std::string(name);
	return level;
}

} // namespace nook
