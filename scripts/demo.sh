#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Sets up, configures, builds and runs the main commands into out/: patterns of lines and points in every format, a tile, the
# reports on noise and error; depth, normals, reference visibility and every method for a built-in level, and for real ones if
# ../shared/scenes has them.
set -eu
cd "$(dirname "$0")/.."

scripts/setup.sh
mkdir -p out

# The component patterns builds in a fraction of the time, so there is something to see while the rest compiles. ccache keeps its
# objects for the full build.
cmake --preset patterns
cmake --build --preset patterns
nook=build/patterns/tools/nook

# Prints a command as it would be typed, and runs it.
run()
{
	echo "nook $*"
	"$nook" "$@"
}

run pattern --domain disk --count 9 --symmetric -o out/disk_009.svg
echo "The first picture: $PWD/out/disk_009.svg"

cmake --preset release
cmake --build --preset release --target nook
nook=build/release/tools/nook
run pattern --domain disk --count 9 --symmetric \
	-o out/disk_009.json -o out/disk_009.h -o out/disk_009.glsl -o out/disk_009.hlsl -o out/disk_009.csv -o out/disk_009.svg
run pattern --domain ball --count 33 -o out/ball_033.json -o out/ball_033.h -o out/ball_033.glsl -o out/ball_033.svg
run tile --pattern out/disk_009.json --size 4 -o out/disk_009_tile.json -o out/disk_009_tile.exr -o out/disk_009_tile.svg -o out/disk_009_tile.glsl
run info out/disk_009.json
run report noise --max-count 8 -o out/noise.html --json out/noise.json
run report error builtin:suburb --quick --methods vo-line,slices,alchemy,gtao,aov,rays -o out/error.html --json out/error.json

# look NAME LEVEL RADIUS OPTIONS…: depth and normals, the reference, and the error of 16 rays against it.
look()
{
	name=$1
	level=$2
	radius=$3
	shift 3
	run gbuffer "$level" "$@" --size 640x360 -o "out/$name.exr"
	run reference "$level" --gbuffer "out/$name.exr" --radius "$radius" --rays 256 -o "out/${name}_reference.exr" -o "out/${name}_reference.png"
	run reference "$level" --gbuffer "out/$name.exr" --radius "$radius" --rays 16 --seed 2 -o "out/${name}_16.exr"
	run compare "out/${name}_16.exr" "out/${name}_reference.exr" --mask "out/$name.exr" --diff "out/${name}_difference.png"
}

look courtyard builtin:courtyard 1.5 --camera main
scripts/methods.sh "$nook" builtin:courtyard 1 out/methods.png
scenes=../shared/scenes
if [ -d "$scenes" ]; then
	[ -e out/sponza.glb ] || { xz -dc "$scenes/sponza/sponza.glb.xz" >out/sponza.part && mv out/sponza.part out/sponza.glb; }
	run info out/sponza.glb
	look sponza out/sponza.glb 1.5 --camera auto:1
	scripts/methods.sh "$nook" out/sponza.glb 1 out/methods_sponza.png --camera auto:1
	look delft "$scenes/delft/delft.obj" 5 --camera auto:1
fi

cat <<EOT

Results are in out/. Open
  out/noise.html      noise against count for every domain and method, up to eight samples
  out/error.html      time against error of five methods on a built-in level, beside ray tracing
  out/disk_009.svg    nine lines: points, cells, weights
  out/courtyard_reference.png   visibility of a built-in level by ray tracing; out/courtyard_difference.png how far 16 rays are off
  out/methods.png     every method on that level, beside the reference
  out/disk_009.glsl   the same as arrays for a shader; .h for C and C++, .hlsl, .csv, .json
EOT
