# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: same_bytes_test.sh PROGRAM SOURCE FOLDER [BUILD...]. Builds nook in FOLDER/BUILD (kept to speed up later runs) and compares
# its outputs with PROGRAM's. BUILD: release_clang, optimised with clang++ (the default), or debug_gcc, unoptimised with g++
# (without debug information). Exit code 77: no clang++ with libFuzzer.
set -u
nook=$1
source=$2
builds=$3
shift 3
builds_asked=${*:-release_clang}
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/samples.sh"

# build NAME OPTIONS...: options of CMake.
build()
{
	name=$1
	shift
	cmake -G Ninja -S "$source" -B "$builds/$name" "$@" -DNOOK_BUILD_TESTS=OFF -DNOOK_BUILD_BENCHMARKS=OFF >"$folder/log" 2>&1 &&
		cmake --build "$builds/$name" --target nook >"$folder/log" 2>&1 && return
	problem "$name: not built"
	tail -n 40 "$folder/log"
	finish
}

case $builds_asked in
*clang*)
	echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' >"$folder/empty.cpp"
	clang++ -fsanitize=fuzzer "$folder/empty.cpp" -o "$folder/empty" 2>/dev/null ||
		{ echo "skipped: found no clang++ that links libFuzzer, expected one (scripts/setup.sh clang)"; exit 77; }
	;;
esac
mkdir "$folder/here"
makeSamples "$nook" "$folder/here" 2
for name in $builds_asked; do
	case $name in
	# With the options of scripts/fuzz.sh, which can then reuse everything except its own sources. These compile faster at -O0.
	release_clang) build $name -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Release -DNOOK_FUZZ=ON -DNOOK_FUZZ_LEVEL=-O0 ;;
	debug_gcc) build $name -DCMAKE_CXX_COMPILER=g++ -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG= ;;
	*) problem "found the build '$name', expected release_clang or debug_gcc" && finish ;;
	esac
	mkdir "$folder/$name"
	makeSamples "$builds/$name/tools/nook" "$folder/$name" 2
	for file in "$folder"/here/*; do
		same "$file" "$folder/$name/$(basename "$file")" "$(basename "$file"): $name, expected the bytes of this build"
	done
done
finish
