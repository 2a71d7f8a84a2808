#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: abi_test.sh SOURCE [record]. Compares functions, types and constants of include/nook/nook.h with tests/nook.abi, which `record`
# writes anew. Exit code 77: a tool is missing, or this is another processor.
# A library of empty functions stands for libnook.so, which has no debug information and which library_test.sh compares with the header.
set -u
header=$1/include/nook/nook.h
known=$1/tests/nook.abi
if ! command -v abidw >/dev/null || [ "$(uname -m)" != x86_64 ]; then
	echo "skipped: found $(uname -m) and no abidw, expected x86_64 and Debian's package abigail-tools (scripts/setup.sh)"
	exit 77
fi
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/steps.sh"

# A constant is an array of that many and one bytes.
{
	cc -E -P -DNOOK_API=NOOK_FUNCTION "$header" | tr '\n\t' '  ' | tr ';' '\n' | sed -n 's/.*NOOK_FUNCTION \(.*\)/\1 { __builtin_trap(); }/p'
	sed -n 's/^\t\(NOOK_[A-Z0-9_]*\) = .*/\1/p; s/^#define \(NOOK_[A-Z_]*\) [0-9]*$/\1/p' "$header" | sed 's/.*/char value_of_&[& + 1];/'
} >"$folder/nook.c"
step "compile" cc -std=c11 -g -shared -fPIC -include "$(realpath "$header")" -o "$folder/libnook.so" -x c - <"$folder/nook.c" || finish
step "describe" abidw --no-corpus-path --no-comp-dir-path --no-show-locs --no-parameter-names --no-elf-needed --out-file "$folder/nook.abi" "$folder/libnook.so" || finish
if [ "${2:-}" = record ] && { [ ! -e "$known" ] || abidiff --no-added-syms "$known" "$folder/nook.abi" >"$folder/log" || grep -q value_of_NOOK_ABI "$folder/log"; }; then
	cp "$folder/nook.abi" "$known"
fi
step "compiled programs run with a library of this header, or NOOK_ABI has grown" abidiff --no-added-syms "$known" "$folder/nook.abi"
step "additions, and what goes with a larger NOOK_ABI, are recorded: sh tests/abi_test.sh . record" abidiff "$known" "$folder/nook.abi"
finish
