#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds every artefact of a release into a folder, with SHA256SUMS, TESTED (where each was tried by this script, or why not) and NOTES
# (the first section of CHANGELOG.md). A preset whose compiler is missing is left out, with a line in TESTED. Exit code 4: a test failed.
# usage: release.sh FOLDER
set -eu
[ $# -eq 1 ] || { echo "release.sh: found '$*', expected FOLDER" >&2; exit 1; }
mkdir -p "$1"
out=$(realpath "$1")
cd "$(dirname "$(realpath "$0")")/.."
[ -z "$(ls "$out")" ] || { echo "release.sh: $out: found files, expected an empty folder" >&2; exit 3; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# built TARGET PRESET OPTIONS...: whether that preset can be built here; builds it.
built()
{
	target=$1
	shift
	cmake --preset "$@" >"$scratch/log" 2>&1 && cmake --build --preset "$1" --target "$target" >"$scratch/log" 2>&1 && return
	echo "$1: not built: $(grep -m 1 -i 'error' "$scratch/log" || tail -n 1 "$scratch/log")" >>"$out/TESTED"
	return 1
}

# tested FILES WHERE COMMAND...: exit code 77 is a tool that is missing.
tested()
{
	files=$1
	where=$2
	shift 2
	status=0
	"$@" >"$scratch/log" 2>&1 || status=$?
	case $status in
	0) echo "$files: $where" ;;
	77) echo "$files: not tested: $where: $(tail -n 1 "$scratch/log")" ;;
	*) echo "$files: FAILED: $where: $(grep -m 1 FAILED "$scratch/log" || tail -n 1 "$scratch/log")" ;;
	esac >>"$out/TESTED"
}

system=$(. /etc/os-release && echo "$PRETTY_NAME")
if built all release; then
	release=$PWD/build/release
	packaging/portable.sh build/release "$out"
	tested "nook-*-linux-x86_64.tar.xz" "an empty root on $system" sh tests/portable_test.sh "$release/tools/nook" . build/release
	(cd "$release" && cpack -G DEB -B "$out" >/dev/null)
	rm -rf "$out/_CPack_Packages"
	tested "*.deb" "lintian and an empty root on $system" sh tests/debian_test.sh "$release/tools/nook" . "$release"
	tested "libnook1_*.deb, libnook-dev_*.deb" "C, C++ and C# on $system" sh tests/library_test.sh "$release/tools/nook" . "$release"
	cmake --install "$release" --prefix "$scratch/installed" >/dev/null
	packaging/wheel.sh "$scratch/installed" "$out"
	python3 -m zipfile -e "$out"/nook-*.whl "$scratch/wheel/python"
	chmod +x "$scratch"/wheel/python/nook/lib/nook_*_worker # as pip does
	tested "nook-*.whl" "Python on $system" /usr/bin/python3 tests/python_test.py "$release/tools/nook" "$scratch/wheel" "$scratch/wheel/python/nook/lib/libnook.so.1"
	sh npm/ao/pack.sh "$release/tools/nook" "$scratch/ao" && (cd "$scratch/ao" && npm pack --pack-destination "$out" >/dev/null 2>&1)
	tested "nook-ao-*.tgz" "Chromium on $system" sh tests/npm_ao_test.sh "$release/tools/nook" . "$release/npm_bundlers"
	cp integrations/blender/nook_bake.py "$out"
	tested "nook_bake.py" "Blender on $system" sh tests/blender_test.sh "$release/tools/nook" .
fi
if built all aarch64 -DCMAKE_EXE_LINKER_FLAGS=-static; then
	packaging/portable.sh build/aarch64 "$out"
	tested "nook-*-linux-aarch64.tar.xz" "QEMU on $system" sh tests/targets_test.sh "$PWD/build/release/tools/nook" "$PWD" "$PWD/build" aarch64
fi
windows=windows
test=targets_test.sh
if [ -e build/windows-libraries ]; then # packaging/windows_libraries.sh
	windows=windows-levels
	test=windows_levels_test.sh
fi
if built all $windows; then
	(cd build/$windows && cpack -G ZIP -B "$out" >/dev/null)
	rm -rf "$out/_CPack_Packages"
	tested "nook-*-windows-x86_64.zip" "Wine on $system" sh tests/$test "$PWD/build/release/tools/nook" "$PWD" "$PWD/build" windows
fi
if built all wasm; then
	(cd build/wasm/npm && npm pack --pack-destination "$out" >/dev/null 2>&1)
	tested "nook-patterns-*.tgz" "Node.js on $system" sh tests/targets_test.sh "$PWD/build/release/tools/nook" "$PWD" "$PWD/build" wasm
fi
awk '/^## / { if (found++) exit } found' CHANGELOG.md >"$out/NOTES"
(cd "$out" && for file in *; do [ "$file" = TESTED ] || [ "$file" = NOTES ] || sha256sum "$file"; done >"$scratch/sums" && mv "$scratch/sums" SHA256SUMS)
cat "$out/TESTED"
! grep -q ': FAILED: ' "$out/TESTED" || exit 4
