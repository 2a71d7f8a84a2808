# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scale_test.sh PROGRAM. A scaled or distant level gives the same pictures within rounding: depths, rays and volumes. Prints
# the table of docs/reference/robustness.md.
set -u
nook=$1
. "$(dirname "$0")/table.sh"
cd "$folder" || exit 1

# A level as one file without cameras, split into JSON and buffer.
"$nook" level builtin:suburb -o level.glb >log || problem "no level: $(cat log)"
length=$(od -An -tu4 -j12 -N4 level.glb | tr -d ' ')
tail -c +21 level.glb | head -c "$length" >level.json
tail -c +$((29 + length)) level.glb >b.bin

# moved FILE X Y Z: the level with its meshes moved.
moved()
{
	sed "s|\"buffers\":\[{|&\"uri\":\"b.bin\",|; s|\"mesh\":|\"translation\":[$2,$3,$4],&|g" level.json >"$1"
	[ "$(grep -c "\"translation\":\[$2,$3,$4\]" "$1")" -gt 0 ] || problem "$1: found no mesh to move"
}

product()
{
	awk -v a="$1" -v b="$2" -v c="$3" 'BEGIN { printf "%.17g", a * b + c }'
}

# pictures NAME FILE UNIT X Y Z: with eye and radius transformed accordingly.
pictures()
{
	name=$1
	file=$2
	unit=$3
	eye=$(product 9 "$unit" "$4"),$(product 2 "$unit" "$5"),$(product 10 "$unit" "$6")
	target=$(product 0 "$unit" "$4"),$(product 1 "$unit" "$5"),$(product 0 "$unit" "$6")
	radius=$(product 1 "$unit" 0)
	{
		"$nook" gbuffer "$file" --unit "$unit" --eye "$eye" --target "$target" --size 64x36 -o "$name.g.exr" &&
			"$nook" reference "$file" --unit "$unit" --gbuffer "$name.g.exr" --radius "$radius" --rays 64 -o "$name.r.exr" &&
			"$nook" shade "$name.g.exr" --method vo-line --radius "$radius" -o "$name.s.exr" &&
			"$nook" volumes "$file" --unit "$unit" --distance "$radius" -o "$name.glb" &&
			"$nook" shade "$name.g.exr" --method aov --volumes "$name.glb" -o "$name.v.exr"
	} >log 2>&1 || problem "$name: $(tail -n 1 log)"
}

# rmse FILE FILE
rmse()
{
	"$nook" compare "$1" "$2" --json compare.json >log 2>&1 || problem "$1: $(cat log)"
	sed -n 's/.*"rmse": \([^,]*\),*/\1/p' compare.json | head -n 1
}

# differs NAME: compares its pictures with those of the original level. Rays are relative to the level's centre and agree exactly;
# lines agree within 32-bit rounding; which polygons of a volume are kept depends on sums that round differently.
differs()
{
	row="| $1"
	for bound in r=1e-6 s=1e-6 v=2e-3; do
		checks=$((checks + 1))
		kind=${bound%=*}
		error=$(rmse "here.$kind.exr" "$1.$kind.exr")
		row="$row | $error"
		awk -v error="$error" -v most="${bound#*=}" 'BEGIN { exit !(error != "" && error <= most) }' ||
			problem "$1: $kind: found an RMSE of '$error', expected at most ${bound#*=}"
	done
	echo "$row |"
}

moved here.gltf 0 0 0
pictures here here.gltf 1 0 0 0
echo "| level | rays | lines | volumes |"
echo "| --- | --- | --- | --- |"
for unit in 1e-6 1e-4 1e-2 1e2 1e4 1e6; do
	pictures $unit here.gltf $unit 0 0 0
	differs $unit
done
moved far.gltf 447000 0 -447000
pictures far far.gltf 1 447000 0 -447000
differs far
awk -v error="$(rmse here.r.exr here.v.exr)" 'BEGIN { exit !(error > 0.01) }' || problem "rays and volumes: found the same picture, expected that levels show"
finish
