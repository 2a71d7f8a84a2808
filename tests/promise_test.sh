# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: promise_test.sh PROGRAM SOURCE. Every sentence of the promise in docs/reference/robustness.md names tests, and each of them
# exists.
set -u
source=$2
. "$(dirname "$0")/table.sh"
cd "$source" || exit 1

# Names of all tests: scripts and C++ test cases.
{
	sed -n 's/^.*nook_add_script_test("\([^"]*\)".*/\1/p; s/^.*add_test(NAME "\([^"]*\)".*/\1/p' tests/CMakeLists.txt
	sed -n 's/^TEST_CASE("\([^"]*\)".*/\1/p' tests/*.cpp
} >"$folder/tests"
sed -n '/<!-- promise -->/,/<!-- \/promise -->/p' docs/reference/robustness.md | grep '^| ' | tail -n +3 >"$folder/rows"
while read -r row; do
	sentence=$(echo "$row" | cut -d '|' -f 2)
	case $sentence in *'. '[A-Z]*) problem "'$sentence': found two sentences, expected one a row" ;; esac
	names=$(echo "$row" | cut -d '|' -f 3 | grep -o '`[^`]*`' | tr -d '`')
	[ -n "$names" ] || problem "'$sentence': found no test"
	echo "$names" >>"$folder/named"
done <"$folder/rows"
while read -r name; do
	checks=$((checks + 1))
	grep -q -x -F -e "$name" "$folder/tests" || problem "found the name '$name', expected that of a test"
done <"$folder/named"
[ "$(wc -l <"$folder/rows")" -ge 10 ] || problem "found $(wc -l <"$folder/rows") sentences, expected the promise"
finish
