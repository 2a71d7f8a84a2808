// SPDX-License-Identifier: GPL-3.0-or-later
// main() of a worker program: requests of core/isolate.h come in, each under its limits; values go out.
#pragma once

#include "core/value_stream.h"

#include <functional>
#include <span>
#include <string_view>

namespace nook
{

struct WorkerFunction
{
	std::string_view name;
	// Reads its arguments, all of them first, and writes its answer. Throws Error, which the asking program throws again.
	void (*run)(ValueReader& request, ValueWriter& answer) = nullptr;
};

// Answers requests, one after the other, until the program that started this one ends; returns main()'s exit code. `prepare` runs
// before the first: what it fails with says that the worker cannot run here, and nothing of a file.
int serveRequests(int argc, char** argv, std::span<const WorkerFunction> functions, const std::function<void()>& prepare = {});

} // namespace nook
