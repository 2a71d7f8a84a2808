/* SPDX-License-Identifier: GPL-3.0-or-later
   Usage: peak COMMAND…. The most memory that the command held at once, KiB, to stdout; its exit code. */
#include <stdio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

int main(int count, char** arguments)
{
	struct rusage used;
	int status = 0;
	const pid_t child = count > 1 ? fork() : -1;
	if (child == 0)
	{
		execv(arguments[1], arguments + 1);
		_exit(127);
	}
	if (child < 0 || wait4(child, &status, 0, &used) != child)
	{
		return 126;
	}
	printf("%ld\n", used.ru_maxrss);
	return WIFEXITED(status) ? WEXITSTATUS(status) : 125;
}
