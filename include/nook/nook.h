/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * nook as a library: what the program does, with arrays in place of files. docs/reference/c_api.md describes options and arrays.
 *
 *	nook_options *options = NULL;
 *	nook_result *result = NULL;
 *	nook_options_create(&options);
 *	nook_options_set(options, "domain", "disk");
 *	nook_options_set(options, "count", "9");
 *	if (nook_run_pattern(options, &result) != NOOK_OK)
 *		puts(nook_error());
 *
 * Options have the names and values of the program's command line ("rays" for --rays), and the bytes are the program's.
 * Positions are in metres, y up; view space is right-handed and looks along -z; depth is positive; visibility is 1 where open.
 *
 * Functions may be called from several threads, also with one handle; a handle that is destroyed meanwhile stays valid for the calls
 * that use it. Null pointers, destroyed handles and handles of another kind are errors. Every function but the ones that return text
 * or nothing returns a status, and leaves its outputs alone where it fails.
 */
#ifndef NOOK_NOOK_H
#define NOOK_NOOK_H

#include <stddef.h>
#include <stdint.h>

/* Grows when programs have to be compiled again; the library's file has the same number: libnook.so.1. */
#define NOOK_ABI 1

/* Version of this header; nook_version() is the library's. */
#define NOOK_VERSION "0.1.0"

#ifndef NOOK_API
#if defined(__GNUC__) && !defined(_WIN32)
#define NOOK_API __attribute__((visibility("default")))
#else
#define NOOK_API
#endif
#endif

#ifdef __cplusplus
extern "C"
{
#endif

typedef int32_t nook_status;
enum
{
	NOOK_OK = 0,
	NOOK_USAGE = 1,         /* a wrong argument or option */
	NOOK_FILE = 2,          /* a file cannot be read or written */
	NOOK_INVALID_INPUT = 3, /* a file or an array holds something wrong */
	NOOK_FAILED = 4,        /* failed while working: out of memory, for example */
	NOOK_UNSUPPORTED = 5,   /* well formed, but not offered here */
	NOOK_DIFFERENCE = 7,    /* a comparison found more than "max-error" */
	NOOK_CANCELLED = 8,     /* the progress callback asked for it */
	NOOK_WRONG_VERSION = 9  /* the library has another NOOK_ABI */
};

typedef int32_t nook_type;
enum
{
	NOOK_FLOAT32 = 1,
	NOOK_FLOAT64 = 2,
	NOOK_UINT8 = 3,
	NOOK_INT32 = 4,
	NOOK_UINT32 = 5,
	NOOK_INT64 = 6,
	NOOK_UINT64 = 7
};

#define NOOK_MAX_DIMENSIONS 4

/* Numbers that lie one after the other, the last dimension fastest. The library reads arrays of its callers before a call returns, and
 * never writes to them. */
typedef struct nook_array
{
	const void *data;
	nook_type type;
	int32_t dimensions;                  /* 0 (one number) to NOOK_MAX_DIMENSIONS */
	uint64_t shape[NOOK_MAX_DIMENSIONS]; /* outermost first */
} nook_array;

typedef struct nook_options nook_options;
typedef struct nook_level nook_level;
typedef struct nook_result nook_result;

/* Called with a stage's name and its share, 0 to 1, one thread at a time, though not always the same; it may make calls of its own.
 * Other values than 0 cancel the call, which then returns NOOK_CANCELLED. */
typedef int32_t (*nook_progress)(void *user, const char *stage, double share);

/* ---- The library ---- */

/* NOOK_OK if the library has this interface: nook_require(NOOK_ABI). */
NOOK_API nook_status nook_require(uint32_t abi);
NOOK_API const char *nook_version(void); /* "0.1.0" */
/* One line about the last call of this thread; empty if it returned NOOK_OK. Valid until this thread's next call. */
NOOK_API const char *nook_error(void);

/* ---- Options of calls ---- */

NOOK_API nook_status nook_options_create(nook_options **options);
NOOK_API void nook_options_destroy(nook_options *options);
/* `name` without dashes: "radius", "threads". A flag's value is "true" or "false". Several values of one option are several calls.
 * "output" is the ending of a file that the result shall have: ".json". Names and values are checked by the function that the options
 * are for. */
NOOK_API nook_status nook_options_set(nook_options *options, const char *name, const char *value);
NOOK_API nook_status nook_options_number(nook_options *options, const char *name, double value);
/* The bytes of a file for an option that takes one, such as "pattern". `file_name` has no folder; its ending gives the format.
 * Several files for "patterns" are several calls. They are in a temporary folder until the options are destroyed. */
NOOK_API nook_status nook_options_file(nook_options *options, const char *name, const char *file_name, const void *bytes, size_t size);
NOOK_API nook_status nook_options_progress(nook_options *options, nook_progress progress, void *user);

/* ---- Levels ---- */

/* positions: n × 3, metres; triangles: m × 3 indices, counter-clockwise seen from the front; normals: n × 3 or null; uvs: n × 2 or
 * null, v grows downward. Options: strict, two-sided, threads. */
NOOK_API nook_status nook_level_create(const nook_array *positions, const nook_array *triangles, const nook_array *normals,
									   const nook_array *uvs, const nook_options *options, nook_level **level);
/* A .gltf, .glb, .obj, .fbx, .ply or .stl file, or "builtin:NAME". Options: unit, up, strict, max-texels, allow-outside, pose, tr,
 * ignore. */
NOOK_API nook_status nook_level_load(const char *path, const nook_options *options, nook_level **level);
/* Arrays positions, triangles, normals, uvs; facts: what was found in the level. */
NOOK_API nook_status nook_level_describe(const nook_level *level, nook_result **result);
NOOK_API void nook_level_destroy(nook_level *level);

/* ---- Work: `options` may be null where nothing is required ---- */

/* nook pattern. Arrays points (n × 2 for the disk, else n × 3), weights (n). */
NOOK_API nook_status nook_run_pattern(const nook_options *options, nook_result **result);
/* nook tile, of option "pattern" (nook_options_file). Arrays points (variants × n × 2 or 3), weights (variants × n). */
NOOK_API nook_status nook_run_tile(const nook_options *options, nook_result **result);
/* nook reference --points: positions and normals are n × 3. Arrays visibility, standard_error, rays; with "measure" bent also bent. */
NOOK_API nook_status nook_run_visibility(const nook_level *level, const nook_array *positions, const nook_array *normals,
									 const nook_options *options, nook_result **result);
/* nook bake. Arrays visibility, back, bent, bent_back per vertex; where triangles were split also positions and triangles. With
 * "texture" texels (height × width); with "probes" texels (z × y × x × 4), origin. Values of vertices without a triangle are NaN. */
NOOK_API nook_status nook_run_bake(const nook_level *level, const nook_options *options, nook_result **result);
/* nook volumes. Arrays corners (n × 3), first_corner, corner_count and alpha per polygon. */
NOOK_API nook_status nook_run_volumes(const nook_level *level, const nook_options *options, nook_result **result);
/* nook gbuffer, one view. Arrays depth (height × width, infinite for sky), normals (height × width × 3, view space), projection and
 * world_to_camera (16 numbers, column by column). */
NOOK_API nook_status nook_run_gbuffer(const nook_level *level, const nook_options *options, nook_result **result);
/* nook shade. depth: height × width; normals: height × width × 3, or null with "normals" from-depth; projection and world_to_camera:
 * 16 numbers each, column by column, or null where the option is given. Arrays visibility (height × width), with "bent" also bent. */
NOOK_API nook_status nook_run_shade(const nook_array *depth, const nook_array *normals, const nook_array *projection,
								const nook_array *world_to_camera, const nook_options *options, nook_result **result);
/* nook compare. Both are height × width; mask: height × width, 0 where a pixel does not count, or null. Arrays of one number each: rmse,
 * mae, mean_error, p95, max, ssim, flip, eq14. With "max-error" there is a result even with NOOK_DIFFERENCE. */
NOOK_API nook_status nook_run_compare(const nook_array *test, const nook_array *reference, const nook_array *mask,
								  const nook_options *options, nook_result **result);
/* nook emit. Each "output" is a file of the result: .glsl, .hlsl, .wgsl, .h, .js, .cs, .py, .json. */
NOOK_API nook_status nook_run_emit(const nook_options *options, nook_result **result);

/* ---- Results: pointers are valid until the result is destroyed ---- */

NOOK_API nook_status nook_result_array(const nook_result *result, const char *name, nook_array *array);
/* Null where there is no further array. */
NOOK_API const char *nook_result_name(const nook_result *result, size_t index);
/* The bytes that the program writes to a file with this ending, one of "output". */
NOOK_API nook_status nook_result_file(const nook_result *result, const char *ending, const char **bytes, size_t *size);
/* JSON, as the program's --json; `warnings`: a line each, or empty. Either may be null. */
NOOK_API nook_status nook_result_facts(const nook_result *result, const char **json, const char **warnings);
NOOK_API void nook_result_destroy(nook_result *result);

#ifdef __cplusplus
}
#endif

#endif /* NOOK_NOOK_H */
