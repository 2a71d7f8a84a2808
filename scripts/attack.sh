#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The long run of docs/reference/robustness.md: attack.sh PROGRAM [SECONDS [SLOW]]. Runs every hostile file through info, volumes
# and gbuffer and, in parallel, sends up to 100 signals of each kind to every verb, in two thirds of the time (3600 s); then all
# instruction sets, levels of other sizes, a comparison with an unoptimised build, and for the remaining time, at least a tenth,
# every fuzz target. SLOW: factor by which the program is slower than a release build.
set -u
source=$(cd "$(dirname "$0")/.." && pwd)
nook=$(realpath "$1")
seconds=${2:-3600}
begin=$(date +%s)
failed=0
# part NAME COMMAND...: runs even if earlier parts failed.
part()
{
	name=$1
	shift
	since=$(date +%s)
	found=0
	"$@" || { found=1; echo "FAILED: $name"; }
	echo "$name: $(($(date +%s) - since)) s"
	return $found
}
part "hostile files" "$(dirname "$nook")/../tests/nook_hostile" "$nook" "$source/tests/hostile/codes.txt" --all --slow "${3:-1}" &
hostile=$!
part "faults" sh "$source/tests/faults_test.sh" "$nook" 100 "$(dirname "$nook")/../tests/libnook_fault_calls.so" $((seconds * 2 / 3)) || failed=1
wait $hostile || failed=1
part "instructions" sh "$source/tests/instructions_test.sh" "$nook" sse2 sse4.2 avx avx2 avx512 || failed=1
part "sizes and places" sh "$source/tests/scale_test.sh" "$nook" || failed=1
part "the same bytes without optimisation" sh "$source/tests/same_bytes_test.sh" "$nook" "$source" "$source/build/same_bytes" debug_gcc || failed=1
left=$((seconds - $(date +%s) + begin))
[ $left -ge $((seconds / 10)) ] || left=$((seconds / 10))
part "fuzz targets, with their build" "$source/scripts/fuzz.sh" $((left / 2 + 1)) || failed=1 # ten targets, five at a time
echo "$(($(date +%s) - begin)) s"
exit $failed
