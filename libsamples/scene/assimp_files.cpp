// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/assimp_files.h"

#include "core/file.h"
#include "scene/load_parts.h"
#include "scene/mesh_text.h"

#include <assimp/MemoryIOWrapper.h>

#include <algorithm>
#include <filesystem>

namespace nook
{
namespace
{

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// glTF writes blanks as %20, which Assimp leaves unchanged.
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

// `bytes` must outlive the stream. The importer deletes it.
Assimp::IOStream* streamOf(const std::string& bytes)
{
	return new Assimp::MemoryIOStream(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()); // NOLINT
}

} // namespace

bool AssimpFiles::Exists(const char* file) const
{
	return isFile(pathOf(file)); // Assimp's own check opens it, and would block on a pipe
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
		if (error.code() == ExitCode::file)
		{
			addFile(missing, path); // cannot be opened
		}
		else if (!refused)
		{
			refused = error; // Assimp would report a missing file, or something else of its own
		}
		return nullptr;
	}
}

// Replacement text of the level's file for Assimp; none: use the file itself.
std::optional<std::string> AssimpFiles::levelText()
{
	std::string bytes = readFile(m_level_path);
	const bool marked = bytes.starts_with(kByteOrderMark); // Assimp would take the mark for a part of the first word
	bytes.erase(0, marked ? kByteOrderMark.size() : 0);
	const std::string ending = endingOf(m_level_path);
	std::optional<std::string> repaired = ending == ".obj"   ? repairedObj(bytes, m_level_path, exact)
										  : ending == ".ply" ? repairedPly(bytes, m_level_path, exact)
										  : ending == ".stl" ? repairedStl(bytes, m_level_path, exact, solids)
															 : std::nullopt;
	return repaired || !marked ? std::move(repaired) : std::optional(std::move(bytes));
}

// Throws Error if the file must not be read, or is not what its name says.
Assimp::IOStream* AssimpFiles::streamOfFile(const std::string& path, const char* mode)
{
	if (path == m_level_path)
	{
		if (!m_has_read) // opened once for its size, then for its text
		{
			m_text = levelText();
			m_has_read = true;
		}
		return m_text ? streamOf(*m_text) : DefaultIOSystem::Open(path.c_str(), mode);
	}
	const bool is_obj = endingOf(m_level_path) == ".obj";
	checkInside(m_level_path, is_obj ? "mtllib" : "reference", path, m_settings);
	if (!is_obj)
	{
		return DefaultIOSystem::Open(path.c_str(), mode);
	}
	std::string bytes = readFile(path);
	bytes.erase(0, bytes.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
	m_names = readMtl(bytes, path, materials);
	return streamOf(m_names);
}

} // namespace nook
