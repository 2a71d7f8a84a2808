#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The table of whole methods in docs/measurements/methods.md: processor milliseconds, on all cores together, for one picture of the
# courtyard through OpenGL on a CPU, with method and filter. Computed as the cost of nook shade with 9 more drawings (--timing)
# minus the cost without; rounds are interleaved and the lowest counts, which makes it robust against other programs.
# usage: times.sh NOOK [ROUNDS [WxH]]
set -eu
nook=$(realpath "${1:?nook, expected the program}")
rounds=${2:-3}
size=${3:-1280x720}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$nook" gbuffer builtin:courtyard --camera auto:1 --size "$size" -o g.exr >/dev/null
"$nook" pattern --domain disk --count 3 -o disk.json >/dev/null
"$nook" tile --pattern disk.json --size 4 -o tile.json >/dev/null

cat >forms <<'END'
`hbao` 6 × 6, 13 taps|--method hbao --taps 13
`hbao` 6 × 6, 5 taps|--method hbao
`gtao` 3 × 6, 5 taps|--method gtao
`vo-line` 3 × 3, 5 taps|--method vo-line --pattern tile.json
`vo-line` 3 × 3, 5 taps, half|--method vo-line --pattern tile.json --resolution half
`slices` 1 × 4, 5 taps|--method slices
`slices` 1 × 4, 5 taps, half|--method slices --resolution half
`slices` 3 × 6, 5 taps|--method slices --slices 3 --slice-steps 6
END

# spent: seconds of processor time of this script's children so far
spent()
{
	times >spent.txt
	tail -n 1 spent.txt | tr 'ms' '  ' | awk '{ print 60 * $1 + $2 + 60 * $3 + $4 }'
}

# taken OPTIONS...: seconds of processor time
taken()
{
	spent >before.txt
	"$nook" shade g.exr --radius 1.5 --device gl "$@" -o v.exr >/dev/null
	spent >after.txt
	paste before.txt after.txt | awk '{ print $2 - $1 }'
}

for round in $(seq "$rounds"); do
	while IFS='|' read -r name options; do
		# shellcheck disable=SC2086
		taken $options >once.txt
		# shellcheck disable=SC2086
		taken $options --timing >ten.txt
		paste once.txt ten.txt | awk -v name="$name" -F '\t' '{ printf "%s|%.1f\n", name, 1000 * ($2 - $1) / 9 }' >>measured
	done <forms
done

echo '| | ms of processor time | × `hbao` |'
echo '| --- | --- | --- |'
awk -F '|' '
	!($1 in least) { order[++n] = $1; least[$1] = $2 }
	$2 < least[$1] { least[$1] = $2 }
	END { for (i = 1; i <= n; ++i) printf "| %s | %.0f | %.2f |\n", order[i], least[order[i]], least[order[i]] / least[order[1]] }' measured
