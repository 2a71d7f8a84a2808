// SPDX-License-Identifier: GPL-3.0-or-later
// Files that must not outlive their use, and folders made for files that did not come: removed when that ends, and when a signal
// ends the program.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace nook
{

// Ends the program on SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGXCPU (Windows: SIGINT, SIGTERM and SIGBREAK) as they do by
// themselves, but removes temporary files first; those that whoever started it ignores stay ignored. A pipe that nobody reads and a
// file at its limit become errors of writing (SIGPIPE, SIGXFSZ). For main(), once.
void handleSignals();

// What a signal would remove. For the last moment of a program that ends without leaving its functions.
void removeTemporaryFiles();

// Between these two moments no signal ends the program; one that came does then.
class SignalsHeld
{
public:
	SignalsHeld();
	SignalsHeld(const SignalsHeld&) = delete;
	SignalsHeld& operator=(const SignalsHeld&) = delete;
	~SignalsHeld();
};

class TemporaryFile
{
public:
	// Before a file of that name is made.
	explicit TemporaryFile(std::string path);
	TemporaryFile(TemporaryFile&& other) noexcept;
	TemporaryFile& operator=(TemporaryFile&&) = delete;
	~TemporaryFile();

	const std::string& path() const
	{
		return m_path;
	}

	// From now on it is the file `target`.
	void rename(const std::string& target, std::error_code& failed);

private:
	friend class NewFolders;
	struct Entry;
	friend void removeTemporaryFiles();
	static Entry* entryOf(const std::string& path, bool is_folder);
	static std::atomic<Entry*> s_entries; // a list that only grows

	std::string m_path;
	Entry* m_entry;
};

// Folders that this program made. Those that are still empty in the end are removed.
class NewFolders
{
public:
	NewFolders() = default;
	NewFolders(const NewFolders&) = delete;
	NewFolders& operator=(const NewFolders&) = delete;
	~NewFolders();

	// A folder, and those above it, as far as they are not there.
	void make(const std::filesystem::path& path, std::error_code& failed);

private:
	std::vector<TemporaryFile::Entry*> m_entries; // the outer ones first
};

} // namespace nook
