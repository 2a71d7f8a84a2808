// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume_methods.h"

#include "core/error.h"
#include "methods/directions.h"
#include "methods/method_table.h"

namespace nook
{

std::string volumeMethods(const std::string& between)
{
	return methodNames([](const MethodRow& row) { return row.kind == MethodKind::volumes; }, between);
}

std::string sumMethod()
{
	return std::string(volumeRow(false).name);
}

std::string maskMethod()
{
	return std::string(volumeRow(true).name);
}

CLI::Option* addDirections(CLI::App& app, int& directions)
{
	return addWhole(app, "--directions", directions, kLeastDirections, kMostDirections,
					maskMethod() + ": directions of a pixel's mask, a multiple of 32 (default 128)");
}

void checkDirections(const CLI::Option& given, int directions, bool masks)
{
	if (given.count() > 0 && !masks)
	{
		throw Error(ExitCode::usage, "--directions: found with another method, expected " + maskMethod());
	}
	if (directions % 32 != 0)
	{
		refuseValue("--directions", std::to_string(directions), "a multiple of 32");
	}
}

} // namespace nook
