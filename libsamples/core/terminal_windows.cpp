// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/system.h"

#define WIN32_LEAN_AND_MEAN
#include <io.h>
#include <windows.h>

namespace nook
{

bool isTerminal()
{
	DWORD mode = 0; // fails unless it is a console; one without escape sequences shows no progress
	const HANDLE console = ::GetStdHandle(STD_ERROR_HANDLE);
	return ::GetConsoleMode(console, &mode) != 0 && ::SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

bool isTerminal(std::FILE* stream)
{
	return ::_isatty(::_fileno(stream)) != 0;
}

} // namespace nook
