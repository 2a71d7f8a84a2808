// SPDX-License-Identifier: GPL-3.0-or-later
// One at a time in a folder. The lock goes with the last process that has it, however that ends.
#pragma once

#include <string>

namespace nook
{

class FolderLock
{
public:
	// Makes the file `lock` in a folder that is there; processes that this one starts have it, too. Throws Error: file; runtime
	// where another has it.
	explicit FolderLock(const std::string& folder);
	FolderLock(const FolderLock&) = delete;
	FolderLock& operator=(const FolderLock&) = delete;
	~FolderLock();

private:
	int m_file = -1;
};

} // namespace nook
