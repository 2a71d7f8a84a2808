# SPDX-License-Identifier: GPL-3.0-or-later
# Shared by the tests of npm packages. Source after table.sh and browser.sh. Exits with 77 where Chromium, Node.js or npm is missing,
# or the registry is not available.

skip()
{
	echo "skipped: $*" >&2
	exit 77
}

# npm_packages FOLDER PACKAGE@VERSION…: installs packages from npm's registry into FOLDER, once. What they depend on has the versions
# that this day had: a version never changes once it is published.
npm_packages()
{
	cache=$1
	shift
	command -v node >/dev/null && command -v npm >/dev/null || skip "found no node or no npm, expected both (scripts/setup.sh)"
	mkdir -p "$cache" && cache=$(realpath "$cache") || exit 1
	if [ "$(cat "$cache/installed" 2>/dev/null)" != "$*" ]; then
		rm -rf "$cache/node_modules" "$cache"/package*.json
		(cd "$cache" && timeout 300 npm install --before=2026-11-12 --no-audit --no-fund --ignore-scripts --fetch-retries 1 --fetch-timeout 30000 "$@") \
			>"$folder/log" 2>&1 || skip "npm could not install $*: $(tail -n 3 "$folder/log" | tr '\n' ' ')"
		echo "$*" >"$cache/installed" # only once everything is installed
	fi
}

# npm_tools CACHE: installs bundlers and linters, and the packages that nook-ao works with, links them into $folder, and sets $tools.
npm_tools()
{
	[ -n "$browser" ] || skip "found no chromium, expected Debian's package chromium (scripts/setup.sh)"
	npm_packages "$1" @arethetypeswrong/cli@0.18.5 esbuild@0.28.2 postprocessing@6.39.6 publint@0.3.25 three@0.187.0 vite@8.3.8
	ln -s "$cache/node_modules" "$folder/node_modules"
	tools="$cache/node_modules/.bin"
}

# linted PACKAGE OPTIONS…: checks a package with publint and attw, which gets the options, and that publint notices missing types.
linted()
{
	cp -r "$1" "$folder/package"
	shift
	for linter in "publint --strict" "attw --pack . $*"; do
		checks=$((checks + 1))
		(cd "$folder/package" && "$tools/"$linter) >"$folder/log" 2>&1 || problem "$linter: $(cat "$folder/log")"
	done
	checks=$((checks + 1))
	sed -i 's/index\.d\.ts/none.d.ts/' "$folder/package/package.json"
	(cd "$folder/package" && "$tools/publint" --strict) >"$folder/log" 2>&1 && problem "publint passed a package without its types"
}

# application SOURCES PACKAGE: an application in $folder/app with a package installed from its file, $tarball. Goes there.
application()
{
	cp -r "$1" "$folder/app" && cd "$folder/app" || exit 1
	tarball="$folder/$(cd "$2" && npm pack --silent --pack-destination "$folder")"
	echo '{"type": "module"}' >package.json
	npm install --silent --offline --legacy-peer-deps --no-audit --no-fund "$tarball" >"$folder/log" 2>&1 || problem "npm: not installed: $(cat "$folder/log")"
}

# page_said NAME COMMAND…: starts a server that prints its address, and opens its page. What the page leaves in globalThis.said goes
# to $folder/said, its faults to $folder/faults. $page_path and $page_options: another page, and options of page_driver.cjs.
page_said()
{
	name=$1
	shift
	: >"$folder/address"
	"$@" >"$folder/address" 2>&1 &
	server=$!
	for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
		grep -q 'http://' "$folder/address" || sleep 0.5
	done
	address=$(sed 's/\x1b\[[0-9;]*m//g' "$folder/address" | grep -o -m 1 'http://[^ ]*')
	node "$here/page_driver.cjs" "$browser" "$address${page_path-}" --wait 300 ${page_options-} >"$folder/said" 2>"$folder/faults" <<-'JS'
		while (!globalThis.said) await new Promise(later => setTimeout(later, 50));
		return said;
	JS
	kill $server
	wait $server 2>/dev/null
}
