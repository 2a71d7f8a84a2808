#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: additions.py BEFORE AFTER [ATTRIBUTE ...]. Prints what nook bake changed in a glTF file other than by adding to it, and
# ends with 1 if there is anything. ATTRIBUTE: one that may have another accessor, such as COLOR_0.
import base64, json, os, struct, sys, urllib.parse


def read(path):
    with open(path, 'rb') as file:
        data = file.read()
    if data[:4] != b'glTF':
        return json.loads(data), b'', []
    chunks, at = [], 12
    while at + 8 <= len(data):
        size, kind = struct.unpack('<I4s', data[at:at + 8])
        chunks.append((kind, data[at + 8:at + 8 + size]))
        at += 8 + size
    rest = [chunk for chunk in chunks[1:] if chunk[0] != b'BIN\0']
    return json.loads(chunks[0][1]), next((c for k, c in chunks if k == b'BIN\0'), b''), rest


def bytes_of(path, document, chunk, index):
    buffer = document['buffers'][index]
    if 'uri' not in buffer:
        return chunk[:buffer['byteLength']]
    if buffer['uri'].startswith('data:'):
        return base64.b64decode(buffer['uri'].split(',', 1)[1] + '==')
    with open(os.path.join(os.path.dirname(path), urllib.parse.unquote(buffer['uri'])), 'rb') as file:
        return file.read()[:buffer['byteLength']]


def main():
    before_path, after_path, changing = sys.argv[1], sys.argv[2], set(sys.argv[3:])
    (before, old, others), (after, new, rest) = read(before_path), read(after_path)
    problems = []

    def compare(a, b, where):
        if isinstance(a, dict) and isinstance(b, dict):
            kept = [name for name in b if name in a]
            if kept != [name for name in a if name in b]:
                problems.append(f'{where}: members in another order')
            for name, value in a.items():
                if name not in b:
                    problems.append(f'{where}.{name}: gone')
                elif not (where.endswith('.attributes') and name in changing):
                    compare(value, b[name], f'{where}.{name}')
            for name in b.keys() - a.keys():
                if not (where.endswith('.attributes') or where in ('.asset', '.asset.extras') or where.endswith('.extras')
                        or where == '' or (where.startswith('.nodes[') and name == 'extras')
                        or (where.startswith('.materials[') and name == 'occlusionTexture')):
                    problems.append(f'{where}.{name}: new')
        elif isinstance(a, list) and isinstance(b, list):
            if len(b) < len(a) or (len(b) > len(a) and where.count('.') > 1):
                problems.append(f'{where}: {len(b)} items instead of {len(a)}')
            for i, (x, y) in enumerate(zip(a, b)):
                compare(x, y, f'{where}[{i}]')
        elif where.startswith('.nodes[') and where.endswith('.mesh'):
            compare(before['meshes'][a], after['meshes'][b], f'.meshes[{a}]')  # a copy with other values
        elif where == '.buffers[0].byteLength':
            if b < a:
                problems.append(f'{where}: shorter')
        elif a != b or type(a) is not type(b):
            problems.append(f'{where}: {b} instead of {a}')

    compare(before, after, '')
    if others != rest:
        problems.append('further chunks differ')
    for i, buffer in enumerate(before.get('buffers', [])):
        a = bytes_of(before_path, before, old, i)
        if bytes_of(after_path, after, new, i)[:len(a)] != a:
            problems.append(f'.buffers[{i}]: other bytes')
    for problem in problems[:10]:
        print(f'{after_path}: {problem}')
    return 1 if problems else 0


sys.exit(main())
