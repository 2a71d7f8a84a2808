#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The table "What flickers in rays" of docs/measurements/methods.md: flicker over four sub-pixel shifts, as defined by `nook report
# error`, of rays and similar forms. The rays' noise is removed: a variance is the mean product of the differences in two traces
# with different seeds, whose noise is uncorrelated.
# usage: flicker.sh NOOK LEVEL [RADIUS [WxH]]
set -eu
nook=$(realpath "${1:?nook, expected the program}")
level=${2:?level, expected one}
radius=${3:-1.5}
size=${4:-240x135}
[ ! -e "$level" ] || level=$(realpath "$level")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# The views: the camera's, and four shifted by fractions of a pixel.
"$nook" gbuffer "$level" --camera auto:1 --size "$size" -o g.exr >/dev/null
"$nook" info g.exr >facts
views="0 1 2 3"
for k in $views; do
	projection=$(awk -v k="$k" -v size="$size" '/^projection64/ { row = 4; next }
		row > 0 { for (i = 1; i <= 4; ++i) p[4 - row, i] = $i; row -= 1 }
		END {
			split(size, s, "x")
			y = k * 0.6180339887498949 + 0.5
			dx = 2 * ((k + 0.5) / 4 - 0.5) / s[1]
			dy = 2 * (y - int(y) - 0.5) / s[2]
			for (i = 1; i <= 4; ++i) { p[0, i] += dx * p[3, i]; p[1, i] += dy * p[3, i] }
			for (i = 1; i <= 4; ++i) for (j = 0; j < 4; ++j) printf "%.17g ", p[j, i]
		}' facts)
	"$nook" gbuffer "$level" --camera auto:1 --size "$size" --projection "$projection" -o g$k.exr >/dev/null
done

# Pixels that show one smooth surface in all views: depths within a twentieth, normals within 5 degrees.
for k in "" $views; do
	oiiotool g$k.exr --ch Z --chnames Y --clamp:max=1e6 -o z$k.exr
	oiiotool g$k.exr --ch N.X,N.Y,N.Z --chnames R,G,B -o n$k.exr
done
oiiotool z.exr --mulc -1 --addc 1e5 --clamp:min=0:max=1 -o smooth.exr
for k in $views; do
	oiiotool z.exr --mulc 0.05 z.exr z$k.exr --absdiff --sub --mulc 1e6 --clamp:min=0:max=1 smooth.exr --mul -o smooth.exr
	oiiotool n.exr n$k.exr --mul --chsum:weight=1,1,1 --chnames Y --subc 0.996 --mulc 1e6 --clamp:min=0:max=1 smooth.exr --mul -o smooth.exr
done
mean()
{
	oiiotool --stats "$1" | awk '/Stats Avg/ { print $3 }'
}
share=$(mean smooth.exr)

# flicker A B: from the pictures A0 to A3 and B0 to B3, over all pairs.
flicker()
{
	for pair in 01 02 03 12 13 23; do
		one=${pair%?}
		two=${pair#?}
		oiiotool "$1$one.exr" "$1$two.exr" --sub "$2$one.exr" "$2$two.exr" --sub --mul smooth.exr --mul --mulc 1e4 -o product.exr
		mean product.exr # six digits after the point
	done | awk -v share="$share" '{ sum += $1 } END { printf "%.4f\n", sqrt(sum / 1e4 / NR / share / 2) }'
}

# row NAME OPTIONS...: options of nook shade.
row()
{
	name=$1
	shift
	for k in $views; do
		"$nook" shade g$k.exr --radius "$radius" "$@" -o v$k.exr >/dev/null
	done
	echo "| $name | $(flicker v v) | $("$nook" compare v0.exr a0.exr --mask g0.exr --json - | sed -n 's/^\t\t"rmse": \([^,]*\),*$/\1/p' | cut -c 1-6) |"
}

for k in $views; do
	for trace in a1 b2; do
		"$nook" reference "$level" --gbuffer g$k.exr --radius "$radius" --falloff linear --rays 512 --seed "${trace#?}" -o "${trace%?}$k.exr" >/dev/null
		oiiotool "${trace%?}$k.exr" --ch visibility -o "${trace%?}$k.exr"
	done
done
for count in 5 9; do
	"$nook" pattern --domain disk --count $count -o disk$count.json >/dev/null
	"$nook" tile --pattern disk$count.json --size 4 -o tile$count.json >/dev/null
done
echo '| | flicker | RMSE to rays |'
echo '| --- | --- | --- |'
echo "| rays | $(flicker a b) | |"
row '9 lines, paper, `window thick`' --method vo-line --recipe paper --pattern tile9.json --filter window --thickness "$radius"
row 'slices 16 × 16, rays, no filter' --method slices --slices 16 --slice-steps 16 --filter none
row 'slices 3 × 6, rays, 5 taps' --method slices --slices 3 --slice-steps 6
row 'slices 1 × 4, rays, 5 taps' --method slices
row '3 × 5 lines, rays, 5 taps' --method vo-line --pattern tile5.json
