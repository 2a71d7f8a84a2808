#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: run.sh [JOBS]    runs what is left of the plan in this folder on this machine, so many at a time (default: as many as there
#                         are processors), by GNU parallel where it is installed, else by xargs
# Written by nook plan, the same for every plan. Ends with 0 where all jobs are done, else with 4.
set -u
cd -- "$(dirname -- "$0")" || exit 2
. ./plan.sh || exit 2
at_once=${1:-$(nproc 2>/dev/null || echo 1)}

# A wave: jobs FIRST to LAST, which wait for none of each other.
wave()
{
	left=$(sh job.sh --left "$1" "$2")
	[ -n "$left" ] || return
	if parallel --version 2>/dev/null | grep -q '^GNU parallel'; then
		printf '%s\n' "$left" | parallel --will-cite --jobs "$at_once" sh job.sh &
	else
		printf '%s\n' "$left" | xargs -n 1 -P "$at_once" sh job.sh &
	fi
	wait $!
}

# nook batch gives it a process group of its own, which ends as one.
[ -z "${NOOK_GROUP-}" ] || trap 'trap "" TERM; kill -s TERM 0; exit 143' TERM INT HUP

depth=
# group NUMBER DEPTH FIRST LAST ...: groups stand by depth.
group()
{
	if [ "$2" != "$depth" ]; then
		[ -z "$depth" ] || wave "$from" "$to"
		depth=$2
		from=$3
	fi
	to=$4
}
. ./groups
wave "$from" "$to"
left=$(sh job.sh --left 1 "$count" | wc -l)
[ "$left" -eq 0 ] && exit 0
echo "run.sh: found $left of $count jobs not done, expected none: nook plan --status says why; run.sh goes on with them" >&2
exit 4
