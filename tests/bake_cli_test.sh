# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: bake_cli_test.sh PROGRAM. nook bake: what it makes, what it says, what it refuses.
set -u
nook=$1
. "$(dirname "$0")/command_line.sh"

works '--fit' bake --help
works '^bake: 144 vertices, ' bake builtin:cornell --radius 0.5 --rays 16 -o b.glb
works '^level: b.glb, ' info b.glb
there b.glb
works '"rmse": 0[.][01]' bake builtin:cornell --radius 0.5 --json -
works '"fit": "points"' bake builtin:cornell --radius 0.5 --fit points --json -
works '' bake builtin:cornell --radius 0.5 --rays 16 -o plain.glb --json s.json
works '' bake builtin:cornell --radius 0.5 --rays 16 --color -o colors.glb --json s.json
checks=$((checks + 1))
grep -aq COLOR_0 colors.glb && ! grep -aq COLOR_0 plain.glb || problem "--color: found it in both files or in none"
there colors.glb plain.glb s.json
works '^bent normals: [0-9.]* degrees' bake builtin:cornell --radius 0.5 --rays 16 --bent -o bent.glb
works '"bent_angle_deg": ' bake builtin:cornell --radius 0.5 --rays 16 --bent --fit points --json -
works '"sides": "mean"' bake builtin:foliage --radius 0.5 --rays 1 --sides mean --json - -o mean.glb
works '"sides": "separate"' bake builtin:foliage --radius 0.5 --rays 1 --json - -o sides.glb
checks=$((checks + 1))
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
checks=$((checks + 1))
"$nook" bake builtin:cornell --radius 0.5 --max-error 0.01 --max-vertices 200 --json s.json -o b.glb 2>../stderr
grep -q '^nook: warning: --max-vertices: 200 left [0-9]* triangles with errors above 0.01$' ../stderr || problem "--max-vertices: found '$(cat ../stderr)'"
grep -q '"stopped_by": "max-vertices"' s.json || problem "--max-vertices: found $(cat s.json)"
there b.glb s.json

works '^probes: ' bake builtin:cornell --radius 0.5 --probes 0.2 --rays 60 -o p.ktx2 -o p.glsl
# The texture: VK_FORMAT_R8G8B8A8_UNORM, and as many texels as the function says.
checks=$((checks + 1))
[ "$(od -An -tu4 -j12 -N4 p.ktx2 | tr -d ' ')" = 37 ] || problem "p.ktx2: found another format than 37"
size=$(od -An -tu4 -j20 -N12 p.ktx2 | awk '{ print $1 ", " $2 ", " $3 }')
grep -q "ivec3($size);" p.glsl || problem "p.ktx2: found $size texels, expected those of $(grep ivec3 p.glsl | head -n 1)"
if command -v glslangValidator >../stdout; then
	for version in '330 core' '300 es'; do
		checks=$((checks + 1))
		{
			printf '#version %s\n#ifdef GL_ES\nprecision highp float;\nprecision highp int;\nprecision highp sampler3D;\n#endif\n' "$version"
			cat p.glsl
			printf 'uniform sampler3D probes;\nin vec3 p;\nin vec3 n;\nout vec4 c;\nvoid main() { c = vec4(nookProbeVisibility(probes, p, n)); }\n'
		} >../p.frag
		glslangValidator ../p.frag >../log 2>&1 || problem "p.glsl as $version: $(cat ../log)"
	done
fi
there p.glsl p.ktx2
# A box's six faces, each with a place of its own in the texture.
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
