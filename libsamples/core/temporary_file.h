// SPDX-License-Identifier: GPL-3.0-or-later
// Temporary files, and folders created for outputs, are removed at the end of their scope and when a signal ends the program.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace nook
{

// Handles SIGINT, SIGTERM, SIGHUP, SIGQUIT and SIGXCPU (Windows: SIGINT, SIGTERM and SIGBREAK): removes temporary files, then ends
// the program with the default action. Signals that the parent set to be ignored stay ignored. SIGPIPE and SIGXFSZ become write
// errors. Call once in main().
void handleSignals();

// Removes what a signal would remove; for programs that exit without unwinding.
void removeTemporaryFiles();

// Delays signals for the lifetime of this object.
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
	// Construct before creating the file.
	explicit TemporaryFile(std::string path);
	TemporaryFile(TemporaryFile&& other) noexcept;
	TemporaryFile& operator=(TemporaryFile&&) = delete;
	~TemporaryFile();

	const std::string& path() const
	{
		return m_path;
	}

	// From then on the file is `target` and no longer temporary.
	void rename(const std::string& target, std::error_code& failed);

private:
	friend class NewFolders;
	struct Entry;
	friend void removeTemporaryFiles();
	static Entry* entryOf(const std::string& path, bool is_folder);
	static std::atomic<Entry*> s_entries; // the list only grows

	std::string m_path;
	Entry* m_entry;
};

// Folders created by this program. Those still empty at the end are removed.
class NewFolders
{
public:
	NewFolders() = default;
	NewFolders(const NewFolders&) = delete;
	NewFolders& operator=(const NewFolders&) = delete;
	~NewFolders();

	// Creates a folder and its missing parents.
	void make(const std::filesystem::path& path, std::error_code& failed);

private:
	std::vector<TemporaryFile::Entry*> m_entries; // outermost first
};

} // namespace nook
