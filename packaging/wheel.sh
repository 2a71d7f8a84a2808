#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# packaging/wheel.sh INSTALLED OUT: the Python package with libnook, its workers and the libraries that they need as one wheel in the
# folder OUT. INSTALLED: where a build with -DNOOK_LIBRARY=ON was installed (cmake --install BUILD --prefix INSTALLED).
# OpenImageIO and its 250 libraries are not in it: nook_image_worker, which alone needs them, uses the system's, as in portable.sh.
# Needs patchelf, binutils and python3. The tag states the glibc whose symbols the files ask for.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
installed=$1
out=$2
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
version=$(sed -n 's/^project(nook VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
abi=$(sed -n 's/^#define NOOK_ABI \([0-9]*\)$/\1/p' "$source/include/nook/nook.h")
package=$work/nook
libs=$package/lib
licences=$package/licences
mkdir -p "$libs" "$licences"
cp "$source/python/nook/"*.py "$package"
library=$(find "$installed" -name "libnook.so.$abi" | head -n 1)
[ -n "$library" ] || { echo "wheel.sh: $installed: found no libnook.so.$abi, expected an installation with -DNOOK_LIBRARY=ON" >&2; exit 2; }
cp -L "$library" "$libs/libnook.so.$abi"
cp "$(dirname "$library")/nook/"nook_*_worker "$libs"

# Libraries that every Linux has stay outside, and so does libGL, which belongs to the machine's driver.
system='^(linux-vdso|ld-linux|libc|libm|libdl|libpthread|librt|libresolv|libutil|libgcc_s|libstdc\+\+|libGL|libEGL|libOpenGL|libGLX|libGLdispatch|libX11|libxcb)[.-]'
for file in "$libs"/*; do
	[ "${file##*/}" = nook_image_worker ] || ldd "$file" | sed -n 's/^\t\(.*\) => \(\/.*\) (0x.*/\1 \2/p'
done | sort -u | while read -r name path; do
	if printf '%s\n' "$name" | grep -Eq "$system" || [ -e "$libs/$name" ]; then
		continue
	fi
	cp -L "$path" "$libs/$name"
	real=$(readlink -f "$path")
	debian=$(dpkg-query -S "$real" 2>/dev/null || dpkg-query -S "${real#/usr}" 2>/dev/null) || # a package may name the file without /usr
		{ echo "wheel.sh: $path: found no Debian package that it is from, expected one, for its licence" >&2; exit 4; }
	cp "/usr/share/doc/${debian%%:*}/copyright" "$licences/$name.txt"
done
for file in "$libs"/*; do
	strip --strip-unneeded "$file"
	case $file in
	*/nook_image_worker) patchelf --remove-rpath "$file" ;;
	*) patchelf --set-rpath '$ORIGIN' "$file" ;;
	esac
done

# The newest glibc symbol decides; libstdc++ and libgcc_s are the system's.
newest=$(for file in "$libs"/*; do objdump -T "$file" | sed -n 's/.*(\{0,1\}GLIBC_2\.\([0-9]*\).*/\1/p'; done | sort -n | tail -n 1)
tag=py3-none-manylinux_2_${newest}_$(uname -m)
info=$work/nook-$version.dist-info
mkdir -p "$info"
cp "$source/LICENSE" "$info"
printf 'Metadata-Version: 2.1\nName: nook\nVersion: %s\nSummary: Ambient obscurance: patterns, bakes, occlusion volumes, reference visibility\nLicense: GPL-3.0-or-later\nRequires-Python: >=3.9\nRequires-Dist: numpy\n' "$version" >"$info/METADATA"
printf 'Wheel-Version: 1.0\nGenerator: packaging/wheel.sh\nRoot-Is-Purelib: false\nTag: %s\n' "$tag" >"$info/WHEEL"
python3 - "$work" "$out/nook-$version-$tag.whl" "nook-$version.dist-info" <<'P'
import base64, hashlib, os, sys, zipfile

work, wheel, info = sys.argv[1:]
files = sorted(os.path.relpath(os.path.join(folder, name), work) for folder, _, names in os.walk(work) for name in names)
record = []
with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
    def add(name, data, mode):
        entry = zipfile.ZipInfo(name)
        entry.external_attr = mode << 16
        entry.compress_type = zipfile.ZIP_DEFLATED
        archive.writestr(entry, data)
    for name in files:
        path = os.path.join(work, name)
        data = open(path, "rb").read()
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record.append(f"{name},sha256={digest},{len(data)}")
        add(name, data, os.stat(path).st_mode & 0o100777 | 0o644)
    record.append(f"{info}/RECORD,,")
    add(f"{info}/RECORD", "\n".join(record) + "\n", 0o100644)
P
ls -l "$out/nook-$version-$tag.whl"
