#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: guide_test.sh PROGRAM SOURCE. The commands of each guide, copied in order into an empty folder, work and produce its
# result; stated file sizes are correct.
set -eu
nook=$1
source=$2
. "$(dirname "$0")/table.sh"

# page NAME RESULT: checks the contents of RESULT after running the commands.
page()
{
	checks=$((checks + 1))
	mkdir "$folder/$1"
	"$source/scripts/guide.sh" "$nook" "$1" "$folder/$1" >"$folder/log" 2>&1 || { problem "$1: $(tail -n 1 "$folder/log")"; return; }
	[ -s "$folder/$1/$2" ] || problem "$1: found no $2, expected it"
}

page engine_header visibility.pgm
page level darkened.png
page choose_a_method picked/tune.html
page farm ref.exr
page which_asset view.png
page darker_creases alpha.glb

# The demo's commands on patterns; its set-up, reports and levels take minutes.
checks=$((checks + 1))
mkdir -p "$folder/demo/out"
sed -e ':join' -e '/\\$/{N;s/\\\n//;b join' -e '}' "$source/scripts/demo.sh" | sed -n 's/^run \(pattern\|tile\|info\) /"$nook" \1 /p' >"$folder/demo/commands"
[ "$(wc -l <"$folder/demo/commands")" -ge 4 ] || problem "demo.sh: found $(wc -l <"$folder/demo/commands") commands on patterns, expected four or more"
(cd "$folder/demo" && nook=$nook sh -eu commands) >"$folder/log" 2>&1 || problem "demo.sh: $(tail -n 1 "$folder/log")"

bytes()
{
	wc -c <"$folder/$1"
}

# stated PAGE ROW SIZE: a table row containing ROW states SIZE, in its own cell or followed by a unit.
stated()
{
	checks=$((checks + 1))
	grep -F "$2" "$source/docs/guide/$1.md" | grep -q "| $3\( [kM]B\)\? |" || problem "$1: '$2': found another size than the $3 of what its commands write"
}
commas()
{
	echo "$1" | sed -e ':again' -e 's/\([0-9]\)\([0-9]\{3\}\)\($\|,\)/\1,\2\3/' -e 't again'
}
# as DIGITS DIVISOR BYTES
as()
{
	awk -v digits="$1" -v divisor="$2" -v bytes="$3" 'BEGIN { printf "%." digits "f\n", bytes / divisor }'
}
if [ $failures -eq 0 ]; then
	stated level 'volumes, `--distance 1.5`' "$(commas "$(bytes level/volumes.glb)")"
	stated level 'volumes, `--distance 0.9' "$(commas "$(bytes level/sums.glb)")"
	stated level "values at the level's vertices" "$(commas $(($(bytes level/baked.glb) - $(bytes level/level.glb))))"
	stated choose_a_method '`aov-mask`, 128 directions' "$(as 1 1e6 "$(bytes choose_a_method/masks.glb)")"
	stated farm 'level, bytes' "$(as 0 1e6 "$(bytes farm/m.glb)")"
	stated farm 'bytes a pixel' "$(as 1 57600 "$(bytes farm/m.exr)")"
fi
# Not run here: platforms.md (targets_test.sh, debian_test.sh), three.md (npm_ao_test.sh), python.md (python_test.py), engines.md
# (ogre_test.sh, godot_test.sh).
checks=$((checks + 1))
[ "$(find "$source/docs/guide" -name '*.md' | wc -l)" -eq 10 ] || problem "docs/guide: found another number of pages, expected each here"
finish
