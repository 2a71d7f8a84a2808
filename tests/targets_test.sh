# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: targets_test.sh PROGRAM SOURCE FOLDER TARGET. Builds the component patterns for aarch64, windows or wasm in FOLDER/TARGET
# (kept) and runs it with QEMU, Wine or Node.js: same bytes, error lines and exit codes as PROGRAM, without oneTBB and GMP; a clear
# message for verbs of other components. Exit code 77: a tool is missing.
set -u
nook=$1
source=$2
target=$4
build=$3/$4
export LC_ALL=C.UTF-8 WINEDEBUG=-all

# need TOOL PACKAGE
need()
{
	command -v "$1" >/dev/null || [ -x "/usr/lib/wine/$1" ] && return
	echo "skipped: found no $1, expected Debian's package $2 (scripts/setup.sh $target)"
	exit 77
}
case $target in
aarch64)
	need aarch64-linux-gnu-g++ g++-aarch64-linux-gnu
	need qemu-aarch64-static qemu-user-static
	run="qemu-aarch64-static -L /usr/aarch64-linux-gnu"
	program=nook
	;;
windows)
	need x86_64-w64-mingw32-g++-posix g++-mingw-w64-x86-64-posix
	need wine64 wine64
	run=$(command -v wine64 || echo /usr/lib/wine/wine64)
	program=nook.exe
	;;
wasm)
	need emcc emscripten
	need npm npm
	run="node --no-experimental-fetch"
	program=nook.js
	;;
esac
. "$(dirname "$0")/table.sh"
export WINEPREFIX="$folder/wine"

if ! { cmake --preset "$target" -S "$source" -B "$build" &&
	cmake --build "$build"; } >"$folder/log" 2>&1; then
	problem "$target: not built"
	tail -n 40 "$folder/log"
	finish
fi
# there ARGUMENT...: runs the program. Wine now and then ends a program at its start, with exit code 1 and no output. nook never fails
# without a line, so the program is started again, and the end of the test says so.
there()
{
	$run "$build/tools/$program" "$@" 2>"$folder/said"
	answer=$?
	if [ "$target" = windows ] && [ $answer -eq 1 ] && [ ! -s "$folder/said" ]; then
		echo "windows: nook $*: not started by Wine, started again" >>"$folder/again"
		$run "$build/tools/$program" "$@" 2>"$folder/said"
		answer=$?
	fi
	cat "$folder/said" >&2
	return $answer
}
if [ "$target" = windows ]; then
	# One server for all programs: a program that starts while a server shuts down fails now and then.
	server=$(command -v wineserver || echo /usr/lib/wine/wineserver)
	mkdir "$WINEPREFIX"
	"$server" -p
	trap '"$server" -k; "$server" -w; rm -rf "$folder"' EXIT
	there --version >/dev/null 2>&1 # lets Wine create its folder
fi

# Bytes. A part of the catalogue, since emulation is slow: docs/guide/platforms.md covers all of it.
while read -r domain counts; do
	there catalogue --domain "$domain" --counts "$counts" -o "$source/patterns" --check || problem "$target: $domain $counts: other bytes"
done <<-EOT
	disk 3-4
	ball 4-4
	sphere 6-6
	hemisphere 5-5
EOT
while read -r name options; do
	"$nook" $options -o "$folder/here.$name" || problem "$name: not made"
	there $options -o "$folder/there.$name" || problem "$target: $name: not made"
	same "$folder/here.$name" "$folder/there.$name" "$target: $name: expected the bytes of this machine's program"
done <<-EOT
	disk.svg pattern --domain disk --count 7 --starts 1
	fitted.json pattern --domain ball --count 21 --centre --method electro --starts 1 --weights fitted
	equal.csv pattern --domain disk --count 12 --method equal --starts 1
	sphere.json pattern --domain sphere --count 24 --method electro --starts 1 --exponent 1
	hemisphere.hlsl pattern --domain hemisphere --count 5 --starts 1
	tile.json tile --pattern $source/patterns/disk/disk_004.json --size 2 --kind random
	vo.glsl emit --methods vo-line --patterns $source/patterns/disk/disk_009_tile4.json --filter window --glsl es300
	aov.glsl emit --methods aov-mask --glsl 430
	noise.html report noise --max-count 2 --starts 2
EOT

"$nook" info "$source/patterns/ball/ball_012.json" >"$folder/here.info"
there info "$source/patterns/ball/ball_012.json" >"$folder/there.info"
same "$folder/here.info" "$folder/there.info" "$target: nook info: other words"

# Errors: the same line and exit code, no leftovers.
mkdir "$folder/folder.json"
printf '{' >"$folder/broken.json"
cd "$folder" || exit 1
while read -r options; do
	"$nook" $options >/dev/null 2>"$folder/here.err"
	expected=$?
	there $options >/dev/null 2>"$folder/there.err"
	found=$?
	[ $expected -ne 0 ] && [ $found -eq $expected ] || problem "$target: nook $options: exit code $found, expected $expected"
	same "$folder/here.err" "$folder/there.err" "$target: nook $options: expected the line of this machine's program"
done <<-EOT
	pattern --domain cube --count 9 -o a.json
	pattern --domain disk --count 0x9 -o a.json
	pattern --domain sphere --count 9 --exponent nan -o a.json
	pattern --domain disk --count 9 -o a.json -o ./a.json
	pattern --domain disk --count 9 -o none/a.json
	pattern --domain disk --count 9 -o folder.json
	info none.json
	info folder.json
	info broken.json
	catalogue --domain disk --counts 3 -o . --check
	wrong
EOT
[ -z "$(find . -name '*.tmp*')" ] || problem "$target: temporary files are left: $(find . -name '*.tmp*')"

# refuses COMPONENT COMMAND...: exit code 5 and one line that names the component.
refuses()
{
	component=$1
	shift
	there "$@" >"$folder/out" 2>"$folder/err"
	code=$?
	if [ $code -ne 5 ] || [ "$(wc -l <"$folder/err")" -ne 1 ] || ! grep -q "the component $component" "$folder/err"; then
		problem "$target: nook $*: exit code $code and '$(cat "$folder/err")', expected 5 and a line about the component $component"
	fi
}
for verb in gbuffer reference compare level volumes bake "info builtin:cornell"; do
	refuses levels $verb
done
refuses levels tile --pattern "$source/patterns/disk/disk_004.json" --size 2 -o tile.png
refuses shading shade x.exr --method vo-line
for verb in tune "report error"; do
	refuses reports $verb
done

# Names with blanks and non-ASCII letters, overwriting an existing file, twice; no carriage return.
mkdir "Ünï 文 1"
for time in first second; do
	there pattern --domain disk --count 5 -o "Ünï 文 1/ä б.json" -o "Ünï 文 1/ä б.h" || problem "$target: $time: not written"
done
there pattern --domain disk --count 5 -o - >"$folder/out"
same "Ünï 文 1/ä б.json" "$source/patterns/disk/disk_005.json" "$target: a name with blanks"
same "$folder/out" "$source/patterns/disk/disk_005.json" "$target: standard output"
[ "$(ls "Ünï 文 1" | wc -l)" -eq 2 ] || problem "$target: found other files: $(ls "Ünï 文 1")"

# sized FILE NAME: docs/guide/platforms.md states its size to a tenth, since it changes slightly with each commit.
sized()
{
	stated=$(sed -n "s/^| \`$2\`[^|]*| \([0-9.]*\) MB |.*/\1/p" "$source/docs/guide/platforms.md")
	awk -v stated="${stated:-0}" -v bytes="$(wc -c <"$1")" 'BEGIN { exit !(bytes >= 0.9e6 * stated && bytes <= 1.1e6 * stated) }' ||
		problem "docs/guide/platforms.md: $2: found '$stated' MB, expected about the $(wc -c <"$1") bytes of $1"
}

# atMost BYTES FILE
atMost()
{
	[ "$(wc -c <"$2")" -le "$1" ] || problem "$2: $(wc -c <"$2") bytes, expected $1 or fewer"
}
if [ "$target" = windows ]; then
	atMost 6291456 "$build/tools/nook.exe"
	sized "$build/tools/nook.exe" nook.exe
	(cd "$build" && cpack -G ZIP -B "$folder/zip") >"$folder/log" 2>&1 || problem "windows: not packed: $(tail -n 1 "$folder/log")"
	sized "$folder"/zip/nook-*.zip 'nook-0.1.0-windows-x86_64.zip'
	if x86_64-w64-mingw32-objdump -p "$build/tools/nook.exe" | grep -iE 'DLL Name: (lib|.*pthread|.*stdc)'; then
		problem "windows: found these libraries, expected Windows' own alone"
	fi
fi

# The npm package, installed from its file in an empty folder.
if [ "$target" = wasm ]; then
	mkdir "$folder/installed"
	(cd "$build/npm" && npm pack --silent --pack-destination "$folder") >/dev/null || problem "npm: not packed"
	atMost 1048576 "$folder"/nook-patterns-*.tgz
	sized "$folder"/nook-patterns-*.tgz nook-patterns-0.1.0.tgz
	sized "$build/npm/nook.wasm" nook.wasm
	cd "$folder/installed" || exit 1
	echo '{"type": "module"}' >package.json
	npm install --silent --offline --no-audit --no-fund "$folder"/nook-patterns-*.tgz >"$folder/log" 2>&1 || problem "npm: not installed: $(cat "$folder/log")"
	cp -r "$source/npm/test" .
	if ! NOOK_PATTERNS="$source/patterns" node --test test >"$folder/log" 2>&1; then
		problem "npm: its tests"
		grep -E -A12 '^not ok' "$folder/log"
	fi
	if command -v tsc >/dev/null; then
		tsc --strict --noEmit --target es2022 --module nodenext --moduleResolution nodenext test/types.mts || problem "npm: its types"
	else
		echo "npm: its types are not checked: found no tsc, expected Debian's package node-typescript (scripts/setup.sh wasm)"
	fi
	npx --no-install nook-patterns pattern --domain disk --count 5 -o a.json && same a.json "$source/patterns/disk/disk_005.json" "npx: other bytes"
fi
[ ! -e "$folder/again" ] || cat "$folder/again"
finish
