# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: compressed_levels_test.sh PROGRAM SOURCE FOLDER. Levels compressed by other programs equal the originals. glTF-Transform,
# Draco and meshoptimizer are downloaded from npm's registry once into FOLDER. Exit code 77: npm or the registry is not available.
set -u
nook=$1
source=$2
cache=$3
. "$(dirname "$0")/command_line.sh"
. "$(dirname "$0")/npm_tools.sh"

npm_packages "$cache" @gltf-transform/core@4.2.1 @gltf-transform/extensions@4.2.1 @gltf-transform/functions@4.2.1 draco3dgltf@1.5.7 meshoptimizer@0.22.0
cp "$source"/tests/gltf_transform/*.mjs "$cache" || exit 1

# same EXPECTED FOUND SHARE
same()
{
	checks=$((checks + 1))
	"$nook" level "$2" -o found.glb >../log 2>&1 || problem "$2: $(cat ../log)"
	(cd "$cache" && node same.mjs "$work/$1" "$work/found.glb" "$3") >../log 2>&1 || problem "$2: $(cat ../log)"
	rm -f found.glb
}
work=$PWD

# Moments of all surfaces; at 16 bits a level 36 m wide has steps of half a millimetre, while cards of grass are a hand wide.
works '' level builtin:foliage -o kept_in.glb
(cd "$cache" && node convert.mjs "$work/kept_in.glb" "$work") >../log 2>&1 || problem "glTF-Transform: $(cat ../log)"
for name in draco.glb draco_sequential.glb meshopt.glb meshopt_filters.glb quantized.glb meshopt.gltf; do
	same kept_in.glb $name 3e-4
done
same kept_in.glb webp.glb 1e-9
"$nook" level nodes.glb -o kept_nodes.glb || problem "nodes.glb"
same kept_nodes.glb instanced.glb 1e-6
"$nook" info instanced.glb >../log
grep -q '^findings: none' ../log || problem "instanced.glb: $(cat ../log)"

# Equal bytes for any number of threads; masks match the picture.
for name in draco meshopt_filters webp; do
	"$nook" level $name.glb -o one.glb --threads 1 && "$nook" level $name.glb -o three.glb --threads 3
	checks=$((checks + 1))
	cmp -s one.glb three.glb || problem "$name.glb: other bytes on three threads than on one"
done
finish
