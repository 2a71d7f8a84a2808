# SPDX-License-Identifier: GPL-3.0-or-later
# What the tests of the installed package share; after table.sh.

# step WHAT COMMAND...: succeeds; its output is shown where it does not.
step()
{
	what=$1
	shift
	checks=$((checks + 1))
	"$@" >"$folder/log" 2>&1 && return
	problem "$what: $*"
	tail -n 40 "$folder/log"
	return 1
}

# made: the files that nook made in the last build.
made()
{
	grep -o '\] nook: .*\|%\] nook: .*\|^nook: .*' "$folder/log" | sed 's/^.*nook: //' | sort -u | wc -l
}

# expect_made NUMBER WHAT
expect_made()
{
	checks=$((checks + 1))
	[ "$(made)" -eq "$1" ] || problem "$2: $(made) files made, expected $1"
}
