#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: unwrapped.py BEFORE AFTER. Checks that the corners of all triangles in AFTER, an output of nook bake --unwrap, have the
# attributes that they have in BEFORE and one more set of texture coordinates, which the occlusion texture uses. Ends with 1 and
# prints what differs.
import base64, json, os, struct, sys

SIZES = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4}
BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}


class File:
    def __init__(self, path):
        with open(path, 'rb') as file:
            data = file.read()
        self.path, self.chunk = path, b''
        if data[:4] == b'glTF':
            size = struct.unpack('<I', data[12:16])[0]
            self.chunk = data[28 + size:]
            data = data[20:20 + size]
        self.json = json.loads(data)

    def elements(self, index):
        item = self.json['accessors'][index]
        size = SIZES[item['type']] * BYTES[item['componentType']]
        if 'bufferView' not in item:
            return [b'\0' * size] * item['count']
        view = self.json['bufferViews'][item['bufferView']]
        buffer = self.json['buffers'][view.get('buffer', 0)]
        data = self.chunk
        if 'uri' in buffer and buffer['uri'].startswith('data:'):
            data = base64.b64decode(buffer['uri'].split(',', 1)[1] + '==')
        elif 'uri' in buffer:
            with open(os.path.join(os.path.dirname(self.path), buffer['uri']), 'rb') as file:
                data = file.read()
        at = view.get('byteOffset', 0) + item.get('byteOffset', 0)
        step = view.get('byteStride', size)
        return [data[at + i * step:at + i * step + size] for i in range(item['count'])]

    # For each node with a mesh: its triangles, each with the attributes and morph targets of its corners.
    def triangles(self, sets):
        found = []
        for node in self.json['nodes']:
            corners = []
            for primitive in self.json['meshes'][node['mesh']]['primitives'] if 'mesh' in node else []:
                if primitive.get('mode', 4) != 4:
                    continue
                names = {name: self.elements(i) for name, i in primitive['attributes'].items()}
                if sets is not None:
                    use = self.json['materials'][primitive['material']]['occlusionTexture']['texCoord']
                    assert f'TEXCOORD_{use}' in names and f'TEXCOORD_{use + 1}' not in names, f'{primitive}: found no new set'
                    for name in [n for n in names if n.startswith('TEXCOORD_') and int(n[9:]) >= sets]:
                        assert all(0 <= x <= 1 for uv in names.pop(name) for x in struct.unpack('<ff', uv)), f'{name}: outside'
                for i, target in enumerate(primitive.get('targets', [])):
                    names.update({f'{i} {name}': self.elements(k) for name, k in target.items()})
                width = BYTES[self.json['accessors'][primitive['indices']]['componentType']] if 'indices' in primitive else 0
                order = ([int.from_bytes(i[:width], 'little') for i in self.elements(primitive['indices'])]
                         if width else range(len(names['POSITION'])))
                corners += [tuple(names[name][i] for name in sorted(names)) for i in order]
            found.append(sorted(tuple(corners[i:i + 3]) for i in range(0, len(corners), 3)))
        return found


before, after = File(sys.argv[1]), File(sys.argv[2])
sets = min(sum(name.startswith('TEXCOORD_') for name in primitive['attributes'])
           for mesh in before.json['meshes'] for primitive in mesh['primitives'])
a, b = before.triangles(None), after.triangles(sets)
if len(a) != len(b) or any(x != y for x, y in zip(a, b)):
    print(f'{sys.argv[2]}: found other triangles than in {sys.argv[1]}')
    sys.exit(1)
