// SPDX-License-Identifier: GPL-3.0-or-later
// The expensive stages of a verb as lists of units. A store keeps each unit's result, so that a run continues where another one
// stopped and several machines can share the work.
#pragma once

#include "core/progress.h"
#include "core/store.h"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace nook
{

// A stage whose units do not depend on each other.
struct WorkStage
{
	std::string name; // for progress, and in the keys of its units
	std::size_t count = 0;
	std::function<double(std::size_t unit)> cost;                 // estimate ≥ 0, in one measure for all stages of a verb
	std::function<void(std::size_t unit)> compute;                // from any thread
	std::function<void(std::size_t unit, Archive& archive)> pass; // the result of compute(), every bit of it
	std::function<std::string(std::size_t unit)> group{};         // units of one group go to one share, in whatever stage they are
};

// Share `number` of `of`: 1 ≤ number ≤ of ≤ kMaxShares.
struct WorkShare
{
	int number = 1;
	int of = 1;
};
inline constexpr int kMaxShares = 100'000;

// The units of one run of a verb: where they are kept, and which of them this run computes.
class WorkUnits
{
public:
	// `identity`: everything that the results depend on except input files: the version of nook, then the command. With a share,
	// the run computes the units of that share only, and must be able to keep them. Throws Error (file) as Store.
	WorkUnits(const std::string& folder, std::span<const std::string> identity, std::optional<WorkShare> share = std::nullopt);

	bool isShare() const
	{
		return m_share.has_value();
	}

	Store& store()
	{
		return m_store;
	}

	// The results of the following units depend on the bytes of these files too. Builtin levels are part of the program. Throws
	// Error (file) if one cannot be read.
	void addInputs(const std::vector<std::string>& paths);

	// Used by runStage(). Throws Error (file) in a share if a result cannot be kept.
	void run(const WorkStage& stage, const RunSettings& run);

	// The key of a value that depends on this command and the inputs so far.
	std::string keyOf(const std::string& what, std::size_t unit = 0) const;

	// Keeps a note that this run is done, for statusOfWork().
	void finish();

private:
	std::vector<std::size_t> ownUnits(const WorkStage& stage, std::span<const double> costs);

	std::vector<std::string> m_identity;
	std::optional<WorkShare> m_share;
	Store m_store;
	std::vector<std::string> m_inputs;   // paths
	std::vector<std::string> m_hashes;   // of their bytes
	std::map<std::string, int> m_calls;  // by a stage's name
	std::vector<double> m_loads;         // the work of each share so far
	std::map<std::string, int> m_owners; // of groups
};

// Returns the results that a finished command has used, or nothing if it has not finished or its inputs have changed since. Paths
// of inputs are resolved in `folder`.
std::optional<std::size_t> finishedUnits(Store& store, std::span<const std::string> identity, std::optional<WorkShare> share,
										 const std::string& folder);

// The share that computes each unit, 0 to shares − 1, the same on every machine. Longest-processing-time-first scheduling: each
// unit goes to the least loaded share, largest unit first. `loads` of the shares grow. Units of equal cost are dealt in a mixed
// order, so that neighbours go to different shares.
std::vector<int> dealUnits(std::span<const double> costs, std::vector<double>& loads);

// Computes all units, or takes them from the run's store. A share computes its own units only, and knows nothing of the others.
void runStage(const WorkStage& stage, const RunSettings& run);

// Computes one value that every share needs, or takes it from the run's store. Reports its own progress and has its own threads.
void runOnce(const std::string& name, const std::function<void()>& compute, const Visitor& pass, const RunSettings& run);

// Whether this run is a share: the results of its stages are incomplete, and it writes no output.
bool isShare(const RunSettings& run);

// Calls WorkUnits::addInputs(); does nothing in a run without a store.
void addInputs(const std::vector<std::string>& paths, const RunSettings& run);

} // namespace nook
