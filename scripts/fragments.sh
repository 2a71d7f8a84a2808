#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Savings and errors from merging, dropping and trimming a level's volumes: fragments, and AOV's eq. 14 against rays with a linear
# falloff, over two automatic views of 128 x 72; a row of docs/measurements/volumes.md.
# usage: fragments.sh NOOK LEVEL DISTANCE [OPTIONS of nook volumes...] (default: --exact-bounds --trim 0.15)
set -eu
nook=$(realpath "${1:?nook, expected the program}")
level=${2:?level, expected a file or builtin:NAME}
distance=${3:?distance, expected metres}
shift 3
[ $# -gt 0 ] || set -- --exact-bounds --trim 0.15
case $level in builtin:*) ;; *) level=$(realpath "$level") ;; esac

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
rays=$(awk "BEGIN { print $distance / 0.6 }")
"$nook" gbuffer "$level" --camera auto:2 --size 128x72 -o g.exr >out
for view in 1 2; do
	"$nook" reference "$level" --gbuffer g-$view.exr --falloff linear --radius "$rays" --rays 400 -o r-$view.exr >out
done

# field FILE NAME: the first number with that name.
field()
{
	sed -n "s/.*\"$2\": *\([0-9.e+-]*\).*/\1/p" "$1" | head -n 1
}

# draw NAME FACES OPTIONS...: makes volumes, draws both views, prints the number of volumes, fragments and mean eq. 14.
draw()
{
	name=$1
	faces=$2
	shift 2
	"$nook" volumes "$level" --distance "$distance" --compensate --ray-distance "$rays" "$@" -o $name.glb --json $name.json
	fragments=0
	error=0
	for view in 1 2; do
		"$nook" shade g-$view.exr --method aov --volumes $name.glb --device gl --faces "$faces" -o v.exr --json v.json
		"$nook" compare v.exr r-$view.exr --mask g-$view.exr --json c.json >out
		fragments=$(awk "BEGIN { printf \"%d\", $fragments + $(field v.json fragments) }")
		error=$(awk "BEGIN { print $error + $(field c.json eq14) / 2 }")
	done
	volumes=$(field $name.json polygons)
}

draw all front --no-merge --no-drop
all=$fragments
all_error=$error
all_volumes=$volumes
draw some chosen "$@"
awk "BEGIN { printf \"| %s, %s m | %d | %d | %.4f | %d | %d (1/%.1f) | %.4f (%+.1f %%) |\n\", \"$(basename "$level")\", $distance,
	$all_volumes, $all, $all_error, $volumes, $fragments, $all / $fragments, $error, 100 * ($error / $all_error - 1) }"
