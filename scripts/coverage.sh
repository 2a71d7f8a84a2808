#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Function coverage of each parser: coverage.sh PROGRAM [SECONDS]. Runs the parsers' fuzz targets for SECONDS (60) each, with the
# seeds of scripts/fuzz.sh and the hostile files of their kind, and prints a table of the parsers' sources with the number of
# functions and how many ran. PROGRAM is a release build with nook_hostile built next to it.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
nook=$(realpath "$1")
seconds=${2:-60}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
hostile=$(dirname "$nook")/../tests/nook_hostile
"$hostile" "$nook" "$source/tests/hostile/codes.txt" --write "$folder/files"

# take TARGET GROUP...: adds seeds.
take()
{
	target=$1
	shift
	mkdir -p "$folder/seeds/$target"
	for group in "$@"; do
		mv "$folder/files/$group" "$folder/seeds/$target/"
	done
}
take pattern pattern tile
take csv csv
take glb gltf glb names
take meshes ply stl obj mtl
take volumes volumes
take exr exr

mkdir "$folder/coverage"
NOOK_PROGRAM=$nook NOOK_FUZZ_SEEDS=$folder/seeds NOOK_FUZZ_COVERAGE=$folder/coverage "$source/scripts/fuzz.sh" "$seconds" \
	"$source/build/fuzz" pattern csv glb meshes volumes exr gbuffer report
# COVERED_FUNC: hits: 12 edges: 3/4 NAME PATH:LINE. Counts functions because edges include checks that never fail.
cat "$folder/coverage"/* | awk '
	/^(UN)?COVERED_FUNC: / && $NF ~ /\/(libsamples\/[a-z_\/]*\.cpp|nook_volumes\.h):/ {
		place = $NF
		sub(/.*\/libsamples\//, "", place)
		taken[place] = taken[place] || $1 == "COVERED_FUNC:"
	}
	END {
		for (place in taken) {
			file = place
			sub(/:.*/, "", file)
			all[file] += 1
			run[file] += taken[place]
			functions += 1
			functions_run += taken[place]
		}
		for (file in all) printf "| `%s` | %d | %d |\n", file, all[file], run[file]
		printf "| ~all | %d | %d |\n", functions, functions_run
	}' | sort | sed 's/~all/all/; 1i| parser | functions | run |\n| --- | --- | --- |'
