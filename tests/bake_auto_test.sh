# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: bake_auto_test.sh PROGRAM. nook bake --auto: which triangles get a texture, bytes, errors, the same bytes on any number of
# threads, and refusals.
set -u
nook=$1
source=$(cd "$(dirname "$0")/.." && pwd)
. "$(dirname "$0")/command_line.sh"
if ! command -v python3 >../stdout; then
	echo "no python3"
	exit 77
fi
export PYTHONPATH="$source/tests" PYTHONDONTWRITEBYTECODE=1

# A floor of two triangles with a box on it, and far away a bumpy patch whose triangles are smaller than its shadows.
python3 - >kept_room.obj <<'EOT'
from math import cos
points = [(-4, 0, -4), (-4, 0, 4), (4, 0, 4), (4, 0, -4)]
points += [(x, y, z) for y in (0, 1) for x, z in ((-.5, -.5), (-.5, .5), (.5, .5), (.5, -.5))]
faces = [(1, 2, 3), (1, 3, 4), (9, 10, 11), (9, 11, 12)]
for k in range(4):
    a, b = 5 + k, 5 + (k + 1) % 4
    faces += [(a, b, b + 4), (a, b + 4, a + 4)]
first, n = len(points) + 1, 40
points += [(20 + .1 * x, .1 * cos(2 * x) * cos(2 * z), .1 * z) for x in range(n) for z in range(n)]
bumpy = []
for x in range(n - 1):
    for z in range(n - 1):
        a = first + n * x + z
        bumpy += [(a, a + 1, a + n + 1), (a, a + n + 1, a + n)]
for p in points:
    print('v %g %g %g' % p)
print('o room')
for f in faces:
    print('f %d %d %d' % f)
print('o bumpy')
for f in bumpy:
    print('f %d %d %d' % f)
EOT
works '' level kept_room.obj -o kept_room.glb
# A copy of this level in one mesh, with the room between two halves of the patch.
awk '/^v/ { print } /^f/ { face[++n] = $0 } END { for (i = 13; i <= 1533; ++i) print face[i]
	for (i = 1; i <= 12; ++i) print face[i]
	for (i = 1534; i <= n; ++i) print face[i] }' kept_room.obj >kept_joined.obj
works '' level kept_joined.obj -o kept_joined.glb
level=kept_room.glb
bake()
{
	"$nook" bake $level --radius 1 "$@" --json s.json -o out.glb >../stdout 2>../stderr </dev/null ||
		problem "bake $*: $(cat ../stderr)"
}

# holds NAME 'CONDITION': of s (the summary), before and after (documents), and old (the error of the earlier summary).
holds()
{
	python3 - "$2" $level <<'EOT' >../log 2>&1 || problem "$1: $(tail -n 3 ../log)"
import os
from gltf_files import *
s, (before, _), (after, _) = json.load(open('s.json')), glb(sys.argv[2]), glb('out.glb')
old = json.load(open('kept_old.json'))['rmse'] if os.path.exists('kept_old.json') else 1
texture, vertices = s['choices'] if 'choices' in s else (None, None)
primitives = [p for m in after['meshes'] for p in m['primitives']]
occluded = [p for p in primitives if 'occlusionTexture' in after['materials'][p['material']]]
if not eval(sys.argv[1]):
    sys.exit(f'found {s}, {primitives}, expected {sys.argv[1]}')
EOT
}

bake && mv s.json kept_old.json && mv out.glb kept_plain.glb
bake --auto
holds "the floor has a texture, and small triangles have none" '2 <= texture["triangles"] <= 12 and len(occluded) == 1'
holds "every triangle is counted" 'texture["triangles"] + vertices["triangles"] == 12 + 2 * 39 * 39'
holds "every primitive has values" 'all("_VISIBILITY" in p["attributes"] for p in primitives)'
holds "triangles are in one primitive each" \
	'sum(after["accessors"][p["indices"]]["count"] for p in primitives) == 3 * (12 + 2 * 39 * 39)'
holds "the error is less than 0.7 times that of vertices" 's["rmse"] < 0.7 * old'
holds "the expected error is that of other points" 'abs(s["expected_rmse"] - s["rmse_seen"]) < 0.3 * s["rmse_seen"] + 0.005'
holds "the choices take all bytes" 's["bytes_added"] == texture["bytes"] + vertices["bytes"] > s["png_bytes"] > 0'
holds "bytes are those of the file" 'after["buffers"][0]["byteLength"] - before["buffers"][0]["byteLength"] - s["bytes_added"] in range(64)'
holds "a stricter limit than values alone reach" 's["max_error"] == 0.03 and s["expected_rmse"] <= 0.031'
mv out.glb kept_first.glb
for threads in 1 2; do
	bake --auto --threads $threads
	cmp -s out.glb kept_first.glb || problem "--threads $threads: found other bytes"
done
# Triangles of a joined mesh that keep values are drawn from the file's own indices.
level=kept_joined.glb
bake --auto
holds "a run of the file's indices on both sides of the texture" 'occluded and sum(after["accessors"][p["indices"]]["bufferView"] ==
	before["accessors"][before["meshes"][0]["primitives"][0]["indices"]]["bufferView"] for p in primitives) == 2'
holds "no other indices but for the room" 's["bytes_added"] - s["png_bytes"] - 4 * s["vertices"] < 1000'
holds "every triangle of the joined mesh once" \
	'sum(after["accessors"][p["indices"]]["count"] for p in primitives) == 3 * (12 + 2 * 39 * 39)'
holds "values of all vertices" 'all("_VISIBILITY" in p["attributes"] for p in primitives)'
level=kept_room.glb
# A bake of a baked file first undoes that.
"$nook" bake kept_first.glb --radius 1 -o again.glb --json s.json 2>../stderr || problem "again: $(cat ../stderr)"
"$nook" bake kept_room.glb --radius 1 -o out.glb --json s.json
python3 - <<'EOT' || problem "again: found another file than that of the original"
from gltf_files import *
(again, of_again), (once, of_once) = glb('again.glb'), glb('out.glb')
again['asset'] = once['asset']
assert (again, of_again) == (once, of_once)
EOT
rm again.glb

bake --auto --max-bytes 38000 # values at the vertices take 36,648
holds "no more bytes than that" 's["bytes_added"] <= 38000 and s["max_bytes"] == 38000 and s["rmse"] < 0.7 * old'
bake --auto --max-bytes 36700
holds "no room for a texture" 's["bytes_added"] == 36648 and texture["triangles"] == 0'
bake --auto --max-error 1
holds "nothing is textured where vertices are good enough" 'texture["triangles"] == 0 and not occluded and s["png_bytes"] == 0'
bake --auto --to color
holds "colours and a texture" 'all("COLOR_0" in p["attributes"] for p in primitives) and occluded'
bake --auto --margin 1 --receivers room
holds "one part alone" 'all(("_VISIBILITY" in p["attributes"]) == (p["indices"] != before["meshes"][1]["primitives"][0]["indices"]) for p in primitives)'

# The box goes through the floor, whose back has no texture: what fronts gain no longer counts for much.
awk '/^v/ && ++v > 4 && v <= 12 { print "v", $2, $3 == 0 ? -1 : 1, $4; next } { print }' kept_room.obj >kept_sheet.obj
works '' level kept_sheet.obj -o kept_sheet.glb
python3 - <<'EOT'
import json, struct
data = open('kept_sheet.glb', 'rb').read()
size, = struct.unpack('<I', data[12:16])
document = json.loads(data[20:20 + size])
for material in document['materials']:
    material['doubleSided'] = True
text = json.dumps(document).encode()
text += b' ' * (-len(text) % 4)
rest = data[20 + size:]
open('kept_sheet.glb', 'wb').write(struct.pack('<4sIIII', b'glTF', 2, 20 + len(text) + len(rest), len(text), 0x4e4f534a) + text + rest)
EOT
level=kept_sheet.glb
bake --auto
holds "few bytes where no texture reaches the error" '0.03 < s["expected_rmse"] < 0.055 and 0 < texture["bytes"] < 5000'
grep -q "expected 0.03 at most; .*backs have values at the vertices only" ../stderr || problem "found no warning about backs: $(cat ../stderr)"
level=kept_room.glb

# nook shade draws the texture.
works '' gbuffer kept_room.glb --eye 3,3,3 --target 0,0,0 --fov 60 --size 64x36 -o kept_g.exr
works '' reference kept_room.glb --gbuffer kept_g.exr --radius 1 --rays 256 -o kept_rays.exr
for bake in kept_first.glb kept_plain.glb; do
	works '' shade kept_g.exr --method bake --bake $bake -o v.exr
	works '' compare v.exr kept_rays.exr --mask kept_g.exr --json $bake.json
done
python3 -c "
import json
auto, plain = (json.load(open(f'kept_{name}.glb.json'))['errors']['rmse'] for name in ('first', 'plain'))
assert auto < 0.5 * plain, (auto, plain)" 2>../log || problem "shade: $(tail -n 1 ../log), expected half of the error in a picture"
rm -f s.json out.glb v.exr kept_*.glb.json

for with in "--texture 64" --unwrap "--probes 1" "--fit points" --bent --color "--sides mean" "--instances shared" "--volumes kept_room.glb"; do
	fails 1 "--?[a-z]*: found with --" bake kept_room.glb --radius 1 --auto $with -o out.glb
done
fails 1 '--auto: found with --to texture, expected vertices' bake kept_room.glb --radius 1 --auto --to texture -o out.glb
fails 1 '--max-bytes: ' bake kept_room.glb --radius 1 --max-bytes 9000 -o out.glb
fails 1 '--max-bytes: found with --max-error' bake kept_room.glb --radius 1 --auto --max-bytes 9000 --max-error 0.1 -o out.glb
fails 1 '--max-bytes: found 100, expected at least [0-9]+, which values at the vertices take' bake kept_room.glb --radius 1 --auto --max-bytes 100 -o out.glb
fails 1 '--share: found with --auto' bake kept_room.glb --radius 1 --auto --share 1/2 --cache . -o out.glb
fails 1 'out.csv: ' bake kept_room.glb --radius 1 --auto -o out.csv
finish
