#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The table of docs/reference/recipes.md: RMSE against rays, one line per method and one column per level.
# usage: recipes.sh NOOK [--size WxH] [--rows WORDS] LEVEL,REACH...
#   REACH: ray length in metres. --rows: a regular expression that selects rows by name
set -eu
nook=$(realpath "${1:?nook, expected the program}")
shift
size=480x270
rows=.
while [ "${1#--}" != "$1" ]; do
	case $1 in
	--size) size=$2 ;;
	--rows) rows=$2 ;;
	*)
		echo "recipes.sh: found $1, expected --size or --rows" >&2
		exit 1
		;;
	esac
	shift 2
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
i=0
for level in "$@"; do
	i=$((i + 1))
	"$nook" gbuffer "${level%,*}" --camera auto:1 --size "$size" -o "$scratch/g$i.exr" >/dev/null
	"$nook" reference "${level%,*}" --gbuffer "$scratch/g$i.exr" --falloff linear --radius "${level##*,}" --rays 256 -o "$scratch/r$i.exr" >/dev/null
done
for count in 2 3 5 9; do
	"$nook" pattern --domain disk --count $count -o "$scratch/p$count.json" >/dev/null
	"$nook" tile --pattern "$scratch/p$count.json" --size 4 -o "$scratch/t$count.json" >/dev/null
done

# row NAME DEPTHS OPTIONS...
row()
{
	echo "$1" | grep -Eq -e "$rows" || return 0
	line="| $1 | $2"
	shift 2
	i=0
	for level in $levels; do
		i=$((i + 1))
		"$nook" shade "$scratch/g$i.exr" --radius "${level##*,}" --filter bilateral "$@" -o "$scratch/v.exr" >/dev/null
		line="$line | $("$nook" compare "$scratch/v.exr" "$scratch/r$i.exr" --mask "$scratch/g$i.exr" | sed -n 's/^rmse *\([0-9.]*\).*/\1/p' | cut -c 1-6)"
	done
	echo "$line |"
}
levels=$*
row '`vo-line` 9, paper' 9 --method vo-line --recipe paper --pattern "$scratch/t9.json"
row '`hbao` 6 × 6, paper' 36 --method hbao --recipe paper
row '`hbao` 6 × 6, bias 10°' 36 --method hbao --recipe paper --hbao-angle-bias 10
row '`hbao` 6 × 6, rays' 36 --method hbao
row '`gtao` 3 × 6, paper' 36 --method gtao --recipe paper
row '`gtao` 3 × 6, rays' 36 --method gtao
row '`gtao` 1 × 4, rays' 8 --method gtao --gtao-slices 1 --gtao-steps 4
row '`bitmask` 3 × 6, paper' 36 --method bitmask --recipe paper
row '`bitmask` 3 × 6, rays' 36 --method bitmask
row '`bitmask` 1 × 4, rays' 8 --method bitmask --bitmask-slices 1 --bitmask-steps 4
row '`alchemy` 9, rays' 9 --method alchemy
row '`slices` 1 × 4, rays' 8 --method slices
row '`slices` 3 × 6, rays' 36 --method slices --slices 3 --slice-steps 6
row '`slices` 2 × 9, rays' 36 --method slices --slices 2 --slice-steps 9
row '`vo-line` 3 × 2, rays' 6 --method vo-line --pattern "$scratch/t2.json"
row '`vo-line` 3 × 3, rays' 9 --method vo-line --pattern "$scratch/t3.json"
row '`vo-line` 3 × 5, rays' 15 --method vo-line --pattern "$scratch/t5.json"
