// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/file.h"

#include "core/error.h"
#include "core/system.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

namespace nook
{
namespace
{

struct Closer
{
	void operator()(std::FILE* file) const
	{
		std::fclose(file);
	}
};
using File = std::unique_ptr<std::FILE, Closer>;

[[noreturn]] void fail(const std::string& path, const char* doing, int reason)
{
	throw Error(ExitCode::file, path + ": cannot be " + doing + ": " + std::strerror(reason));
}

void writeAll(std::FILE* file, const std::string& path, std::string_view bytes)
{
	if (std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size() || std::fflush(file) != 0)
	{
		fail(path, "written", errno);
	}
}

// In the target's folder, so that the rename stays within one file system. The extension is kept because libraries choose a format
// by it.
std::filesystem::path temporaryFor(const std::filesystem::path& target)
{
	static std::atomic<unsigned> number{0}; // keeps names unique within the process
	std::filesystem::path name = target.stem();
	name += ".tmp" + std::to_string(processNumber()) + "_" + std::to_string(number++);
	name += target.extension();
	return target.parent_path() / name;
}

// Follows links; the target need not exist.
std::filesystem::path linkTarget(std::filesystem::path path)
{
	std::error_code failed;
	for (int links = 0; links < 40 && std::filesystem::is_symlink(path, failed); ++links) // Linux's limit
	{
		path = path.parent_path() / std::filesystem::read_symlink(path, failed);
	}
	return path;
}

bool isDevice(const std::string& path)
{
	std::error_code ignored;
	const std::filesystem::file_status status = std::filesystem::status(nativePath(path), ignored);
	return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

void writeDirectly(const std::string& path, const std::string& name, std::string_view bytes)
{
	File file(openFile(path, "wb"));
	if (file == nullptr)
	{
		fail(name, "written", errno);
	}
	writeAll(file.get(), name, bytes);
	if (std::fclose(file.release()) != 0)
	{
		fail(name, "written", errno);
	}
}

} // namespace

std::string readFile(const std::string& path)
{
	const File file(openFile(path, "rb"));
	if (file == nullptr)
	{
		fail(path, "read", errno);
	}
	std::string bytes;
	std::error_code unknown; // unknown for a pipe, for example
	const std::uintmax_t size = std::filesystem::file_size(nativePath(path), unknown);
	if (!unknown)
	{
		if (size > kMaxFileBytes)
		{
			fail(path, "read", EFBIG); // before allocating any memory
		}
		bytes.reserve(static_cast<std::size_t>(size));
	}
	char buffer[65536];
	for (;;)
	{
		const std::size_t got = std::fread(buffer, 1, sizeof buffer, file.get());
		bytes.append(buffer, got);
		if (got < sizeof buffer)
		{
			break;
		}
		if (bytes.size() > kMaxFileBytes)
		{
			fail(path, "read", EFBIG);
		}
	}
	if (std::ferror(file.get()) != 0)
	{
		fail(path, "read", errno);
	}
	return bytes;
}

void checkWritable(const std::string& path)
{
	if (path == "-")
	{
		return;
	}
	std::error_code ignored;
	if (std::filesystem::is_directory(nativePath(path), ignored))
	{
		fail(path, "written", EISDIR);
	}
	if (isDevice(path))
	{
		return;
	}
	std::filesystem::path folder = linkTarget(nativePath(path)).parent_path();
	if (folder.empty())
	{
		folder = ".";
	}
	if (!isOpenFolder(folder.string()))
	{
		fail(path, "written", errno);
	}
	if (!std::filesystem::is_directory(folder, ignored))
	{
		fail(path, "written", ENOTDIR);
	}
}

std::string fileIdentity(const std::string& path)
{
	if (path == "-")
	{
		return path;
	}
	if (const std::optional<std::string> identity = identityOfFile(path))
	{
		return *identity;
	}
	const std::filesystem::path target = linkTarget(std::filesystem::absolute(nativePath(path)));
	std::error_code failed;
	const std::filesystem::path folder = std::filesystem::weakly_canonical(target.parent_path(), failed);
	return nameKey(((failed ? target.parent_path().lexically_normal() : folder) / target.filename()).string());
}

void writeFile(const std::string& path, std::string_view bytes)
{
	OutputSet outputs;
	outputs.add(path, bytes);
	outputs.commit();
}

void OutputSet::add(const std::string& path, std::string_view bytes)
{
	if (path == "-" || isDevice(path))
	{
		m_directs.push_back({path, std::string(bytes)});
		return;
	}
	// Links are kept; their target is replaced.
	const std::filesystem::path target = linkTarget(nativePath(path));
	TemporaryFile temporary(temporaryFor(target).string());
	writeDirectly(temporary.path(), path, bytes);
	m_renamings.push_back({std::move(temporary), target.string(), path, {}});
}

void OutputSet::commit()
{
	for (const Direct& direct : std::exchange(m_directs, {}))
	{
		if (direct.path == "-")
		{
			writeAll(stdout, "standard output", direct.bytes);
		}
		else
		{
			writeDirectly(direct.path, direct.path, direct.bytes);
		}
	}
	const SignalsHeld held; // a signal in between would leave a mix of new and old files
	for (std::size_t i = 0; i < m_renamings.size(); ++i)
	{
		Renaming& renaming = m_renamings[i];
		if (i + 1 < m_renamings.size()) // the last rename is atomic; only earlier ones may need undoing
		{
			keepOld(renaming);
		}
		std::error_code failed;
		renaming.temporary.rename(renaming.target, failed);
		if (failed)
		{
			takeBack(i);
			const std::string path = renaming.path;
			m_renamings.clear();
			fail(path, "written", failed.default_error_condition().value());
		}
	}
	m_renamings.clear(); // removes the backups
}

// Keeps the file about to be replaced as a hard link, or as a copy on file systems without hard links.
void OutputSet::keepOld(Renaming& renaming)
{
	std::error_code failed;
	const std::filesystem::path target = nativePath(renaming.target);
	if (!std::filesystem::exists(target, failed))
	{
		return;
	}
	const TemporaryFile& old = renaming.old.emplace(temporaryFor(target).string());
	std::filesystem::create_hard_link(target, nativePath(old.path()), failed);
	if (failed)
	{
		std::filesystem::copy_file(target, nativePath(old.path()), failed);
	}
	if (failed)
	{
		renaming.old.reset();
	}
}

// Undoes the first `count` renames.
void OutputSet::takeBack(std::size_t count)
{
	for (std::size_t done = 0; done < count; ++done)
	{
		std::error_code ignored;
		if (m_renamings[done].old)
		{
			m_renamings[done].old->rename(m_renamings[done].target, ignored);
		}
		else
		{
			std::filesystem::remove(nativePath(m_renamings[done].target), ignored);
		}
	}
}

} // namespace nook
