// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a program on a file and reports its outcome and cost.
#pragma once

#include <string>
#include <vector>

namespace nook::hostile
{

struct Ended
{
	int code = -1;             // exit code; −1: a signal, or stopped after `wait_s`
	std::string how;           // "signal 11", "no end after 30 s"
	std::string out;           // what it printed
	std::string error;         // and on stderr
	double processor_s = 0;    // including every process it waited for
	long resident_kb = 0;      // maximum over them
	bool left_process = false; // one of its processes was alive a second later
};

// Runs in the current folder. The caller adopts orphans of the program, so it must have no other child processes.
Ended run(const std::vector<std::string>& arguments, double wait_s);

} // namespace nook::hostile
