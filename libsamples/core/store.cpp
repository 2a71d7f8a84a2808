// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/store.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/system.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

namespace nook
{
namespace
{

namespace fs = std::filesystem;

constexpr std::string_view kValueMagic = "nook.value/1 ";

// A value's first line: the format, and a checksum of the key and the bytes that follow.
std::string headOf(const std::string& key, std::string_view value)
{
	ContentHash sum;
	sum.add(key);
	sum.add(value);
	return std::string(kValueMagic) + sum.text() + "\n";
}

constexpr std::size_t kBlock = std::size_t{1} << 20U;

} // namespace

Store::Store(std::string folder, std::string version, bool must_keep)
	: m_folder(std::move(folder)), m_version(std::move(version)), m_must_keep(must_keep)
{
	std::error_code problem;
	m_new.make(nativePath(m_folder), problem);
	if (!fs::is_directory(nativePath(m_folder)))
	{
		throw Error(ExitCode::file, m_folder + ": found " + (fs::exists(nativePath(m_folder)) ? "a file" : problem.message()) +
										", expected a folder for finished work, or a place for one");
	}
}

std::string Store::pathOf(const std::string& key) const
{
	ContentHash hash;
	hash.add(m_version);
	hash.add(key);
	const std::string name = hash.text();
	return (nativePath(m_folder) / name.substr(0, 2) / name.substr(2)).string();
}

void Store::note(const std::string& what)
{
	const std::lock_guard lock(m_mutex);
	if (m_remark.empty())
	{
		m_remark = what;
	}
}

std::string Store::remark() const
{
	const std::lock_guard lock(m_mutex);
	return m_remark;
}

std::optional<std::string> Store::find(const std::string& key)
{
	const std::string path = pathOf(key);
	std::error_code none;
	if (!fs::exists(path, none))
	{
		return std::nullopt;
	}
	std::string bytes;
	try
	{
		bytes = readFile(path);
	}
	catch (const Error& error)
	{
		note(error.what());
		return std::nullopt;
	}
	const std::size_t size = headOf(key, "").size();
	const std::string_view value = std::string_view(bytes).substr(std::min(size, bytes.size()));
	if (!bytes.starts_with(headOf(key, value)))
	{
		note(path + ": found a value that was cut short or changed (its checksum differs), expected it as it was written");
		return std::nullopt;
	}
	bytes.erase(0, size);
	return bytes;
}

void Store::keep(const std::string& key, std::string_view value)
{
	m_kept += 1;
	if (value.size() > kMaxFileBytes - 64) // more than readFile() takes
	{
		return;
	}
	const std::string path = pathOf(key);
	try
	{
		std::error_code none; // writing says why
		fs::create_directories(nativePath(path).parent_path(), none);
		writeFile(path, headOf(key, value) + std::string(value));
	}
	catch (const Error& error)
	{
		if (m_must_keep)
		{
			throw;
		}
		note(error.what());
	}
}

bool Store::load(const std::string& key, const Visitor& visitor)
{
	const std::optional<std::string> value = find(key);
	const bool well = value && readBytes(*value, visitor);
	m_found += well ? 1 : 0;
	return well;
}

void Store::once(const std::string& key, const std::function<bool()>& compute, const Visitor& visitor)
{
	if (load(key, visitor))
	{
		return;
	}
	std::error_code none;
	fs::create_directories(nativePath(pathOf(key)).parent_path(), none);
	const FileLock lock(pathOf(key) + ".lock");
	if (!load(key, visitor) && compute())
	{
		keep(key, bytesOf(visitor));
	}
}

std::string hashOfFile(const std::string& path)
{
	std::FILE* const file = openFile(path, "rb");
	if (file == nullptr)
	{
		throw Error(ExitCode::file, path + ": cannot be read: " + std::strerror(errno));
	}
	const std::unique_ptr<std::FILE, int (*)(std::FILE*)> closer(file, &std::fclose);
	ContentHash hash;
	std::vector<std::byte> block(kBlock);
	for (std::size_t size = kBlock; size == kBlock;)
	{
		size = std::fread(block.data(), 1, kBlock, file);
		hash.add(std::span<const std::byte>(block.data(), size));
	}
	if (std::ferror(file) != 0)
	{
		throw Error(ExitCode::file, path + ": cannot be read: " + std::strerror(errno));
	}
	return hash.text();
}

} // namespace nook
