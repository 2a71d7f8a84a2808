# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: viewer_test.sh PROGRAM SOURCE BUILD. Builds examples/viewer against an installed nook, as another project would, and
# compares its pictures with `nook shade` for the same cameras; also in a window if Xvfb is available.
set -u
source=$2
build=$3
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/steps.sh"
. "$(dirname "$0")/hidden_libraries.sh"
unset DESTDIR NOOK_EXECUTABLE CMAKE_PREFIX_PATH CMAKE_GENERATOR || true

prefix="$folder/pre fix"
out="$folder/the build"
step "install" cmake --install "$build" --prefix "$prefix" || finish
cp -r "$source/examples/viewer" "$folder/the viewer"
step "configure" cmake -G Ninja -S "$folder/the viewer" -B "$out" "-DCMAKE_PREFIX_PATH=$prefix" \
	"-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wshadow -Wconversion -Wsign-conversion -Werror" || finish
step "build" cmake --build "$out" || finish
expect_made 15 "first build: four patterns, four tiles, five modules, the level and its volumes"
ninja -C "$out" -t commands viewer | grep -F -e "$source" -e "$build" && problem "the viewer is built from our sources"
step "build again" cmake --build "$out"
expect_made 0 "nothing changed"

# Compares its pictures with the kernels on the CPU (62 degrees, 0.1 m to infinity, 16:9). An OpenGL picture's rows go upward; tiles
# are aligned regardless, but cells and coarser levels start at row 0: for those, an upside-down projection makes a G-buffer with
# the same row order.
nook="$prefix/bin/nook"
viewer="$out/viewer"
cd "$folder" || exit 1
size=192x108
for view in "g 1.66427948235" "turned -1.66427948235"; do
	projection="0.936157208822 0 0 0 0 ${view#* } 0 0 0 0 -1 -1 0 0 -0.2 0"
	step "G-buffer ${view% *}" "$nook" gbuffer "$out/nook_patterns/viewer/level.glb" --camera main --projection "$projection" --size $size \
		--normals interpolated -o "${view% *}.exr"
done
# The file with a method's samples.
tile_of()
{
	case $1 in
	vo-line | vo-area) echo "$out/nook_patterns/viewer/viewer_disk_$1_tile.json" ;;
	*) echo "$out/nook_patterns/viewer/viewer_points_$1_tile.json" ;;
	esac
}
for method in vo-line vo-point alchemy vo-area; do
	view=g
	[ $method = vo-area ] && view=turned
	step "$method: shade" "$nook" shade $view.exr --method $method --pattern "$(tile_of $method)" \
		--filter window --radius 0.5 -o $method.exr
	step "$method: viewer" "$viewer" --no-window --size $size --method $method --show visibility -o $method.png
	[ $view = g ] && cp $method.png $method.same.png
	[ $view = g ] || step "$method: flip" oiiotool $method.png --flip -o $method.same.png
	# 8 bits alone cause a mean error of 0.001; rays and rasterisation differ at edges.
	step "$method: mean difference" "$nook" compare $method.same.png $method.exr --mask $view.exr --metric mae --max-error 0.002
	step "$method: 95 % of the pixels" "$nook" compare $method.same.png $method.exr --mask $view.exr --metric p95 --max-error 0.006
	step "$method: reversed" "$viewer" --no-window --size $size --method $method --show visibility --keys z -o $method.reversed.png
	step "$method: reversed depth" "$nook" compare $method.reversed.png $method.png --metric mae --max-error 0.0005
done
# The level's volumes, drawn by the emitted stages, compared with the CPU: alone, with reversed depth, and both.
step "volumes: shade" "$nook" shade g.exr --method aov --volumes "$out/nook_patterns/viewer/level.volumes.glb" -o aov.exr
step "volumes: viewer" "$viewer" --no-window --size $size --occluder volumes --show visibility -o aov.png
step "volumes: mean difference" "$nook" compare aov.png aov.exr --mask g.exr --metric mae --max-error 0.002
step "volumes: 95 % of the pixels" "$nook" compare aov.png aov.exr --mask g.exr --metric p95 --max-error 0.006
step "volumes: reversed" "$viewer" --no-window --size $size --show visibility --keys "o o z" -o aov.reversed.png
step "volumes: reversed depth" "$nook" compare aov.reversed.png aov.png --metric mae --max-error 0.0005
step "both" "$viewer" --no-window --size $size --show visibility --keys o -o both.png
step "both: the lesser" oiiotool vo-line.png aov.png --min -d uint8 -o lesser.png
step "both: the lesser of the two" "$nook" compare both.png lesser.png --metric mae --max-error 0.00001
# A bake with moving objects: the level with values at its vertices, and two boxes that are neither in it nor in its volumes,
# compared with nook shade by the same rule.
box()
{
	awk -v b="$*" 'BEGIN { split(b, v, " "); for (i = 0; i < 8; ++i) print "v", v[1] + v[4] * (i % 2), v[2] + v[5] * (int(i / 2) % 2), v[3] + v[6] * int(i / 4)
		n = split("1 3 4 2 5 6 8 7 1 2 6 5 3 7 8 4 1 5 7 3 2 4 8 6", f, " "); for (i = 1; i < n; i += 4) print "f", f[i] - 9, f[i + 1] - 9, f[i + 2] - 9, f[i + 3] - 9 }'
}
level="$out/nook_patterns/viewer/level.glb"
{ box -0.2 0 -6 1 1 1; box 2.4 0 -5 0.8 1.4 0.8; } >crates.obj
step "bake" "$nook" bake "$level" --radius 0.5 --falloff linear --rays 32 -o baked.glb
step "bake: beside volumes" "$nook" bake "$level" --radius 0.5 --falloff linear --rays 32 \
	--volumes "$out/nook_patterns/viewer/level.volumes.glb" -o beside.glb
step "what moves" "$nook" level crates.obj -o crates.glb
step "what moves: with the level" "$nook" level "$level" crates.glb -o moved.glb
step "what stands still" "$nook" level "$level" -o still.glb # its camera was written as often as that of moved.glb
for view in moved still; do
	step "what moves: G-buffer of what is $view" "$nook" gbuffer $view.glb --camera main \
		--projection "0.936157208822 0 0 0 0 1.66427948235 0 0 0 0 -1 -1 0 0 -0.2 0" --size $size --normals interpolated -o $view.exr
done
volumes="$out/nook_patterns/viewer/level.volumes.glb"
# bakes NAME LEVEL G-BUFFER OCCLUDER ARGUMENTS of nook shade
bakes()
{
	name=$1
	baked=$2
	view=$3
	occluder=$4
	shift 4
	moving=
	[ $view = g ] || moving="--moving crates.glb"
	step "$name: shade" "$nook" shade $view.exr "$@" -o known.exr
	# shellcheck disable=SC2086
	step "$name: viewer" "$viewer" "$baked" --volumes "$volumes" $moving --no-window --size $size --occluder $occluder --show visibility -o known.png
	step "$name: mean difference" "$nook" compare known.png known.exr --mask $view.exr --metric mae --max-error 0.002
	step "$name: 95 % of the pixels" "$nook" compare known.png known.exr --mask $view.exr --metric p95 --max-error 0.006
}
pattern=$(tile_of vo-line)
bakes "bake alone" baked.glb g bake --method bake --bake baked.glb
cp known.png alone.png
bakes "bake beside volumes" beside.glb g bake --method aov --volumes "$volumes" --bake beside.glb
bakes "bake, what moves" baked.glb moved moves --method vo-line --pattern "$pattern" --filter window --radius 0.5 --bake baked.glb
"$nook" compare known.png alone.png --metric mae --max-error 0.002 >log 2>&1 && problem "what moves: found nearly the picture without it"
bakes "bake beside volumes, what moves" beside.glb moved moves --method vo-line --pattern "$pattern" --filter window --radius 0.5 \
	--volumes "$volumes" --bake beside.glb
bakes "volumes, what moves" "$level" moved moves --method vo-line --pattern "$pattern" --filter window --radius 0.5 --volumes "$volumes" --static still.exr
step "bake: nothing moves" "$viewer" baked.glb --no-window --size $size --occluder moves --show visibility -o still.png
same still.png alone.png "a bake where nothing moves: not the picture of the bake alone"
step "bake: keys" "$viewer" baked.glb --no-window --size $size --show visibility --keys o -o keys.png
same keys.png alone.png "what the first key o of a level without volumes draws: not the bake alone"

# Half resolution: equally close to the kernels' half-resolution result, which differs from full resolution.
for method in alchemy vo-area; do
	step "$method: half, shade" "$nook" shade turned.exr --method $method --pattern "$(tile_of $method)" \
		--filter window --radius 0.5 --resolution half -o $method.half.exr
	step "$method: half, viewer" "$viewer" --no-window --size $size --method $method --show visibility --resolution half -o $method.half.png
	step "$method: half, flip" oiiotool $method.half.png --flip -o $method.flipped.png
	step "$method: half, mean difference" "$nook" compare $method.flipped.png $method.half.exr --mask turned.exr --metric mae --max-error 0.002
	step "$method: half, 95 % of the pixels" "$nook" compare $method.flipped.png $method.half.exr --mask turned.exr --metric p95 --max-error 0.006
	"$nook" compare $method.half.png $method.png --metric mae --max-error 0.01 >log 2>&1 && problem "$method: half and full: found nearly the same picture"
done

# Reaches the same picture through keys, and in a window.
step "keys" "$viewer" --no-window --size $size --keys "c c c c c 2 v z z" -o keys.png
same keys.png vo-point.png "five cameras on, the second method, visibility, reversed and back: not the same picture"
step "keys: half" "$viewer" --no-window --size $size --keys "3 v r v v v v v v" -o keys.png
same keys.png alchemy.half.png "the third method, visibility, half, six times what is shown: not the same picture"
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
step "foliage: shade" "$nook" shade leaves.exr --method vo-line --pattern "$(tile_of vo-line)" \
	--filter window --radius 0.5 -o leaves.v.exr
step "foliage: viewer" "$viewer" foliage.glb --no-window --size $size --show visibility -o leaves.png
step "foliage: the same picture" "$nook" compare leaves.png leaves.v.exr --mask leaves.exr --metric mae --max-error 0.05

# Over frames. The first four form a plain mean: that of the kernels on the CPU.
for method in vo-line alchemy; do
	frames=
	for frame in 0 1 2 3; do
		step "$method: frame $frame" "$nook" shade g.exr --method $method --pattern "$(tile_of $method)" --filter window --radius 0.5 \
			--frame $frame -o frame.$frame.exr
		frames="$frames frame.$frame.exr"
		[ $frame = 0 ] || frames="$frames --add"
	done
	step "$method: mean of four" oiiotool $frames --divc 4 -o four.exr
	step "$method: four frames" "$viewer" --no-window --size $size --method $method --show visibility --accumulate on --frames 4 -o four.png
	step "$method: four frames, mean difference" "$nook" compare four.png four.exr --mask g.exr --metric mae --max-error 0.0015
	step "$method: four frames, 95 % of the pixels" "$nook" compare four.png four.exr --mask g.exr --metric p95 --max-error 0.005
	"$nook" compare four.png $method.png --metric mae --max-error 0.0005 >log 2>&1 && problem "$method: one frame and four: found nearly the same picture"
done
step "keys: over frames" "$viewer" --no-window --size $size --keys "3 v t . . ." -o keys.png
same keys.png four.png "the third method, visibility, four frames: not the same picture"
step "keys: forget" "$viewer" --no-window --size $size --method alchemy --show visibility --accumulate on --keys "..x" -o keys.png
same keys.png alchemy.png "forgotten frames: not the picture of one"
step "keys: a still tile" "$viewer" --no-window --size $size --method alchemy --show visibility --accumulate on --keys "f..." -o keys.png
same keys.png alchemy.png "frames with the same samples: not the picture of one"
step "a still tile" "$viewer" --no-window --size $size --method alchemy --show visibility --accumulate on --tile still --frames 4 -o keys.png
same keys.png alchemy.png "--tile still: not the picture of one frame"

# A camera that moves for 32 frames: a single frame there, and the means. `ages` shows which pixels have just been uncovered.
for motion in still pan walk; do
	for mean in off on unchecked; do
		step "$motion: $mean" "$viewer" --no-window --size $size --show visibility --motion $motion --accumulate $mean --frames 32 \
			-o $motion.$mean.png
	done
	step "$motion: a still tile" "$viewer" --no-window --size $size --show visibility --motion $motion --accumulate on --tile still \
		--frames 32 -o $motion.tile.png
	step "$motion: ages" "$viewer" --no-window --size $size --show ages --motion $motion --accumulate on --frames 32 -o $motion.ages.png
	step "$motion: depth" "$viewer" --no-window --size $size --show depth --motion $motion --frames 32 -o $motion.depth.png
done
step "motion by keys" "$viewer" --no-window --size $size --motion pan --keys m --show visibility --frames 32 -o keys.png
same keys.png walk.off.png "the motion after a pan: not the same picture"
for motion in pan walk; do
	step "$motion: reversed" "$viewer" --no-window --size $size --show visibility --motion $motion --accumulate on --keys z --frames 33 \
		-o reversed.png
	step "$motion: forgotten" "$viewer" --no-window --size $size --show visibility --motion $motion --accumulate on --keys x --frames 33 \
		-o forgotten.png
	step "$motion: reversed depth" "$nook" compare reversed.png forgotten.png --metric mae --max-error 0.0005
done
for mean in off on; do
	step "walk: half resolution, $mean" "$viewer" --no-window --size $size --show visibility --motion walk --accumulate $mean --frames 32 \
		--resolution half -o half.$mean.png
done

# These views with a hundred lines per pixel instead of five: the reference for noise and ghosts.
sed -i 's/COUNTS 5 3 ${tile} --starts 1/COUNTS 100 3 PATTERN_OPTIONS --method vogel TILE_OPTIONS --kind even/' "$folder/the viewer/CMakeLists.txt"
step "build with a hundred lines" cmake --build "$out"
expect_made 6 "other counts: two patterns, their tiles, two modules"
for motion in still pan walk; do
	step "$motion: a hundred lines" "$viewer" --no-window --size $size --show visibility --motion $motion --frames 32 -o $motion.many.png
done
step "walk: a hundred lines, half resolution" "$viewer" --no-window --size $size --show visibility --motion walk --frames 32 \
	--resolution half -o half.many.png

# rmse FILE FILE [MASK]: root mean square difference where the mask is white.
rmse()
{
	picture=$1
	share=1
	if [ $# -eq 3 ]; then
		picture=masked.exr
		oiiotool "$1" "$2" --sub "$3" --mul "$2" --add -o $picture
		share=$(share_of "$3")
	fi
	"$nook" compare "$picture" "$2" | awk -v share="$share" '$1 == "rmse" && share > 0 { printf "%.4f", $2 / sqrt(share) }'
}
# share_of MASK: white fraction.
share_of()
{
	oiiotool --stats "$1" | awk '/Stats Avg/ { print $3 }'
}
# at_most WHAT FIGURE FACTOR FIGURE: the first value is at most FACTOR times the second.
at_most()
{
	echo "$1: $2, at most $3 x $4"
	awk -v a="$2" -v b="$3" -v c="$4" 'BEGIN { exit !(a != "" && c != "" && a + 0 <= b * c) }' || problem "$1: found $2, expected at most $3 x $4"
}
at_most "still: noise of the mean against one frame's" "$(rmse still.on.png still.many.png)" 0.33 "$(rmse still.off.png still.many.png)"
at_most "still: unchecked, too" "$(rmse still.unchecked.png still.many.png)" 0.33 "$(rmse still.off.png still.many.png)"
for motion in still pan walk; do
	at_most "$motion: error with other samples each frame, against a still tile's" "$(rmse $motion.on.png $motion.many.png)" 0.98 \
		"$(rmse $motion.tile.png $motion.many.png)"
	# Darkened, and uniform within 12/255 over 5 x 5 pixels.
	step "$motion: smooth" oiiotool $motion.many.png --dilate 5x5 $motion.many.png --erode 5x5 --sub --subc 0.049 --mulc -1000 \
		--clamp:min=0:max=1 $motion.many.png --subc 0.979 --mulc -1000 --clamp:min=0:max=1 --mul -o mask.exr
	at_most "$motion: a hundredth of the pixels, against smooth ones" 0.01 1 "$(share_of mask.exr)"
	at_most "$motion: error of the mean on smooth surfaces against one frame's" "$(rmse $motion.on.png $motion.many.png mask.exr)" 0.98 \
		"$(rmse $motion.off.png $motion.many.png mask.exr)"
done
at_most "walk: error of the mean against one frame's, half resolution" "$(rmse half.on.png half.many.png)" 1.1 "$(rmse half.off.png half.many.png)"
for motion in pan walk; do
	# In a single frame thin edges are dotted, even with 100 lines, which limits how close the mean can come.
	at_most "$motion: error of the mean against one frame's" "$(rmse $motion.on.png $motion.many.png)" 1.2 "$(rmse $motion.off.png $motion.many.png)"
	for age in 2 9; do
		# Surfaces whose mean has at most that many frames.
		step "$motion: mask" oiiotool $motion.ages.png --subc 0.$((age))5 --mulc -1000 --clamp:min=0:max=1 \
			$motion.depth.png --mulc 1000 --clamp:min=0:max=1 --mul -o mask.exr
		at_most "$motion: a hundredth of the pixels, against those that are counted" 0.01 1 "$(share_of mask.exr)"
		one=$(rmse $motion.off.png $motion.many.png mask.exr)
		at_most "$motion: surfaces seen for $age frames at most" "$(rmse $motion.on.png $motion.many.png mask.exr)" 1.2 "$one"
		at_most "$motion: the same without a check, which leaves ghosts" "$one" 0.6 "$(rmse $motion.unchecked.png $motion.many.png mask.exr)"
	done
done

# A level from a file is remade when it changes; changing the number of samples remakes everything that depends on it.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\n' >triangle.obj # a corner: a flat level has no volumes
sed -i 's/COUNTS 5 9/COUNTS 6 9/' "$folder/the viewer/CMakeLists.txt"
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
wrong 1 '--occluder: found .all., expected one of screen, both, volumes, bake, moves' --occluder all
wrong 1 '--occluder: found nothing of the level' --occluder bake
wrong 1 '--occluder: found nothing of the level' baked.glb --occluder volumes
wrong 2 'none.glb: cannot be read' --moving none.glb
wrong 2 'none.glb: cannot be read' --volumes none.glb
wrong 1 '--accumulate: found .yes., expected one of off, on, unchecked' --accumulate yes
wrong 1 '--tile: found .moving., expected one of frames, still' --tile moving
wrong 1 '--motion: found .run., expected one of still, pan, walk' --motion run
wrong 3 'level.glb: found .*, expected a file of nook volumes' --volumes "$out/nook_patterns/viewer/level.glb"
wrong 1 '--radius: found .0.' --radius 0
wrong 1 '--camera: found .none.' --camera none
wrong 1 '--colour' --colour 3
wrong 2 'none.glb: cannot be read' none.glb
wrong 2 '/none/x.png: cannot be written' --size 16x16 -o /none/x.png
wrong 3 'cut.glb' cut.glb
wrong 3 'triangle.obj: found no binary glTF' triangle.obj
(unset DISPLAY WAYLAND_DISPLAY; "$viewer" >log 2>&1)
[ $? -eq 5 ] || problem "no display: expected exit code 5, found: $(cat log)"
if canHide; then
	for library in libEGL.so.1 "libOpenGL.so.0 libGL.so.1"; do
		without "$library" "$viewer" --no-window --size 16x16 -o x.png >log 2>&1
		{ [ $? -eq 5 ] && [ "$(wc -l <log)" -eq 1 ] && grep -q 'EGL: found no libEGL.so.1 or no libOpenGL.so.0' log; } ||
			problem "without $library: expected exit code 5 and one line, found: $(cat log)"
	done
fi
finish
