// SPDX-License-Identifier: GPL-3.0-or-later
// What both ends of core/isolate.h and core/worker.h know: what a request begins with, and how its end is called.
#pragma once

#include <cstddef>

namespace nook
{

inline constexpr int kWorkerSocket = 3; // of the worker; its standard streams lead nowhere

struct RequestHead
{
	bool limited = false;
	std::size_t memory_bytes = 0; // on top of what the worker has as the request comes
	int processor_s = 0;
};

inline constexpr const char* kTooLarge = "something that takes far more memory than its size needs";
inline constexpr const char* kTooLong = "something that reading does not come to an end with";
inline constexpr const char* kBroken = "something that breaks its reader";

} // namespace nook
