// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/file.h"

#include "core/error.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include <unistd.h>

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

// Beside the target, so that the rename stays within one file system; the ending is kept, since libraries choose a format by it.
std::filesystem::path temporaryBeside(const std::filesystem::path& target)
{
	std::filesystem::path name = target.stem();
	name += ".tmp" + std::to_string(static_cast<long>(::getpid()));
	name += target.extension();
	return target.parent_path() / name;
}

bool isDevice(const std::string& path)
{
	std::error_code ignored;
	const std::filesystem::file_status status = std::filesystem::status(path, ignored);
	return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

void writeDirectly(const std::string& path, std::string_view bytes)
{
	const File file(std::fopen(path.c_str(), "wb"));
	if (file == nullptr)
	{
		fail(path, "written", errno);
	}
	writeAll(file.get(), path, bytes);
}

} // namespace

std::string readFile(const std::string& path)
{
	const File file(std::fopen(path.c_str(), "rb"));
	if (file == nullptr)
	{
		fail(path, "read", errno);
	}
	std::string bytes;
	char buffer[65536];
	for (;;)
	{
		const std::size_t got = std::fread(buffer, 1, sizeof buffer, file.get());
		bytes.append(buffer, got);
		if (got < sizeof buffer)
		{
			break;
		}
	}
	if (std::ferror(file.get()) != 0)
	{
		fail(path, "read", errno);
	}
	return bytes;
}

void writeFile(const std::string& path, std::string_view bytes)
{
	if (path == "-")
	{
		writeAll(stdout, "standard output", bytes);
		return;
	}
	if (isDevice(path))
	{
		writeDirectly(path, bytes);
		return;
	}
	writeFileWith(path, [&](const std::string& temporary) { writeDirectly(temporary, bytes); });
}

void writeFileWith(const std::string& path, const std::function<void(const std::string& temporary_path)>& write)
{
	if (path == "-" || isDevice(path))
	{
		// A library that needs a named, seekable file: give it one elsewhere and copy the bytes.
		const std::filesystem::path target(path);
		const std::filesystem::path temporary =
		    std::filesystem::temp_directory_path() / temporaryBeside("nook" + target.extension().string()).filename();
		try
		{
			write(temporary.string());
			writeFile(path, readFile(temporary.string()));
		}
		catch (...)
		{
			std::error_code ignored;
			std::filesystem::remove(temporary, ignored);
			throw;
		}
		std::filesystem::remove(temporary);
		return;
	}
	const std::filesystem::path target(path);
	const std::filesystem::path temporary = temporaryBeside(target);
	try
	{
		write(temporary.string());
		std::error_code failed;
		std::filesystem::rename(temporary, target, failed);
		if (failed)
		{
			fail(path, "written", failed.value());
		}
	}
	catch (const Error& error)
	{
		std::error_code ignored;
		std::filesystem::remove(temporary, ignored);
		// The user knows the target, not the temporary file.
		std::string message = error.what();
		const std::size_t at = message.find(temporary.string());
		if (at != std::string::npos)
		{
			message.replace(at, temporary.string().size(), path);
		}
		throw Error(error.code(), message);
	}
	catch (...)
	{
		std::error_code ignored;
		std::filesystem::remove(temporary, ignored);
		throw;
	}
}

} // namespace nook
