#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A sheet with one picture of a level per method, and the reference.
# usage: methods.sh NOOK LEVEL RADIUS SHEET.png [OPTIONS of nook gbuffer…]
set -eu
nook=$1
level=$2
radius=$3
sheet=$4
shift 4
font=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

"$nook" gbuffer "$level" --size 480x270 -o "$scratch/g.exr" "$@"
sheets=

# label TITLE: draws the title on the picture $scratch/one.png and adds it to the sheet.
label()
{
	next=$scratch/$(printf '%s' "$sheets" | wc -w).png
	oiiotool "$scratch/one.png" --ch 0,0,0 --text:x=8:y=24:size=18:color=0.85,0.1,0.1:font="$font" "$1" -o "$next"
	sheets="$sheets $next"
}

"$nook" reference "$level" --gbuffer "$scratch/g.exr" --radius "$radius" --falloff linear --rays 256 -o "$scratch/one.png"
label "reference: 256 rays, linear falloff"
for method in vo-line "vo-line --recipe paper" vo-point vo-area alchemy statvo slices crytek volumetric-ao \
	"hbao --recipe paper --hbao-angle-bias 10" hbao sao gtao bitmask; do
	# shellcheck disable=SC2086 # a method and its options
	"$nook" shade "$scratch/g.exr" --method $method --radius "$radius" -o "$scratch/one.png"
	label "$method"
done
# shellcheck disable=SC2086 # one file a word
oiiotool --nosoftwareattrib $sheets --mosaic:pad=4 3x5 -o "$sheet"
