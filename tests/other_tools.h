// SPDX-License-Identifier: GPL-3.0-or-later
// Runs other programs from tests.
#pragma once

#include "testing.h"

namespace nook::test
{

inline bool toolExists(const std::string& tool)
{
	return std::system(("command -v " + tool + " > /dev/null 2>&1").c_str()) == 0;
}

// True if it exits with 0; otherwise the test failure shows its output.
inline bool passes(const std::string& command, const TemporaryFolder& folder)
{
	const bool passed = std::system((command + " > '" + folder / "log" + "' 2>&1").c_str()) == 0;
	if (!passed)
	{
		UNSCOPED_INFO(command << "\n" << readFile(folder / "log"));
	}
	return passed;
}

} // namespace nook::test
