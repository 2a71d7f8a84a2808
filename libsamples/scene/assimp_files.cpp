// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/assimp_files.h"

#include "core/file.h"
#include "scene/load_parts.h"

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
	Assimp::IOStream* stream = nullptr;
	if (hasByteOrderMark(path))
	{
		stream = streamOf(readFile(path).substr(kByteOrderMark.size()));
	}
	else if (const std::size_t at = endingOf(path) == ".ply" ? lostByte(path) : 0; at > 0)
	{
		stream = streamOf(readFile(path).insert(at - 1, 1, '\r'));
	}
	else
	{
		stream = DefaultIOSystem::Open(path.c_str(), mode);
	}
	addFile(stream == nullptr ? missing : opened, path);
	return stream;
}

} // namespace nook
