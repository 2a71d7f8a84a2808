# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: ktx2_test.sh PROGRAM SOURCE FOLDER. KTX2 tiles and baked textures read by an independent reader: every float equals the tile's JSON. The
# reader is downloaded from npm's registry once into FOLDER. Exit code 77: npm or the registry is not available.
set -u
nook=$1
source=$2
cache=$3
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/npm_tools.sh"

npm_packages "$cache" ktx-parse@2.0.0
cp "$source"/tests/ktx_parse/*.js "$cache" || exit 1

# reads NAME SIZE WORDS: NAME.ktx2 is the texture of NAME.json, has that size, and describes its layout with those words.
reads()
{
	checks=$((checks + 1))
	(cd "$cache" && node read.js "$folder/$1.ktx2" "$folder/$1.json") >log 2>&1 || problem "$1: $(cat log)"
	grep -q "^$2, .*$3" log || problem "$1: found '$(cat log)', expected $2 and '$3'"
}

cd "$folder" || exit 1
"$nook" pattern --domain disk --count 3 --starts 1 -o disk.json || problem "disk"
"$nook" pattern --domain ball --count 4 --starts 1 -o ball.json || problem "ball"
"$nook" tile --pattern disk.json --size 2 --starts 1 -o still.json -o still.ktx2 || problem "still"
"$nook" tile --pattern ball.json --size 3 --starts 1 -o ball_tile.json -o ball_tile.ktx2 || problem "ball_tile"
"$nook" tile --pattern disk.json --size 4 --kind even -o even.json -o even.ktx2 || problem "even"
"$nook" tile --pattern disk.json --size 2 --filter none --frames 3 --starts 1 -o frames.json -o frames.ktx2 || problem "frames"
"$nook" tile --pattern disk.json --size 2 --filter none --frames 3 --moves --starts 1 -o moves.json -o moves.ktx2 || problem "moves"
reads still '4 x 3 x 1' 'column = variant = (y mod 2) \* 2 + x mod 2, row = sample'
reads ball_tile '9 x 4 x 1' 'RGBA = x,y,z,weight'
reads even '4 x 4 x 1' 'texel = (x mod 4, y mod 4)'
reads frames '4 x 3 x 3' '+ x mod 2, layer = frame mod 3, row = sample'
reads moves '4 x 3 x 1' 'moves 0,0 1,0 0,1'

# A texture in blocks, of a size that is no power of two.
printf 'v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nvt 0.1 0.1\nvt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9\nf 1/1 2/2 3/3 4/4\n' >floor.obj
"$nook" bake floor.obj --radius 1 --rays 4 --texture 90 -o floor.ktx2 --json s.json || problem "floor"
checks=$((checks + 1))
(cd "$cache" && node blocks.js "$folder/floor.ktx2" 90) >log 2>&1 || problem "floor: $(cat log)"

# Checks that the reader detects errors: another format, another weight.
for offset in 12 $(($(wc -c <still.ktx2) - 2)); do # offsets of VkFormat and of the last weight
	cp still.ktx2 wrong.ktx2
	cp still.json wrong.json
	printf '\001' | dd of=wrong.ktx2 bs=1 seek="$offset" conv=notrunc 2>dd.log || problem "dd: $(cat dd.log)"
	checks=$((checks + 1))
	(cd "$cache" && node read.js "$folder/wrong.ktx2" "$folder/wrong.json") >log 2>&1 && problem "byte $offset: a wrong file passed"
done
finish
