# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: error_page_test.sh PROGRAM. nook report error: its exit codes, its cache, and its page in a browser: nothing in its console,
# everything drawn that its figures ask for, light and dark, wide and narrow. Exit code 77: no Chromium here.
set -u
nook=$1
claims=$(cd "$(dirname "$0")/../scripts" && pwd)/claims.py
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/browser.sh"
cd "$folder"

cat >corner.obj <<EOT
v -2 0 -2
v 2 0 -2
v 2 0 2
v -2 0 2
v -2 3 -2
v 2 3 -2
v -0.5 0 -0.5
v 0.5 0 -0.5
v 0 1 -0.5
f 4 3 2
f 4 2 1
f 1 2 6
f 1 6 5
f 7 8 9
f 9 8 7
EOT
small="--grid quick --size 32x18 --rays 32 --repetitions 1 --shifts 2 --device cpu --threads 2 --cache cache"

# exits CODE PATTERN COMMAND…: that exit code and a line on stderr with the pattern
exits()
{
	code=$1
	pattern=$2
	shift 2
	"$@" 2>err >out
	found=$?
	[ $found = "$code" ] || problem "$*: exit code $found, expected $code: $(head -n 2 err)"
	[ -z "$pattern" ] || grep -q "$pattern" err || problem "$*: '$(cat err)', expected '$pattern'"
}

exits 0 '^nook: [1-9][0-9]* results made, [0-9]* from the cache$' "$nook" report error corner.obj $small -o page.html --json report.json
exits 0 '' "$nook" report error corner.obj $small -o again.html --json again.json --baseline report.json
cmp -s report.json again.json || problem "the cache: found another report, expected the same bytes"
sed 's/"eq14": [0-9.e-]*/"eq14": 0.0001/' report.json >better.json
exits 7 'errors that have grown' "$nook" report error corner.obj $small -o again.html --baseline better.json
sed 's/"camera": "/"camera": "another /' report.json >elsewhere.json
exits 3 'found nothing in elsewhere.json' "$nook" report error corner.obj $small -o again.html --baseline elsewhere.json
exits 1 "methods: found 'sums', expected some of" "$nook" report error corner.obj --methods statvo,sums
exits 0 '' "$nook" report error corner.obj $small --methods statvo,rays --json some.json
grep -q '"command": "nook report error corner.obj .*--methods statvo,rays' some.json && ! grep -q '"method": "alchemy"' some.json ||
	problem "report error --methods: found $(head -c 400 some.json), expected statvo and rays alone"
exits 1 'shifts: found .1., expected 0' "$nook" report error corner.obj --shifts 1
exits 4 '1 of 2 levels that failed' "$nook" report error none.obj corner.obj $small -o failed.html
exits 4 '1 of 2 levels that failed.*errors that have grown' "$nook" report error none.obj corner.obj $small -o again.html --baseline better.json
cp corner.obj kept.obj
exits 1 'corner.obj: named twice' "$nook" report error corner.obj $small --json corner.obj
cmp -s corner.obj kept.obj || problem "corner.obj: found other bytes, expected a level that no output replaces"
[ -s failed.html ] || problem "a level that fails: found no page, expected one of the others"
exits 2 'cannot be written' "$nook" report error corner.obj $small -o none/page.html
echo '{"schema": "other"}' >wrong.json
exits 3 'schema' "$nook" report error --join wrong.json -o joined.html
exits 1 'LEVEL' "$nook" report error -o page2.html
exits 1 'join' "$nook" report error --join report.json --quick -o joined.html
sed 's/"renderer": "CPU"/"renderer": "another"/' report.json >other.json
exits 0 '' "$nook" report error --join report.json other.json -o joined.html

# The papers' claims, from the report's JSON.
if command -v python3 >/dev/null; then
	exits 0 '' python3 "$claims" report.json
	for text in 'lines beat points' 'five lines' 'every screen-space method' 'hundreds of rays'; do
		grep -q "$text" out || problem "claims.py: found no '$text'"
	done
	exits 1 "schema: found other" python3 "$claims" wrong.json
	sed 's/"low_ms": [0-9.e-]*/"low_ms": 1e-9/' report.json >instant.json # no times to interpolate between
	exits 0 '' python3 "$claims" instant.json
	grep -q 'no count of points takes as long' out || problem "claims.py: found '$(cat out)', expected no equal times"
fi

# A disk that is full, as a limit to the size of files: one line, and nothing half written.
exits 2 'cannot be written' sh -c 'trap "" XFSZ; ulimit -f 4; exec "$@"' sh "$nook" report error corner.obj --grid quick --size 32x18 --rays 32 \
	--device cpu --cache fresh -o limited.html
[ "$(wc -l <err)" = 1 ] || problem "a full disk: found '$(cat err)', expected one line"
[ ! -e limited.html ] && [ -z "$(find fresh -name '*.tmp*' 2>/dev/null)" ] || problem "a full disk: found $(find fresh limited.html), expected nothing half written"

if [ -z "$browser" ]; then
	[ "$failures" = 0 ] && exit 77
	finish
fi

# Items to draw, counted from the JSON: points with a time and an error, and those of the front; and again by bytes.
points=$(($(grep -c '"origin": ' report.json) - $(grep -A3 '"time": {' report.json | grep -cE '"ms": 0(\.0)?,$'))) # a bake takes none
sized=$(grep -c '"bytes": [1-9]' report.json)
fronts=$(grep -cE '"front(_bytes)?": true' report.json)
for name in points sized fronts; do
	eval "[ \"\${$name:-0}\" -gt 0 ]" || problem "the figures: no $name to expect"
done

# drawn FILE REPORTS FAILURES WIDTH SCHEME OPTIONS…
drawn()
{
	where="$1, $4 wide, $5"
	file=$1
	reports=$2
	failed=$3
	width=$4
	scheme=$5
	shift 5
	opened "$file" "$width" "$@"
	quiet "$where"
	is ready yes "$where"
	is width "$width" "$where"
	is scheme "$scheme" "$where"
	is overflow false "$where"
	is reports "$reports" "$where"
	is failures "$failed" "$where"
	is charts $((2 * reports)) "$where"
	is points $(((points + sized) * reports)) "$where"
	is fronts $((fronts * reports)) "$where"
	is pictures 2 "$where"
}

for width in 400 1400; do
	drawn page.html 1 0 $width light --blink-settings=preferredColorScheme=1
	drawn page.html 1 0 $width dark --blink-settings=preferredColorScheme=0
done
drawn joined.html 2 0 1400 light --blink-settings=preferredColorScheme=1
drawn failed.html 1 1 1400 light --blink-settings=preferredColorScheme=1

# The check itself must be able to fail: a page whose script is broken, and one that draws a method too few.
before=$failures
sed 's/^function drawScatter/function drawScater/' page.html >broken.html
sed 's/^drawHead();/drawHead(); state.shown.delete("hbao");/' page.html >fewer.html
for page in broken.html fewer.html; do
	drawn $page 1 0 1400 light --blink-settings=preferredColorScheme=1 >faults
	[ -s faults ] || echo "FAILED: $page: found no fault, expected one" >>missed
done
failures=$before
[ -e missed ] && problem "$(cat missed)"

finish
