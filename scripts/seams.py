#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: seams.py BAKED.glb [DEGREES]. How far the two sides of each seam of the file's occlusion textures are apart: bilinear values
# at 16 points along every edge that two triangles share with different coordinates and with normals that differ by less than
# DEGREES (default 11).
import json, struct, sys, zlib
import numpy as np

POINTS = 16
SIZES = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3}
TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}


def read(path):
    data = open(path, 'rb').read()
    size, = struct.unpack('<I', data[12:16])
    return json.loads(data[20:20 + size]), data[28 + size:]


def values(document, chunk, index):
    accessor = document['accessors'][index]
    view = document['bufferViews'][accessor['bufferView']]
    kind, width = np.dtype(TYPES[accessor['componentType']]), SIZES[accessor['type']]
    stride = view.get('byteStride', kind.itemsize * width)
    start = view.get('byteOffset', 0) + accessor.get('byteOffset', 0)
    raw = np.frombuffer(chunk, np.uint8)
    rows = np.lib.stride_tricks.as_strided(raw[start:], (accessor['count'], kind.itemsize * width), (stride, 1))
    return np.ascontiguousarray(rows).view(kind).reshape(accessor['count'], width)


def png(data):
    width, height, bits, colour = struct.unpack('>IIBB', data[16:26])
    assert bits == 8 and colour in (0, 2, 6)
    channels = {0: 1, 2: 3, 6: 4}[colour]
    at, packed = 8, b''
    while at < len(data):
        size, kind = struct.unpack('>I4s', data[at:at + 8])
        packed += data[at + 8:at + 8 + size] if kind == b'IDAT' else b''
        at += 12 + size
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * channels)
    image = np.zeros((height + 1, width + 1, channels), int)  # with an empty row and column before the first
    for y, row in enumerate(rows, 1):
        line, up, method = row[1:].reshape(width, channels).astype(int), image[y - 1], row[0]
        if method in (0, 2):
            image[y, 1:] = line + (up[1:] if method == 2 else 0) & 255
            continue
        for x in range(1, width + 1):
            left, above, corner = image[y, x - 1], up[x], up[x - 1]
            if method == 4:
                guess = left + above - corner
                distances = np.abs(np.stack([guess - left, guess - above, guess - corner]))
                guess = np.choose(np.argmin(distances, axis=0), [left, above, corner])
            else:
                guess = left if method == 1 else (left + above) // 2
            image[y, x] = line[x - 1] + guess & 255
    return image[1:, 1:, 0] / 255


def bilinear(picture, uv):
    size = np.array(picture.shape[::-1])
    p = np.clip(uv * size - 0.5, 0, size - 1)
    low = np.minimum(np.floor(p).astype(int), size - 2)
    f = p - low
    at = lambda dx, dy: picture[low[:, 1] + dy, low[:, 0] + dx]
    return ((at(0, 0) * (1 - f[:, 0]) + at(1, 0) * f[:, 0]) * (1 - f[:, 1])
            + (at(0, 1) * (1 - f[:, 0]) + at(1, 1) * f[:, 0]) * f[:, 1])


def matrix(node):
    if 'matrix' in node:
        return np.array(node['matrix']).reshape(4, 4).T
    x, y, z, w = node.get('rotation', (0, 0, 0, 1))
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    made = np.eye(4)
    made[:3, :3] = turn * np.array(node.get('scale', (1, 1, 1)))
    made[:3, 3] = node.get('translation', (0, 0, 0))
    return made


def triangles(document, chunk):
    worlds = {}
    nodes = document['nodes']
    stack = [(root, np.eye(4)) for root in document['scenes'][document.get('scene', 0)]['nodes']]
    while stack:
        index, parent = stack.pop()
        world = parent @ matrix(nodes[index])
        stack += [(child, world) for child in nodes[index].get('children', ())]
        for primitive in document['meshes'][nodes[index]['mesh']]['primitives'] if 'mesh' in nodes[index] else ():
            use = document['materials'][primitive['material']].get('occlusionTexture') if 'material' in primitive else None
            if use is None:
                continue
            attributes = primitive['attributes']
            points = values(document, chunk, attributes['POSITION']).astype(float) @ world[:3, :3].T + world[:3, 3]
            uvs = values(document, chunk, attributes[f"TEXCOORD_{use.get('texCoord', 0)}"]).astype(float)
            corners = values(document, chunk, primitive['indices']).reshape(-1, 3).astype(int)
            yield points[corners], uvs[corners], np.full(len(corners), document['textures'][use['index']]['source'])


def main():
    document, chunk = read(sys.argv[1])
    least = np.cos(np.radians(float(sys.argv[2]) if len(sys.argv) > 2 else 11.0))
    points, uvs, pages = map(np.concatenate, zip(*triangles(document, chunk)))
    normals = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    normals /= np.maximum(lengths, 1e-300)[:, None]
    sides = {}
    for t in np.flatnonzero(lengths > 0):
        keys = [p.tobytes() for p in np.round(points[t].astype(np.float32), 6) + np.float32(0)]
        for k in range(3):
            a, b = k, (k + 1) % 3
            a, b = (a, b) if keys[a] < keys[b] else (b, a)
            sides.setdefault((keys[a], keys[b]), []).append((t, a, b, a == k))
    share = (np.arange(POINTS)[:, None] + 0.5) / POINTS
    ends = []
    for found in sides.values():
        if len(found) == 2 and found[0][3] != found[1][3]:
            (t, a, b, _), (u, c, d, _) = found
            if normals[t] @ normals[u] > least and (pages[t] != pages[u] or not (uvs[t, [a, b]] == uvs[u, [c, d]]).all()):
                ends.append((pages[t], uvs[t, a] + (uvs[t, b] - uvs[t, a]) * share, pages[u],
                             uvs[u, c] + (uvs[u, d] - uvs[u, c]) * share))
    pictures = {}
    for page in set(pages):
        view = document['bufferViews'][document['images'][page]['bufferView']]
        start = view.get('byteOffset', 0)
        pictures[page] = png(chunk[start:start + view['byteLength']])
    apart = np.array([np.abs(bilinear(pictures[p], uv) - bilinear(pictures[q], vw)) for p, uv, q, vw in ends])
    if not apart.size:
        sys.exit('no seams')
    print(f'seams {len(ends)} within_0.02 {np.mean(apart <= 0.02):.4f} p99 {np.quantile(apart, 0.99):.4f} max {apart.max():.4f}')


main()
