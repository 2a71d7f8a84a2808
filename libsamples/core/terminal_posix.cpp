// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/system.h"

#include <unistd.h>

namespace nook
{

bool isTerminal()
{
	return isTerminal(stderr);
}

bool isTerminal(std::FILE* stream)
{
	return ::isatty(::fileno(stream)) != 0;
}

} // namespace nook
