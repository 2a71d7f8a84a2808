// SPDX-License-Identifier: GPL-3.0-or-later
// Preloaded into nook (LD_PRELOAD): makes write call number NOOK_TEST_FAIL fail, as on a disk that is full for that moment. Write
// calls: fopen() for writing, fwrite(), fflush(), fclose(), rename(), mkdir().
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static atomic_int calls;
static _Atomic(FILE*) written[64]; // streams opened for writing

// 1 if this call must fail; does not affect nook's workers.
static int fails(void)
{
	static int wanted = -1;
	if (wanted < 0)
	{
		const char* const text = getenv("NOOK_TEST_FAIL");
		wanted = text != NULL && strcmp(program_invocation_short_name, "nook") == 0 ? atoi(text) : 0;
	}
	if (atomic_fetch_add(&calls, 1) + 1 != wanted)
	{
		return 0;
	}
	errno = ENOSPC;
	return 1;
}

static int isWritten(FILE* file, FILE* instead)
{
	for (int i = 0; i < 64; ++i)
	{
		FILE* expected = file;
		if (atomic_compare_exchange_strong(&written[i], &expected, instead))
		{
			return 1;
		}
	}
	return 0;
}

FILE* fopen(const char* path, const char* mode)
{
	static FILE* (*real)(const char*, const char*);
	real = real != NULL ? real : (FILE * (*)(const char*, const char*)) dlsym(RTLD_NEXT, "fopen");
	if (strchr(mode, 'w') == NULL)
	{
		return real(path, mode);
	}
	FILE* const file = fails() ? NULL : real(path, mode);
	if (file != NULL)
	{
		isWritten(NULL, file);
	}
	return file;
}

size_t fwrite(const void* bytes, size_t size, size_t count, FILE* file)
{
	static size_t (*real)(const void*, size_t, size_t, FILE*);
	real = real != NULL ? real : (size_t(*)(const void*, size_t, size_t, FILE*))dlsym(RTLD_NEXT, "fwrite");
	return file != stderr && fails() ? 0 : real(bytes, size, count, file);
}

int fflush(FILE* file)
{
	static int (*real)(FILE*);
	real = real != NULL ? real : (int (*)(FILE*))dlsym(RTLD_NEXT, "fflush");
	return file != NULL && file != stderr && fails() ? EOF : real(file);
}

int fclose(FILE* file)
{
	static int (*real)(FILE*);
	real = real != NULL ? real : (int (*)(FILE*))dlsym(RTLD_NEXT, "fclose");
	const int failed = isWritten(file, NULL) && fails();
	const int closed = real(file);
	errno = failed ? ENOSPC : errno;
	return failed ? EOF : closed;
}

int rename(const char* from, const char* to)
{
	static int (*real)(const char*, const char*);
	real = real != NULL ? real : (int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename");
	return fails() ? -1 : real(from, to);
}

int mkdir(const char* path, mode_t mode)
{
	static int (*real)(const char*, mode_t);
	real = real != NULL ? real : (int (*)(const char*, mode_t))dlsym(RTLD_NEXT, "mkdir");
	return fails() ? -1 : real(path, mode);
}
