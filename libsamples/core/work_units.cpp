// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/work_units.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_hash.h"
#include "core/parallel.h"
#include "core/system.h"

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <numeric>
#include <queue>
#include <utility>

namespace nook
{
namespace
{

// Between writings of a file of kept units, and how much longer than a writing takes that has to be.
constexpr std::chrono::seconds kWritePause{2};
constexpr int kWriteShare = 20;

// Finalising steps of SplitMix64 (G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators", 2014): an order of
// indices without pattern.
uint64_t mixed(uint64_t index)
{
	uint64_t z = (index + 1) * 0x9e3779b97f4a7c15ULL;
	z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
	z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
	return z ^ (z >> 31U);
}

std::vector<double> costsOf(const WorkStage& stage)
{
	std::vector<double> costs(stage.count);
	for (std::size_t i = 0; i < stage.count; ++i)
	{
		costs[i] = stage.cost(i);
	}
	return costs;
}

// The dearest first, so that no thread is left with one of them at the end. `done`: may be empty.
void computeAll(const WorkStage& stage, std::vector<std::size_t> units, std::span<const double> costs, const RunSettings& run,
				const std::function<void(std::size_t)>& done = {})
{
	std::stable_sort(units.begin(), units.end(), [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
	ProgressCounter progress(run.progress, stage.name, units.size());
	parallelFor(units.size(), run.threads,
				[&](std::size_t i)
				{
					stage.compute(units[i]);
					if (done)
					{
						done(units[i]);
					}
					progress.finishOne();
				});
}

} // namespace

std::vector<int> dealUnits(std::span<const double> costs, std::vector<double>& loads)
{
	std::vector<std::size_t> order(costs.size());
	std::iota(order.begin(), order.end(), std::size_t{0});
	std::sort(order.begin(), order.end(),
			  [&](std::size_t a, std::size_t b)
			  { return costs[a] != costs[b] ? costs[a] > costs[b] : mixed(a) < mixed(b); }); // mixed() is one to one
	using Place = std::pair<double, int>;                                                    // a load, and whose
	std::priority_queue<Place, std::vector<Place>, std::greater<>> least;
	for (std::size_t i = 0; i < loads.size(); ++i)
	{
		least.emplace(loads[i], static_cast<int>(i));
	}
	std::vector<int> owners(costs.size());
	for (const std::size_t unit : order)
	{
		const auto [load, owner] = least.top();
		least.pop();
		owners[unit] = owner;
		loads[static_cast<std::size_t>(owner)] = load + costs[unit];
		least.emplace(load + costs[unit], owner);
	}
	return owners;
}

WorkUnits::WorkUnits(PartNumber part, PartFile identity)
	: m_result(std::move(identity)), m_part(part), m_loads(static_cast<std::size_t>(part.of))
{
	m_result.part = part;
}

WorkUnits::WorkUnits(std::vector<PartFile> parts) : m_parts(std::move(parts)), m_loads(m_parts.size()) {}

WorkUnits::WorkUnits(const std::string& folder, PartFile identity) : m_result(std::move(identity))
{
	ContentHash name;
	for (const std::string& word : m_result.command)
	{
		name.add(word);
	}
	std::error_code problem;
	std::filesystem::create_directory(nativePath(folder), problem);
	if (!std::filesystem::is_directory(nativePath(folder)))
	{
		throw Error(ExitCode::file, folder + ": found " +
										(std::filesystem::exists(nativePath(folder)) ? "a file" : problem.message()) +
										", expected a folder for what is done, or a place for one");
	}
	m_path = (nativePath(folder) / (name.text() + ".part")).string();
	m_result.part = {1, 1};
	if (!std::filesystem::exists(nativePath(m_path), problem))
	{
		return;
	}
	try
	{
		m_known = partFrom(readFile(m_path), m_path);
	}
	catch (const Error& error)
	{
		forget(error.what());
		return;
	}
	if (m_known.version != m_result.version)
	{
		forget(m_path + ": found what nook " + m_known.version + " has kept, expected nook " + m_result.version);
	}
	else if (m_known.command != m_result.command || m_known.part != m_result.part)
	{
		forget(m_path + ": found what another command has kept, expected this one's");
	}
}

void WorkUnits::forget(const std::string& why)
{
	m_known.stages.clear();
	m_known.inputs.clear();
	m_kept.remark = why + ": it is made anew";
}

void WorkUnits::inputs(const std::vector<std::string>& paths)
{
	for (const std::string& path : paths)
	{
		const bool own = isPart() || isKept();
		const std::vector<PartInput>& known = own ? m_result.inputs : m_parts.front().inputs;
		const auto found = std::find_if(known.begin(), known.end(), [&](const PartInput& input) { return input.path == path; });
		if (path.starts_with("builtin:") || (own && found != known.end()))
		{
			continue;
		}
		if (own)
		{
			const std::size_t index = m_result.inputs.size();
			m_result.inputs.push_back({path, hashOfFile(path)});
			if (!m_known.stages.empty() && (index >= m_known.inputs.size() || m_known.inputs[index] != m_result.inputs[index]))
			{
				forget(m_path + ": found it made from other bytes of " + path);
			}
		}
		else if (found == known.end() || found->hash != hashOfFile(path))
		{
			throw Error(ExitCode::invalid_input, path + ": found other bytes than " + m_parts.front().path +
													 " was made from, expected them unchanged since the parts were made");
		}
	}
}

// A stage may be run several times: "rays", "rays 2".
std::string WorkUnits::nameOf(const std::string& stage)
{
	const int call = ++m_calls[stage];
	return call == 1 ? stage : stage + " " + std::to_string(call);
}

std::vector<int> WorkUnits::groupOwners(const WorkStage& stage, std::span<const double> costs)
{
	std::vector<std::string> names(stage.count);
	std::map<std::string, double> sums; // of groups that are nobody's yet
	for (std::size_t i = 0; i < stage.count; ++i)
	{
		names[i] = stage.group(i);
		const auto owner = m_group_owners.find(names[i]);
		(owner != m_group_owners.end() ? m_loads[static_cast<std::size_t>(owner->second)] : sums[names[i]]) += costs[i];
	}
	std::vector<double> fresh;
	for (const auto& [name, cost] : sums)
	{
		fresh.push_back(cost);
	}
	const std::vector<int> dealt = dealUnits(fresh, m_loads);
	std::size_t next = 0;
	for (const auto& [name, cost] : sums)
	{
		m_group_owners[name] = dealt[next++];
	}
	std::vector<int> owners;
	for (const std::string& name : names)
	{
		owners.push_back(m_group_owners.at(name));
	}
	return owners;
}

const std::vector<int>& WorkUnits::ownersOf(const std::string& name, const WorkStage& stage, std::span<const double> costs)
{
	std::vector<int>& owners = m_owners[name];
	if (stage.group)
	{
		owners = groupOwners(stage, costs);
		return owners;
	}
	if (stage.with.empty())
	{
		owners = dealUnits(costs, m_loads);
		return owners;
	}
	owners = m_owners.at(stage.with);
	assert(owners.size() == stage.count);
	for (std::size_t i = 0; i < stage.count; ++i)
	{
		m_loads[static_cast<std::size_t>(owners[i])] += costs[i];
	}
	return owners;
}

void WorkUnits::run(const WorkStage& stage, const RunSettings& run)
{
	const std::string name = nameOf(stage.name);
	const std::vector<double> costs = costsOf(stage);
	if (isKept())
	{
		keep(name, stage, costs, run);
		return;
	}
	const std::vector<int>& owners = ownersOf(name, stage, costs);
	if (isPart())
	{
		compute(name, stage, owners, costs, run);
	}
	else
	{
		load(name, stage, owners);
	}
}

void WorkUnits::compute(const std::string& name, const WorkStage& stage, std::span<const int> owners, std::span<const double> costs,
						const RunSettings& run)
{
	std::vector<std::size_t> own;
	for (std::size_t i = 0; i < stage.count; ++i)
	{
		if (owners[i] == m_part.number - 1)
		{
			own.push_back(i);
		}
	}
	computeAll(stage, own, costs, run);
	UnitResults& results = m_result.stages[name];
	for (const std::size_t unit : own)
	{
		results[unit] = stage.save(unit);
	}
}

void WorkUnits::keep(const std::string& name, const WorkStage& stage, std::span<const double> costs, const RunSettings& run)
{
	UnitResults known = std::move(m_known.stages[name]);
	UnitResults& results = m_result.stages[name];
	std::vector<std::size_t> left;
	for (std::size_t i = 0; i < stage.count; ++i)
	{
		const auto found = known.find(i);
		if (found != known.end() && stage.load(i, found->second))
		{
			results.emplace(i, std::move(found->second));
			m_kept.known += 1;
		}
		else
		{
			left.push_back(i);
		}
	}
	m_kept.computed += left.size();
	computeAll(stage, std::move(left), costs, run,
			   [&](std::size_t unit)
			   {
				   std::string saved = stage.save(unit);
				   const std::lock_guard lock(m_mutex);
				   results.emplace(unit, std::move(saved));
				   if (std::chrono::steady_clock::now() - m_written >
					   std::max<std::chrono::steady_clock::duration>(kWritePause, kWriteShare * m_write_took))
				   {
					   write();
				   }
			   });
}

// What is known of later stages is kept as well.
void WorkUnits::write()
{
	const auto start = std::chrono::steady_clock::now();
	PartFile all = m_result;
	for (const auto& [name, units] : m_known.stages)
	{
		if (!units.empty() && !all.stages.contains(name))
		{
			all.stages[name] = units;
		}
	}
	writeFile(m_path, partBytes(all));
	m_written = std::chrono::steady_clock::now();
	m_write_took = m_written - start;
}

void WorkUnits::load(const std::string& name, const WorkStage& stage, std::span<const int> owners) const
{
	std::vector<std::size_t> counts(m_parts.size());
	for (std::size_t i = 0; i < stage.count; ++i)
	{
		const auto owner = static_cast<std::size_t>(owners[i]);
		const PartFile& part = m_parts[owner];
		counts[owner] += 1;
		const auto results = part.stages.find(name);
		const auto found = results == part.stages.end() ? UnitResults::const_iterator() : results->second.find(i);
		if (results == part.stages.end() || found == results->second.end() || !stage.load(i, found->second))
		{
			throw Error(ExitCode::invalid_input, part.path + ": stage '" + name + "': unit " + std::to_string(i) +
													 ": found none that fits, expected it in this part");
		}
	}
	for (std::size_t k = 0; k < m_parts.size(); ++k)
	{
		const auto results = m_parts[k].stages.find(name);
		const std::size_t found = results == m_parts[k].stages.end() ? 0 : results->second.size();
		if (found != counts[k])
		{
			throw Error(ExitCode::invalid_input, m_parts[k].path + ": stage '" + name + "': found " + std::to_string(found) +
													 " units, expected " + std::to_string(counts[k]));
		}
	}
}

std::string WorkUnits::keyOf(const std::string& what) const
{
	const PartFile& own = m_parts.empty() ? m_result : m_parts.front();
	ContentHash key;
	key.add(own.version);
	for (const std::string& word : own.command)
	{
		key.add(word);
	}
	for (const PartInput& input : own.inputs)
	{
		key.add(input.path);
		key.add(input.hash);
	}
	key.add(what);
	return key.text();
}

void WorkUnits::leave(const std::string& stage)
{
	m_owners[nameOf(stage)];
}

void WorkUnits::finish()
{
	if (isPart())
	{
		throw PartIsDone{};
	}
	if (isKept())
	{
		write();
		return;
	}
	for (const PartFile& part : m_parts)
	{
		for (const auto& [name, units] : part.stages)
		{
			if (!m_owners.contains(name))
			{
				throw Error(ExitCode::invalid_input,
							part.path + ": found a stage '" + name + "' that this command has not, expected none");
			}
		}
	}
}

bool isPart(const RunSettings& run)
{
	return run.units != nullptr && run.units->isPart();
}

bool isMerge(const RunSettings& run)
{
	return run.units != nullptr && !run.units->isPart() && !run.units->isKept();
}

void runStage(const WorkStage& stage, const RunSettings& run)
{
	if (run.units != nullptr)
	{
		run.units->run(stage, run);
		return;
	}
	std::vector<std::size_t> all(stage.count);
	std::iota(all.begin(), all.end(), std::size_t{0});
	computeAll(stage, std::move(all), costsOf(stage), run);
}

void addInputs(const std::vector<std::string>& paths, const RunSettings& run)
{
	if (run.units != nullptr)
	{
		run.units->inputs(paths);
	}
}

void finishUnits(const RunSettings& run)
{
	if (run.units != nullptr)
	{
		run.units->finish();
	}
}

} // namespace nook
