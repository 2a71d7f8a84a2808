// SPDX-License-Identifier: GPL-3.0-or-later
#include "farm/folder_lock.h"

#include "core/error.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace nook
{

FolderLock::FolderLock(const std::string& folder)
{
	const std::string path = folder + "/lock";
	m_file = ::open(path.c_str(), O_RDWR | O_CREAT, 0666); // NOLINT: its third argument
	if (m_file < 0)
	{
		throw Error(ExitCode::file, path + ": cannot be written: " + std::strerror(errno));
	}
	if (::flock(m_file, LOCK_EX | LOCK_NB) != 0)
	{
		const int reason = errno;
		::close(m_file);
		if (reason == EWOULDBLOCK)
		{
			throw Error(ExitCode::runtime, folder + ": found another nook that plans or runs here, expected one at a time");
		}
		throw Error(ExitCode::file, path + ": cannot be locked: " + std::strerror(reason));
	}
}

FolderLock::~FolderLock()
{
	::close(m_file);
}

} // namespace nook
