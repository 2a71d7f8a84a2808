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

skip()
{
	echo "skipped: $*" >&2
	exit 77
}

for tool in "$browser" node npm; do
	command -v "$tool" >/dev/null || skip "found no ${tool:-chromium}, expected Debian's packages chromium, nodejs and npm (scripts/setup.sh)"
done
[ -s "$npm/nook.wasm" ] || skip "found no $npm/nook.wasm, expected the npm package of the preset wasm"
mkdir -p "$cache" && cp "$source"/tests/npm_bundlers/package*.json "$cache" || exit 1
if ! [ -e "$cache/installed" ]; then
	(cd "$cache" && timeout 300 npm ci --no-audit --no-fund --ignore-scripts --fetch-retries 1 --fetch-timeout 30000) >"$folder/log" 2>&1 ||
		skip "npm could not install Vite, esbuild, publint and attw: $(tail -n 3 "$folder/log" | tr '\n' ' ')"
	touch "$cache/installed" # only once everything is installed
fi
ln -s "$cache/node_modules" "$folder/node_modules"
tools="$cache/node_modules/.bin"

# Package linters.
cp -r "$npm" "$folder/package"
for linter in "publint --strict" "attw --pack ."; do
	checks=$((checks + 1))
	(cd "$folder/package" && "$tools/"$linter) >"$folder/log" 2>&1 || problem "$linter: $(cat "$folder/log")"
done
checks=$((checks + 1))
sed -i 's/index\.d\.ts/none.d.ts/' "$folder/package/package.json"
(cd "$folder/package" && "$tools/publint" --strict) >"$folder/log" 2>&1 && problem "publint passed a package without its types"

# An application with the package installed from its file.
cp -r "$source/tests/npm_bundlers/app" "$folder/app" && cd "$folder/app" || exit 1
(cd "$npm" && npm pack --silent --pack-destination "$folder") >/dev/null || problem "npm: not packed"
echo '{"type": "module"}' >package.json
npm install --silent --offline --no-audit --no-fund "$folder"/nook-patterns-*.tgz >"$folder/log" 2>&1 || problem "npm: not installed: $(cat "$folder/log")"
cat >"$folder/script.js" <<-'JS'
	while (!globalThis.said) await new Promise(later => setTimeout(later, 50));
	return said;
JS

# served NAME COMMAND…: starts a server that prints its address, and checks its page.
served()
{
	name=$1
	shift
	"$@" >"$folder/address" 2>&1 &
	server=$!
	for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
		grep -q 'http://' "$folder/address" || sleep 0.5
	done
	address=$(sed 's/\x1b\[[0-9;]*m//g' "$folder/address" | grep -o -m 1 'http://[^ ]*')
	checks=$((checks + 1))
	node "$here/page_driver.cjs" "$browser" "$address" <"$folder/script.js" >"$folder/said" 2>"$folder/faults" || problem "$name: $(head -n 5 "$folder/faults")"
	kill $server
	wait $server 2>/dev/null
	checks=$((checks + 1))
	node - "$source/patterns/disk" "$folder/said" >"$folder/log" 2>&1 <<-'JS' || problem "$name: $(grep -m 5 '^[+-]\|Error' "$folder/log")"
		const { deepStrictEqual } = require('node:assert'), { readFileSync } = require('node:fs'), [folder, said] = process.argv.slice(2);
		const catalogue = name => readFileSync(`${folder}/${name}`, 'utf8');
		deepStrictEqual(JSON.parse(readFileSync(said, 'utf8')), { disk: catalogue('disk_004.json'), watched: catalogue('disk_005.json'),
			told: true, texture: 'KTX 20', cancelled: 'AbortError', at_once: true, before: 'AbortError',
			refused: "NookError, --domain: found 'cube', expected disk, ball, sphere or hemisphere" });
	JS
}

served "Vite's server" "$tools/vite" --port 0
checks=$((checks + 1))
"$tools/vite" build --outDir "$folder/vite" --logLevel warn >"$folder/log" 2>&1 || problem "vite build: $(tail -n 5 "$folder/log")"
served "Vite's build" "$tools/vite" preview --outDir "$folder/vite" --port 0
# esbuild does not rewrite URLs: the worker is a separate entry point, nook.wasm is copied.
checks=$((checks + 1))
mkdir "$folder/esbuild" && cp index.html node_modules/nook-patterns/nook.wasm "$folder/esbuild"
"$tools/esbuild" main.js nook_worker=nook-patterns/nook_worker.js --bundle --format=esm --outdir="$folder/esbuild" --log-level=warning >"$folder/log" 2>&1 ||
	problem "esbuild: $(head -n 5 "$folder/log")"
[ -s "$folder/log" ] && problem "esbuild: $(head -n 5 "$folder/log")"
served "esbuild" "$tools/vite" preview --outDir "$folder/esbuild" --port 0
finish
