# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: file_names_test.sh PROGRAM. No output replaces an input or another output, whatever their names; a level reads only files
# in its folder; a depfile lists what was read.
set -u
nook=$1
. "$(dirname "$0")/command_line.sh"

# A level of three files (text, materials, a picture), and one of two.
mkdir kept_level kept_elsewhere
"$nook" tile --domain slice --size 2 -o kept_level/mask.png
printf 'newmtl net\nmap_d mask.png\n' >kept_level/a.mtl
printf 'mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl net\nf 1/1 2/2 3/3\n' >kept_level/a.obj
zero='\000\000\000\000'
one='\000\000\200\077'
# shellcheck disable=SC2059
printf "$zero$zero$zero$one$zero$zero$zero$one$zero" >kept_level/b.bin
gltf()
{
	printf '{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"%s"}]}\n' "$1"
}
gltf b.bin >kept_level/b.gltf
cp -r kept_level ..

# An input by its own name, another spelling, a link, a second name; also the files that a level refers to.
ln -s kept_level kept_link
ln -s a.mtl kept_level/link.glb
ln kept_level/b.bin kept_level/hard.glb
ln -s ../kept_level/none.json kept_elsewhere/dangling.json
level=kept_level/a.obj
fails 1 'kept_level/a.obj: named twice' info $level --json $level
fails 1 'kept_level/../kept_level/a.obj: found the same file as kept_level/a.obj' info $level --json kept_level/../kept_level/a.obj
fails 1 'kept_link/a.obj: found the same file as kept_level/a.obj' level $level -o l.glb --json kept_link/a.obj
fails 1 'kept_level/a.mtl: named twice' info $level --json kept_level/a.mtl
fails 1 'kept_link/mask.png: found the same file as kept_level/mask.png' level $level -o l.glb --json kept_link/mask.png
fails 1 'kept_level/link.glb: found the same file as kept_level/a.mtl' level $level -o kept_level/link.glb
fails 1 'kept_level/hard.glb: found the same file as kept_level/b.bin' level kept_level/b.gltf -o kept_level/hard.glb
fails 1 'kept_link/b.bin: found the same file as kept_level/b.bin' volumes kept_level/b.gltf --distance 1 -o v.glb --depfile kept_link/b.bin
fails 1 'kept_level/b.bin: named twice' gbuffer kept_level/b.gltf --camera auto:1 --size 8x8 --json kept_level/b.bin
fails 1 'kept_link/a.obj: found the same file as kept_level/a.obj' tune $level --budget 1ms --json kept_link/a.obj
fails 1 'kept_link/a.obj: found the same file as kept_level/a.obj' report error $level -o e.html --json kept_link/a.obj
printf '0.2,0.2,0,0,0,1\n' >kept_points.csv
fails 1 'kept_level/a.mtl: named twice' reference $level --points kept_points.csv --radius 1 -o r.csv --json kept_level/a.mtl
fails 1 'kept_link/../kept_points.csv: found the same file as kept_points.csv' reference $level --points kept_points.csv --radius 1 -o kept_link/../kept_points.csv
fails 1 'kept_level/mask.png: named twice' compare kept_level/mask.png kept_level/mask.png --diff kept_level/mask.png
fails 1 'kept_link/mask.png: found the same file as kept_level/mask.png' compare kept_level/mask.png kept_level/mask.png --json kept_link/mask.png
works '' pattern --domain disk --count 4 --starts 1 -o kept_p.json
cp kept_p.json ../kept_p.json
ln -s kept_p.json kept_q.json
fails 1 'kept_q.json: found the same file as kept_p.json' tile --pattern kept_p.json --size 2 -o kept_q.json
fails 1 'kept_q.json: found the same file as kept_p.json' emit --methods vo-line --patterns kept_p.json --glsl 330 -o m.glsl --json kept_q.json
fails 1 './closed/../kept_p.json: found the same file as kept_p.json' info kept_p.json --json ./closed/../kept_p.json
for file in a.obj a.mtl mask.png b.gltf b.bin; do
	same kept_level/$file ../kept_level/$file "kept_level/$file: found other bytes after refusals"
done
same kept_p.json ../kept_p.json 'kept_p.json: found other bytes after refusals'

# Two outputs with one target: by another spelling, before either exists, through a dangling link.
fails 1 './p.json: found the same file as p.json' pattern --domain disk --count 4 --starts 1 -o p.json -o ./p.json
fails 1 'kept_link/p.json: found the same file as kept_level/p.json' pattern --domain disk --count 4 --starts 1 -o kept_level/p.json --json kept_link/p.json
fails 1 'kept_level/none.json: found the same file as kept_elsewhere/dangling.json' pattern --domain disk --count 4 --starts 1 -o kept_elsewhere/dangling.json --json kept_level/none.json
fails 1 'c/disk/disk_004.json: named twice' catalogue --domain disk --counts 4 -o c --json c/disk/disk_004.json
fails 1 '--depfile: nothing depends' level $level -o - --depfile l.d
rm kept_level/hard.glb kept_level/link.glb

# A level cannot refer to files outside its folder, by any path, unless that is allowed.
mkdir kept_level/in kept_level/textures
cp kept_level/mask.png kept_elsewhere/mask.png
cp kept_level/a.mtl kept_elsewhere/a.mtl
cp kept_level/b.bin kept_elsewhere/b.bin
ln -s ../kept_elsewhere kept_level/out
outside()
{
	fails 3 "$2: found .*$3, which is outside the level.s folder, expected .*--allow-outside" info "$1"
	works '1 triangle' info "$1" --allow-outside
}
for uri in ../kept_elsewhere/b.bin out/b.bin "$PWD/kept_elsewhere/b.bin" %2e%2e/kept_elsewhere/b.bin; do
	gltf "$uri" >kept_level/c.gltf
	outside kept_level/c.gltf 'kept_level/c.gltf: buffers.0..uri' b.bin
done
for uri in b.bin in/../b.bin ../kept_level/b.bin "$PWD/kept_link/b.bin"; do
	gltf "$uri" >kept_level/c.gltf
	works '1 triangle' info kept_level/c.gltf
done
for name in ../kept_elsewhere/a.mtl out/a.mtl; do
	sed "s|a.mtl|$name|" kept_level/a.obj >kept_level/c.obj
	outside kept_level/c.obj 'kept_level/c.obj: mtllib' a.mtl
done
for name in ../kept_elsewhere/mask.png out/mask.png "$PWD/kept_elsewhere/mask.png" '..\kept_elsewhere\mask.png'; do
	printf 'newmtl net\nmap_d %s\n' "$name" >kept_level/c.mtl
	sed 's|a.mtl|c.mtl|' kept_level/a.obj >kept_level/c.obj
	outside kept_level/c.obj "kept_level/c.obj: mask '.*mask.png'" mask.png
done
# Paths from an exporter's machine are looked up next to the level; unread pictures may be anywhere.
printf 'newmtl net\nmap_d C:\\nowhere\\mask.png\nmap_Kd ../kept_elsewhere/mask.png\n' >kept_level/c.mtl
works "mask 'net'" info kept_level/c.obj
fails 3 "kept_level/c.obj: picture of material 'net': found .*mask.png, which is outside the level.s folder, expected .*--allow-outside" \
	bake kept_level/c.obj --radius 1 --rays 1 -o c.glb
works '' bake kept_level/c.obj --radius 1 --rays 1 --allow-outside -o c.glb
rm -f c.glb
(cd kept_level && "$nook" info a.obj >../../stdout) || problem 'a level of this folder'

# A depfile lists the files read, without duplicates, and no built-in names.
lists()
{
	file=$1
	shift
	found=$(sed -n 's/^  \([^ ]*\).*/\1/p' "$file" | tr '\n' ' ')
	[ "$found" = "$*${*:+ }" ] || problem "$file: found '$found', expected '$*'"
	rm "$file"
}
works '' level $level -o l.glb --depfile l.d
lists l.d kept_level/a.obj kept_level/a.mtl kept_level/mask.png
works '' gbuffer kept_level/b.gltf --camera auto:1 --size 8x8 -o kept_g.exr --depfile g.d
lists g.d kept_level/b.gltf kept_level/b.bin
works '' gbuffer builtin:cornell --size 8x8 -o g.exr --depfile g.d
lists g.d
works '' reference $level --points kept_points.csv --radius 1 -o r.csv --depfile r.d
lists r.d kept_points.csv kept_level/a.obj kept_level/a.mtl kept_level/mask.png
works '' emit --methods vo-line,vo-area --patterns kept_p.json,kept_p.json --glsl 330 -o m.glsl --depfile m.d
lists m.d kept_p.json
works '' shade kept_g.exr --method vo-line --pattern kept_p.json -o s.exr --depfile s.d
lists s.d kept_g.exr kept_p.json
error='report error --device cpu --grid quick --size 16x16 --rays 4 --repetitions 1 --pictures 0 --shifts 0 --camera auto:1'
# shellcheck disable=SC2086
"$nook" $error builtin:cornell kept_level/b.gltf -o e.html --json kept_e.json --depfile e.d 2>../stderr || problem "$error: $(cat ../stderr)"
lists e.d kept_level/b.gltf kept_level/b.bin
works '' report error --join kept_e.json -o e.html --depfile e.d
lists e.d kept_e.json
rm -f l.glb g.exr r.csv m.glsl s.exr e.html
there
finish
