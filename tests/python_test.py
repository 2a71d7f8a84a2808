# SPDX-License-Identifier: GPL-3.0-or-later
"""Usage: python_test.py PROGRAM SOURCE LIBRARY. The Python package: the program's bytes, arrays of all kinds, errors, Ctrl-C."""

import _thread
import json
import os
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
import unittest.mock

PROGRAM, SOURCE, LIBRARY = sys.argv[1:4]
os.environ["NOOK_LIBRARY"] = LIBRARY
sys.path.insert(0, os.path.join(SOURCE, "python"))

import numpy as np

import nook


def cube():
    """Corners and triangles of a box with outward normals inside a larger floor."""
    V = np.array([[x, y, z] for x in (-1, 1) for y in (0, 2) for z in (-1, 1)] + [[-5, 0, 5], [5, 0, 5], [5, 0, -5], [-5, 0, -5]], dtype=np.float64)
    F = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
         [8, 9, 10], [8, 10, 11]]
    return V, np.array(F)


class Bytes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def program(self, ending, *words):
        path = os.path.join(self.folder.name, "out" + ending)
        subprocess.run([PROGRAM, *words, "-o", path], check=True, stdout=subprocess.DEVNULL)
        with open(path, "rb") as file:
            return file.read()

    def test_pattern(self):
        made = nook.pattern("disk", 9, starts=2)
        self.assertEqual(made.file(".json"), self.program(".json", "pattern", "--domain", "disk", "--count", "9", "--starts", "2"))
        self.assertEqual(made.points.shape, (9, 2))
        self.assertAlmostEqual(made.weights.sum(), 1.0, places=6)
        np.testing.assert_array_equal(np.float32(json.loads(made.file(".json"))["points"]), made.points)

    def test_tile(self):
        base = nook.pattern("ball", 4, starts=2)
        path = os.path.join(self.folder.name, "pattern.json")
        base.save(path)
        tile = nook.tile(base, 2, starts=1)
        self.assertEqual(tile.file(".json"), self.program(".json", "tile", "--pattern", path, "--size", "2", "--starts", "1"))
        self.assertEqual(tile.points.shape, (4, 4, 3))
        with self.assertRaises(nook.Error):
            base.save(os.path.join(self.folder.name, "pattern.glb"))
        self.assertFalse(os.path.exists(os.path.join(self.folder.name, "pattern.glb")))

    def test_another_library(self):
        source, library = os.path.join(self.folder.name, "other.c"), os.path.join(self.folder.name, "libnook.so.1")
        with open(source, "w") as file:
            file.write('int nook_require(unsigned abi) { return abi == 1 ? 9 : 0; }\nconst char *nook_version(void) { return "9"; }\n'
                       'const char *nook_error(void) { return "another version"; }\n')
        for flags, words in (([], "another version"), (["-Dnook_error=nook_other"], "found no function nook_error")):
            subprocess.run(["cc", "-shared", "-fPIC", *flags, source, "-o", library], check=True)
            found = dict(os.environ, NOOK_LIBRARY=library, PYTHONPATH=os.path.dirname(os.path.dirname(nook.__file__)))
            done = subprocess.run([sys.executable, "-c", "import nook"], env=found, stderr=subprocess.PIPE, text=True)
            self.assertIn("ImportError", done.stderr)
            self.assertIn(words, done.stderr)

    def test_visibility(self):
        V, F = cube()
        obj = os.path.join(self.folder.name, "cube.obj")
        with open(obj, "w") as file:
            file.writelines("v %r %r %r\n" % tuple(row) for row in V.tolist())
            file.writelines("f %d %d %d\n" % tuple(row + 1) for row in F)
        rng = np.random.default_rng(1)
        points = rng.uniform(-4, 4, (200, 3)) * (1, 0, 1)
        normals = np.tile([0.0, 1.0, 0.0], (200, 1)) + rng.uniform(-0.3, 0.3, (200, 3))
        csv = os.path.join(self.folder.name, "points.csv")
        with open(csv, "w") as file:
            file.writelines(",".join(repr(number) for number in row) + "\n" for row in np.hstack([points, normals]).tolist())
        words = ("--radius", "3", "--rays", "64")
        expected = self.program(".csv", "reference", obj, "--points", csv, *words)
        for threads in (1, 2):
            made = nook.visibility(V, F, points, normals, radius=3, rays=64, threads=threads, output=".csv")
            self.assertEqual(made.file(".csv"), expected)
        self.assertEqual(nook.Level.load(obj).visibility(points, normals, 3, rays=64, output=".csv").file(".csv"), expected)
        # Strides, byte order and types: what numpy has.
        swapped = np.asfortranarray(points.astype(">f8"))
        self.assertEqual(nook.visibility(V[:, ::-1][:, ::-1], F.astype(np.uint16), swapped, normals, radius=3, rays=64, output=".csv").file(".csv"),
                         expected)

    def test_bake_of_arrays(self):
        V, F = cube()
        order = list(dict.fromkeys(F.ravel().tolist()))  # by first use, as files are read
        V, F = V[order], np.argsort(order)[F]
        glb = os.path.join(self.folder.name, "cube.glb")
        data = V.astype("<f4").tobytes() + F.astype("<u4").tobytes()
        scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "buffers": [{"byteLength": len(data)}],
                 "bufferViews": [{"buffer": 0, "byteLength": V.size * 4}, {"buffer": 0, "byteOffset": V.size * 4, "byteLength": F.size * 4}],
                 "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(V), "type": "VEC3", "min": V.min(0).tolist(),
                                "max": V.max(0).tolist()}, {"bufferView": 1, "componentType": 5125, "count": F.size, "type": "SCALAR"}]}
        text = json.dumps(scene).encode()
        text += b" " * (-len(text) % 4)
        with open(glb, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data)
        baked = nook.bake(V, F, radius=3, rays=32)
        self.assertEqual(baked.visibility.shape, (len(V),))
        np.testing.assert_array_equal(baked.visibility, nook.Level.load(glb).bake(radius=3, rays=32).visibility)
        # One more vertex, which no triangle uses.
        more = nook.bake(np.vstack([[[9, 9, 9]], V]), F + 1, radius=3, rays=32).visibility
        self.assertTrue(np.isnan(more[0]))
        np.testing.assert_array_equal(more[1:], baked.visibility)

    def test_bake_and_volumes(self):
        level = nook.Level.load("builtin:cornell")
        self.assertEqual(level.bake(radius=1, rays=32, bent=True, output=".glb").file(".glb"),
                         self.program(".glb", "bake", "builtin:cornell", "--radius", "1", "--rays", "32", "--bent"))
        self.assertEqual(level.bake(radius=1, rays=6, probes=0.5, output=".ktx2").file(".ktx2"),
                         self.program(".ktx2", "bake", "builtin:cornell", "--radius", "1", "--rays", "6", "--probes", "0.5"))
        volumes = level.volumes(distance=0.5)
        self.assertEqual(volumes.file(".glb"), self.program(".glb", "volumes", "builtin:cornell", "--distance", "0.5"))
        self.assertEqual(volumes.corner_count.sum(), len(volumes.corners))
        self.assertEqual(volumes.facts["verb"], "volumes")

    def test_pictures(self):
        level = nook.Level.load("builtin:cornell")
        pixels = level.gbuffer(size=(64, 48), output=".exr")
        exr = os.path.join(self.folder.name, "g.exr")
        with open(exr, "wb") as file:
            file.write(self.program(".exr", "gbuffer", "builtin:cornell", "--size", "64x48"))
        with open(exr, "rb") as file:
            self.assertEqual(pixels.file(".exr"), file.read())
        words = ("--radius", "0.3", "--bent")
        drawn = nook.shade(pixels, method="slices", radius=0.3, bent=True, output=[".exr"])
        self.assertEqual(drawn.file(".exr"), self.program(".exr", "shade", exr, "--method", "slices", *words))
        camera = [pixels.projection.reshape(4, 4).T, pixels.world_to_camera.reshape(4, 4).T]
        again = nook.shade(pixels.depth, pixels.normals, camera, method="slices", radius=0.3)
        np.testing.assert_array_equal(again.visibility, drawn.visibility)
        self.assertGreater(float(nook.compare(np.ones_like(again.visibility), again.visibility).rmse), 0.0)
        self.assertEqual(float(nook.compare(again.visibility, again.visibility).max), 0.0)

    def test_emit(self):
        base = nook.pattern("disk", 5, starts=1)
        path = os.path.join(self.folder.name, "pattern.json")
        base.save(path)
        made = nook.emit("vo-line", base, glsl=330)
        self.assertEqual(made.file(".glsl"), self.program(".glsl", "emit", "--methods", "vo-line", "--patterns", path, "--glsl", "330"))


class Errors(unittest.TestCase):
    def failure(self, call, status):
        with self.assertRaises(nook.Error) as caught:
            call()
        self.assertEqual(caught.exception.status, status)
        return str(caught.exception)

    def test_options(self):
        self.assertIn("--count: found '0'", self.failure(lambda: nook.pattern("disk", 0), 1))
        self.failure(lambda: nook.pattern("disk", 4, colour="red"), 1)
        self.failure(lambda: nook.Level.load("/nowhere.glb"), 2)

    def test_arrays(self):
        V, F = cube()
        points = np.zeros((1, 3))
        self.failure(lambda: nook.Level(np.where(V == 2, np.nan, V), F), 3)
        self.failure(lambda: nook.Level(V, F + 1), 3)
        self.failure(lambda: nook.Level(V, F.astype(float)), 1)
        self.failure(lambda: nook.visibility(V, F, points, points, radius=1), 3)  # no direction
        self.failure(lambda: nook.visibility(V, F, np.ones((2, 3)), np.ones((1, 3)), radius=1), 1)
        with self.assertRaises(TypeError):
            nook.Level(np.array([["a", "b", "c"]]), F)
        with self.assertRaises(ValueError):
            nook.Level(V[:, :2], F)
        self.failure(lambda: nook.shade(np.full((4, 4), np.nan), None, np.eye(4)), 3)

    def test_results_outlive_their_owners(self):
        points = nook.pattern("disk", 9, starts=1).points
        copy = points.copy()
        for _ in range(20):
            nook.pattern("disk", 9, starts=1, seed=2)
        np.testing.assert_array_equal(points, copy)
        self.assertFalse(points.flags.writeable)

    def test_progress(self):
        told = []
        nook.pattern("disk", 6, starts=2, progress=lambda stage, share: told.append((stage, share)))
        self.assertTrue(told and all(0 <= share <= 1 for _, share in told))

        def refuse(_stage, _share):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            nook.pattern("disk", 6, progress=refuse)
        with self.assertRaisesRegex(RuntimeError, "enough"):
            nook.Level.load("builtin:cornell").bake(radius=1, progress=refuse)

    def interrupted(self, progress, start):
        """Ctrl-C ends a bake, which would take many minutes, and its threads; `start` is that of the thread that it runs in."""
        told = []

        def tell(stage, share):
            if stage == "rays":
                told.append(share)
                progress()

        level = nook.Level.load("builtin:courtyard")
        with unittest.mock.patch.object(threading.Thread, "start", start), self.assertRaises(KeyboardInterrupt):
            level.bake(radius=float("inf"), rays=4096, progress=tell)
        self.assertLess(max(told, default=0.0), 0.5)
        ended = len(told)
        level.bake(radius=1, rays=1)
        self.assertEqual(len(told), ended)

    def test_interrupt(self):
        # From a callback, so that it comes in time, however slow the machine is.
        asked = []

        def interrupt():
            if not asked:
                asked.append(True)
                _thread.interrupt_main()

        # A shell's background jobs ignore the signal, and Python then raises nothing.
        handler = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, handler)
        self.interrupted(interrupt, threading.Thread.start)

    def test_interrupt_at_start(self):
        start = threading.Thread.start

        def interrupt(thread):
            start(thread)
            raise KeyboardInterrupt

        self.interrupted(lambda: None, interrupt)

    def test_threads(self):
        level = nook.Level.load("builtin:cornell")
        found = []

        def work():
            found.append(level.visibility([[0, 0.5, 0]], [[0, 1, 0]], radius=1).visibility[0])

        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(set(found)), 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
