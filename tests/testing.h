// SPDX-License-Identifier: GPL-3.0-or-later
// Every test file begins with this: Catch2, what many tests use of the standard library, GLM and core/, and the namespaces.
#pragma once

#include "temporary_folder.h"

#include "core/error.h"
#include "core/file.h"
#include "core/lists.h"
#include "core/math.h"
#include "core/random.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace nook::test
{

// The message of the error that `act` throws, which must be one line and have this code; "" if it throws none.
template <class Act> std::string refusalBy(const Act& act, ExitCode code = ExitCode::invalid_input)
{
	try
	{
		act();
	}
	catch (const Error& error)
	{
		const std::string line = error.what();
		INFO(line);
		CHECK(error.code() == code);
		CHECK(line.find_first_of("\n\r") == std::string::npos);
		return line;
	}
	return "";
}

} // namespace nook::test
using namespace nook;
using namespace nook::test;
