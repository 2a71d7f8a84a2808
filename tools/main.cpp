// SPDX-License-Identifier: GPL-3.0-or-later
// The program's entry; apart from all else, so that CLI11's header is not compiled once more for it.
#include "program.h"

int main(int argc, char** argv)
{
	return nook::runProgram(argc, argv);
}
