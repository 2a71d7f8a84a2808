#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: components_test.sh PROGRAM SOURCE FOLDER. Builds the component patterns alone in FOLDER (kept), with neither oneTBB nor GMP and
# without optimisation, and holds it against PROGRAM: the same bytes, and a plain word where a verb is of another component. A library that is missing when
# the build is configured is named with Debian's package of it.
set -u
nook=$1
source=$2
build=$3
. "$(dirname "$0")/table.sh"

configure()
{
	cmake -G Ninja -S "$source" -B "$@" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG= -DNOOK_BUILD_TESTS=OFF -DNOOK_BUILD_BENCHMARKS=OFF >"$folder/log" 2>&1
}

if ! { configure "$build" -DNOOK_COMPONENTS=patterns -DNOOK_GMP=OFF -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON &&
	cmake --build "$build" >"$folder/log" 2>&1; }; then
	problem "the component patterns: not built"
	tail -n 40 "$folder/log"
	finish
fi
alone=$build/tools/nook

# What it is linked to.
if ldd "$alone" | grep -E 'tbb|gmp|mpfr|png|OpenImageIO|embree|assimp|EGL'; then
	problem "the component patterns: found these libraries, expected the compiler's alone"
fi

# The same bytes.
while read -r name options; do
	"$nook" $options -o "$folder/here.$name" || problem "$name: not made"
	"$alone" $options -o "$folder/alone.$name" || problem "$name: not made by the component alone"
	same "$folder/here.$name" "$folder/alone.$name" "$name: without oneTBB, GMP and optimisation, expected the bytes of the whole program"
done <<-EOT
	disk.json pattern --domain disk --count 9 --symmetric --starts 4
	disk.svg pattern --domain disk --count 7 --starts 2
	ball.h pattern --domain ball --count 12 --centre --method electro --starts 3
	sphere.json pattern --domain sphere --count 24 --starts 3
	hemisphere.glsl pattern --domain hemisphere --count 9 --starts 3
	tile.json tile --pattern $source/patterns/disk/disk_004.json --size 2
	vo.glsl emit --methods vo-line --patterns $source/patterns/disk/disk_009_tile4.json --filter window --glsl es300
	noise.html report noise --max-count 2 --starts 2
EOT

# refuses COMMAND...: exit code 5 and one line that names the component.
refuses()
{
	component=$1
	shift
	"$alone" "$@" >"$folder/out" 2>"$folder/err"
	code=$?
	if [ $code -ne 5 ] || [ "$(wc -l <"$folder/err")" -ne 1 ] || ! grep -q "the component $component" "$folder/err"; then
		problem "nook $*: exit code $code and '$(cat "$folder/err")', expected 5 and a line about the component $component"
	fi
}
for verb in gbuffer reference compare level volumes bake "info builtin:cornell"; do
	refuses levels $verb
done
refuses levels tile --pattern "$source/patterns/disk/disk_004.json" --size 2 -o "$folder/tile.png"
refuses shading shade x.exr --method vo-line
for verb in tune stress "report error" "report live"; do
	refuses reports $verb
done

# missing PACKAGE VARIABLES...: configuring ends with a line that names Debian's package.
missing()
{
	package=$1
	shift
	rm -rf "$folder/missing"
	if configure "$folder/missing" "$@"; then
		problem "$package: configured without it"
	fi
	grep -q "expected Debian's package $package" "$folder/log" || problem "$package: not named where it is missing: $(tail -n 3 "$folder/log")"
}
missing libembree-dev -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON
missing libcli11-dev -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON -DNOOK_COMPONENTS=patterns
finish
