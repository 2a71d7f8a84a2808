#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the tables and the plot of docs/measurements/gpu.md again.

usage: page.py NOOK FOLDER [--rays SCENES CACHE] [--caches]     FOLDER holds nook_gpu_cost and nook_caches, build/release/tests
       page.py NOOK FOLDER --check                              compares costs with the page: exit code 7 if they differ, 77 if
                                                                there is no driver, or another than the page's
Without --rays the page keeps its errors, without --caches its bytes, and new rows have none.
"""
import itertools
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

import gpu_cost
import rays

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
PAGE = os.path.join(ROOT, "docs/measurements/gpu.md")
PLOT = os.path.join(ROOT, "docs/pictures/gpu_front.svg")

# Patterns of the catalogue. Those that are no tiles are made into tiles of 4 x 4.
PATTERNS = {"disk3": "disk/disk_003.json", "disk9": "disk/disk_009_tile4.json",
            "ball12": "ball/ball_012.json", "hemisphere9": "hemisphere/hemisphere_009.json"}
FILTER = {"nookBilateralX": 1, "nookBilateralY": 1}
HALF = {"nookBilateralX": 0.25, "nookBilateralYOfSurface": 0.25, "nookUpsample": 1}
# Tables of half the width and height at 1280 x 720: four of them, each summed in 4 + 3 steps; 8 x 8 pixels share a range and a slope.
TABLES = {"nookStatRange": 2 / 64, "nookStatCells": 4 / 4, "nookTableSum": 4 * 7 / 4,
          "nookStatSlopes": 1 / 64, "nookStatFlags": 1 / 64, "nookStatVo": 1}
# Name, method, pattern, options of emit and of shade, passes with the share of the picture's pixels that they draw; 0: the method
# without what a filter needs, for comparison.
METHODS = [
    ("lines 3 × 3", "vo-line", "disk3", "", {"nookVoLine": 0, "nookVoLineLinked": 1, **FILTER}),
    ("lines 3 × 9", "vo-line", "disk9", "", {"nookVoLineLinked": 1, **FILTER}),
    ("lines 9, one radius", "vo-line", "disk9", "--recipe paper", {"nookVoLine": 0, "nookVoLineLinked": 1, **FILTER}),
    ("points 12", "vo-point", "ball12", "", {"nookVoPointLinked": 1, **FILTER}),
    ("areas 3 × 3", "vo-area", "disk3", "", {"nookMoments": 1 / 3, "nookVoAreaLinked": 1, **FILTER}),
    ("areas 9, one radius", "vo-area", "disk9", "--recipe paper",
     {"nookMoments": 1 / 3, "nookVoArea": 0, "nookVoAreaLinked": 1, **FILTER}),
    ("Alchemy 9", "alchemy", "hemisphere9", "", {"nookAlchemy": 0, "nookAlchemyLinked": 1, **FILTER}),
    ("StatVO, 4 layers, half tables", "statvo", "", "--tables half", TABLES),
    ("slices 1 × 2", "slices", "", "--slice-steps 2", {"nookSlicesLinked": 1, **FILTER}),
    ("slices 1 × 3", "slices", "", "--slice-steps 3", {"nookSlicesLinked": 1, **FILTER}),
    ("slices 1 × 4", "slices", "", "", {"nookSlices": 0, "nookSlicesLinked": 1, **FILTER}),
    ("slices 3 × 6", "slices", "", "--slices 3 --slice-steps 6", {"nookSlices": 0, "nookSlicesLinked": 1, **FILTER}),
    ("lines 3 × 3, half", "vo-line", "disk3", "--resolution half", {"nookVoLineLinked": 0.25, **HALF}),
    ("slices 1 × 4, half", "slices", "", "--resolution half", {"nookSlicesLinked": 0.25, **HALF}),
    ("slices 3 × 6, half", "slices", "", "--slices 3 --slice-steps 6 --resolution half", {"nookSlicesLinked": 0.25, **HALF}),
]
# Cycles of all passes with the rivals' own shaders, compiled in the same way; errors are of nook's versions with these options.
RIVALS = [(f"XeGTAO {name}, {slices} × {steps}", f"gtao --gtao-slices {slices} --gtao-steps {steps}", cycles)
          for name, slices, steps, cycles in (("Low", 1, 2, 912), ("Medium", 2, 2, 1326), ("High", 3, 3, 2112), ("Ultra", 9, 3, 5280))]
RIVALS += [("HBAO 8 × 4", "hbao --hbao-directions 8 --hbao-steps 4", 1828), ("HBAO 6 × 6", "hbao --hbao-directions 6 --hbao-steps 6", 2002)]
RADII = (16, 48, 120, 240)


def skip(why):
    print(f"page.py: skipped: {why}")
    sys.exit(77)


def patterns(nook, folder):
    files = {"": ""}
    for name, path in PATTERNS.items():
        files[name] = os.path.join(ROOT, "patterns", path)
        if "tile" not in path:
            tile = os.path.join(folder, f"{name}.json")
            rays.run(nook, "tile", "--pattern", files[name], "--size", 4, "-o", tile)
            files[name] = tile
    return files


def no_sky(module):
    """The compiler counts code that pixels may skip as three quarters of itself. Without this test they skip only samples."""
    return module.replace("if (depth >= NOOK_SKY)", "if (false)")


def volume_stage(module, stage, corners):
    """A stage of the volumes, in Vulkan's GLSL, for polygons with that many corners and surfaces within the volume."""
    text = module.replace("gl_VertexID", "gl_VertexIndex")
    if stage == "FRAGMENT":
        text = text.replace("nook_polygon.y", str(corners))
    for i, name in enumerate(("nook_polygon", "nook_front", "nook_offset", "nook_step")):
        text = re.sub(rf"^flat (in|out) (\w+ {name};)", rf"layout(location = {i}) flat \1 \2", text, flags=re.M)
    return f"#version 450\n#extension GL_EXT_control_flow_attributes : enable\n#define NOOK_{stage}\n{gpu_cost.unrolled(text)}"


def measure(nook, tool, files, folder):
    """Costs by method and pass, each with the cycles without the test for sky as "surface"."""
    shaders, keys = [], []
    for name, method, pattern, options, passes in METHODS:
        module = os.path.join(folder, "module.glsl")
        filters = [] if method == "statvo" else ["--filter", "bilateral"]
        given = ["--patterns", files[pattern]] if pattern else []
        rays.run(nook, "emit", "--methods", method, *given, *filters, *options.split(), "--glsl", "vulkan", "-o", module)
        with open(module) as file:
            text = file.read()
        for function in passes:
            keys.append((name, function))
            shaders += [("frag", gpu_cost.pixel_shader(text, function)), ("frag", gpu_cost.pixel_shader(no_sky(text), function))]
    for method, name in (("aov", "volumes"), ("aov-mask", "masks of 128 directions")):
        module = os.path.join(folder, "module.glsl")
        rays.run(nook, "emit", "--methods", method, "--glsl", "430", "-o", module)
        with open(module) as file:
            text = file.read()
        for stage, does in (("FRAGMENT", "a volume's fragment"), ("RESOLVE", "resolve"), ("SPARSE", "interpolation")):
            keys.append((name, does))
            vertex = [volume_stage(text, "VERTEX", 4)] if stage == "FRAGMENT" else []
            shaders += [("frag", volume_stage(each, stage, 4), *vertex) for each in (text, no_sky(text))]
    found = gpu_cost.costs(tool, shaders)
    return {key: {**cost, "surface": other["cycles"]} for key, cost, other in zip(keys, found[::2], found[1::2])}


def slice_reads(radius, steps):
    """Offsets in pixels of the reads of one slice for each variant, as nookSlice in slices.glsl places them."""
    for own in range(16):
        x, y = own % 4, own // 4
        variant = 4 * (2 * ((x + y) % 2) + y % 2) + 2 * ((x // 2 + y // 2) % 2) + y // 2
        jitter = (8 * (variant % 2) + 4 * (variant // 2 % 2) + 2 * (variant // 4 % 2) + variant // 8 + 0.5) / 16
        angle, first = (variant + 0.5) / 16 * math.pi, 1.3 / max(radius, 1.3)
        reads = []
        for k in range(2 * steps):
            share = (k // 2 + (jitter + 0.5 * (k % 2)) % 1) / steps
            place = (first + (1 - first) * share**3) * radius * (1 if k % 2 == 0 else -1)
            reads.append((math.cos(angle) * place, -math.sin(angle) * place))
        yield reads


def tile_reads(path, radii):
    with open(path) as file:
        variants = gpu_cost.json.load(file)["variants"]
    return [[(point[0] * radius, -point[1] * radius) for radius in radii for point in variant["points"]] for variant in variants]


def bytes_table(tool, files):
    methods = {"lines 3 × 3": lambda r: tile_reads(files["disk3"], (0.522 * r, 0.138 * r, 0.034 * r)),
               "lines 9, one radius": lambda r: tile_reads(files["disk9"], (r,)),
               "Alchemy 9": lambda r: tile_reads(files["hemisphere9"], (r,)), "slices 1 × 4": lambda r: list(slice_reads(r, 4))}
    rows = [(name, layout, bits) for name in methods for layout, bits in (("plain", 32), ("plain", 16), ("levels", 16), ("deinterleaved", 16))]
    cases = [f"{layout} {bits} {1 + len(reads[0])} " + " ".join(f"0 0 {' '.join(f'{x} {y}' for x, y in variant)}" for variant in reads)
             for name, layout, bits in rows for reads in map(methods[name], RADII)]
    found = subprocess.run([tool], input="\n".join(cases), capture_output=True, text=True, check=True).stdout.split()
    table = [f"| method | depth | {' | '.join(f'{radius} px' for radius in RADII)} |", "| --- " * (2 + len(RADII)) + "|"]
    for i, (name, layout, bits) in enumerate(rows):
        depth = f"{bits} bits" + ("" if layout == "plain" else f", {layout}")
        table.append(f"| {name} | {depth} | {' | '.join(found[len(RADII) * i:len(RADII) * (i + 1)])} |")
    return "\n".join(table)


def plot(rows):
    """Cycles against RMSE: rows of (name, cycles, RMSE, is a rival)."""
    def x(cycles):
        return 60 + 640 * math.log(cycles / 300) / math.log(12000 / 300)

    def y(rmse):
        return 20 + 340 * (0.12 - rmse) / (0.12 - 0.04)

    def place(cycles, rmse, name):
        """Where a label overlaps points and other labels least: x, y of its left end."""
        wide = 6.2 * len(name)
        boxes = [(x(cycles) + left, y(rmse) + down - 10, x(cycles) + left + wide, y(rmse) + down + 2)
                 for left, down in itertools.product((6, -6 - wide, -wide / 2), (-4, 12, 4, -14, 22))]
        box = min(boxes, key=lambda box: (box[2] > 760) + sum(
            max(0, min(box[2], other[2]) - max(box[0], other[0])) * max(0, min(box[3], other[3]) - max(box[1], other[1])) for other in taken))
        taken.append(box)
        return box[0], box[3] - 2
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 410" font-family="sans-serif" font-size="11">',
           '<rect width="760" height="410" fill="white"/>', '<g stroke="#ddd" fill="#333" text-anchor="middle">']
    for cycles in (300, 600, 1200, 2400, 4800, 9600):
        out.append(f'<path d="M{x(cycles):.1f} 20V360"/><text stroke="none" x="{x(cycles):.1f}" y="376">{cycles}</text>')
    for rmse in range(4, 13):
        out.append(f'<path d="M60 {y(rmse / 100):.1f}H700"/><text stroke="none" x="40" y="{y(rmse / 100) + 4:.1f}">.{rmse * 10:03d}</text>')
    out.append('<text stroke="none" x="380" y="398">cycles of all passes, RDNA 2 (lower is cheaper)</text>'
               '<text stroke="none" transform="translate(14 190) rotate(-90)">RMSE to rays (lower is better)</text></g>')
    rows = [row for row in rows if row[2] < 0.12]
    taken = [(x(row[1]) - 4, y(row[2]) - 4, x(row[1]) + 4, y(row[2]) + 4) for row in rows]
    for rival, colour in ((False, "#1f6fb4"), (True, "#c0392b")):
        points = sorted(row[1:3] + row[:1] for row in rows if row[3] == rival)
        best = list(itertools.accumulate((rmse for _, rmse, _ in points), min))
        front = [point for i, point in enumerate(points) if i == 0 or best[i] < best[i - 1]]
        line = "L".join(f"{x(cycles):.1f} {y(rmse):.1f}" for cycles, rmse, _ in front)
        out.append(f'<path d="M{line}" fill="none" stroke="{colour}" stroke-dasharray="{"4 3" if rival else "none"}"/>')
        for cycles, rmse, name in points:
            left, down = place(cycles, rmse, name)
            out.append(f'<circle cx="{x(cycles):.1f}" cy="{y(rmse):.1f}" r="3.5" fill="{colour}"/>'
                       f'<text x="{left:.1f}" y="{down:.1f}" fill="{colour}">{name}</text>')
    return "\n".join(out) + "\n</svg>\n"


def block(page, name):
    found = re.search(rf"<!-- figures: {name} -->\n(.*?)\n?<!-- /figures -->", page, re.S)
    return found[1]


def main():
    words = [word for word in sys.argv[1:] if word not in ("--check", "--caches")]
    scenes = words[words.index("--rays") + 1:] if "--rays" in words else []
    if len(words) < 2 or (len(words) > 2 and len(scenes) != 2):
        print(__doc__, file=sys.stderr)
        sys.exit(1)
    nook, tools, check = os.path.abspath(words[0]), words[1], "--check" in sys.argv
    if not os.path.exists(os.path.join(tools, "nook_gpu_cost")) or not shutil.which("glslangValidator"):
        skip("expected libvulkan-dev, mesa-vulkan-drivers and glslang-tools (scripts/setup.sh)")
    with open(PAGE) as file:
        page = file.read()
    with tempfile.TemporaryDirectory() as folder:
        files = patterns(nook, folder)
        try:
            found = measure(nook, os.path.join(tools, "nook_gpu_cost"), files, folder)
        except SystemExit as end:
            if end.code == 5:
                skip("found no RADV that opens hardware which is not there")
            raise
        driver = next(iter(found.values()))["driver"]
        if check and f"`{driver}`" not in page:
            skip(f"found {driver}, expected the driver that the page names")
        old = dict(re.findall(r"^\| ([^|]+) \| \d+ \| [^|]*\| (\.\d+|)", block(page, "methods"), re.M))

        def error(name, options, pattern=""):
            if not scenes:
                return old.get(name, "")
            given = f" --pattern {files[pattern]}" if pattern else ""
            means = rays.errors(nook, *scenes, f"--method {options}{given}")
            return f"{sum(means.values()) / len(means):.4f}"[1:]
        rows = [(name, round(sum(share * found[name, function]["cycles"] for function, share in passes.items())),
                 round(sum(share * found[name, function]["surface"] for function, share in passes.items())),
                 error(name, f"{method} {options}", pattern), False)
                for name, method, pattern, options, passes in METHODS]
        rows += [(name, cycles, "", error(name, options), True) for name, options, cycles in RIVALS]
        total = ["| method | cycles, all passes | without the sky test | RMSE |", "| --- | --- | --- | --- |"]
        total += [f"| {name} | {cycles} | {surface} | {rmse} |" for name, cycles, surface, rmse, _ in sorted(rows, key=lambda row: row[1])]
        table = ["| method | pass | cycles | without the sky test | latency | instructions | registers | waves |", "| --- " * 8 + "|"]
        seen = set()
        for (name, function), cost in found.items():
            what = f"`{function}`" if function.startswith("nook") else function
            line = f"| {what} | {' | '.join(str(cost[key]) for key in ('cycles', 'surface', 'latency', 'instructions', 'registers', 'waves'))} |"
            if line not in seen:
                table.append(f"| {name} {line}")
            seen.add(line)
        new = {"driver": f"Compiler and hardware: `{driver}`.", "methods": "\n".join(total), "passes": "\n".join(table)}
        if "--caches" in sys.argv:
            new["caches"] = bytes_table(os.path.join(tools, "nook_caches"), files)
    drawing = plot([(name, cycles, float(rmse), rival) for name, cycles, _, rmse, rival in rows if rmse])
    if check:
        differ = [f"found {line}" for name, text in new.items() for line in text.splitlines() if line not in block(page, name).splitlines()]
        with open(PLOT) as file:
            differ += [] if file.read() == drawing else ["found another plot"]
        print("\n".join(f"page.py: docs/measurements/gpu.md: {line}" for line in differ) or "page.py: the costs are those of the page")
        sys.exit(7 if differ else 0)
    for name, text in new.items():
        page = page.replace(f"<!-- figures: {name} -->\n{block(page, name)}", f"<!-- figures: {name} -->\n{text}")
    with open(PAGE, "w") as file:
        file.write(page)
    with open(PLOT, "w") as file:
        file.write(drawing)


if __name__ == "__main__":
    main()
