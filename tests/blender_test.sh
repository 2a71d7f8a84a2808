#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: blender_test.sh PROGRAM SOURCE. The add-on integrations/blender in Blender: its values, targets, occluders and refusals
# without a window, then its modal operator in a window where xvfb-run can make one. Exit code 77: no Blender (scripts/setup.sh
# blender).
set -u
nook=$(realpath "$1")
source=$(realpath "$2")
. "$(dirname "$0")/table.sh"
command -v blender >/dev/null || { echo "skipped: found no blender, expected Debian's package blender"; exit 77; }
mkdir "$folder/scripts" "$folder/config" "$folder/work"
export BLENDER_USER_SCRIPTS="$folder/scripts" BLENDER_USER_CONFIG="$folder/config"

# blended NAME COMMAND…: checks that Blender ends with 0, and prints what the script says of its checks.
blended()
{
	checks=$((checks + 1))
	name=$1
	shift
	timeout 600 "$@" --factory-startup --python-exit-code 1 --python "$source/tests/blender_test.py" -- \
		"$nook" "$source" "$folder/work" >"$folder/log" 2>&1 || problem "$name: $(tail -n 12 "$folder/log")"
	grep -e ' checks in ' -e '^difference' "$folder/log"
}
blended "without a window" blender -b
if command -v xvfb-run >/dev/null; then
	blended "in a window" xvfb-run -a -s '-screen 0 1280x800x24' env LIBGL_ALWAYS_SOFTWARE=1 blender
fi
finish
