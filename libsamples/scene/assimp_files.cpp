// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/assimp_files.h"

#include "core/file.h"
#include "scene/load_parts.h"
#include "scene/obj_text.h"

#include <assimp/MemoryIOWrapper.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace nook
{
namespace
{

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// glTF writes blanks as %20, which Assimp leaves so.
std::string pathOf(const char* file)
{
	std::error_code failed;
	return std::filesystem::exists(file, failed) ? std::string(file) : unescaped(file);
}

// Devices and pipes have no end.
bool isFile(const std::string& path)
{
	std::error_code failed;
	return std::filesystem::is_regular_file(path, failed);
}

// Where a PLY's data begin, if their first byte is 10 and no 13 stands before the header's last 10; else 0. Assimp takes that byte
// for a second end of the line, and all that follows is off by one.
std::size_t lostByte(const std::string& path)
{
	std::ifstream stream(path, std::ios::binary);
	std::string line;
	while (std::getline(stream, line))
	{
		if (line.starts_with("end_header"))
		{
			return line == "end_header" && stream.peek() == '\n' ? static_cast<std::size_t>(stream.tellg()) : 0;
		}
	}
	return 0;
}

// Of text. Assimp takes the mark for a part of the first word, so that an OBJ loses its first vertex.
bool hasByteOrderMark(const std::string& path)
{
	std::ifstream stream(path, std::ios::binary);
	std::string start(kByteOrderMark.size(), '\0');
	return stream.read(start.data(), static_cast<std::streamsize>(start.size())) && start == kByteOrderMark;
}

Assimp::IOStream* streamOf(const std::string& bytes)
{
	auto* const copy = new uint8_t[bytes.size()]; // NOLINT: the stream deletes it
	std::copy(bytes.begin(), bytes.end(), copy);
	return new Assimp::MemoryIOStream(copy, bytes.size(), true); // NOLINT: and the importer the stream
}

} // namespace

bool AssimpFiles::Exists(const char* file) const
{
	return isFile(pathOf(file)); // the library's own way opens it, and waits for ever at a pipe
}

Assimp::IOStream* AssimpFiles::Open(const char* file, const char* mode)
{
	const std::string path = pathOf(file);
	if (!isFile(path))
	{
		addFile(missing, path);
		return nullptr;
	}
	try
	{
		Assimp::IOStream* const stream = streamOfFile(path, mode);
		addFile(stream == nullptr ? missing : opened, path);
		return stream;
	}
	catch (const Error& error)
	{
		if (error.code() != ExitCode::invalid_input)
		{
			addFile(missing, path); // cannot be opened
		}
		else if (!refused)
		{
			refused = error; // of which the library would make a missing file, or words of its own
		}
		return nullptr;
	}
}

// An OBJ or MTL file where Assimp is to get other text than the file's; none: the file itself.
std::optional<std::string> AssimpFiles::repairedText(const std::string& path)
{
	const bool is_level = path == m_level_path;
	if (is_level && m_level_is_sound)
	{
		return std::nullopt; // opened for its size, then for its text
	}
	std::string bytes = readFile(path);
	const bool marked = bytes.starts_with(kByteOrderMark);
	bytes.erase(0, marked ? kByteOrderMark.size() : 0);
	std::optional<std::string> repaired = is_level ? repairedObj(bytes, path) : repairedMtl(bytes, path);
	m_level_is_sound = m_level_is_sound || (is_level && !repaired && !marked);
	return repaired || !marked ? repaired : std::optional(std::move(bytes));
}

// Throws Error where the file is not to be read, or is not what its name says.
Assimp::IOStream* AssimpFiles::streamOfFile(const std::string& path, const char* mode)
{
	if (path != m_level_path)
	{
		checkInside(m_level_path, endingOf(m_level_path) == ".obj" ? "mtllib" : "reference", path, m_settings);
	}
	if (endingOf(m_level_path) == ".obj")
	{
		if (const std::optional<std::string> text = repairedText(path))
		{
			return streamOf(*text);
		}
	}
	else if (hasByteOrderMark(path))
	{
		return streamOf(readFile(path).substr(kByteOrderMark.size()));
	}
	if (const std::size_t at = endingOf(path) == ".ply" ? lostByte(path) : 0; at > 0)
	{
		return streamOf(readFile(path).insert(at - 1, 1, '\r'));
	}
	return DefaultIOSystem::Open(path.c_str(), mode);
}

} // namespace nook
