# SPDX-License-Identifier: GPL-3.0-or-later
"""The C API through ctypes: finding libnook, arrays, handles and errors."""

import ctypes
import glob
import os
import weakref

import numpy as np

ABI = 1
PROGRESS = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_double)
TYPES = {np.dtype(name): number + 1 for number, name in
         enumerate(("float32", "float64", "uint8", "int32", "uint32", "int64", "uint64"))}
_DTYPES = {number: dtype for dtype, number in TYPES.items()}


class Array(ctypes.Structure):
    """struct nook_array."""

    _fields_ = [("data", ctypes.c_void_p), ("type", ctypes.c_int32), ("dimensions", ctypes.c_int32),
                ("shape", ctypes.c_uint64 * 4)]


class Error(Exception):
    """A call that failed; `status` is the program's exit code: 1 usage, 2 file, 3 invalid input, 4 failed, 5 unsupported."""

    DIFFERENCE = 7
    CANCELLED = 8

    def __init__(self, status, message):
        super().__init__(message)
        self.status = status


class Handle:
    """Destroys what it holds when nobody refers to it any more."""

    def __init__(self, value, destroy):
        self.value = value
        weakref.finalize(self, destroy, value)


def check(status):
    """Raises an Error unless a call succeeded."""
    if status != 0:
        raise Error(status, _loaded.nook_error().decode())


def pointer(array):
    """A nook_array of a numpy array, which the caller keeps; null for None."""
    if array is None:
        return None
    given = Array(array.ctypes.data, TYPES[array.dtype], array.ndim)
    if array.ndim > 4:
        raise ValueError(f"found {array.ndim} dimensions, expected at most 4")
    for i in range(array.ndim):
        given.shape[i] = array.shape[i]
    given.owner = array  # not of the structure: keeps the memory
    return ctypes.pointer(given)


def view(given, handle):
    """A numpy array of the library's memory, without a copy; it keeps `handle`."""
    dtype = _DTYPES[given.type]
    shape = tuple(given.shape[:given.dimensions])
    count = int(np.prod(shape, dtype=np.int64)) if shape else 1
    if count == 0:
        return np.empty(shape, dtype)
    memory = (ctypes.c_char * (count * dtype.itemsize)).from_address(given.data)
    memory.owner = handle
    array = np.frombuffer(memory, dtype).reshape(shape)
    array.flags.writeable = False
    return array if shape else array[()]


def _candidates():
    """NOOK_LIBRARY, the wheel's own library, then the system's."""
    given = os.environ.get("NOOK_LIBRARY")
    if given:
        return [given]
    here = os.path.dirname(os.path.abspath(__file__))
    return sorted(glob.glob(os.path.join(here, "lib", f"libnook.so.{ABI}"))) + [f"libnook.so.{ABI}"]


def load():
    """The library, with the types of its functions. Raises ImportError."""
    global _loaded
    failures = []
    for path in _candidates():
        try:
            library = ctypes.CDLL(path)
            break
        except OSError as failure:
            failures.append(str(failure))
    else:
        raise ImportError("nook: found no library that loads, expected libnook.so." + str(ABI) + " (NOOK_LIBRARY): " +
                          "; ".join(failures))
    text, handle, out = ctypes.c_char_p, ctypes.c_void_p, ctypes.POINTER(ctypes.c_void_p)
    array = ctypes.POINTER(Array)
    for name, result, arguments in (
            ("require", ctypes.c_int32, [ctypes.c_uint32]),
            ("version", text, []),
            ("error", text, []),
            ("options_create", ctypes.c_int32, [out]),
            ("options_destroy", None, [handle]),
            ("options_set", ctypes.c_int32, [handle, text, text]),
            ("options_file", ctypes.c_int32, [handle, text, text, text, ctypes.c_size_t]),
            ("options_progress", ctypes.c_int32, [handle, PROGRESS, ctypes.c_void_p]),
            ("level_create", ctypes.c_int32, [array, array, array, array, handle, out]),
            ("level_load", ctypes.c_int32, [text, handle, out]),
            ("level_describe", ctypes.c_int32, [handle, out]),
            ("level_destroy", None, [handle]),
            ("run_pattern", ctypes.c_int32, [handle, out]),
            ("run_tile", ctypes.c_int32, [handle, out]),
            ("run_emit", ctypes.c_int32, [handle, out]),
            ("run_visibility", ctypes.c_int32, [handle, array, array, handle, out]),
            ("run_bake", ctypes.c_int32, [handle, handle, out]),
            ("run_volumes", ctypes.c_int32, [handle, handle, out]),
            ("run_gbuffer", ctypes.c_int32, [handle, handle, out]),
            ("run_shade", ctypes.c_int32, [array, array, array, array, handle, out]),
            ("run_compare", ctypes.c_int32, [array, array, array, handle, out]),
            ("result_array", ctypes.c_int32, [handle, text, array]),
            ("result_name", text, [handle, ctypes.c_size_t]),
            ("result_file", ctypes.c_int32, [handle, text, out, ctypes.POINTER(ctypes.c_size_t)]),
            ("result_facts", ctypes.c_int32, [handle, ctypes.POINTER(text), ctypes.POINTER(text)]),
            ("result_destroy", None, [handle])):
        function = getattr(library, "nook_" + name, None)
        if function is None:
            raise ImportError(f"nook: {path}: found no function nook_{name}, expected a library with NOOK_ABI {ABI}")
        function.restype, function.argtypes = result, arguments
        if name == "error" and library.nook_require(ABI) != 0:
            raise ImportError(library.nook_error().decode())
    _loaded = library
    return library


_loaded = None
