#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Recomputes the measurements in docs/measurements/patterns.md and prints them as a table. Takes some minutes.
# usage: figures.sh NOOK [THOMSON.csv]     THOMSON.csv: rows count,energy of the lowest known energies
set -eu
nook=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# value NAME: that measure from a JSON summary on standard input.
value()
{
	sed -n "s/^\t\t\"$1\": \([^,]*\),*\$/\1/p" | head -n 1
}

# measured OPTIONS...: makes a pattern and writes its summary to $scratch/summary.
measured()
{
	"$nook" pattern "$@" --json "$scratch/summary"
}

# best NAME OPTIONS...: the lowest value among free, centred and symmetric.
best()
{
	name=$1
	shift
	for variant in "" --centre --symmetric; do
		[ "$variant $3" = "--symmetric sphere" ] && continue
		"$nook" pattern "$@" $variant --json - 2>/dev/null | value "$name" || true
	done | sort -g | head -n 1
}

seconds()
{
	start=$(date +%s%N)
	"$@" >/dev/null
	awk "BEGIN { printf \"%.2f\", ($(date +%s%N) - $start) / 1e9 }"
}

# row FIGURE FOUND LIMIT
row()
{
	awk -v figure="$1" -v found="$2" -v limit="$3" 'BEGIN {
		printf "| %s | %.6g | %s | %s |\n", figure, found, limit, found + 0 <= limit + 0 ? "reached" : "**missed**" }'
}

echo "| figure | reached | at most | |"
echo "| --- | --- | --- | --- |"

while read -r count plane cliff; do
	row "disk $count, best of free, centred, symmetric: plane" "$(best plane --domain disk --count "$count")" "$plane"
	for variant in "" --centre --symmetric; do
		"$nook" pattern --domain disk --count "$count" $variant --json - | value cliff
	done | sort -g | head -n 1 >"$scratch/cliff"
	row "disk $count: cliff" "$(cat "$scratch/cliff")" "$cliff"
done <<EOT
9 0.0181 0.0488
16 0.0104 0.0316
32 0.0055 0.0187
EOT

while read -r count plane; do
	row "ball $count, best of free, centred, symmetric: plane on the grid" "$(best plane --domain ball --count "$count")" "$plane"
	row "ball $count: plane in closed form" "$(best plane_exact --domain ball --count "$count")" "$plane"
done <<EOT
8 0.0606
16 0.0375
32 0.0236
64 0.0148
EOT

for domain in disk ball; do
	for count in 2 5 8 9 16 33 64; do
		"$nook" pattern --domain $domain --count $count --symmetric --json - | value centre
	done | sort -g | tail -n 1 >"$scratch/centre"
	row "$domain, symmetric: greatest centre over 2, 5, 8, 9, 16, 33, 64" "$(cat "$scratch/centre")" 1e-6
done

count=4
: >"$scratch/ratios"
while [ $count -le 16 ]; do
	"$nook" pattern --domain disk --count $count --method electro --starts 32 --json "$scratch/paper"
	"$nook" pattern --domain disk --count $count --minimise noise --starts 32 --json "$scratch/quiet"
	echo "$(value noise <"$scratch/quiet") $(value noise <"$scratch/paper") $(value plane <"$scratch/quiet") $(value plane <"$scratch/paper")" >>"$scratch/ratios"
	count=$((count + 1))
done
row "noise against electro, geometric mean over 4 to 16" "$(awk '{ s += log($1 / $2) } END { print exp(s / NR) }' "$scratch/ratios")" 0.80
row "plane against electro, greatest over 4 to 16" "$(awk '{ if ($3 / $4 > m) m = $3 / $4 } END { print m }' "$scratch/ratios")" 1.10

for domain in disk ball; do
	count=1
	: >"$scratch/spread"
	while [ $count -le 64 ]; do
		"$nook" pattern --domain $domain --count $count --method equal --starts 1 --json - | value spread >>"$scratch/spread"
		count=$((count + 1))
	done
	limit=1e-6
	[ $domain = ball ] && limit=1e-3
	row "$domain, equal: greatest spread over 1 to 64" "$(sort -g "$scratch/spread" | tail -n 1)" $limit
done

while read -r count window; do
	"$nook" pattern --domain disk --count "$count" -o "$scratch/base.json"
	"$nook" tile --pattern "$scratch/base.json" --size 4 --json "$scratch/summary"
	row "tile 4 x 4 of disk $count: window" "$(value window <"$scratch/summary")" "$window"
	row "tile 4 x 4 of disk $count: variants' plane against the base" \
		"$(awk "BEGIN { print $(value variant_plane <"$scratch/summary") / $(value base_plane <"$scratch/summary") }")" 1.3
done <<EOT
5 0.0042
9 0.0024
16 0.0014
EOT

if [ $# -gt 1 ]; then
	start=$(date +%s%N)
	grep '^[0-9]' "$2" | while IFS=, read -r count energy; do
		[ "$count" -le 64 ] || continue
		"$nook" pattern --domain sphere --count "$count" --exponent 1 --json - | value energy |
			awk -v least="$energy" '{ print $1 / least - 1 }'
	done | sort -g >"$scratch/excess"
	row "sphere, exponent 1: greatest relative excess over least known energies, $(wc -l <"$scratch/excess") counts" \
		"$(tail -n 1 "$scratch/excess")" 1e-6
	row "the same: seconds" "$(awk "BEGIN { print ($(date +%s%N) - $start) / 1e9 }")" 90
fi

row "disk 16, electro, 32 starts: seconds" "$(seconds "$nook" pattern --domain disk --count 16 --method electro --starts 32 --json -)" 1
row "ball 33, electro, 32 starts: seconds" "$(seconds "$nook" pattern --domain ball --count 33 --method electro --starts 32 --json -)" 6
