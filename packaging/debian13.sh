#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds Debian's packages on Debian 13 and tries them there. ROOT gets three folders: base/ (debootstrap), build/ (with compilers and
# libraries; a clone of HEAD is built there, read by lintian and installed in an empty root: tests/debian_test.sh) and try/, where apt
# installs the packages with only what they depend on. There the program and the Python package must write the bytes of NOOK, a
# program of another system. Run it again at any time: base/ and build/ are kept.
# usage: debian13.sh ROOT OUT NOOK      e.g. debian13.sh build/debian13 packages build/release/tools/nook
set -eu

refuse()
{
	echo "debian13.sh: $2" >&2
	exit "$1"
}

# inside FOLDER COMMAND...: runs it with that folder as the root, and /proc in it for as long as it runs.
inside()
{
	folder=$root/$1
	shift
	unshare --mount sh -c 'mount -t proc proc "$1/proc" && exec chroot "$@"' sh "$folder" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
		LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive ${CMAKE_BUILD_PARALLEL_LEVEL:+CMAKE_BUILD_PARALLEL_LEVEL=$CMAKE_BUILD_PARALLEL_LEVEL} "$@"
}

# copied NAME: a new copy of base/, which appears whole.
copied()
{
	rm -rf "$root/$1.part" "${root:?}/$1"
	cp -a "$root/base" "$root/$1.part"
	mv "$root/$1.part" "$root/$1"
}

[ $# -eq 3 ] || refuse 1 "found '$*', expected ROOT OUT NOOK"
source=$(realpath "$(dirname "$(realpath "$0")")/..")
nook=$(realpath "$3")
[ -x "$nook" ] || refuse 2 "$3: found no program, expected one to compare with"
for tool in debootstrap unshare git; do
	command -v $tool >/dev/null || { echo "skipped: found no $tool, expected Debian's packages debootstrap, util-linux and git"; exit 77; }
done
[ "$(id -u)" -eq 0 ] && unshare --mount true || { echo "skipped: found no right to mount, expected root, for debootstrap and /proc"; exit 77; }
mkdir -p "$1" "$2"
root=$(realpath "$1")
out=$(realpath "$2")

if [ ! -e "$root/base" ]; then
	rm -rf "$root/base.part"
	debootstrap --variant=minbase trixie "$root/base.part" >"$root/log" 2>&1 || refuse 4 "debootstrap: $(tail -n 1 "$root/log")"
	mv "$root/base.part" "$root/base"
fi
[ -e "$root/build" ] || copied build
rm -rf "$root/build/nook"
git clone -q "file://$source" "$root/build/nook"
# Compilers other than Debian 12's warn of other things.
inside build sh -euc 'cd /nook
	scripts/setup.sh build debian
	cmake --preset library -DCMAKE_COMPILE_WARNING_AS_ERROR=OFF
	cmake --build --preset library
	sh tests/debian_test.sh build/library/tools/nook . "$PWD/build/library"
	(cd build/library && cpack -G DEB -B /nook/packages)' >"$root/log" 2>&1 ||
	refuse 4 "build: $(grep -m 1 'FAILED\|[Ee]rror:' "$root/log" || tail -n 1 "$root/log")"

copied try
mkdir "$root/try/trial" "$root/trial.part"
trap 'rm -rf "$root/trial.part"' EXIT
cp "$root"/build/nook/packages/*.deb "$root/try/trial/"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' | tee "$root/try/trial/level.obj" >"$root/trial.part/level.obj"
inside try sh -euc 'cd /trial
	apt-get -q update
	apt-get -q install --yes --no-install-recommends ./nook_*.deb ./libnook1_*.deb ./python3-nook_*.deb' >"$root/log" 2>&1 ||
	refuse 4 "installation: $(grep -m 1 '^E: ' "$root/log" || tail -n 1 "$root/log")"
while read -r file options; do
	(cd "$root/trial.part" && "$nook" $options -o "$file" >/dev/null) || refuse 4 "nook $options: failed with $nook"
	inside try sh -c 'cd /trial && exec nook "$@" >/dev/null' sh $options -o "$file" || refuse 4 "nook $options: failed on Debian 13"
	cmp "$root/trial.part/$file" "$root/try/trial/$file" || refuse 4 "nook $options: other bytes than those of $nook"
done <<-EOT
	disk.json pattern --domain disk --count 9
	view.exr gbuffer builtin:courtyard --size 64x36
	rays.exr reference builtin:courtyard --gbuffer view.exr --radius 1 --rays 64
	slices.exr shade view.exr --method slices --radius 1
	volumes.glb volumes builtin:courtyard --distance 0.6
	bake.glb bake builtin:courtyard --radius 1 --rays 16
	level.glb level level.obj
EOT
inside try python3 -c 'import nook
nook.pattern("disk", 9).save("/trial/python.json")
nook.Level.load("builtin:courtyard").bake(radius=1, rays=16, output=".glb").save("/trial/python.glb")'
cmp "$root/try/trial/python.json" "$root/trial.part/disk.json"
cmp "$root/try/trial/python.glb" "$root/trial.part/bake.glb"
cp "$root"/build/nook/packages/*.deb "$out/"
