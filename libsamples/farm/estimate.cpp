// SPDX-License-Identifier: GPL-3.0-or-later
#include "farm/estimate.h"

#include <algorithm>
#include <cmath>

namespace nook
{
namespace
{

// Of a triangle and a ray: what Sponza takes (docs/reference/parts.md); a level without depth takes a quarter of that for a ray. Of
// volumes: as nook info expects it (docs/measurements/bake.md). The others are rough.
constexpr double kStart_s = 0.1;           // of a program, its libraries and its readers
constexpr double kLoad_s = 1e-6;           // of a triangle: reading, checking, the tree
constexpr double kRay_s = 1.7e-7;          // of a ray in a level of 10⁵ triangles
constexpr double kVolume_s = 3e-5;         // volumes of a triangle
constexpr double kLooking_s = 1.8e-4;      // where they are looked at besides
constexpr double kPixel_s = 2e-6;          // depth, normals, one method
constexpr double kBytesOfTriangle = 400.0; // arrays, tree, diagnosis
constexpr double kBytesOfVolume = 300.0;   // of a triangle, besides
constexpr double kBytesOfLooking = 1600.0;
constexpr double kBytesOfPixel = 150.0; // a G-buffer, values, the picture as it is written
constexpr double kBytesOfProgram = 2e8;

constexpr double kTimeMargin = 3.0; // machines of a farm differ, and so do levels
constexpr double kMemoryMargin = 1.5;

// Of the jobs together, without what each does by itself.
double sharedSeconds(const JobNeeds& needs, std::size_t jobs)
{
	return (needs.seconds - needs.load_seconds) * static_cast<double>(jobs);
}

} // namespace

int minutesToAsk(const JobNeeds& needs)
{
	return needs.minutes > 0
			   ? needs.minutes
			   : static_cast<int>(std::clamp(std::ceil(kTimeMargin * needs.seconds / 60.0) + 5.0, 1.0, double{kMostMinutes}));
}

int mebibytesToAsk(const JobNeeds& needs)
{
	return needs.mebibytes > 0
			   ? needs.mebibytes
			   : static_cast<int>(std::clamp(std::ceil(kMemoryMargin * needs.bytes / 1048576.0), 64.0, double{kMostMebibytes}));
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
	needs.load_seconds = kStart_s + kLoad_s * facts.triangles;
	needs.bytes = kBytesOfProgram + kBytesOfTriangle * facts.triangles + kBytesOfPixel * facts.pixels;
	double work_s = 0.0;
	if (facts.verb == "reference")
	{
		// A tree of four times the triangles is one level deeper, of ten or so.
		const double deeper = 1.0 + 0.1 * std::log2(std::max(facts.triangles, 1e5) / 1e5);
		work_s = facts.pixels * facts.rays * kRay_s * deeper;
	}
	else if (facts.verb == "bake" && !facts.open_end)
	{
		work_s = facts.pixels * facts.rays * kRay_s;
	}
	else if (facts.verb == "volumes")
	{
		work_s = facts.triangles * (facts.looks_on ? kLooking_s : kVolume_s);
		needs.bytes += facts.triangles * (facts.looks_on ? kBytesOfLooking : kBytesOfVolume);
	}
	else if (facts.verb == "gbuffer" || facts.verb == "shade" || facts.verb == "compare" || facts.verb == "level" ||
			 facts.verb == "info")
	{
		work_s = facts.pixels * kPixel_s;
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
