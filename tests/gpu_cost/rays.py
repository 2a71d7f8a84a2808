#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mean RMSE against ray tracing over 32 views (eight levels, four views each), per list of options of nook shade.

usage: rays.py NOOK SCENES CACHE "--method slices --slice-steps 4"...
SCENES holds the levels' files. CACHE keeps G-buffers and references (256 rays, linear falloff, 480 x 270), which take four minutes.
"""
import concurrent.futures
import json
import os
import subprocess
import sys

# Each level's file and the reach of its rays in metres.
LEVELS = {"courtyard": ("builtin:courtyard", 1.5), "suburb": ("builtin:suburb", 1.5), "sponza": ("sponza/sponza.glb", 1),
          "delft": ("delft/delft.obj", 1.5), "bathroom": ("bathroom/bathroom.glb", 0.3), "cave": ("builtin:cave", 1),
          "dragon": ("dragon/dragon_vrip_res2.ply", 0.02), "heightfield": ("builtin:heightfield:20000", 5)}
VIEWS = range(1, 5)


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    return done.stdout


def prepare(nook, scenes, cache, name):
    path, reach = LEVELS[name]
    level = path if path.startswith("builtin:") else os.path.join(scenes, path)
    folder = os.path.join(cache, name)
    if os.path.exists(os.path.join(folder, "done")):
        return
    os.makedirs(folder, exist_ok=True)
    run(nook, "gbuffer", level, "--camera", "auto:4", "--size", "480x270", "-o", f"{folder}/g.exr")
    for view in VIEWS:
        run(nook, "reference", level, "--gbuffer", f"{folder}/g-{view}.exr", "--radius", reach, "--falloff", "linear", "--rays", 256,
            "-o", f"{folder}/r-{view}.exr")
    open(os.path.join(folder, "done"), "w").close()


def view_error(nook, cache, name, view, options):
    folder = os.path.join(cache, name)
    out = os.path.join(cache, f"shaded-{os.getpid()}-{name}-{view}.exr")
    threads = [] if "gl" in options.split() else ["--threads", 1]
    run(nook, "shade", f"{folder}/g-{view}.exr", "--radius", LEVELS[name][1], *threads, *options.split(), "-o", out)
    found = json.loads(run(nook, "compare", out, f"{folder}/r-{view}.exr", "--mask", f"{folder}/g-{view}.exr", "--json", "-"))
    os.remove(out)
    return found["errors"]["rmse"]


def errors(nook, scenes, cache, options):
    """Mean RMSE of each level."""
    for name in LEVELS:
        prepare(nook, scenes, cache, name)
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        jobs = {name: [pool.submit(view_error, nook, cache, name, view, options) for view in VIEWS] for name in LEVELS}
        return {name: sum(job.result() for job in row) / len(row) for name, row in jobs.items()}


def main():
    if len(sys.argv) < 5:
        print(__doc__, file=sys.stderr)
        sys.exit(1)
    nook, scenes, cache = sys.argv[1:4]
    print("  mean", *(f"{name:>11s}" for name in LEVELS))
    for options in sys.argv[4:]:
        means = errors(nook, scenes, cache, options)
        print(f"{sum(means.values()) / len(means):6.4f}", *(f"{mean:11.4f}" for mean in means.values()), "", options, flush=True)


if __name__ == "__main__":
    main()
