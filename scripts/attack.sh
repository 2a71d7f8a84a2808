#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The long run of docs/reference/robustness.md: attack.sh PROGRAM [SECONDS [SLOW]]. Every hostile file through info, volumes and gbuffer,
# 100 signals of each kind for every verb, and the rest of the time (3600 s) every fuzz target. SLOW: times as slow as a release build.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
nook=$(realpath "$1")
seconds=${2:-3600}
begin=$(date +%s)
"$(dirname "$nook")/../tests/nook_hostile" "$nook" "$source/tests/hostile/codes.txt" --all --slow "${3:-1}"
sh "$source/tests/faults_test.sh" "$nook" 100
left=$((seconds - $(date +%s) + begin))
if [ "$left" -gt 0 ]; then
	"$source/scripts/fuzz.sh" $((left / 2 + 1)) # ten targets, five at a time
fi
echo "$(($(date +%s) - begin)) s"
