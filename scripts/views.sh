#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The six views that --camera auto:6 selects for each level, ray-traced with that reach in metres: one row per level, in order of
# selection. Needs OpenImageIO's oiiotool.
# usage: views.sh PROGRAM SHEET.png LEVEL,REACH...
# The sheet in docs/reference/gbuffer.md:
#   scripts/views.sh build/release/tools/nook docs/pictures/views.png sponza.glb,1.5 delft.obj,8 bathroom.glb,1 dragon.ply,0.02 shuttle.glb,0.05 \
#     pine.glb,4 temple.gltf,1 garden.glb,1
set -euo pipefail
nook=$1
sheet=$2
shift 2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
rows=()
for row in "$@"; do
	level=${row%,*}
	"$nook" gbuffer "$level" --camera auto:6 --size 176x99 -o "$folder/g.exr" >/dev/null
	pictures=()
	for k in 1 2 3 4 5 6; do
		pictures+=("$folder/$k.png")
		"$nook" reference "$level" --gbuffer "$folder/g-$k.exr" --falloff linear --radius "${row##*,}" --rays 32 -o "$folder/$k.png" >/dev/null
	done
	rows+=("$folder/row${#rows[@]}.png")
	oiiotool "${pictures[@]}" --mosaic:pad=2 6x1 -o "${rows[-1]}"
done
oiiotool --nosoftwareattrib "${rows[@]}" --mosaic:pad=2 "1x${#rows[@]}" --ch R -d uint8 -o "$sheet"
