#!/bin/sh
# SPDX-License-Identifier: MIT
# Makes made/: the module's two passes as compute shaders of Godot 4, and its block, tile and settings. Needs nook on the PATH.
set -eu
cd "$(dirname "$0")"
mkdir -p made
nook pattern --domain disk --count 3 -o made/disk.json
nook tile --pattern made/disk.json --size 4 -o made/tile.json
nook emit --methods vo-line --patterns made/tile.json --filter window --depth device --normals from-depth --block floats \
	--glsl vulkan --main compute -o made/nook_vo.txt.glsl -o made/nook_vo.json
# Godot wants to know the stage, and the pass is a macro behind #version.
for pass in 0 1; do
	{ echo '#[compute]'; sed "1a #define NOOK_PASS $pass" made/nook_vo.txt.glsl; } >made/pass$pass.glsl
done
rm made/nook_vo.txt.glsl
