# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: webgpu_test.sh PROGRAM SOURCE FOLDER. nook emit --wgsl: complete shaders of every method and volumes, drawn by Dawn and by
# Firefox, equal the pictures of nook shade within 1/255. WebGPU for Node.js is downloaded from npm's registry once
# into FOLDER. Exit code 77: no npm, registry or Vulkan driver. Without Firefox, Dawn draws alone.
set -u
nook=$(realpath "$1")
source=$(realpath "$2")
cache=$3
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/npm_tools.sh"

npm_packages "$cache" webgpu@0.6.2
cp "$source"/tests/webgpu/*.mjs "$cache" || exit 1
firefox=$(command -v firefox-esr || command -v firefox) || echo "left out: found no Firefox, expected Debian's firefox-esr"
# Chromium's driver on the CPU, because Dawn refuses Mesa's as incomplete.
dawn=
[ -e /usr/lib/chromium/vk_swiftshader_icd.json ] && dawn="env VK_ICD_FILENAMES=/usr/lib/chromium/vk_swiftshader_icd.json"

# agree SCRIPT NAME…: the pictures of draw.mjs or volumes.mjs by both engines.
agree()
{
	script=$1
	shift
	for engine in Dawn ${firefox:+Firefox}; do
		case $engine in
		Dawn) $dawn node "$cache/$script" "$source" "$@" >said 2>log ;;
		Firefox) node "$cache/firefox.mjs" "$firefox" "$cache/$script" "$source" "$@" >said 2>log ;;
		esac
		code=$?
		[ $code = 77 ] && [ $engine = Dawn ] && skip "$(cat said)"
		[ $code = 77 ] && echo "left out: $engine: $(cat said)" && continue
		[ $code = 0 ] || problem "$engine: $script: exit code $code: $(tail -n 3 log said)"
		for name in "$@"; do
			checks=$((checks + 1))
			result=$(sed -n "s/^$name //p" said)
			[ -n "$result" ] && [ "${result##* }" = 0 ] || problem "$engine: $name: found '$result', expected no pixel beyond 1/255"
		done
		sed "s/^/$engine: /" said
	done
}

cd "$folder" || exit 1
for domain in disk ball hemisphere; do
	"$nook" pattern --domain $domain --count 6 --starts 1 -o $domain.json || problem "$domain: not made"
	"$nook" tile --pattern $domain.json --size 4 --kind random -o ${domain}_tile.json || problem "$domain: no tile"
done
"$nook" pattern --domain disk --count 6 --order progressive --starts 1 -o bands.json || problem "bands: not made"
"$nook" gbuffer builtin:suburb --camera auto:1 --size 80x48 -o g.exr || problem "no G-buffer"
names=

# drawn NAME METHOD SAMPLES EMIT_OPTIONS OPTIONS…: a complete shader, and the picture and passes of nook shade.
drawn()
{
	name=$1
	method=$2
	samples=$3
	emits=$4
	shift 4
	"$nook" emit --methods "$method" ${samples:+--patterns "$samples"} --wgsl --main fragment $emits "$@" -o "$name.wgsl" || problem "$name: not emitted"
	for file in exr json; do
		"$nook" shade g.exr --method "$method" ${samples:+--pattern "$samples"} --radius 1.5 "$@" -o "$name.$file" || problem "$name: not drawn"
	done
	names="$names $name"
}
drawn lines vo-line disk_tile.json "" --filter window
drawn lines-normals vo-line disk_tile.json "--tile array" --normals from-depth --filter bilateral --falloff quadratic
drawn lines-half vo-line disk_tile.json "--block floats" --filter bilateral --resolution half
drawn lines-bands vo-line bands.json "" --bands 3 --filter none --recipe paper
drawn points vo-point ball_tile.json "" --filter bilateral
drawn areas vo-area disk_tile.json "" --filter bilateral
drawn alchemy alchemy hemisphere_tile.json "" --filter window --depth-levels 3
drawn alchemy-cut alchemy hemisphere.json "" --cut --filter none --recipe paper
drawn statvo statvo "" "" --quadrants --filter bilateral
drawn statvo-uniform statvo "" "--block floats" --layering uniform --layers 8 --tables half --filter none --recipe paper
drawn slices slices "" "" --filter bilateral --slices 2
drawn slices-bent slices "" "" --bent --filter bilateral
lines="--methods vo-line --patterns disk_tile.json --filter window --wgsl"
"$nook" emit $lines --main fragment -o nook_vo.js || problem "page: not emitted"
"$nook" emit $lines --main compute -o compute.wgsl || problem "compute: not emitted"
cp lines.json compute.json
cp lines.exr compute.exr
cp lines.exr page.exr
names="$names compute page"
echo '{ "type": "module" }' >package.json # for nook_vo.js
agree draw.mjs $names

# Volumes: with and without depth clamp, faces chosen one by one, prisms, an eye within volumes, a depth buffer.
volumes=
# scene NAME EMIT_OPTIONS VOLUME_OPTIONS CAMERA_OPTIONS…
scene()
{
	name=$1 emits=$2 makes=$3
	shift 3
	"$nook" emit --methods aov $emits --wgsl -o "$name.wgsl" && "$nook" volumes builtin:cornell --distance 0.4 $makes -o "$name.glb" >log 2>&1 &&
		"$nook" gbuffer builtin:cornell --size 80x60 "$@" -o "$name.exr" >log 2>&1 &&
		"$nook" shade "$name.exr" --method aov --volumes "$name.glb" -o "${name}_expected.exr" >log 2>&1 || problem "$name: $(tail -n 1 log)"
	volumes="$volumes $name"
}
scene volumes "" ""
scene volumes-clip "" ""
scene volumes-faces "" --exact-bounds
scene volumes-prisms "" "--layout prisms"
scene volumes-within "" "" --eye 0.1,0.3,0.2 --target=-0.2,0.1,-0.4
scene volumes-device-clip "--depth device" ""
agree volumes.mjs $volumes
finish
