#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: library_test.sh PROGRAM SOURCE BUILD. Installs libnook, checks what it exports, and uses it from the examples in C, C++ and, with
# Mono, C#.
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

step "examples: configure" cmake -G Ninja -S "$source/examples/library" -B "$folder/examples" "-DCMAKE_PREFIX_PATH=$folder/prefix" || finish
step "examples: build" cmake --build "$folder/examples" || finish
step "C" "$folder/examples/visibility"
grep -qx '1.000' "$folder/log" || problem "C: found $(cat "$folder/log"), expected 1.000 in the open"
step "C++" "$folder/examples/bake" builtin:cornell "$folder/library.glb"
step "the program" "$nook" bake builtin:cornell --radius 2 --rays 64 -o "$folder/program.glb"
same "$folder/library.glb" "$folder/program.glb" "C++: other bytes than those of the program"
if command -v mcs >/dev/null && command -v mono >/dev/null; then
	step "C#: compile" mcs -unsafe "-out:$folder/Pattern.exe" "$source/examples/library/Pattern.cs"
	step "C#" env "LD_LIBRARY_PATH=$(dirname "$library")" mono "$folder/Pattern.exe"
	[ "$(wc -l <"$folder/log")" -eq 9 ] || problem "C#: expected nine lines, found $(cat "$folder/log")"
fi
finish
