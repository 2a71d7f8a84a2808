// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/system.h"

#include <unistd.h>

namespace nook
{

bool isTerminal()
{
	return ::isatty(STDERR_FILENO) != 0;
}

} // namespace nook
