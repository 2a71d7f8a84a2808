# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: live_site_test.sh PROGRAM SOURCE NPM_FOLDER CACHE. The live site: errors of its build, and its page in a browser, as one file,
# as a folder of files and from a server: empty console; patterns identical to the program's, measures identical to nook info's,
# pictures matching nook shade, rays of nook reference in three.js; messages without WebGL 2 or WebAssembly. Exit code 77: no Chromium,
# Node.js, npm package or registry.
set -u
nook=$(realpath "$1")
source=$(realpath "$2")
npm=$(realpath -m "$3")
cache=$(realpath -m "$4")
here=$(cd "$(dirname "$0")" && pwd)
. "$here/table.sh"
. "$here/browser.sh"
. "$here/npm_tools.sh"
for tool in idiff python3; do
	command -v "$tool" >/dev/null || skip "found no $tool, expected Debian's packages openimageio-tools and python3"
done
[ -s "$npm/nook.wasm" ] || skip "found no $npm/nook.wasm, expected the npm package of the preset wasm"
npm_tools "$cache"
modules=$cache/node_modules
cd "$folder"

# live OPTIONS…: with this test's folders.
live()
{
	node "$source/site/build.mjs" --nook "$nook" --npm "$npm" --catalogue "$source/patterns" --modules "$modules" "$@"
}

# refuses CODE PATTERN OPTIONS…: with all other requirements met.
refuses()
{
	code=$1
	pattern=$2
	shift 2
	node "$source/site/build.mjs" --nook "$nook" --modules "$modules" -o refused.html "$@" 2>err
	found=$?
	[ $found = "$code" ] && grep -q -e "$pattern" err && [ "$(wc -l <err)" = 1 ] || problem "$*: exit code $found, '$(cat err)', expected $code and '$pattern'"
	[ ! -e refused.html ] || problem "$*: found a page, expected none"
}

small="builtin:suburb --size 240x135 --rays 16"
mkdir empty other broken
cp "$npm"/* other
cp "$npm"/* broken
sed -i 's/"version": "[^"]*"/"version": "9.9.9"/' other/package.json
head -c 3 "$npm/nook.wasm" >broken/nook.wasm
refuses 2 'npm: found no nook.wasm in empty, expected the npm package' $small --npm empty --catalogue "$source/patterns"
refuses 3 'package.json: version: found 9.9.9, expected' $small --npm other --catalogue "$source/patterns"
refuses 3 'broken/nook.wasm: found 3 bytes, expected WebAssembly' $small --npm broken --catalogue "$source/patterns"
refuses 2 'catalogue: found no disk/disk_009.json in empty' $small --npm "$npm" --catalogue empty
refuses 1 "camera: found 'auto:2', expected" $small --npm "$npm" --catalogue "$source/patterns" --camera auto:2
refuses 1 'camera' $small --npm "$npm" --catalogue "$source/patterns" --camera none
refuses 1 "builtin: found 'none'" builtin:none --npm "$npm" --catalogue "$source/patterns"
refuses 2 'none.glb' none.glb --npm "$npm" --catalogue "$source/patterns"
refuses 2 'modules: found no vite/package.json in empty' $small --npm "$npm" --catalogue "$source/patterns" --modules empty
refuses 1 'docs: found with the page refused.html, expected a folder' $small --npm "$npm" --catalogue "$source/patterns" --docs other
live $small -o other 2>err
[ $? = 2 ] && grep -q 'other: found other files in it, expected an empty folder' err && [ -e other/package.json ] || problem "another's folder: found '$(cat err)'"
live $small -o page.html || { problem "the page: not made"; finish; }
# A disk that is full, as a limit to the size of files: one line, and nothing half written.
(trap "" XFSZ; ulimit -f 4; live $small -o limited.html 2>err)
[ $? = 2 ] && [ "$(wc -l <err)" = 1 ] && [ -z "$(ls | grep limited)" ] || problem "a full disk: found '$(cat err)' and $(ls | grep limited), expected one line"
live $small -o again.html || problem "the page: not made again"
same page.html again.html "the page made again: expected the same bytes"
# A folder, twice in the same place, with documentation, from a server below an address of its own.
mkdir -p docs
echo '<!DOCTYPE html><title>docs</title>' >docs/index.html
for time in first second; do
	live $small -o below/site --docs docs || problem "the site: not made the $time time"
done
[ "$(ls below/site | tr '\n' ' ')" = 'data.js docs index.html site.css site.js ' ] || problem "the site: found $(ls below/site)"

grep -q 'three.js authors' below/site/site.js && grep -q 'meshoptimizer library' page.html || problem "the site: found no licences of three.js and meshoptimizer"

# driven PAGE OPTIONS… <SCRIPT: writes the script's result to ./said.
driven()
{
	page=$1
	shift
	node "$here/page_driver.cjs" "$browser" "$page" "$@" >said 2>faults || problem "$page $*: $(head -n 5 faults)"
}

# The patterns, and every module with every filter, written to ./made.
driven page.html <"$here/live_site_script.js"
node "$here/live_site_files.cjs" made <said || problem "the page: $(head -c 300 said)"
while IFS='|' read -r name words; do
	"$nook" $words -o "$name.json" -o "$name.h" -o "$name.glsl" || problem "$words: not made"
	for ending in json h glsl; do
		same "$name.$ending" "made/$name.$ending" "$words: $ending: expected the program's bytes"
	done
	"$nook" info "$name.json" | sed -n '/^measured:/,$s/^  \([a-z_]*\) *\(.*\)/\1 \2/p' >"$name.info"
	same "$name.info" "made/$name.info" "$words: expected the measures of nook info"
done <made/patterns
[ "$(wc -l <made/patterns)" -ge 5 ] || problem "found $(cat made/patterns), expected five patterns"

# Pictures agree within 1/255 on 99.9 % of the pixels; slices, which count bits of angles, on 99.8 %.
"$nook" gbuffer builtin:suburb --size 240x135 -o g.exr || problem "gbuffer: not made"
# pictured PICTURE OPTIONS…
pictured()
{
	picture=$1
	shift
	(cd made && "$nook" shade ../g.exr "$@" -o "$picture.exr") || problem "shade $*: not drawn"
	case $* in *"--method slices"*) most=0.2 ;; *) most=0.1 ;; esac
	idiff -fail 0.0039216 -failpercent "$most" "made/$picture.tif" "made/$picture.exr" >difference 2>&1
	[ $? -lt 2 ] || problem "shade $*: $(grep -E 'Max|pixels' difference)" # 1: differences within the limit
}
while IFS='|' read -r name words; do
	pictured "$name" $words
done <made/pictures
[ "$(wc -l <made/pictures)" -ge 30 ] || problem "found $(wc -l <made/pictures) pictures, expected one a method, samples and filter"
# Checks that the test itself can fail.
before=$failures
words=$(sed -n '1s/^[^|]*|//p' made/pictures)
pictured "$(sed -n '1s/|.*//p' made/pictures)" $words --max-pixels 4 >missed
[ $failures -gt $before ] || echo "another picture: found no fault, expected one" >>unseen
failures=$before
[ ! -e unseen ] || problem "$(cat unseen)"

# Light and dark, wide and narrow; another view; cancelling; errors of the program.
for width in 400 1400; do
	for scheme in light dark; do
		driven page.html --width $width $([ $scheme = light ] || echo --dark) <<-'EOT'
			while (!document.documentElement.dataset.settled) await new Promise(later => setTimeout(later, 50));
			nookPage.publish();
			return Object.entries(document.documentElement.dataset).map(([name, text]) => `${name}=${text}`).join(' ');
		EOT
		for word in "width=$width" "scheme=$scheme" overflow=false ready=yes settled=yes stageDrawn=1 'patternMade=nook pattern --domain disk --count 16'; do
			grep -q -e "$word" said || problem "$width wide, $scheme: found $(cat said), expected $word"
		done
	done
done

# says PATTERN WHAT
says()
{
	grep -q -e "$1" said || problem "$2: found $(head -c 600 said), expected '$1'"
}
driven page.html <"$here/live_site_use.js"
says '"cancelled":"Cancelled; nothing was kept of it."' 'cancelling'
says '"refused":"--symmetric: ' 'a hemisphere that is symmetric'
says '"after":"nook pattern --domain disk --count 5"' 'a pattern after cancelling'
says '"moved":"another view' 'the level from elsewhere'
says '"covered":true' 'the level from elsewhere: its triangles'
says '"near":true' 'the traced view drawn from the triangles: its depths'
says '"back":"camera main' 'the traced view again'
says '"thick":"nook emit --methods vo-line --patterns disk_3_tile.json' 'the module with another thickness'
says '"yours":"vo-point, yours' 'the pattern from above'
says '"domains":"disk ball sphere hemisphere"' 'the domains that patterns have'
says '"restored":true' 'the picture after cancelling: that of the measures and files'
says '"busy":"Making a tile of your pattern' 'a tile, at once'
says '"idle":true' 'a tile that is made'
says '"kept":"random bilateral"' 'samples and filter over a change of methods'
says '"silent":true' 'rays of the same radius'
says '"warned":"The rays were traced for a radius of' 'rays of another radius'
says 'rays of another radius' 'the RMSE to rays of another radius'
# Commands as printed by the page work.
node -e 'JSON.parse(require("fs").readFileSync("said", "utf8")).commands.forEach((lines, i) => require("fs").writeFileSync(`commands${i}.sh`, lines))' || problem "the page: no commands"
for script in commands*.sh; do
	mkdir ran && (cd ran && PATH="$(dirname "$nook"):$PATH" sh -eu "../$script") >log 2>&1 || problem "$script: $(cat "$script" log)"
	rm -rf ran
done
[ -e commands7.sh ] || problem "found $(ls commands*.sh), expected eight"

# The level in three.js, from a server.
python3 -u -m http.server --bind 127.0.0.1 --directory "$folder" 0 >"$folder/address" 2>&1 &
server=$!
for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
	grep -q 'http://' "$folder/address" || sleep 0.5
done
address=$(grep -o -m 1 'http://[^)]*' "$folder/address")
node "$here/page_driver.cjs" "$browser" "${address}below/site/index.html" --wait 240 <"$here/live_site_level.js" >said 2>faults || problem "the level: $(grep -v 'does not belong to this context' faults | head -n 5)"
node - said <<-'JS' >log 2>&1 || problem "the level: $(head -c 600 log)"
	const said = JSON.parse(require('node:fs').readFileSync(process.argv[2], 'utf8')), wrong = [];
	const expect = (name, holds) => { if (!holds) wrong.push(`${name}: found ${JSON.stringify(said[name])}`); };
	expect('colourful', said.colourful > 0.2);
	expect('off', said.off === true);
	expect('rayed', said.rayed > 20);
	expect('darker', said.darker.every(one => one < -1) && said.lighter === false);
	expect('sides', said.sides.every(one => one <= 1));
	expect('traced', said.traced <= 1);
	expect('errors', said.errors[0] > 0 && said.errors[0] < 0.75 * said.errors[1]);
	expect('high', said.high < said.errors[0]);
	expect('options', String(said.options) === 'pass,true,true,true');
	expect('radius', String(said.radius) === '2,true');
	expect('moved', /camera moved.*Rays were traced for the first view alone/.test(said.moved));
	expect('cameras', said.cameras === 'main unit porch side street');
	expect('places', said.places === true);
	expect('size', String(said.size) === '480,270');
	expect('back', said.back === true);
	expect('restored', said.restored <= 1);
	expect('network', said.network.length === 0);
	if (wrong.length > 0) throw new Error(wrong.join('; '));
JS
echo "return document.querySelector('#links a[href=\"docs/index.html\"]').textContent" |
	node "$here/page_driver.cjs" "$browser" "below/site/index.html" 2>faults | grep -q Documentation || problem "the site as files: $(head -n 5 faults)"
kill $server
wait $server 2>/dev/null

driven page.html --option --disable-3d-apis <<'EOT'
	while (!document.documentElement.dataset.settled || !document.documentElement.dataset.started) await new Promise(later => setTimeout(later, 50));
	return document.getElementById('level').innerText + document.getElementById('three').innerText;
EOT
says 'This browser has no WebGL2' 'without WebGL2'
says 'This browser has no WebGL 2 that draws' 'three.js without WebGL2'
driven page.html --before 'delete globalThis.WebAssembly;' <<'EOT'
	while (!document.documentElement.dataset.stageDrawn) await new Promise(later => setTimeout(later, 50));
	return document.getElementById('pattern').innerText;
EOT
says 'This browser has no WebAssembly' 'without WebAssembly'

finish
