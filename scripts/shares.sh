#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: shares.sh PROGRAM N VERB ARGUMENTS... What sharing a command costs: processor seconds of the single run, of N shares and of the run
# that writes the outputs, each on one thread; the largest share over the mean, and the sum over the single run. The output is -o FILE with
# the ending in OUTPUT (default .png). Compares bytes, except for report error, which contains times. For example:
#   nook gbuffer sponza.glb --camera auto:1 --size 1280x720 -o g.exr
#   scripts/shares.sh nook 16 reference sponza.glb --gbuffer g.exr --radius 1.5 --rays 256
set -euo pipefail
nook=$1
count=$2
shift 2
ending=${OUTPUT:-.png}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# seconds COMMAND...: processor time, user and system.
seconds()
{
	local TIMEFORMAT='%U %S'
	{ time "$@" >/dev/null 2>"$folder/error"; } 2>"$folder/time" || { cat "$folder/error" >&2; exit 1; }
	awk '{ printf "%.2f\n", $1 + $2 }' "$folder/time"
}

single=$(seconds "$nook" "$@" -o "$folder/single$ending" --threads 1)
for k in $(seq "$count"); do
	seconds "$nook" "$@" -o "$folder/shared$ending" --threads 1 --cache "$folder/cache" --share "$k/$count" >>"$folder/shares"
done
last=$(seconds "$nook" "$@" -o "$folder/shared$ending" --threads 1 --cache "$folder/cache")
[ "$1 $2" = 'report error' ] || cmp "$folder/single$ending" "$folder/shared$ending"
awk -v single="$single" -v last="$last" -v bytes="$(du -sb "$folder/cache" | cut -f1)" '
	{ sum += $1; if ($1 > most) most = $1 }
	END {
		print "| shares | single, s | mean share, s | largest / mean | sum / single | last run, s | cache, bytes |"
		print "| --- | --- | --- | --- | --- | --- | --- |"
		printf "| %d | %.2f | %.2f | %.3f | %.3f | %.2f | %d |\n", NR, single, sum / NR, most * NR / sum, sum / single, last, bytes
	}' "$folder/shares"
