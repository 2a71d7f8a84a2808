# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: npm_package_test.sh PROGRAM SOURCE NPM_FOLDER CACHE. Checks the npm package with publint and attw, and in Chromium through
# Vite's server, Vite's build and esbuild. These are downloaded from npm's registry once into CACHE. Exit code 77: no Chromium,
# Node.js, npm or package, or the registry is not available.
set -u
source=$(realpath "$2")
npm=$(realpath -m "$3")
cache=$(realpath -m "$4")
here=$(cd "$(dirname "$0")" && pwd)
. "$here/table.sh"
. "$here/browser.sh"
. "$here/npm_tools.sh"

[ -s "$npm/nook.wasm" ] || skip "found no $npm/nook.wasm, expected the npm package of the preset wasm"
npm_tools "$cache"
linted "$npm"

# An application with the package installed from its file.
application "$source/tests/npm_app" "$npm"

# served NAME COMMAND…: starts a server, and checks its page.
served()
{
	page_said "$@"
	[ -s "$folder/faults" ] && problem "$name: $(head -n 5 "$folder/faults")"
	node - "$source/patterns/disk" "$folder/said" >"$folder/log" 2>&1 <<-'JS' || problem "$name: $(grep -m 5 '^[+-]\|Error' "$folder/log")"
		const { deepStrictEqual } = require('node:assert'), { readFileSync } = require('node:fs'), [folder, said] = process.argv.slice(2);
		const catalogue = name => readFileSync(`${folder}/${name}`, 'utf8');
		deepStrictEqual(JSON.parse(readFileSync(said, 'utf8')), { disk: catalogue('disk_004.json'), watched: catalogue('disk_005.json'),
			told: true, texture: 'KTX 20', cancelled: 'AbortError', at_once: true, before: 'AbortError',
			refused: "NookError, --domain: found 'cube', expected disk, ball, sphere or hemisphere" });
	JS
}

served "Vite's server" "$tools/vite" --port 0
"$tools/vite" build --outDir "$folder/vite" --logLevel warn >"$folder/log" 2>&1 || problem "vite build: $(tail -n 5 "$folder/log")"
served "Vite's build" "$tools/vite" preview --outDir "$folder/vite" --port 0
# esbuild does not rewrite URLs: the worker is a separate entry point, nook.wasm is copied.
mkdir "$folder/esbuild" && cp index.html node_modules/nook-patterns/nook.wasm "$folder/esbuild"
"$tools/esbuild" main.js nook_worker=nook-patterns/nook_worker.js --bundle --format=esm --outdir="$folder/esbuild" --log-level=warning >"$folder/log" 2>&1 ||
	problem "esbuild: $(head -n 5 "$folder/log")"
[ -s "$folder/log" ] && problem "esbuild: $(head -n 5 "$folder/log")"
served "esbuild" "$tools/vite" preview --outDir "$folder/esbuild" --port 0
finish
