# SPDX-License-Identifier: GPL-3.0-or-later
# shaders_generated/ is what the tool emits today.
# usage: generated_test.sh NOOK SOURCE_FOLDER
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
sh "$2/scripts/generate.sh" "$1" "$folder"
diff -r -x README.md "$folder" "$2/shaders_generated"
