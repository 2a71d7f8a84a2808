# SPDX-License-Identifier: GPL-3.0-or-later
# Shared by all script tests: counting, and a temporary folder.
failures=0
checks=0

# problem TEXT: counts and prints a failure.
problem()
{
	failures=$((failures + 1))
	echo "FAILED: $*"
}

# same FILE FILE WHAT: checks for equal bytes.
same()
{
	checks=$((checks + 1))
	cmp "$1" "$2" >&2 || problem "$3"
}

# Prints the totals and exits with the result.
finish()
{
	echo "$checks checks, $failures failures"
	[ "$checks" -gt 0 ] && [ "$failures" -eq 0 ]
	exit
}

folder=$(mktemp -d "${TMPDIR:-/tmp}/nook test.XXXXXX")
trap 'rm -rf "$folder"' EXIT
