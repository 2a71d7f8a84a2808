# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: cli_scene_test.sh PROGRAM. Verbs that read levels: level, gbuffer, reference and shade.
set -u
nook=$1
. "$(dirname "$0")/command_line.sh"

for verb in level gbuffer reference shade; do
	works '(builtin:NAME|--device)' $verb --help
done

# Levels as binary glTF: same facts, including masks and cameras; converting again gives the same bytes.
works '"triangles": 21630' level builtin:suburb -o l.glb --json -
facts()
{
	"$nook" info "$1" | grep -E '^(bounds|surface|cameras|findings)|looks along|^  mask' | sed 's/, [^,]*$//'
}
[ "$(facts l.glb | wc -l)" -eq 12 ] && [ "$(facts l.glb)" = "$(facts builtin:suburb)" ] || problem "level: found '$(facts l.glb)', expected '$(facts builtin:suburb)'"
cp l.glb kept_l.glb
works '' level kept_l.glb -o l.glb --depfile l.d --strict
grep -q 'kept_l.glb$' l.d || problem "l.d: found '$(cat l.d)', expected kept_l.glb in it"
there l.d l.glb
works '' level builtin:cornell --cameras 2 -o l.glb
"$nook" info l.glb | grep -q "^  'auto-2': at .* 60 degrees high" || problem "--cameras 2: found '$("$nook" info l.glb)', expected auto-2"
there l.glb
fails 1 '--cameras: found .0.' level builtin:cornell --cameras 0 -o l.glb
fails 1 '.*nothing to write' level builtin:suburb
fails 1 '.*l.obj: found the ending' level builtin:suburb -o l.obj
fails 1 'kept_l.glb: named twice' level kept_l.glb -o kept_l.glb
fails 2 'missing.obj' level missing.obj -o l.glb
fails 1 '--unit: found with builtin' level builtin:suburb --unit 2 -o l.glb
rm kept_l.glb

# Several levels as one.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >kept_a.obj
works '"triangles": 3' level kept_a.obj kept_a.obj kept_a.obj --move 0,0,0 --move -2,0,0 --move 0,0,1e3 -o l.glb --json - --depfile l.d
"$nook" info l.glb | grep -qF 'bounds: (-2, 0, 0) to (1, 1, 1000) m' || problem "--move: found '$("$nook" info l.glb)'"
there l.d l.glb
works '"findings": \["duplicate-faces 1", "empty-meshes 1"\]' level kept_a.obj kept_a.obj --json -
fails 3 'kept_a.obj and 1 more: .*duplicate-faces' level kept_a.obj kept_a.obj --strict -o l.glb
fails 1 '--move: found 1 for 2 levels' level kept_a.obj builtin:cornell --move 1,2,3 -o l.glb
fails 1 "--move: found '1,2'" level kept_a.obj --move 1,2 -o l.glb
fails 1 "--move: found '1,2,nan'" level kept_a.obj --move 1,2,nan -o l.glb
fails 2 'missing.obj' level kept_a.obj missing.obj -o l.glb
fails 1 'LEVEL' level -o l.glb
rm kept_a.obj

# Map coordinates, and MTL files whose Tr is opacity.
printf 'mtllib kept_a.mtl\nusemtl a\nv 447000.4 5411000.4 0\nv 447000.7 5411000.4 0\nv 447000.4 5411000.7 0\nf 1 2 3\n' >kept_a.obj
printf 'newmtl a\nTr 1\n' >kept_a.mtl
found=$("$nook" info kept_a.obj | grep -E '^(surface|origin|  (large|inverted))')
[ "$found" = "origin: (447000, 5411000, 0) m, which files of 32-bit positions count from: the translation of their nodes
surface: 0.045 m2
  inverted-transparency: 1 repaired, first material 'a'
  large-coordinates: 3 kept, first mesh 'defaultobject', triangle 0" ] || problem "info kept_a.obj: found '$found'"
works '"findings": \["large-coordinates 3"\]' level kept_a.obj --tr opacity --json -
works '"findings": \["large-coordinates 3"\]' level kept_a.obj --tr transparency --json -
fails 3 'kept_a.obj: material .a.: found inverted-transparency' level kept_a.obj --strict -o l.glb
fails 1 '--tr: found' level kept_a.obj --tr odd -o l.glb
fails 1 '--tr: found with builtin:cornell' level builtin:cornell --tr opacity -o l.glb
printf 'newmtl a\nmap_d -imfchan z a.png\n' >kept_a.mtl
fails 5 'kept_a.mtl: line 2: found the channel z' level kept_a.obj -o l.glb
rm kept_a.obj kept_a.mtl

# Parts: what is left out is as if the file had it not, for rays, pictures and levels.
printf 'usemtl ground\no Floor\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\nf 1 2 3 4\n' >kept_floor.obj
{
	cat kept_floor.obj
	printf 'usemtl brick\no Wall\nv -2 0 -1\nv 2 0 -1\nv 2 2 -1\nv -2 2 -1\nf 5 6 7 8\n'
} >kept_parts.obj
printf 'x,y,z,nx,ny,nz\n0,0,-0.9,0,1,0\n0,0,1,0,1,0\n' >kept_points.csv
works '' reference kept_floor.obj --points kept_points.csv --radius 1 -o kept_floor.csv
for parts in '--ignore Wall' '--ignore material:brick' '--occluders Floor' '--occluders /Floor' '--ignore Wall --occluders material:gr*'; do
	# shellcheck disable=SC2086 # words
	works '' reference kept_parts.obj --points kept_points.csv --radius 1 $parts -o r.csv
	cmp -s r.csv kept_floor.csv || problem "reference $parts: found $(cat r.csv), expected $(cat kept_floor.csv)"
done
works '' reference kept_parts.obj --points kept_points.csv --radius 1 -o r.csv
cmp -s r.csv kept_floor.csv && problem "reference: found the wall darkening nothing"
sky=$("$nook" gbuffer kept_floor.obj --eye 0,1,3 --target 0,1,0 --size 32x18 --json - | grep sky_share)
works "$sky" gbuffer kept_parts.obj --eye 0,1,3 --target 0,1,0 --size 32x18 --ignore Wall --json -
works '"triangles": 2,' level kept_parts.obj --ignore 'W*l' --json - -o l.glb
works '"parts": ."/Floor", "/Wall".' info kept_parts.obj --json -
works '"triangles": 4,' level kept_floor.obj kept_parts.obj --move 0,0,0 --move 9,0,0 --ignore Wall --json -
there l.glb r.csv
fails 1 "--ignore: found 'Wal', expected parts of kept_parts.obj: '/Floor', '/Wall'" info kept_parts.obj --ignore Wal
fails 1 "--occluders: found 'material:a', expected parts of kept_parts.obj: 'material:" reference kept_parts.obj --points kept_points.csv --radius 1 --occluders material:a -o r.csv
fails 1 "--ignore: found 'extras:a', expected parts of kept_parts.obj, which has none" gbuffer kept_parts.obj --ignore extras:a -o g.exr
fails 1 '--occluders: found with --from depth' reference --gbuffer a.exr --measure sphere --from depth --radius 1 --occluders a -o r.exr
fails 1 '--ignore: found with .a.exr., expected a level' gbuffer a.exr --ignore a -o g.exr
fails 3 'kept_parts.obj: ignore: found every part' level kept_parts.obj --ignore Wall --ignore Floor -o l.glb
sed 's/o Wall/o UCX_Wall/; s/o Floor/o sky/' kept_parts.obj >kept_sky.obj
works "collision-meshes: 1 kept, first mesh 'UCX_Wall', which --ignore 'UCX_Wall' leaves out" info kept_sky.obj
works 'skies: 1 kept' info kept_sky.obj
fails 3 'kept_sky.obj: mesh .UCX_Wall., which --ignore .UCX_Wall. leaves out: found collision-meshes' info kept_sky.obj --strict
rm kept_*

# Cells.
works '"triangles_around": 0' level builtin:cornell --cell -100,-100,-100,100,100,100 --around 1 -o l.glb --json -
there l.glb
works '"cell": .1.0, 0.0, 1.0.' level builtin:cornell --cells 2x2 --around 0.5 -o l.glb --json - --depfile l.d
grep -q '^l-0-0.glb' l.d || problem "l.d: found '$(cat l.d)', expected l-0-0.glb first"
there l-0-0.glb l-0-1.glb l-1-0.glb l-1-1.glb l.d
works '' level builtin:cornell --cells 1x2x1 --around 0 -o l.glb
there l-0-0-0.glb l-0-1-0.glb
fails 3 'builtin:cornell: --cell: found no triangle whose centre is in 100,0,0,101,1,1' level builtin:cornell --cell 100,0,0,101,1,1 --around 1 -o l.glb
fails 1 '--around: found none' level builtin:cornell --cell 0,0,0,1,1,1 -o l.glb
fails 1 '--around: found without' level builtin:cornell --around 1 -o l.glb
fails 1 '--cells: found with --cell' level builtin:cornell --cell 0,0,0,1,1,1 --cells 2x2 --around 1 -o l.glb
fails 1 "--cell: found '1,0,0,0,1,1'" level builtin:cornell --cell 1,0,0,0,1,1 --around 1 -o l.glb
fails 1 '--cell: found a box without inside' level builtin:cornell --cell 0,0,0,0,1,1 --around 1 -o l.glb
for grid in 2 0x2 2x 2x2x2x2 2x2y 100x100 -1x2 2x4097; do
	fails 1 "--cells: found '$grid'" level builtin:cornell "--cells=$grid" --around 1 -o l.glb
done
fails 1 '--around: found' level builtin:cornell --cells 2x2 --around -1 -o l.glb

# G-buffers: cameras by name, explicit, automatic; sizes; formats.
works '' gbuffer builtin:nulls --size 16x9 -o g.exr
there g.exr
works '"cameras": \["auto-1", "auto-2"\]' gbuffer builtin:cornell --camera auto:2 --size 16x9 -o a.exr --json -
there a-1.exr a-2.exr
works '"sky_share": 1' gbuffer builtin:nulls --eye 0,50,0 --target 0,60,1 --fov 40 --size 8x8 --json -
works '' gbuffer builtin:cornell --projection '1 0 0 0 0 1 0 0 0 0 0 -1 0 0 0.1 0' --size 8x8 -o reversed.exr
works '0 +0 +0 +0[.]1$' info reversed.exr
there reversed.exr
fails 1 '--size: found .0x9.' gbuffer builtin:nulls --size 0x9 -o g.exr
fails 1 '--size: found' gbuffer builtin:nulls --size 16 -o g.exr
fails 1 '--camera: found .none.' gbuffer builtin:cornell --camera none --size 8x8 -o g.exr
fails 1 '--camera' gbuffer builtin:cornell --camera auto:0 -o g.exr
fails 1 '--camera: found .auto:1000000., expected auto:K with K from 1 to 64' gbuffer builtin:cornell --camera auto:1000000 -o g.exr
fails 1 '--camera' gbuffer builtin:cornell --camera auto: -o g.exr

# If views from standing height show too little, views are from outside.
printf 'v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nf 1 2 3 4\n' >kept_floor.obj
works '"views_from_outside": 3' gbuffer kept_floor.obj --camera auto:3 --size 16x9 -o a.exr --json -
there a-1.exr a-2.exr a-3.exr
works '"views_from_outside": 0' gbuffer builtin:cornell --size 16x9 -o a.exr --json -
there a.exr
"$nook" volumes kept_floor.obj --distance 0.3 --compensate --json - >../stdout 2>../stderr || problem "volumes of a floor: $(cat ../stderr)"
printf 'newmtl none\nd 0\n' >kept_none.mtl
printf 'mtllib kept_none.mtl\nusemtl none\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3\n' >kept_none.obj
fails 3 'kept_none.obj: cameras: found no view that shows anything of it' gbuffer kept_none.obj --camera auto:1 -o g.exr
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n' >kept_line.obj
fails 3 "kept_line.obj: mesh '.*', triangle 0: found degenerate-triangles and no triangle that is left" gbuffer kept_line.obj --camera auto:1 -o g.exr
rm kept_floor.obj kept_none.mtl kept_none.obj kept_line.obj
fails 1 '--' gbuffer builtin:cornell --eye 0,1,2 -o g.exr
fails 1 '--' gbuffer builtin:cornell --eye 0,1,2 --target 0,1,2 -o g.exr
fails 1 '--' gbuffer builtin:cornell --eye 0,1,nan --target 0,1,2 -o g.exr
fails 3 'projection: found a singular' gbuffer builtin:cornell --projection '1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1' -o g.exr
fails 1 '--eye: found .1e300,0,0.' gbuffer builtin:cornell --eye 1e300,0,0 --target 0,0,0 -o g.exr
fails 3 'camera .given.: found rays from beyond' gbuffer builtin:cornell --world-to-camera '1 0 0 0 0 1 0 0 0 0 1 0 1e300 0 0 1' -o g.exr
fails 1 '--unit: found with builtin:cornell' gbuffer builtin:cornell --unit 0.01 -o g.exr
fails 1 '--up: found with builtin:cornell' info builtin:cornell --up z
fails 1 '--projection: found' gbuffer builtin:cornell --projection '1 0 0 0' -o g.exr
fails 1 'builtin: found .nothing.' gbuffer builtin:nothing -o g.exr
fails 2 'missing.obj' gbuffer missing.obj -o g.exr
fails 1 'g.png' gbuffer builtin:cornell -o g.png
fails 1 '--depth: found' gbuffer builtin:cornell --depth device -o g.exr
fails 1 '-o' gbuffer builtin:cornell
echo 'v 0 0 0' >kept.obj
fails 3 'kept.obj' gbuffer kept.obj -o g.exr
# A camera inside a cube is an error.
cat >kept_cube.obj <<-EOT
	v -1 -1 -1
	v 1 -1 -1
	v 1 1 -1
	v -1 1 -1
	v -1 -1 1
	v 1 -1 1
	v 1 1 1
	v -1 1 1
	f 1 4 3 2
	f 5 6 7 8
	f 1 2 6 5
	f 4 8 7 3
	f 1 5 8 4
	f 2 3 7 6
EOT
fails 3 'kept_cube.obj: camera .* inside' gbuffer kept_cube.obj --eye 0,0,0 --target 0,0,1 --size 8x8 -o g.exr
works '' gbuffer kept_cube.obj --eye 0,0,0 --target 0,0,1 --size 8x8 --allow-inside -o g.exr --depfile g.d
grep -q 'kept_cube.obj' g.d || problem "g.d: found '$(cat g.d)', expected kept_cube.obj in it"
there g.d g.exr

# An engine's file: depth only.
works '' gbuffer kept_cube.obj --eye 0,0,4 --target 0,0,0 --fov 60 --size 32x32 -o kept_g.exr
fails 1 '--size: found with' gbuffer kept_g.exr --size 8x8 -o h.exr
fails 1 '--normals' gbuffer kept_g.exr --normals interpolated -o h.exr
works '' gbuffer kept_g.exr --normals from-depth -o h.exr
there h.exr

# References.
works '"rms_standard_error": 0\.0' reference kept_cube.obj --gbuffer kept_g.exr --radius 1 --rays 64 -o r.exr -o r.png --json -
works 'visibility' info r.exr
there r.exr r.png
works '' reference --gbuffer kept_g.exr --radius 0.5 --measure sphere --from depth --rays 16 -o r.exr
there r.exr
printf 'x,y,z,nx,ny,nz\n0,1,0,0,1,0\n0,0.9,0,0,1,0\n' >kept_points.csv
works '' reference kept_cube.obj --points kept_points.csv --radius inf --rays 128 -o r.csv
[ "$(cut -d, -f1 r.csv | tr '\n' ' ')" = 'visibility 1 0 ' ] || problem "r.csv: found '$(cat r.csv)', expected 1 on the cube and 0 inside"
there r.csv
works '"measure": "bent"' reference kept_cube.obj --gbuffer kept_g.exr --radius 1 --measure bent --falloff linear --rays 16 -o r.exr -o r.png --json -
works 'bent[.]Z +-?[0-9.]+ to ' info r.exr
works '' reference kept_cube.obj --points kept_points.csv --radius inf --measure bent --rays 64 -o b.csv
[ "$(sed -n '3p' b.csv | cut -d, -f4-)" = '0,1,0,0' ] || problem "b.csv: found '$(cat b.csv)', expected the normal where nothing is open"
there b.csv r.exr r.png
fails 1 '--from: found with --measure bent' reference kept_cube.obj --gbuffer kept_g.exr --measure bent --from depth --radius 1 -o r.exr
fails 1 'LEVEL: found none' reference --gbuffer kept_g.exr --measure bent --radius 1 -o r.exr
fails 1 'reference: found no lists' reference kept_cube.obj --radius 1 -o r.exr
fails 1 'reference: found two lists' reference kept_cube.obj --gbuffer kept_g.exr --points kept_points.csv --radius 1 -o r.exr
fails 1 'LEVEL: found none' reference --gbuffer kept_g.exr --radius 1 -o r.exr
fails 1 'LEVEL: found with --from depth' reference kept_cube.obj --gbuffer kept_g.exr --measure box --from depth --radius 1 -o r.exr
fails 1 '--radius' reference kept_cube.obj --gbuffer kept_g.exr -o r.exr
for radius in 0 -1 nan x; do
	fails 1 '--radius: found' reference kept_cube.obj --gbuffer kept_g.exr --radius=$radius -o r.exr
done
fails 1 '--radius: found .inf' reference kept_cube.obj --gbuffer kept_g.exr --radius inf --falloff linear -o r.exr
fails 1 '--rays: found' reference kept_cube.obj --gbuffer kept_g.exr --radius 1 --rays 0 -o r.exr
fails 1 '--falloff: found' reference kept_cube.obj --gbuffer kept_g.exr --radius 1 --falloff soft -o r.exr
fails 1 '--falloff: found with' reference kept_cube.obj --gbuffer kept_g.exr --radius 1 --falloff linear --measure box -o r.exr
fails 1 '--falloff-u: found without' reference kept_cube.obj --gbuffer kept_g.exr --radius 1 --falloff-u 0.1 -o r.exr
fails 1 '--from: found with' reference kept_cube.obj --gbuffer kept_g.exr --radius 1 --from depth -o r.exr
fails 1 '--points: found with' reference kept_cube.obj --points kept_points.csv --radius 1 --measure box -o r.csv
fails 1 'r.exr' reference kept_cube.obj --points kept_points.csv --radius 1 -o r.exr
fails 2 'none.exr' reference kept_cube.obj --gbuffer none.exr --radius 1 -o r.exr
fails 2 'none.csv' reference kept_cube.obj --points none.csv --radius 1 -o r.csv
echo '1,2,3' >kept_short.csv
fails 3 'kept_short.csv:1: found' reference kept_cube.obj --points kept_short.csv --radius 1 -o r.csv
fails 3 'kept_points.csv' reference kept_cube.obj --gbuffer kept_points.csv --radius 1 -o r.exr
fails 3 'kept_points.csv' reference kept_points.csv --gbuffer kept_g.exr --radius 1 -o r.exr
fails 1 'kept_g.exr: named twice' reference kept_cube.obj --gbuffer kept_g.exr --radius 1 -o kept_g.exr

# A depth buffer of a parallel projection whose z is the depth in metres is also device depth.
parallel='2 0 0 0 0 2 0 0 0 0 -1 0 0 0 0 1'
works '' gbuffer kept_cube.obj --eye 0.3,0.2,1.5 --target 0.3,0.2,0 --projection "$parallel" --size 24x24 -o kept_d.exr
works '' reference kept_cube.obj --gbuffer kept_d.exr --radius 1 --rays 16 -o kept_r.exr
works '' reference kept_cube.obj --gbuffer kept_d.exr --depth device --clip zero-to-one --projection "$parallel" --radius 1 --rays 16 -o r.exr
works '^max +0 ' compare r.exr kept_r.exr --max-error 0
fails 3 'kept_d.exr: .*behind the camera' reference kept_cube.obj --gbuffer kept_d.exr --depth device --projection "$parallel" --radius 1 -o s.exr
there r.exr
# Falloffs, an error limit, automatic views, sky, and points off the surface.
for options in '--falloff linear' '--falloff alchemy --falloff-u 0.2' '--max-error 0.05' '--max-error 0.02 --rays 64'; do
	# shellcheck disable=SC2086
	works '"rms_standard_error": 0\.0' reference kept_cube.obj --gbuffer kept_g.exr --radius 1 $options -o r.exr --json -
done
there r.exr
works '' gbuffer builtin:cornell --camera auto:2 --size 16x9 -o a.exr
works '"points": 144' reference builtin:cornell --gbuffer a-2.exr --radius 0.5 --rays 16 -o r.exr --json -
there a-1.exr a-2.exr r.exr
works '' gbuffer builtin:nulls --eye 0,50,0 --target 0,60,1 --fov 40 --size 8x8 -o kept_sky.exr
works '"points": 0,' reference builtin:nulls --gbuffer kept_sky.exr --radius 1 -o r.exr --json -
works 'visibility +1 to 1' info r.exr
there r.exr
printf '0,0.9999,0,0,1,0\n' >kept_points.csv
works '' reference kept_cube.obj --points kept_points.csv --radius 1 --rays 64 --lift 0.001 -o r.csv
[ "$(sed -n '2s/,.*//p' r.csv)" = 1 ] || problem "r.csv: found '$(cat r.csv)', expected 1 above the lifted point"
printf '1e300,0,0,0,1,0\n' >kept_points.csv
fails 3 'kept_points.csv:1: found .*1e15' reference kept_cube.obj --points kept_points.csv --radius 1 -o s.csv
fails 1 '--radius: found' reference kept_cube.obj --gbuffer kept_g.exr --radius 1e300 -o s.exr
fails 1 '--radius: found' reference kept_cube.obj --gbuffer kept_g.exr --radius 1e-300 -o s.exr
fails 1 '--lift: found with' reference --gbuffer kept_g.exr --radius 1 --measure box --from depth --lift 1 -o s.exr
there r.csv

# Shading.
works '"renderer": "CPU"' shade kept_g.exr --method vo-line --radius 0.5 -o s.exr -o s.png --json -
works '^CPU: [0-9.]+ ms$' shade kept_g.exr --method alchemy --timing -o t.exr
there s.exr s.png t.exr
works '' pattern --domain ball --count 6 --starts 2 -o kept_ball.json
works '' shade kept_g.exr --method vo-point --pattern kept_ball.json -o s.exr
there s.exr
works '^  fill: [0-9.]+ ms$' shade kept_g.exr --method vo-line --filter window --resolution half --timing -o f.exr
works '"filter": "bilateral 7"' shade kept_g.exr --method alchemy --filter bilateral --taps 7 --json - -o f.png
there f.exr f.png
works '' pattern --domain disk --count 6 --starts 2 -o kept_disk.json
fails 1 '--taps: found with' shade kept_g.exr --method vo-line --filter window --taps 7 -o s.exr
fails 1 '--taps: found .8.' shade kept_g.exr --method vo-line --filter bilateral --taps 8 -o s.exr
fails 1 '--taps: found .15.' shade kept_g.exr --method vo-line --filter bilateral --taps 15 -o s.exr
fails 1 '--resolution: found third with --method vo-line, expected full or half' shade kept_g.exr --method vo-line --resolution third -o s.exr
fails 3 'kept_ball.json: domain: found .ball.*expected .disk' shade kept_g.exr --method vo-line --pattern kept_ball.json -o s.exr
fails 1 '--method' shade kept_g.exr -o s.exr
fails 1 '--method: found .ssao.' shade kept_g.exr --method ssao -o s.exr
fails 1 '--sigma: found with' shade kept_g.exr --method vo-line --sigma 2 -o s.exr
fails 1 '--use-normal: found with' shade kept_g.exr --method alchemy --use-normal no -o s.exr
fails 1 '--threads: found with' shade kept_g.exr --method vo-line --device gl --threads 2 -o s.exr
for method in crytek volumetric-ao hbao sao gtao bitmask; do
	works '' shade kept_g.exr --method $method --radius 0.5 -o s.exr
done
works '"samples": 4' shade kept_g.exr --method hbao --hbao-directions 4 --hbao-steps 3 --filter window -o s.exr --json -
works '^  coarser depths 4: [0-9.]+ ms$' shade kept_g.exr --method sao --sao-levels 2 --timing -o s.exr
works '' shade kept_g.exr --method crytek --pattern kept_ball.json --crytek-range 1 -o s.exr
rm s.exr
fails 1 '--hbao-steps: found with another method, expected --method hbao' shade kept_g.exr --method sao --hbao-steps 4 -o s.exr
fails 1 '--sao-bias: found with another method, expected --method sao' shade kept_g.exr --method alchemy --sao-bias 0 -o s.exr
fails 1 '--hbao-steps: found .0.' shade kept_g.exr --method hbao --hbao-steps 0 -o s.exr
fails 1 '--hbao-angle-bias: found .90.' shade kept_g.exr --method hbao --hbao-angle-bias 90 -o s.exr
fails 1 '--sao-epsilon: found .0.' shade kept_g.exr --method sao --sao-epsilon 0 -o s.exr
works '"samples": 2' shade kept_g.exr --method gtao --gtao-slices 2 --gtao-steps 3 --gtao-thickness 0 --filter window -o s.exr --json -
works '' shade kept_g.exr --method bitmask --bitmask-slices 1 --bitmask-steps 16 --bitmask-hit touched -o s.exr
rm s.exr
fails 1 '--gtao-falloff: found .1., expected' shade kept_g.exr --method gtao --gtao-falloff 1 -o s.exr
fails 1 '--bitmask-thickness: found .0.' shade kept_g.exr --method bitmask --bitmask-thickness 0 -o s.exr
fails 1 '--bitmask-hit: found .most.' shade kept_g.exr --method bitmask --bitmask-hit most -o s.exr
fails 3 'kept_disk.json: domain: found .disk.*expected .ball' shade kept_g.exr --method crytek --pattern kept_disk.json -o s.exr
works '"layers": "4 adaptive layers, full tables"' shade kept_g.exr --method statvo -o s.exr --json -
works '"filter": "none"' shade kept_g.exr --method statvo --layers 2 --tables half --quadrants --skip no -o s.exr --json -
works '^  flags: [0-9.]+ ms$' shade kept_g.exr --method statvo --layers 5 --layering uniform --resolution half --timing -o s.exr
works '"tables_by": "fragments"' shade kept_g.exr --method statvo --tables-by fragments --use-normal no --slope 2 --height 0.5 --largest 63 -o s.exr --json -
there s.exr
fails 1 '--layers: found .3., expected 1, 2 or 4' shade kept_g.exr --method statvo --layers 3 -o s.exr
fails 1 '--layers: found .65.' shade kept_g.exr --method statvo --layers 65 --layering uniform -o s.exr
fails 1 '--layering: found .log.' shade kept_g.exr --method statvo --layering log -o s.exr
fails 1 '--tables: found .eighth.' shade kept_g.exr --method statvo --tables eighth -o s.exr
fails 1 '--slope: found .0.' shade kept_g.exr --method statvo --slope 0 -o s.exr
fails 1 '--height: found .-1.' shade kept_g.exr --method statvo --height -1 -o s.exr
fails 1 '--largest: found .256.' shade kept_g.exr --method statvo --largest 256 -o s.exr
fails 1 '--tables-by: found compute with --device cpu' shade kept_g.exr --method statvo --tables-by compute -o s.exr
fails 1 '--quadrants: found with another method, expected --method statvo' shade kept_g.exr --method vo-line --quadrants -o s.exr
works '' shade kept_g.exr --method slices --filter window -o p.json
grep -q '"schema":"nook.passes/1".*"call":"nookSlices".*"call":"nookWindow"' p.json || problem "p.json: found '$(head -c 300 p.json)', expected two passes"
there p.json
fails 1 'p.json: found with volumes' shade kept_g.exr --method vo-line --debug samples -o p.json
fails 1 '--pattern: found with --method statvo' shade kept_g.exr --method statvo --pattern kept_disk.json -o s.exr
fails 1 '--filter: found .window. with --method statvo' shade kept_g.exr --method statvo --filter window -o s.exr
fails 2 'none.exr' shade none.exr --method vo-line -o s.exr

# Texels of a mask, before it is decoded.
works '' tile --domain slice --size 2 -o kept_mask.png
printf 'newmtl net\nmap_d kept_mask.png\n' >kept_mask.mtl
printf 'mtllib kept_mask.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl net\nf 1/1 2/2 3/3\n' >kept_mask.obj
texels=$("$nook" info kept_mask.png | sed -n 's/.* \([0-9]*\) x \([0-9]*\) pixels.*/\1 \2/p' | awk '{ print $1 * $2 }')
works '1 triangle' info kept_mask.obj --max-texels "$texels"
fails 3 "kept_mask.png: found $texels texels, expected at most $((texels - 1)) .--max-texels." info kept_mask.obj --max-texels $((texels - 1))
fails 1 "--max-texels: found '0', expected a whole number from 1 to 4294967296" info kept_mask.obj --max-texels 0
# A camera too far away for any level.
works '' level builtin:cornell -o kept_far.glb
length=$(od -An -tu4 -j12 -N4 kept_far.glb | tr -d ' ')
tail -c +$((29 + length)) kept_far.glb >kept_far.bin
tail -c +21 kept_far.glb | head -c "$length" | sed 's|"buffers":\[{|&"uri":"kept_far.bin",|' >kept_far.json
sed 's|"matrix":\[[^]]*\]|"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,1e308,0,0,1]|' kept_far.json >kept_far.gltf
works 'far-cameras: 1 dropped' info kept_far.gltf
works '' volumes kept_far.gltf --distance 0.5 -o v.glb
there v.glb
finish
