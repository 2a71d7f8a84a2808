#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: job.sh NUMBER...            runs these jobs of the plan in this folder, each unless it is done
#        job.sh --left FIRST LAST    prints the numbers of those that are not done
# Written by nook plan, the same for every plan. `jobs` has a line a job; what becomes of it stands in state/ and log/. A job that was
# killed is run again by the same command; two tries at once wait for each other where there is flock (util-linux).
set -u
plan=$(cd -- "$(dirname -- "$0")" && pwd) || exit 2
. "$plan/plan.sh" || exit 2
program=${NOOK:-$program}
NOOK_DECODED=${NOOK_DECODED-$plan/decoded} # a picture is decoded once, and not once a part
export NOOK_DECODED

fail()
{
	echo "job.sh: $2" >&2
	exit "$1"
}

areThere()
{
	for file in "$@"; do
		[ -e "$plan/$work/$file" ] || return 1
	done
}

# Of the line that was read last.
isDone()
{
	grep -qsF "\"key\": \"$key\"" "$plan/state/$name.done" && outputs
}

load()
{
	case $1 in '' | *[!0-9]*) fail 1 "found job '$1', expected a number from 1 to $count" ;; esac
	line=$(sed -n "${1}p" "$plan/jobs")
	[ -n "$line" ] || fail 1 "found job $1, expected a number from 1 to $count"
	eval "$line"
}

# What nook needs to be, once before any work.
checkProgram()
{
	found=$("$program" --version 2>&1 | head -n 1)
	[ "$found" = "nook $version" ] || fail 5 "$program: found '$found', expected nook $version, for which this was planned"
}

# work [OPTION...] is the job's command. Writes that it is alive as long as it is.
try()
{
	rm -f "$plan/state/$name.done" "$plan/state/$name.exit" "$plan/log/$name.progress"
	if [ "$tells" = 1 ]; then
		work --progress "$plan/log/$name.progress" 2>"$plan/log/$name.err" 9>&- &
	else
		work 2>"$plan/log/$name.err" 9>&- &
	fi
	child=$!
	alive=$plan/state/$name.alive
	: >"$alive"
	(
		trap 'kill $nap 2>/dev/null; exit' TERM
		while kill -0 $child 2>/dev/null; do
			: >"$alive"
			sleep 15 &
			nap=$!
			wait $nap
		done
	) </dev/null >/dev/null 2>&1 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&- & # no lock stays with it
	beat=$!
	trap 'kill -s TERM $child 2>/dev/null' TERM INT HUP
	wait $child
	code=$?
	while kill -0 $child 2>/dev/null; do # a signal ended the waiting
		wait $child
		code=$?
	done
	trap - TERM INT HUP
	kill $beat 2>/dev/null
	rm -f "$alive"
	cat "$plan/log/$name.err" >&2
	if [ $code -eq 0 ] && ! outputs; then
		echo "job.sh: $name: found not all of its outputs, expected them from a command that ended with 0" >&2
		code=4
	fi
	echo $code >"$plan/state/$name.exit"
	if [ $code -eq 0 ]; then
		echo "{\"schema\": \"nook.done/1\", \"job\": \"$name\", \"key\": \"$key\"}" >"$plan/state/$name.done.tmp$$" &&
			mv "$plan/state/$name.done.tmp$$" "$plan/state/$name.done"
	fi
	return $code
}

# In a subshell: it has the lock until it ends.
runJob()
(
	load "$1"
	isDone && exit 0
	for need in $needs; do
		[ -e "$plan/state/$need.done" ] || fail 3 "$name: not run: found that $need is not done"
	done
	if command -v flock >/dev/null; then
		exec 9>>"$plan/state/$name.lock"
		flock 9
		isDone && exit 0
	fi
	checkProgram
	cd -- "$plan/$work" || exit 2
	try
)

if [ "${1-}" = --left ]; then
	sed -n "$2,$3p" "$plan/jobs" | {
		number=$2
		while IFS= read -r line; do
			eval "$line"
			isDone || echo "$number"
			number=$((number + 1))
		done
	}
	exit
fi
[ $# -gt 0 ] || fail 1 "found no number, expected job.sh NUMBER..."
worst=0
for number in "$@"; do
	runJob "$number" || worst=$?
done
exit $worst
