#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Savings of each kind of skipping, measured with and without in one run; rows of docs/measurements/shading.md. Times are medians of
# 9 drawings on --device DEVICE (cpu by default).
# usage: skipping.sh NOOK LEVEL [DEVICE]
set -eu
nook=$(realpath "${1:?nook, expected the program}")
level=${2:?level, expected a file or builtin:NAME}
device=${3:-cpu}
case $level in builtin:*) ;; *) level=$(realpath "$level") ;; esac

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# field FILE NAME: the first number with that name.
field()
{
	sed -n "s/.*\"$2\": *\([0-9.e+-]*\).*/\1/p" "$1" | head -n 1
}

# draw NAME GBUFFER OPTIONS...: draws, and keeps milliseconds and picture under that name.
draw()
{
	name=$1
	from=$2
	shift 2
	"$nook" shade "$from" "$@" --recipe paper --device "$device" --threads 1 --timing --json "$name.json" -o "$name.exr" >out
}

# change NAME NAME: root mean squared difference of two pictures.
change()
{
	"$nook" compare "$1.exr" "$2.exr" --json c.json >out
	awk "BEGIN { printf \"%.2g\", $(field c.json rmse) }"
}

# row WHAT SKIPPED WITHOUT WITH CHANGE
row()
{
	awk "BEGIN { printf \"| %s | %s | %.3g | %.3g | %.0f %% | %s |\\n\", \"$1\", \"$2\", $3, $4, 100 * (1 - $4 / $3), \"$5\" }"
}

"$nook" gbuffer "$level" --camera auto:1 --size 640x360 -o g.exr >out
"$nook" gbuffer "$level" --eye 0,1e4,0 --target 1,2e4,0 --size 640x360 -o up.exr >out
"$nook" pattern --domain disk --count 9 --order progressive -o p.json >out
echo "| $(basename "$level"), 640 x 360, $device | what is left out | ms without | ms with | saved | change (RMSE) |"
echo "| --- | --- | --- | --- | --- | --- |"

draw lines g.exr --method vo-line --pattern p.json
draw sky up.exr --method vo-line --pattern p.json
row "sky, nine lines" "all pixels, against a view without" "$(field lines.json milliseconds)" "$(field sky.json milliseconds)" "-"

draw bands g.exr --method vo-line --pattern p.json --bands 3
row "distant pixels, \`--bands 3\`" "a third or two thirds of the lines" "$(field lines.json milliseconds)" \
	"$(field bands.json milliseconds)" "$(change bands lines)"

draw half g.exr --method vo-line --pattern p.json --resolution half
row "flat regions, \`--resolution half\`" "three of four pixels, but for edges" "$(field lines.json milliseconds)" \
	"$(field half.json milliseconds)" "$(change half lines)"

draw layers g.exr --method statvo --layers 4 --skip no
draw fewer g.exr --method statvo --layers 4 --skip yes
row "empty layers, \`statvo --skip yes\`" "layers of smooth tiles" "$(field layers.json milliseconds)" "$(field fewer.json milliseconds)" \
	"$(change fewer layers)"

"$nook" volumes "$level" --distance 0.5 --no-drop --no-merge --exact-bounds --json all_made.json -o all.glb >out
"$nook" volumes "$level" --distance 0.5 --exact-bounds --json some_made.json -o some.glb >out
"$nook" volumes "$level" --distance 0.5 --exact-bounds --trim 0.15 -o trim.glb >out
draw all g.exr --method aov --volumes all.glb
draw some g.exr --method aov --volumes some.glb
draw trim g.exr --method aov --volumes trim.glb
row "merged polygons, and volumes that darken nothing" "$(field all_made.json polygons) polygons to $(field some_made.json polygons)" "$(field all.json milliseconds)" \
	"$(field some.json milliseconds)" "$(change some all)"
row "faint parts of volumes, \`--trim 0.15\`" "$(field some.json fragments) fragments to $(field trim.json fragments)" \
	"$(field some.json milliseconds)" "$(field trim.json milliseconds)" "$(change trim some)"
draw third g.exr --method aov --volumes some.glb --resolution third
row "flat regions, volumes at a third" "$(field some.json fragments) fragments to $(field third.json fragments)" \
	"$(field some.json milliseconds)" "$(field third.json milliseconds)" "$(change third some)"
