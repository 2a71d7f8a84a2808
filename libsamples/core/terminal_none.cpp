// SPDX-License-Identifier: GPL-3.0-or-later
// For systems that cannot tell: Emscripten takes every stream for a terminal.
#include "core/system.h"

namespace nook
{

bool isTerminal()
{
	return false;
}

bool isTerminal(std::FILE*)
{
	return false;
}

} // namespace nook
