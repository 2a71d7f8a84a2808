# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: debian_test.sh PROGRAM SOURCE BUILD [PACKAGES]. Makes Debian packages of BUILD, or takes those in the folder PACKAGES, checks
# them with lintian, installs them in an empty root and uses find_package(nook) and, where BUILD has the library, the Python package from
# there. Exit code 77: a tool is missing.
set -u
nook=$1
build=$3
version=$("$nook" --version | sed -n 's/^nook //p')
for words in "packaging/vcpkg/nook/vcpkg.json:\"version\": \"$version\"" "CITATION.cff:^version: $version$"; do
	grep -q "${words#*:}" "$2/${words%%:*}" || { echo "FAILED: ${words%%:*}: expected version $version"; exit 1; }
done
packages=${4:+$(realpath "$4")}
for tool in dpkg-deb dpkg-shlibdeps lintian; do
	if ! command -v $tool >/dev/null; then
		echo "skipped: found no $tool, expected Debian's packages dpkg-dev and lintian (scripts/setup.sh debian)"
		exit 77
	fi
done
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/steps.sh"
unset DESTDIR NOOK_EXECUTABLE CMAKE_PREFIX_PATH CMAKE_GENERATOR || true

umask 022
if [ -n "$packages" ]; then
	mkdir "$folder/packages" && cp "$packages"/*.deb "$folder/packages" || exit 1
else
	step "cpack" sh -c 'cd "$1" && cpack -G DEB -B "$2"' sh "$build" "$folder/packages" || finish
fi
arch=$(dpkg --print-architecture)
program="$folder/packages/nook_${version}_$arch.deb"
library="$folder/packages/libnook-dev_${version}_$arch.deb"
shared=
python=
if grep -q '^NOOK_LIBRARY:BOOL=ON' "$build/CMakeCache.txt"; then
	shared="$folder/packages/libnook1_${version}_$arch.deb"
	python="$folder/packages/python3-nook_${version}_all.deb"
fi
set -- "$program" "$library" ${shared:+"$shared" "$python"}
step "the packages are named as Debian names them" ls "$@" || finish

step "lintian" lintian --allow-root --no-tag-display-limit --fail-on error,warning "$@" || cat "$folder/log"

# has PACKAGE PATH
has()
{
	dpkg-deb --contents "$1" >"$folder/contents"
	grep -q " \./$2\$" "$folder/contents" || problem "$(basename "$1"): found no $2"
}
has "$program" usr/bin/nook
has "$program" usr/share/nook/patterns/disk/disk_009.json
has "$library" usr/lib/cmake/nook/nookConfig.cmake
has "$library" usr/include/nook/nook_volumes.h
dpkg-deb --field "$library" Depends | grep -q "nook (= $version)" || problem "libnook-dev: found no dependency on nook of its version"
dpkg-deb --field "$program" Depends | grep -q libc6 || problem "nook: found no dependency on libc6"

# An empty root; the packages' dependencies come from the machine.
root="$folder/an empty root"
mkdir -p "$root/var/lib/dpkg/info" "$root/var/lib/dpkg/updates" "$root/var/log"
: >"$root/var/lib/dpkg/status"
: >"$root/var/lib/dpkg/available"
step "dpkg --install" dpkg "--root=$root" --force-not-root --force-depends --force-script-chrootless --install "$@" || cat "$folder/log"
[ "$("$root/usr/bin/nook" --version)" = "$("$nook" --version)" ] || problem "the installed program says another version"

# Every option has its own help in the man pages, and completions know an option's choices.
for page in "$root"/usr/share/man/man1/nook*.1.gz; do
	zcat "$page" | awk -v page="${page##*/}" 'before == ".TP" && $0 == "" { print page ": nothing about " last } { before = last; last = $0 }'
done >"$folder/log"
[ ! -s "$folder/log" ] || problem "$(head -n 3 "$folder/log")"
words=$(bash -c '. "$1"; COMP_WORDS=(nook emit --glsl ""); COMP_CWORD=3; _nook; echo "${COMPREPLY[*]}"' bash "$root/usr/share/bash-completion/completions/nook")
[ "$words" = "330 430 es300 vulkan" ] || problem "bash: nook emit --glsl: found '$words', expected the languages"

mkdir "$folder/project"
cat >"$folder/project/CMakeLists.txt" <<'EOT'
cmake_minimum_required(VERSION 3.25)
project(uses LANGUAGES CXX)
find_package(nook CONFIG REQUIRED)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/a.cpp "#include \"disk_003.h\"\nint main() { return NOOK_DISK_3_COUNT - 3; }\n")
add_executable(uses ${CMAKE_CURRENT_BINARY_DIR}/a.cpp)
nook_add_patterns(uses DOMAIN disk COUNTS 3 OPTIONS --method vogel)
EOT
step "find_package: configure" cmake -G Ninja -S "$folder/project" -B "$folder/project/build" "-DCMAKE_PREFIX_PATH=$root/usr" &&
	step "find_package: build" cmake --build "$folder/project/build" && step "find_package: run" "$folder/project/build/uses"
step "found in that root" grep -q "$root/usr" "$folder/project/build/CMakeCache.txt"

# Python's numpy is the machine's; the library and its workers are those of the root.
if [ -n "$python" ]; then
	has "$shared" "usr/lib/libnook.so.1 -> .*"
	has "$python" usr/lib/python3/dist-packages/nook/__init__.py
	dpkg-deb --field "$shared" Depends | grep -q "libembree[34]-" || problem "libnook1: found no dependency on Embree"
	for package in "libnook1 (>= $version)" python3-numpy; do
		dpkg-deb --field "$python" Depends | grep -Fq "$package" || problem "python3-nook: found no dependency on $package"
	done
	printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$folder/level.obj"
	step "Python: the pattern of the program" "$nook" pattern --domain disk --count 9 -o "$folder/program.json"
	step "Python" env -C "$folder" -u NOOK_LIBRARY "PYTHONPATH=$root/usr/lib/python3/dist-packages" \
		"LD_LIBRARY_PATH=$(dirname "$(find "$root/usr/lib" -name libnook.so.1)")" /usr/bin/python3 -B -c '
import nook
assert nook.__file__.startswith("'"$root"'"), nook.__file__
nook.pattern("disk", 9).save("python.json")
print(nook.Level.load("level.obj").bake(radius=1, rays=16).visibility)'
	same "$folder/python.json" "$folder/program.json" "Python: other bytes than those of the program"
fi
finish
