// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/notes.h"

namespace nook
{

std::string commentBlock(const Notes& notes, std::string_view prefix)
{
	std::string block;
	for (const Note& note : notes)
	{
		block += std::string(prefix) + note.key + ": " + note.value + "\n";
	}
	return block;
}

} // namespace nook
