// SPDX-License-Identifier: GPL-3.0-or-later
// Kernels and builders against twins of more digits, over random and adversarial inputs: how wrong they get, where, and whether
// they ever return no number, or one out of its range.
#pragma once

#include "core/progress.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct StressSettings
{
	std::vector<std::string> kernels; // names; empty: all
	uint64_t cases = 1'000'000;       // of all of them together, shared out by what a case costs; ≥ 1
	uint32_t seed = 1;                // same seed, same cases, on any number of threads
};

// A greatest error, and the case that has it.
struct StressWorst
{
	double value = 0.0;
	std::optional<uint64_t> at; // none where nothing was compared
};

struct StressResult
{
	std::string_view name;
	std::string_view family;
	std::string_view what; // what is held against which twin
	std::string_view unit; // of absolute errors and of their threshold
	uint64_t cases = 0;
	uint64_t compared = 0; // with the twin
	uint64_t unsure = 0;   // of those: a comparison within the kernel may fall either way by rounding; errors are not counted
	uint64_t broken = 0;   // cases with a NaN or an infinity
	uint64_t outside = 0;  // cases with a result out of its range, or a property that does not hold
	std::optional<uint64_t> first_broken;
	std::optional<uint64_t> first_outside;
	StressWorst absolute;
	StressWorst relative; // share of the twin's size; none is counted where that is 0
	double most_absolute = 0.0;

	bool passed() const
	{
		return broken == 0 && outside == 0 && absolute.value <= most_absolute;
	}
};

std::vector<std::string_view> stressKernelNames();

// Throws Error (usage) for a name that is none. Same results on any number of threads.
std::vector<StressResult> runStress(const StressSettings& settings, const RunSettings& run);

// One case again: its input, the kernel's results and the twin's, a line each; numbers as hexadecimal and as decimal floats.
struct StressCase
{
	std::string text;
	bool passed = false; // the thresholds
};
StressCase showStressCase(std::string_view kernel, uint32_t seed, uint64_t index);

// "nook stress --kernel prism --seed 1 --case 7".
std::string commandOfCase(std::string_view kernel, uint32_t seed, uint64_t index);

// For people, one kernel a line and the commands of what did not pass; a table in Markdown; JSON, "schema": "nook.stress/1".
std::string stressText(const std::vector<StressResult>& results, const StressSettings& settings);
std::string stressMarkdown(const std::vector<StressResult>& results, const StressSettings& settings, std::string_view version);
std::string stressJson(const std::vector<StressResult>& results, const StressSettings& settings, std::string_view version);

} // namespace nook
