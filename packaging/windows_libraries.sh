#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Cross-compiles the libraries of the component levels for Windows from Debian's sources: static, by MinGW, into FOLDER, with the licence
# of each. Takes eleven minutes of processor time. A library whose version is there already is not built again.
# usage: windows_libraries.sh FOLDER    e.g. build/windows-libraries, where the preset windows-levels looks
set -eu

[ $# -eq 1 ] || { echo "windows_libraries.sh: found '$*', expected FOLDER" >&2; exit 1; }
mkdir -p "$1"
folder=$(realpath "$1")
toolchain=$(dirname "$(realpath "$0")")/../cmake/toolchains/windows.cmake
scratch=$folder/scratch
mkdir -p "$scratch/apt/lists/partial" "$scratch/apt/cache/archives/partial" "$scratch/sources"
cd "$scratch"

# The system's package sources, with lists of their own: nothing of the system changes.
cat /etc/apt/sources.list.d/*.sources 2>/dev/null | sed 's/^Types:.*/Types: deb deb-src/' >sources/all.sources
cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list 2>/dev/null | sed -n 's/^deb \(.*debian\.org.*\)/deb \1\ndeb-src \1/p' >sources/all.list
cat >apt.conf <<-EOT
	Dir::Etc::SourceList "/dev/null";
	Dir::Etc::SourceParts "$scratch/sources";
	Dir::State::Lists "$scratch/apt/lists";
	Dir::Cache "$scratch/apt/cache";
	APT::Sandbox::User "$(id -un)";
	APT::Get::Only-Source "true";
EOT
export APT_CONFIG="$scratch/apt.conf"
apt-get -q update >/dev/null

# sources PACKAGE: unpacks the newest version that the mirror has completely into source/ and says which in $version. A mirror of the
# security updates may lack a version that its list names.
sources()
{
	for full in $(apt-cache showsrc --only-source "$1" | sed -n 's/^Version: //p' | sort -Vru); do
		version=${full#*:}
		[ ! -e "$folder/licences/${1}_$version" ] || return 0
		rm -rf source build "$1"_*
		if { apt-get -q source --download-only "$1=$full" && dpkg-source --no-check -x "$1"_*.dsc source; } >log 2>&1; then
			return 0
		fi
	done
	# Upstream's own sources, of which Embree needs no changes here.
	mkdir source
	tar -C source --strip-components=1 -xf "$1"_*.orig.tar.*z
	version=${version%-*}
	echo "windows_libraries.sh: $1: found no version with Debian's changes, expected one; upstream's $version is built" >&2
}

# library PACKAGE OPTIONS...: the source package, by CMake.
library()
{
	package=$1
	shift
	sources "$package"
	licence=$folder/licences/${package}_$version
	[ ! -e "$licence" ] || return 0
	echo "$package $version"
	rm -rf "$folder/licences/$package"_*
	if [ "$package" = embree ]; then # takes g++ for Microsoft's compiler, and installs a target that oneTBB's own package lacks
		sed -i 's/INCLUDE (msvc)/INCLUDE (gnu)/' source/CMakeLists.txt
		sed -i '/embree.rc\|curve_intersector_virtual\|bvh_builder_hair/d' source/kernels/CMakeLists.txt # resources, and curves, which are off
		sed -i 's/-D_FORTIFY_SOURCE=2//' source/common/cmake/gnu.cmake
		: >source/common/cmake/installTBB.cmake
		: >source/readme.pdf # which Debian leaves out
	fi
	cmake -S source -B build -G Ninja -DCMAKE_TOOLCHAIN_FILE="$toolchain" -DNOOK_WINDOWS_LIBRARIES="$folder" -DCMAKE_BUILD_TYPE=Release \
		-DCMAKE_INSTALL_PREFIX="$folder" -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF "$@" >log 2>&1 &&
		ninja -C build ${NOOK_JOBS:+-j$NOOK_JOBS} install >log 2>&1 || { tail -n 30 log >&2; exit 4; }
	mkdir -p "$folder/licences"
	cat source/debian/copyright source/LICENSE.txt >"$licence" 2>/dev/null || true
}

if [ ! -e "$folder/lib/libz.a" ]; then # without the import library of a DLL, which CMake would take
	apt-get -q download libz-mingw-w64-dev >log 2>&1
	dpkg -x libz-mingw-w64-dev_*.deb zlib
	mkdir -p "$folder/lib" "$folder/include" "$folder/licences"
	cp zlib/usr/x86_64-w64-mingw32/lib/libz.a "$folder/lib/"
	cp zlib/usr/x86_64-w64-mingw32/include/z*.h "$folder/include/"
	cp zlib/usr/share/doc/libz-mingw-w64-dev/copyright "$folder/licences/zlib"
fi
library onetbb -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON
grep -q Threads "$folder/lib/cmake/TBB/TBBConfig.cmake" || sed -i '1i find_package(Threads REQUIRED)' "$folder/lib/cmake/TBB/TBBConfig.cmake"
library meshoptimizer
library libpng1.6 -DPNG_SHARED=OFF -DPNG_TESTS=OFF
# g++ does not align a function's stack to 32 bytes on Windows (GCC bug 54412), as AVX's moves expect: the assembler makes them unaligned.
library embree -DEMBREE_STATIC_LIB=ON -DEMBREE_TUTORIALS=OFF -DEMBREE_ISPC_SUPPORT=OFF -DEMBREE_GEOMETRY_QUAD=OFF -DEMBREE_GEOMETRY_CURVE=OFF \
	-DEMBREE_GEOMETRY_SUBDIVISION=OFF -DEMBREE_GEOMETRY_INSTANCE=OFF -DEMBREE_GEOMETRY_GRID=OFF -DEMBREE_GEOMETRY_POINT=OFF \
	-DEMBREE_ISA_SSE42=OFF -DEMBREE_ISA_AVX=OFF -DEMBREE_ISA_AVX2=OFF -DEMBREE_ISA_AVX512=OFF
library libjpeg-turbo -DENABLE_SHARED=OFF -DWITH_SIMD=OFF -DWITH_TURBOJPEG=OFF
library imath
library openexr -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF -DOPENEXR_INSTALL_TOOLS=OFF
rm -rf "$scratch"
