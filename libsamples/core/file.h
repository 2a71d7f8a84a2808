// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and writes whole files. The outputs of one run appear complete and together, or not at all.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace nook
{

// Temporary files, and folders created for outputs, are removed at the end of their scope and when a signal ends the program.

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
	SignalsHeld& operator=(SignalsHeld&&) = delete;
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
	NewFolders& operator=(NewFolders&&) = delete;
	~NewFolders();

	// Creates a folder and its missing parents.
	void make(const std::filesystem::path& path, std::error_code& failed);

private:
	std::vector<TemporaryFile::Entry*> m_entries; // outermost first
};

inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30U; // limit of readFile

// Throws Error (file) with the path and the system's reason.
std::string readFile(const std::string& path);

// Throws Error (file) if `path` cannot become a file: its folder is missing or not writable, or a folder has its name. Lets a verb
// fail before long work; "-" passes. Writing can still fail later.
void checkWritable(const std::string& path);

// Returns the same text for every name of one file: device and inode if it exists, else its resolved path; "-" is itself.
std::string fileIdentity(const std::string& path);

// Writes a temporary file next to `path` and renames it. "-" is standard output; devices and pipes are written directly. A failure
// leaves nothing behind. Throws Error (file).
void writeFile(const std::string& path, std::string_view bytes);

// The outputs of one run. Each is written to a temporary file when added; commit() makes them all appear.
// Uncommitted files are removed, also when a signal ends the program.
class OutputSet
{
public:
	OutputSet& operator=(OutputSet&&) = delete;

	// Arguments as for writeFile. Throws Error (file).
	void add(const std::string& path, std::string_view bytes);

	// Writes devices and standard output first, since they cannot be undone, then renames. If it throws Error (file), no new file
	// exists and the old ones are unchanged.
	void commit();

private:
	struct Renaming
	{
		TemporaryFile temporary;
		std::string target;               // with links resolved
		std::string path;                 // as the user wrote it
		std::optional<TemporaryFile> old; // backup of the replaced file during commit()
	};
	struct Direct
	{
		std::string path;
		std::string bytes;
	};
	static void keepOld(Renaming& renaming);
	void takeBack(std::size_t count);

	std::vector<Renaming> m_renamings;
	std::vector<Direct> m_directs;
};

// Names in glTF: "a%20b.png" → "a b.png"; a % without a valid code stays.
std::string unescaped(const std::string& uri);
std::string escapedUri(const std::string& name);

// A rule for GNU Make and Ninja: "target…: source…" with each path escaped. Throws Error (unsupported) for a path that Make 4.3 or
// Ninja 1.11 cannot hold: in a makefile it could run a command, and in Ninja's log it could name another file.
std::string depfileText(std::span<const std::string> targets, std::span<const std::string> sources);

} // namespace nook
