# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: windows_levels_test.sh PROGRAM SOURCE FOLDER. Builds the preset windows-levels in FOLDER/windows-levels (kept), packs it, and
# runs it with Wine from a folder with a blank and letters beyond ASCII in its path: the bytes of PROGRAM for every built-in level and
# for Sponza, and its lines and exit codes for files and workers that are broken. Exit code 77: a tool, or the libraries of
# packaging/windows_libraries.sh, are missing.
set -u
nook=$1
source=$2
build=$3/windows-levels
export LC_ALL=C.UTF-8 WINEDEBUG=-all
wine=$(command -v wine64 || echo /usr/lib/wine/wine64)
server=$(command -v wineserver || echo /usr/lib/wine/wineserver)
libraries=${NOOK_WINDOWS_LIBRARIES:-$source/build/windows-libraries}
if [ ! -x "$wine" ] || [ ! -e "$libraries/lib/libz.a" ]; then
	echo "skipped: found no Wine or no $libraries, expected scripts/setup.sh windows and packaging/windows_libraries.sh build/windows-libraries"
	exit 77
fi
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/steps.sh"
step "windows-levels: configured" cmake --preset windows-levels -S "$source" -B "$build" -DNOOK_WINDOWS_LIBRARIES="$libraries" || finish
step "windows-levels: built" cmake --build "$build" || finish

# The ZIP: small, with its workers and licences, and without libraries other than Windows' own.
mkdir "$folder/here" "$folder/Ünï 文 1"
step "windows-levels: packed" sh -c 'cd "$1" && cpack -G ZIP -B "$2"' sh "$build" "$folder" || finish
zip=$(ls "$folder"/nook-*.zip)
step "windows-levels: unpacked" python3 -m zipfile -e "$zip" "$folder/Ünï 文 1" || finish
root=$(dirname "$(ls -d "$folder/Ünï 文 1"/*/bin)")
[ "$(cat "$root"/bin/*.exe | wc -c)" -le 31457280 ] || problem "the programs take $(cat "$root"/bin/*.exe | wc -c) bytes, expected 31457280 or fewer"
[ "$(find "$root" -path '*libraries*' -type f | wc -l)" -ge 7 ] || problem "$zip: found no licences of the libraries"
for program in "$root"/bin/*.exe; do
	! x86_64-w64-mingw32-objdump -p "$program" | grep -iE 'DLL Name: (lib|.*pthread|.*stdc|tbb|embree)' || problem "$program needs a library"
done

# One server for all programs: a program that starts while a server shuts down fails now and then.
export WINEPREFIX="$folder/wine"
mkdir "$WINEPREFIX"
"$server" -p
trap '"$server" -k; "$server" -w; rm -rf "$folder"' EXIT
"$wine" "$root/bin/nook.exe" --version >/dev/null 2>&1 # lets Wine create its folder

# both OUTPUT ARGUMENTS...: the same bytes, lines and exit code.
both()
{
	output=$1
	shift
	cd "$folder/here" || exit 1
	expected=0
	"$nook" "$@" -o "$output" >"$folder/here.out" 2>"$folder/here.err" || expected=$?
	cd "$folder/Ünï 文 1" || exit 1
	# Wine now and then ends a program at its start: ours with exit code 1 and no output, a worker by ERROR_INTERNAL_ERROR.
	for start in first again; do
		found=0
		"$wine" "$root/bin/nook.exe" "$@" -o "$output" >"$folder/there.out" 2>"$folder/there.err" || found=$?
		{ [ $found -eq 1 ] && [ ! -s "$folder/there.err" ]; } || grep -q 'cannot be started: Internal error' "$folder/there.err" || break
		echo "windows-levels: nook $*: not started by Wine, $start"
	done
	[ $found -eq $expected ] || problem "nook $*: exit code $found, expected $expected: $(cat "$folder/there.err")"
	cmp "$folder/here.err" "$folder/there.err" >&2 || problem "nook $*: other lines: $(cat "$folder/there.err")"
	[ $expected -ne 0 ] || cmp "$folder/here/$output" "$output" >&2 || problem "nook $* -o $output: other bytes"
}

# Every verb on a level. The file of `nook level` is read again by the worker.
verbs()
{
	both level.glb level "$1" --ignore material:none
	both view.exr gbuffer "$1" --size 48x27 $2
	both rays.exr reference "$1" --gbuffer view.exr --radius 1 --rays 4
	both volumes.glb volumes "$1" --distance "$3"
	both baked.glb bake level.glb --radius 1 --rays 2
}
for level in cornell courtyard suburb foliage heightfield:9 cave:1000 nulls; do
	verbs builtin:$level "" 0.6
done
both picture.png reference builtin:cornell --gbuffer view.exr --radius 1 --rays 4
both texture.glb bake builtin:cornell --radius 1 --rays 4 --texture 64 # refused
both probes.ktx2 bake builtin:cornell --radius 1 --rays 4 --probes 1
both packed.glb volumes builtin:cornell --distance 0.6 --compress
both unpacked.glb level packed.glb

# Files of every format, masks by the picture workers, names beyond ASCII, and files that are broken.
for place in here "Ünï 文 1"; do
	cp "$source/docs/pictures/views.png" "$folder/$place/mäsk.png"
	printf 'GIF89a\1\0\1\0\0\0\0;' >"$folder/$place/mask.gif"
	for mask in mäsk.png mask.gif; do
		printf 'newmtl a\nmap_d %s\n' $mask >"$folder/$place/$mask.mtl"
		printf 'mtllib %s.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n' $mask >"$folder/$place/$mask.obj"
	done
	printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >"$folder/$place/ä.ply"
	printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n' >"$folder/$place/a.stl"
	head -c 3000 "$folder/$place/packed.glb" >"$folder/$place/short.glb"
	printf 'v 0 0 0\nf 1 2 999\n' >"$folder/$place/wrong.obj"
	printf 'not a level' >"$folder/$place/text.fbx"
done
for file in mäsk.png.obj ä.ply a.stl short.glb wrong.obj text.fbx none.obj .; do
	both file.glb level "$file"
done
both view.exr gbuffer mäsk.png # not an OpenEXR file
"$wine" "$root/bin/nook.exe" level mask.gif.obj -o file.glb 2>"$folder/there.err"
[ $? -eq 5 ] && grep -q 'a picture that only OpenImageIO reads' "$folder/there.err" || problem "a GIF mask: $(cat "$folder/there.err")"

# Sponza, where its file is.
if [ -e "$source/../shared/scenes/sponza/sponza.glb.xz" ]; then
	xz -dc "$source/../shared/scenes/sponza/sponza.glb.xz" >"$folder/here/sponza.glb"
	cp "$folder/here/sponza.glb" "$folder/Ünï 文 1/"
	both level.glb level sponza.glb
	both view.exr gbuffer sponza.glb --size 48x27
	both rays.exr reference sponza.glb --gbuffer view.exr --radius 1 --rays 4
	both volumes.glb volumes sponza.glb --distance 0.3
	both baked.csv bake sponza.glb --radius 1 --rays 1
fi

# A worker that ends at once is exit code 4, one that is missing 2.
cp "$root/bin/nook.exe" "$root/bin/nook_level_worker.exe"
"$wine" "$root/bin/nook.exe" level a.stl -o x.glb 2>"$folder/there.err"
[ $? -eq 4 ] && grep -q 'nook_level_worker: found that it cannot be started: it ends with status 1' "$folder/there.err" || problem "a worker that ends: $(cat "$folder/there.err")"
rm "$root/bin/nook_level_worker.exe"
"$wine" "$root/bin/nook.exe" level a.stl -o x.glb 2>"$folder/there.err"
[ $? -eq 2 ] && grep -q 'nook_level_worker: found no such program' "$folder/there.err" || problem "no worker: $(cat "$folder/there.err")"
[ -z "$(find "$folder/Ünï 文 1" -name '*.tmp*')" ] || problem "temporary files are left"
finish
