# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: bake_cli_test.sh PROGRAM. nook bake: outputs, summaries and errors.
set -u
nook=$1
source=$(cd "$(dirname "$0")/.." && pwd)
. "$(dirname "$0")/command_line.sh"

works '--fit' bake --help
works '^bake: 144 vertices, ' bake builtin:cornell --radius 0.5 --rays 16 -o b.glb
works '^level: b.glb, ' info b.glb
there b.glb
works '"rmse": 0[.][01]' bake builtin:cornell --radius 0.5 --json -
works '"fit": "points"' bake builtin:cornell --radius 0.5 --fit points --json -
works '' bake builtin:cornell --radius 0.5 --rays 16 -o plain.glb --json s.json
works '' bake builtin:cornell --radius 0.5 --rays 16 --color -o colors.glb --json s.json
grep -aq COLOR_0 colors.glb && ! grep -aq COLOR_0 plain.glb || problem "--color: found it in both files or in none"
there colors.glb plain.glb s.json
works '^bent normals: [0-9.]* degrees' bake builtin:cornell --radius 0.5 --rays 16 --bent -o bent.glb
works '"bent_angle_deg": ' bake builtin:cornell --radius 0.5 --rays 16 --bent --fit points --json -
works '"sides": "mean"' bake builtin:foliage --radius 0.5 --rays 1 --sides mean --json - -o mean.glb
works '"sides": "separate"' bake builtin:foliage --radius 0.5 --rays 1 --json - -o sides.glb
grep -aq _BENT_NORMAL bent.glb && ! grep -aq _BENT_NORMAL sides.glb || problem "--bent: found it in both files or in none"
grep -aq _VISIBILITY_BACK sides.glb && ! grep -aq _VISIBILITY_BACK mean.glb || problem "--sides: found backs in both files or in none"
there bent.glb mean.glb sides.glb
fails 1 '--bent: found with --probes' bake builtin:cornell --radius 1 --probes 1 --bent -o p.ktx2
fails 1 '--sides: found with --texture' bake kept_box.obj --radius 1 --texture 64 --sides mean -o t.glb
fails 1 '--sides: found' bake builtin:cornell --radius 1 --sides both -o b.glb
works '"radius_m": null' bake builtin:cornell --radius inf --rays 4 --json -
works '"falloff_u_m": 0.05' bake builtin:cornell --radius 0.5 --falloff alchemy --rays 4 --json -

works '"stopped_by": "(max-error|shortest-edge)"' bake builtin:cornell --radius 0.5 --max-error 0.05 --json -
works '^refined: ' bake builtin:cornell --radius 0.5 --max-error 0.1 -o b.glb
there b.glb
"$nook" bake builtin:cornell --radius 0.5 --max-error 0.01 --max-vertices 200 --json s.json -o b.glb 2>../stderr
grep -q '^nook: warning: --max-vertices: 200 left [0-9]* triangles with errors above 0.01$' ../stderr || problem "--max-vertices: found '$(cat ../stderr)'"
grep -q '"stopped_by": "max-vertices"' s.json || problem "--max-vertices: found $(cat s.json)"
there b.glb s.json

works '^probes: ' bake builtin:cornell --radius 0.5 --probes 0.2 --rays 60 -o p.ktx2 -o p.glsl
# The texture is VK_FORMAT_R8G8B8A8_UNORM with the number of texels that the function states.
[ "$(od -An -tu4 -j12 -N4 p.ktx2 | tr -d ' ')" = 37 ] || problem "p.ktx2: found another format than 37"
size=$(od -An -tu4 -j20 -N12 p.ktx2 | awk '{ print $1 ", " $2 ", " $3 }')
grep -q "ivec3($size);" p.glsl || problem "p.ktx2: found $size texels, expected those of $(grep ivec3 p.glsl | head -n 1)"
if command -v glslangValidator >../stdout; then
	for version in '330 core' '300 es'; do
		{
			printf '#version %s\n#ifdef GL_ES\nprecision highp float;\nprecision highp int;\nprecision highp sampler3D;\n#endif\n' "$version"
			cat p.glsl
			printf 'uniform sampler3D probes;\nin vec3 p;\nin vec3 n;\nout vec4 c;\nvoid main() { c = vec4(nookProbeVisibility(probes, p, n)); }\n'
		} >../p.frag
		glslangValidator ../p.frag >../log 2>&1 || problem "p.glsl as $version: $(cat ../log)"
	done
fi
there p.glsl p.ktx2
# The six faces of a box, each with its own place in the texture.
cat >kept_box.obj <<'EOT'
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
vt 0.02 0.02
vt 0.30 0.02
vt 0.30 0.47
vt 0.02 0.47
vt 0.35 0.02
vt 0.63 0.02
vt 0.63 0.47
vt 0.35 0.47
vt 0.68 0.02
vt 0.96 0.02
vt 0.96 0.47
vt 0.68 0.47
vt 0.02 0.52
vt 0.30 0.52
vt 0.30 0.97
vt 0.02 0.97
f 1/1 4/4 3/3 2/2
f 5/5 6/6 7/7 8/8
f 1/9 2/10 6/11 5/12
f 4/13 8/14 7/15 3/16
EOT
works '^texture: 64 x 64 texels, [0-9]* of them in 4 charts, 0 in more than one' bake kept_box.obj --radius 0.5 --texture 64 --rays 16 -o t.glb
works '' info t.glb
there t.glb
works '"coordinates": "first"' bake kept_box.obj --radius 0.5 --texture 16 --rays 4 --json -
sed 's|^vt 0.35|vt 0.05|; s|^vt 0.63|vt 0.33|' kept_box.obj >kept_overlap.obj
sed 's|^vt 0.96|vt 1.96|' kept_box.obj >kept_outside.obj
sed 's|/[0-9]*||g; /^vt/d' kept_box.obj >kept_without.obj
fails 3 'kept_overlap.obj: texture coordinates: found triangles that overlap' bake kept_overlap.obj --radius 1 --texture 64 -o t.glb
fails 3 'kept_outside.obj: texture coordinates: found some from' bake kept_outside.obj --radius 1 --texture 64 -o t.glb
fails 3 'kept_without.obj: texture coordinates: found none' bake kept_without.obj --radius 1 --texture 64 -o t.glb
fails 3 'builtin:cornell: texture coordinates: found' bake builtin:cornell --radius 1 --texture 64 -o t.glb
works '"png_bytes": ' bake kept_box.obj --radius 0.5 --texture 64 --rays 16 -o p.exr -o p.png -o t.glb -o p.ktx2 --json -
[ "$(wc -c <p.ktx2)" -gt $((8 * (256 + 64 + 16 + 4 + 1 + 1 + 1))) ] || problem "p.ktx2: found $(wc -c <p.ktx2) bytes, expected seven levels"
there p.exr p.ktx2 p.png t.glb
fails 1 'p.png: found' bake kept_box.obj --radius 0.5 -o p.png
for size in 0 15 8193 65536 -1 1e3; do
	fails 1 '--texture: found' bake kept_box.obj --radius 1 --texture $size -o t.glb
done
fails 1 '--fit: found with --texture' bake kept_box.obj --radius 1 --texture 64 --fit surface -o t.glb
fails 1 '--texture: found with --probes' bake kept_box.obj --radius 1 --texture 64 --probes 1 -o p.ktx2
works '"buried_probes": ' bake builtin:cornell --radius 0.5 --probes 0.5 --rays 6 --json -
fails 1 '--probes: found more than 2048' bake builtin:cornell --radius 1 --probes 1e-5 -o p.ktx2
fails 1 '--probes: found [0-9]* probes in the level, expected at most 16777216' bake builtin:cornell --radius 1 --probes 0.004 -o p.ktx2
fails 1 '--probes: found' bake builtin:cornell --radius 1 --probes 0 -o p.ktx2
fails 1 '--fit: found with --probes' bake builtin:cornell --radius 1 --probes 1 --fit surface -o p.ktx2
fails 1 '--color: found with --probes' bake builtin:cornell --radius 1 --probes 1 --color -o p.ktx2
fails 1 '' bake builtin:cornell --radius 1 --probes 1 -o p.glb
fails 1 '' bake builtin:cornell --radius 1 -o p.ktx2
# Shading: alone, with volumes, under a screen-space method, with a moving object.
cat >kept_still.obj <<'EOT'
v -2 0 2
v 2 0 2
v 2 0 -2
v -2 0 -2
v -2 0 -1
v 2 0 -1
v 2 2 -1
v -2 2 -1
f 1 2 3 4
f 5 6 7 8
EOT
cat kept_still.obj - >kept_moved.obj <<'EOT'
v 0 0.5 0.5
v 0.5 0.5 0.5
v 0.5 0.5 0
v 0 0.5 0
f 9 10 11 12
EOT
view='--eye 0,1.5,4 --target 0,0.3,0 --fov 50 --size 64x36'
# shellcheck disable=SC2086 # words
{
	works '' gbuffer kept_still.obj $view -o kept_still.exr
	works '' gbuffer kept_moved.obj $view -o kept_moved.exr
	works '' gbuffer kept_moved.obj --eye 0,1.5,5 --target 0,0.3,0 --fov 50 --size 64x36 -o kept_other.exr
}
works '' bake kept_still.obj --radius 1 --falloff linear --max-error 0.02 -o kept_b.glb --json s.json
works '' volumes kept_still.obj --distance 0.6 --ray-distance 1 -o kept_v.glb --json s.json
works '"beside": "aov",' bake kept_still.obj --radius 1 --falloff linear --volumes kept_v.glb -o kept_d.glb --json -
# Warns if volumes are closer to rays than a bake with few rays.
works '' volumes builtin:heightfield:2000 --distance 6 --ray-distance 10 --exact-bounds -o hills_v.glb --json s.json
"$nook" bake builtin:heightfield:2000 --radius 10 --falloff linear --rays 4 --volumes hills_v.glb -o hills_d.glb --json s.json 2>../stderr
grep -q '^nook: warning: hills_v.glb: found an RMSE of .* with the difference baked, expected less than the .* of the volumes alone' ../stderr ||
	problem "--volumes that are nearer alone: found '$(cat ../stderr)'"
there hills_d.glb hills_v.glb s.json
works '"beside": "aov-mask",' bake kept_still.obj --radius 1 --volumes kept_v.glb --volumes-by aov-mask --directions 64 -o kept_m.glb --json -
works '' reference kept_still.obj --gbuffer kept_still.exr --radius 1 --falloff linear -o kept_r.exr
works '"moving_pixels": 0' shade kept_still.exr --method bake --bake kept_b.glb -o kept_1.exr --json -
works '^rmse +0[.]0[01]' compare kept_1.exr kept_r.exr
works '"moving_pixels": 0' shade kept_still.exr --method aov --volumes kept_v.glb --bake kept_d.glb -o kept_2.exr --json -
works '' shade kept_still.exr --method aov-mask --directions 64 --volumes kept_v.glb --bake kept_m.glb -o kept_3.exr
# Nothing moves: screen-space methods do not darken the static level.
works '' shade kept_still.exr --method vo-line --bake kept_b.glb -o kept_4.exr
works '^max +0 ' compare kept_4.exr kept_1.exr --max-error 0
works '' shade kept_still.exr --method vo-line --volumes kept_v.glb --static kept_still.exr -o kept_5.exr
works '' shade kept_still.exr --method aov --volumes kept_v.glb -o kept_6.exr
works '^max +0 ' compare kept_5.exr kept_6.exr --max-error 0
works '"moving_pixels": [1-9]' shade kept_moved.exr --method vo-line --bake kept_b.glb -o kept_7.exr --json -
works '"moving_pixels": [1-9]' shade kept_moved.exr --method vo-line --volumes kept_v.glb --bake kept_d.glb -o kept_8.exr --json -
works '"moving_pixels": [1-9]' shade kept_moved.exr --method vo-line --volumes kept_v.glb --static kept_still.exr -o kept_9.exr --json -
rm -f kept_[1-9].exr
fails 1 '--bake: found none' shade kept_still.exr --method bake -o v.exr
fails 1 '--volumes: found with --method bake' shade kept_still.exr --method bake --bake kept_b.glb --volumes kept_v.glb -o v.exr
fails 1 '--static: found with --bake' shade kept_still.exr --method vo-line --bake kept_b.glb --static kept_still.exr -o v.exr
fails 1 '--static: found without --volumes' shade kept_still.exr --method vo-line --static kept_still.exr -o v.exr
fails 1 '--static: found without a screen-space method' shade kept_still.exr --method aov --volumes kept_v.glb --static kept_still.exr -o v.exr
fails 1 '--device: found with --method bake' shade kept_still.exr --method bake --bake kept_b.glb --device gl -o v.exr
fails 1 '--radius: found with --method bake' shade kept_still.exr --method bake --bake kept_b.glb --radius 1 -o v.exr
fails 1 '--debug: found with --bake' shade kept_still.exr --method vo-line --bake kept_b.glb --debug samples -o v.exr
fails 3 'kept_d.glb: found the difference to volumes .aov., expected visibility' shade kept_still.exr --method bake --bake kept_d.glb -o v.exr
fails 3 'kept_b.glb: found visibility, expected the difference to volumes' shade kept_still.exr --method aov --volumes kept_v.glb --bake kept_b.glb -o v.exr
fails 3 'kept_d.glb: found the difference to volumes .aov., expected' shade kept_still.exr --method aov-mask --volumes kept_v.glb --bake kept_d.glb -o v.exr
fails 3 'kept_still.obj: found no attribute _VISIBILITY' shade kept_still.exr --method bake --bake kept_still.obj -o v.exr
fails 3 'kept_other.exr: found another size or camera' shade kept_still.exr --method vo-line --volumes kept_v.glb --static kept_other.exr -o v.exr
fails 1 '--volumes-by: found no volumes' bake kept_still.obj --radius 1 --volumes-by aov -o b.glb
fails 1 '--directions: found with another method, expected aov-mask' bake kept_still.obj --radius 1 --volumes kept_v.glb --directions 64 -o b.glb
fails 1 '--directions: found .33.' bake kept_still.obj --radius 1 --volumes kept_v.glb --volumes-by aov-mask --directions 33 -o b.glb
fails 1 '--volumes: found with --bent' bake kept_still.obj --radius 1 --volumes kept_v.glb --bent -o b.glb
fails 3 'kept_b.glb: ' bake kept_still.obj --radius 1 --volumes kept_b.glb -o b.glb
# A value out of range: the first float of the file that is 1.
"$nook" bake kept_still.obj --radius 0.01 --rays 1 -o kept_b.glb --json s.json
LC_ALL=C sed 's/\x00\x00\x80\x3f\x00\x00\x80\x3f\x00\x00\x80\x3f/\x00\x00\x80\x40\x00\x00\x80\x40\x00\x00\x80\x40/g' kept_b.glb >kept_bad.glb
cmp -s kept_b.glb kept_bad.glb && problem "kept_bad.glb: found nothing changed"
fails 3 'kept_bad.glb: _VISIBILITY: found 4, expected values from 0 to 1' shade kept_still.exr --method bake --bake kept_bad.glb -o v.exr
there s.json
# Into a glTF: additions only, twice like once, over itself, and every target.
cat >kept_two.gltf <<'EOT'
{
	"asset": {"version": "2.0", "extras": {"by": "hand"}}, "scene": 0, "scenes": [{"nodes": [1, 0]}],
	"unknown": [1.50, -0, 1e-7, "\u00e9"], "extensionsUsed": ["EXT_of_nobody"], "extensions": {"EXT_of_nobody": {"b": 1, "a": 2}},
	"nodes": [{"name": "low", "mesh": 0, "extras": 3}, {"name": "high", "mesh": 0, "translation": [0, 0.25, 0], "scale": [2, 2, 2]}],
	"materials": [{"doubleSided": true, "occlusionTexture": {"index": 0, "strength": 0.5}}], "textures": [{"source": 0}],
	"images": [{"uri": "none here.png"}],
	"meshes": [{"primitives": [{"attributes": {"TEXCOORD_0": 1, "POSITION": 0, "COLOR_0": 2}, "indices": 3, "material": 0}]}],
	"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 0, 1]},
		{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
		{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
		{"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
	"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 32}, {"buffer": 0, "byteOffset": 80, "byteLength": 12}],
	"buffers": [{"byteLength": 92, "uri": "kept_two.bin"}]
}
EOT
# A floor of two triangles: its corners, their coordinates, its indices.
printf '\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\200\077\000\000\200\077\000\000\000\000\000\000\200\077\000\000\200\077\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000\200\077\000\000\200\077\000\000\200\077\000\000\200\077\000\000\000\000\000\000\001\000\002\000\000\000\002\000\003\000' >kept_two.bin
# additions BEFORE AFTER [ATTRIBUTE ...]
additions()
{
	command -v python3 >../stdout || return
	python3 "$source/tests/additions.py" "$@" >../log 2>&1 || problem "additions $*: $(cat ../log)"
}
mkdir kept_folder
works '"shared_meshes": 1' bake kept_two.gltf --radius 1 --rays 32 -o kept_2.gltf -o kept_2.glb -o kept_folder/2.gltf --json -
additions kept_two.gltf kept_2.gltf
grep -q '"uri": "../none%20here.png"' kept_folder/2.gltf || problem "kept_folder/2.gltf: found other names than those from there"
works '' info kept_folder/2.gltf --allow-outside
works '^baked: visibility, radius 1.0 m, falloff hard, 32 rays' info kept_2.glb
works '^bake command: nook bake kept_two.gltf --radius 1 --rays 32' info kept_2.gltf
works '' bake kept_2.glb --radius 1 --rays 32 --to color -o kept_3.glb --json s.json
works '"mesh_copies": 0' bake kept_3.glb --radius 1 --rays 32 --instances shared -o kept_4.glb --json -
works '' bake kept_two.gltf --radius 1 --rays 32 -o kept_5.gltf --json s.json
works '' bake kept_5.gltf --radius 1 --rays 32 --to color-alpha -o kept_6.gltf --json s.json
works '' bake kept_6.gltf --radius 1 --rays 32 -o kept_6.gltf --json s.json
sed 's/kept_[26].gltf/kept_two.gltf/' kept_6.gltf | cmp -s - kept_5.gltf || problem "baking again: found another file than baking once"
# Edited by hand after the bake: its undo may mean other items.
works '' bake kept_two.gltf --radius 1 --rays 32 --to color -o kept_8.gltf --json s.json
sed 's/"name": "low"/"name": "lower"/' kept_8.gltf >kept_other.gltf
fails 3 'kept_other.gltf: COLOR_0: found an earlier bake in a file that was changed since' bake kept_other.gltf --radius 1 --to color -o b.gltf
sed 's/"name": "low"/"name": "lower"/' kept_5.gltf >kept_other.gltf
works '' bake kept_other.gltf --radius 1 --rays 32 -o kept_8.gltf --json s.json
works '' info kept_8.gltf
for to in color color-alpha texcoord:1 texcoord:3 custom:AO visibility; do
	works "\"to\": \"$to\"" bake kept_two.gltf --radius 1 --rays 32 --to $to -o kept_7.gltf --json -
	additions kept_two.gltf kept_7.gltf COLOR_0
	works '' info kept_7.gltf
done
fails 5 'kept_two.gltf: nodes\[0\].extras: found no object' bake kept_two.gltf --radius 1 --instances attribute -o b.gltf
sed 's/"extras": 3/"extras": {"a": 3}/' kept_two.gltf >kept_other.gltf
works '"mesh_copies": 0' bake kept_other.gltf --radius 1 --rays 32 --instances attribute -o kept_7.gltf --json -
additions kept_other.gltf kept_7.gltf
grep -q nook_visibility kept_7.gltf || problem "--instances attribute: found no factor"
works '' bake kept_two.gltf --radius 1 --rays 32 -o values.csv -o values.npy -o values.json --json s.json
[ "$(wc -l <values.csv)" -eq 9 ] || problem "values.csv: found $(wc -l <values.csv) lines, expected two nodes of four vertices"
there s.json values.csv values.json values.npy
sed 's/"doubleSided": true/&, "alphaMode": "BLEND"/' kept_two.gltf >kept_other.gltf
"$nook" bake kept_other.gltf --radius 1 --rays 32 --to color-alpha -o blend.csv >../stdout 2>../log
grep -q 'color-alpha: 1 materials have no value' ../log || problem "--to color-alpha: found no warning: $(cat ../log)"
[ "$(cut -d, -f5 blend.csv | sort -u | wc -l)" -eq 2 ] || problem "blend.csv: found values of a material that has none: $(sort -u blend.csv)"
fails 3 'kept_two.gltf: TEXCOORD_0: found it in use, expected a set that is free, as --to texcoord:1' bake kept_two.gltf --radius 1 --to texcoord:0 -o b.gltf
sed 's/"COLOR_0"/"_VISIBILITY"/' kept_two.gltf >kept_other.gltf
fails 3 'kept_other.gltf: _VISIBILITY: found an accessor of VEC3, component type 5126, expected SCALAR' bake kept_other.gltf --radius 1 -o b.gltf
sed 's/{"by": "hand"}/4/' kept_two.gltf >kept_other.gltf
fails 5 'kept_other.gltf: asset.extras: found no object' bake kept_other.gltf --radius 1 -o b.gltf
sed 's/"path": *"/"path": "\/nothing/' kept_5.gltf >kept_other.gltf
fails 3 'kept_other.gltf: asset.extras.nook.undo: found no patch of this file' bake kept_other.gltf --radius 1 -o b.gltf
for to in texcoord texcoord:8 custom: 'custom:a b' color:1 grey; do
	fails 1 '--to: found' bake kept_two.gltf --radius 1 --to "$to" -o b.gltf
done
# Coordinates of its own: in the next set of each file, with all else as it was, and the same after baking again.
unwrapped()
{
	command -v python3 >../stdout || return
	python3 "$source/tests/unwrapped.py" "$@" >../log 2>&1 || problem "unwrapped $*: $(cat ../log)"
}
works '^unwrapped: 2 charts on 1 page, texels of 0.0[0-9]* m, coverage 0.[3-9][0-9]*, stretch 1' bake kept_two.gltf --radius 1 --rays 8 --unwrap --texture 64 -o kept_u.gltf --threads 1
unwrapped kept_two.gltf kept_u.gltf
works '"shared_meshes": 1' bake kept_u.gltf --radius 1 --rays 8 --unwrap --texture 64 -o kept_v.gltf --threads 2 --json -
sed 's/kept_[uv].gltf/kept_two.gltf/' kept_v.gltf >b.gltf
sed 's/kept_[uv].gltf/kept_two.gltf/' kept_u.gltf | cmp -s - b.gltf || problem "--unwrap again: found another file than once"
works '"pages": [23],' bake kept_two.gltf --radius 1 --rays 8 --unwrap --texture 32 --texel-size 0.1 --pages 4 --margin 1 -o kept_w.glb --json -
unwrapped kept_two.gltf kept_w.glb
works '' bake kept_two.gltf --radius 1 --rays 8 --unwrap --texture 32 --texel-size 0.1 --pages 4 --margin 1 -o b.png -o b.glb --json s.json
[ -s b-1.png ] && [ -s b-2.png ] && [ -s b.glb ] || problem "--pages: found $(echo b*), expected a picture for each page"
rm -f b-*.png
fails 1 '--unwrap: found only textures to write' bake kept_two.gltf --radius 1 --unwrap -o b.png
works '"texels_across": 128,' bake kept_two.gltf --radius 1 --rays 8 --unwrap --texel-size 0.03 -o b.glb --json -
works '^level: kept_w.glb, 4 triangles' info kept_w.glb --allow-outside
works '' bake kept_u.gltf --radius 1 --rays 8 -o kept_v.gltf --json s.json
additions kept_two.gltf kept_v.gltf
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 2 0\nf 1 2 3\nf 1 2 3\nf 3 2 1\nf 1 3 4\nf 1 3 2 4\nf 1 3 5\nf 1 1 2\n' >kept_soup.obj
works '"pages": 1,' bake kept_soup.obj --radius 1 --rays 8 --unwrap --texture 64 -o b.glb --json -
sed 's/"TEXCOORD_0": 1/"TEXCOORD_0": 1, "TEXCOORD_1": 1, "TEXCOORD_2": 1, "TEXCOORD_3": 1, "TEXCOORD_4": 1, "TEXCOORD_5": 1, "TEXCOORD_6": 1, "TEXCOORD_7": 1/' kept_two.gltf >kept_full.gltf
fails 3 'kept_full.gltf: meshes: found no free set of texture coordinates' bake kept_full.gltf --radius 1 --unwrap -o kept_full.gltf
fails 3 'kept_two.gltf: unwrap: found 2 charts that 1 page of 16 texels do not hold' bake kept_two.gltf --radius 1 --unwrap --texture 16 --margin 8 -o b.glb
fails 1 '--texel-size: found without' bake kept_two.gltf --radius 1 --texel-size 1 -o b.glb
fails 1 '--pages: found without' bake kept_two.gltf --radius 1 --texture 64 --pages 2 -o b.glb
fails 1 '--margin: found without' bake kept_two.gltf --radius 1 --texture 64 --margin 2 -o b.glb
fails 1 '--unwrap: found with --to color' bake kept_two.gltf --radius 1 --unwrap --to color -o b.glb
fails 1 '--unwrap: found with --probes' bake kept_two.gltf --radius 1 --unwrap --probes 1 -o b.glb
rm -f b.gltf b.glb s.json
# Parts: a lamp that is ignored darkens as little as none, and nodes that receive nothing keep their mesh.
sed 's/"name": "high"/"name": "Lamp, old"/; s/"extras": 3/"extras": {"kind": "floor"}/' kept_two.gltf >kept_parts.gltf
sed 's/"nodes": .1, 0./"nodes": [0]/' kept_parts.gltf >kept_alone.gltf
works '' bake kept_alone.gltf --radius 1 --rays 32 -o kept_alone.csv --json s.json
works '"parts": ."/Lamp, old/meshes.0.", "/low/meshes.0."' info kept_parts.gltf --json -
for parts in 'Lamp*' '/Lamp*' 'Lamp? old' 'none,Lamp*'; do
	case $parts in
	none*) fails 1 "--ignore: found 'none', expected parts of kept_parts.gltf: '/Lamp, old/meshes" bake kept_parts.gltf --radius 1 --ignore "$parts" -o b.csv ;;
	*)
		works '' bake kept_parts.gltf --radius 1 --rays 32 --ignore "$parts" -o b.csv --json s.json
		cmp -s b.csv kept_alone.csv || problem "--ignore $parts: found other values than without the part"
		;;
	esac
done
rm -f b.csv blend.csv
works '"receivers": ."extras:kind=floor".' bake kept_parts.gltf --radius 1 --rays 32 --occluders low --receivers extras:kind=floor --threads 1 -o kept_7.gltf -o b.csv --json -
additions kept_parts.gltf kept_7.gltf
[ "$(grep -c '_VISIBILITY"' kept_7.gltf)" -eq 1 ] && [ "$(grep -o '"mesh": [0-9]' kept_7.gltf | tr '\n' ' ')" = '"mesh": 1 "mesh": 0 ' ] ||
	problem "--receivers: found $(grep -o '"mesh": [0-9]' kept_7.gltf | tr '\n' ' '), expected a copy for the receiver alone"
[ "$(cut -d, -f1 b.csv | sort -u | tr '\n' ' ')" = '0 node ' ] || problem "--receivers: found other nodes in $(cat b.csv)"
cut -d, -f5 b.csv | grep -v '^1$' | grep -qv visibility && problem "--occluders: found values other than 1 in $(cat b.csv)"
works '' bake kept_parts.gltf --radius 1 --rays 32 --occluders low --receivers extras:kind=floor --threads 2 -o b.gltf --json s.json
sed 's/b.gltf/kept_7.gltf/' b.gltf | cmp -s - kept_7.gltf || problem "--receivers: found other bytes with two threads"
there b.csv b.gltf s.json
works '' bake kept_still.obj --radius 1 --rays 32 --receivers '*' -o b.glb --json s.json
works '"occluders": ."[*]".' bake builtin:cornell --radius 1 --probes 1 --rays 6 --occluders '*' --json -
there b.glb s.json
for how in --unwrap '--to texture'; do
	# shellcheck disable=SC2086 # words
	works '' bake kept_parts.gltf --radius 1 --rays 4 --receivers extras:kind=floor $how --texture 64 -o b.gltf --json s.json
	found=$(grep -o '"mesh": [0-9]\|"material": [0-9]\|occlusionTexture' b.gltf | tr '\n' ' ')
	[ "$found" = '"mesh": 1 "mesh": 0 occlusionTexture occlusionTexture "material": 0 "material": 1 ' ] ||
		problem "--receivers $how: found '$found', expected a mesh and a material for the receiver alone"
done
works '"receivers": ."[*]".' bake kept_box.obj --radius 1 --rays 4 --receivers '*' --texture 64 -o b.glb --json -
works '"probes": ' bake kept_parts.gltf --radius 1 --rays 6 --receivers extras:kind=floor --probes 0.5 --json -
there b.glb b.gltf s.json
fails 1 "--ignore: found 'a,,b', expected patterns of parts" bake kept_parts.gltf --radius 1 --ignore a,,b -o b.glb
fails 1 "--occluders: found 'material:x', expected parts of" bake kept_parts.gltf --radius 1 --occluders material:x -o b.glb
fails 1 "--receivers: found 'extras:kind=wall', expected parts of kept_parts.gltf: 'extras:kind=floor'" bake kept_parts.gltf --radius 1 --receivers extras:kind=wall -o b.glb
fails 3 'kept_parts.gltf: ignore: found every part' bake kept_parts.gltf --radius 1 --ignore '*' -o b.glb
fails 1 'b.gltf: found the ending of a glTF in text' bake builtin:cornell --radius 1 -o b.gltf
fails 1 '--instances: found with --max-error' bake kept_two.gltf --radius 1 --max-error 0.1 --instances shared -o b.glb
fails 1 'kept_two.bin: named twice' bake kept_two.gltf --radius 1 -o b.glb --json kept_two.bin
fails 1 '--max-vertices: found without' bake builtin:cornell --radius 1 --max-vertices 100 -o b.glb
fails 1 '--max-error: found with --fit points' bake builtin:cornell --radius 1 --max-error 0.1 --fit points -o b.glb
fails 1 '--max-error: found' bake builtin:cornell --radius 1 --max-error 0 -o b.glb
fails 1 '' bake builtin:cornell -o b.glb
fails 1 '--radius: found .0.' bake builtin:cornell --radius 0 -o b.glb
fails 1 "--radius: found '2e[+]09'" bake builtin:cornell --radius 2e9 -o b.glb
fails 1 "--radius: found 'inf'" bake builtin:cornell --radius inf --falloff linear -o b.glb
fails 1 '--falloff-u: found without' bake builtin:cornell --radius 1 --falloff-u 1 -o b.glb
fails 1 '--falloff-u: found none' bake builtin:cornell --radius inf --falloff alchemy -o b.glb
fails 1 '--rays: found' bake builtin:cornell --radius 1 --rays 0 -o b.glb
fails 1 '--fit: found' bake builtin:cornell --radius 1 --fit best -o b.glb
fails 1 '--normals: found' bake builtin:cornell --radius 1 --normals from-depth -o b.glb
fails 1 '' bake builtin:cornell --radius 1 -o b.obj
fails 1 '-o: nothing' bake builtin:cornell --radius 1
fails 2 '' bake none.glb --radius 1 -o b.glb
printf 'v 0 0 0\nv 1 0 0\nf 1 2 2\n' >kept_bad.obj
fails 3 'kept_bad.obj: ' bake kept_bad.obj --radius 1 -o b.glb
finish
