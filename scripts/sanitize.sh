#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs nook under sanitizers: sanitize.sh addresses [SHARE] | threads. addresses: every hostile file (tests/hostile), or one in
# SHARE of each large group, with the address and undefined-behaviour sanitizers, workers included. threads: the parallel code with
# the thread sanitizer. Exit code 1: an error was found.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
what=${1:?expected addresses or threads}
case $what in
addresses) preset=asan targets="nook nook_hostile" ;;
threads) preset=tsan targets=nook ;;
*)
	echo "sanitize.sh: found '$what', expected addresses or threads" >&2
	exit 1
	;;
esac
build=$source/build/$preset
cd "$source"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# shellcheck disable=SC2086
{ cmake --preset "$preset" -B "$build" -DNOOK_BUILD_BENCHMARKS=OFF && cmake --build "$build" --target $targets; } >"$log" 2>&1 || { tail -n 40 "$log" >&2; exit 1; }
nook=$build/tools/nook

if [ "$what" = addresses ]; then
	# Ignores leaks, since processes exit without freeing memory. The factor is the sanitizers' slowdown on a busy machine.
	ASAN_OPTIONS=detect_leaks=0 "$build/tests/nook_hostile" "$nook" tests/hostile/codes.txt --slow 8 --share "${2:-1}"
	exit
fi

folder=$(mktemp -d)
trap 'rm -rf "$log" "$folder"' EXIT
cd "$folder"
export TSAN_OPTIONS="suppressions=$source/tests/thread_checks.txt exitcode=66 halt_on_error=1"
failures=0
# checked ARGUMENTS: on four threads. Without address randomisation, which the thread sanitizer does not support on newer kernels.
checked()
{
	setarch -R "$nook" "$@" --threads 4 >"$log" 2>&1 && echo "ok: $*" && return
	failures=$((failures + 1))
	echo "FAILED: $*"
	head -n 60 "$log"
}
checked pattern --domain disk --count 8 --starts 8 -o p.json
checked pattern --domain ball --count 8 --starts 4 --method electro -o b.json
checked tile --pattern p.json --size 2 --kind random -o t.json
checked tile --pattern p.json --size 2 --filter box:2 --frames 2 -o f.json
checked gbuffer builtin:suburb --size 96x54 -o g.exr
checked gbuffer builtin:courtyard --camera auto:1 --size 48x27 -o auto.exr
checked reference builtin:suburb --gbuffer g.exr --radius 1 --rays 64 -o r.exr
checked reference builtin:suburb --gbuffer g.exr --radius 1 --measure sphere --rays 16 -o s.exr
checked reference --gbuffer g.exr --radius 1 --measure sphere --from depth --rays 16 -o d.exr
checked volumes builtin:cornell --distance 0.5 --trim 0.05 --compensate -o v.glb
checked volumes builtin:suburb --distance 0.5 -o large.glb
for method in vo-line vo-point vo-area alchemy statvo slices; do
	checked shade g.exr --method $method --device cpu -o $method.exr
done
checked shade g.exr --method vo-line --device cpu --filter bilateral --resolution half -o half.exr
checked shade g.exr --method aov --volumes large.glb --device cpu -o aov.exr
checked fit builtin:cornell --methods statvo --views 1 --size 16x9 --rays 4 -o fit.json
checked report noise --max-count 2 --starts 1 --seeds 2 -o noise.html
checked report error builtin:cornell --grid quick --size 16x9 --rays 4 --repetitions 1 --shifts 2 --pictures 0 --device cpu -o error.html
echo "$failures failures"
[ "$failures" -eq 0 ]
