#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Number of SPIR-V instructions of each emitted kernel after spirv-opt -O; recipe paper unless stated otherwise.
# usage: instructions.sh NOOK
set -eu
nook=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# tile DOMAIN COUNT
tile()
{
	"$nook" pattern --domain "$1" --count "$2" -o "$scratch/pattern.json"
	"$nook" tile --pattern "$scratch/pattern.json" --size 4 -o "$scratch/$1.json"
}

# count ENTRY TYPE OPTIONS of nook emit…
count()
{
	entry=$1
	type=$2
	shift 2
	case "$*" in
	*--recipe*) "$nook" emit "$@" --glsl vulkan -o "$scratch/module.glsl" ;;
	*) "$nook" emit "$@" --recipe paper --glsl vulkan -o "$scratch/module.glsl" ;;
	esac
	{
		echo "#version 450"
		cat "$scratch/module.glsl"
		echo "layout(location = 0) out $type colour;"
		echo "void main() { colour = $entry(ivec2(gl_FragCoord.xy)); }"
	} >"$scratch/whole.frag"
	glslangValidator -V -o "$scratch/whole.spv" "$scratch/whole.frag" >"$scratch/log" || { cat "$scratch/log" >&2; exit 1; }
	spirv-opt -O "$scratch/whole.spv" -o "$scratch/small.spv"
	total=$(spirv-dis "$scratch/small.spv" | sed '1,/OpFunction /d' | wc -l)
	echo "$total  $entry: $(echo "$*" | sed "s|$scratch/||g")"
}

tile disk 9
tile ball 12
tile hemisphere 9
lines="--patterns $scratch/disk.json"
# shellcheck disable=SC2086 # options, a word each
{
	count nookVoLine float --methods vo-line $lines
	count nookVoLine float --methods vo-line $lines --use-normal no
	count nookVoLine float --methods vo-line $lines --thick
	count nookVoLine float --methods vo-line $lines --combine product
	count nookVoLine float --methods vo-line $lines --depth device
	count nookVoLine float --methods vo-line $lines --recipe rays
	count nookVoPoint float --methods vo-point --patterns "$scratch/ball.json"
	count nookVoArea float --methods vo-area $lines
	count nookMoments vec4 --methods vo-area $lines
	count nookAlchemy float --methods alchemy --patterns "$scratch/hemisphere.json"
	count nookStatVo float --methods statvo
	count nookStatVo float --methods statvo --layers 1
	count nookStatCells uvec4 --methods statvo
	count nookTableSum uvec4 --methods statvo
	count nookVoLineLinked vec4 --methods vo-line $lines --filter bilateral
	count nookBilateralX vec4 --methods vo-line $lines --filter bilateral
	count nookBilateralY float --methods vo-line $lines --filter bilateral
	count nookWindow float --methods vo-line $lines --filter window
	count nookUpsample float --methods vo-line $lines --resolution half
}
