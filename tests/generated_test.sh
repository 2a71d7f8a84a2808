# SPDX-License-Identifier: GPL-3.0-or-later
# shaders_generated/ matches the tool's current output.
# usage: generated_test.sh NOOK SOURCE_FOLDER
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
sh "$2/scripts/generate.sh" "$1" "$folder"
if grep -rnE 'docs/|[a-z]\.md\b|libsamples' "$folder"; then
	echo "FAILED: found a file of nook's repository named in what it emits" >&2
	exit 1
fi
diff -r -x README.md "$folder" "$2/shaders_generated"
