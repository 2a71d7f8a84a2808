// SPDX-License-Identifier: GPL-3.0-or-later
// The one store of finished work: a folder of values, each in its own file, under the hash of all that it depends on.
#pragma once

#include "core/archive.h"
#include "core/file.h"

#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace nook
{

// Values appear whole or not at all, each with a checksum of its key and bytes, so any number of processes may share a folder. A
// value that is damaged counts as missing. Safe to use from any thread.
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

	// Loads the value, or computes it while other processes that need the same value wait for this one. Keeps it if compute()
	// returns true.
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

} // namespace nook
