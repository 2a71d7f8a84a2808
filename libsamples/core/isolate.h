// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a function of a worker, a program of ours, with limits on memory and time; the values that it writes come back.
//
// Why a process: readers of other people's formats crash, loop and ask for gigabytes where a file is damaged or made for it.
// (Assimp 5.2.5 overflows its stack on a glTF whose nodes form a circle, before it looks at anything else.) Inside one process
// nothing of that can be caught; in another all of it becomes one line. Why a program: it shares no lock, thread or memory with
// this one, and this one does not load what it links.
#pragma once

#include "core/error.h"
#include "core/value_stream.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace nook
{

struct IsolationLimits
{
	std::size_t memory_bytes = std::size_t{1} << 30U; // on top of what the worker has as the request comes
	int processor_s = 60;                             // processor time; five times as long where it only waits
};

struct Isolated
{
	const char* program = "";  // found as this program finds its libraries: beside them when installed, else where it was built
	const char* function = ""; // of those that it offers (core/worker.h)
	bool keep = false;         // it stays for the next call, for what takes long to start
	std::string key{}; // a hash of all that the answer depends on; it may come from an earlier run (core/kept_answers.h). Empty: no
};

// `ask` writes the function's arguments, `take` reads what it answers. An Error of the function is thrown here. A worker that
// crashes, runs too long or wants too much is an Error (invalid_input) of `name`, the file being read; `take` may change it as it
// goes from one file to the next. Without limits what is worked on is our own, and such an end is a failure of ours (runtime). With
// `keep` or `key`, both may be called a second time: a worker that others used before and that ends badly gives way to a new one,
// and so does a kept answer that `take` does not understand. Throws Error as well where there is no such program (file), or it
// cannot run here (runtime).
void isolate(const Isolated& what, const std::string& name, const std::optional<IsolationLimits>& limits,
			 const std::function<void(ValueWriter&)>& ask, const std::function<void(ValueReader&)>& take);

} // namespace nook
