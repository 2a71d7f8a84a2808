#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: same_bytes.sh OLD NEW [LEVEL...]. Runs commands that cover every output format with two builds of the program and compares all
# files, except the commit and the lines that contain times. Prints what differs; exit code 7 if anything does.
set -u
old=$(realpath -- "$1") && new=$(realpath -- "$2") || exit 1
shift 2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
compared=0
different=0

# both NAME ARGUMENTS: runs in old/ and new/, whose files then have to be the same.
both()
{
	name=$1
	shift
	for build in old new; do
		mkdir -p "$folder/$build"
		program=$old
		[ $build = old ] || program=$new
		(cd "$folder/$build" && "$program" "$@" >"$name.out" 2>"$name.err" </dev/null; echo $? >>"$name.out")
	done
	for file in $(cd "$folder/old" && find . -type f | sort); do
		compared=$((compared + 1))
		cmp -s "$folder/old/$file" "$folder/new/$file" && continue
		different=$((different + 1))
		echo "DIFFERS: $file: nook $*"
	done
	for build in old new; do # inputs of later commands stay
		rm -f "$folder/$build/$name.out" "$folder/$build/$name.err"
	done
}

for domain in disk ball sphere hemisphere; do
	both $domain pattern --domain $domain --count 7 --starts 2 -o $domain.json -o $domain.h -o $domain.glsl -o $domain.csv -o $domain.svg --json $domain.s.json
done
both electro pattern --domain disk --count 6 --method electro --starts 2 -o electro.json -o electro.hlsl
both tile tile --pattern disk.json --size 4 --filter binomial:3 --starts 1 -o tile.json -o tile.exr -o tile.ktx2 -o tile.glsl -o tile.h -o tile.svg
both frames tile --pattern disk.json --size 4 --filter box:4 --frames 4 --starts 1 -o frames.json
both slices tile --domain slice --size 4 -o slices.json -o slices.png
both info_tile info tile.json --filter binomial:3 --json info_tile.json
both info_disk info disk.json --json info_disk.json
both methods info --methods
for method in alchemy vo-line vo-point vo-area slices statvo; do
	both options_$method info --options $method
done
for glsl in 330 430 es300 vulkan; do
	both emit_$glsl emit --methods vo-line,alchemy,slices,statvo,vo-point,vo-area --patterns disk.json,ball.json --glsl $glsl -o m_$glsl.glsl -o m_$glsl.h -o m_$glsl.js
done
both emit_volumes emit --methods vo-line --volumes bounds --glsl 430 -o v.glsl
both catalogue catalogue --domain disk --counts 1-5 --tiles -o patterns
for level in builtin:cornell builtin:courtyard builtin:suburb builtin:cave:3000 builtin:foliage "$@"; do
	name=$(basename "$level" | tr -c 'a-z0-9\n' _)
	both level_$name level "$level" -o $name.glb --json level_$name.json
	both info_$name info "$level" --distance 1 --json info_$name.json
	both g_$name gbuffer "$level" --camera auto:1 --size 96x54 -o $name.g.exr --json g_$name.json
	both r_$name reference "$level" --gbuffer $name.g.exr --radius 1 --rays 16 -o $name.r.exr -o $name.r.png --json r_$name.json
	both b_$name reference "$level" --gbuffer $name.g.exr --radius 1 --rays 16 --measure bent -o $name.b.exr
	both v_$name volumes "$level" --distance 1 -o $name.v.glb --json v_$name.json
	both vi_$name info $name.v.glb --json vi_$name.json
	both k_$name bake "$level" --radius 1 --rays 16 -o $name.k.glb --json k_$name.json
	for method in vo-line vo-point vo-area alchemy slices statvo crytek volumetric-ao hbao sao gtao bitmask; do
		both s_$method shade $name.g.exr --method $method --radius 1 --device cpu -o $name.$method.exr
		both c_$method compare $name.$method.exr $name.r.exr --json $name.$method.json
	done
	both a_$name shade $name.g.exr --method aov --volumes $name.v.glb --device cpu -o $name.aov.exr
	both m_$name shade $name.g.exr --method aov-mask --volumes $name.v.glb --device cpu -o $name.mask.exr
done
both trim volumes builtin:heightfield:2000 --distance 1 --compensate --trim 0.1 --verify --detail auto -o trim.glb --json trim.json
both packed volumes builtin:suburb --distance 1 --compress -o packed.glb
both probes bake builtin:cornell --radius 1 --probes 0.5 --rays 48 -o probes.ktx2 -o probes.glsl
both split bake builtin:cornell --radius 1 --rays 64 --max-error 0.1 -o split.glb
both fit fit builtin:cornell --methods statvo,slices --views 1 --size 16x9 --rays 4 -o fit.recipes.json
both diff compare builtin_cornell.alchemy.exr builtin_cornell.r.exr --diff diff.png
for bad in 'pattern --domain disk --count 0 -o a.json' 'volumes gone.glb --distance 1 -o a.glb' 'shade disk.json --method vo-line -o a.exr' 'reference builtin:nothing --radius 1 -o a.exr'; do
	# shellcheck disable=SC2086 # words
	both bad $bad
done
echo "$compared files compared, $different differ"
[ $different = 0 ] || exit 7
