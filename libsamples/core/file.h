// SPDX-License-Identifier: GPL-3.0-or-later
// Whole files in and out; the outputs of one run appear complete and together, or not at all.
#pragma once

#include "core/temporary_file.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30U; // what readFile takes in; more is a mistake or an attack

// The file's bytes. Throws Error (file) with the path and the system's reason.
std::string readFile(const std::string& path);

// Throws Error (file) when `path` cannot become a file: its folder is missing or closed to us, or a folder has its name.
// For an answer before long work; "-" passes. Writing can still fail later.
void checkWritable(const std::string& path);

// The same text for every name of one file, through links and other spellings: by device and number where it is there, else by
// where it would come to be. "-" is itself.
std::string fileIdentity(const std::string& path);

// Writes to a temporary file beside `path` and renames it; "-" is standard output; an existing file that is not a regular one
// (a device, a pipe) is written directly. On failure nothing is left behind. Throws Error (file).
void writeFile(const std::string& path, std::string_view bytes);

// The outputs of one run. Each is written to a temporary file when it is added; commit() makes them all appear.
// What was added and not committed is removed, where a signal ends the program as well (core/temporary_file.h).
class OutputSet
{
public:
	OutputSet() = default;
	OutputSet(const OutputSet&) = delete;
	OutputSet& operator=(const OutputSet&) = delete;

	// Path and meaning as writeFile. Throws Error (file).
	void add(const std::string& path, std::string_view bytes);

	// Devices and standard output first, since they cannot be taken back; then the renames. Throws Error (file), and then
	// none of the new files is there and the old ones are as they were.
	void commit();

private:
	struct Renaming
	{
		TemporaryFile temporary;
		std::string target;               // where links lead
		std::string path;                 // as the user wrote it
		std::optional<TemporaryFile> old; // what stood there before, during commit()
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

} // namespace nook
