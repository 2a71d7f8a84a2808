# SPDX-License-Identifier: GPL-3.0-or-later
# nook tune on the command line: the files of its pick are those of the commands that it lists; and its errors.
# usage: tune_cli_test.sh NOOK
set -u
nook=$1
runtime=$(cd "$(dirname "$0")/../libsamples/volume/runtime" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
. "$here/command_line.sh"
. "$here/browser.sh"

small="--size 64x36 --views 2 --rays 16 --repetitions 1 --threads 2"

# ends CODE 'REGEX' ARGUMENTS: checks the exit code and the line on stderr, ignoring other output.
ends()
{
	code=$1
	regex=$2
	shift 2
	"$nook" "$@" >../stdout 2>../stderr </dev/null
	found=$?
	[ "$found" -eq "$code" ] || problem "nook $*: exit code $found, expected $code: $(cat ../stderr)"
	[ "$(wc -l <../stderr)" -eq 1 ] && grep -Eq -e "^nook: $regex" ../stderr || problem "nook $*: found '$(cat ../stderr)', expected '$regex'"
}

# again FOLDER: running its commands in another folder makes the same files, except the page and nook's own headers.
again()
{
	mkdir kept_again
	sed -n '/"commands": \[/,/\]/p' "$1/tune.html" | sed -n 's/^\t*"\(nook .*\)",\{0,1\}$/\1/p' |
		sed -e 's/\\u003c/</g' -e 's/\\"/"/g' -e 's/\\\\/\\/g' >kept_commands
	[ -s kept_commands ] || problem "$1/tune.html: found no command that makes its files again"
	(cd kept_again && sed "s#^nook #\"$nook\" #" ../kept_commands | sh -e >log 2>&1) || problem "commands: $(cat kept_commands kept_again/log)"
	compared=0
	for file in "$1"/*; do
		name=${file#"$1"/}
		case $name in
		tune.html) continue ;;
		nook_volumes.h | nook_volumes_draw.h) other=$runtime/$name ;;
		*) other=kept_again/$name ;;
		esac
		compared=$((compared + 1))
		cmp -s "$file" "$other" || problem "$name: other bytes than $(cat kept_commands)"
	done
	[ "$compared" -gt 0 ] || problem "$1: found no file but the page"
	rm -rf kept_again
}

# compiles FILE ENDING DEFINES...: as in an engine's shader.
compiles()
{
	command -v glslangValidator >/dev/null || return
	file=$1
	ending=$2
	shift 2
	{ echo "#version 330 core"; for define in "$@"; do echo "#define $define"; done; cat "$file"; } >"kept_shader.$ending"
	grep -q 'void main()' "$file" || echo 'out float visibility; void main() { visibility = nookDepth(ivec2(gl_FragCoord.xy)); }' >>"kept_shader.$ending"
	glslangValidator "kept_shader.$ending" >kept_log || problem "$file: $(cat kept_log)"
}

# A screen-space pick.
works "pick: vo-area" tune builtin:cornell --budget 10s --methods vo-area --grid quick $small -o kept_out --json kept_tune.json
for file in nook_ao.glsl nook_ao.h pattern.json tile.json tune.html; do
	[ -s "kept_out/$file" ] || problem "kept_out/$file is missing"
done
grep -q '"schema": "nook.tune/1"' kept_tune.json || problem "no schema"
grep -q '"left_out"' kept_tune.json || problem "nothing about what was left out"
! grep -q '@[A-Z]*@' kept_out/tune.html || problem "the page has slots that nothing filled"
! grep -v "^const NS = 'http://www.w3.org/2000/svg';$" kept_out/tune.html | grep -q 'https\?://' || problem "the page asks the network"
again kept_out
compiles kept_out/nook_ao.glsl frag

# The page in a browser, if available: empty console, and every candidate, row, file and command of its data. drawn PAGE JSON
drawn()
{
	browsed "$1" --window-size=1400,1200
	sed '/<script/,/<\/script>/d' "$folder/dom" >kept_dom
	quiet "$1"
	points=$(sed -n '/^\t"candidates": \[/,/^\t\]/s/^\t\t\t"time_ms": /&/p' "$2" | wc -l)
	[ "$points" -gt 0 ] || problem "$2: found no candidate that was measured"
	grep -q "data-points=\"$points\"" kept_dom || problem "$1: found other points than $points: $(grep -o '<html[^>]*>' kept_dom)"
	for text in 'data-ready="yes"' 'data-charts="1"' 'data-overflow="false"' 'Take <em>vo-area' 'Next is \|No other candidate\|The least error has' 'class="mark ours chosen"' \
		'>pick</td>' '>nook_ao.h</td>' 'nook emit --methods vo-area' 'measuring took' 'not searched'; do
		grep -q -e "$text" kept_dom || problem "$1: found no '$text' in what it draws"
	done
}

if [ -n "$browser" ]; then
	drawn kept_out/tune.html kept_tune.json
	# Checks that the test itself can fail.
	before=$failures
	sed 's/^function drawScatter/function drawScater/' kept_out/tune.html >kept_broken.html
	drawn kept_broken.html kept_tune.json >kept_faults
	failures=$before
	[ -s kept_faults ] || problem "a page whose script is broken: found no fault, expected one"
fi

# StatVO, which takes no pattern.
works 'pick: statvo' tune builtin:cornell --max-error 10 --methods statvo --grid quick $small -o kept_statvo
[ -s kept_statvo/nook_ao.glsl ] && [ ! -e kept_statvo/tile.json ] || problem "statvo: found $(ls kept_statvo)"
again kept_statvo

# Volumes for two levels, one with a name that a shell would split.
"$nook" level builtin:cornell -o "kept a level.glb"
works 'pick: aov' tune builtin:cornell "kept a level.glb" --max-error 10 --methods aov --grid quick $small --radius 0.4 -o kept_volumes
for file in nook_aov.glsl nook_volumes.h nook_volumes_draw.h tune.html; do
	[ -s "kept_volumes/$file" ] || problem "kept_volumes/$file is missing"
done
[ "$(ls kept_volumes/*.volumes.glb | wc -l)" -eq 2 ] || problem "volumes: found $(ls kept_volumes)"
compiles kept_volumes/nook_aov.glsl vert NOOK_VERTEX
compiles kept_volumes/nook_aov.glsl frag NOOK_FRAGMENT
sed -i 's#kept a level.glb#../kept a level.glb#' kept_volumes/tune.html # again() runs them in a folder below
again kept_volumes

# A bake: no extra time, its bytes in lines, JSON and page, and the level with values at its vertices; for two levels.
works 'pick: bake' tune builtin:cornell "kept a level.glb" --budget 10s --methods bake --grid quick $small --radius 0.4 -o kept_bakes \
	--json kept_bakes.json
[ "$(ls kept_bakes/*.baked.glb | wc -l)" -eq 2 ] || problem "bakes: found $(ls kept_bakes)"
for file in kept_bakes/*.baked.glb; do
	grep -aq '_VISIBILITY' "$file" || problem "$file: found no visibility at its vertices"
done
bytes=$(sed -n '/^\t"pick": {/,/^\t}/s/^\t\t"bytes": \([0-9]*\),\{0,1\}$/\1/p' kept_bakes.json)
[ "${bytes:-0}" -gt 0 ] || problem "kept_bakes.json: found '$bytes' bytes of the pick, expected some"
sed -i 's#kept a level.glb#../kept a level.glb#' kept_bakes/tune.html
again kept_bakes
if [ -n "$browser" ]; then
	browsed kept_bakes/tune.html --window-size=1400,1200
	sed '/<script/,/<\/script>/d' "$folder/dom" >kept_dom
	quiet kept_bakes/tune.html
	for text in 'data-ready="yes"' 'data-charts="2"' 'data-overflow="false"' 'Take <em>bake' 'Bytes against error' '>none</td>' 'baked.glb</td>'; do
		grep -q -e "$text" kept_dom || problem "kept_bakes/tune.html: found no '$text' in what it draws"
	done
fi
# A limit on bytes: assets that exceed it are left out with a message; methods without assets are not.
works '2 candidates are not in these figures; the first is bake: bytes: found .* kB, expected at most 0.008 kB' tune builtin:cornell --budget 10s \
	--methods bake,statvo --grid quick $small --max-bytes 8 --json kept_few.json
grep -q '"max_bytes": 8' kept_few.json || problem "kept_few.json: found no bound of bytes"
works 'pick: bake: 0 ms, rmse [0-9.]*, [0-9.]* kB a level' tune builtin:cornell --max-error 10 --methods bake,aov --grid quick $small \
	--max-bytes 1MiB -o kept_enough

# Measurements are reused: the same times, and the same files.
for run in first second; do
	"$nook" tune builtin:cornell --budget 10s --methods statvo --grid quick $small --cache kept_cache -o kept_$run >../stdout 2>../stderr ||
		problem "--cache: $(cat ../stderr)"
done
grep -q '^nook: 0 results made, [1-9][0-9]* from the cache$' ../stderr || problem "--cache: found '$(cat ../stderr)', expected nothing measured"
cmp kept_first/nook_ao.glsl kept_second/nook_ao.glsl || problem "--cache: other files than before"

# A target language without masks: none are searched, regardless of the budget, and volumes are drawn by sums.
works 'pick: ' tune builtin:cornell --budget 10s --grid quick $small --glsl es300 -o kept_es
grep -q 'they are drawn by' kept_es/tune.html || problem "the page does not say why there are no masks"
[ -s kept_es/nook_aov.glsl ] && grep -q 'precision highp' kept_es/nook_aov.glsl || problem "es300: found $(ls kept_es)"
again kept_es

# File names that are not UTF-8 are written with a replacement character.
odd=$(printf 'kept_\377.glb')
cp "kept a level.glb" "$odd"
works 'pick: statvo' tune "$odd" --budget 10s --methods statvo --grid quick $small --json kept_odd.json
[ -s kept_odd.json ] || problem "nothing of a level whose name is no UTF-8"

# One of two levels cannot be read: the other one continues, and the page reports it.
echo "no level" >kept_bad.obj
ends 4 'kept_bad.obj: found a level that cannot be measured' tune builtin:cornell kept_bad.obj --budget 10s --methods statvo --grid quick $small \
	-o kept_part
grep -q 'kept_bad.obj is not in these figures' kept_part/tune.html || problem "the page does not say which level is missing"
[ -s kept_part/nook_ao.glsl ] || problem "the other level brought nothing"

# Nothing reaches the goal: page and files are those of the closest candidate.
ends 4 '--budget 0.001us: found nothing that reaches it, .*the nearest is statvo' tune builtin:cornell --budget 0.001us --methods statvo --grid quick \
	$small -o kept_nearest --json kept_nearest.json
for file in nook_ao.glsl nook_ao.h tune.html; do
	[ -s "kept_nearest/$file" ] || problem "kept_nearest/$file is missing"
done
again kept_nearest
grep -q '"pick": null' kept_nearest.json && grep -q '"nearest": {' kept_nearest.json || problem "no nearest candidate in its figures"
if [ -n "$browser" ]; then
	browsed kept_nearest/tune.html --window-size=1400,1200
	sed '/<script/,/<\/script>/d' "$folder/dom" >kept_dom
	quiet kept_nearest/tune.html
	for text in 'data-ready="yes"' 'Nothing reaches --budget 0.001us' '; the nearest is statvo' '>nearest</td>' '>nook_ao.h</td>'; do
		grep -q -e "$text" kept_dom || problem "kept_nearest/tune.html: found no '$text' in what it draws"
	done
fi
ends 4 '--max-error 1e-09: found nothing that reaches it' tune builtin:cornell --max-error 1e-9 --methods statvo --grid quick $small
# No output replaces a level; a folder may end with a slash.
cp "kept a level.glb" kept_level.glb
fails 1 'kept_level.glb: named twice' tune kept_level.glb --budget 10s --methods statvo --grid quick $small --json kept_level.glb
cmp -s "kept a level.glb" kept_level.glb || problem "kept_level.glb: found other bytes, expected the level"
works "pick: statvo" tune "kept a level.glb" --unit 2 --budget 10s --methods statvo --grid quick $small -o kept_slash/
grep -q "nook tune 'kept a level.glb'.* --unit 2" kept_slash/tune.html ||
	problem "the page: found no command that makes the search again: $(grep 'nook tune' kept_slash/tune.html)"
fails 1 'kept_slash/tune.html: named twice' tune builtin:cornell --budget 10s --methods statvo -o kept_slash --json kept_slash/tune.html
fails 1 '--budget, --max-error: found neither' tune builtin:cornell
fails 1 '--budget, --max-error: found both' tune builtin:cornell --budget 1ms --max-error 0.1
fails 1 "--budget: found '1'" tune builtin:cornell --budget 1
fails 1 "--budget: found '-1ms'" tune builtin:cornell --budget=-1ms
fails 1 "--budget: found 'nans'" tune builtin:cornell --budget nans
fails 1 "--methods: found 'hbao'" tune builtin:cornell --budget 1ms --methods hbao
fails 1 '--glsl: found es300 with aov-mask, expected 330, 430 or vulkan' tune builtin:cornell --budget 1ms --methods aov-mask --glsl es300 -o kept_none
fails 1 "--max-bytes: found '0'" tune builtin:cornell --budget 1ms --max-bytes 0
fails 1 "--max-bytes: found '1MB'" tune builtin:cornell --budget 1ms --max-bytes 1MB
fails 1 '--depth: found without -o' tune builtin:cornell --budget 1ms --depth device
fails 1 '--max-error' tune builtin:cornell --max-error 0
fails 2 'no_such_folder' tune builtin:cornell --budget 1ms -o no_such_folder/out
fails 2 'no_such.glb' tune no_such.glb --budget 1ms
there


finish
