# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: web_example_test.sh PROGRAM SOURCE. examples/web, set up as in its README, in headless Chromium: empty console, and
# visibility equal to that of nook shade on the CPU and in OpenGL within 1/255 on 99.9 % of the pixels. nook shade gets the page's
# own linear depths, with the module's error bounds, as floats. (From the depth texture nook would assume four times that error,
# since it cannot know how a file was rounded.) Exit code 77: no Chromium, Node.js or npm, or no registry to download three.js from.
set -u
nook=$(realpath "$1")
source=$(realpath "$2")
here=$(cd "$(dirname "$0")" && pwd)
. "$here/table.sh"
. "$here/browser.sh"
for tool in "$browser" node npm idiff oiiotool; do
	command -v "$tool" >/dev/null || { echo "skipped: found no ${tool:-chromium}, expected Debian's packages chromium, nodejs, npm and openimageio-tools"; exit 77; }
done
cp -r "$source/examples/web" "$folder/page" && cd "$folder/page" || exit 1
rm -rf node_modules made && mkdir made
npm install --no-audit --no-fund >../log 2>&1 ||
	{ echo "skipped: found no three.js, expected npm install to get it: $(grep -m 1 'npm error' ../log)"; exit 77; }
checks=$((checks + 1))
PATH="$(dirname "$nook"):$PATH" npm run emit >../log 2>&1 || problem "npm run emit: $(tail -n 5 ../log)"
node serve.js 0 >../address 2>../log &
server=$!
trap 'kill $server; rm -rf "$folder"' EXIT
for _ in 1 2 3 4 5 6 7 8 9 10; do
	[ -s ../address ] || sleep 0.5
done
checks=$((checks + 1))
node "$here/page_driver.cjs" "$browser" "$(cat ../address)" --width 900 --height 500 --screenshot ../page.png \
	<"$here/web_example_script.js" >../said 2>../faults || problem "the page: $(head -n 5 ../faults)"
[ -z "${NOOK_KEEP:-}" ] || cp ../page.png "$NOOK_KEEP"

cd "$folder"
node "$here/live_site_files.cjs" read <said || problem "the page: $(head -c 300 said)"
projection=$(node -e 'console.log(JSON.parse(require("fs").readFileSync("said", "utf8")).projection.join(" "))')
oiiotool read/v0.tif read/v1.tif --chappend --chnames Z,depth_error -o depth.exr || problem "depth: not read"
# pictured WHAT OPTIONS…
pictured()
{
	checks=$((checks + 1))
	what=$1
	shift
	"$nook" shade depth.exr --sky-depth 1e29 --projection "$projection" --world-to-camera identity --normals from-depth \
		--method vo-line --pattern page/made/tile.json --filter window --radius 1.5 "$@" -o shade.exr || problem "$what: not drawn"
	idiff -fail 0.0039216 -failpercent 0.1 read/v2.tif shade.exr >difference 2>&1
	[ $? -lt 2 ] || problem "$what: $(grep -E 'Max|pixels' difference)"
}
pictured "on the CPU"
grep -E 'pixels' difference
pictured "in OpenGL" --device gl
# Checks that the test itself can fail.
before=$failures
pictured "another radius" --max-pixels 8 >missed
[ $failures -gt $before ] && failures=$before || problem "another radius: found no fault, expected one"
checks=$((checks + 1))
"$nook" compare read/v2.tif shade.exr --metric mae --max-error 0.2 >/dev/null 2>&1 || problem "visibility: found a picture of something else"
finish
