# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: npm_ao_test.sh PROGRAM SOURCE CACHE. Packs nook-ao, checks its size and its metadata, installs it in an empty project, and
# draws with Vite's build in headless Chromium: visibility equal to that of nook shade, every option, every kind of camera, both
# composers, a lost context, and what the package refuses. Exit code 77: no Chromium, Node.js or npm, or no registry.
set -u
nook=$(realpath "$1")
source=$(realpath "$2")
cache=$(realpath -m "$3")
here=$(cd "$(dirname "$0")" && pwd)
. "$here/table.sh"
. "$here/browser.sh"
. "$here/npm_tools.sh"

for tool in idiff oiiotool; do
	command -v "$tool" >/dev/null || skip "found no $tool, expected Debian's package openimageio-tools"
done
npm_tools "$cache"
sh "$source/npm/ao/pack.sh" "$nook" "$folder/nook-ao" >"$folder/log" 2>&1 || problem "pack.sh: $(tail -n 5 "$folder/log")"
linted "$folder/nook-ao" --profile esm-only
application "$source/tests/npm_ao" "$folder/nook-ao"
[ "$(wc -c <"$tarball")" -le 40000 ] || problem "the package: found $(wc -c <"$tarball") bytes, expected at most 40000"
mkdir public && "$nook" bake builtin:cornell --radius 1 --rays 16 -o public/baked.glb >"$folder/log" || problem "nook bake: failed"
"$nook" volumes builtin:cornell --distance 0.4 -o public/volumes.glb >"$folder/log" || problem "nook volumes: failed"
"$nook" volumes builtin:cornell --distance 0.4 --compress -o public/packed.glb >"$folder/log" || problem "nook volumes: failed"
node packed.mjs public "$nook" >"$folder/log" 2>&1 || problem "packed volumes: $(tail -n 5 "$folder/log")"
"$tools/vite" build --outDir "$folder/vite" --logLevel error >"$folder/log" 2>&1 || problem "vite build: $(tail -n 5 "$folder/log")"
# A bundle holds only what it uses: of the passes nothing, with bakes alone.
for name in useBakedVisibility NookPass; do
	echo "import { $name } from 'nook-ao'; globalThis.used = $name;" >"$name.mjs"
	"$tools/esbuild" "$name.mjs" --bundle --minify --format=esm --external:three --external:'three/*' >"$folder/$name.js" 2>"$folder/log" || problem "esbuild: $(cat "$folder/log")"
done
[ $(($(wc -c <"$folder/useBakedVisibility.js") * 20)) -lt "$(wc -c <"$folder/NookPass.js")" ] ||
	problem "bundles: found $(wc -c "$folder"/[uN]*.js), expected that of useBakedVisibility to be a twentieth of the other's"
page_said "the page" "$tools/vite" preview --outDir "$folder/vite" --port 0
# After a lost context three.js deletes objects of the old one, which Chromium reports.
grep -v 'object does not belong to this context' "$folder/faults" >"$folder/log" && problem "the page: $(head -n 5 "$folder/log")"
cd "$folder" || exit 1
node - said <<-'JS' >log 2>&1 || problem "the page: $(head -c 600 log)"
	const { differences, refused } = JSON.parse(require('node:fs').readFileSync(process.argv[2], 'utf8'));
	const { deepStrictEqual } = require('node:assert');
	// The largest difference of each comparison, or its value.
	const bounds = { infinite: 1e-3, logarithmicDepthBuffer: 2e-3, reversedDepthBuffer: 2e-3, reversedHalf: 0.03, orthographic: 4e-3, half: 0.03,
		normals: 0.01, smooth: 1, castingNormals: 0, card: 0.05, points: 0, temporal: [1e-6, 0.2], multisampled: 0.06, intensity: 2e-3, tint: 0, product: 1e-3, view: 0, split: [0, 0], afterRender: 0,
		twice: 1e-3, postprocessing: 0, postTwice: 1e-3, postScene: 0, postMultisampled: 0, postResized: 0, postLayers: 0, postTransparent: 0, postRestored: 0, transparent: 0, over: 1e-3, layers: 0, casting: 0, bakedOnly: 1e-3, resized: 0, changed: 0, restoredContext: 0,
		tinted: 0, lower: 2e-3, volumesReversed: 3e-3, volumesPacked: 1e-5 };
	const rest = { sky: 1, restored: [9, true, 0x8080ff], meshes: 1, level: true, kept: true, noVolumes: null, nothing: null, memory: 0,
		disposed: 'Error: NookPass: found render after dispose, expected a new pass',
		postDisposed: 'Error: NookPass: found render after dispose, expected a new pass',
		volumesDisposed: 'Error: NookVolumes: found render after dispose, expected a new one' };
	const found = { ...differences }, wrong = [];
	for (const [name, bound] of Object.entries(bounds)) {
		if (![found[name]].flat().every((one, i) => one >= 0 && one <= [bound].flat()[i])) wrong.push(`${name}: found ${found[name]}, expected at most ${bound}`);
		delete found[name];
	}
	if (!(found.included > 0.05)) wrong.push(`included: found ${found.included}, expected a transparent object to occlude`);
	if (!(found.covered > 0.1)) wrong.push(`covered: found ${found.covered}, expected the transparent object on a tenth of the picture`);
	if (!(found.baked < 0.2)) wrong.push(`baked: found ${found.baked}, expected the ball to be dark`);
	if (!(found.facets > 1.5)) wrong.push(`facets: found ${found.facets} degrees, expected normals from depth to be off the ball's by more`);
	if (!(found.mapped > 0.03)) wrong.push(`mapped: found ${found.mapped}, expected the normal map on the card`);
	if (!(found.volumesDarken[0] === 0 && found.volumesDarken[1] > 0.003)) wrong.push(`volumesDarken: found ${found.volumesDarken}, expected a darker picture`);
	for (const name of ['volumesDarken', 'included', 'covered', 'baked', 'facets', 'mapped']) delete found[name];
	if (wrong.length > 0) throw new Error(wrong.join('; '));
	deepStrictEqual(found, rest);
	deepStrictEqual(refused, [
		'RangeError: volumes: found another length than the file says',
		"RangeError: NookPass: volumes: found 'volumes.glb', expected a NookVolumes or null",
		'RangeError: NookPass: radius: found -1, expected a number above 0',
		"RangeError: NookPass: quality: found 'ultra', expected 'low', 'medium', 'high'",
		'TypeError: NookPass: found the option radious, expected radius, quality, intensity, halfResolution, temporal, sky, view, tint, excludeTransparent, ' +
			'excludeLayers, volumes, normals, baked, renderScene, samples',
		'RangeError: NookPass: excludeLayers: found 3, expected an array of layers, 0 to 31',
		'RangeError: NookAO: found a size of NaN x 108, expected two numbers',
		'RangeError: NookPass: intensity: found NaN, expected a number above 0',
		'RangeError: NookAO: camera: projection: found infinity or NaN, expected 16 finite numbers',
		'Error: NookPass: found no EXT_color_buffer_float, expected it to draw linear depth',
		'Error: NookAO: found no WebGL 2, expected it',
		'Error: NookAO: found a WebGPURenderer, expected a WebGLRenderer; nook-ao/webgpu is for the other',
	]);
JS

# WebGPU, with Chromium's SwiftShader: the pictures of WebGL 2, up to normals of a few pixels at edges, where depths of the two fit
# neighbours on both sides equally well.
cp said webgl_said
(
	cd "$folder/app" || exit 1
	page_path=webgpu.html
	page_options='--option --enable-unsafe-webgpu --option --use-webgpu-adapter=swiftshader'
	page_said "the page of WebGPU" "$tools/vite" preview --outDir "$folder/vite" --port 0
)
grep -v -e CONTEXT_LOST_WEBGL -e 'Instance dropped in popErrorScope' -e 'external Instance reference no longer exists' faults >log && problem "the page of WebGPU: $(head -n 5 log)"
node - said <<-'JS' >log 2>&1 || problem "WebGPU: $(head -c 600 log)"
	const { refused, texts, webgpu, shadowed, ...differences } = JSON.parse(require('node:fs').readFileSync(process.argv[2], 'utf8'));
	const { deepStrictEqual } = require('node:assert');
	// The greatest difference, and the share of pixels beyond 2/255.
	const most = [2 / 255, 0], half = [0.02, 0.001], exact = [1e-3, 0];
	const bounds = { low: most, medium: most, high: most, lowHalf: half, mediumHalf: half, highHalf: half, colours: most, tint: most, radius: most, sky: most,
		orthographic: exact, reversed: most, changed: exact, resized: exact, empty: exact, filled: exact, started: exact, both: exact, infinite: most, transparent: most,
		off: exact, split: most, visibility: most, normals: [0.2, 5e-4], depth: exact, layers: most, temporal: most, moved: half, volumes: [0.02, 5e-4], volumesReversed: [0.2, 0.01] };
	const differ = ['darkened', 'half', 'included', 'averaged', 'screen'];
	const found = name => differences[name] ?? [NaN, NaN];
	const wrong = Object.entries(bounds).filter(([name, bound]) => !found(name).every((one, i) => one <= bound[i])).map(([name, bound]) => `${name}: found ${found(name)}, expected at most ${bound}`);
	for (const name of differ) if (!(found(name)[0] > 0.05 && found(name)[1] > 0.02)) wrong.push(`${name}: found ${found(name)}, expected other pictures`);
	if (wrong.length > 0) throw new Error(wrong.join('; '));
	deepStrictEqual(Object.keys(differences).sort(), [...Object.keys(bounds), ...differ].sort());
	if (!webgpu || !(shadowed < 0.97)) throw new Error(`found WebGPU ${webgpu} and a mean visibility of ${shadowed}, expected a picture with shadows`);
	// The browser's reason follows: the device was destroyed, or its instance is gone.
	deepStrictEqual(texts.map(text => text.replace(/stays: .+\.$/, 'stays')), ['nookPass: the device is lost, and the last picture stays']);
	deepStrictEqual(refused, [
		'RangeError: nookPass: volumes: found [object Object], expected a NookVolumes or null',
		'RangeError: nookPass: radius: found 0, expected a number above 0',
		'TypeError: nookPass: found the option samples, expected radius, quality, intensity, halfResolution, temporal, sky, view, tint, excludeTransparent, excludeLayers, volumes',
		'Error: nookPass: found a renderer without WebGPU, expected WebGPU; NookPass of nook-ao is for WebGL 2',
		'Error: nookPass: found logarithmicDepthBuffer, expected a linear or reversed depth buffer',
		'Error: NookVolumes: found render after dispose, expected a new one',
		'RangeError: nookPass: camera: projection: found infinity or NaN, expected 16 finite numbers',
		...Array(5).fill('nothing refused'),
	]);
JS
mv webgl_said said

# nook shade draws these depths.
node "$here/live_site_files.cjs" read <said || problem "the page: $(head -c 300 said)"
projection=$(node -e 'console.log(JSON.parse(require("fs").readFileSync("said", "utf8")).projection.join(" "))')
oiiotool read/v0.tif --chnames Z -o depth.exr || problem "depth: not read"
# pictured PICTURE SLICES STEPS PERCENT: at most PERCENT of the pixels differ by more than 1.5/255, since the page's normals have 8 bits.
pictured()
{
	"$nook" tile --domain slice --count "$2" --size 4 --filter bilateral:5 --frames 16 --moves -o tile.json >/dev/null || problem "tile: not made"
	"$nook" shade depth.exr --sky-depth 1e29 --projection "$projection" --world-to-camera identity --normals from-depth --method slices \
		--pattern tile.json --slice-steps "$3" --filter bilateral --radius 1.5 -o shade.exr >log 2>&1 || problem "nook shade: $(cat log)"
	idiff -fail 0.0059 -failpercent "$4" "read/$1.tif" shade.exr >difference 2>&1
	[ $? -lt 2 ] || problem "$1: $(grep -E 'Max|pixels' difference)"
}
# nook shade draws the same volumes, up to the page's normals of 8 bits and visibility of 8 bits.
numbers=$(node -e 'console.log(JSON.parse(require("fs").readFileSync("said", "utf8")).room.map(matrix => matrix.join(" ")).join("\n"))')
oiiotool read/v3.tif --chnames Z -o room.exr || problem "room: not read"
"$nook" shade room.exr --sky-depth 1e29 --projection "$(echo "$numbers" | head -n 1)" --world-to-camera "$(echo "$numbers" | tail -n 1)" --normals from-depth \
	--method aov --volumes app/public/volumes.glb -o shade.exr >log 2>&1 || problem "nook shade: $(cat log)"
idiff -fail 0.0079 -failpercent 0.5 read/v4.tif shade.exr >difference 2>&1
[ $? -lt 2 ] || problem "volumes: $(grep -E 'Max|pixels' difference)"
[ "$(oiiotool --stats shade.exr | grep -c 'Stats Min: 0\.[0-7]')" = 1 ] || problem "volumes: found $(oiiotool --stats shade.exr | grep Min), expected dark pixels"
pictured v1 1 4 0.5
pictured v2 3 6 0.5
before=$failures
pictured v1 1 2 0.5 >missed
[ $failures -gt $before ] && failures=$before || problem "other steps: found no fault, expected one"
finish
