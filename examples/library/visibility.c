/* SPDX-License-Identifier: MIT */
/* Visibility in the middle of a floor and next to its wall: cc visibility.c -lnook, or CMakeLists.txt here. */
#include <nook/nook.h>

#include <stdio.h>

static int stop(const char *what)
{
	fprintf(stderr, "%s: %s\n", what, nook_error());
	return 1;
}

static nook_array rows(const void *data, nook_type type, uint64_t count)
{
	nook_array array = {data, type, 2, {count, 3}};
	return array;
}

int main(void)
{
	/* A floor, 4 x 4 metres, and a wall along its far side. */
	const float positions[] = {-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2, 2, 4, -2, -2, 4, -2};
	const int32_t triangles[] = {0, 1, 2, 0, 2, 3, 3, 2, 4, 3, 4, 5};
	const double points[] = {0, 0, 0, 0, 0, -1.9};
	const double normals[] = {0, 1, 0, 0, 1, 0};
	const nook_array vertices = rows(positions, NOOK_FLOAT32, 6);
	const nook_array corners = rows(triangles, NOOK_INT32, 4);
	const nook_array at = rows(points, NOOK_FLOAT64, 2);
	const nook_array about = rows(normals, NOOK_FLOAT64, 2);
	nook_options *options = NULL;
	nook_level *level = NULL;
	nook_result *result = NULL;
	nook_array visibility;
	int i;

	if (nook_require(NOOK_ABI) != NOOK_OK || nook_level_create(&vertices, &corners, NULL, NULL, NULL, &level) != NOOK_OK)
		return stop("level");
	if (nook_options_create(&options) != NOOK_OK || nook_options_number(options, "radius", 1.5) != NOOK_OK ||
		nook_options_set(options, "rays", "1024") != NOOK_OK)
		return stop("options");
	if (nook_run_visibility(level, &at, &about, options, &result) != NOOK_OK ||
		nook_result_array(result, "visibility", &visibility) != NOOK_OK)
		return stop("visibility");
	for (i = 0; i < 2; i++)
		printf("%.3f\n", ((const double *)visibility.data)[i]);
	nook_result_destroy(result);
	nook_options_destroy(options);
	nook_level_destroy(level);
	return 0;
}
