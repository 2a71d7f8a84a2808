#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the pictures of the README again, in docs/pictures/. usage: pictures.sh NOOK
set -eu
nook=$1
folder=$(dirname "$0")/../docs/pictures
mkdir -p "$folder"
"$nook" pattern --domain disk --count 9 --symmetric -o "$folder/disk_009_symmetric.svg"
"$nook" pattern --domain disk --count 16 -o "$folder/disk_016.svg"
"$nook" pattern --domain ball --count 33 -o "$folder/ball_033.svg"
"$nook" pattern --domain hemisphere --count 16 -o "$folder/hemisphere_016.svg"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$nook" pattern --domain disk --count 9 -o "$scratch/disk_009.json"
"$nook" tile --pattern "$scratch/disk_009.json" --size 4 -o "$folder/disk_009_tile4.svg"
"$nook" gbuffer builtin:courtyard --camera main --size 640x360 -o "$scratch/g.exr"
"$nook" reference builtin:courtyard --gbuffer "$scratch/g.exr" --radius 1.5 --rays 256 -o "$folder/courtyard_reference.png"
"$(dirname "$0")/methods.sh" "$nook" builtin:courtyard 1 "$scratch/methods.png" --camera main
oiiotool "$scratch/methods.png" --resize 1086x0 -o "$folder/methods.png"
