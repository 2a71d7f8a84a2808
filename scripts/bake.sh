#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The first table of docs/measurements/bake.md: compares values at the vertices with values fitted to the surface, on the level's
# triangles and on those refined by --max-error, each pair with the same number of bytes.
# usage: bake.sh PROGRAM [LEVEL RADIUS]...
set -eu
nook=$1
shift
[ $# -gt 0 ] || set -- builtin:cornell 0.5 builtin:courtyard 1.5 builtin:suburb 1.5 builtin:foliage 0.5 builtin:heightfield:200000 1.5
folder=$(mktemp -d "${TMPDIR:-/tmp}/nook bake.XXXXXX")
trap 'rm -rf "$folder"' EXIT

# field NAME: its value in the summary.
field()
{
	sed -n "s/^\t\"$1\": \(.*[^,]\),*\$/\1/p" "$folder/s.json"
}

# row LEVEL WHAT ARGUMENTS: bakes, and prints results and seconds.
row()
{
	level=$1
	what=$2
	shift 2
	begin=$(date +%s.%N)
	"$nook" bake "$level" "$@" -o "$folder/b.glb" --json "$folder/s.json" 2>"$folder/log" || { cat "$folder/log" >&2; exit 1; }
	end=$(date +%s.%N)
	printf '| %s | %s | %s | %s | %.3f | %.4f | %.1f |\n' "$name" "$what" "$(field vertices)" "$(field bytes)" "$(field rmse)" \
		"$(field rms_standard_error)" "$(awk "BEGIN { print $end - $begin }")"
}

echo '| level | bake | vertices | bytes | RMSE | standard error | s |'
echo '| --- | --- | --- | --- | --- | --- | --- |'
while [ $# -gt 0 ]; do
	name=$(basename "$1")
	row "$1" 'at the vertices' --radius "$2" --fit points
	row "$1" fitted --radius "$2"
	row "$1" 'fitted, `--max-error 0.1`' --radius "$2" --max-error 0.1 --max-vertices 400000
	"$nook" level "$folder/b.glb" -o "$folder/refined.glb" # bakes of b.glb would undo the split first
	row "$folder/refined.glb" 'at the vertices of that' --radius "$2" --fit points
	shift 2
done
