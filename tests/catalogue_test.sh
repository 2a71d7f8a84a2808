# SPDX-License-Identifier: GPL-3.0-or-later
# Regenerated entries of the catalogue are identical byte for byte; a changed byte is detected.
# usage: catalogue_test.sh NOOK SOURCE_FOLDER
set -eu
nook=$1
patterns=$2/patterns

"$nook" catalogue --domain disk --counts 4-7 --tiles -o "$patterns" --check
"$nook" catalogue --domain ball --counts 8-9 -o "$patterns" --check
"$nook" catalogue --domain sphere --counts 23-24 -o "$patterns" --check
"$nook" catalogue --domain hemisphere --counts 15-16 -o "$patterns" --check

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp -r "$patterns/sphere" "$folder"
changed=$(ls "$folder"/sphere/* | sed -n 2p)
sed -i 's/"count": *3/"count": 4/' "$changed"
code=0
"$nook" catalogue --domain sphere --counts 3-3 -o "$folder" --check 2>/dev/null || code=$?
if [ "$code" -ne 7 ]; then
	echo "a changed entry: found exit code $code, expected 7" >&2
	exit 1
fi
