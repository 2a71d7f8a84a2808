// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/content_hash.h"

#include "core/error.h"
#include "core/system.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

namespace nook
{
namespace
{

constexpr std::size_t kBlock = std::size_t{1} << 20U;

} // namespace

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
