// SPDX-License-Identifier: GPL-3.0-or-later
// The expensive stages of a verb as lists of units. A store keeps each unit's result, so that a run continues where another one
// stopped and several machines can share the work.
#pragma once

#include "core/archive.h"
#include "core/file.h"
#include "core/progress.h"

#include <atomic>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// The one store of finished work: a folder of values, each in its own file, under the hash of all that it depends on. Values appear
// whole or not at all, each with a checksum of its key and bytes, so any number of processes may share a folder. A value that is
// damaged counts as missing. Safe to use from any thread.
class Store
{
public:
	// Makes the folder if it is missing. Throws Error (file) if that fails. Values of another `version` of nook are not seen. With
	// `must_keep`, keep() throws Error (file) if a value cannot be written; without it, that becomes a remark().
	Store(std::string folder, std::string version, bool must_keep = false);

	std::optional<std::string> find(const std::string& key);
	void keep(const std::string& key, std::string_view value);

	// Reads a value through the visitor, or returns false.
	bool load(const std::string& key, const Visitor& visitor);

	template <class Value> std::optional<Value> get(const std::string& key)
	{
		Value value;
		return load(key, [&](Archive& archive) { archive(value); }) ? std::optional(std::move(value)) : std::nullopt;
	}
	template <class Value> void put(const std::string& key, Value value)
	{
		keep(key, bytesOf([&](Archive& archive) { archive(value); }));
	}

	// Loads the value, or computes it while other processes wait for it. Keeps it if compute() returns true.
	void once(const std::string& key, const std::function<bool()>& compute, const Visitor& visitor);

	// Values that this run has kept, and found.
	std::size_t kept() const
	{
		return m_kept;
	}
	std::size_t found() const
	{
		return m_found;
	}

	// The first value that was damaged, or could not be written; empty if there was none.
	std::string remark() const;

private:
	std::string pathOf(const std::string& key) const;
	void note(const std::string& what);

	NewFolders m_new; // goes again if nothing was kept
	std::string m_folder;
	std::string m_version;
	bool m_must_keep;
	std::atomic<std::size_t> m_kept{0};
	std::atomic<std::size_t> m_found{0};
	std::string m_remark;
	mutable std::mutex m_mutex;
};

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

	// Later results depend on the bytes of these files too, except for builtin levels. Throws Error (file) if one cannot be read.
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

// Returns the number of results of a finished command whose inputs, resolved in `folder`, have not changed since, or nothing.
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
