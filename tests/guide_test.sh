#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: guide_test.sh PROGRAM SOURCE. The commands of each guide, copied in their order into an empty folder, work and end with its result.
set -eu
nook=$1
source=$2
. "$(dirname "$0")/table.sh"

# page NAME RESULT: what is in RESULT when the commands have run.
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
# platforms.md is not run here: targets_test.sh and debian_test.sh build what it shows.
checks=$((checks + 1))
[ "$(find "$source/docs/guide" -name '*.md' | wc -l)" -eq 6 ] || problem "docs/guide: found another number of pages, expected each here"
finish
