// SPDX-License-Identifier: GPL-3.0-or-later
// main() of a worker program: receives requests from core/isolate.h with their limits and returns values.
#pragma once

#include "core/value_stream.h"
#include <cstddef>

#include <functional>
#include <span>
#include <string_view>

namespace nook
{

struct WorkerFunction
{
	std::string_view name;
	// Reads all its arguments first, then writes its answer. Throws Error, which the caller rethrows.
	void (*run)(ValueReader& request, ValueWriter& answer) = nullptr;
};

// Serves requests until the parent ends; returns main()'s exit code. `prepare` runs before the first request; if it fails, the
// worker cannot run on this machine.
int serveRequests(int argc, char** argv, std::span<const WorkerFunction> functions, const std::function<void()>& prepare = {});

// Shared by core/isolate.h and core/worker.h: request header and end-of-message codes.

inline constexpr int kWorkerSocket = 3; // in the worker; its standard streams lead nowhere

struct RequestHead
{
	bool limited = false;
	std::size_t memory_bytes = 0; // in addition to the worker's size when the request arrives
	int processor_s = 0;
};

inline constexpr const char* kTooLarge = "contents that need far more memory than their size justifies";
inline constexpr const char* kTooLong = "contents that never finish reading";
inline constexpr const char* kBroken = "contents that crash their reader";

} // namespace nook
