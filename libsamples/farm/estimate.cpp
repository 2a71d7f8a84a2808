// SPDX-License-Identifier: GPL-3.0-or-later
#include "farm/estimate.h"

#include "core/costs.h"

#include <algorithm>
#include <cmath>

namespace nook
{
namespace
{

constexpr double kTimeMargin = 3.0; // machines of a farm differ, and so do levels
constexpr double kMemoryMargin = 1.5;

// The work that the jobs share, without what each does by itself.
double sharedSeconds(const JobNeeds& needs, std::size_t jobs)
{
	return (needs.seconds - needs.load_seconds) * static_cast<double>(jobs);
}

} // namespace

int minutesToAsk(const JobNeeds& needs)
{
	return needs.minutes > 0
			   ? needs.minutes
			   : static_cast<int>(std::clamp(std::ceil(kTimeMargin * needs.seconds / 60.0) + 5.0, 1.0, double{kMaxMinutes}));
}

int mebibytesToAsk(const JobNeeds& needs)
{
	return needs.mebibytes > 0
			   ? needs.mebibytes
			   : static_cast<int>(std::clamp(std::ceil(kMemoryMargin * needs.bytes / 1048576.0), 64.0, double{kMaxMebibytes}));
}

double trianglesOfFile(const std::string& ending, double bytes)
{
	// A triangle has half a vertex: 12 to 16 bytes of indices and as many of position, normal and texture in binary; a line of text
	// for a face and half of three.
	const bool text = ending == ".obj" || ending == ".gltf";
	return bytes / (text ? 80.0 : 30.0);
}

double overheadOf(const JobNeeds& needs, std::size_t jobs)
{
	return needs.known ? needs.seconds * static_cast<double>(jobs) / (needs.load_seconds + sharedSeconds(needs, jobs)) : 1.0;
}

std::size_t mostJobs(const JobNeeds& needs, std::size_t jobs)
{
	const double single = needs.load_seconds + sharedSeconds(needs, jobs);
	return 1 + static_cast<std::size_t>((kOverhead - 1.0) * single / needs.load_seconds);
}

JobNeeds guessWork(const WorkFacts& facts, int threads)
{
	JobNeeds needs;
	needs.threads = threads;
	needs.known = true;
	needs.load_seconds = cost::kStart_s + cost::kLoad_s * facts.triangles;
	needs.bytes = cost::kProgram_bytes + cost::kTriangle_bytes * facts.triangles + cost::kPixel_bytes * facts.pixels;
	double work_s = 0.0;
	if (facts.verb == "reference")
	{
		// A tree of four times the triangles is one level deeper, of ten or so.
		const double deeper = 1.0 + 0.1 * std::log2(std::max(facts.triangles, 1e5) / 1e5);
		work_s = facts.pixels * facts.rays * cost::kRay_s * deeper;
	}
	else if (facts.verb == "bake" && !facts.open_end)
	{
		work_s = facts.pixels * facts.rays * cost::kRay_s;
	}
	else if (facts.verb == "volumes")
	{
		work_s = facts.triangles * (facts.looks_on ? cost::kBuiltVolume_s : cost::kVolume_s);
		needs.bytes += facts.triangles * (facts.looks_on ? cost::kBuiltVolume_bytes : cost::kVolume_bytes);
	}
	else if (facts.verb == "gbuffer" || facts.verb == "shade" || facts.verb == "compare" || facts.verb == "level" ||
			 facts.verb == "info")
	{
		work_s = facts.pixels * cost::kPixel_s;
	}
	else
	{
		needs.known = false;
		needs.bytes = std::max(needs.bytes, JobNeeds{}.bytes);
		needs.seconds = JobNeeds{}.seconds;
		return needs;
	}
	needs.seconds = needs.load_seconds + work_s / threads;
	return needs;
}

} // namespace nook
