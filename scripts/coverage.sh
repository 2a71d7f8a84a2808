#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What of each parser runs: coverage.sh PROGRAM [SECONDS]. Builds the fuzz targets with counters in build/coverage, runs each for SECONDS
# (60) from the seeds of scripts/fuzz.sh and the hostile files of its kind, and prints a table of the parsers' sources. PROGRAM is a
# release build, beside which nook_hostile was built.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
nook=$(realpath "$1")
seconds=${2:-60}
build=$source/build/coverage
targets="pattern csv glb meshes volumes exr gbuffer report"
files=$build/hostile
rm -rf "$files" "$build/profiles"
mkdir -p "$files" "$build/profiles"
"$(dirname "$nook")/../tests/nook_hostile" "$nook" "$source/tests/hostile/codes.txt" --write "$files"
# take TARGET GROUP...: as inputs that were found before.
take()
{
	target=$1
	shift
	mkdir -p "$build/corpus/$target"
	for group in "$@"; do
		find "$files/$group" -type f -size -100k | while read -r file; do cp "$file" "$build/corpus/$target/hostile_${file##*/}"; done
	done
}
take pattern pattern tile
take csv csv
take glb gltf glb names
take meshes ply stl obj mtl
take volumes volumes
take exr exr
export LLVM_PROFILE_FILE="$build/profiles/%p.profraw"
# shellcheck disable=SC2086
NOOK_PROGRAM=$nook NOOK_FUZZ_OPTIONS=-DNOOK_COVERAGE=ON "$source/scripts/fuzz.sh" "$seconds" "$build" $targets
tools=$(dirname "$(readlink -f "$(command -v clang++)")")
"$tools/llvm-profdata" merge -o "$build/all.profdata" "$build"/profiles/*.profraw
objects=
for target in $targets; do
	objects="$objects -object $build/tests/fuzz/fuzz_$target"
done
cd "$source/libsamples"
echo "| parser | lines | run, % | regions | run, % |"
echo "| --- | --- | --- | --- | --- |"
# shellcheck disable=SC2086
"$tools/llvm-cov" report $objects -instr-profile "$build/all.profdata" core/json_reader.cpp error_report/error_json.cpp format/input.cpp \
	format/json_fields.cpp format/pattern_check.cpp format/pattern_csv.cpp format/pattern_json.cpp format/tile_json.cpp methods/recipes.cpp scene/gbuffer_channels.cpp \
	scene/gbuffer_depth.cpp scene/gbuffer_file.cpp scene/gbuffer_normals.cpp scene/gltf_check.cpp scene/gltf_file.cpp scene/gltf_mesh.cpp \
	scene/gltf_source.cpp scene/gltf_values.cpp scene/number_text.cpp scene/obj_text.cpp scene/ply_check.cpp scene/stl_check.cpp \
	volume/runtime/nook_volumes.h |
	awk '/%/ { sub("TOTAL", "all"); print "| `" $1 "` | " $8 " | " int($10) " | " $2 " | " int($4) " |" }'
