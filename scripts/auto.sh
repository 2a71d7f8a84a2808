#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The table of nook bake --auto in docs/measurements/bake.md: bakes and volumes of a level by bytes, and their errors in views 2 and
# 3 of auto:3 at 240 x 135, against 256 rays with a linear falloff.
# usage: auto.sh PROGRAM LEVEL RADIUS [LEVEL RADIUS]...
set -eu
nook=$1
shift
folder=$(mktemp -d "${TMPDIR:-/tmp}/nook auto.XXXXXX")
trap 'rm -rf "$folder"' EXIT

run()
{
	env time -f '%U %S' -o "$folder/time" "$nook" "$@" >"$folder/log" 2>&1 || { tail -n 3 "$folder/log" >&2; exit 1; }
}

# field FILE NAME: its value in a summary.
field()
{
	sed -n "s/^\t*\"$2\": \(.*[^,]\),*\$/\1/p" "$1" | head -n 1
}

# row WHAT BYTES METHOD OPTION FILE: draws an asset that was made just now.
row()
{
	took=$(awk '{ printf "%.0f", $1 + $2 }' "$folder/time")
	errors=
	for view in 2 3; do
		run shade "$folder/g-$view.exr" --method "$3" "$4" "$5" --device cpu -o "$folder/m.exr"
		run compare "$folder/m.exr" "$folder/r-$view.exr" --mask "$folder/g-$view.exr" --json "$folder/c.json"
		errors="$errors | $(field "$folder/c.json" rmse | awk '{ printf "%.4f", $1 }')"
	done
	printf '| %s | %s | %s%s | %s |\n' "$name" "$1" "$2" "$errors" "$took"
}

bake()
{
	what=$1
	shift
	run bake "$level" --radius "$radius" --falloff linear "$@" -o "$folder/b.glb" --json "$folder/b.json"
	row "$what" "$(field "$folder/b.json" bytes_added)" bake --bake "$folder/b.glb"
}

echo '| level | asset | bytes | RMSE, view 2 | view 3 | processor time, s |'
echo '| --- | --- | --- | --- | --- | --- |'
while [ $# -gt 0 ]; do
	level=$1
	radius=$2
	name=$(basename "$level")
	shift 2
	run gbuffer "$level" --camera auto:3 --size 240x135 -o "$folder/g.exr"
	for view in 2 3; do
		run reference "$level" --gbuffer "$folder/g-$view.exr" --falloff linear --radius "$radius" --rays 256 -o "$folder/r-$view.exr"
	done
	bake 'vertices'
	values=$(field "$folder/b.json" bytes_added)
	vertices=$(field "$folder/b.json" vertices)
	bake '`--auto`' --auto
	bake '`--max-error 0.1`, a twentieth more vertices' --max-error 0.1 --max-vertices $((vertices * 21 / 20))
	run volumes "$level" --compress --distance "$radius" --masks --detail auto -o "$folder/v.glb"
	volume_bytes=$(wc -c <"$folder/v.glb")
	row masks "$volume_bytes" aov-mask --volumes "$folder/v.glb"
	[ "$volume_bytes" -le "$values" ] || bake '`--auto --max-bytes`' --auto --max-bytes "$volume_bytes"
done
