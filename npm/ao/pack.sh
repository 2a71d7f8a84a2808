#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: pack.sh NOOK FOLDER. Writes the npm package nook-ao to FOLDER, ready for `npm pack`: its sources, and the modules that NOOK
# emits. Needs Node.js.
set -eu
nook=$(realpath "$(command -v "$1")")
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$2"
cp "$here"/*.d.ts "$here/README.md" "$2"
# Comments, indentation and spaces would be a tenth of the package; the types have the documentation.
for script in "$here"/*.js; do
	sed -e '2,$ { /^\t*\/\//d; /^\t*\/\*\*.*\*\/$/d; /^\t*\/\*\*/,/\*\/$/d; s/^\t*//; s/[ \t]*\/\/ [^"'"'"'`]*$//; }' "$script" >"$2/${script##*/}"
done
# The licence of emitted files covers the package as well: leave out the sentence that lists them.
sed '/^This licence covers/,/^$/d' "$here/../../LICENSES/MIT.txt" >"$2/LICENSE"
version=$("$nook" --version | sed 's/[^0-9]*\([0-9.]*\).*/\1/;q')
sed "s/@PROJECT_VERSION@/$version/" "$here/package.json.in" >"$2/package.json"
node "$here/generate.mjs" "$nook" "$2"
