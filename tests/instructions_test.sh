# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: instructions_test.sh PROGRAM [ISA...]. Embree selects code by the processor: checks for equal bytes with every choice (sse2
# and avx2 compared with the processor's own; long commands only with the first), and on an emulated processor if an emulator is
# available.
set -u
nook=$1
shift
sets=${*:-sse2 avx2}
. "$(dirname "$0")/table.sh"
cd "$folder" || exit 1

# makes FOLDER COMMAND...: ray-traced outputs, by a program that runs nook.
makes()
{
	mkdir "$1"
	own=$1
	shift
	"$@" gbuffer builtin:suburb --size 48x27 -o "$own/g.exr" >log 2>&1 || problem "$own: gbuffer: $(tail -n 1 log)"
	"$@" gbuffer builtin:courtyard --camera auto:1 --size 48x27 -o "$own/auto.exr" >log 2>&1 || problem "$own: gbuffer auto: $(tail -n 1 log)"
	"$@" reference builtin:suburb --gbuffer here/g.exr --radius 1 --rays 64 -o "$own/r.exr" >log 2>&1 || problem "$own: reference: $(tail -n 1 log)"
	"$@" reference builtin:suburb --gbuffer here/g.exr --radius 1 --falloff linear --rays 64 -o "$own/linear.exr" >log 2>&1 ||
		problem "$own: reference, linear: $(tail -n 1 log)"
	"$@" volumes builtin:cornell --distance 0.5 --compensate -o "$own/volumes.glb" >log 2>&1 || problem "$own: volumes: $(tail -n 1 log)"
}

# makesMuch FOLDER COMMAND...: outputs that take half a minute.
makesMuch()
{
	own=$1
	shift
	"$@" gbuffer builtin:suburb --size 256x144 -o "$own/large.exr" >log 2>&1 || problem "$own: gbuffer: $(tail -n 1 log)"
	# Nineteen million rays: some miss an edge by less than 32 bits resolve.
	"$@" reference builtin:suburb --gbuffer here/large.exr --radius 1 --rays 512 -o "$own/many.exr" >log 2>&1 || problem "$own: reference, many rays: $(tail -n 1 log)"
	"$@" volumes builtin:suburb --distance 0.9 --compensate --trim 0.05 -o "$own/compensated.glb" --json "$own/compensated.json" >log 2>&1 ||
		problem "$own: volumes --compensate: $(tail -n 1 log)"
}

# alike FOLDER FILES: compares them with "here".
alike()
{
	found=$(ls "$1" | wc -l)
	[ "$found" -eq "$2" ] || problem "$1: found $found files, expected $2"
	for file in "$1"/*; do
		same "here/${file#"$1"/}" "$file" "${file#"$1"/}: $1, expected the bytes of this processor's instructions"
	done
}

NOOK_TEST_ISA=sse9 "$nook" gbuffer builtin:cornell --size 2x2 -o one.exr >log 2>&1
[ $? -eq 1 ] && [ "$(cat log)" = "nook: NOOK_TEST_ISA: found 'sse9', expected sse2, sse4.2, avx, avx2 or avx512" ] || problem "sse9: $(cat log)"
[ ! -e one.exr ] || problem "sse9: found a file, expected none"

makes here "$nook"
makesMuch here "$nook"
much=yes
tried=0
for isa in $sets; do
	if ! NOOK_TEST_ISA=$isa "$nook" gbuffer builtin:cornell --size 2x2 -o one.exr >log 2>&1; then
		grep -q "^nook: NOOK_TEST_ISA: found '$isa', expected instructions" log || problem "$isa: $(cat log)"
		echo "$isa: skipped: found that this processor has it not"
		continue
	fi
	tried=$((tried + 1))
	makes $isa env NOOK_TEST_ISA=$isa "$nook"
	[ "$much" = no ] || makesMuch $isa env NOOK_TEST_ISA=$isa "$nook"
	[ "$much" = no ] && alike $isa 5 || alike $isa 9
	[ $# -gt 0 ] || much=no
done
[ $tried -ge 2 ] || problem "found $tried sets of instructions, expected two or more to compare"

# Workers are emulated too: scripts in their place start them in the emulator.
if ! command -v qemu-x86_64-static >log; then
	echo "an emulated processor: skipped: found no qemu-x86_64-static, expected it (scripts/setup.sh)"
	finish
fi
mkdir -p built/tools built/libsamples/core
cp "$nook" built/tools/nook
for worker in nook_image_worker nook_picture_worker nook_level_worker; do
	ln -s "$(dirname "$(dirname "$nook")")/libsamples/core/$worker" built/$worker
	printf '#!/bin/sh\nexec qemu-x86_64-static -cpu "$cpu" "%s" "$@"\n' "$PWD/built/$worker" >built/libsamples/core/$worker
	chmod +x built/libsamples/core/$worker
done
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >a.obj
"$nook" level a.obj -o a.glb >log
"$nook" pattern --domain disk --count 5 -o p.json >log
"$nook" tile --pattern p.json --size 2 --filter binomial:3 --starts 1 -o native.json >log
for cpu in max Nehalem; do
	export cpu
	checks=$((checks + 5))
	qemu-x86_64-static -cpu $cpu built/tools/nook gbuffer builtin:cornell --size 16x9 -o $cpu.exr >log 2>&1 || problem "$cpu: gbuffer: $(cat log)"
	"$nook" gbuffer builtin:cornell --size 16x9 -o native.exr >log 2>&1
	same native.exr $cpu.exr "$cpu: an OpenEXR, expected the bytes of this processor"
	qemu-x86_64-static -cpu $cpu built/tools/nook info $cpu.exr >log 2>&1 || problem "$cpu: info: $(cat log)"
	qemu-x86_64-static -cpu $cpu built/tools/nook level a.obj -o $cpu.glb >log 2>&1 || problem "$cpu: level: $(cat log)"
	same a.glb $cpu.glb "$cpu: a level, expected the bytes of this processor"
	# Pairs of lines with and without AVX2.
	qemu-x86_64-static -cpu $cpu built/tools/nook tile --pattern p.json --size 2 --filter binomial:3 --starts 1 -o $cpu.json >log 2>&1 ||
		problem "$cpu: tile: $(cat log)"
	same native.json $cpu.json "$cpu: a tile, expected the bytes of this processor"
done
finish
