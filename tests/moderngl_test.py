# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: moderngl_test.py PROGRAM SOURCE. Runs the script "In moderngl" of docs/reference/modules.md, and counts its lines: no pixel of
# its picture differs from that of nook shade by more than 1/255. Counts the lines of "WGSL" as well. Exit code 77: no moderngl, OpenGL
# or oiiotool.
import array
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile

nook, source = (os.path.realpath(path) for path in sys.argv[1:3])
try:
	import moderngl
	ctx = moderngl.create_context(standalone=True, backend="egl")
except Exception as fault:
	print(f"skipped: found no moderngl that draws ({fault}), expected Debian's package python3-moderngl (scripts/setup.sh moderngl)")
	sys.exit(77)
if shutil.which("oiiotool") is None:
	print("skipped: found no oiiotool, expected Debian's package openimageio-tools")
	sys.exit(77)

SIZE = WIDTH, HEIGHT = 160, 90
PROJECTION = [1.2, 0, 0, 0, 0, 1.2 * WIDTH / HEIGHT, 0, 0, 0, 0, -1, -1, 0, 0, -0.2, 0]
failures = 0


def check(holds, what):
	global failures
	failures += 0 if holds else 1
	print("" if holds else f"FAILED: {what}\n", end="")


# The lines of a script, without comments, blank lines, and lines of closing marks alone.
def lines_of(script):
	return [line for line in script.splitlines() if line.strip() and not re.fullmatch(r"\s*([#/].*|[)}\]; ]+)", line)]


def run(*words):
	subprocess.run([nook, *words], check=True, stdout=subprocess.DEVNULL)


# {channel: rows from the bottom, as OpenGL has them, of 32-bit floats}.
def read_exr(path):
	subprocess.run(["oiiotool", path, "-d", "float", "--compression", "none", "-o", "plain.exr"], check=True)
	data = open("plain.exr", "rb").read()
	names, at = [], 8
	while data[at] != 0:
		name, kind, rest = data[at:].split(b"\0", 2)
		at = len(data) - len(rest) + 4
		if name == b"channels":
			names = re.findall(rb"([A-Za-z_.]+)\x00\x02\x00\x00\x00", data[at:at + struct.unpack_from("<i", data, at - 4)[0]])
		at += struct.unpack_from("<i", data, at - 4)[0]
	rows = [struct.unpack_from(f"<{WIDTH * len(names)}f", data, offset + 8) for offset in struct.unpack_from(f"<{HEIGHT}Q", data, at + 1)]
	return {name.decode(): [value for row in reversed(rows) for value in row[i * WIDTH:(i + 1) * WIDTH]] for i, name in enumerate(names)}


page = open(f"{source}/docs/reference/modules.md", encoding="utf-8").read()
script = re.search(r"### In moderngl.*?```python\n(.*?)```", page, re.S)[1]
command = re.search(r"### In moderngl.*?```sh\nnook (.*?)\n```", page, re.S)[1]
with tempfile.TemporaryDirectory() as folder:
	os.chdir(folder)
	sys.path.insert(0, folder)
	run("pattern", "--domain", "disk", "--count", "3", "--starts", "1", "-o", "disk.json")
	run("tile", "--pattern", "disk.json", "--size", "4", "--kind", "random", "-o", "tile.json")
	run(*command.split())
	numbers = " ".join(map(str, PROJECTION))
	run("gbuffer", "builtin:courtyard", "--size", f"{WIDTH}x{HEIGHT}", "--projection", numbers, "-o", "g.exr")
	run("shade", "g.exr", "--method", "vo-line", "--pattern", "tile.json", "--filter", "window", "--radius", "1.5", "-o", "shade.exr")
	scene = read_exr("g.exr")
	depths = ctx.texture(SIZE, 1, array.array("f", [min(depth, 1e30) for depth in scene["Z"]]), dtype="f4")
	normals = ctx.texture(SIZE, 3, array.array("f", [part for normal in zip(scene["N.X"], scene["N.Y"], scene["N.Z"]) for part in normal]), dtype="f4")
	visibility = ctx.texture(SIZE, 1, dtype="f4")
	exec(script, {"ctx": ctx, "projection": PROJECTION, "depths": depths, "normals": normals, "visibility": visibility})
	found = array.array("f", visibility.read())
	expected = read_exr("shade.exr")["visibility"]
	apart = [abs(a - b) for a, b in zip(found, expected)]
	beyond = sum(one > 1 / 255 for one in apart)
	check(len(apart) == WIDTH * HEIGHT and beyond == 0, f"found {beyond} pixels beyond 1/255, at most {max(apart)}")
	check(min(expected) < 0.8, "found a picture without dark pixels")
	print(f"greatest difference {max(apart):.6f}")

for name, lines, most in [("moderngl", script, 15), ("WGSL", re.search(r"## WGSL.*?```js\n(.*?)```", page, re.S)[1], 25)]:
	count = len(lines_of(lines))
	check(0 < count <= most, f"{name}: found {count} lines, expected at most {most}")
	print(f"{name}: {count} lines")
sys.exit(1 if failures else 0)
