// SPDX-License-Identifier: GPL-3.0-or-later
// Calls the functions onProgress(stage, share) and onPoints(start, numbers) that the module was made with (npm/index.js).
#include "verb_progress.h"

#include <emscripten.h>

#include <string>

// clang-format off
EM_JS(int, nook_is_watched, (), { return (Module['onProgress'] ? 1 : 0) + (Module['onPoints'] ? 2 : 0); })
EM_JS(void, nook_tell_progress, (const char* stage, double share), { Module['onProgress'](UTF8ToString(stage), share); })
EM_JS(void, nook_tell_points, (int start, const double* numbers, int count),
	{ Module['onPoints'](start, HEAPF64.slice(numbers >> 3, (numbers >> 3) + count)); })
// clang-format on

namespace nook
{

Progress pageProgress()
{
	if ((nook_is_watched() & 1) == 0)
	{
		return {};
	}
	return [](std::string_view stage, double share)
	{
		nook_tell_progress(std::string(stage).c_str(), share);
	};
}

Watch pageWatch()
{
	if ((nook_is_watched() & 2) == 0)
	{
		return {};
	}
	return [](std::size_t start, std::span<const glm::dvec3> points)
	{
		if (!points.empty())
		{
			nook_tell_points(static_cast<int>(start), &points.front().x, static_cast<int>(3 * points.size()));
		}
	};
}

} // namespace nook
