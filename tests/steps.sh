# SPDX-License-Identifier: GPL-3.0-or-later
# Shared by the tests of the installed package; source after table.sh.

# step WHAT COMMAND...: must succeed; its output is shown if it does not.
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

# made: the files made by nook in the last build.
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
