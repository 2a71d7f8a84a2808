# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: web_volumes_test.sh PROGRAM SOURCE. Occlusion volumes drawn by WebGL 2 in headless Chromium, with npm/ao/volumes_gl.js and the
# module of nook emit --glsl es300: no pixel differs by more than 1/255 from nook shade, for perspective, off-centre and parallel
# cameras, and for an eye within volumes. Broken files are refused. Exit code 77: no Chromium or Node.js.
set -u
nook=$(realpath "$1")
source=$(realpath "$2")
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/browser.sh"
for tool in "$browser" node; do
	command -v "$tool" >/dev/null || { echo "skipped: found no ${tool:-chromium}, expected Debian's packages chromium and nodejs"; exit 77; }
done

cd "$folder" || exit 1
"$nook" emit --methods aov --glsl es300 -o nook_aov.glsl || problem "not emitted"
# scene NAME LEVEL DISTANCE SIZE CAMERA_OPTIONS…: volumes, G-buffer and the expected picture.
scene()
{
	name=$1 level=$2 distance=$3 size=$4
	shift 4
	"$nook" volumes "$level" --distance "$distance" -o "$name.glb" >log 2>&1 && "$nook" gbuffer "$level" --size "$size" -o "$name.exr" "$@" >log 2>&1 &&
		"$nook" shade "$name.exr" --method aov --volumes "$name.glb" -o "${name}_expected.exr" >log 2>&1 || problem "$name: $(tail -n 1 log)"
}
scene cornell builtin:cornell 0.4 96x72
scene within builtin:cornell 0.5 64x48 --eye 0.1,0.3,0.2 --target=-0.2,0.1,-0.4
scene offcentre builtin:cornell 0.4 64x48 --projection '1.4 0 0 0 0 1.8 0 0 0.3 -0.2 -1 -1 0 0 -0.2 0'
scene parallel builtin:cornell 0.4 64x48 --projection '0.3 0 0 0 0 0.4 0 0 0 0 -0.1 0 0.1 0.05 -1 1'
scene courtyard builtin:courtyard 1 48x27

node "$source/tests/web_volumes.mjs" "$browser" "$source" cornell within offcentre parallel courtyard >said 2>err || problem "web_volumes.mjs: $(tail -n 3 err)"
for name in cornell within offcentre parallel courtyard; do
	checks=$((checks + 1))
	grep -q "^$name .* 0 pixels beyond, darkest 0\.[0-8]" said || problem "$name: found '$(grep "^$name" said)', expected no pixel beyond 1/255, and dark ones"
done
cat said

# Files cut at multiples of 97 bytes and compressed arrays are refused. Changed bytes are refused or read, nothing else.
checks=$((checks + 1))
"$nook" volumes builtin:cornell --distance 0.4 --compress -o packed.glb >log || problem "packed: not made"
cat >hostile.mjs <<EOT
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
const { readVolumes, VolumesFrame } = await import(pathToFileURL('$source/npm/ao/volumes_file.js'));
const bytes = new Uint8Array(readFileSync('cornell.glb')), volumes = readVolumes(bytes);
function refused(what, pattern, call) {
	try {
		call();
	} catch (error) {
		if (error instanceof RangeError && pattern.test(error.message)) return;
		console.log(what + ': ' + error);
		return;
	}
	console.log(what + ': found nothing wrong');
}
for (let size = 0; size < bytes.length; size += 97) refused('cut at ' + size, /^volumes: found/, () => readVolumes(bytes.slice(0, size)));
refused('packed', /compressed arrays, and no decoder/, () => readVolumes(readFileSync('packed.glb')));
for (let i = 0; i < bytes.length; i += 61) {
	const one = bytes.slice();
	one[i] ^= 0xff;
	try { readVolumes(one); } catch (error) { if (!(error instanceof RangeError)) console.log('byte ' + i + ': ' + error); }
}
const frame = new VolumesFrame(volumes), view = { cameraFromWorld: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], width: 4, height: 4 };
refused('row-major', /row-major/, () => frame.set({ ...view, projection: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -0.2, 0, 0, -1, 0] }));
refused('left-handed', /left-handed/, () => frame.set({ ...view, projection: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, -0.2, 0] }));
refused('no pixels', /without pixels/, () => frame.set({ ...view, width: 0, projection: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.2, 0] }));
EOT
node hostile.mjs >said 2>&1 || problem "hostile.mjs: $(tail -n 3 said)"
[ -s said ] && problem "hostile files: $(head -n 3 said)"
finish
