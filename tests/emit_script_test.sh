# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: emit_script_test.sh PROGRAM. nook emit -o FILE.js, .py and .cs: blocks and texels equal the header's, byte for byte, over a
# table of cameras and settings; errors; -o FILE.json has the same offsets and texels; the script's GLSL equals the file's. Exit code 77:
# no Node.js or compiler. C# needs Debian's mono-mcs.
set -u
nook=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
. "$here/table.sh"
for tool in node c++; do
	command -v $tool >/dev/null || { echo "skipped: found no $tool, expected Debian's packages nodejs and g++"; exit 77; }
done
cd "$folder"
echo '{ "type": "module" }' >package.json # for this folder's .js files

"$nook" pattern --domain disk --count 5 --starts 1 -o disk.json || problem "pattern: not made"
"$nook" tile --pattern disk.json --size 4 --kind random -o tile.json
for kind in ball hemisphere; do
	"$nook" pattern --domain $kind --count 6 --starts 1 -o $kind.json
	"$nook" tile --pattern $kind.json --size 4 --kind random -o ${kind}_tile.json
done
for block in "mixed nook_block" "floats nook_float_block"; do
	"$nook" emit --methods vo-line,vo-point,vo-area,alchemy,statvo,slices --patterns tile.json,ball_tile.json,tile.json,hemisphere_tile.json \
		--block ${block% *} --filter bilateral --glsl es300 -o m.glsl -o m.h -o m.js -o m.py -o m.cs -o m.json || problem "$block: not emitted"
	node "$here/emit_script_table.mjs" cpp ${block#* } >table.cpp
	c++ -std=c++17 -ffp-contract=off -Wall -Wextra -Wpedantic -Werror -o table table.cpp >log 2>&1 || problem "$block: $(head -n 5 log)"
	./table >of_header
	node "$here/emit_script_table.mjs" js >of_script 2>faults || problem "$block: $(head -n 5 faults)"
	same of_header of_script "$block: expected the header's bytes, found others from line $(cmp of_header of_script | sed 's/.*line //')"
	node "$here/emit_script_table.mjs" py >table.py
	python3 table.py >of_python 2>faults || problem "$block: $(tail -n 5 faults)"
	same of_header of_python "$block: Python: expected the header's bytes, found others from line $(cmp of_header of_python | sed 's/.*line //')"
	if command -v mcs >/dev/null && command -v mono >/dev/null; then
		node "$here/emit_script_table.mjs" cs >table.cs
		mcs -warnaserror -out:table.exe table.cs m.cs >log 2>&1 && mono table.exe >of_sharp 2>faults || problem "$block: $(head -n 5 log faults)"
		same of_header of_sharp "$block: C#: expected the header's bytes, found others from line $(cmp of_header of_sharp | sed 's/.*line //')"
	fi
	printf 'import { readFileSync } from "node:fs";\nimport * as script from "./m.js";\nconst json = JSON.parse(readFileSync("m.json"));\n%s\n%s\n%s\n%s\n' \
		'const same = (a, b) => JSON.stringify(a) === JSON.stringify(b) || (console.log(a, b), process.exit(1));' \
		'same(json.block.members.map(({ name, type, offset }) => ({ name, type, offset })), script.members);' \
		'same(json.methods.filter(one => one.tile).map(one => json.block.bytes + one.tile.texels.map(Math.fround).join()), ["voLine", "voPoint", "voArea", "alchemy"].map(name => script.blockBytes + script[name].tile.texels.join()));' \
		'same(json.methods.map(one => Object.entries(one.settings).map(([name, value]) => [name, value.times_reach * 2 || value])), ["voLine", "voPoint", "voArea", "alchemy", "statVo", "slices"].map(name => Object.entries(script[name].settings(2))));' >json.mjs
	node json.mjs >faults || problem "$block: m.json: $(head -c 500 faults)"
	for reason in 'looks left-handed: w = +z' 'looks left-handed: near and far' 'looks row-major: transpose it' 'found infinity or NaN' 'found a skew' \
		'found 0 for the scale' 'found a z that depends on x or y' 'settings: radius:' 'settings: largest_pixels:'; do
		grep -q "^refused: .*$reason" of_script || problem "$block: found no '$reason' among $(grep refused of_script | sort | uniq -c)"
	done
	[ "$(grep -c refused of_script)" -ge 50 ] && [ "$(grep -c '^[0-9a-f]\{384\}$' of_script)" -ge 100 ] && [ "$(grep -c _tile of_script)" -eq 4 ] ||
		problem "$block: found $(grep -c refused of_script) refused of $(wc -l <of_script) lines, expected 50, 100 blocks and 4 tiles"
	printf 'import { writeFileSync } from "node:fs";\nimport { glsl } from "./m.js";\nwriteFileSync("said.glsl", glsl);\n' >glsl.mjs
	node glsl.mjs && same m.glsl said.glsl "$block: the GLSL in the module: expected that of the file"
done
# Checks that the test itself can fail.
sed 's/^\tbeta: .*/\tbeta: 2e-4,/' m.js >other.js && mv other.js m.js
node "$here/emit_script_table.mjs" js >of_script
cmp -s of_header of_script && problem "another default: found the header's bytes, expected others"

# throws PATTERN PROJECTION SETTINGS
throws()
{
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
throws '^RangeError: projection: looks left-handed: w = +z' '[1,0,0,0, 0,1,0,0, 0,0,1,1, 0,0,-0.1,0]' '{ width: 9, height: 9 }'
throws '^RangeError: projection: looks row-major: transpose it' '[1,0,0,0, 0,1,0,0, 0,0,-1,-0.1, 0,0,-1,0]' '{ width: 9, height: 9 }'
throws '^RangeError: projection: found infinity or NaN' 'Array(16).fill(NaN)' '{ width: 9, height: 9 }'
throws '^RangeError: settings: width, height: expected 1 or more' '[1,0,0,0, 0,1,0,0, 0,0,-1,-1, 0,0,-0.1,0]' '{}'
throws '^RangeError: settings: x, y: expected -16777216 to 16777216' '[1,0,0,0, 0,1,0,0, 0,0,-1,-1, 0,0,-0.1,0]' '{ width: 9, height: 9, y: 2147483647 }'

# Modules of device depth preset it: in their own settings, and in JavaScript also in the defaults.
for target in "es300 false" "vulkan true"; do
	"$nook" emit --methods vo-line --patterns tile.json --depth device --glsl ${target% *} -o m.glsl -o m.h -o m.js || problem "$target: not emitted"
	printf '#include "m.h"\n#include <cstdio>\nint main()\n{\n\tconst double p[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.002, -1, 0, 0, -0.2, 0};\n\tnook_settings s = nook_vo_line_settings(1.5);\n\ts.width = s.height = 9;\n\tnook_block b{};\n\tif (nook_fill(b, p, s))\n\t\treturn 1;\n\tstd::printf("%%d %%.9g %%.9g %%.9g %%.9g\\n", s.zero_to_one, b.depth[0], b.depth[1], b.depth[2], b.depth[3]);\n}\n' >device.cpp
	c++ -std=c++17 -o device device.cpp && ./device >of_header || problem "$target: no block"
	printf 'import { fill, voLine } from "./m.js";\nconst p = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.002, -1, 0, 0, -0.2, 0];\nfor (const settings of [voLine.settings(1.5), {}])\n\tconsole.log(...new Float32Array(fill(p, { ...settings, width: 9, height: 9 })).subarray(16, 20));\n' >device.mjs
	node device.mjs >of_script || problem "$target: no block in JavaScript"
	node -e 'const read = name => require("fs").readFileSync(name, "utf8").trim().split(/\s+/).map(Number);
		const [header, script] = [read("of_header"), read("of_script")];
		const same = [0, 1, 2, 3, 4, 5, 6, 7].every(i => Math.abs(script[i] - header[1 + i % 4]) <= 1e-6 * Math.abs(script[i]));
		if (!same || header[0] !== Number(process.argv[1] === "true") || !(script[0] > 0)) { console.log(header, script); process.exit(1); }' "${target#* }" ||
		problem "$target: found other terms of depth in the header than in the script, or none"
done

# File names cannot end a comment or a template, and a module without GLSL exports none.
cp tile.json '`${x} y`.json'
cp tile.json "$(printf 'a\342\200\250process.exit(3).json')"
for name in '`${x} y`.json' "$(printf 'a\342\200\250process.exit(3).json')"; do
	"$nook" emit --methods vo-line --patterns "$name" --glsl 330 -o m.glsl -o m.js || problem "$name: not emitted"
	node glsl.mjs && cmp -s m.glsl said.glsl || [ "$name" != '`${x} y`.json' ] || problem "$name: found other GLSL in the module"
	node -e 'import("./m.js").then(module => { if (!module.fill) process.exit(1); })' || problem "$name: found no module"
done
"$nook" emit --methods vo-line --patterns tile.json -o m.js || problem "a module alone: not emitted"
grep -q 'export const glsl' m.js && problem "a module without --glsl: found GLSL, expected none"
finish
