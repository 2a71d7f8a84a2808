// SPDX-License-Identifier: GPL-3.0-or-later
// An empty folder for one test, removed afterwards.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace nook
{

class TemporaryFolder
{
public:
	TemporaryFolder()
	{
		std::string name = (std::filesystem::temp_directory_path() / "nook_test_XXXXXX").string();
		if (::mkdtemp(name.data()) == nullptr)
		{
			throw std::runtime_error("no temporary folder");
		}
		m_path = name;
	}
	TemporaryFolder& operator=(TemporaryFolder&&) = delete;

	~TemporaryFolder()
	{
		std::error_code ignored;
		std::filesystem::remove_all(m_path, ignored);
	}

	std::string operator/(const std::string& name) const
	{
		return (m_path / name).string();
	}

	// Names of its contents, sorted.
	std::vector<std::string> names() const
	{
		std::vector<std::string> found;
		for (const auto& entry : std::filesystem::directory_iterator(m_path))
		{
			found.push_back(entry.path().filename().string());
		}
		std::sort(found.begin(), found.end());
		return found;
	}

private:
	std::filesystem::path m_path;
};

} // namespace nook
