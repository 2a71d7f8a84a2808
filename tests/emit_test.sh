# SPDX-License-Identifier: GPL-3.0-or-later
# nook emit on the command line: its files, summary and errors.
# usage: emit_test.sh NOOK
set -u
nook=$1
. "$(dirname "$0")/command_line.sh"

"$nook" pattern --domain disk --count 5 --starts 1 -o kept_disk.json
"$nook" pattern --domain disk --count 12 --starts 1 --order progressive -o kept_order.json
"$nook" pattern --domain ball --count 6 --starts 1 -o kept_ball.json
"$nook" pattern --domain hemisphere --count 4 --starts 1 -o kept_up.json
"$nook" tile --pattern kept_disk.json --size 2 --kind random -o kept_tile.json

works '' emit --methods vo-line --patterns kept_disk.json --glsl 330 -o m.glsl
grep -q '^// Made by: nook emit --methods vo-line --patterns kept_disk.json --glsl 330$' m.glsl || problem "no command in $(head -1 m.glsl)"
grep -q '^// SPDX-License-Identifier: MIT$' m.glsl || problem "no licence"
cp m.glsl kept_first.glsl
works '"samples": *5' emit --methods vo-line --patterns "$PWD/kept_disk.json" --glsl 330 -o m.glsl -o m.h --json - --depfile m.d
same m.glsl kept_first.glsl "another folder, other bytes"
grep -q '^m.glsl m.h:' m.d && grep -q 'kept_disk.json$' m.d || problem "depfile: found '$(cat m.d)'"
there m.d m.glsl m.h
for target in 330 430 es300 vulkan; do
	works '' emit --methods vo-line,vo-point,alchemy --patterns kept_tile.json,kept_ball.json,kept_up.json --glsl $target -o m.glsl
done
there m.glsl
works '' emit --methods vo-line --patterns kept_order.json --counts 7 --glsl 430 -o m.glsl
grep -q 'vec4 nook_vo_line_samples\[7\]' m.glsl || problem "--counts 7: not seven samples"
works '' tile --pattern kept_disk.json --size 2 --starts 1 --progressive -o kept_ordered.json
works '' emit --methods vo-line --patterns kept_ordered.json --tile array --counts 3 --bands 2 --glsl 430 -o m.glsl
grep -q 'vec4 nook_vo_line_samples\[12\]' m.glsl || problem "--counts 3: not three samples in each of four variants"
works '#version 300 es' emit --methods vo-line --patterns kept_tile.json --tile array --use-normal no --main fragment --glsl es300 -o -
works '' emit --methods vo-line --patterns kept_tile.json -o m.h
grep -q 'nook_vo_line_tile\[20\]' m.h || problem "the header has no texels"
there m.glsl m.h

works '' emit --methods vo-line --patterns kept_tile.json --filter window --glsl 330 -o m.glsl
grep -q '^float nookWindow' m.glsl || problem "no filter"
there m.glsl

# JavaScript, normals from depth, a block of floats.
works '' emit --methods vo-line --patterns kept_tile.json --normals from-depth --block floats --glsl es300 -o m.glsl -o m.h -o m.js
grep -q 'nook_normals' m.glsl && problem "--normals from-depth: found a picture of normals"
grep -q '#define NOOK_NORMAL(pixel) nookNormalFromDepth(pixel)' m.glsl || problem "--normals from-depth: no normals"
grep -q 'vec2 first;' m.glsl && grep -q 'struct alignas(16) nook_float_block' m.h && grep -q "name: 'first', type: 'vec2'" m.js || problem "--block floats: found integers"
sed -n 's/^\/\/ Made by: //p' m.glsl m.js | uniq | wc -l | grep -qx 1 || problem "another command in the script than in the module"
there m.glsl m.h m.js
works '' emit --methods vo-line --patterns kept_tile.json -o m.js
grep -q '^// Made by: nook emit --methods vo-line --patterns kept_tile.json$' m.js || problem "no command in $(head -1 m.js)"
there m.js
# Device depth presets the header's settings, and two headers that read depth differently conflict.
works '' emit --methods vo-line --patterns kept_tile.json --depth device --glsl vulkan -o m.glsl -o m.h
grep -q 'settings.device_depth = true;' m.h && grep -q 'settings.zero_to_one = true;' m.h || problem "--depth device: found no presets"
grep -q '^// Made by: nook emit .* --depth device --glsl vulkan$' m.h || problem "--depth device: found another command in $(head -n 1 m.h)"
works '' emit --methods vo-line --patterns kept_tile.json --depth device --recipe paper --glsl 330 -o m.glsl -o kept_paper.h
grep -q 'settings.radius = reach;' kept_paper.h && grep -q 'settings.zero_to_one = false;' kept_paper.h || problem "--recipe paper: found no presets"
if command -v c++ >../log; then
	printf '#include "m.h"\n#include "kept_paper.h"\nint main() {}\n' >kept_both.cpp
	c++ -std=c++17 -fsyntax-only kept_both.cpp >../log 2>&1 && problem "two headers of other depths: compiled"
	grep -q 'reads depth in another way' ../log || problem "two headers of other depths: $(head -n 3 ../log)"
fi
there m.glsl m.h
# In languages with binding numbers everything has one; and no text can end a comment.
for target in 430 vulkan; do
	for method in "vo-line --patterns kept_tile.json --filter bilateral --resolution half" "vo-point --patterns kept_ball.json --filter bilateral" \
		"vo-area --patterns kept_tile.json --filter window --normals from-depth" "alchemy --patterns kept_up.json --depth-levels 3 --gather" \
		"statvo --skip yes" "slices --bent --filter bilateral --block floats" "aov" "aov-mask --directions 256"; do
		case $target$method in vulkanaov*) continue ;; esac
		works '' emit --methods $method --depth device --glsl $target -o m.glsl
		grep -E '^(layout\(.*\) )?(readonly )?(uniform|buffer) ' m.glsl | grep -v -e 'binding = ' -e 'location = ' -e 'push_constant' &&
			problem "$method $target: found something without a number"
		grep -n -i -e 'docs/' -e '[a-z]\.md' -e 'libsamples' -e '\.glsl ' -e '\.cpp' m.glsl && problem "$method $target: found a file of nook in a comment"
		grep -q 'depth read' m.glsl || problem "$method $target: found no number of depth reads"
	done
done
there m.glsl
fails 1 '--normals from-depth: found a module that asks for no normal' emit --methods vo-line --patterns kept_tile.json --use-normal no --normals from-depth --glsl 330 -o m.glsl
fails 1 "--patterns: found 'kept_tile.json,', expected names of files" emit --methods vo-line --patterns kept_tile.json, --glsl 330 -o m.glsl
fails 1 '--normals: found without a .glsl file' emit --methods vo-line --patterns kept_tile.json --normals from-depth -o m.h
fails 1 '--filter: found without a .glsl file' emit --methods vo-line --patterns kept_tile.json --filter window -o m.js
fails 1 "--block: found 'integers', expected mixed or floats" emit --methods vo-line --patterns kept_tile.json --block integers -o m.h
fails 1 '--block: found with --methods aov' emit --methods aov --block floats --glsl 330 -o m.glsl
fails 1 'm.js: found no shader' emit --methods aov --glsl 330 -o m.js
works '' emit --methods alchemy --patterns kept_up.json --depth-levels 2 --filter bilateral --resolution half --gather --glsl 330 -o m.glsl
for function in nookCoarser nookBilateralY nookAlchemyFull nookGather; do
	grep -q "^float $function(" m.glsl || problem "no $function"
done
works '' emit --methods vo-area,statvo --patterns kept_tile.json --thick --combine minimum --falloff quadratic --layers 2 --glsl vulkan -o m.glsl
grep -q 'push_constant' m.glsl || problem "no nook_pass"
there m.glsl
works '' emit --methods vo-line --patterns kept_tile.json --namespace low -o m.h
grep -q '^namespace low$' m.h && grep -q -- '--namespace low' m.h || problem "no namespace"
there m.h
fails 1 '--namespace: found without a .h or .cs file' emit --methods vo-line --patterns kept_tile.json --namespace low --glsl 330 -o m.glsl
fails 1 '--namespace: found .9low' emit --methods vo-line --patterns kept_tile.json --namespace 9low -o m.h
fails 1 '--namespace: found' emit --methods vo-line --patterns kept_tile.json --namespace '' -o m.h
fails 1 '--namespace' emit --methods aov --namespace low --glsl 330 -o m.glsl
fails 1 '--layers:.*expected statvo' emit --methods vo-line --patterns kept_tile.json --layers 2 --glsl 330 -o m.glsl
fails 1 '--taps:' emit --methods vo-line --patterns kept_tile.json --taps 7 --glsl 330 -o m.glsl
fails 3 'sample 0: found no other .*--paired' emit --methods vo-line --patterns kept_disk.json --paired --glsl 330 -o m.glsl
fails 3 'kept_tile.json: found samples in any order, expected for bands' emit --methods vo-line --patterns kept_tile.json --bands 2 --glsl 330 -o m.glsl
works '' emit --methods vo-line --patterns kept_tile.json --filter window --main fragment --glsl 330 -o m.glsl
grep -q '^#elif NOOK_PASS == 1$' m.glsl || problem "--main fragment with a filter: found no second pass"
there m.glsl
works '' emit --methods statvo,vo-point --patterns kept_ball.json --hlsl 60 --filter bilateral -o m.hlsl -o m.h -o m.cs -o m.py -o m.json
grep -q 'vec[234]' m.hlsl && problem "HLSL: found $(grep -m 1 'vec[234]' m.hlsl)"
there m.cs m.h m.hlsl m.json m.py
works '' emit --methods vo-line --patterns kept_tile.json --namespace low -o m.cs
grep -q '^namespace low$' m.cs || problem "no namespace in C#"
there m.cs
fails 1 '--main compute: found --glsl 330, which has no compute shaders' emit --methods slices --main compute --glsl 330 -o m.glsl
fails 1 '--main: found with --gather' emit --methods slices --main fragment --gather --glsl 330 -o m.glsl
fails 1 "--main: found 'vertex', expected fragment or compute" emit --methods slices --main vertex --glsl 330 -o m.glsl
fails 1 '--textures separate: found --glsl 430, expected --glsl vulkan' emit --methods slices --textures separate --glsl 430 -o m.glsl
fails 1 '--textures: found with --hlsl' emit --methods slices --textures macros --hlsl 60 -o m.hlsl
fails 1 '--glsl: found with --hlsl' emit --methods slices --glsl 330 --hlsl 60 -o m.glsl
fails 1 '--hlsl: missing' emit --methods slices -o m.hlsl
fails 1 'm.hlsl: found with --glsl, expected -o FILE.glsl' emit --methods slices --glsl 330 -o m.hlsl
fails 1 'm.glsl: found with --hlsl, expected -o FILE.hlsl' emit --methods slices --hlsl 60 -o m.glsl
fails 1 '--hlsl: found without a .hlsl' emit --methods slices --hlsl 60 -o m.cs
fails 1 "--hlsl: found '50', expected 60" emit --methods slices --hlsl 50 -o m.hlsl
fails 1 'm.py: found' emit --methods aov --glsl 330 -o m.py
fails 3 '--filter window: vo-line: found 1 variants' emit --methods vo-line --patterns kept_disk.json --filter window --glsl 330 -o m.glsl
works '' emit --methods slices --filter window --glsl 330 -o m.glsl
there m.glsl
fails 3 '--filter window: statvo: found 0 variants' emit --methods statvo --filter window --glsl 330 -o m.glsl
fails 1 '--methods:.*gtao.*expected.*alchemy' emit --methods vo-line,gtao --patterns kept_disk.json --glsl 330 -o m.glsl
fails 1 '--methods:.*once' emit --methods vo-line,vo-line --patterns kept_disk.json,kept_disk.json --glsl 330 -o m.glsl
fails 1 '--methods:' emit --methods vo-line, --patterns kept_disk.json --glsl 330 -o m.glsl
fails 1 '--patterns:.*as many' emit --methods vo-line --patterns kept_disk.json,kept_ball.json --glsl 330 -o m.glsl
fails 1 '--glsl: found .110' emit --methods vo-line --patterns kept_disk.json --glsl 110 -o m.glsl
fails 1 '--glsl: missing' emit --methods vo-line --patterns kept_disk.json -o m.glsl
fails 1 '--glsl: found without' emit --methods vo-line --patterns kept_disk.json --glsl 330 -o m.h
fails 1 '--cut:' emit --methods vo-line --patterns kept_disk.json --cut --glsl 330 -o m.glsl
fails 1 '--use-normal:' emit --methods alchemy --patterns kept_up.json --use-normal no --glsl 330 -o m.glsl
fails 1 '--main:.*one method' emit --methods vo-line,alchemy --patterns kept_disk.json,kept_up.json --main fragment --glsl 330 -o m.glsl
fails 1 '--tile:' emit --methods vo-line --patterns kept_disk.json --tile array --glsl 330 -o m.glsl
fails 1 '--counts:.*as many' emit --methods vo-line --patterns kept_order.json --counts 3,4 --glsl 330 -o m.glsl
fails 1 '--counts:' emit --methods vo-line --patterns kept_order.json --counts 0 --glsl 330 -o m.glsl
fails 1 '.*m.txt: found the ending' emit --methods vo-line --patterns kept_disk.json --glsl 330 -o m.txt
fails 1 'kept_disk.json: named twice' emit --methods vo-line --patterns kept_disk.json --glsl 330 -o m.glsl --json kept_disk.json
fails 2 'closed/none/m.glsl' emit --methods vo-line --patterns kept_disk.json --glsl 330 -o closed/none/m.glsl
fails 2 'missing.json' emit --methods vo-line --patterns missing.json --glsl 330 -o m.glsl
fails 3 'kept_ball.json: domain: found ball, expected disk for vo-line' emit --methods vo-line --patterns kept_ball.json --glsl 330 -o m.glsl
fails 3 'kept_disk.json: --counts: found 5 samples, expected 9 or more' emit --methods vo-line --patterns kept_disk.json --counts 9 --glsl 330 -o m.glsl
fails 3 'kept_disk.json: recipe:.*progressive' emit --methods vo-line --patterns kept_disk.json --counts 3 --glsl 330 -o m.glsl
fails 3 'kept_tile.json: --counts:' emit --methods vo-line --patterns kept_tile.json --counts 3 --glsl 330 -o m.glsl
# Volumes: stages that compile on their own.
for target in "330 core" "430 core" "300 es" "450 vulkan"; do
	version=$target
	case $target in
	300*) target=es300 ;;
	450*) target=vulkan version=450 ;;
	*) target=${target% core} ;;
	esac
	for method in "aov" "aov-mask" "aov-mask --directions 256" "aov --depth device"; do
		[ "$target ${method%% *}" = "es300 aov-mask" ] && continue
		works '"method": "aov' emit --methods $method --glsl $target -o m.glsl --json -
		grep -q "^// Made by: nook emit --methods $method --glsl $target$" m.glsl || problem "no command in $(head -1 m.glsl)"
		for stage in "VERTEX vert" "VERTEX_PRISMS vert" "VERTEX_CHOOSE_FACES vert" "VERTEX_ANY_DEPTH vert" "FRAGMENT frag" "RESOLVE frag" "SPARSE frag"; do
			set -- $stage
			{
				printf '#version %s\n#define NOOK_%s\n' "$version" "${1%%_*}"
				[ "$1" = "${1%%_*}" ] || echo "#define NOOK_${1#*_}"
				cat m.glsl
			} >stage.$2
			command -v glslangValidator >log || continue
			glslangValidator $([ $target = vulkan ] && echo "-V -o stage.spv") stage.$2 >log 2>&1 || problem "$method $target $1: $(grep -m 1 ERROR log)"
		done
		rm -f stage.vert stage.frag stage.spv log
	done
done
there m.glsl
fails 1 'aov-mask: found --glsl es300, which has no logic operations on render targets' emit --methods aov-mask --glsl es300 -o m.glsl
fails 1 '--glsl: missing' emit --methods aov -o m.glsl
fails 1 '--patterns: found with --methods aov' emit --methods aov --patterns kept_disk.json --glsl 330 -o m.glsl
fails 1 '--filter: found with --methods aov' emit --methods aov --filter window --glsl 330 -o m.glsl
fails 1 '--directions: found with another method, expected aov-mask' emit --methods aov --directions 64 --glsl 330 -o m.glsl
fails 1 '--directions: found .?48' emit --methods aov-mask --directions 48 --glsl 330 -o m.glsl
fails 1 '--directions: found with another method' emit --methods statvo --directions 64 --glsl 330 -o m.glsl
fails 1 'aov-mask: found --wgsl, which has no logic operations' emit --methods aov-mask --wgsl -o m.wgsl
fails 1 'm.glsl: found with --wgsl, expected -o FILE.wgsl' emit --methods slices --wgsl -o m.glsl
fails 1 '--wgsl: missing, expected one for the .wgsl file' emit --methods slices -o m.wgsl
fails 1 '--glsl: found with --wgsl, expected one language' emit --methods slices --wgsl --glsl 330 -o m.wgsl
fails 1 '--wgsl: found with --hlsl, expected one language' emit --methods slices --wgsl --hlsl 60 -o m.wgsl
fails 1 'm.glsl: found with --hlsl, expected -o FILE.hlsl' emit --methods aov --hlsl 60 -o m.glsl
fails 1 'm.h: found no shader' emit --methods aov --glsl 330 -o m.h
fails 1 '--methods:.*or aov or aov-mask alone' emit --methods aov,statvo --glsl 330 -o m.glsl
finish
