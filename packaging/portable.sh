#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes nook-VERSION-linux-ARCH.tar.xz of a build folder: the program, its workers and their libraries, for any Linux with the kernel of
# glibc 2.31 or newer. OpenImageIO is not in it: nook_image_worker uses the system's. A program that is linked statically, as of the
# component patterns for ARM64, needs no libraries.
# usage: portable.sh BUILD FOLDER           writes the archive there
#        portable.sh --folder BUILD FOLDER  fills FOLDER instead, for scripts that add to it
set -eu

refuse()
{
	echo "portable.sh: $2" >&2
	exit "$1"
}

# libraries FILE...: paths of the libraries that they load.
libraries()
{
	ldd "$@" | sed -n 's/^\t[^ ]* => \(\/[^ ]*\) .*/\1/p' | sort -u
}

# latest PREFIX FILE...: the latest version of those symbols that the files need.
latest()
{
	prefix=$1
	shift
	objdump -T "$@" | grep '\*UND\*' | grep -o "($prefix[0-9.]*)" | tr -d '()' | sort -uV | tail -n 1
}

# licence FILE: copies the licence of the Debian package that holds it.
licence()
{
	real=$(realpath "$1") # below /usr, also where its package says /lib
	package=$(dpkg -S "$real" "${real#/usr}" 2>/dev/null | cut -d : -f 1 | head -n 1)
	[ -n "$package" ] || refuse 3 "$1: found no Debian package that holds it, expected a library of the system"
	[ -e "$doc/libraries/$package" ] || cp -L "/usr/share/doc/$package/copyright" "$doc/libraries/$package"
	echo "$package $(dpkg-query -W -f '${Version} (source: ${source:Package} ${source:Version})' "$package:$(dpkg --print-architecture)")" >>"$doc/list"
}

# addLibraries: of the programs in libexec/, with a launcher under the name of each.
addLibraries()
{
	mkdir -p "$root/lib/gcc" "$root/lib/glibc" "$doc/libraries"
	for library in $(libraries "$root"/libexec/*); do
		case ${library##*/} in
		libc.so.* | libm.so.* | libdl.so.* | libpthread.so.* | librt.so.*) cp -L "$library" "$root/lib/glibc/" ;;
		libstdc++.so.* | libgcc_s.so.*) cp -L "$library" "$root/lib/gcc/" ;;
		*) cp -L "$library" "$root/lib/" ;;
		esac
		licence "$library"
	done
	cp -L /lib64/ld-linux-x86-64.so.2 "$root/lib/glibc/"
	chmod u+w "$root"/lib/*.so* "$root"/lib/*/*.so*
	strip --strip-unneeded "$root"/lib/*.so* "$root"/lib/gcc/*
	sort -u "$doc/list" >"$doc/libraries/versions"
	rm "$doc/list"
	glibc=$(latest GLIBC_ "$root"/libexec/* "$root"/lib/*.so* "$root"/lib/gcc/*)
	glibcxx=$(latest GLIBCXX_ "$root"/libexec/* "$root"/lib/*.so*)
	${CC:-cc} -std=c11 -O2 -Wall -Wextra -Werror -static -s -DNOOK_GLIBC="\"$glibc\"" -DNOOK_GLIBCXX="\"$glibcxx\"" \
		-o "$root/bin/nook" "$here/launcher.c"
	for program in "$root"/libexec/nook_*; do
		ln -s ../../bin/nook "$root/lib/nook/${program##*/}"
	done
	cat >"$doc/README" <<-EOT
		nook $version for Linux on x86-64. bin/nook runs from any folder; nothing has to be installed.

		bin/nook is a launcher, which starts libexec/nook with the libraries in lib/. lib/glibc/ is used where the system's glibc lacks
		$glibc, lib/gcc/ where its libstdc++ lacks $glibcxx. The libraries are Debian's, without their symbols: libraries/versions names their
		packages and sources (https://snapshot.debian.org), libraries/PACKAGE has the licence of each. A library may be replaced by
		another build of the same version.

		nook_image_worker alone uses the system's own libraries: it reads pictures other than PNG, JPEG, TGA, BMP, EXR and KTX2 where
		libOpenImageIO.so.2.4 is installed.
	EOT
}

fill()
{
	mkdir -p "$root"
	cmake --install "$build" --prefix "$root" --strip >/dev/null
	version=$("$build/tools/nook" --version 2>/dev/null | sed -n 's/^nook //p') || true
	doc=$root/share/doc/nook
	mkdir -p "$doc"
	cp "$here/../LICENSE" "$here/../LICENSES/MIT.txt" "$doc/"
	rm -rf "$root"/share/doc/libnook* "$root/share/doc/python3-nook" "$root/share/lintian" "$root"/share/doc/nook/changelog* \
		"$root/share/doc/nook/copyright"
	if readelf -l "$root/bin/nook" | grep -q INTERP; then
		readelf -h "$root/bin/nook" | grep -q X86-64 || refuse 5 "$build: found shared libraries, expected a static program except on x86-64"
		mkdir "$root/libexec"
		mv "$root/bin/nook" "$root/libexec/"
		for worker in "$root"/lib/nook/nook_*_worker; do
			[ "${worker##*/}" = nook_image_worker ] || mv "$worker" "$root/libexec/"
		done
		addLibraries
	fi
}

here=$(dirname "$(realpath "$0")")
whole=
[ "${1:-}" != --folder ] || { whole=--folder; shift; }
[ $# -eq 2 ] || refuse 1 "found '$*', expected [--folder] BUILD FOLDER"
[ -e "$1/cmake_install.cmake" ] || refuse 2 "$1: found no build, expected a folder of cmake --build"
build=$(realpath "$1")
mkdir -p "$2"
if [ -n "$whole" ]; then
	root=$(realpath "$2")
	fill
	exit
fi
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
arch=$(readelf -h "$build/tools/nook" | sed -n 's/.*Machine: *//p')
case $arch in
*X86-64) arch=x86_64 ;;
AArch64) arch=aarch64 ;;
*) refuse 5 "$build/tools/nook: found a program for $arch, expected x86-64 or AArch64" ;;
esac
name=nook-$version-linux-$arch
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
root=$scratch/$name
fill
tar -C "$scratch" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@${SOURCE_DATE_EPOCH:-$(git -C "$here" log -1 --format=%ct 2>/dev/null || echo 0)}" -cf - "$name" |
	xz -9 -T0 >"$scratch/archive"
mv "$scratch/archive" "$2/$name.tar.xz"
echo "$2/$name.tar.xz: $(wc -c <"$2/$name.tar.xz") bytes"
