# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: stress_cli_test.sh PROGRAM. nook stress: the same bytes on any number of threads, cases that can be shown again, bad input.
set -u
nook=$1
. "$(dirname "$0")/command_line.sh"

works 'form-factor .*share of the hemisphere' stress --cases 60000 --threads 1 -o one.md --json one.json
works 'vo-line' stress --cases 60000 --threads 3 -o three.md --json three.json
same one.md three.md "table, expected the bytes of one thread"
same one.json three.json "JSON, expected the bytes of one thread"
works '"schema": "nook.stress/1"' stress --cases 1000 --kernel prism --kernel falloff --json -
works '(falloff|prism)' stress --cases 1000 --kernel prism --kernel falloff

# The commands that a run names show the case that it names.
sed -n 's/.*"command": "nook \([^"]*\)".*/\1/p' one.json >../commands
[ "$(wc -l <../commands)" -gt 20 ] || problem "one.json: found $(wc -l <../commands) commands, expected one a kernel"
head -n 8 ../commands | while read -r command; do
	"$nook" $command >../stdout || echo "nook $command: exit code $?, expected 0"
	grep -q '^absolute error: 0x' ../stdout || echo "nook $command: found no error, expected one"
done >../said
[ -s ../said ] && problem "$(cat ../said)"

rm -f one.md three.md one.json three.json
fails 1 "--kernel: found 'nothing', expected one of depth-format, " stress --kernel nothing
fails 1 "--kernel: found 'nothing'" stress --kernel nothing --case 3
fails 1 "--case: found 0 times --kernel" stress --case 3
fails 1 "--case: found 2 times --kernel" stress --kernel prism --kernel falloff --case 3
fails 1 "--case: found with -o, --json, --progress or --part" stress --kernel prism --case 3 -o a.md
for count in 0 -1 1.5 1e6 x 99999999999999999999 ''; do
	fails 1 "--cases: found '$count', expected a whole number from 1 to" stress --cases "$count"
done
fails 1 "--case: found '-1'" stress --kernel prism --case -1
fails 1 ".*a.html" stress --cases 1000 -o a.html
fails 2 ".*missing" stress --cases 1000 -o missing/a.md
finish
