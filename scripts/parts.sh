#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: parts.sh PROGRAM N VERB ARGUMENTS... What sharing out a command costs: seconds of the processor of the single run, of N parts and
# of the merge, each on one thread; how even the parts are, and what all of them cost over the single run. The verb's outputs are -o
# FILE.ENDING of the variable OUTPUT (default .png). What parts keep for the others, as in a plan, is made by the first, which then runs
# again like the others: the difference is what making it takes, once, and is in the sum. Bytes are compared, but for those of report
# error, which have times. REPEAT: of each part the least of so many times, on a machine that does other work. For example:
#   nook gbuffer sponza.glb --camera auto:1 --size 320x180 -o g.exr
#   scripts/parts.sh nook 16 reference sponza.glb --gbuffer g.exr --radius 1.5 --rays 256
set -euo pipefail
nook=$1
count=$2
shift 2
ending=${OUTPUT:-.png}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# seconds COMMAND...: of the processor, by user and system.
seconds()
{
	local TIMEFORMAT='%U %S'
	{ time "$@" >/dev/null 2>"$folder/error"; } 2>"$folder/time" || { cat "$folder/error" >&2; exit 1; }
	awk '{ printf "%.2f\n", $1 + $2 }' "$folder/time"
}

single=$(for _ in $(seq "${REPEAT:-1}"); do
	seconds "$nook" "$@" -o "$folder/single$ending" --threads 1
done | sort -n | head -n 1)
mkdir "$folder/decoded"
export NOOK_DECODED=$folder/decoded
first=$(seconds "$nook" "$@" --part "1/$count" -o "$folder/1.part" --threads 1)
parts=()
for k in $(seq "$count"); do
	for _ in $(seq "${REPEAT:-1}"); do
		seconds "$nook" "$@" --part "$k/$count" -o "$folder/$k.part" --threads 1
	done | sort -n | head -n 1 >>"$folder/parts"
	parts+=("$folder/$k.part")
done
merge=$(seconds "$nook" merge "${parts[@]}" -o "$folder/merged$ending" --threads 1)
[ "$1 $2" = 'report error' ] || cmp "$folder/single$ending" "$folder/merged$ending"
bytes=$(cat "${parts[@]}" | wc -c)
awk -v single="$single" -v first="$first" -v merge="$merge" -v bytes="$bytes" '
	NR == 1 { once = first > $1 ? first - $1 : 0 }
	{ sum += $1; if ($1 > most) most = $1 }
	END {
		print "| parts | single, s | made once, s | mean of a part, s | greatest / mean | sum of parts / single | merge, s | bytes of parts |"
		print "| --- | --- | --- | --- | --- | --- | --- | --- |"
		printf "| %d | %.2f | %.2f | %.2f | %.3f | %.3f | %.2f | %d |\n", NR, single, once, sum / NR, most * NR / sum, (once + sum) / single,
			merge, bytes
	}' "$folder/parts"
