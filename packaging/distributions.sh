#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Tries the portable bundle on Debian 11 and 13, each without any further package: twelve commands, which must write the bytes of NOOK,
# and what they take together. ROOT gets a folder for each (debootstrap), which is kept.
# usage: distributions.sh ROOT BUNDLE.tar.xz NOOK    exit code 77: no debootstrap, or not root
set -eu

[ $# -eq 3 ] || { echo "distributions.sh: found '$*', expected ROOT BUNDLE.tar.xz NOOK" >&2; exit 1; }
mkdir -p "$1"
root=$(realpath "$1")
bundle=$(realpath "$2")
nook=$(realpath "$3")
pictures=$(dirname "$(realpath "$0")")/../docs/pictures
command -v debootstrap >/dev/null && command -v oiiotool >/dev/null && [ "$(id -u)" -eq 0 ] ||
	{ echo "skipped: found no debootstrap, oiiotool or root, expected Debian's packages debootstrap and openimageio-tools"; exit 77; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/levels" "$work/here"
for mask in png jpg tga bmp exr; do
	oiiotool "$pictures/views.png" --resize 64x32 -d uint8 -o "$work/levels/mask.$mask"
	printf 'newmtl a\nmap_d mask.%s\n' $mask >"$work/levels/$mask.mtl"
	printf 'mtllib %s.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n' $mask >"$work/levels/$mask.obj"
done

# The commands of "$@", from $levels into $out.
commands()
{
	"$@" pattern --domain disk --count 9 -o "$out/disk.json"
	"$@" gbuffer builtin:suburb --size 64x36 -o "$out/view.exr"
	"$@" reference builtin:suburb --gbuffer "$out/view.exr" --radius 1 --rays 16 -o "$out/rays.exr"
	"$@" shade "$out/view.exr" --method slices --radius 1 -o "$out/slices.exr"
	"$@" volumes builtin:courtyard --distance 0.6 -o "$out/volumes.glb"
	for mask in png jpg tga bmp exr; do
		"$@" level "$levels/$mask.obj" -o "$out/$mask.glb"
	done
	"$@" bake builtin:cornell --radius 1 -o "$out/baked.glb"
	"$@" bake builtin:cornell --radius 1 --probes 1 -o "$out/probes.ktx2"
}
out=$work/here
levels=$work/levels
commands "$nook" >/dev/null

for name in bullseye trixie; do
	base=$root/$name
	if [ ! -e "$base" ]; then
		rm -rf "$base.part"
		debootstrap --variant=minbase $name "$base.part" >"$root/log" 2>&1 || { echo "debootstrap: $(tail -n 1 "$root/log")" >&2; exit 4; }
		mv "$base.part" "$base"
	fi
	rm -rf "$base/nook" && mkdir -p "$base/nook/out"
	mkdir "$base/nook/bundle"
	tar xf "$bundle" -C "$base/nook/bundle" --strip-components 1
	cp -r "$work/levels" "$base/nook/levels"
	out=/nook/out
	levels=/nook/levels
	begun=$(date +%s%N)
	commands chroot "$base" /nook/bundle/bin/nook >/dev/null
	took=$((($(date +%s%N) - begun) / 100000000))
	diff -r "$work/here" "$base/nook/out" || { echo "$name: other bytes" >&2; exit 4; }
	echo "$(. "$base/etc/os-release" && echo "$PRETTY_NAME"), $(chroot "$base" ldd --version | head -n 1): the same bytes, $((took / 10)).$((took % 10)) s"
done
