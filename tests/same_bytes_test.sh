# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: same_bytes_test.sh PROGRAM SOURCE FOLDER. Builds nook without optimisation by g++ and with it by clang++ in FOLDER
# (kept, so that a second run is quick; nobody debugs it, so without what a debugger reads), and compares what each of them makes
# with what PROGRAM makes.
set -u
nook=$1
source=$2
builds=$3
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/samples.sh"

# build NAME COMPILER TYPE
build()
{
	cmake -G Ninja -S "$source" -B "$builds/$1" -DCMAKE_CXX_COMPILER="$2" -DCMAKE_BUILD_TYPE="$3" \
		-DCMAKE_CXX_FLAGS_DEBUG= \
		-DNOOK_BUILD_TESTS=OFF -DNOOK_BUILD_BENCHMARKS=OFF >"$folder/log" 2>&1 &&
		cmake --build "$builds/$1" --target nook >"$folder/log" 2>&1 && return
	problem "$1: not built"
	tail -n 40 "$folder/log"
	finish
}

mkdir "$folder/here"
makeSamples "$nook" "$folder/here" 2
while read -r name compiler type; do
	build "$name" "$compiler" "$type"
	mkdir "$folder/$name"
	makeSamples "$builds/$name/tools/nook" "$folder/$name" 2
	for file in "$folder"/here/*; do
		same "$file" "$folder/$name/$(basename "$file")" "$(basename "$file"): $name, expected the bytes of this build"
	done
done <<-EOT
	debug_gcc g++ Debug
	release_clang clang++ Release
EOT
finish
