// SPDX-License-Identifier: GPL-3.0-or-later
// bin/nook of the portable bundle, and each of its workers: starts the program of the same name in libexec/ with the libraries in lib/.
// A program asks for its loader by an absolute path, and Debian 12's programs ask for its glibc, so this one, which is linked statically,
// picks the loader: the system's where its glibc has NOOK_GLIBC, else the bundle's with the bundle's glibc. Likewise libstdc++ and
// NOOK_GLIBCXX. Newer libraries of the system come first because its graphics driver, which nook loads, may need them.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#define LOADER "/lib64/ld-linux-x86-64.so.2"

// Whether a file holds that version's name: libraries list the versions of their symbols.
static int fileHolds(const char *path, const char *version)
{
	const int file = open(path, O_RDONLY | O_CLOEXEC);
	struct stat status;
	int holds = 0;
	if (file >= 0 && fstat(file, &status) == 0 && status.st_size > 0)
	{
		void *const bytes = mmap(NULL, (size_t)status.st_size, PROT_READ, MAP_PRIVATE, file, 0);
		holds = bytes != MAP_FAILED && memmem(bytes, (size_t)status.st_size, version, strlen(version) + 1) != NULL;
		if (bytes != MAP_FAILED)
		{
			munmap(bytes, (size_t)status.st_size);
		}
	}
	if (file >= 0)
	{
		close(file);
	}
	return holds;
}

static int systemHolds(const char *library, const char *version)
{
	static const char *const folders[] = {"/lib/x86_64-linux-gnu", "/usr/lib/x86_64-linux-gnu", "/lib64", "/usr/lib64", "/usr/lib"};
	for (size_t i = 0; i < sizeof folders / sizeof *folders; ++i)
	{
		char path[PATH_MAX];
		snprintf(path, sizeof path, "%s/%s", folders[i], library);
		if (access(path, R_OK) == 0)
		{
			return fileHolds(path, version); // the first is the one that the loader takes
		}
	}
	return 0;
}

int main(int argc, char **argv)
{
	const char *const called = (const char *)getauxval(AT_EXECFN);
	char folder[PATH_MAX];
	char libraries[4 * PATH_MAX + 64];
	char program[PATH_MAX + 64];
	char loader[PATH_MAX + 64];
	if (realpath(called, folder) == NULL || strpbrk(folder, ":;") != NULL)
	{
		fprintf(stderr, "nook: %s: found a folder that cannot be read or has ':' or ';' in its name, expected another one\n", called);
		return 2;
	}
	*strrchr(folder, '/') = '\0';          // bin or lib/nook
	char *const last = strrchr(folder, '/'); // bin, or nook in lib
	if (last != NULL && strcmp(last, "/nook") == 0)
	{
		*last = '\0';
	}
	char *const above = strrchr(folder, '/');
	if (above != NULL)
	{
		*above = '\0';
	}
	const char *const name = strrchr(called, '/') == NULL ? called : strrchr(called, '/') + 1;
	const int is_worker = strncmp(name, "nook_", 5) == 0; // else nook, by any name
	snprintf(program, sizeof program, "%s/libexec/%s", folder, is_worker ? name : "nook");
	const int ours = access(LOADER, X_OK) != 0 || !systemHolds("libc.so.6", NOOK_GLIBC);
	const int ours_too = ours || !systemHolds("libstdc++.so.6", NOOK_GLIBCXX);
	snprintf(libraries, sizeof libraries, "%s/lib/nook:%s/lib", folder, folder);
	snprintf(loader, sizeof loader, ours ? "%s/lib/glibc/ld-linux-x86-64.so.2" : LOADER, folder);
	if (ours_too)
	{
		snprintf(libraries + strlen(libraries), PATH_MAX + 16, ":%s/lib/gcc", folder);
	}
	if (ours)
	{
		snprintf(libraries + strlen(libraries), PATH_MAX + 16, ":%s/lib/glibc", folder);
	}
	const char **const words = malloc(((size_t)argc + 8) * sizeof *words);
	if (words == NULL)
	{
		return 4;
	}
	size_t count = 0;
	words[count++] = loader;
	words[count++] = "--library-path";
	words[count++] = libraries;
	words[count++] = "--argv0";
	words[count++] = argc > 0 ? argv[0] : name;
	words[count++] = program;
	for (int i = 1; i < argc; ++i)
	{
		words[count++] = argv[i];
	}
	words[count] = NULL;
	execv(loader, (char *const *)words);
	fprintf(stderr, "nook: %s: found that it cannot be started: %s, expected the whole bundle\n", loader, strerror(errno));
	return 2;
}
