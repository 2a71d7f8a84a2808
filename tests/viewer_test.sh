# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: viewer_test.sh PROGRAM SOURCE BUILD. Builds examples/viewer against an installed nook, as a foreign engine would be, and
# compares its pictures with `nook shade` of the same cameras; in a window too, where Xvfb is at hand.
set -u
source=$2
build=$3
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/steps.sh"
unset DESTDIR NOOK_EXECUTABLE CMAKE_PREFIX_PATH CMAKE_GENERATOR || true

prefix="$folder/pre fix"
out="$folder/the build"
step "install" cmake --install "$build" --prefix "$prefix" || finish
cp -r "$source/examples/viewer" "$folder/the viewer"
step "configure" cmake -G Ninja -S "$folder/the viewer" -B "$out" "-DCMAKE_PREFIX_PATH=$prefix" \
	"-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wshadow -Wconversion -Wsign-conversion -Werror" || finish
step "build" cmake --build "$out" || finish
expect_made 13 "first build: four patterns, four tiles, three modules, the level and its volumes"
ninja -C "$out" -t commands viewer | grep -F -e "$source" -e "$build" && problem "the viewer is built from our sources"
step "build again" cmake --build "$out"
expect_made 0 "nothing changed"

# Its pictures against the kernels on the CPU. The rows of an OpenGL picture go upward, and so do the variants of a tile in it:
# a projection that is upside down makes a G-buffer of the same rows. (62 degrees, 0.1 m to infinity, 16:9.)
nook="$prefix/bin/nook"
viewer="$out/viewer"
cd "$folder" || exit 1
size=320x180
projection="0.936157208822 0 0 0 0 -1.66427948235 0 0 0 0 -1 -1 0 0 -0.2 0"
step "G-buffer" "$nook" gbuffer "$out/nook_patterns/viewer/level.glb" --camera main --projection "$projection" --size $size --normals interpolated -o g.exr
for method in vo-line vo-point alchemy vo-area; do
	step "$method: shade" "$nook" shade g.exr --method $method --pattern "$out/nook_patterns/viewer/viewer_ao_${method}_tile.json" \
		--filter window --radius 0.5 -o $method.exr
	step "$method: viewer" "$viewer" --no-window --size $size --method $method --show visibility -o $method.png
	step "$method: flip" oiiotool $method.png --flip -o $method.flipped.png
	# 8 bits alone are off by 0.001 in the mean; rays and rasterisation differ at edges.
	step "$method: mean difference" "$nook" compare $method.flipped.png $method.exr --mask g.exr --metric mae --max-error 0.002
	step "$method: 95 % of the pixels" "$nook" compare $method.flipped.png $method.exr --mask g.exr --metric p95 --max-error 0.006
	step "$method: reversed" "$viewer" --no-window --size $size --method $method --show visibility --keys z -o $method.reversed.png
	step "$method: reversed depth" "$nook" compare $method.reversed.png $method.png --metric mae --max-error 0.0005
done
# The level's volumes, by the stages that were emitted, against the CPU: alone, with reversed depth, and both.
step "volumes: shade" "$nook" shade g.exr --method aov --volumes "$out/nook_patterns/viewer/level.volumes.glb" -o aov.exr
step "volumes: viewer" "$viewer" --no-window --size $size --occluder volumes --show visibility -o aov.png
step "volumes: flip" oiiotool aov.png --flip -o aov.flipped.png
step "volumes: mean difference" "$nook" compare aov.flipped.png aov.exr --mask g.exr --metric mae --max-error 0.002
step "volumes: 95 % of the pixels" "$nook" compare aov.flipped.png aov.exr --mask g.exr --metric p95 --max-error 0.006
step "volumes: reversed" "$viewer" --no-window --size $size --show visibility --keys "o o z" -o aov.reversed.png
step "volumes: reversed depth" "$nook" compare aov.reversed.png aov.png --metric mae --max-error 0.0005
step "both" "$viewer" --no-window --size $size --show visibility --keys o -o both.png
step "both: the lesser" oiiotool vo-line.png aov.png --min -d uint8 -o lesser.png
step "both: the lesser of the two" "$nook" compare both.png lesser.png --metric mae --max-error 0.00001
# Half resolution: as near to the kernels' own, which is far from their full one.
for method in alchemy vo-area; do
	step "$method: half, shade" "$nook" shade g.exr --method $method --pattern "$out/nook_patterns/viewer/viewer_ao_${method}_tile.json" \
		--filter window --radius 0.5 --resolution half -o $method.half.exr
	step "$method: half, viewer" "$viewer" --no-window --size $size --method $method --show visibility --resolution half -o $method.half.png
	step "$method: half, flip" oiiotool $method.half.png --flip -o $method.flipped.png
	step "$method: half, mean difference" "$nook" compare $method.flipped.png $method.half.exr --mask g.exr --metric mae --max-error 0.002
	step "$method: half, 95 % of the pixels" "$nook" compare $method.flipped.png $method.half.exr --mask g.exr --metric p95 --max-error 0.006
	checks=$((checks + 1))
	"$nook" compare $method.half.png $method.png --metric mae --max-error 0.01 >log 2>&1 && problem "$method: half and full: found nearly the same picture"
done

# The same picture from keys, and in a window.
step "keys" "$viewer" --no-window --size $size --keys "c c c c c 2 v z z" -o keys.png
same keys.png vo-point.png "five cameras on, the second method, visibility, reversed and back: not the same picture"
step "keys: half" "$viewer" --no-window --size $size --keys "3 v r v v v v v" -o keys.png
same keys.png alchemy.half.png "the third method, visibility, half, five times what is shown: not the same picture"
step "difference" "$viewer" --no-window --size $size --method alchemy --show difference -o difference.png
step "difference: half" "$viewer" --no-window --size $size --method alchemy --show difference --resolution half -o difference.half.png
same difference.png difference.half.png "difference of the two resolutions: not the same picture from both"
if command -v xvfb-run >/dev/null; then
	step "window" xvfb-run -a "$viewer" --size $size --keys "2 v" --frames 5 -o window.png
	same window.png vo-point.png "another picture in a window"
else
	echo "no xvfb-run: the window has not been tried"
fi
for show in lit normals depth; do
	step "$show" "$viewer" --no-window --size $size --show $show -o $show.png
done
cmp -s lit.png normals.png && problem "lit and normals: found the same picture"
cmp -s lit.png depth.png && problem "lit and depth: found the same picture"

# Masks: leaves let light through in both.
step "foliage" "$nook" level builtin:foliage -o foliage.glb
step "foliage: G-buffer" "$nook" gbuffer foliage.glb --camera main --size $size -o leaves.exr
step "foliage: shade" "$nook" shade leaves.exr --method vo-line --pattern "$out/nook_patterns/viewer/viewer_ao_vo-line_tile.json" \
	--filter window --radius 0.5 -o leaves.v.exr
step "foliage: viewer" "$viewer" foliage.glb --no-window --size $size --show visibility -o leaves.png
step "foliage: the same picture" "$nook" compare leaves.png leaves.v.exr --mask leaves.exr --metric mae --max-error 0.05

# A level from a file, made again when that changes; another number of samples makes what depends on it.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\n' >triangle.obj # a corner: a flat level has no volumes
sed -i 's/COUNTS 3 5 9 3/COUNTS 3 6 9 3/' "$folder/the viewer/CMakeLists.txt"
step "another level" cmake "-DVIEWER_LEVEL=$folder/triangle.obj" "$out"
step "build with another level" cmake --build "$out"
expect_made 6 "another level and another count: a pattern, its tile, two modules, the level and its volumes"
sleep 1
touch triangle.obj
step "the level changed" cmake --build "$out"
expect_made 2 "the level's file changed: the level and its volumes"
step "show the triangles" "$viewer" --no-window --size 64x64

# wrong CODE REGEX ARGUMENTS: one line on stderr.
wrong()
{
	code=$1
	regex=$2
	shift 2
	checks=$((checks + 1))
	"$viewer" "$@" --no-window >log 2>&1
	found=$?
	{ [ $found -eq "$code" ] && [ "$(wc -l <log)" -eq 1 ] && grep -Eq -e "$regex" log; } ||
		problem "viewer $*: exit code $found, '$(cat log)', expected $code and one line of '$regex'"
}
head -c 400 "$out/nook_patterns/viewer/level.glb" >cut.glb
wrong 1 '--show: found .x., expected one of lit' --show x
wrong 1 '--method: found .gtao.' --method gtao
wrong 1 '--resolution: found .third., expected one of full, half' --resolution third
wrong 1 '--size: found' --size 16
wrong 1 '--occluder: found .all., expected one of screen, both, volumes' --occluder all
wrong 2 'none.glb: cannot be read' --volumes none.glb
wrong 3 'level.glb: found .*, expected a file of nook volumes' --volumes "$out/nook_patterns/viewer/level.glb"
wrong 1 '--radius: found .0.' --radius 0
wrong 1 '--camera: found .none.' --camera none
wrong 1 '--colour' --colour 3
wrong 2 'none.glb: cannot be read' none.glb
wrong 2 '/none/x.png: cannot be written' --size 16x16 -o /none/x.png
wrong 3 'cut.glb' cut.glb
wrong 3 'triangle.obj: found no binary glTF' triangle.obj
checks=$((checks + 1))
(unset DISPLAY WAYLAND_DISPLAY; "$viewer" >log 2>&1)
[ $? -eq 5 ] || problem "no display: expected exit code 5, found: $(cat log)"
finish
