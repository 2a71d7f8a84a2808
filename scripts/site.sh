#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the live site with the pages of docs.sh in build/live_site/, to open as a file or serve from any address. Needs the programs of
# the presets release and wasm, Node.js, and npm's registry once.
# usage: site.sh [LEVEL] [OPTIONS of site/build.mjs, as --camera, --radius, -- --unit 0.01]
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
modules=$here/build/site_modules
for tool in node npm; do
	command -v $tool >/dev/null || { echo "site.sh: found no $tool, expected Debian's packages nodejs and npm (scripts/setup.sh installs them)" >&2; exit 1; }
done
if ! cmp -s "$here/site/package-lock.json" "$modules/installed"; then
	mkdir -p "$modules"
	cp "$here/site/package.json" "$here/site/package-lock.json" "$modules"
	(cd "$modules" && npm ci --no-audit --no-fund --ignore-scripts)
	cp "$here/site/package-lock.json" "$modules/installed" # only once everything is installed
fi
"$here/scripts/docs.sh"
node "$here/site/build.mjs" --modules "$modules/node_modules" --docs "$here/build/site" -o "$here/build/live_site" "$@"
echo "$here/build/live_site/index.html"
