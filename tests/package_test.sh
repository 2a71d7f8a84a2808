# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: package_test.sh PROGRAM SOURCE BUILD. Installs nook to a folder with blanks in its name, moves it, and uses it from
# examples/consumer: with Ninja and Make, again without changes, after a change, with another program, and in a cross build.
set -u
source=$2
build=$3
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/steps.sh"
unset DESTDIR NOOK_EXECUTABLE CMAKE_PREFIX_PATH CMAKE_GENERATOR || true

# refused WHAT REGEX COMMAND...: fails and prints REGEX.
refused()
{
	what=$1
	regex=$2
	shift 2
	"$@" >"$folder/log" 2>&1 && problem "$what: succeeded, expected a refusal"
	tr -s ' \n' '  ' <"$folder/log" | grep -Eq "$regex" || problem "$what: expected '$regex', found: $(tail -n 20 "$folder/log")"
}

step "install" cmake --install "$build" --prefix "$folder/first prefix" || finish
mv "$folder/first prefix" "$folder/moved prefix"
prefix="$folder/moved prefix"
if grep -rIl -e "$source" -e "$build" "$prefix" >"$folder/log"; then
	problem "the installed files name the source or build folder: $(cat "$folder/log")"
fi
cp -r "$source/examples/consumer" "$folder/the consumer"

for generator in Ninja "Unix Makefiles"; do
	out="$folder/build $generator"
	step "$generator: configure" cmake -G "$generator" -S "$folder/the consumer" -B "$out" "-DCMAKE_PREFIX_PATH=$prefix" || finish
	step "$generator: build" cmake --build "$out"
	expect_made 3 "$generator: first build"
	step "$generator: run" "$out/consumer"
	grep -q '9 lines' "$folder/log" || problem "$generator: the consumer said nothing of its lines"
	[ -s "$out/shaders/disk_009.glsl" ] || problem "$generator: no disk_009.glsl beside the program"

	patterns="$out/nook_patterns/consumer"
	cp -p "$patterns/disk_009.h" "$folder/before.h"
	step "$generator: again" cmake --build "$out"
	expect_made 0 "$generator: nothing changed"
	[ "$patterns/disk_009.h" -nt "$folder/before.h" ] && problem "$generator: disk_009.h made again without a change"

	step "$generator: other options" cmake "-DCONSUMER_LINE_OPTIONS=--symmetric;--seed;7" "$out"
	step "$generator: build with other options" cmake --build "$out"
	expect_made 2 "$generator: other options for two of three"
	grep -q -- '--seed 7' "$patterns/disk_009.h" || problem "$generator: other options did not reach the header"
	step "$generator: same options" cmake "-DCONSUMER_LINE_OPTIONS=--symmetric;--seed;7" "$out"
	step "$generator: build with same options" cmake --build "$out"
	expect_made 0 "$generator: configured again without a change"

	sleep 1
	touch "$prefix/bin/nook"
	step "$generator: other program" cmake --build "$out"
	expect_made 3 "$generator: another program"
done

# An explicit program, also in a cross build, where the package's own may not run.
cat >"$folder/other nook" <<EOT
#!/bin/sh
echo "\$*" >>"$folder/calls"
exec "$prefix/bin/nook" "\$@"
EOT
chmod +x "$folder/other nook"
step "NOOK_EXECUTABLE: configure" cmake -G Ninja -S "$folder/the consumer" -B "$folder/other" "-DCMAKE_PREFIX_PATH=$prefix" "-DNOOK_EXECUTABLE=$folder/other nook"
step "NOOK_EXECUTABLE: build" cmake --build "$folder/other"
[ "$(wc -l <"$folder/calls")" -eq 3 ] || problem "NOOK_EXECUTABLE: $(wc -l <"$folder/calls") calls, expected 3"
refused "NOOK_EXECUTABLE: no such file" "NOOK_EXECUTABLE: found no file '/none'" \
	cmake -G Ninja -S "$folder/the consumer" -B "$folder/none" "-DCMAKE_PREFIX_PATH=$prefix" -DNOOK_EXECUTABLE=/none

cat >"$folder/toolchain.cmake" <<EOT
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR nook_test_processor)
EOT
rm "$folder/calls"
step "cross: configure" cmake -G Ninja -S "$folder/the consumer" -B "$folder/cross" "-DCMAKE_PREFIX_PATH=$prefix" \
	"-DCMAKE_TOOLCHAIN_FILE=$folder/toolchain.cmake" "-DNOOK_EXECUTABLE=$folder/other nook"
step "cross: build" cmake --build "$folder/cross"
[ "$(wc -l <"$folder/calls")" -eq 3 ] || problem "cross: $(wc -l <"$folder/calls") calls of the host's program, expected 3"
step "cross: the package's own program runs on the host" cmake -G Ninja -S "$folder/the consumer" -B "$folder/cross host" \
	"-DCMAKE_PREFIX_PATH=$prefix" "-DCMAKE_TOOLCHAIN_FILE=$folder/toolchain.cmake"
config=$(find "$prefix" -name nookConfig.cmake)
sed 's/set(_nook_system ".*")/set(_nook_system "Elsewhere-z80")/' "$config" >"$folder/config" && cp "$folder/config" "$config"
refused "cross: a program for another machine" "NOOK_EXECUTABLE=FILE" cmake -G Ninja -S "$folder/the consumer" -B "$folder/cross none" \
	"-DCMAKE_PREFIX_PATH=$prefix" "-DCMAKE_TOOLCHAIN_FILE=$folder/toolchain.cmake"

# Invalid calls fail at configure time.
mkdir "$folder/wrong"
try()
{
	printf 'cmake_minimum_required(VERSION 3.25)\nproject(wrong LANGUAGES CXX)\nfind_package(nook CONFIG REQUIRED)\nfile(WRITE a.cpp "")\nadd_library(a INTERFACE)\n%s\n' "$2" >"$folder/wrong/CMakeLists.txt"
	refused "$2" "$1" cmake -G Ninja -S "$folder/wrong" -B "$folder/wrong/build" "-DCMAKE_PREFIX_PATH=$prefix"
}
try "DOMAIN: found 'cube'" 'nook_add_patterns(a DOMAIN cube COUNTS 3)'
try "DOMAIN: found ''" 'nook_add_patterns(a COUNTS 3)'
try "COUNTS: found none" 'nook_add_patterns(a DOMAIN disk)'
try "COUNTS: found '0'" 'nook_add_patterns(a DOMAIN disk COUNTS 3 0)'
try "COUNTS: found '4097'" 'nook_add_patterns(a DOMAIN disk COUNTS 4097)'
try "found no target 'b'" 'nook_add_patterns(b DOMAIN disk COUNTS 3)'
try "found 'SEEDS" 'nook_add_patterns(a SEEDS 3 DOMAIN disk COUNTS 3)'
try "found 'disk_003' twice" 'nook_add_patterns(a DOMAIN disk COUNTS 3 3)'
try "NAME: found '3x'" 'nook_add_patterns(a DOMAIN disk COUNTS 3 NAME 3x)'

try "found no target 'b'" 'nook_add_module(b NAME m METHODS vo-line COUNTS 3 GLSL 330)'
try "NAME: found ''" 'nook_add_module(a METHODS vo-line COUNTS 3 GLSL 330)'
try "GLSL: found '110'" 'nook_add_module(a NAME m METHODS vo-line COUNTS 3 GLSL 110)'
try "HLSL: found '50'" 'nook_add_module(a NAME m METHODS vo-line COUNTS 3 HLSL 50)'
try "found WGSL with GLSL" 'nook_add_module(a NAME m METHODS vo-line COUNTS 3 GLSL 330 WGSL)'
try "FORMATS: found 'rs'" 'nook_add_module(a NAME m METHODS vo-line COUNTS 3 WGSL FORMATS js rs)'
try "METHODS: found none" 'nook_add_module(a NAME m COUNTS 3 GLSL 330)'
try "METHODS: found 'gtao', expected some of vo-line" 'nook_add_module(a NAME m METHODS gtao COUNTS 3 GLSL 330)'
try "found 1 COUNTS and 0 PATTERNS, expected 2" 'nook_add_module(a NAME m METHODS vo-line vo-point COUNTS 3 GLSL 330)'
try "found 1 COUNTS and 1 PATTERNS" 'nook_add_module(a NAME m METHODS vo-line COUNTS 3 PATTERNS p.json GLSL 330)'
try "found 1 COUNTS and 0 PATTERNS, expected 0" 'nook_add_module(a NAME m METHODS statvo COUNTS 3 GLSL 330)'
try "COUNTS: found 'x'" 'nook_add_module(a NAME m METHODS vo-line COUNTS x GLSL 330)'
try "TILE: found '0'" 'nook_add_module(a NAME m METHODS vo-line COUNTS 3 TILE 0 GLSL 330)'
try "found TILE, PATTERN_OPTIONS" 'nook_add_module(a NAME m METHODS vo-line PATTERNS p.json TILE 4 GLSL 330)'
try "found 'SEED" 'nook_add_module(a NAME m SEED 3 METHODS vo-line COUNTS 3 GLSL 330)'
try "found 0 COUNTS and 0 PATTERNS, expected 1 of one of them, as METHODS that take samples, or 2 with slices" 'nook_add_module(a NAME m METHODS slices vo-line GLSL 330)'
try "TILE: found '1' with COUNTS of slices" 'nook_add_module(a NAME m METHODS slices COUNTS 2 TILE 1 GLSL 330)'
try "found RECIPE, FORMATS or SCRIPT with aov" 'nook_add_module(a NAME m METHODS aov SCRIPT GLSL 330)'
try "GLSL: found '', expected 330, 430 or vulkan, or HLSL, for aov-mask" 'nook_add_module(a NAME m METHODS aov-mask WGSL)'
try "GLSL: found 'es300', expected 330, 430 or vulkan, or HLSL, for aov-mask" 'nook_add_module(a NAME m METHODS aov-mask GLSL es300)'
try "OPTIONS: found '--recipe', expected" 'nook_add_module(a NAME m METHODS slices GLSL 330 OPTIONS --recipe paper)'
try "OPTIONS: found '-o', expected" 'nook_add_module(a NAME m METHODS slices GLSL 330 OPTIONS --filter bilateral -o m.js)'
try "found 'm' twice" 'nook_add_module(a NAME m METHODS vo-line COUNTS 3 GLSL 330)
nook_add_module(a NAME m METHODS vo-line COUNTS 3 GLSL 330)'
try "found no target 'b'" 'nook_add_level(b LEVEL builtin:nulls OUTPUT x)'
try "found no LEVEL or no OUTPUT" 'nook_add_level(a LEVEL builtin:nulls)'
try "found 'UNIT" 'nook_add_level(a UNIT 3 LEVEL builtin:nulls OUTPUT x)'
try "found 'nulls' twice" 'nook_add_level(a LEVEL builtin:nulls OUTPUT x)
nook_add_level(a LEVEL builtin:nulls OUTPUT y)'

try "found no target 'b'" 'nook_add_volumes(b LEVEL builtin:nulls DISTANCE 1 OUTPUT x)'
try "found no LEVEL or no OUTPUT" 'nook_add_volumes(a LEVEL builtin:nulls DISTANCE 1)'
try "DISTANCE: found ''" 'nook_add_volumes(a LEVEL builtin:nulls OUTPUT x)'
try "DISTANCE: found '0.0'" 'nook_add_volumes(a LEVEL builtin:nulls DISTANCE 0.0 OUTPUT x)'
try "DISTANCE: found '-1'" 'nook_add_volumes(a LEVEL builtin:nulls DISTANCE -1 OUTPUT x)'
try "LAYOUT: found 'cubes'" 'nook_add_volumes(a LEVEL builtin:nulls DISTANCE 1 LAYOUT cubes OUTPUT x)'
try "found 'UNIT" 'nook_add_volumes(a UNIT 3 LEVEL builtin:nulls DISTANCE 1 OUTPUT x)'
try "found 'nulls' twice" 'nook_add_volumes(a LEVEL builtin:nulls DISTANCE 1 OUTPUT x)
nook_add_volumes(a LEVEL builtin:nulls DISTANCE 2 OUTPUT y)'

try "found no target 'b'" 'nook_add_bake(b LEVEL builtin:nulls RADIUS 1 OUTPUT x)'
try "found no LEVEL or no OUTPUT" 'nook_add_bake(a LEVEL builtin:nulls RADIUS 1)'
try "RADIUS: found ''" 'nook_add_bake(a LEVEL builtin:nulls OUTPUT x)'
try "RADIUS: found 'far'" 'nook_add_bake(a LEVEL builtin:nulls RADIUS far OUTPUT x)'
try "PROBES: found '0'" 'nook_add_bake(a LEVEL builtin:nulls RADIUS 1 PROBES 0 OUTPUT x)'
try "OPTIONS: found '--probes', expected" 'nook_add_bake(a LEVEL builtin:nulls RADIUS 1 OUTPUT x OPTIONS --probes 2)'
try "found 'UNIT" 'nook_add_bake(a UNIT 3 LEVEL builtin:nulls RADIUS 1 OUTPUT x)'
try "found 'nulls.bake.glb' twice" 'nook_add_bake(a LEVEL builtin:nulls RADIUS 1 OUTPUT x)
nook_add_bake(a LEVEL builtin:nulls RADIUS 2 OUTPUT y)'

# Through an interface library from another folder.
mkdir -p "$folder/wrong/sub"
cat >"$folder/wrong/CMakeLists.txt" <<'EOT'
cmake_minimum_required(VERSION 3.25)
project(through LANGUAGES CXX)
find_package(nook CONFIG REQUIRED)
add_library(patterns INTERFACE)
add_subdirectory(sub)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/a.cpp "#include \"disk_003.h\"\nint main() { return NOOK_DISK_3_COUNT - 3; }\n")
add_executable(through ${CMAKE_CURRENT_BINARY_DIR}/a.cpp)
target_link_libraries(through PRIVATE patterns)
EOT
echo 'nook_add_patterns(patterns DOMAIN disk COUNTS 3 OPTIONS --method vogel)' >"$folder/wrong/sub/CMakeLists.txt"
rm -rf "$folder/wrong/build"
step "interface: configure" cmake -G Ninja -S "$folder/wrong" -B "$folder/wrong/build" "-DCMAKE_PREFIX_PATH=$prefix"
step "interface: build" cmake --build "$folder/wrong/build"
step "interface: run" "$folder/wrong/build/through"

# Modules: one without samples, and one that shares another's, which Make would make twice without a dependency.
mkdir "$folder/modules"
cat >"$folder/modules/CMakeLists.txt" <<'EOT'
cmake_minimum_required(VERSION 3.25)
project(modules LANGUAGES CXX)
find_package(nook CONFIG REQUIRED)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/a.cpp
	"#include \"statistics.h\"\n#include \"mixed.h\"\nint main() { return nook_vo_area_tile_height - 3 + int(sizeof(nook_block)) % 16; }\n")
add_executable(modules ${CMAKE_CURRENT_BINARY_DIR}/a.cpp)
nook_add_module(modules NAME statistics METHODS statvo GLSL 330 OPTIONS --filter bilateral)
nook_add_module(modules NAME mixed METHODS statvo vo-area COUNTS 3 GLSL 330 PATTERN_OPTIONS --method vogel SAMPLES samples)
nook_add_module(modules NAME half METHODS vo-area PATTERNS ${samples} GLSL es300 OPTIONS --filter bilateral --resolution half)
EOT
step "modules: configure" cmake -G "Unix Makefiles" -S "$folder/modules" -B "$folder/modules/build" "-DCMAKE_PREFIX_PATH=$prefix"
step "modules: build" cmake --build "$folder/modules/build" -j 4
expect_made 5 "three modules, a pattern and its tile"
step "modules: run" "$folder/modules/build/modules"
for line in "statistics float nookStatVo(ivec2 pixel)" "mixed float nookVoArea(ivec2 pixel)" "half float nookVoAreaFull(ivec2 pixel)" \
	"half vec4 nookBilateralX(ivec2"; do
	step "modules: ${line#* }" grep -Fq "${line#* }" "$folder/modules/build/nook_patterns/modules/${line%% *}.glsl"
done

# All features of nook emit: its own slices and slices of a tile, a recipe from a file, JavaScript; remade when the recipe changes.
mkdir "$folder/emits"
cat >"$folder/emits/recipe.json" <<'EOT'
{ "format": "nook.recipes/1", "recipes": [{ "method": "slices", "radius": 0.75, "options": {} }] }
EOT
cat >"$folder/emits/CMakeLists.txt" <<'EOT'
cmake_minimum_required(VERSION 3.25)
project(emits LANGUAGES CXX)
find_package(nook CONFIG REQUIRED)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/a.cpp "#include \"fitted.h\"\nint main() { return nook_slices_settings(4.0).radius == 3.0 ? 0 : 1; }\n")
add_executable(emits ${CMAKE_CURRENT_BINARY_DIR}/a.cpp)
nook_add_module(emits NAME fitted METHODS slices RECIPE recipe.json GLSL 430 SCRIPT OUTPUTS files
	OPTIONS --slices 2 --depth device --bent --filter bilateral)
nook_add_module(emits NAME tiled METHODS vo-line slices COUNTS 3 2 TILE 2 RECIPE paper GLSL vulkan OPTIONS --normals from-depth
	PATTERN_OPTIONS --method vogel TILE_OPTIONS --starts 1)
nook_add_module(emits NAME masks METHODS aov-mask GLSL 430 OPTIONS --directions 64)
nook_add_module(emits NAME shaders METHODS slices WGSL FORMATS cs py json EMBED OUTPUTS others)
if(NOT others MATCHES "shaders.wgsl;.*shaders.h;.*shaders.cs;.*shaders.py;.*shaders.json;.*shaders.wgsl.h$")
	message(FATAL_ERROR "OUTPUTS: found ${others}, expected shaders.wgsl, .h, .cs, .py, .json and .wgsl.h")
endif()
if(NOT files MATCHES "fitted.js$")
	message(FATAL_ERROR "OUTPUTS: found ${files}, expected fitted.js last")
endif()
EOT
for generator in Ninja "Unix Makefiles"; do
	out="$folder/emits/build $generator"
	cp "$folder/emits/recipe.json" "$folder/recipe.json"
	step "emits, $generator: configure" cmake -G "$generator" -S "$folder/emits" -B "$out" "-DCMAKE_PREFIX_PATH=$prefix" || finish
	step "emits, $generator: build" cmake --build "$out" -j 4
	expect_made 7 "emits, $generator: four modules, a pattern and two tiles"
	step "emits, $generator: run" "$out/emits"
	made="$out/nook_patterns/emits"
	step "emits, $generator: slices" grep -Fq "vec4 nookSlicesOpen(ivec2 pixel)" "$made/fitted.glsl"
	step "emits, $generator: JavaScript" grep -Fq "radius: 0.75 * reach" "$made/fitted.js"
	step "emits, $generator: device depth" grep -Fq "settings.device_depth = true;" "$made/fitted.h"
	step "emits, $generator: a tile of slices" grep -Fq "inline constexpr int nook_slices_tile_height = 2;" "$made/tiled.h"
	step "emits, $generator: masks" grep -Fq "float(covered) / 64.0" "$made/masks.glsl"
	step "emits, $generator: WGSL" grep -Fq "fn nookSlices(pixel" "$made/shaders.wgsl"
	step "emits, $generator: C#" grep -Fq "static Block Fill(" "$made/shaders.cs"
	step "emits, $generator: Python" grep -Fq "def slices_settings(reach" "$made/shaders.py"
	step "emits, $generator: JSON" grep -Fq '"schema":"nook.module/1"' "$made/shaders.json"
	step "emits, $generator: embedded" grep -Fq "char shaders_wgsl[]" "$made/shaders.wgsl.h"
	step "emits, $generator: again" cmake --build "$out"
	expect_made 0 "emits, $generator: nothing changed"
	sleep 1
	sed 's/0.75/0.5/' "$folder/recipe.json" >"$folder/emits/recipe.json"
	step "emits, $generator: after another recipe" cmake --build "$out"
	expect_made 1 "emits, $generator: the recipe changed"
	cp "$folder/recipe.json" "$folder/emits/recipe.json"
done
# The build fails with nook's error line.
sed 's/--bent/--bent --taps 6/' "$folder/emits/CMakeLists.txt" >"$folder/CMakeLists.txt" && cp "$folder/CMakeLists.txt" "$folder/emits/CMakeLists.txt"
step "wrong OPTIONS: configure" cmake "$folder/emits/build Ninja"
refused "wrong OPTIONS" "nook: --taps: found .?6.?, expected" cmake --build "$folder/emits/build Ninja"

# Volumes: made, read by the installed header, remade only when the level changes.
mkdir "$folder/volumes"
cat >"$folder/volumes/house.obj" <<'EOT'
v 0 0 0
v 4 0 0
v 4 0 4
v 0 0 4
v 0 3 0
v 4 3 0
f 4 3 2 1
f 1 2 6 5
EOT
cat >"$folder/volumes/main.cpp" <<'EOT'
#include <nook/nook_volumes.h>
#include <nook/nook_volumes_draw.h>
#include <cstdio>
#include <vector>
int main(int, char** arguments)
{
	std::FILE* const file = std::fopen(arguments[1], "rb");
	std::vector<unsigned char> bytes(1 << 20);
	bytes.resize(file ? std::fread(bytes.data(), 1, bytes.size(), file) : 0);
	nook_volumes::Volumes volumes;
	const char* const problem = volumes.open(bytes.data(), bytes.size());
	std::printf("%s: %u volumes of %u corners reach %g m\n", problem ? problem : "good", unsigned(volumes.polygonCount()),
		unsigned(volumes.cornerCount()), problem ? 0.0 : volumes.header().distance);
	return problem ? 1 : 0;
}
EOT
cat >"$folder/volumes/CMakeLists.txt" <<'EOT'
cmake_minimum_required(VERSION 3.25)
project(volumes LANGUAGES CXX)
find_package(nook CONFIG REQUIRED)
add_executable(volumes main.cpp)
target_compile_features(volumes PRIVATE cxx_std_17)
target_compile_options(volumes PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Werror)
nook_add_volumes(volumes LEVEL house.obj DISTANCE 1.5 OUTPUT file)
nook_add_volumes(volumes LEVEL builtin:cornell DISTANCE 0.3 LAYOUT prisms OUTPUT other OPTIONS --compress)
EOT
for generator in Ninja "Unix Makefiles"; do
	out="$folder/volumes/build $generator"
	step "volumes, $generator: configure" cmake -G "$generator" -S "$folder/volumes" -B "$out" "-DCMAKE_PREFIX_PATH=$prefix" || finish
	step "volumes, $generator: build" cmake --build "$out"
	expect_made 2 "volumes, $generator: first build"
	step "volumes, $generator: run" "$out/volumes" "$out/nook_patterns/volumes/house.volumes.glb"
	grep -Fq "good: 2 volumes of 8 corners reach 1.5 m" "$folder/log" || problem "volumes, $generator: read '$(cat "$folder/log")'"
	step "volumes, $generator: the statement" grep -Fq '"polygons": 2' "$out/nook_patterns/volumes/house.volumes.json"
	step "volumes, $generator: again" cmake --build "$out"
	expect_made 0 "volumes, $generator: nothing changed"
	sleep 1
	echo "# other" >>"$folder/volumes/house.obj"
	step "volumes, $generator: after a change" cmake --build "$out"
	expect_made 1 "volumes, $generator: the level changed"
done

# Bakes: of vertices with volumes that are also made here, and of probes; remade only when the level changes.
mkdir "$folder/bakes"
cp "$folder/volumes/house.obj" "$folder/bakes"
cat >"$folder/bakes/CMakeLists.txt" <<'EOT'
cmake_minimum_required(VERSION 3.25)
project(bakes LANGUAGES CXX)
find_package(nook CONFIG REQUIRED)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/a.cpp "int main() { return 0; }\n")
add_executable(bakes ${CMAKE_CURRENT_BINARY_DIR}/a.cpp)
nook_add_volumes(bakes LEVEL house.obj DISTANCE 1.5 OUTPUT volumes)
nook_add_bake(bakes LEVEL house.obj RADIUS 1.5 OUTPUT vertices OPTIONS --rays 16)
nook_add_bake(bakes LEVEL house.obj RADIUS 1.5 NAME rest VOLUMES ${volumes} OUTPUT rest OPTIONS --rays 16)
nook_add_bake(bakes LEVEL builtin:cornell RADIUS 0.5 PROBES 0.3 OUTPUT probes OPTIONS --rays 16)
if(NOT vertices MATCHES "/house.bake.glb$" OR NOT probes MATCHES "cornell.probes.ktx2;.*cornell.probes.glsl$")
	message(FATAL_ERROR "OUTPUT: found ${vertices} and ${probes}")
endif()
EOT
for generator in Ninja "Unix Makefiles"; do
	out="$folder/bakes/build $generator"
	step "bakes, $generator: configure" cmake -G "$generator" -S "$folder/bakes" -B "$out" "-DCMAKE_PREFIX_PATH=$prefix" || finish
	step "bakes, $generator: build" cmake --build "$out" -j 4
	expect_made 4 "bakes, $generator: first build"
	made="$out/nook_patterns/bakes"
	step "bakes, $generator: vertices" "$prefix/bin/nook" info "$made/house.bake.glb"
	step "bakes, $generator: visibility" grep -aq _VISIBILITY "$made/house.bake.glb"
	step "bakes, $generator: probes" grep -q "nookProbeVisibility" "$made/cornell.probes.glsl"
	step "bakes, $generator: again" cmake --build "$out"
	expect_made 0 "bakes, $generator: nothing changed"
	sleep 1
	echo "# other" >>"$folder/bakes/house.obj"
	step "bakes, $generator: after a change" cmake --build "$out"
	expect_made 3 "bakes, $generator: the level changed"
	sed -i 's/RADIUS 0.5/RADIUS 0.25/' "$folder/bakes/CMakeLists.txt"
	step "bakes, $generator: after another radius" cmake --build "$out"
	expect_made 1 "bakes, $generator: a radius changed"
	sed -i 's/RADIUS 0.25/RADIUS 0.5/' "$folder/bakes/CMakeLists.txt"
done

finish
