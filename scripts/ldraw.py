#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Converts a model of bricks (LDraw, www.ldraw.org/article/218.html) to a GLB in metres: one mesh without normals, in up to two
# primitives; that of parts without certified winding has a two-sided material. Needs numpy.
# usage: ldraw.py LIBRARY MODEL OUT.glb
# LIBRARY: a folder with parts/ and p/; MODEL: .ldr or .mpd.
import json
import pathlib
import struct
import sys

import numpy

UNIT = 0.0004  # metres of an LDraw unit, whose y points down


class Reader:
    def __init__(self, library):
        self.files = {}  # by lower-case name: lines
        self.meshes = {}
        self.paths = {}
        for folder in ("p", "parts"):
            root = pathlib.Path(library) / folder
            self.paths.update({path.relative_to(root).as_posix().lower(): path for path in root.rglob("*.dat")})

    def read_model(self, path):
        """Adds the files of a model, and returns the name of the first."""
        first, name = None, "model"
        for line in pathlib.Path(path).read_text(errors="replace").splitlines():
            words = line.split()
            if words[:2] == ["0", "FILE"]:
                name = key(" ".join(words[2:]))
                first = first or name
            self.files.setdefault(name, []).append(line)
        return first or name

    def lines(self, name):
        if name not in self.files:
            if name not in self.paths:
                sys.exit(f"ldraw.py: found no part {name}, expected it in the library")
            self.files[name] = self.paths[name].read_text(errors="replace").splitlines()
        return self.files[name]

    def mesh(self, name):
        """Triangles as arrays of shape (n, 3, 3): those with certified winding, and the others."""
        if name in self.meshes:
            return self.meshes[name]
        certified, clockwise, invert = False, False, False
        faces = [[], []]
        parts = [[], []]
        for words in map(str.split, self.lines(name)):
            if words[:2] == ["0", "BFC"]:
                for word in words[2:]:
                    certified = word != "NOCERTIFY" and (certified or word == "CERTIFY")
                    clockwise = word != "CCW" and (clockwise or word == "CW")
                    invert = invert or word == "INVERTNEXT"
            elif words[:1] == ["1"]:
                numbers = numpy.array(words[2:14], dtype=float)
                matrix = numbers[3:].reshape(3, 3)
                turned = (numpy.linalg.det(matrix) < 0) != invert
                for kind, triangles in enumerate(self.mesh(key(" ".join(words[14:])))):
                    triangles = triangles @ matrix.T + numbers[:3]
                    parts[kind].append(triangles[:, ::-1] if turned else triangles)
                invert = False
            elif words[:1] in (["3"], ["4"]):
                corners = numpy.array(words[2 : 2 + 3 * int(words[0])], dtype=float).reshape(-1, 3)
                corners = corners[::-1] if clockwise else corners
                for i in range(2, len(corners)):
                    faces[0 if certified else 1].append(corners[[0, i - 1, i]])
                invert = False
        self.meshes[name] = tuple(numpy.concatenate([numpy.array(f).reshape(-1, 3, 3), *p]) for f, p in zip(faces, parts))
        return self.meshes[name]


def key(name):
    return name.strip().lower().replace("\\", "/")


def write_glb(path, meshes):
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
             "materials": [{}, {"doubleSided": True}], "accessors": [], "bufferViews": []}
    primitives, data = [], b""
    for material, triangles in enumerate(meshes):
        if len(triangles) == 0:
            continue
        points = (triangles.reshape(-1, 3) * [UNIT, -UNIT, -UNIT]).astype("<f4")
        scene["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": points.nbytes})
        primitives.append({"attributes": {"POSITION": len(primitives)}, "material": material})
        scene["accessors"].append({"bufferView": len(primitives) - 1, "componentType": 5126, "count": len(points), "type": "VEC3",
                                   "min": points.min(0).tolist(), "max": points.max(0).tolist()})
        data += points.tobytes()
    scene["meshes"] = [{"primitives": primitives}]
    scene["buffers"] = [{"byteLength": len(data)}]
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(data), 0x004E4942) + data)


if len(sys.argv) != 4:
    sys.exit("usage: ldraw.py LIBRARY MODEL OUT.glb")
reader = Reader(sys.argv[1])
write_glb(sys.argv[3], reader.mesh(reader.read_model(sys.argv[2])))
