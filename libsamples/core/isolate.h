// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a function in a worker process with limits on memory and time, and returns the values it writes.
//
// Readers of other people's formats crash, loop and ask for gigabytes on damaged or hostile files. A separate process turns all of
// that into one error line. It is a separate program, not a fork, so that it shares no locks, threads or memory, and so that nook
// does not load the libraries it links.
#pragma once

#include "core/value_stream.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace nook
{

struct IsolationLimits
{
	std::size_t memory_bytes = std::size_t{1} << 30U; // in addition to the worker's size when the request arrives
	int processor_s = 60;                             // processor time; five times as long in wall time
};

struct Isolated
{
	const char* program = "";  // found along the run path, like this program's libraries
	const char* function = ""; // one of the functions it offers
	bool keep = false;         // keep the worker for the next call; for workers that start slowly
};

// `ask` writes the function's arguments, `take` reads what it answers. An Error of the function is thrown here. A worker that
// crashes, runs too long or wants too much is an Error (invalid_input) of `name`, the file being read; `take` may change it as it
// goes from one file to the next. Without limits what is worked on is our own, and such an end is a failure of ours (runtime). With
// `keep`, both may be called a second time: a worker that others used before and that ends badly gives way to a new one. Throws
// Error as well where there is no such program (file), or it cannot run here (runtime).
void isolate(const Isolated& what, const std::string& name, const std::optional<IsolationLimits>& limits,
			 const std::function<void(ValueWriter&)>& ask, const std::function<void(ValueReader&)>& take);

// False if that worker, or a library that it links, is missing, or it cannot start for another reason. The worker is kept.
bool hasWorker(const char* program);

// main() of a worker program: receives requests of isolate() with their limits and returns values.

struct WorkerFunction
{
	std::string_view name;
	// Reads all its arguments first, then writes its answer. Throws Error, which the caller rethrows.
	void (*run)(ValueReader& request, ValueWriter& answer) = nullptr;
};

// Serves requests until the parent ends; returns main()'s exit code. If `prepare`, run first, fails, the worker cannot run here.
int serveRequests(int argc, char** argv, std::span<const WorkerFunction> functions, const std::function<void()>& prepare = {});

// Shared by both sides: end-of-message codes.
inline constexpr const char* kTooLarge = "contents that need far more memory than their size justifies";
inline constexpr const char* kTooLong = "contents that never finish reading";
inline constexpr const char* kBroken = "contents that crash their reader";

} // namespace nook
