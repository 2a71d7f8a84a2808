#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs missing packages for building and testing nook on Debian 12. Quick if nothing is missing.
# Usage: setup.sh [build] [aarch64] [windows] [wasm] [debian] [targets] [farm] [library] [ogre] [godot] [moderngl] [blender] [clang]. `build` leaves out what
# only the tests need, and also works on Debian 13: presets library and patterns. The next three add cross
# compilers and emulators for ARM64, Windows and the browser, `debian` adds packaging tools, `targets` all four; `farm` adds the
# engines that scripts/farm.sh starts, `library` the tools for the wheel and its figures, `ogre` and `godot` the engines of these
# examples, `moderngl` the Python package for a test, `blender` Blender for the test of its add-on, `clang` the second compiler with
# libFuzzer.
set -eu

packages="g++ cmake ninja-build make ccache git pkg-config
	libcgal-dev libboost-dev libeigen3-dev libopenimageio-dev libopenexr-dev libpng-dev libjpeg-dev zlib1g-dev libglm-dev libtbb-dev libcli11-dev nlohmann-json3-dev
	libmeshoptimizer-dev libdraco-dev libembree-dev libepoxy-dev"
tests="libglfw3-dev libegl-dev libegl-mesa0 libgl1-mesa-dri
	catch2 libbenchmark-dev libvulkan-dev mesa-vulkan-drivers glslang-tools spirv-tools spirv-cross openimageio-tools xz-utils locales qemu-user-static xvfb xauth chromium firefox-esr fonts-dejavu-core mkdocs python3-numpy mono-mcs mono-runtime abigail-tools"

# For Khronos' glTF validator in one test. Other Node.js builds include npm and conflict with Debian's.
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
	tests="$tests nodejs npm"
fi

# shellcheck disable=SC2046 # words
set -- $(printf '%s ' "$@" | sed 's/targets/aarch64 windows wasm debian/')
for target in "$@"; do
	case $target in
	build) tests= ;;
	aarch64) packages="$packages g++-aarch64-linux-gnu" ;;
	windows) packages="$packages g++-mingw-w64-x86-64-posix wine64 dpkg-dev" ;;
	wasm) packages="$packages emscripten node-typescript" ;;
	debian) packages="$packages lintian dpkg-dev fakeroot python3-numpy" ;;
	library) packages="$packages python3-matplotlib patchelf" ;;
	ogre) packages="$packages libogre-1.12-dev" ;;
	moderngl) packages="$packages python3-moderngl" ;;
	godot) packages="$packages godot3" ;;
	blender) packages="$packages blender" ;;
	clang) packages="$packages clang llvm libclang-rt-14-dev" ;;
	farm) packages="$packages slurm-wlm munge snakemake procps" ;;
	*)
		echo "setup.sh: found '$target', expected build, aarch64, windows, wasm, debian, targets, farm, library, ogre, godot, moderngl, blender, clang or nothing" >&2
		exit 1
		;;
	esac
done
packages="$packages $tests"

if ! command -v dpkg-query >/dev/null; then
	echo "setup.sh: found no dpkg-query, expected Debian 12 or packages equal to:" $packages >&2
	exit 1
fi

missing=
for package in $packages; do
	state=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
	if [ "$state" != installed ]; then
		missing="$missing $package"
	fi
done
if [ -z "$missing" ]; then
	exit 0
fi

as_root=
if [ "$(id -u)" -ne 0 ]; then
	if ! command -v sudo >/dev/null; then
		echo "setup.sh: not root and no sudo, expected one of them to install:$missing" >&2
		exit 1
	fi
	as_root="sudo"
fi
echo "setup.sh: installing$missing"
$as_root env DEBIAN_FRONTEND=noninteractive apt-get -q update
$as_root env DEBIAN_FRONTEND=noninteractive apt-get -q install --yes --no-install-recommends $missing
