# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: bake_materials_test.sh PROGRAM. nook bake: materials of formats other than glTF, values in the order of their files, occlusion
# in the red channel of metallic-roughness textures, split triangles, parts by extras of materials, and skies.
set -u
nook=$1
source=$(cd "$(dirname "$0")/.." && pwd)
. "$(dirname "$0")/command_line.sh"
if ! command -v python3 >../stdout; then
	echo "no python3"
	exit 77
fi
export PYTHONPATH="$source/tests" PYTHONDONTWRITEBYTECODE=1

# A floor with a colour, a wall with a texture in a folder, a card with a texture and a mask, a vertex that nothing uses.
mkdir 'kept tex' kept_out
cat >kept_room.mtl <<'EOT'
newmtl red
Kd 0.8 0.1 0.05
newmtl wall
Kd 0 0 0
map_Kd -s 2 2 1 kept tex/brick 1.png
newmtl card
map_Kd kept tex/brick 1.png
map_d kept tex/mask.png
EOT
cat >kept_room.obj <<'EOT'
mtllib kept_room.mtl
v 0 0 0
v 9 9 9
v 2 0 0
v 2 0 2
v 0 0 2
v 0 2 0
v 2 2 0
v 1 0 1
v 1 1 1
v 1 1 2
v 1 0 2
vt 0 0
vt 1 0
vt 1 1
vt 0 1
o floor
usemtl red
f 5 4 3 1
o wall
usemtl wall
f 1/1 3/2 7/3 6/4
o card
usemtl card
f 8/1 9/2 10/3 11/4
EOT
python3 - <<'EOT'
from gltf_files import png
png('kept tex/brick 1.png', 4, 4, [c for i in range(16) for c in (16 * i, 255 - i, 7, 255)])
png('kept tex/mask.png', 2, 2, [c for i in range(4) for c in (0, 0, 0, 255 if i < 2 else 0)])
EOT
works '^file: ' bake kept_room.obj --radius 1 --rays 32 -o kept_out/room.glb -o values.csv -o values.npy
python3 - <<'EOT' >../log 2>&1 || problem "kept_room.obj: $(cat ../log)"
from gltf_files import *
document, chunk = glb('kept_out/room.glb')
red, wall, card = document['materials']
assert [round(x, 4) for x in red['pbrMetallicRoughness']['baseColorFactor']] == [0.8, 0.1, 0.05, 1], red
assert 'baseColorFactor' not in wall['pbrMetallicRoughness'], wall
image = lambda m: document['textures'][m['pbrMetallicRoughness']['baseColorTexture']['index']]['source']
assert document['images'][image(wall)]['uri'] == '../kept%20tex/brick%201.png', document['images']
assert card['alphaMode'] == 'MASK'
width, height, card_pixels = pixels(document, chunk, image(card))
assert (width, height) == (4, 4) and [p[:3] for p in card_pixels] == [(16 * i, 255 - i, 7) for i in range(16)], card_pixels
assert all((p[3] > 127) == (i < 8) for i, p in enumerate(card_pixels)), card_pixels
parts = {m['name']: m['primitives'][0]['attributes'] for m in document['meshes']}
assert 'TEXCOORD_0' not in parts['floor']
assert sorted(floats(document, chunk, parts['wall']['TEXCOORD_0'])) == [(0, -1), (0, 1), (2, -1), (2, 1)], parts
# One row for each v line, in that order: the mean over the vertices at its place; 1 for the vertex without a face.
rows = [line.split(',') for line in open('values.csv').read().split()[1:]]
places = [tuple(map(float, line.split()[1:])) for line in open('kept_room.obj') if line.startswith('v ')]
assert [int(row[3]) for row in rows] == list(range(11)) and rows[1][4] == '1', rows
at = {}
for attributes in parts.values():
    for p, v in zip(floats(document, chunk, attributes['POSITION']), floats(document, chunk, attributes['_VISIBILITY'])):
        at.setdefault(p, []).append(v[0])
for place, row in zip(places, rows):
    expected = sum(at.get(place, [1])) / len(at.get(place, [1]))
    assert abs(float(row[4]) - expected) < 1e-6, (place, row, expected)
assert min(float(row[4]) for row in rows) < 0.9 and len(set(row[4] for row in rows)) > 4
EOT
there values.csv values.npy
works '' bake kept_room.obj --radius 1 --rays 4 --unwrap --texture 64 -o kept_out/unwrapped.glb
works '' level kept_room.obj -o kept_level.glb
grep -aq '"uri"' kept_level.glb && problem "kept_level.glb: found another file's name"
sed 's/brick 1.png/none.png/' kept_room.mtl >kept_none.mtl
sed 's/kept_room.mtl/kept_none.mtl/; /^o card/,$d' kept_room.obj >kept_none.obj
works '' bake kept_none.obj --radius 1 --rays 4 -o kept_none.glb --json s.json
grep -q missing-file s.json && ! grep -aq '"uri"' kept_none.glb || problem "kept_none.obj: found a texture that does not exist in the output"
cp 'kept tex/brick 1.png' kept_brick.tga
sed 's/kept tex.brick 1.png/kept_brick.tga/' kept_room.mtl >kept_none.mtl
"$nook" bake kept_none.obj --radius 1 --rays 4 -o kept_none.glb >../stdout 2>../log
grep -q 'warning: kept_brick.tga: found a picture that few' ../log || problem "kept_brick.tga: found no warning: $(cat ../log)"

# Colours of vertices: sRGB in the file, linear in the output; multiplied by --to color.
cat >kept_scan.ply <<'EOT'
ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 2
property list uchar int vertex_indices
end_header
5 5 5 0 0 0
0 0 0 255 188 0
1 0 0 255 255 255
1 0 1 0 0 255
0 0 1 255 0 0
3 1 3 2
3 1 4 3
EOT
sed -e 's/^end_header//' -e '/^[^0-9]/d' -e '/^3 /d' kept_scan.ply |
	awk 'NF == 6 { print "v", $1, $2, $3, $4 / 255, $5 / 255, $6 / 255 } END { print "f 2 4 3\nf 2 5 4" }' >kept_scan.obj
for scan in kept_scan.ply kept_scan.obj; do
	works '' bake $scan --radius 1 --rays 4 -o scan.glb -o scan.json --json s.json
	python3 - <<'EOT' >../log 2>&1 || problem "$scan: $(cat ../log)"
from gltf_files import *
document, chunk = glb('scan.glb')
attributes = document['meshes'][0]['primitives'][0]['attributes']
colours = dict(zip(floats(document, chunk, attributes['POSITION']), floats(document, chunk, attributes['COLOR_0'])))
expected = {(0, 0, 0): (1, 0.503, 0), (1, 0, 0): (1, 1, 1), (1, 0, 1): (0, 0, 1), (0, 0, 1): (1, 0, 0)}
for place, colour in expected.items():
    assert all(abs(a - b) < 1e-3 for a, b in zip(colours[place], colour)), colours
parts = json.load(open('scan.json'))['parts']
assert len(parts) == 1 and len(parts[0]['values']) // json.load(open('scan.json'))['sides'] == 5, parts
EOT
done
there s.json scan.glb scan.json

# A floor and a wall with coordinates of their own, and a metallic-roughness texture that has something else in red.
python3 - <<'EOT'
import base64
from gltf_files import *
quads = [[(0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 0, 0)], [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]]
uvs = [[(u + x * 0.4, 0.1 + y * 0.8) for x, y in ((0, 0), (0, 1), (1, 1), (1, 0))] for u in (0.05, 0.55)]
data = b''.join(struct.pack('<3f', *p) for q in quads for p in q) + b''.join(struct.pack('<2f', *p) for q in uvs for p in q)
data += struct.pack('<6H', 0, 1, 2, 0, 2, 3)
png('kept_orm.png', 32, 16, [c for i in range(512) for c in (i & 255, i * 7 & 255, i * 13 & 255, 255 - i % 9)])
views = [(48 * i, 48) for i in (0, 1)] + [(96 + 32 * i, 32) for i in (0, 1)] + [(160, 12)]
document = {
    'asset': {'version': '2.0'}, 'scenes': [{'nodes': [0, 1]}], 'nodes': [{'mesh': 0, 'name': 'floor'}, {'mesh': 1, 'name': 'wall'}],
    'meshes': [{'primitives': [{'attributes': {'POSITION': i, 'TEXCOORD_0': 2 + i}, 'indices': 4, 'material': i}]} for i in (0, 1)],
    'materials': [{'name': 'steel', 'pbrMetallicRoughness': {'metallicRoughnessTexture': {'index': 0}}, 'extras': {'physics': 'only'},
                   'occlusionTexture': {'index': 0, 'strength': 0.25}}, {'name': 'plain'}],
    'textures': [{'source': 0, 'sampler': 0}], 'samplers': [{'wrapS': 33648}], 'images': [{'uri': 'kept_orm.png'}],
    'accessors': [{'bufferView': i, 'componentType': 5126, 'count': 4, 'type': 'VEC3', 'min': [0, 0, 0], 'max': [1, 1, 1]} for i in (0, 1)]
    + [{'bufferView': i, 'componentType': 5126, 'count': 4, 'type': 'VEC2'} for i in (2, 3)]
    + [{'bufferView': 4, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'}],
    'bufferViews': [{'buffer': 0, 'byteOffset': start, 'byteLength': size} for start, size in views],
    'buffers': [{'byteLength': len(data), 'uri': 'data:;base64,' + base64.b64encode(data).decode()}]}
json.dump(document, open('kept_orm.gltf', 'w'))
# 16 × 8 pixels, all (20, 130, 60).
jpeg = ('/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDAAIBAQEBAQIBAQECAgICAgQDAgICAgUEBAMEBgUGBgYFBgYGBwkIBgcJBwYGCAsICQoK'
        'CgoKBggLDAsKDAkKCgr/2wBDAQICAgICAgUDAwUKBwYHCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoK'
        'CgoKCgoKCgr/wAARCAAIABADASIAAhEBAxEB/8QAFQABAQAAAAAAAAAAAAAAAAAAAAj/xAAUEAEAAAAAAAAAAAAAAAAAAAAA/8QA'
        'FQEBAQAAAAAAAAAAAAAAAAAABwj/xAAUEQEAAAAAAAAAAAAAAAAAAAAA/9oADAMBAAIRAxEAPwCYwB+jt//Z')
open('kept_orm.jpg', 'wb').write(base64.b64decode(jpeg))
document['images'] = [{'uri': 'kept_orm.jpg'}]
json.dump(document, open('kept_jpeg.gltf', 'w'))
# A box of 40 m around them.
corners = [(x, y, z) for x in (-20, 20) for y in (-20, 20) for z in (-20, 20)]
faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
with open('kept_shell.obj', 'w') as obj:
    obj.write('o thing\n' + ''.join('v %d %d %d\n' % p for q in quads for p in q) + 'f 1 2 3 4\no other\nf 5 6 7 8\no shell\n')
    obj.write(''.join('v %d %d %d\n' % p for p in corners) + ''.join('f ' + ' '.join(str(9 + i) for i in f) + '\n' for f in faces))
EOT
works '"to": "texture:orm"' bake kept_orm.gltf --radius 1 --rays 64 --to texture:orm --texture 32 -o orm.glb --json -
works '' bake kept_orm.gltf --radius 1 --rays 64 --texture 32 -o plain.glb --json s.json
works '' bake kept_jpeg.gltf --radius 1 --rays 64 --to texture:orm --texture 32 -o jpeg.glb --json s.json
works '' bake orm.glb --radius 1 --rays 64 --texture 32 -o again.glb --json s.json
works '' bake kept_orm.gltf --radius 1 --rays 64 --to texture:orm --unwrap --texture 64 -o unwrapped.glb --json s.json
python3 - <<'EOT' >../log 2>&1 || problem "--to texture:orm: $(cat ../log)"
from gltf_files import *
def maps(path):
    document, chunk = glb(path)
    steel, plain = document['materials']
    source = lambda use: document['textures'][use['index']]['source']
    return document, chunk, steel, plain, source
document, chunk, steel, plain, source = maps('orm.glb')
rough = steel['pbrMetallicRoughness']['metallicRoughnessTexture']
assert steel['occlusionTexture'] == {'index': rough['index'], 'texCoord': 0, 'strength': 0.25}, steel
assert document['textures'][rough['index']]['sampler'] == 0 and document['images'][0] == {'uri': 'kept_orm.png'}
assert plain['occlusionTexture']['index'] != rough['index'] and 'pbrMetallicRoughness' not in plain, plain
width, height, orm = pixels(document, chunk, source(rough))
assert (width, height) == (32, 16)
assert [p[1:] for p in orm] == [(i * 7 & 255, i * 13 & 255, 255 - i % 9) for i in range(512)]
_, _, occlusion = pixels(document, chunk, source(plain['occlusionTexture']))  # 32 x 32: two rows for each of the texture
for i, p in enumerate(orm):
    mean = (occlusion[i // 32 * 64 + i % 32][0] + occlusion[i // 32 * 64 + 32 + i % 32][0]) / 2
    assert abs(p[0] - mean) <= 1, (i, p, mean)
assert min(p[0] for p in orm) < 200 < max(p[0] for p in orm)
document, chunk, steel, plain, source = maps('jpeg.glb')
_, _, orm = pixels(document, chunk, source(steel['occlusionTexture']))
assert all(abs(p[1] - 130) <= 3 and abs(p[2] - 60) <= 3 for p in orm), orm[:4]
document, chunk, steel, plain, source = maps('again.glb')
assert document['textures'][steel['pbrMetallicRoughness']['metallicRoughnessTexture']['index']]['source'] == 0
assert len(document['images']) == 2 and steel['occlusionTexture']['strength'] == 0.25
document, chunk, steel, plain, source = maps('unwrapped.glb')
rough = steel['pbrMetallicRoughness']['metallicRoughnessTexture']
assert steel['occlusionTexture'] == {'index': rough['index'], 'texCoord': 1, 'strength': 0.25}, steel
EOT
there again.glb jpeg.glb orm.glb plain.glb s.json unwrapped.glb
python3 - <<'EOT'
import zlib, struct
part = lambda kind, data: struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
rows = b''.join(b'\0' + b'\1\x80' * 12 for y in range(4))
open('kept_16.png', 'wb').write(b'\x89PNG\r\n\x1a\n' + part(b'IHDR', struct.pack('>IIBBBBB', 4, 4, 16, 2, 0, 0, 0)) + part(b'IDAT', zlib.compress(rows)) + part(b'IEND', b''))
EOT
sed 's/kept_orm.png/kept_16.png/' kept_orm.gltf >kept_deep.gltf
fails 5 'kept_deep.gltf: textures\[0\]: found more than 8 bits per channel' bake kept_deep.gltf --radius 1 --rays 1 --to texture:orm --texture 16 -o o.glb
sed 's/"source": 0,/"extensions": {"EXT_texture_webp": {"source": 0}},/' kept_orm.gltf >kept_webp.gltf
fails 5 'kept_webp.gltf: textures\[0\]: found no image of the core format' bake kept_webp.gltf --radius 1 --rays 1 --to texture:orm --texture 16 -o o.glb
fails 1 '--to: found' bake kept_orm.gltf --radius 1 --to texture:red -o o.glb
# The file is checked before the first ray.
: >kept_set.log >kept_deep.log
fails 3 'kept_orm.gltf: TEXCOORD_0: found it in use' bake kept_orm.gltf --radius 1 --to texcoord:0 -o o.glb --progress kept_set.log
fails 5 'kept_deep.gltf: textures\[0\]: found more than 8 bits' bake kept_deep.gltf --radius 1 --to texture:orm --texture 16 -o o.glb --progress kept_deep.log
grep -q '"places"' kept_set.log && ! grep -q '"rays"' kept_set.log kept_deep.log || problem "found rays in $(cat kept_set.log kept_deep.log)"

# --max-error in the file itself: all attributes are interpolated. A wall stands on a floor, whose strip two nodes show, one of
# them far away in a mirror; every attribute is a linear function of the position.
python3 - <<'EOT'
import base64
from gltf_files import *
data, views, accessors = b'', [], []
def add(kind, component, packing, rows, **more):
    global data
    packed = b''.join(struct.pack(packing, *row) for row in rows)
    views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(packed), 'byteStride': len(packed) // len(rows)})
    accessors.append({'bufferView': len(views) - 1, 'componentType': component, 'count': len(rows), 'type': kind, **more})
    data += packed + b'\0' * (-len(packed) % 4)
    return len(accessors) - 1
floor = [(0, 0, 0), (0, 0, 4), (4, 0, 0), (4, 0, 4)]
attributes = {
    'POSITION': add('VEC3', 5126, '<3f', floor, min=[0, 0, 0], max=[4, 0, 4]), 'NORMAL': add('VEC3', 5126, '<3f', [(0, 1, 0)] * 4),
    'TANGENT': add('VEC4', 5126, '<4f', [(1, 0, 0, -1)] * 4), 'TEXCOORD_0': add('VEC2', 5126, '<2f', [(x / 2, -z) for x, y, z in floor]),
    'TEXCOORD_1': add('VEC2', 5123, '<2H', [(9999 * x, 5000 * z) for x, y, z in floor], normalized=True),
    'COLOR_0': add('VEC4', 5121, '<4B', [(60 * x, 50 * z, 9, 255) for x, y, z in floor], normalized=True),
    '_ID': add('SCALAR', 5123, '<Hxx', [(7 * i,) for i in range(4)]),
    'JOINTS_0': add('VEC4', 5121, '<4B', [(x, 2 + z, 0, 0) for x, y, z in floor]),
    'WEIGHTS_0': add('VEC4', 5121, '<4B', [(155, 100, 0, 0)] * 4, normalized=True)}
target = add('VEC3', 5126, '<3f', [(z, x, 0) for x, y, z in floor], min=[0, 0, 0], max=[4, 4, 0])
wall = add('VEC3', 5126, '<3f', [(2, 0, 1), (2, 0, 3), (2, 1, 1), (2, 1, 3)], min=[2, 0, 1], max=[2, 1, 3])
document = {
    'asset': {'version': '2.0'}, 'scenes': [{'nodes': [0, 1, 2]}],
    'nodes': [{'mesh': 0, 'name': 'floor'}, {'mesh': 1, 'name': 'wall'}, {'mesh': 0, 'name': 'far', 'translation': [90, 0, 0], 'scale': [-1, 1, 1]}],
    'meshes': [{'primitives': [{'attributes': attributes, 'mode': 5, 'targets': [{'POSITION': target}]}], 'weights': [0]},
               {'primitives': [{'attributes': {'POSITION': wall}, 'mode': 5, 'material': 0}]}],
    'materials': [{'doubleSided': True}], 'accessors': accessors, 'bufferViews': views,
    'buffers': [{'byteLength': len(data), 'uri': 'data:;base64,' + base64.b64encode(data).decode()}]}
json.dump(document, open('kept_split.gltf', 'w'))
document['nodes'][0]['extensions'] = {'EXT_mesh_gpu_instancing': {'attributes': {'TRANSLATION': wall}}}
document['extensionsUsed'] = ['EXT_mesh_gpu_instancing']
json.dump(document, open('kept_placed.gltf', 'w'))
EOT
works '"file": "the level.s, with additions"' bake kept_split.gltf --radius 1 --rays 64 --max-error 0.03 --threads 1 -o split.glb -o split.csv --json -
works '' bake kept_split.gltf --radius 1 --rays 64 --max-error 0.03 --threads 3 -o other.glb --json s.json
works '' bake kept_split.gltf --radius 1 --rays 64 --max-error 0.005 --receivers far,wall --to color -o wall.glb --json s.json
works '' bake split.glb --radius 1 --rays 64 -o again.glb --json s.json
works '' bake kept_split.gltf --radius 1 --rays 64 -o plain.glb --json s.json
works '' bake kept_shell.obj --radius 1 --rays 64 --max-error 0.005 --receivers thing -o thing.glb --json s.json
sed 's/bake kept_split.gltf/bake split.glb/' split.glb | cmp -s - split.glb && problem "split.glb: found another command in its record"
LC_ALL=C sed 's/bake kept_split.gltf .* -o//' split.glb >a && LC_ALL=C sed 's/bake kept_split.gltf .* -o//' other.glb | cmp - a >../log || problem "--max-error: $(cat ../log)"
python3 - <<'EOT' >../log 2>&1 || problem "--max-error in the file: $(cat ../log)"
from gltf_files import *
def values(document, chunk, accessor):
    item = document['accessors'][accessor]
    view = document['bufferViews'][item['bufferView']]
    kind, most = {5126: ('f', 1), 5123: ('H', 65535), 5121: ('B', 255), 5125: ('I', 1)}[item['componentType']]
    packing = f"<{ {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4}[item['type']]}{kind}"
    start, stride = view.get('byteOffset', 0) + item.get('byteOffset', 0), view.get('byteStride', struct.calcsize(packing))
    return [struct.unpack_from(packing, chunk, start + stride * i) for i in range(item['count'])]
def area(p, triangles):
    total = [0, 0, 0]
    for a, b, c in triangles:
        u, v = [[p[i][k] - p[a][k] for k in range(3)] for i in (b, c)]
        total = [total[k] + (u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]) / 2 for k in range(3)]
    return total
document, chunk = glb('split.glb')
assert [n['mesh'] for n in document['nodes']] == [2, 1, 0] and document['meshes'][0]['primitives'][0]['mode'] == 5
primitive, = document['meshes'][2]['primitives']
got = {name: values(document, chunk, i) for name, i in primitive['attributes'].items()}
p, indices = got['POSITION'], [i for i, in values(document, chunk, primitive['indices'])]
assert len(indices) > 60 and primitive['mode'] == 4 and set(indices) == set(range(len(p))), indices
assert max(abs(a - b) for a, b in zip(area(p, zip(*[iter(indices)] * 3)), (0, 16, 0))) < 1e-5
deltas = values(document, chunk, primitive['targets'][0]['POSITION'])
for i, (x, y, z) in enumerate(p):
    assert y == 0 and got['NORMAL'][i] == (0, 1, 0) and got['TANGENT'][i] == (1, 0, 0, -1) and deltas[i] == (z, x, 0)
    assert got['TEXCOORD_0'][i] == (x / 2, -z) and got['_ID'][i][0] in (0, 7, 14, 21)
    assert max(abs(a - b) for a, b in zip(got['TEXCOORD_1'][i], (9999 * x, 5000 * z))) <= 0.5
    assert max(abs(a - b) for a, b in zip(got['COLOR_0'][i], (60 * x, 50 * z, 9, 255))) <= 0.5
    assert sum(got['WEIGHTS_0'][i]) == 255 and len(set(got['JOINTS_0'][i])) >= 2, (got['WEIGHTS_0'][i], got['JOINTS_0'][i])
middle = p.index((2, 0, 2))
assert sorted(zip(got['JOINTS_0'][middle], got['WEIGHTS_0'][middle])) in ([(0, 78), (2, 50), (4, 77), (6, 50)], [(0, 77), (2, 50), (4, 78), (6, 50)]), \
    (got['JOINTS_0'][middle], got['WEIGHTS_0'][middle])
seen = got['_VISIBILITY']
assert seen[middle][0] < 0.8 < seen[0][0], seen
rows = [line.split(',') for line in open('split.csv').read().split()[1:]]
assert sum(row[0] == '0' for row in rows) == len(p) and sum(row[0] == '2' for row in rows) == 4
# Without --max-error, the bake before leaves no trace in the output.
again, plain = glb('again.glb')[0], glb('plain.glb')[0]
assert again['meshes'] == plain['meshes'] and again['accessors'] == plain['accessors']
# Parts that receive nothing are not split, and darken.
document, chunk = glb('wall.glb')
assert [n['mesh'] for n in document['nodes']] == [0, 1, 2] and 'indices' not in document['meshes'][0]['primitives'][0]
wall = document['meshes'][1]['primitives'][0]
assert len(values(document, chunk, wall['indices'])) > 6 and len(document['meshes'][0]['primitives'][0]['attributes']) == 9
assert min(c[0] for c in values(document, chunk, wall['attributes']['COLOR_0'])) < 255
document, chunk = glb('thing.glb')
thing, other, shell = [m['primitives'][0] for m in document['meshes']]
assert len(values(document, chunk, thing['indices'])) > 6 == len(values(document, chunk, other['indices'])), document['meshes']
assert '_VISIBILITY' in thing['attributes'] and '_VISIBILITY' not in shell['attributes']
EOT
there a again.glb other.glb plain.glb s.json split.csv split.glb thing.glb wall.glb
fails 5 'kept_placed.gltf: nodes.0.: found instances by EXT_mesh_gpu_instancing' bake kept_placed.gltf --radius 1 --max-error 0.1 -o o.glb

# Parts by extras of materials, and a sky without a name.
works '^triangles: 2$|triangles: 2,|"triangles": 2' bake kept_orm.gltf --radius 1 --rays 4 --ignore extras:physics=only --json -
fails 1 "--ignore: found 'extras:none', expected parts of kept_orm.gltf: 'extras:physics=only'" bake kept_orm.gltf --radius 1 --ignore extras:none -o o.glb
works "skies.*mesh 'shell' around all others, which --ignore '/shell' leaves out" info kept_shell.obj
"$nook" info kept_room.obj | grep -q skies && problem "kept_room.obj: found a sky"
there
finish
