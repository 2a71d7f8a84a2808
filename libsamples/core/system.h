// SPDX-License-Identifier: GPL-3.0-or-later
// Differences between operating systems. File names are UTF-8 everywhere.
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

// Path for the standard library, whose conversion from char is not UTF-8 on Windows.
inline std::filesystem::path nativePath(const std::string& path)
{
	return std::filesystem::path(std::u8string(path.begin(), path.end()));
}

// Like std::fopen(): returns null and sets errno on failure.
std::FILE* openFile(const std::string& path, const char* mode);

// Ignores a missing file. Safe in a signal handler.
void removeFile(const char* path) noexcept;

// Removes an empty folder, likewise.
void removeFolder(const char* path) noexcept;

// Identifies a file independently of its name; nothing if it does not exist.
std::optional<std::string> identityOfFile(const std::string& path);

// Maps all spellings that the system considers one name to the same text.
std::string nameKey(const std::string& path);

// True if files can be created in a folder; otherwise errno gives the reason.
bool isOpenFolder(const std::string& folder);

// Waits until no other process holds a lock on the file, which is made if it is missing, and holds it. Does nothing where the
// system or the file system has no locks.
class FileLock
{
public:
	explicit FileLock(const std::string& path);
	FileLock& operator=(FileLock&&) = delete;
	~FileLock();

private:
	int m_file = -1;
};

unsigned long processNumber();

// Processor time of this thread in seconds; negative if the system does not provide it.
double threadSeconds();

// True if the stream (default: stderr) is a terminal.
bool isTerminal();
bool isTerminal(std::FILE* stream);

// Call first in main(): returns the arguments as UTF-8 and makes stdout binary.
std::vector<std::string> takeCommandLine(int argc, char** argv);

// Yields to another thread while waiting for the program's end.
void waitForEnd();

// Calls `handler` on termination signals that the parent did not ignore. Broken pipes and size limits become write errors.
void onEndingSignals(void (*handler)(int));

// In that handler: ends the program with the signal's default action.
void endBySignal(int signal);

} // namespace nook
