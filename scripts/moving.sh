#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The table "What moves" of docs/measurements/bake.md: moving.sh PROGRAM [METHOD]. A colonnade with steps, defined here, gets a bake
# and volumes; then crates are added that neither contains. Each rule for combining a screen-space method with them is compared with
# rays in the colonnade with crates.
set -eu
nook=$1
method=${2:-slices}
folder=$(mktemp -d "${TMPDIR:-/tmp}/nook moving.XXXXXX")
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# boxes: converts lines "x y z width height depth cells" to an OBJ of boxes with cells × cells quads per face.
boxes()
{
	awk '
	function face(a, b, c, ux, uy, uz, vx, vy, vz, n,    i, j) {
		for (j = 0; j <= n; ++j) for (i = 0; i <= n; ++i)
			print "v", a + ux * i / n + vx * j / n, b + uy * i / n + vy * j / n, c + uz * i / n + vz * j / n
		for (j = 0; j < n; ++j) for (i = 0; i < n; ++i) {
			p = made + j * (n + 1) + i + 1
			print "f", p, p + 1, p + n + 2, p + n + 1
		}
		made += (n + 1) * (n + 1)
	}
	{
		x = $1; y = $2; z = $3; w = $4; h = $5; d = $6; n = $7
		face(x, y, z, 0, 0, d, 0, h, 0, n); face(x + w, y, z + d, 0, 0, -d, 0, h, 0, n)
		face(x, y, z + d, w, 0, 0, 0, h, 0, n); face(x + w, y, z, -w, 0, 0, 0, h, 0, n)
		face(x, y + h, z + d, w, 0, 0, 0, 0, -d, n); face(x, y, z, w, 0, 0, 0, 0, d, n)
	}'
}

{
	echo '-6 -1 -6 12 1 12 48'
	echo '-6 0 -6 12 5 0.5 40'
	for x in -4.5 -1.5 1.5 4.5; do
		echo "$x 0 -3.5 0.6 4 0.6 12"
		echo "$x 0 0 0.6 4 0.6 12"
	done
	echo '-5.5 4 -4 11 0.4 5 32'
	echo '-6 0 -5.5 12 0.3 1 24'
} >columns
{
	echo '-0.5 0 -1.6 1 1 1 1'
	echo '2.4 0 0.9 0.8 0.8 0.8 1'
	echo '-3.1 0 0.5 0.7 1.4 0.7 1'
} >crates
boxes <columns >still.obj
cat columns crates | boxes >moved.obj

set -- --eye 1.2,1.7,6 --target 0,0.8,-2 --fov 60 --size 480x270
"$nook" gbuffer moved.obj "$@" -o g.exr --json s.json
"$nook" gbuffer still.obj "$@" -o still.exr --json s.json
"$nook" reference moved.obj --gbuffer g.exr --radius 1.5 --falloff linear --rays 256 -o rays.exr --json s.json
"$nook" bake still.obj --radius 1.5 --falloff linear -o bake.glb --json s.json
"$nook" volumes still.obj --distance 1 --ray-distance 1.5 --compensate -o volumes.glb --json s.json
"$nook" bake still.obj --radius 1.5 --falloff linear --volumes volumes.glb -o beside.glb --json s.json

# row NAME ARGUMENTS: arguments of nook shade.
row()
{
	name=$1
	shift
	"$nook" shade g.exr "$@" -o v.exr --json s.json
	rmse=$("$nook" compare v.exr rays.exr | sed -n 's/^rmse *\([0-9.e-]*\) .*/\1/p')
	printf '| %s | %.4f |\n' "$name" "$rmse"
}

echo '| what is drawn | RMSE |'
echo '| --- | --- |'
row "\`$method\` alone" --method "$method" --radius 1.5
row 'bake alone' --method bake --bake bake.glb
row 'volumes alone' --method aov --volumes volumes.glb
row 'bake beside volumes' --method aov --volumes volumes.glb --bake beside.glb
row "volumes, \`$method\`: the lesser" --method "$method" --radius 1.5 --volumes volumes.glb
row "volumes, \`$method\`: what moves" --method "$method" --radius 1.5 --volumes volumes.glb --static still.exr
row "bake, \`$method\`: what moves" --method "$method" --radius 1.5 --bake bake.glb
row "bake beside volumes, \`$method\`: what moves" --method "$method" --radius 1.5 --volumes volumes.glb --bake beside.glb
