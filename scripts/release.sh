#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds every artefact of a release into a folder, with SHA256SUMS, TESTED (where each was tried by this script, or why not) and NOTES
# (the first section of CHANGELOG.md). A preset whose compiler is missing is left out, with a line in TESTED. Exit code 4: a test
# failed, or the library was not built.
# usage: release.sh FOLDER    packages for Debian 13 are built in $NOOK_DEBIAN13, by default build/debian13 (packaging/debian13.sh); the
# bundle is tried in systems in $NOOK_DISTRIBUTIONS, by default build/distributions (packaging/distributions.sh)
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

# atMost MEGABYTES FILE
atMost()
{
	[ "$(wc -c <"$2")" -le $(($1 * 1000000)) ] || echo "${2##*/}: FAILED: $(wc -c <"$2") bytes, expected $1 MB or less" >>"$out/TESTED"
}

system=$(. /etc/os-release && echo "$PRETTY_NAME")
release=$PWD/build/library # the code of the preset release, without its tests
if built all library; then
	packaging/portable.sh build/library "$out"
	atMost 25 "$out"/nook-*-linux-x86_64.tar.xz
	tested "nook-*-linux-x86_64.tar.xz" "an empty root on $system" sh tests/portable_test.sh "$release/tools/nook" . "$out"/nook-*-linux-x86_64.tar.xz
	tested "nook-*-linux-x86_64.tar.xz" "Debian 11 and 13, debootstrapped" packaging/distributions.sh "${NOOK_DISTRIBUTIONS:-build/distributions}" \
		"$out"/nook-*-linux-x86_64.tar.xz "$release/tools/nook"
	(cd "$release" && cpack -G DEB -B "$out" >/dev/null)
	rm -rf "$out/_CPack_Packages"
	tested "*.deb" "lintian and an empty root on $system" sh tests/debian_test.sh "$release/tools/nook" . "$release" "$out"
	mkdir "$out/debian13"
	tested "debian13/*.deb" "lintian, an empty root and apt on Debian 13" packaging/debian13.sh "${NOOK_DEBIAN13:-build/debian13}" "$out/debian13" \
		"$release/tools/nook"
	rmdir "$out/debian13" 2>/dev/null || true # skipped
	tested "libnook1_*.deb, libnook-dev_*.deb" "C, C++ and C# on $system" sh tests/library_test.sh "$release/tools/nook" . "$release"
	cmake --install "$release" --prefix "$scratch/installed" >/dev/null
	packaging/wheel.sh "$scratch/installed" "$out"
	atMost 25 "$out"/nook-*.whl
	python3 -m zipfile -e "$out"/nook-*.whl "$scratch/wheel/python"
	chmod +x "$scratch"/wheel/python/nook/lib/nook_*_worker # as pip does
	tested "nook-*.whl" "Python on $system" /usr/bin/python3 tests/python_test.py "$release/tools/nook" "$scratch/wheel" "$scratch/wheel/python/nook/lib/libnook.so.1"
	sh npm/ao/pack.sh "$release/tools/nook" "$scratch/ao" && (cd "$scratch/ao" && npm pack --pack-destination "$out" >/dev/null 2>&1)
	tested "nook-ao-*.tgz" "packed again, Chromium on $system" sh tests/npm_ao_test.sh "$release/tools/nook" . "$release/npm_bundlers"
	cp integrations/blender/nook_bake.py "$out"
	tested "nook_bake.py" "Blender on $system" sh tests/blender_test.sh "$release/tools/nook" .
fi
if built all aarch64 -DCMAKE_EXE_LINKER_FLAGS=-static; then
	packaging/portable.sh build/aarch64 "$out"
	tested "nook-*-linux-aarch64.tar.xz" "its program by QEMU on $system" sh tests/targets_test.sh "$release/tools/nook" "$PWD" "$PWD/build" aarch64
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
	atMost 30 "$out"/nook-*-windows-x86_64.zip
	tested "nook-*-windows-x86_64.zip" "Wine on $system" sh tests/$test "$release/tools/nook" "$PWD" "$PWD/build" windows
fi
if built all wasm; then
	(cd build/wasm/npm && npm pack --pack-destination "$out" >/dev/null 2>&1)
	tested "nook-patterns-*.tgz" "its program by Node.js on $system" sh tests/targets_test.sh "$release/tools/nook" "$PWD" "$PWD/build" wasm
fi
awk '/^## / { if (found++) exit } found' CHANGELOG.md >"$out/NOTES"
(cd "$out" && find . -type f ! -name TESTED ! -name NOTES -printf '%P\n' | sort | xargs -d '\n' sha256sum >"$scratch/sums" && mv "$scratch/sums" SHA256SUMS)
cat "$out/TESTED"
! grep -qE ': FAILED: |^library: not built' "$out/TESTED" || exit 4
