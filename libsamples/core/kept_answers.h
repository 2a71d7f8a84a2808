// SPDX-License-Identifier: GPL-3.0-or-later
// What takes long and is the same in several runs of the program, kept as files: the parts of a command decode a picture, clean a
// level and merge its polygons once, and not once each.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace nook
{

// The variable that names the folder; nothing is kept where it is not set, or names none.
inline constexpr const char* kAnswersFolder = "NOOK_DECODED";

bool keepsAnswers();

// Of one key: a hash of all that an answer depends on but the version of nook.
class KeptAnswer
{
public:
	// Where there is none, other runs that ask for it wait until this goes away.
	explicit KeptAnswer(const std::string& key);
	KeptAnswer(const KeptAnswer&) = delete;
	KeptAnswer& operator=(const KeptAnswer&) = delete;
	~KeptAnswer();

	// One that is damaged, or of another version, counts as none.
	const std::optional<std::string>& answer() const
	{
		return m_answer;
	}

	// Does nothing where it cannot be written, or is more than readFile() takes in: the next run does the work again.
	void keep(std::string_view answer) const;

private:
	std::string m_path;
	std::optional<std::string> m_answer;
	int m_lock = -1;
};

} // namespace nook
