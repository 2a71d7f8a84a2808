#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Recomputes the tables of docs/measurements/patterns.md#behind-filters. Takes about two minutes.
# usage: filters.sh NOOK
set -eu
nook=$(realpath "$1")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$nook" pattern --domain disk --count 9 -o p.json
"$nook" tile --pattern p.json --size 4 -o window.json

# value FILE NAME OPTIONS...: a value from nook info.
value()
{
	file=$1
	name=$2
	shift 2
	"$nook" info "$file" "$@" --json - | sed -n "s/^\t\t\"$name\": \([^,]*\),*\$/\1/p" | head -n 1
}

pattern=$(value p.json plane_exact)

# row COLUMNS...: numbers with four digits.
row()
{
	printf '|'
	for column in "$@"; do
		case $column in
		0.*) awk "BEGIN { printf \" %.4f |\", $column }" ;;
		*) printf ' %s |' "$column" ;;
		esac
	done
	printf '\n'
}

ratio()
{
	awk "BEGIN { printf \"%.2f\", $1 / $2 }"
}

echo "| behind | made for its window | made for it | half of the taps cut off | made for it with --robust | a variant alone, × the pattern |"
echo "| --- | --- | --- | --- | --- | --- |"
for kernel in box:3 binomial:3 gauss:1 bilateral:5 box:4; do
	"$nook" tile --pattern p.json --size 4 --filter "$kernel" -o own.json
	"$nook" tile --pattern p.json --size 4 --filter "$kernel" --robust -o robust.json
	row "\`$kernel\`" "$(value window.json "$kernel" --filter "$kernel")" "$(value own.json "$kernel")" \
		"$(value window.json "$kernel, half" --filter "$kernel")" "$(value robust.json "$kernel, half")" \
		"$(ratio "$(value own.json variant_plane)" "$pattern")"
done
echo
echo "| frames | values | a pixel alone | panned | behind \`box:4\` | behind \`binomial:3\` | a variant alone, × the pattern |"
echo "| --- | --- | --- | --- | --- | --- | --- |"
# frames NAME VALUES FILE
frames()
{
	set -- "$1" "$2" "$3" --filter none --filter box:4 --filter binomial:3
	name=$1
	count=$2
	file=$3
	shift 3
	row "$name" "$count" "$(value "$file" 'none, frames' "$@")" "$(value "$file" 'none, frames, panned' "$@")" \
		"$(value "$file" 'box:4, frames' "$@")" "$(value "$file" 'binomial:3, frames' "$@")" \
		"$(ratio "$(value "$file" variant_plane)" "$pattern")"
}
# Independent variants: the square root of α / (2 - α) times the error of one.
row "any, drawn at random" "" "$(awk "BEGIN { print $(value window.json variant_plane) * sqrt(0.1 / 1.9) }")" "" "" "" ""
"$nook" tile --pattern p.json --size 4 --filter box:4 --frames 16 --moves -o moving.json
frames "16 moves of one tile" 576 moving.json
for count in 8 16; do
	"$nook" tile --pattern p.json --size 4 --filter box:4 --frames $count -o own.json
	frames "$count tiles" $((576 * count)) own.json
done
"$nook" tile --pattern p.json --size 4 --filter none --frames 16 --lambda 0.02 -o alone.json
frames "16 tiles, made with \`--filter none\`" 9216 alone.json
