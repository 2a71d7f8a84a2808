#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: job.sh NUMBER...    runs these jobs of the plan in this folder, unless they are up to date
# Written by nook plan. `jobs` has one line per job, done/ a mark for each that is done, log/ what it printed, cache/ its results: a job
# that was killed continues from there. NOOK: the program, if it is not the one that was planned with.
set -u
plan=$(cd -- "$(dirname -- "$0")" && pwd) || exit 2
program=${NOOK:-@PROGRAM@}
version=@VERSION@
found=$("$program" --version 2>&1 | head -n 1)
if [ "$found" != "nook $version" ]; then
	echo "job.sh: $program: found '$found', expected nook $version, for which this was planned" >&2
	exit 5
fi
mkdir -p -- "$plan/done" "$plan/log" && cd -- "$plan" && cd -- @WORK@ || exit 2

# run NAME OUTPUT... -- INPUT... -- WORD...: up to date if the mark is that of this line, the outputs exist and no input is newer.
run()
{
	name=$1 mark=$plan/done/$1 fresh=1
	[ -e "$mark" ] && [ "$(cat "$mark")" = "$line" ] || fresh=0
	shift
	while [ "$1" != -- ]; do
		[ -e "$1" ] || fresh=0
		shift
	done
	shift
	while [ "$1" != -- ]; do
		[ ! "$1" -nt "$mark" ] || fresh=0
		shift
	done
	shift
	[ $fresh = 0 ] || return 0
	"$program" "$@" >"$plan/log/$name" 2>&1
	code=$?
	if [ $code = 0 ]; then
		printf '%s\n' "$line" >"$mark"
	else
		rm -f -- "$mark"
		echo "job.sh: $name: $(tail -n 1 "$plan/log/$name")" >&2
	fi
	return $code
}

worst=0
for number in "$@"; do
	line=$(sed -n "${number}p" "$plan/jobs")
	[ -n "$line" ] || {
		echo "job.sh: found job '$number', expected a number of a line of jobs" >&2
		exit 1
	}
	eval "run $line" || worst=$?
done
exit $worst
