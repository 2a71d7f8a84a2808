// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/work_units.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/system.h"

#include <algorithm>
#include <filesystem>
#include <queue>
#include <utility>

namespace nook
{
namespace
{

// The most expensive first, so that no thread is left with one of them at the end.
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

std::string keyFrom(std::span<const std::string> identity, std::span<const std::string> inputs, std::span<const std::string> hashes,
					const std::string& what, std::size_t unit)
{
	ContentHash key;
	for (const std::span<const std::string> list : {identity, inputs, hashes})
	{
		key.add(list.size());
		for (const std::string& word : list)
		{
			key.add(word);
		}
	}
	key.add(what);
	key.add(unit);
	return key.text();
}

// The key of the note that a run is done.
std::string doneKey(std::span<const std::string> identity, const std::optional<WorkShare>& share)
{
	return keyFrom(identity, {}, {}, share ? "share " + std::to_string(share->number) + "/" + std::to_string(share->of) : "all", 0);
}

// The contents of that note.
struct DoneNote
{
	std::vector<std::string> inputs;
	std::vector<std::string> hashes;
	uint64_t units = 0;
};

void visit(Archive& archive, DoneNote& note)
{
	archive(note.inputs, note.hashes, note.units);
}

namespace fs = std::filesystem;

constexpr std::string_view kValueMagic = "nook.value/1 ";

// A value's first line: the format, and a checksum of the key and the bytes that follow.
std::string headOf(const std::string& key, std::string_view value)
{
	ContentHash sum;
	sum.add(key);
	sum.add(value);
	return std::string(kValueMagic) + sum.text() + "\n";
}

} // namespace

std::vector<int> dealUnits(std::span<const double> costs, std::vector<double>& loads)
{
	std::vector<std::size_t> order = countingFrom(std::size_t{0}, costs.size());
	std::sort(order.begin(), order.end(),
			  [&](std::size_t a, std::size_t b)
			  {
				  return costs[a] != costs[b] ? costs[a] > costs[b] : splitMix(0, a) < splitMix(0, b);
			  });                         // an order without pattern; splitMix() is one to one
	using Place = std::pair<double, int>; // a load, and whose
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

WorkUnits::WorkUnits(const std::string& folder, std::span<const std::string> identity, std::optional<WorkShare> share)
	: m_identity(identity.begin(), identity.end()), m_share(share), m_store(folder, m_identity.front(), share.has_value()),
	  m_loads(static_cast<std::size_t>(share ? share->of : 1))
{
}

void WorkUnits::addInputs(const std::vector<std::string>& paths)
{
	for (const std::string& path : paths)
	{
		if (!path.starts_with("builtin:") && std::find(m_inputs.begin(), m_inputs.end(), path) == m_inputs.end())
		{
			m_inputs.push_back(path);
			m_hashes.push_back(hashOfFile(path));
		}
	}
}

std::string WorkUnits::keyOf(const std::string& what, std::size_t unit) const
{
	return keyFrom(m_identity, m_inputs, m_hashes, what, unit);
}

// The units that this run is to have: all, or those of its share.
std::vector<std::size_t> WorkUnits::ownUnits(const WorkStage& stage, std::span<const double> costs)
{
	if (!m_share)
	{
		return countingFrom(std::size_t{0}, stage.count);
	}
	std::vector<std::string> names(stage.count);
	std::map<std::string, double> sums; // of groups without an owner; their order is that of their names
	for (std::size_t i = 0; i < stage.count; ++i)
	{
		const std::string number = std::to_string(i);
		names[i] = stage.group ? stage.group(i) : stage.name + std::string(20 - number.size(), '0') + number;
		const auto owner = m_owners.find(names[i]);
		(owner != m_owners.end() ? m_loads[static_cast<std::size_t>(owner->second)] : sums[names[i]]) += costs[i];
	}
	const std::vector<int> dealt = dealUnits(mapped(sums, [](const auto& sum) { return sum.second; }), m_loads);
	std::size_t next = 0;
	for (const auto& [name, cost] : sums)
	{
		m_owners[name] = dealt[next++];
	}
	return indicesWhere(stage.count, [&](std::size_t i) { return m_owners.at(names[i]) == m_share->number - 1; });
}

void WorkUnits::run(const WorkStage& stage, const RunSettings& run)
{
	const int call = ++m_calls[stage.name]; // a stage may run several times
	const std::string name = stage.name + " " + std::to_string(call);
	const std::vector<double> costs = listOf(stage.count, stage.cost);
	std::vector<std::size_t> missing;
	for (const std::size_t unit : ownUnits(stage, costs))
	{
		if (!m_store.load(keyOf(name, unit), [&](Archive& archive) { stage.pass(unit, archive); }))
		{
			missing.push_back(unit);
		}
	}
	computeAll(stage, std::move(missing), costs, run,
			   [&](std::size_t unit)
			   { m_store.keep(keyOf(name, unit), bytesOf([&](Archive& archive) { stage.pass(unit, archive); })); });
}

void WorkUnits::finish()
{
	DoneNote note{m_inputs, m_hashes, m_store.kept() + m_store.found()};
	m_store.put(doneKey(m_identity, m_share), note);
}

std::optional<std::size_t> finishedUnits(Store& store, std::span<const std::string> identity, std::optional<WorkShare> share,
										 const std::string& folder)
{
	const std::optional<DoneNote> note = store.get<DoneNote>(doneKey(identity, share));
	for (std::size_t i = 0; note && i < note->inputs.size(); ++i)
	{
		const std::string path = (nativePath(folder) / nativePath(note->inputs[i])).string();
		std::error_code none;
		if (i >= note->hashes.size() || !std::filesystem::is_regular_file(nativePath(path), none) ||
			hashOfFile(path) != note->hashes[i])
		{
			return std::nullopt;
		}
	}
	return note ? std::optional(static_cast<std::size_t>(note->units)) : std::nullopt;
}

bool isShare(const RunSettings& run)
{
	return run.units != nullptr && run.units->isShare();
}

void runStage(const WorkStage& stage, const RunSettings& run)
{
	if (run.units != nullptr)
	{
		run.units->run(stage, run);
		return;
	}
	computeAll(stage, countingFrom(std::size_t{0}, stage.count), listOf(stage.count, stage.cost), run);
}

void runOnce(const std::string& name, const std::function<void()>& compute, const Visitor& pass, const RunSettings& run)
{
	if (run.units != nullptr)
	{
		run.units->store().once(
			run.units->keyOf(name),
			[&compute]
			{
				compute();
				return true;
			},
			pass);
		return;
	}
	compute();
}

void addInputs(const std::vector<std::string>& paths, const RunSettings& run)
{
	if (run.units != nullptr)
	{
		run.units->addInputs(paths);
	}
}

Store::Store(std::string folder, std::string version, bool must_keep)
	: m_folder(std::move(folder)), m_version(std::move(version)), m_must_keep(must_keep)
{
	std::error_code problem;
	m_new.make(nativePath(m_folder), problem);
	refuseIf(!fs::is_directory(nativePath(m_folder)),
			 m_folder + ": found " + (fs::exists(nativePath(m_folder)) ? "a file" : problem.message()) +
				 ", expected a folder for finished work, or a place for one",
			 ExitCode::file);
}

std::string Store::pathOf(const std::string& key) const
{
	ContentHash hash;
	hash.add(m_version);
	hash.add(key);
	const std::string name = hash.text();
	return (nativePath(m_folder) / name.substr(0, 2) / name.substr(2)).string();
}

void Store::note(const std::string& what)
{
	const std::lock_guard lock(m_mutex);
	if (m_remark.empty())
	{
		m_remark = what;
	}
}

std::string Store::remark() const
{
	const std::lock_guard lock(m_mutex);
	return m_remark;
}

std::optional<std::string> Store::find(const std::string& key)
{
	const std::string path = pathOf(key);
	std::error_code none;
	if (!fs::exists(path, none))
	{
		return std::nullopt;
	}
	std::string bytes;
	try
	{
		bytes = readFile(path);
	}
	catch (const Error& error)
	{
		note(error.what());
		return std::nullopt;
	}
	const std::size_t size = headOf(key, "").size();
	const std::string_view value = std::string_view(bytes).substr(std::min(size, bytes.size()));
	if (!bytes.starts_with(headOf(key, value)))
	{
		note(path + ": found a value that was cut short or changed (its checksum differs), expected it as it was written");
		return std::nullopt;
	}
	bytes.erase(0, size);
	return bytes;
}

void Store::keep(const std::string& key, std::string_view value)
{
	m_kept += 1;
	if (value.size() > kMaxFileBytes - 64) // more than readFile() takes
	{
		return;
	}
	const std::string path = pathOf(key);
	try
	{
		std::error_code none; // writing says why
		fs::create_directories(nativePath(path).parent_path(), none);
		writeFile(path, headOf(key, value) + std::string(value));
	}
	catch (const Error& error)
	{
		if (m_must_keep)
		{
			throw;
		}
		note(error.what());
	}
}

bool Store::load(const std::string& key, const Visitor& visitor)
{
	const std::optional<std::string> value = find(key);
	const bool well = value && readBytes(*value, visitor);
	m_found += well ? 1 : 0;
	return well;
}

void Store::once(const std::string& key, const std::function<bool()>& compute, const Visitor& visitor)
{
	if (load(key, visitor))
	{
		return;
	}
	std::error_code none;
	fs::create_directories(nativePath(pathOf(key)).parent_path(), none);
	const FileLock lock(pathOf(key) + ".lock");
	if (!load(key, visitor) && compute())
	{
		keep(key, bytesOf(visitor));
	}
}

} // namespace nook
