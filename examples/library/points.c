/* SPDX-License-Identifier: MIT */
/* Visibility at points of a level: points LEVEL POINTS OUT.csv, with rows of six doubles in POINTS, a position and a normal. Writes
 * what nook reference --points --radius 1 --rays 256 does; examples/python/cost.py measures it. */
#include <nook/nook.h>

#include <stdio.h>
#include <stdlib.h>

static int stop(const char* what)
{
	fprintf(stderr, "%s: %s\n", what, nook_error());
	return 1;
}

/* Reads up to `most` rows into positions and normals; returns how many. */
static size_t readRows(const char* path, double* positions, double* normals, size_t most)
{
	FILE* file = fopen(path, "rb");
	size_t count = 0;
	if (file == NULL)
		return 0;
	while (count < most && fread(positions + 3 * count, sizeof(double), 3, file) == 3 &&
		   fread(normals + 3 * count, sizeof(double), 3, file) == 3)
		count++;
	fclose(file);
	return count;
}

int main(int count, char** arguments)
{
	enum
	{
		MOST = 1000000
	};
	double* positions = malloc(3 * MOST * sizeof(double)); /* pages that stay empty take no memory */
	double* normals = malloc(3 * MOST * sizeof(double));
	nook_options* options = NULL;
	nook_level* level = NULL;
	nook_result* result = NULL;
	const char* bytes;
	size_t size;
	FILE* out;

	if (count != 4 || positions == NULL || normals == NULL || nook_require(NOOK_ABI) != NOOK_OK)
		return stop("usage: points LEVEL POINTS OUT.csv");
	nook_array at = {positions, NOOK_FLOAT64, 2, {readRows(arguments[2], positions, normals, MOST), 3}};
	nook_array about = {normals, NOOK_FLOAT64, 2, {at.shape[0], 3}};
	if (nook_level_load(arguments[1], NULL, &level) != NOOK_OK)
		return stop(arguments[1]);
	if (nook_options_create(&options) != NOOK_OK || nook_options_set(options, "radius", "1") != NOOK_OK ||
		nook_options_set(options, "rays", "256") != NOOK_OK || nook_options_set(options, "output", ".csv") != NOOK_OK ||
		nook_run_visibility(level, &at, &about, options, &result) != NOOK_OK ||
		nook_result_file(result, ".csv", &bytes, &size) != NOOK_OK)
		return stop(arguments[2]);
	out = fopen(arguments[3], "wb");
	if (out == NULL || fwrite(bytes, 1, size, out) != size || fclose(out) != 0)
		return stop(arguments[3]);
	nook_result_destroy(result);
	nook_options_destroy(options);
	nook_level_destroy(level);
	free(positions);
	free(normals);
	return 0;
}
