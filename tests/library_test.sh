#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: library_test.sh PROGRAM SOURCE BUILD. Installs libnook, checks what it exports, and uses it from the examples in C and C++, shared
# and static, and, with Mono, C#.
set -u
nook=$1
source=$2
build=$3
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/steps.sh"

step "install" cmake --install "$build" --prefix "$folder/prefix" || finish
library=$(find "$folder/prefix" -name 'libnook.so.?')

# The functions of the header, and nothing else.
grep -o '\bnook_[a-z_]*(' "$source/include/nook/nook.h" | tr -d '(' | sort -u >"$folder/declared"
nm -D --defined-only "$library" | sed -n 's/.* [A-Z] \([A-Za-z_0-9]*\).*/\1/p' | grep -v '^NOOK_1$' | sort -u >"$folder/exported"
same "$folder/declared" "$folder/exported" "the library exports other symbols than nook.h declares"
[ "$(wc -l <"$folder/declared")" -le 60 ] || problem "more than 60 functions"

# The static library shows the same.
nm -g --defined-only "$(dirname "$library")/libnook.a" | sed -n 's/^[0-9a-f]* . //p' | sort -u >"$folder/visible"
same "$folder/declared" "$folder/visible" "the static library shows other symbols than nook.h declares"

step "the program" "$nook" bake builtin:cornell --radius 2 --rays 64 -o "$folder/program.glb"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$folder/level.obj" # read by a worker
step "the program: a file" "$nook" bake "$folder/level.obj" --radius 2 --rays 64 -o "$folder/program_file.glb"
for kind in library static; do
	examples="$folder/examples of $kind"
	step "$kind: configure" cmake -G Ninja -S "$source/examples/library" -B "$examples" "-DCMAKE_PREFIX_PATH=$folder/prefix" -DNOOK_KIND=$kind || finish
	step "$kind: build" cmake --build "$examples" || finish
	step "$kind: C" "$examples/visibility"
	grep -qx '1.000' "$folder/log" || problem "$kind: C: found $(cat "$folder/log"), expected 1.000 in the open"
	step "$kind: C++" "$examples/bake" builtin:cornell "$folder/$kind.glb"
	same "$folder/$kind.glb" "$folder/program.glb" "$kind: C++: other bytes than those of the program"
	step "$kind: C++, a file" "$examples/bake" "$folder/level.obj" "$folder/${kind}_file.glb"
	same "$folder/${kind}_file.glb" "$folder/program_file.glb" "$kind: C++, a file: other bytes than those of the program"
done
ldd "$folder/examples of static/bake" | grep -q libnook && problem "static: the program loads libnook.so"
if command -v mcs >/dev/null && command -v mono >/dev/null; then
	step "C#: compile" mcs -unsafe "-out:$folder/Pattern.exe" "$source/examples/library/Pattern.cs"
	step "C#" env "LD_LIBRARY_PATH=$(dirname "$library")" mono "$folder/Pattern.exe"
	[ "$(wc -l <"$folder/log")" -eq 9 ] || problem "C#: expected nine lines, found $(cat "$folder/log")"
fi
finish
