#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Recomputes the tables of docs/measurements/patterns.md#slices. Takes about two minutes.
# usage: slices.sh NOOK
set -eu
nook=$(realpath "$1")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
kernel=bilateral:5
"$nook" tile --domain slice --count 16 --size 4 -o many.json
"$nook" tile --domain slice --size 4 --filter $kernel -o still.json
"$nook" tile --domain slice --size 4 --filter $kernel --frames 16 -o frames.json
"$nook" tile --domain slice --size 8 --filter $kernel --frames 16 --moves -o moves.json

# error PICTURE: RMSE against many slices.
error()
{
	"$nook" compare "$1" many.exr --json - | sed -n 's/^\t\t"rmse": \([^,]*\),*$/\1/p'
}

echo "| level | samples | frame 1 | 8 | 16 |"
echo "| --- | --- | --- | --- | --- |"
for level in courtyard suburb; do
	"$nook" gbuffer builtin:$level --camera main --size 320x180 -o view.exr
	shade()
	{
		out=$1
		shift
		"$nook" shade view.exr --method slices --radius 1.5 --filter bilateral "$@" -o "$out"
	}
	shade many.exr --pattern many.json
	for tile in none still frames moves; do
		row="| $level | $tile |"
		for frame in 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do
			case $tile in
			none) shade new.exr ;;
			still) shade new.exr --pattern still.json ;;
			*) shade new.exr --pattern $tile.json --frame $frame ;;
			esac
			# The mean of all frames so far, later an exponential mean.
			new=$(awk "BEGIN { n = $frame + 1; print n < 10 ? 1 / n : 0.1 }")
			if [ $frame = 0 ]; then
				mv new.exr mean.exr
			else
				old=$(awk "BEGIN { print 1 - $new }")
				oiiotool mean.exr --mulc "$old" new.exr --mulc "$new" --add -o next.exr
				mv next.exr mean.exr
			fi
			case $frame in
			0 | 7 | 15) row="$row $(printf %.4f "$(error mean.exr)") |" ;;
			esac
		done
		echo "$row"
	done
done

# nookSliceVariant of the sixteen pixels, row by row, and its bits reversed.
{
	printf '{"schema": "nook.tile/1", "domain": "slice", "count": 1, "size": 4, "variants": ['
	comma=
	for place in 0 8 2 10 12 4 14 6 3 11 1 9 15 7 13 5; do
		reverse=$((8 * (place % 2) + 4 * (place / 2 % 2) + 2 * (place / 4 % 2) + place / 8))
		printf '%s{"points": [[%s, %s]], "weights": [1]}' "$comma" "$(awk "BEGIN { print ($place + 0.5) / 16 }")" \
			"$(awk "BEGIN { print ($reverse + 0.5) / 16 }")"
		comma=", "
	done
	printf ']}\n'
} >kernels.json

# behind FILE KERNEL
behind()
{
	"$nook" info "$1" --filter "$2" --json - | sed -n "s/^\t\t\"$2\": \([^,]*\),*\$/\1/p" | head -n 1
}
echo
echo "| behind | the kernel's own | made for it |"
echo "| --- | --- | --- |"
for kernel in box:3 binomial:3 bilateral:5 box:4; do
	"$nook" tile --domain slice --size 4 --filter $kernel -o own.json
	printf '| `%s` | %.3f | %.3f |\n' $kernel "$(behind kernels.json $kernel)" "$(behind own.json $kernel)"
done
