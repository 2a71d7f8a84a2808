#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# static_object.sh LD NM OBJCOPY OUTPUT INPUT...: one object of objects and archives, with nook_* as its only visible symbols. Programs
# may then contain other versions of the libraries whose templates nook compiles.
set -eu
ld=$1
nm=$2
objcopy=$3
output=$4
shift 4
trap 'rm -f "$output.unique"' EXIT
# Groups would be dropped in favour of a program's own, although local symbols point into them.
"$ld" -r --force-group-allocation -o "$output" "$@"
# objcopy makes weak symbols local, but not unique ones.
"$nm" "$output" | sed -n 's/.* u //p' >"$output.unique"
"$objcopy" "--weaken-symbols=$output.unique" "$output"
"$objcopy" --wildcard --keep-global-symbol='nook_*' --strip-unneeded --remove-section=.comment "$output"
