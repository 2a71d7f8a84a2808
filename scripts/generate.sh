#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Regenerates shaders_generated/: arrays of the most common patterns for GLSL, HLSL and C, and modules.
# usage: generate.sh NOOK [FOLDER]
set -eu
nook=$1
folder=${2:-$(dirname "$0")/../shaders_generated}
mkdir -p "$folder"

# pattern NAME OPTIONS...: one pattern in the three languages.
pattern()
{
	name=$1
	shift
	"$nook" pattern "$@" -o "$folder/$name.glsl" -o "$folder/$name.hlsl" -o "$folder/$name.h"
}

for count in 5 9 16; do
	pattern disk_$(printf %03d $count)_symmetric --domain disk --count $count --symmetric
done
pattern ball_012 --domain ball --count 12
pattern ball_033 --domain ball --count 33
pattern hemisphere_064 --domain hemisphere --count 64

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$nook" pattern --domain disk --count 9 -o "$scratch/disk_009.json"
"$nook" tile --pattern "$scratch/disk_009.json" --size 4 -o "$folder/disk_009_tile4.glsl" -o "$folder/disk_009_tile4.hlsl" -o "$folder/disk_009_tile4.h"

# module NAME OPTIONS...: one module for every target, and its header.
module()
{
	name=$1
	shift
	for target in 330 430 es300 vulkan; do
		"$nook" emit "$@" --glsl $target -o "$folder/${name}_$target.glsl" -o "$folder/$name.h"
	done
}

"$nook" tile --pattern "$scratch/disk_009.json" --size 4 -o "$scratch/disk_009_tile4.json"
"$nook" pattern --domain hemisphere --count 9 -o "$scratch/hemisphere_009.json"
"$nook" tile --pattern "$scratch/hemisphere_009.json" --size 4 -o "$scratch/hemisphere_009_tile4.json"
module nook_vo9 --methods vo-line --patterns "$scratch/disk_009_tile4.json" --filter window --recipe paper
module nook_alchemy9 --methods alchemy --patterns "$scratch/hemisphere_009_tile4.json" --filter window --recipe paper
module nook_area9 --methods vo-area --patterns "$scratch/disk_009_tile4.json" --filter bilateral --recipe paper
module nook_statvo --methods statvo --recipe paper
# Fitted to rays: three lines at three radii, and slices.
"$nook" pattern --domain disk --count 3 -o "$scratch/disk_003.json"
"$nook" tile --pattern "$scratch/disk_003.json" --size 4 -o "$scratch/disk_003_tile4.json"
module nook_vo3 --methods vo-line --patterns "$scratch/disk_003_tile4.json" --filter bilateral
module nook_slices --methods slices --filter bilateral
for target in 330 430; do
	"$nook" emit --methods aov --glsl $target -o "$folder/nook_aov_$target.glsl"
	"$nook" emit --methods aov-mask --glsl $target -o "$folder/nook_aov_mask_$target.glsl"
done
module nook_vo9_half --methods vo-line --patterns "$scratch/disk_009_tile4.json" --filter bilateral --resolution half --recipe paper
