#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The table "Six levels" of docs/measurements/levels.md: the cost of each asset of a level, and the RMSE of two pictures of it
# (auto:2, 320 x 180) against rays with a linear falloff. Needs GNU time.
# usage: assets.sh PROGRAM [LEVEL RADIUS]...
set -eu
nook=$1
shift
[ $# -gt 0 ] || set -- builtin:cave 1.5 builtin:heightfield:5000000 3
folder=$(mktemp -d "${TMPDIR:-/tmp}/nook assets.XXXXXX")
trap 'rm -rf "$folder"' EXIT

# run ARGUMENTS: runs nook; the file "time" then has seconds of processor time and KiB of memory.
run()
{
	env time -f '%U %S %M' -o "$folder/time" "$nook" "$@" >"$folder/log" 2>&1 || { tail -n 3 "$folder/log" >&2; exit 1; }
}

# row ASSET BYTES ARGUMENTS: shades both views with these arguments and prints the asset's cost.
row()
{
	asset=$1
	bytes=$2
	took=$(awk '{ printf "%.1f | %.2f", $1 + $2, $3 / 1048576 }' "$folder/time")
	shift 2
	sum=0
	for view in 1 2; do
		run shade "$folder/g-$view.exr" "$@" --device cpu -o "$folder/v.exr"
		run compare "$folder/v.exr" "$folder/r-$view.exr" --mask "$folder/g-$view.exr" --json "$folder/c.json"
		rmse=$(sed -n 's/^\t*"rmse": \(.*[^,]\),*$/\1/p' "$folder/c.json")
		sum=$(awk "BEGIN { print $sum + $rmse * $rmse / 2 }")
	done
	printf '| %s | %s | %s | %s | %s | %.4f |\n' "$name" "$radius" "$asset" "$bytes" "$took" "$(awk "BEGIN { print sqrt($sum) }")"
	name=
}

# size FILE: its bytes.
size()
{
	wc -c <"$folder/$1"
}

echo '| level | radius, m | asset | bytes | processor time, s | memory, GiB | RMSE |'
echo '| --- | --- | --- | --- | --- | --- | --- |'
while [ $# -gt 0 ]; do
	level=$1
	radius=$2
	shift 2
	name=$(basename "$level")
	distance=$(awk "BEGIN { print 0.6 * $radius }")
	run gbuffer "$level" --camera auto:2 --size 320x180 -o "$folder/g.exr"
	for view in 1 2; do
		run reference "$level" --gbuffer "$folder/g-$view.exr" --falloff linear --radius "$radius" --rays 512 -o "$folder/r-$view.exr"
	done
	run level "$level" -o "$folder/level.glb"
	case $level in *.glb) cp "$level" "$folder/level.glb" ;; esac # nook bake adds to this file
	for fit in points surface; do
		run bake "$level" --radius "$radius" --falloff linear --rays 64 --fit "$fit" -o "$folder/b.glb"
		[ "$fit" = points ] && what='bake, values at the vertices' || what='bake'
		row "$what" $(($(size b.glb) - $(size level.glb))) --method bake --bake "$folder/b.glb"
	done
	run volumes "$level" --distance "$radius" --exact-bounds --compress -o "$folder/v.glb"
	row 'volumes, masks' "$(size v.glb)" --method aov-mask --volumes "$folder/v.glb"
	set_of_sums='--exact-bounds --compress --compensate'
	for what in 'volumes, sums' 'volumes, sums, `--detail auto`'; do
		# shellcheck disable=SC2086 # words
		run volumes "$level" --distance "$distance" --ray-distance "$radius" $set_of_sums -o "$folder/v.glb"
		row "$what" "$(size v.glb)" --method aov --volumes "$folder/v.glb"
		set_of_sums="$set_of_sums --detail auto"
	done
	run bake "$level" --radius "$radius" --falloff linear --rays 64 --volumes "$folder/v.glb" -o "$folder/b.glb"
	row 'these, and a bake of the difference' $(($(size v.glb) + $(size b.glb) - $(size level.glb))) --method aov \
		--volumes "$folder/v.glb" --bake "$folder/b.glb"
done
