#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A sheet with methods and rays, and for each method the region where it errs most, as all the others draw it. Prints the regions
# and errors.
# usage: worst.sh NOOK LEVEL REACH SHEET.png    REACH: ray length in metres
set -eu
nook=$(realpath "${1:?nook, expected the program}")
level=$2
reach=$3
sheet=$4
font=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
wide=64 # size of a region in pixels
high=36
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$nook" gbuffer "$level" --camera auto:1 --size 480x270 -o "$scratch/g.exr" >/dev/null
"$nook" reference "$level" --gbuffer "$scratch/g.exr" --falloff linear --radius "$reach" --rays 256 -o "$scratch/0.exr" >/dev/null
"$nook" pattern --domain disk --count 3 -o "$scratch/p3.json" >/dev/null
"$nook" tile --pattern "$scratch/p3.json" --size 4 -o "$scratch/t3.json" >/dev/null
sheets=
methods=0

# show NAME CUT TITLE: adds a part of a picture to the sheet.
show()
{
	next=$scratch/$(printf '%s' "$sheets" | wc -w).png
	oiiotool "$scratch/$1.exr" --ch visibility,visibility,visibility --chnames R,G,B --cut "$2" --resize:filter=box 256x144 \
		--text:x=6:y=18:size=14:color=0.85,0.1,0.1:font="$font" "$3" -o "$next"
	sheets="$sheets $next"
}

# method TITLE OPTIONS...
method()
{
	methods=$((methods + 1))
	printf '%s' "$1" >"$scratch/$methods.title"
	shift
	"$nook" shade "$scratch/g.exr" --radius "$reach" --filter bilateral "$@" -o "$scratch/$methods.exr" >/dev/null
}
method "vo-line 3 x 3" --method vo-line --pattern "$scratch/t3.json"
method "slices 1 x 4" --method slices
method "hbao 6 x 6" --method hbao
method "vo-line 9, paper" --method vo-line --recipe paper

printf 'rays' >"$scratch/0.title"
for i in $(seq 0 $methods); do
	show "$i" 480x270+0+0 "$(cat "$scratch/$i.title")"
done
for i in $(seq 1 $methods); do
	# The greatest mean error over a region: the maximum of pictures blurred by its size, away from the border.
	oiiotool "$scratch/$i.exr" --ch visibility "$scratch/0.exr" --ch visibility --absdiff --blur:kernel=box ${wide}x$high -o "$scratch/errors.exr"
	oiiotool "$scratch/errors.exr" --cut $((480 - wide))x$((270 - high))+$((wide / 2))+$((high / 2)) --chnames visibility -o "$scratch/inner.exr"
	oiiotool "$scratch/inner.exr" --mulc 0 --chnames visibility -o "$scratch/none.exr"
	found=$("$nook" compare "$scratch/inner.exr" "$scratch/none.exr" | sed -n 's/^max *\([0-9.]*\) *at pixel \([0-9]*\),\([0-9]*\).*/\1 \2 \3/p')
	# shellcheck disable=SC2086 # error, x, y
	set -- $found
	echo "$(cat "$scratch/$i.title"): mean error $1 around $(($2 + wide / 2)),$(($3 + high / 2))"
	for j in $(seq 0 $methods); do
		title=
		[ "$j" -ne 0 ] || title="worst of $(cat "$scratch/$i.title")"
		show "$j" "${wide}x$high+$2+$3" "$title"
	done
done
# shellcheck disable=SC2086 # one file a word
oiiotool --nosoftwareattrib $sheets --mosaic:pad=4 $((methods + 1))x$((methods + 1)) -o "$sheet"
