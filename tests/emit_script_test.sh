# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: emit_script_test.sh PROGRAM. nook emit -o FILE.js: its blocks and texels are those of the header, byte for byte, over a table
# of cameras and settings; what it refuses; its GLSL is that of the file. Exit code 77: no Node.js or compiler here.
set -u
nook=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
. "$here/table.sh"
for tool in node c++; do
	command -v $tool >/dev/null || { echo "skipped: found no $tool, expected Debian's packages nodejs and g++"; exit 77; }
done
cd "$folder"
echo '{ "type": "module" }' >package.json # of this folder's .js

"$nook" pattern --domain disk --count 5 --starts 1 -o disk.json || problem "pattern: not made"
"$nook" tile --pattern disk.json --size 4 --kind random -o tile.json
for kind in ball hemisphere; do
	"$nook" pattern --domain $kind --count 6 --starts 1 -o $kind.json
	"$nook" tile --pattern $kind.json --size 4 --kind random -o ${kind}_tile.json
done
for block in "mixed nook_block" "floats nook_float_block"; do
	checks=$((checks + 1))
	"$nook" emit --methods vo-line,vo-point,vo-area,alchemy,statvo,slices --patterns tile.json,ball_tile.json,tile.json,hemisphere_tile.json \
		--block ${block% *} --filter bilateral --glsl es300 -o m.glsl -o m.h -o m.js || problem "$block: not emitted"
	node "$here/emit_script_table.mjs" cpp ${block#* } >table.cpp
	c++ -std=c++17 -ffp-contract=off -Wall -Wextra -Wpedantic -Werror -o table table.cpp >log 2>&1 || problem "$block: $(head -n 5 log)"
	./table >of_header
	node "$here/emit_script_table.mjs" js >of_script 2>faults || problem "$block: $(head -n 5 faults)"
	same of_header of_script "$block: expected the header's bytes, found others from line $(cmp of_header of_script | sed 's/.*line //')"
	[ "$(grep -c refused of_script)" -ge 50 ] && [ "$(grep -c '^[0-9a-f]\{384\}$' of_script)" -ge 100 ] && [ "$(grep -c _tile of_script)" -eq 4 ] ||
		problem "$block: found $(grep -c refused of_script) refused of $(wc -l <of_script) lines, expected 50, 100 blocks and 4 tiles"
	printf 'import { writeFileSync } from "node:fs";\nimport { glsl } from "./m.js";\nwriteFileSync("said.glsl", glsl);\n' >glsl.mjs
	node glsl.mjs && same m.glsl said.glsl "$block: the GLSL in the module: expected that of the file"
done
# The check itself must be able to fail.
sed 's/^\tbeta: .*/\tbeta: 2e-4,/' m.js >other.js && mv other.js m.js
node "$here/emit_script_table.mjs" js >of_script
cmp -s of_header of_script && problem "another default: found the header's bytes, expected others"

# throws PATTERN PROJECTION SETTINGS
throws()
{
	checks=$((checks + 1))
	printf 'import { fill } from "./m.js";\ntry { fill(%s, %s); } catch (error) { console.log(`${error.name}: ${error.message}`); }\n' "$2" "$3" >throws.mjs
	node throws.mjs >said 2>&1
	grep -q -e "$1" said || problem "fill($2, $3): found '$(head -n 3 said)', expected '$1'"
}
throws '^TypeError: settings.Radius: found 2, expected one of width, height' 'Array(16).fill(1)' '{ Radius: 2 }'
throws '^TypeError: settings.toString: found 2, expected one of' 'Array(16).fill(1)' '{ toString: 2 }'
throws '^TypeError: settings.width: found 2.5, expected a whole number' 'Array(16).fill(1)' '{ width: 2.5 }'
throws '^TypeError: settings.width: found 640, expected a number' 'Array(16).fill(1)' '{ width: "640" }'
throws '^TypeError: settings.device_depth: found 1, expected a boolean' 'Array(16).fill(1)' '{ device_depth: 1 }'
throws '^TypeError: projection: found .*, expected 16 numbers' '[1, 2, 3]' '{}'
throws '^TypeError: projection: found .*, expected 16 numbers' 'Array(16).fill("1")' '{}'

# Names of files cannot end a comment or a template, and a module without GLSL has none.
cp tile.json '`${x} y`.json'
cp tile.json "$(printf 'a\342\200\250process.exit(3).json')"
for name in '`${x} y`.json' "$(printf 'a\342\200\250process.exit(3).json')"; do
	checks=$((checks + 1))
	"$nook" emit --methods vo-line --patterns "$name" --glsl 330 -o m.glsl -o m.js || problem "$name: not emitted"
	node glsl.mjs && cmp -s m.glsl said.glsl || [ "$name" != '`${x} y`.json' ] || problem "$name: found other GLSL in the module"
	node -e 'import("./m.js").then(module => { if (!module.fill) process.exit(1); })' || problem "$name: found no module"
done
checks=$((checks + 1))
"$nook" emit --methods vo-line --patterns tile.json -o m.js || problem "a module alone: not emitted"
grep -q 'export const glsl' m.js && problem "a module without --glsl: found GLSL, expected none"
finish
