#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The table of half resolution in docs/measurements/shading.md: RMSE against full resolution on the courtyard, with a filter of
# equally many taps or of equal reach in the picture; and the smallest percentage of pixels that would have to be computed at full
# resolution for an RMSE of 0.012.
# usage: half.sh NOOK [WxH]
set -eu
nook=$(realpath "${1:?nook, expected the program}")
size=${2:-1280x720}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$nook" gbuffer builtin:courtyard --camera auto:1 --size "$size" -o g.exr >/dev/null
for count in 3 9; do
	"$nook" pattern --domain disk --count $count -o disk.json >/dev/null
	"$nook" tile --pattern disk.json --size 4 -o tile$count.json >/dev/null
done

# difference A B
difference()
{
	"$nook" compare "$1" "$2" --json - | sed -n 's/^\t\t"rmse": \([^,]*\),*$/\1/p' | cut -c 1-6
}

# share A B
share()
{
	oiiotool "$1" "$2" --absdiff -o difference.exr
	oiiotool --info -v --dumpdata difference.exr | awk '/ Pixel / { print $NF }' | sort -gr | awk '
		{ square[NR] = $1 * $1; rest += square[NR] }
		END { for (i = 1; rest > 0.012 * 0.012 * NR; ++i) rest -= square[i]; printf "%.1f\n", 100 * (i - 1) / NR }'
}

# row NAME OPTIONS...
row()
{
	name=$1
	shift
	"$nook" shade g.exr --radius 1.5 --device gl "$@" --resolution half -o half.exr >/dev/null
	"$nook" shade g.exr --radius 1.5 --device gl "$@" -o full.exr >/dev/null
	line="| $name | $(difference half.exr full.exr) | $(share half.exr full.exr) |"
	case $* in
	*"--filter none"*) echo "$line |" ;;
	*)
		"$nook" shade g.exr --radius 1.5 --device gl "$@" --taps 9 -o far.exr >/dev/null
		echo "$line $(difference half.exr far.exr) |"
		;;
	esac
}

echo '| | to 5 taps | pixels, % | to 9 taps |'
echo '| --- | --- | --- | --- |'
row '`vo-line` 3 × 3' --method vo-line --pattern tile3.json
row '`vo-line` 3 × 9' --method vo-line --pattern tile9.json
row '`slices` 1 × 4' --method slices
row '`slices` 3 × 6' --method slices --slices 3 --slice-steps 6
row '`slices` 16 × 16' --method slices --slices 16 --slice-steps 16
row '`slices` 16 × 16, no filter' --method slices --slices 16 --slice-steps 16 --filter none
