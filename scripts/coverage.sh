#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# How much of each parser runs: coverage.sh PROGRAM [SECONDS]. Runs the fuzz targets of the parsers for SECONDS (60) each, from the seeds
# of scripts/fuzz.sh and the hostile files of their kind, and prints a table of the parsers' sources: of the edges between their basic
# blocks, how many were taken. PROGRAM is a release build, beside which nook_hostile was built.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
nook=$(realpath "$1")
seconds=${2:-60}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
hostile=$(dirname "$nook")/../tests/nook_hostile
"$hostile" "$nook" "$source/tests/hostile/codes.txt" --write "$folder/files"

# take TARGET GROUP...: as further seeds.
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
# COVERED_FUNC: hits: 12 edges: 3/4 NAME PATH:LINE. Of a function that several targets have, the most.
cat "$folder/coverage"/* | awk '
	/^(UN)?COVERED_FUNC: / && $NF ~ /\/(libsamples\/[a-z_\/]*\.cpp|nook_volumes\.h):/ {
		place = $NF
		sub(/.*\/libsamples\//, "", place)
		split($5, edges, "/")
		if (edges[1] + 0 >= taken[place] + 0) { taken[place] = edges[1]; all[place] = edges[2] }
	}
	END {
		for (place in all) {
			file = place
			sub(/:.*/, "", file)
			files_taken[file] += taken[place]
			files_all[file] += all[place]
			sum_taken += taken[place]
			sum_all += all[place]
		}
		for (file in files_all) printf "| `%s` | %d | %d |\n", file, files_all[file], 100 * files_taken[file] / files_all[file]
		printf "| ~all | %d | %d |\n", sum_all, 100 * sum_taken / sum_all
	}' | sort | sed 's/~all/all/; 1i| parser | edges | taken, % |\n| --- | --- | --- |'
