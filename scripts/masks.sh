#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The table "Masks on real levels" of docs/measurements/levels.md: bytes, seconds and RMSE of masks in views 2 and 3 of auto:3 at
# 240 x 135, against 256 rays. Needs GNU time.
# usage: [OPTIONS="--masks --detail auto"] masks.sh PROGRAM LEVEL RADIUS [LEVEL RADIUS]...
set -eu
nook=$1
shift
folder=$(mktemp -d "${TMPDIR:-/tmp}/nook masks.XXXXXX")
trap 'rm -rf "$folder"' EXIT

# run ARGUMENTS: runs nook; the file "time" then has seconds of processor time.
run()
{
	env time -f '%U %S' -o "$folder/time" "$nook" "$@" >"$folder/log" 2>&1 || { tail -n 3 "$folder/log" >&2; exit 1; }
}

echo '| level | triangles | radius | volumes | bytes | processor time, s | RMSE, view 2 | view 3 |'
echo '| --- | --- | --- | --- | --- | --- | --- | --- |'
while [ $# -gt 0 ]; do
	level=$1
	radius=$2
	shift 2
	run gbuffer "$level" --camera auto:3 --size 240x135 -o "$folder/g.exr"
	# shellcheck disable=SC2086 # words
	run volumes "$level" --distance "$radius" --compress ${OPTIONS:---masks} -o "$folder/v.glb" --json "$folder/v.json"
	took=$(awk '{ printf "%.1f", $1 + $2 }' "$folder/time")
	errors=
	for view in 2 3; do
		run reference "$level" --gbuffer "$folder/g-$view.exr" --falloff linear --radius "$radius" --rays 256 -o "$folder/r.exr"
		run shade "$folder/g-$view.exr" --method aov-mask --volumes "$folder/v.glb" --device cpu -o "$folder/m.exr"
		run compare "$folder/m.exr" "$folder/r.exr" --mask "$folder/g-$view.exr" --json "$folder/c.json"
		errors="$errors | $(sed -n 's/^\t*"rmse": \(.*[^,]\),*$/\1/p' "$folder/c.json" | awk '{ printf "%.4f", $1 }')"
	done
	triangles=$(sed -n 's/^\t*"level_triangles": \([0-9]*\).*/\1/p' "$folder/v.json")
	volumes=$(sed -n 's/^\t*"polygons": \([0-9]*\).*/\1/p' "$folder/v.json")
	printf '| %s | %s | %s | %s | %s | %s%s |\n' "$(basename "$level")" "$triangles" "$radius" "$volumes" \
		"$(wc -c <"$folder/v.glb")" "$took" "$errors"
done
