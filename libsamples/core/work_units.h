// SPDX-License-Identifier: GPL-3.0-or-later
// The expensive stages of a verb, cut into units that several runs of the program share out, and one puts together; or that one run
// keeps in a file, so that after its end, whatever that was, another one goes on.
#pragma once

#include "core/part_file.h"
#include "core/progress.h"

#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// A stage whose units do not depend on each other.
struct WorkStage
{
	std::string name; // of its progress, and in the files of parts
	std::size_t count = 0;
	std::function<double(std::size_t unit)> cost;                 // estimated, ≥ 0; one measure for all stages of a verb
	std::function<void(std::size_t unit)> compute;                // from any thread
	std::function<std::string(std::size_t unit)> save;            // what compute() found, every bit of it
	std::function<bool(std::size_t unit, std::string_view)> load; // instead of compute(); false: save() writes no such bytes
	std::string
		with{}; // an earlier stage, whose results for a unit compute() needs: units are dealt as there; empty: by their costs
	std::function<std::string(std::size_t unit)>
		group{}; // units of one name, in whatever stage, share what takes long to make: one part has them. None: each by itself
};

// Thrown where a part has done its share; no error.
struct PartIsDone
{
};

// Of one run of a verb that is split: a part that computes its own units and keeps them, or a merge that has them all. Or of a run
// that does all of the work and keeps its units in a file as they are done.
class WorkUnits
{
public:
	// `identity`: version and command.
	explicit WorkUnits(PartNumber part, PartFile identity = {});

	// Of all parts, as checkParts() leaves them.
	explicit WorkUnits(std::vector<PartFile> parts);

	// A run that goes on where another one of the same command, version and inputs was, as far as its file in this folder tells;
	// the folder is made where it is not. `identity`: version and command. Throws Error (file) where there can be no such folder.
	WorkUnits(const std::string& folder, PartFile identity);

	bool isPart() const
	{
		return m_parts.empty() && !isKept();
	}

	// All units are done in this run, and kept.
	bool isKept() const
	{
		return !m_path.empty();
	}

	// The files that the work depends on, before any unit of it; builtin levels are part of the program. A part remembers their
	// bytes, a merge compares. Throws Error: invalid_input where they differ, file where one cannot be read.
	void inputs(const std::vector<std::string>& paths);

	// Where runStage() is used in a run. Throws Error (invalid_input) naming the part's file where what it has is not its share.
	void run(const WorkStage& stage, const RunSettings& run);

	// In a merge: a stage that parts have run for nothing, since what they could not know changes its premise. Runs no more.
	void leave(const std::string& stage);

	// Of what every part of this command, version and inputs so far makes by itself: one text for all of them.
	std::string keyOf(const std::string& what) const;

	// After the last stage that is split. Throws PartIsDone in a part; Error (invalid_input) in a merge where a part has a stage
	// that the verb has not.
	void finish();

	// Of a run that keeps units: how many it has computed, how many its file had, and why that was of no use (empty: it was, or
	// there was none).
	struct Kept
	{
		std::size_t computed = 0;
		std::size_t known = 0;
		std::string remark;
	};
	const Kept& kept() const
	{
		return m_kept;
	}

	// What a part has done, after PartIsDone.
	const PartFile& result() const
	{
		return m_result;
	}

private:
	std::string nameOf(const std::string& stage);
	std::vector<int> groupOwners(const WorkStage& stage, std::span<const double> costs);
	const std::vector<int>& ownersOf(const std::string& name, const WorkStage& stage, std::span<const double> costs);
	void compute(const std::string& name, const WorkStage& stage, std::span<const int> owners, std::span<const double> costs,
				 const RunSettings& run);
	void load(const std::string& name, const WorkStage& stage, std::span<const int> owners) const;
	void keep(const std::string& name, const WorkStage& stage, std::span<const double> costs, const RunSettings& run);
	void forget(const std::string& why);
	void write();

	std::vector<PartFile> m_parts; // empty: this is a part
	PartFile m_result;
	PartNumber m_part;
	std::vector<double> m_loads;                      // what each part has to do, of all stages so far
	std::map<std::string, int> m_calls;               // by a stage's name
	std::map<std::string, std::vector<int>> m_owners; // of units, by stages' names in files
	std::map<std::string, int> m_group_owners;

	std::string m_path; // of a run that keeps its units
	PartFile m_known;   // what the file had
	Kept m_kept;
	std::mutex m_mutex;                                  // of m_result while units are computed
	std::chrono::steady_clock::time_point m_written{};   // the file, last
	std::chrono::steady_clock::duration m_write_took{0}; // that
};

// Whose a unit is, 0 to parts − 1, the same on every machine: the dearest first, each to the part with the least to do so far.
// `loads`: of every part, grows. Units of one cost are dealt in an order without pattern, so that neighbours are apart.
std::vector<int> dealUnits(std::span<const double> costs, std::vector<double>& loads);

// Computes all units, or a part's own, or takes them from parts.
void runStage(const WorkStage& stage, const RunSettings& run);

bool isPart(const RunSettings& run);

// Parts have done it all: no unit is computed here.
bool isMerge(const RunSettings& run);

// As WorkUnits; nothing in a run that is not split.
void addInputs(const std::vector<std::string>& paths, const RunSettings& run);
void finishUnits(const RunSettings& run);

} // namespace nook
