#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Regenerates the pictures of the README and of the guides in docs/pictures/.
# usage: pictures.sh NOOK
set -eu
nook=$1
folder=$(dirname "$0")/../docs/pictures
mkdir -p "$folder"
"$nook" pattern --domain disk --count 9 --symmetric -o "$folder/disk_009_symmetric.svg"
"$nook" pattern --domain disk --count 16 -o "$folder/disk_016.svg"
"$nook" pattern --domain ball --count 33 -o "$folder/ball_033.svg"
"$nook" pattern --domain hemisphere --count 16 -o "$folder/hemisphere_016.svg"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$nook" pattern --domain disk --count 9 -o "$scratch/disk_009.json"
"$nook" tile --pattern "$scratch/disk_009.json" --size 4 -o "$folder/disk_009_tile4.svg"
"$nook" gbuffer builtin:courtyard --camera main --size 640x360 -o "$scratch/g.exr"
"$nook" reference builtin:courtyard --gbuffer "$scratch/g.exr" --radius 1.5 --rays 256 -o "$folder/courtyard_reference.png"
"$(dirname "$0")/methods.sh" "$nook" builtin:courtyard 1 "$scratch/methods.png" --camera main
oiiotool --nosoftwareattrib "$scratch/methods.png" --resize 1086x0 -o "$folder/methods.png"
for level in courtyard suburb; do
	"$(dirname "$0")/worst.sh" "$nook" builtin:$level 1.5 "$folder/worst_$level.png"
done
"$nook" gbuffer builtin:suburb --camera main --size 640x360 -o "$scratch/suburb.exr"
"$nook" volumes builtin:suburb --distance 1.5 --compensate -o "$scratch/suburb.glb" >"$scratch/out"
"$nook" shade "$scratch/suburb.exr" --method aov --volumes "$scratch/suburb.glb" -o "$folder/volumes.png"

# The guides' results, by their own commands.
guide=$(cd "$(dirname "$0")" && pwd)/guide.sh
for page in engine_header level choose_a_method; do
	mkdir "$scratch/$page"
	"$guide" "$nook" "$page" "$scratch/$page" >"$scratch/out"
done
oiiotool --nosoftwareattrib "$scratch/engine_header/visibility.pgm" -o "$folder/guide_engine_header.png"
cp "$scratch/level/darkened.png" "$folder/guide_level.png"
for method in rays vo-line slices statvo aov both; do
	cp "$scratch/choose_a_method/$method.png" "$folder/choose_$method.png"
done

# The page of error against time in a browser.
"$nook" report error builtin:courtyard --quick -o "$scratch/error.html"
for browser in chromium chromium-browser google-chrome; do
	if command -v $browser >"$scratch/out"; then
		$browser --headless --no-sandbox --disable-gpu --user-data-dir="$scratch/profile" --virtual-time-budget=20000 --hide-scrollbars \
			--window-size=1000,1290 --screenshot="$folder/error_page.png" "file://$scratch/error.html" 2>"$scratch/log"
		break
	fi
done

# The live site, if the npm package is built and scripts/site.sh has installed Vite: its first two parts.
root=$(cd "$(dirname "$0")/.." && pwd)
if [ -s "$root/build/wasm/npm/nook.wasm" ] && [ -e "$root/build/site_modules/installed" ] && command -v "$browser" >"$scratch/out" && command -v node >"$scratch/out"; then
	node "$root/site/build.mjs" --nook "$nook" -o "$scratch/live.html"
	echo 'const drawn = document.documentElement.dataset; while (!drawn.settled || !drawn.started) await new Promise(later => setTimeout(later, 100));' |
		node "$root/tests/page_driver.cjs" "$browser" "$scratch/live.html" --width 1000 --tall 2000 --screenshot "$scratch/live.png" >"$scratch/out"
	oiiotool "$scratch/live.png" --resize 640x0 -o "$folder/live_page.png"
fi
