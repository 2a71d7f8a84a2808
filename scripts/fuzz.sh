#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the libFuzzer target of every parser, of shading and of the C API, five at a time: fuzz.sh SECONDS [FOLDER [TARGET...]]. FOLDER
# (build/fuzz) is a clang++ build; new inputs are kept in FOLDER/corpus for the next run, and failures in FOLDER/findings.
# NOOK_PROGRAM: a built program for making seeds; NOOK_FUZZ_SEEDS: a folder with more seeds, one subfolder per target;
# NOOK_FUZZ_COVERAGE: a folder for each target's coverage output. Exit code 77: no clang++ with libFuzzer. 1: a parser failed.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
seconds=${1:?seconds, expected a number of them for each target}
build=$(realpath -m "${2:-$source/build/fuzz}")
[ $# -ge 2 ] && shift 2 || shift $#
targets=${*:-pattern csv glb meshes volumes exr gbuffer report command farm shade capi}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' >"$scratch/empty.cpp"
if ! clang++ -fsanitize=fuzzer,address,undefined "$scratch/empty.cpp" -o "$scratch/empty" >"$scratch/log" 2>&1; then
	echo "fuzz.sh: skipped: found no clang++ that links libFuzzer, expected one (scripts/setup.sh clang)" >&2
	exit 77
fi

nook=${NOOK_PROGRAM:-$build/tools/nook}
programs="nook nook_fuzz"
[ -z "${NOOK_PROGRAM:-}" ] || programs=
for target in ${NOOK_PROGRAM:+$targets}; do
	programs="$programs fuzz_$target"
done
# shellcheck disable=SC2086
if ! { cmake -G Ninja -S "$source" -B "$build" -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Release -DNOOK_FUZZ=ON \
	-DNOOK_BUILD_TESTS=OFF -DNOOK_BUILD_BENCHMARKS=OFF &&
	cmake --build "$build" --target $programs; } >"$scratch/log" 2>&1; then
	tail -n 40 "$scratch/log" >&2
	exit 1
fi

# Seeds: files written by nook. The folders are named after the targets.
seeds=$scratch/seeds
for target in $targets; do
	mkdir -p "$seeds/$target" "$build/corpus/$target" "$build/findings"
done
seed()
{
	case " $targets " in *" $1 "*) cp "$2" "$seeds/$1/" ;; esac
}
cd "$scratch"
"$nook" pattern --domain disk --count 3 --starts 1 -o disk.json -o disk.csv
"$nook" pattern --domain ball --count 4 --starts 1 -o ball.json -o ball.csv
"$nook" tile --pattern disk.json --size 2 --kind even -o tile.json
"$nook" tile --pattern disk.json --size 2 --filter box:2 --frames 2 --starts 1 -o frames.json
echo '{"taps": [[0, 1, 0], [1, 4, 1], [0, 1, 0]]}' >filter.json
"$nook" level builtin:cornell -o cornell.glb >out
"$nook" volumes builtin:cornell --distance 0.5 -o volumes.glb >out
"$nook" volumes builtin:cornell --distance 0.5 --layout prisms --compress -o prisms.glb >out
"$nook" gbuffer builtin:cornell --camera main --size 12x8 -o small.exr >out
"$nook" gbuffer builtin:courtyard --camera auto:1 --size 40x30 --normals from-depth -o large.exr >out
"$nook" report error builtin:cornell --grid quick --methods statvo,aov,rays --size 16x9 --rays 4 --repetitions 1 --shifts 2 --pictures 1 --device cpu --json report.json
"$nook" fit builtin:cornell --methods statvo --views 1 --size 16x9 --rays 4 -o recipes.json >out
printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >triangle.ply
printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n' >triangle.stl
printf '; FBX 7.4.0\nFBXHeaderExtension: {\nFBXVersion: 7400\n}\nObjects: {\nGeometry: 2, "Geometry::", "Mesh" {\nVertices: *9 {\na: 0,0,0,1,0,0,0,1,0\n}\nPolygonVertexIndex: *3 {\na: 0,1,-3\n}\n}\nModel: 1, "Model::a", "Mesh" {\nProperties70: {\nP: "Lcl Scaling", "", "", "A",1,2,3\n}\n}\n}\nConnections: {\nC: "OO",1,0\nC: "OO",2,1\n}\n' >triangle.fbx
printf 'gbuffer\nbuiltin:cornell\n--camera\nauto:3\n--size\n64x48\n--eye\n1,2,3\n--target\n0,1e3,-4\n--fov\n60\n-o\ng.exr' >command_1
printf 'shade\ng.exr\n--method\nvo-line\n--radius\n0.5\n--projection\n1,0,0,0,0,1,0,0,0,0,-1,-1,0,0,-0.1,0\n--threads\n2' >command_2
printf 'bake\nhouse.glb\n--rays\n1000000\n--seed\n4294967295\n--radius\n12' >command_3
printf 'catalogue\n--counts\n1-64\n--check\n-o\npatterns' >command_4
for file in disk.json ball.json tile.json frames.json filter.json; do seed pattern $file; done
for file in disk.csv ball.csv; do seed csv $file; done
cat >posed.gltf <<'EOT'
{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0, "skin": 0}, {"translation": [0, 1, 0]}],
 "meshes": [{"weights": [0.5], "primitives": [{"material": 0, "targets": [{"POSITION": 0}],
  "attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2, "COLOR_0": 2}}]}], "skins": [{"joints": [1]}],
 "materials": [{"alphaMode": "BLEND"}], "buffers": [{"byteLength": 64, "uri": "data:;base64,AAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAAAA/wAAAP8AAACAAACAAAAAAA=="}],
 "bufferViews": [{"buffer": 0, "byteLength": 64}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
  {"bufferView": 0, "byteOffset": 36, "componentType": 5121, "count": 3, "type": "VEC4"},
  {"bufferView": 0, "byteOffset": 48, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC4"}]}
EOT
for file in cornell.glb posed.gltf; do seed glb $file; done
for file in volumes.glb prisms.glb; do seed volumes $file; seed glb $file; done
for file in small.exr large.exr; do seed exr $file; done
for file in report.json recipes.json; do seed report $file; done
for file in triangle.ply triangle.stl triangle.fbx; do seed meshes $file; done
for file in command_1 command_2 command_3 command_4; do seed command $file; done
"$nook" plan --shares 3 --for slurm -o jobs -- volumes builtin:cornell --distance 1 -o planned.glb >out
cat >list.json <<'EOT'
{"schema": "nook.levels/1", "values": {"rays": "16"},
 "steps": [{"name": "depth", "command": ["gbuffer", "{level}", "--size", "64x36", "-o", "{name}.g.exr"]},
           {"name": "rays", "shares": 3, "command": ["reference", "{level}", "--gbuffer", "{name}.g.exr", "--rays", "{rays}", "-o", "{name}.exr"]}],
 "levels": [{"name": "one", "level": "builtin:cornell"}, {"name": "two", "level": "two.glb", "values": {"rays": "4"}}]}
EOT
for file in jobs/plan.json list.json; do seed farm $file; done
head -c 600 cornell.glb >numbers
for target in gbuffer shade capi; do seed $target numbers; done
[ -z "${NOOK_FUZZ_SEEDS:-}" ] || cp -r "$NOOK_FUZZ_SEEDS/." "$seeds/"

# run TARGET: fuzzes it.
run()
{
	coverage=${NOOK_FUZZ_COVERAGE:+-print_coverage=1}
	# shellcheck disable=SC2086
	TMPDIR=$scratch "$build/tests/fuzz/fuzz_$1" "$build/corpus/$1" "$seeds/$1" -max_total_time="$seconds" -timeout=20 \
		-rss_limit_mb=3000 -max_len=100000 -artifact_prefix="$build/findings/$1-" -print_final_stats=1 $coverage \
		>"$scratch/log_$1" 2>&1 &&
		{ [ -z "$coverage" ] || cp "$scratch/log_$1" "$NOOK_FUZZ_COVERAGE/$1"; } &&
		echo "ok $1: $(sed -n 's/^stat::number_of_executed_units: *//p' "$scratch/log_$1") inputs" && return
	echo "FAILED $1: see $build/findings"
	tail -n 60 "$scratch/log_$1"
	touch "$scratch/failed"
}
for target in $targets; do
	run "$target" &
	running=$((${running:-0} + 1))
	if [ $((running % 5)) = 0 ]; then
		wait
	fi
done
wait
[ ! -e "$scratch/failed" ]
