#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The table "What nook info expects" of docs/measurements/bake.md: compares nook info's estimates of the two commands that it names,
# nook volumes --masks and nook bake at the suggested distance, with their actual cost: megabytes, of a bake those that it adds,
# seconds of processor time, megabytes of memory.
# usage: advice.sh PROGRAM [LEVEL]...
set -eu
nook=$1
shift
[ $# -gt 0 ] || set -- builtin:cornell builtin:courtyard builtin:suburb builtin:foliage builtin:heightfield:200000
folder=$(mktemp -d "${TMPDIR:-/tmp}/nook advice.XXXXXX")
trap 'rm -rf "$folder"' EXIT

# field NAME: its value in nook info's output.
field()
{
	sed -n "s/^\t\"$1\": \(.*[^,]\),*\$/\1/p" "$folder/i.json"
}

# took FILE ARGUMENTS: runs nook and prints the file's megabytes, seconds and megabytes of memory (GNU time).
took()
{
	file=$1
	shift
	env time -f '%U %S %M' -o "$folder/time" "$@" >"$folder/log" 2>&1 || { cat "$folder/log" >&2; exit 1; }
	size=$(wc -c <"$file")
	awk -v size="$size" '{ printf "%.2f %.1f %.0f", size / 1e6, $1 + $2, $3 * 1024 / 1e6 }' "$folder/time"
}

# row NAME ASSET EXPECTED TOOK: expected and actual values, three each.
row()
{
	# shellcheck disable=SC2086 # words
	printf '| %s | %s | %.2f | %.2f | %.1f | %.1f | %.0f | %.0f |\n' "$1" "$2" $3
}

echo '| level | asset | MB, expected | MB | s, expected | s | memory, MB, expected | memory, MB |'
echo '| --- | --- | --- | --- | --- | --- | --- | --- |'
for level in "$@"; do
	"$nook" info "$level" --json "$folder/i.json" >"$folder/log"
	radius=$(field suggested_distance_m)
	name=$(basename "$level")
	for asset in volumes bake; do
		case $asset in
		volumes)
			found=$(took "$folder/a.glb" "$nook" volumes "$level" --masks --distance "$radius" -o "$folder/a.glb" --json "$folder/s.json")
			;;
		bake)
			found=$(took "$folder/a.glb" "$nook" bake "$level" --radius "$radius" -o "$folder/a.glb" --json "$folder/s.json")
			added=$(sed -n 's/^\t"bytes_added": \([0-9]*\),*$/\1/p' "$folder/s.json")
			found="$(awk "BEGIN { print $added / 1e6 }") ${found#* }"
			;;
		esac
		# shellcheck disable=SC2086 # words
		set_of=$(echo "$(field expected_${asset}_bytes) $(field expected_${asset}_seconds) $(field expected_${asset}_memory_bytes) $found" |
			awk '{ print $1 / 1e6, $4, $2, $5, $3 / 1e6, $6 }')
		[ "$asset" = bake ] || asset=masks
		row "$name" "$asset" "$set_of"
	done
done
