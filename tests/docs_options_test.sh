#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: docs_options_test.sh PROGRAM SOURCE. The docs' tables of a method's options, between <!-- options: METHOD --> and <!--
# /options -->, match the units, ranges and defaults of the program's own table; every method's page exists.
set -eu
nook=$1
source=$2
. "$(dirname "$0")/table.sh"

"$nook" info --methods >"$folder/methods"
"$nook" shade --help >"$folder/help"
find "$source/docs" -name '*.md' >"$folder/pages"

# "method page" of each row.
sed -n 's/^| `\([^`]*\)` .* \([a-z]*\.md\) |$/\1 \2/p' "$folder/methods" >"$folder/rows"
[ -s "$folder/rows" ] || problem "nook info --methods: found no row, expected one a method"

# cells FILE: option, unit, range and default of each row, without the description.
cells()
{
	grep '^| `--' "$1" | cut -d '|' -f 2-5 | sed 's/  */ /g' || true
}

while read -r method page; do
	checks=$((checks + 1))
	grep -q "/$page\$" "$folder/pages" || problem "$method: found no page docs/**/$page, expected the one that its row names"
	"$nook" info --options "$method" >"$folder/options"
	cells "$folder/options" >"$folder/said"
	while read -r path; do
		sed -n "/^<!-- options: $method -->\$/,/^<!-- \/options -->\$/p" "$path" >"$folder/table"
		[ -s "$folder/table" ] || continue
		cells "$folder/table" >"$folder/written"
		while IFS= read -r row; do
			checks=$((checks + 1))
			grep -qxF -e "$row" "$folder/written" || problem "$path: $method: found no row with$row, expected what nook info --options $method says"
		done <"$folder/said"
		# Other rows of the page are options of all methods.
		cut -d '`' -f 2 "$folder/said" | sort >"$folder/features"
		cut -d '`' -f 2 "$folder/written" | sort | comm -13 "$folder/features" - >"$folder/others"
		while read -r option; do
			checks=$((checks + 1))
			grep -q -e "$option " "$folder/help" || problem "$path: $method: found $option, expected an option of nook shade"
		done <"$folder/others"
	done <"$folder/pages"
done <"$folder/rows"
finish
