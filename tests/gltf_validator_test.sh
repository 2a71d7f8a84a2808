# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: gltf_validator_test.sh PROGRAM SOURCE FOLDER. Khronos' validator finds no errors or warnings in files written by nook. It
# is downloaded from npm's registry once into FOLDER. Exit code 77: npm or the registry is not available.
set -u
nook=$1
source=$2
cache=$3
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/npm_tools.sh"

npm_packages "$cache" gltf-validator@2.0.0-dev.3.10
cp "$source"/tests/gltf_validator/*.js "$cache" || exit 1

cd "$folder" || exit 1
for layout in polygons prisms; do
	for compress in "" --compress; do
		"$nook" volumes builtin:suburb --distance 1.5 --layout $layout $compress -o "suburb $layout$compress.glb" --json s.json || problem "$layout $compress"
		"$nook" volumes builtin:foliage --distance 0.3 --no-drop --layout $layout $compress -o "foliage $layout$compress.glb" --json s.json ||
			problem "$layout $compress"
	done
done
# Far from the origin, where nodes have a translation.
printf 'v 100000 0 0\nv 100001 0 0\nv 100001 1 0.3\nv 100000 1 0.3\nf 1 2 3 4\n' >far.obj
"$nook" volumes far.obj --distance 1 --no-drop -o far.glb --json s.json || problem "far.obj"
"$nook" level builtin:suburb -o level.glb || problem "level"
"$nook" bake builtin:foliage --radius 0.5 --rays 16 --color --bent -o baked.glb --json s.json || problem "bake"
cat >charts.obj <<'EOT'
v 0 0 0
v 1 0 0
v 1 0 1
v 0 0 1
v 0 1 0
v 1 1 0
vt 0.1 0.1
vt 0.4 0.1
vt 0.4 0.4
vt 0.1 0.4
vt 0.6 0.1
vt 0.9 0.1
vt 0.9 0.4
vt 0.6 0.4
f 4/1 3/2 2/3 1/4
f 1/5 2/6 6/7 5/8
EOT
"$nook" bake charts.obj --radius 0.5 --rays 16 --texture 32 -o texture.glb --json s.json || problem "bake --texture"
"$nook" bake builtin:cornell --radius 0.5 --rays 16 --auto -o auto.glb --json s.json || problem "bake --auto"
grep -q '"kind": "texture", "triangles": [1-9]' s.json || problem "bake --auto: found no texture in $(cat s.json)"
checks=$((checks + 13))
(cd "$cache" && node validate.js "$folder"/*.glb) >log 2>&1 || problem "$(cat log)"
[ "$(grep -c ': 0 errors, 0 warnings$' log)" -eq 13 ] || problem "found '$(cat log)', expected thirteen files without an error"

# Checks that the validator detects an error: an accessor without a count.
checks=$((checks + 1))
sed 's/"count":/"cuunt":/' far.glb >wrong.glb
(cd "$cache" && node validate.js "$folder/wrong.glb") >log 2>&1 && problem "a file without counts passed: $(cat log)"
grep -q ': [1-9][0-9]* errors' log || problem "a file without counts: found '$(cat log)', expected errors of the validator's"
finish
