#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: components_test.sh PROGRAM SOURCE. Configuring without a required library names the library and its Debian package. For the
# component patterns alone see targets_test.sh.
set -u
source=$2
. "$(dirname "$0")/table.sh"

# missing PACKAGE VARIABLES...
missing()
{
	package=$1
	shift
	checks=$((checks + 1))
	if cmake -G Ninja -S "$source" -B "$folder/$package" -DNOOK_BUILD_TESTS=OFF -DNOOK_BUILD_BENCHMARKS=OFF "$@" >"$folder/log" 2>&1; then
		problem "$package: configured without it"
	fi
	grep -q "expected Debian's package $package" "$folder/log" || problem "$package: not named where it is missing: $(tail -n 3 "$folder/log")"
}
missing libembree-dev -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON
missing libcli11-dev -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON -DNOOK_COMPONENTS=patterns
finish
