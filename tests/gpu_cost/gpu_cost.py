#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What shaders cost on a GPU (AMD RDNA 2), according to Mesa's compiler. No GPU is needed (docs/measurements/gpu.md).

usage: gpu_cost.py [--json] TOOL MODULE.glsl FUNCTION...             functions of a pixel of a module of nook emit --glsl vulkan
       gpu_cost.py [--json] TOOL SHADER.frag|SHADER.comp...          whole shaders
TOOL is nook_gpu_cost of the build folder.
"""
import glob
import json
import os
import re
import subprocess
import sys
import tempfile

FULL_SCREEN = "#version 450\nvoid main() { gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2 - 1, 0, 1); }\n"
COLUMNS = {"cycles": "Inverse Throughput", "latency": "Latency", "instructions": "Instructions", "registers": "VGPRs",
           "waves": "Subgroups per SIMD"}


def unrolled(text):
    """The compiler counts eight rounds of a loop that it does not unroll."""
    return re.sub(r"^(\s*)(for \(int )", r"\1[[unroll]] \2", text, flags=re.M)


def pixel_shader(module, function):
    return (f"#version 450\n#extension GL_EXT_control_flow_attributes : enable\n{unrolled(module)}\n"
            f"layout(location = 0) out vec4 seen;\nvoid main() {{ seen = vec4({function}(ivec2(gl_FragCoord.xy))); }}\n")


def costs(tool, shaders):
    """Costs of shaders: (stage, text), or (stage, text, vertex shader) where fragments have inputs."""
    with tempfile.TemporaryDirectory() as folder:
        def spirv(name, stage, text):
            path = os.path.join(folder, f"{name}.{stage}")
            with open(path, "w") as file:
                file.write(text)
            run = subprocess.run(["glslangValidator", "-V", "--target-env", "vulkan1.2", f"-I{os.getcwd()}", path, "-o", path + ".spv"],
                                 capture_output=True, text=True)
            if run.returncode:
                sys.exit(run.stdout)
            return path + ".spv"

        full = spirv("full", "vert", FULL_SCREEN)
        files = []
        for i, (stage, text, *vertex) in enumerate(shaders):
            before = "" if stage == "comp" else (spirv(i, "vert", vertex[0]) if vertex else full) + "+"
            files.append(before + spirv(i, stage, text))
        driver = (glob.glob("/usr/share/vulkan/icd.d/radeon_icd*.json") or [""])[0]
        env = dict(os.environ, RADV_FORCE_FAMILY="navi21", VK_ICD_FILENAMES=driver, VK_DRIVER_FILES=driver, XDG_RUNTIME_DIR=folder)
        run = subprocess.run([tool, *files], capture_output=True, text=True, env=env)
        if run.returncode:
            print(run.stderr, end="", file=sys.stderr)
            sys.exit(run.returncode)
    found = [json.loads(line) for line in run.stdout.splitlines()]
    return [{"driver": row["driver"], **{name: row[theirs] for name, theirs in COLUMNS.items()}} for row in found]


def main():
    words = [word for word in sys.argv[1:] if word != "--json"]
    if len(words) < 2:
        print(__doc__, file=sys.stderr)
        sys.exit(1)
    tool, first, *functions = words
    is_module = first.endswith(".glsl")
    names = functions if is_module else words[1:]
    try:
        texts = [open(name).read() for name in ([first] if is_module else names)]
    except OSError as error:
        print(f"gpu_cost.py: {error.filename}: cannot be read: {error.strerror}", file=sys.stderr)
        sys.exit(2)
    if is_module:
        shaders = [("frag", pixel_shader(texts[0], name)) for name in names]
    else:
        shaders = [(name.rsplit(".", 1)[-1], text) for name, text in zip(names, texts)]
    rows = [{"name": name, **cost} for name, cost in zip(names, costs(tool, shaders))]
    if "--json" in sys.argv:
        print(json.dumps(rows, indent=1))
        return
    for row in rows:
        print(f"{row['name']:32s}", "  ".join(f"{name} {row[name]:5d}" for name in COLUMNS))


if __name__ == "__main__":
    main()
