# SPDX-License-Identifier: GPL-3.0-or-later
"""nook in Python: sample patterns, visibility by rays, bakes, occlusion volumes and screen-space methods on numpy arrays.

Functions take and return numpy arrays. Keyword arguments are the options of the program with underscores for dashes
(``max_error=0.01`` for ``--max-error 0.01``); the bytes are the program's. Units: metres, y up, radians only where a name says so;
visibility is 1 where open. Triangles are counter-clockwise seen from the front.

Every function takes ``threads`` (default: all processors), ``output``, endings of files that the result shall have (".json", or a
list), and ``progress``, called as ``progress(stage, share)``: an exception in it, and Ctrl-C, stop the work. ``Error.status`` has
the program's exit codes.
"""

import ctypes
import json
import os
import threading

import numpy as np

from . import _library

__all__ = ["Error", "Level", "Result", "bake", "compare", "emit", "gbuffer", "pattern", "shade", "tile", "version", "visibility"]

_lib = _library.load()
Error = _library.Error


def version():
    """The library's version, such as "0.1.0"."""
    return _lib.nook_version().decode()


def _given(array, name, columns=None):
    """An array as the library takes it: C-contiguous numbers of 32 or 64 bits, or bytes; a copy only of others."""
    array = np.asarray(array)
    if columns is not None and (array.ndim != 2 or array.shape[1] != columns):
        raise ValueError(f"{name}: found shape {array.shape}, expected (n, {columns})")
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{name}: found {array.dtype}, expected numbers")
    dtype = array.dtype.newbyteorder("=")
    if dtype not in _library.TYPES:
        dtype = np.dtype({"f": np.float64, "b": np.uint8}.get(dtype.kind, np.int32))
    return np.ascontiguousarray(array, dtype)


class Result:
    """Arrays by name, ``result["visibility"]`` or ``result.visibility``, and the files that the program writes.

    Arrays are views of the library's memory, which lives as long as one of them does.
    """

    def __init__(self, handle):
        self._handle = _library.Handle(handle, _lib.nook_result_destroy)
        self._arrays = {}
        for index in range(1 << 16):
            name = _lib.nook_result_name(handle, index)
            if name is None:
                break
            given = _library.Array()
            _library.check(_lib.nook_result_array(handle, name, ctypes.byref(given)))
            self._arrays[name.decode()] = _library.view(given, self._handle)

    def __getitem__(self, name):
        return self._arrays[name]

    def __getattr__(self, name):
        if name.startswith("_") or name not in self._arrays:
            raise AttributeError(name)
        return self._arrays[name]

    def __contains__(self, name):
        return name in self._arrays

    def keys(self):
        """Names of the arrays."""
        return self._arrays.keys()

    @property
    def facts(self):
        """What the program writes with --json, as a dictionary."""
        text = ctypes.c_char_p()
        _library.check(_lib.nook_result_facts(self._handle.value, ctypes.byref(text), None))
        return json.loads(text.value)

    @property
    def warnings(self):
        """A list of lines."""
        text = ctypes.c_char_p()
        _library.check(_lib.nook_result_facts(self._handle.value, None, ctypes.byref(text)))
        return text.value.decode().splitlines()

    def file(self, ending):
        """Bytes of the program's file with this ending, one of the call's ``output``."""
        data, size = ctypes.c_void_p(), ctypes.c_size_t()
        _library.check(_lib.nook_result_file(self._handle.value, ending.encode(), ctypes.byref(data), ctypes.byref(size)))
        return ctypes.string_at(data.value, size.value)

    def save(self, path):
        """Writes a file, whose ending is one of the call's ``output``."""
        content = self.file(os.path.splitext(path)[1])
        with open(path, "wb") as file:
            file.write(content)


class _Options:
    """Options of one call, and the call itself."""

    def __init__(self, options):
        self.failure = None
        self.cancelled = False
        self._callback = None
        handle = ctypes.c_void_p()
        _library.check(_lib.nook_options_create(ctypes.byref(handle)))
        self.handle = _library.Handle(handle.value, _lib.nook_options_destroy)
        self._progress = options.pop("progress", None)
        for name, value in options.items():
            self._set(name.rstrip("_").replace("_", "-"), value)

    def _set(self, name, value):
        if value is None:
            return
        if isinstance(value, (list, tuple, np.ndarray)) and name in ("projection", "world-to-camera"):
            # 4 x 4 in numpy's order: rows; the program takes columns.
            value = ",".join(repr(float(number)) for number in np.asarray(value, dtype=np.float64).T.ravel())
        elif isinstance(value, (list, tuple, np.ndarray)) and name in ("eye", "target"):
            value = ",".join(repr(float(number)) for number in value)
        if isinstance(value, (list, tuple)):
            for one in value:
                self._set(name, one)
        elif isinstance(value, Result):
            ending = ".glb" if name in ("volumes", "bake") else ".json"
            self._file(name, name.rstrip("s") + ending, value.file(ending))
        elif isinstance(value, bool):
            self._text(name, "true" if value else "false")
        elif isinstance(value, (float, np.floating)):
            self._text(name, "inf" if value == float("inf") else repr(float(value)))
        else:
            self._text(name, os.fspath(value) if isinstance(value, os.PathLike) else str(value))

    def _text(self, name, value):
        _library.check(_lib.nook_options_set(self.handle.value, name.encode(), value.encode()))

    def _file(self, name, file_name, data):
        _library.check(_lib.nook_options_file(self.handle.value, name.encode(), file_name.encode(), data, len(data)))

    def _tell(self, _user, stage, share):
        """Runs in threads of the library; what it returns cancels the call."""
        try:
            if self._progress is not None and not self.cancelled:
                self._progress(stage.decode(), share)
        except BaseException as failure:  # raised again by run()
            self.failure = failure
            self.cancelled = True
        return int(self.cancelled)

    def run(self, function, *arguments):
        """Calls `function` in a thread, so that Ctrl-C reaches this one and stops it; returns its handle."""
        main = threading.current_thread() is threading.main_thread()
        if self._progress is not None or main:
            self._callback = _library.PROGRESS(self._tell)
            _library.check(_lib.nook_options_progress(self.handle.value, self._callback, None))
        made = ctypes.c_void_p()
        answer = []
        done = threading.Event()  # after Ctrl-C in join(), Python 3.11 takes a running thread for one that ended

        def call():
            try:
                status = function(*arguments, self.handle.value, ctypes.byref(made))
                answer.append((status, _lib.nook_error().decode()))
            finally:
                done.set()

        if main:
            thread = threading.Thread(target=call, daemon=True)
            try:
                thread.start()
                while not done.wait(0.1):
                    pass
            except BaseException as interrupt:  # wherever it comes, the thread has to stop, and ends before its arrays do
                self.cancelled = True
                self.failure = interrupt
                if thread.ident is None:
                    raise
                done.wait()
        else:
            call()
        status, text = answer[0]
        if self.failure is not None:
            _lib.nook_result_destroy(made)  # finished in spite of it; a level is destroyed likewise
            raise self.failure
        if status != 0 and not (status == Error.DIFFERENCE and made.value):
            raise Error(status, text)
        return made.value


def _result(function, options, *arguments):
    return Result(_Options(options).run(function, *arguments))


def pattern(domain, count, **options):
    """A sample pattern.

    domain: "disk", "ball", "sphere" or "hemisphere"; count: 1 to 4096.
    Result: ``points`` (count, 2) for the disk, else (count, 3), in the unit disk or ball; ``weights`` (count,), sum 1.
    output: .json (default), .csv, .h, .glsl, .svg; tile() and emit() need .json.
    """
    return _result(_lib.nook_run_pattern, dict({"output": ".json"}, **options, domain=domain, count=count))


def tile(pattern, size, **options):
    """The variants of a pattern for the pixels of a blur window.

    pattern: a Result of pattern(), or a path; size: pixels across.
    Result: ``points`` (variants, count, 2 or 3), ``weights`` (variants, count); variants are row by row.
    """
    return _result(_lib.nook_run_tile, dict({"output": ".json"}, **options, pattern=pattern, size=size))


class Level:
    """Triangles in world space, metres, y up.

    V: (n, 3) positions; F: (m, 3) vertex indices. N: (n, 3) normals or None; UV: (n, 2) texture coordinates or None, v downward.
    strict: anything odd is an error; two_sided: triangles are seen from both sides; name: for files made of it.
    """

    def __init__(self, V, F, N=None, UV=None, **options):
        arrays = [_given(V, "V", 3), _given(F, "F", 3)]
        arrays += [None if array is None else _given(array, name, columns) for array, name, columns in ((N, "N", 3), (UV, "UV", 2))]
        self._take(_Options(options).run(_lib.nook_level_create, *[_library.pointer(array) for array in arrays]))

    def _take(self, handle):
        self._handle = _library.Handle(handle, _lib.nook_level_destroy)

    @classmethod
    def load(cls, path, **options):
        """A .gltf, .glb, .obj, .fbx, .ply or .stl file, or "builtin:NAME". Options: unit, up, strict, allow_outside, pose."""
        level = cls.__new__(cls)
        level._take(_Options(options).run(_lib.nook_level_load, os.fspath(path).encode()))
        return level

    @classmethod
    def of(cls, mesh, **options):
        """A level of a mesh of trimesh, or of anything with ``vertices`` and ``faces``."""
        return cls(mesh.vertices, mesh.faces, **options)

    def describe(self):
        """The level as it is used.

        Result: ``positions`` (n, 3), metres; ``triangles`` (m, 3), indices; ``normals`` (n, 3) and ``uvs`` (n, 2), where the level has
        them; ``facts["findings"]``.
        """
        made = ctypes.c_void_p()
        _library.check(_lib.nook_level_describe(self._handle.value, ctypes.byref(made)))
        return Result(made.value)

    def visibility(self, points, normals, radius, **options):
        """See nook.visibility()."""
        points, normals = _given(points, "points", 3), _given(normals, "normals", 3)
        return _result(_lib.nook_run_visibility, dict(options, radius=radius), self._handle.value, _library.pointer(points),
                       _library.pointer(normals))

    def bake(self, radius, **options):
        """See nook.bake()."""
        return _result(_lib.nook_run_bake, dict(options, radius=radius), self._handle.value)

    def volumes(self, distance, **options):
        """Occlusion volumes.

        distance: how far a polygon darkens what lies before it, metres.
        Result: ``corners`` (n, 3), metres; per polygon (m,) ``first_corner`` and ``corner_count``, indices into them, and ``alpha``,
        opacity from 0 to 1.
        output: .glb (default).
        """
        return _result(_lib.nook_run_volumes, dict({"output": ".glb"}, **options, distance=distance), self._handle.value)

    def gbuffer(self, size=(1280, 720), **options):
        """Depth and normals from a camera: ``camera="name"`` or "auto:1", ``eye`` and ``target``, or ``world_to_camera`` and
        ``projection`` (4, 4).

        size: width and height in pixels.
        Result: ``depth`` (height, width), metres, infinite for sky; ``normals`` (height, width, 3), view space; ``projection`` and
        ``world_to_camera``, 16 numbers column by column. output: .exr.
        """
        return _result(_lib.nook_run_gbuffer, dict(options, size=f"{size[0]}x{size[1]}"), self._handle.value)


def _level(V, F, options):
    """A level of a mesh; takes its options out of those of a call."""
    own = {name: options.pop(name) for name in ("N", "UV", "name", "strict", "two_sided") if name in options}
    return Level(V, F, **own, threads=options.get("threads"))


def visibility(V, F, points, normals, radius, **options):
    """Visibility by rays at points of a mesh.

    V: (n, 3); F: (m, 3); points: (k, 3), metres; normals: (k, 3), of any length; radius: length of the rays, metres or inf.
    Options: rays (256), measure ("obscurance", "bent", "sphere", "hemisphere"), falloff, max_error, lift, seed.
    Result: ``visibility``, ``standard_error``, ``rays`` (k,); with measure="bent" also ``bent`` (k, 3). output: .csv.
    """
    return _level(V, F, options).visibility(points, normals, radius, **options)


def bake(V, F, radius, **options):
    """Visibility at the vertices of a mesh, fitted to its surface.

    V: (n, 3); F: (m, 3); radius: length of the rays, metres or inf.
    Options: rays (256), fit, falloff, bent, max_error, probes, seed, two_sided; N (n, 3); texture with UV (n, 2).
    Result: ``visibility`` (n,), NaN for vertices without a triangle; with bent=True ``bent`` (n, 3). output: .glb; with probes .ktx2, .glsl.
    """
    return _level(V, F, options).bake(radius, **options)


def gbuffer(V, F, **options):
    """Depth and normals of a mesh from a camera. See Level.gbuffer()."""
    return _level(V, F, options).gbuffer(**options)


def shade(depth, normals=None, camera=None, method="slices", **options):
    """Visibility by a screen-space method.

    depth: (height, width), metres along the view direction, infinite for sky, or a Result of gbuffer() in place of all three;
    normals: (height, width, 3), view space, or None: from the depth;
    camera: the projection, (4, 4), or a pair (projection, world_to_camera).
    Options: radius (0.5), pattern, filter, bent, volumes, bake, ...: as of the program.
    Result: ``visibility`` (height, width); with bent=True ``bent`` (height, width, 3). output: .exr, .png.
    """
    if isinstance(depth, Result):
        matrices = [depth["projection"], depth["world_to_camera"]]
        depth, normals = depth["depth"], depth["normals"]
    else:
        if camera is None:
            raise TypeError("camera: found none, expected a projection, or a pair of projection and world_to_camera")
        pair = camera if isinstance(camera, (tuple, list)) and len(camera) == 2 else (camera, np.eye(4))
        matrices = [np.asarray(matrix, dtype=np.float64).reshape(4, 4).T.ravel() for matrix in pair]
    if normals is None:
        options["normals"] = "from-depth"
    arrays = [_given(depth, "depth"), None if normals is None else _given(normals, "normals"), *matrices]
    return _result(_lib.nook_run_shade, dict(options, method=method), *[_library.pointer(array) for array in arrays])


def compare(test, reference, mask=None, **options):
    """Errors of one visibility picture against another, both (height, width).

    mask: (height, width), 0 where a pixel does not count, or None.
    Result: ``rmse``, ``mae``, ``mean_error``, ``p95``, ``max``, ``ssim``, ``flip``, ``eq14``, a number each.
    """
    arrays = [_given(test, "test"), _given(reference, "reference"), None if mask is None else _given(mask, "mask")]
    return _result(_lib.nook_run_compare, dict(options), *[_library.pointer(array) for array in arrays])


def emit(methods, patterns=(), **options):
    """A shader module.

    methods: a list of names. patterns: Results of pattern() or tile(), or paths, one for each method that takes samples.
    A language is required: ``glsl=330`` (430, "es300", "vulkan"), ``hlsl=60`` or ``wgsl=True``.
    output: .glsl (default), .hlsl, .wgsl; .h, .js, .cs, .py, .json.
    """
    if isinstance(methods, (list, tuple)):
        methods = ",".join(methods)
    patterns = patterns if isinstance(patterns, (list, tuple)) else [patterns]
    return _result(_lib.nook_run_emit, dict({"output": ".glsl"}, **options, methods=methods, patterns=patterns))
