# SPDX-License-Identifier: GPL-3.0-or-later
# What the script tests share: counting, and an empty folder that goes away.
failures=0
checks=0

# problem TEXT: one more failure, said aloud.
problem()
{
	failures=$((failures + 1))
	echo "FAILED: $*"
}

# same FILE FILE WHAT: the bytes are equal.
same()
{
	checks=$((checks + 1))
	cmp "$1" "$2" >&2 || problem "$3"
}

# Prints the tally and ends the script with its result.
finish()
{
	echo "$checks checks, $failures failures"
	[ "$checks" -gt 0 ] && [ "$failures" -eq 0 ]
	exit
}

folder=$(mktemp -d "${TMPDIR:-/tmp}/nook test.XXXXXX")
trap 'rm -rf "$folder"' EXIT
