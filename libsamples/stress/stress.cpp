// SPDX-License-Identifier: GPL-3.0-or-later
#include "stress/stress.h"

#include "core/byte_text.h"
#include "core/error.h"
#include "core/work_units.h"
#include "stress/case.h"

#include <algorithm>
#include <cstddef>
#include <functional>

namespace nook
{
namespace
{

using stress::Case;
using stress::CaseNotes;
using stress::StressKernel;

constexpr uint64_t kChunk = 16384; // cases that one thread does at a time; a multiple of all shared pictures' cases
constexpr uint64_t kMostChunks = 4096;

std::vector<const StressKernel*> allKernels()
{
	std::vector<const StressKernel*> kernels;
	for (const auto family :
		 {stress::depthKernels, stress::volumeKernels, stress::maskKernels, stress::gatherKernels, stress::filterKernels,
		  stress::tableKernels, stress::prismKernels, stress::patternKernels, stress::occluderKernels})
	{
		for (const StressKernel& kernel : family())
		{
			kernels.push_back(&kernel);
		}
	}
	return kernels;
}

const StressKernel& kernelOf(std::string_view name)
{
	std::string names;
	for (const StressKernel* const kernel : allKernels())
	{
		if (kernel->name == name)
		{
			return *kernel;
		}
		names += (names.empty() ? "" : ", ") + std::string(kernel->name);
	}
	throw Error(ExitCode::usage, "kernel: found '" + std::string(name) + "', expected one of " + names);
}

// The same for a kernel whatever others there are (FNV-1a of its name).
uint64_t keyOf(const StressKernel& kernel, uint32_t seed)
{
	uint64_t hash = 0xcbf29ce484222325ULL;
	for (const char letter : kernel.name)
	{
		hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3ULL;
	}
	return stress::mixed(hash, seed);
}

void take(StressWorst& worst, double value, uint64_t index)
{
	if (!worst.at || value > worst.value)
	{
		worst = {value, index};
	}
}

void takeFirst(std::optional<uint64_t>& first, std::optional<uint64_t> index)
{
	if (!first)
	{
		first = index;
	}
}

void add(StressResult& result, const Case& one)
{
	result.cases += 1;
	result.compared += one.compared ? 1U : 0U;
	result.unsure += one.unsure ? 1U : 0U;
	if (one.broken)
	{
		result.broken += 1;
		takeFirst(result.first_broken, one.index());
	}
	if (one.outside)
	{
		result.outside += 1;
		takeFirst(result.first_outside, one.index());
	}
	if (one.compared && !one.unsure)
	{
		take(result.absolute, one.absolute, one.index());
		take(result.relative, one.relative, one.index());
	}
}

// `later`: of the cases that follow.
void add(StressResult& result, const StressResult& later)
{
	result.cases += later.cases;
	result.compared += later.compared;
	result.unsure += later.unsure;
	result.broken += later.broken;
	result.outside += later.outside;
	takeFirst(result.first_broken, later.first_broken);
	takeFirst(result.first_outside, later.first_outside);
	for (const auto member : {&StressResult::absolute, &StressResult::relative})
	{
		if ((later.*member).at)
		{
			take(result.*member, (later.*member).value, *(later.*member).at);
		}
	}
}

StressResult emptyResult(const StressKernel& kernel)
{
	StressResult result;
	result.name = kernel.name;
	result.family = kernel.family;
	result.what = kernel.what;
	result.unit = kernel.unit;
	result.most_absolute = kernel.most_absolute;
	return result;
}

StressResult runCases(const StressKernel& kernel, uint64_t key, uint64_t first, uint64_t end)
{
	StressResult result = emptyResult(kernel);
	for (uint64_t i = first; i < end; ++i)
	{
		Case one(key, i, i % kernel.twin_every == 0, nullptr);
		kernel.run(one);
		add(result, one);
	}
	return result;
}

// Cases that cost much come in smaller pieces, so that threads end together; of very many cases the pieces grow.
uint64_t chunkOf(const StressKernel& kernel, uint64_t cases)
{
	const uint64_t least = kernel.share >= 100 ? kChunk : kernel.share >= 10 ? kChunk / 16 : 16;
	return least * std::max<uint64_t>(1, cases / (least * kMostChunks));
}

void save(ByteWriter& out, const std::optional<uint64_t>& at)
{
	out.small(at ? 1 : 0);
	out.whole(at.value_or(0));
}

std::optional<uint64_t> optionalOf(ByteReader& in)
{
	const bool there = in.small() != 0;
	const uint64_t at = in.whole();
	return there ? std::optional(at) : std::nullopt;
}

std::string savedResult(const StressResult& result)
{
	ByteWriter out;
	for (const uint64_t count : {result.cases, result.compared, result.unsure, result.broken, result.outside})
	{
		out.whole(count);
	}
	save(out, result.first_broken);
	save(out, result.first_outside);
	for (const StressWorst& worst : {result.absolute, result.relative})
	{
		out.number(worst.value);
		save(out, worst.at);
	}
	return out.take();
}

bool loadResult(std::string_view bytes, StressResult& result)
{
	ByteReader in(bytes);
	for (uint64_t* const count : {&result.cases, &result.compared, &result.unsure, &result.broken, &result.outside})
	{
		*count = in.whole();
	}
	result.first_broken = optionalOf(in);
	result.first_outside = optionalOf(in);
	for (StressWorst* const worst : {&result.absolute, &result.relative})
	{
		worst->value = in.number();
		worst->at = optionalOf(in);
	}
	return in.isAtEnd();
}

StressResult runKernel(const StressKernel& kernel, uint64_t key, uint64_t cases, const RunSettings& run)
{
	const uint64_t chunk = chunkOf(kernel, cases);
	std::vector<StressResult> chunks(static_cast<std::size_t>((cases + chunk - 1) / chunk), emptyResult(kernel));
	const auto end = [&](std::size_t i)
	{
		return std::min<uint64_t>(cases, (i + 1) * chunk);
	};
	runStage({std::string(kernel.name), chunks.size(),
			  [&](std::size_t i) { return static_cast<double>(end(i) - i * chunk) / static_cast<double>(kernel.share); },
			  [&](std::size_t i) { chunks[i] = runCases(kernel, key, i * chunk, end(i)); },
			  [&](std::size_t i) { return savedResult(chunks[i]); },
			  [&](std::size_t i, std::string_view bytes)
			  {
				  return loadResult(bytes, chunks[i]) && chunks[i].cases == end(i) - i * chunk;
			  }},
			 run);
	StressResult result = emptyResult(kernel);
	for (const StressResult& one : chunks)
	{
		add(result, one);
	}
	return result;
}

} // namespace

std::vector<std::string_view> stressKernelNames()
{
	std::vector<std::string_view> names;
	for (const StressKernel* const kernel : allKernels())
	{
		names.push_back(kernel->name);
	}
	return names;
}

std::vector<StressResult> runStress(const StressSettings& settings, const RunSettings& run)
{
	std::vector<const StressKernel*> kernels;
	for (const std::string& name : settings.kernels)
	{
		kernels.push_back(&kernelOf(name));
	}
	if (kernels.empty())
	{
		kernels = allKernels();
	}
	uint64_t shares = 0;
	for (const StressKernel* const kernel : kernels)
	{
		shares += kernel->share;
	}
	std::vector<StressResult> results;
	ProgressCounter all(run.progress, "kernels", severalOf(kernels.size())); // cases are shared out by what they cost
	for (const StressKernel* const kernel : kernels)
	{
		const uint64_t cases =
			std::max<uint64_t>(1, settings.cases / shares * kernel->share + settings.cases % shares * kernel->share / shares);
		results.push_back(runKernel(*kernel, keyOf(*kernel, settings.seed), cases, run));
		all.finishOne();
	}
	finishUnits(run);
	return results;
}

StressCase showStressCase(std::string_view name, uint32_t seed, uint64_t index)
{
	const StressKernel& kernel = kernelOf(name);
	CaseNotes notes;
	Case one(keyOf(kernel, seed), index, true, &notes);
	kernel.run(one);
	StressResult result = emptyResult(kernel);
	add(result, one);
	notes.add("absolute error", one.absolute);
	notes.add("relative error", one.relative);
	if (one.unsure)
	{
		notes.add("verdict", std::string_view("rounding decides within the kernel: not compared"));
	}
	return {std::string(kernel.name) + ": " + std::string(kernel.what) + "\n" + notes.text(), result.passed()};
}

std::string commandOfCase(std::string_view kernel, uint32_t seed, uint64_t index)
{
	return "nook stress --kernel " + std::string(kernel) + " --seed " + std::to_string(seed) + " --case " + std::to_string(index);
}

} // namespace nook
