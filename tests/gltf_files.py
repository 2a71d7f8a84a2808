# SPDX-License-Identifier: GPL-3.0-or-later
# Shared by the tests of bakes: PNG files, and the parts of binary glTF files.
import base64, json, struct, sys, zlib


def png(path, width, height, rgba):
    part = lambda kind, data: struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    rows = b''.join(b'\0' + bytes(rgba[4 * width * y:4 * width * (y + 1)]) for y in range(height))
    open(path, 'wb').write(b'\x89PNG\r\n\x1a\n' + part(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 6, 0, 0, 0))
                           + part(b'IDAT', zlib.compress(rows)) + part(b'IEND', b''))


def glb(path):
    data = open(path, 'rb').read()
    size, = struct.unpack('<I', data[12:16])
    return json.loads(data[20:20 + size]), data[28 + size:]


def pixels(document, chunk, image):  # of PNG files with any filters
    view = document['bufferViews'][document['images'][image]['bufferView']]
    data = chunk[view.get('byteOffset', 0):][:view['byteLength']]
    width, height, bits, colour = struct.unpack('>IIBB', data[16:26])
    n = {0: 1, 2: 3, 6: 4}[colour]
    packed, at = b'', 8
    while at < len(data):
        size, kind = struct.unpack('>I4s', data[at:at + 8])
        packed += data[at + 8:at + 8 + size] if kind == b'IDAT' else b''
        at += 12 + size
    raw, last, rows = zlib.decompress(packed), [0] * (n * width), []
    for y in range(height):
        method, line = raw[y * (1 + n * width)], list(raw[y * (1 + n * width) + 1:(y + 1) * (1 + n * width)])
        for x in range(n * width):
            a, b, c = (line[x - n] if x >= n else 0), last[x], (last[x - n] if x >= n else 0)
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[x] = line[x] + (0, a, b, (a + b) // 2, paeth)[method] & 255
        last, rows = line, rows + [[tuple(line[n * x:n * x + n]) for x in range(width)]]
    return width, height, [p for row in rows for p in row]


def floats(document, chunk, accessor):
    item = document['accessors'][accessor]
    view = document['bufferViews'][item['bufferView']]
    n = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3}[item['type']]
    start, stride = view.get('byteOffset', 0) + item.get('byteOffset', 0), view.get('byteStride', 4 * n)
    return [struct.unpack_from(f'<{n}f', chunk, start + stride * i) for i in range(item['count'])]
