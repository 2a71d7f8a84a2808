// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a program on a file, and says how it ended and what it took.
#pragma once

#include <string>
#include <vector>

namespace nook::hostile
{

struct Ended
{
	int code = -1;             // exit code; −1: a signal, or it was stopped after `wait_s`
	std::string how;           // "signal 11", "no end after 30 s"
	std::string out;           // what it printed
	std::string error;         // and on stderr
	double processor_s = 0;    // with that of every process it waited for
	long resident_kb = 0;      // the largest of them
	bool left_process = false; // one of its processes was alive a second later
};

// In the folder that this process is in. Whoever calls this adopts what the program leaves behind: no child of its own may be
// alive.
Ended run(const std::vector<std::string>& arguments, double wait_s);

} // namespace nook::hostile
