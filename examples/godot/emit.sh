#!/bin/sh
# SPDX-License-Identifier: MIT
# Makes made/: the level, the module's two passes as shaders of Godot 3, and its tile and settings. Needs nook on the PATH, and Python.
set -eu
cd "$(dirname "$0")"
mkdir -p made
nook level builtin:courtyard -o made/level.glb
nook pattern --domain disk --count 3 -o made/disk.json
nook tile --pattern made/disk.json --size 4 -o made/tile.json
nook emit --methods vo-line --patterns made/tile.json --filter window --depth device --normals from-depth --block floats --glsl 330 \
	-o made/nook_vo.glsl -o made/nook_vo.json
python3 translate.py made/nook_vo.glsl nookVoLine made/lines.shader
python3 translate.py made/nook_vo.glsl nookWindow made/window.shader
