# SPDX-License-Identifier: GPL-3.0-or-later
# A few patterns of every domain and method, a tile and a picture; G-buffers and references: the outputs compared by tests of equal
# bytes.

# makeSamples PROGRAM FOLDER THREADS
makeSamples()
{
	while read -r sample options; do
		"$1" pattern $options --threads "$3" -o "$2/$sample.json" -o "$2/$sample.h" || problem "$sample: not made"
	done <<-EOT
		disk_refine --domain disk --count 7 --starts 4
		disk_symmetric --domain disk --count 9 --symmetric --starts 4
		disk_noise --domain disk --count 6 --minimise noise --starts 3
		disk_electro --domain disk --count 16 --method electro --starts 4 --order progressive
		disk_fitted --domain disk --count 9 --method lloyd --weights fitted --starts 2
		disk_equal --domain disk --count 8 --method equal --starts 2
		ball_refine --domain ball --count 8 --starts 3
		ball_electro --domain ball --count 12 --centre --method electro --starts 3 --order progressive
		ball_equal --domain ball --count 6 --method equal --starts 2
		sphere_refine --domain sphere --count 6 --starts 3
		sphere_thomson --domain sphere --count 12 --exponent 1 --starts 4
		hemisphere_refine --domain hemisphere --count 5 --starts 3
		disk_poisson --domain disk --count 20 --method poisson
		ball_halton --domain ball --count 20 --method halton
		sphere_vogel --domain sphere --count 20 --method vogel
		hemisphere_random --domain hemisphere --count 20 --method random
	EOT
	"$1" pattern --domain disk --count 5 --method lloyd --starts 2 --threads "$3" -o "$2/base.json" -o "$2/base.svg" -o "$2/base.csv" ||
		problem "base: not made"
	for kind in points even random; do
		"$1" tile --pattern "$2/base.json" --size 2 --kind $kind --threads "$3" -o "$2/tile_$kind.json" -o "$2/tile_$kind.exr" ||
			problem "tile $kind: not made"
	done
	while read -r level options; do
		"$1" gbuffer "builtin:$level" --size 64x36 $options --threads "$3" -o "$2/$level.exr" || problem "$level: no G-buffer"
		"$1" reference "builtin:$level" --gbuffer "$2/$level.exr" --radius 2 --rays 32 --threads "$3" -o "$2/$level.hard.exr" ||
			problem "$level: no reference"
	done <<-EOT
		cornell --camera main
		courtyard --camera auto:1 --normals interpolated
		suburb --camera main --normals from-depth
		foliage --camera main
		nulls --camera main
	EOT
	"$1" level builtin:suburb --threads "$3" -o "$2/suburb.glb" || problem "suburb: no level"
	for options in "--falloff linear --max-error 0.02" "--falloff alchemy" "--measure hemisphere" "--measure box"; do
		"$1" reference builtin:suburb --gbuffer "$2/suburb.exr" --radius 1 $options --threads "$3" -o "$2/suburb$(echo "$options" | tr -d ' ').exr" ||
			problem "suburb $options: no reference"
	done
	"$1" reference --gbuffer "$2/suburb.exr" --radius 1 --measure sphere --from depth --rays 64 --threads "$3" -o "$2/depth.exr" ||
		problem "depth: no reference"
	for method in vo-line vo-point alchemy; do
		"$1" shade "$2/suburb.exr" --method $method --threads "$3" -o "$2/suburb.$method.exr" || problem "$method: no picture"
	done
	"$1" volumes builtin:suburb --distance 1 --drop-below 1/512 --layout prisms --compress --threads "$3" \
		-o "$2/volumes.glb" --json "$2/volumes.json" || problem "volumes: no file"
	"$1" volumes builtin:cornell --distance 0.5 --compensate --trim 0.05 --threads "$3" -o "$2/trimmed.glb" --json "$2/trimmed.json" ||
		problem "trimmed volumes: no file"
	"$1" bake builtin:suburb --radius 1 --rays 64 --color --threads "$3" -o "$2/baked.glb" --json "$2/baked.json" || problem "bake: no file"
	for method in aov aov-mask; do
		"$1" shade "$2/suburb.exr" --method $method --volumes "$2/volumes.glb" --threads "$3" -o "$2/suburb.$method.exr" ||
			problem "$method: no picture"
	done
	"$1" compare "$2/suburb.hard.exr" "$2/depth.exr" --mask "$2/suburb.exr" --threads "$3" --diff "$2/difference.png" --json "$2/compare.json" >/dev/null ||
		problem "compare: nothing"
}
