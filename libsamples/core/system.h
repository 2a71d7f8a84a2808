// SPDX-License-Identifier: GPL-3.0-or-later
// What the operating systems do differently. Names of files are UTF-8 everywhere.
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

// The name of a file as the standard library takes it: its conversion from char knows no UTF-8 on Windows.
inline std::filesystem::path nativePath(const std::string& path)
{
	return std::filesystem::path(std::u8string(path.begin(), path.end()));
}

// As std::fopen(); null and errno where it cannot be.
std::FILE* openFile(const std::string& path, const char* mode);

// Nothing happens where there is none. May be called in a handler of a signal.
void removeFile(const char* path) noexcept;

// The same of a folder that is empty.
void removeFolder(const char* path) noexcept;

// What a file is, whatever its names are; nothing where it is not there.
std::optional<std::string> identityOfFile(const std::string& path);

// The same text for all spellings of a name that the system takes for one.
std::string nameKey(const std::string& path);

// Whether files can be made in a folder; else errno says why not.
bool isOpenFolder(const std::string& folder);

unsigned long processNumber();

// Of a processor, that this thread has had, seconds; negative where the system does not tell.
double threadSeconds();

// Whether a person sees what goes to stderr, or to any other stream.
bool isTerminal();
bool isTerminal(std::FILE* stream);

// For the beginning of main(): the arguments as UTF-8; what is written to stdout stays as it is.
std::vector<std::string> takeCommandLine(int argc, char** argv);

// Lets another thread go on, where this one has nothing to do but wait for the program's end.
void waitForEnd();

// Calls `handler` on the signals that ask a program to end, but for those that whoever started it ignores. A pipe that nobody reads
// and a file at its limit become errors of writing.
void onEndingSignals(void (*handler)(int));

// In that handler: ends the program as the signal does by itself.
void endBySignal(int signal);

} // namespace nook
