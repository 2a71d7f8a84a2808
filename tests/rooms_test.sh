#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Every room includes only rooms that its target lists, lists none that it does not include, and comes after those it uses.
#
#	rooms_test.sh SOURCE_FOLDER ROOMS_FILE    (a line a room, in order: "measure: core;pattern")
set -eu
rooms=$1/libsamples
stated=$2
failed=0
before=" "

# The rooms included by the files of a room.
included_by() {
	find "$rooms/$1" -name '*.cpp' -o -name '*.h' -o -name '*.glsl' | xargs sed -n 's/^#include "\([a-z_]*\)\/.*/\1/p' |
		sort -u | grep -vx "$1" || true
}

while IFS=: read -r room uses; do
	[ -n "$room" ] || continue
	uses=$(printf '%s' "$uses" | tr ';' ' ')
	for used in $uses; do
		case $before in
		*" $used "*) ;;
		*)
			echo "$room: found that it uses $used, which does not come before it" >&2
			failed=1
			;;
		esac
		if ! included_by "$room" | grep -qx "$used"; then
			echo "$room: found that it states $used and includes nothing of it, expected no more than it uses" >&2
			failed=1
		fi
	done
	for found in $(included_by "$room"); do
		case " $uses " in
		*" $found "*) ;;
		*)
			echo "$room: found an include of $found:" $(grep -rln "^#include \"$found/" "$rooms/$room") >&2
			failed=1
			;;
		esac
	done
	before="$before$room "
done <"$stated"

for folder in "$rooms"/*/; do
	name=$(basename "$folder")
	case $before in
	*" $name "*) ;;
	*)
		echo "libsamples/$name: found a folder that no room is, expected a nook_room() of that name" >&2
		failed=1
		;;
	esac
done
exit $failed
