# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: portable_test.sh PROGRAM SOURCE BUILD|BUNDLE.tar.xz. The portable bundle, of BUILD or unpacked, runs in a root that has nothing
# else, from a folder with blanks in its name, and writes the program's bytes; a picture that needs OpenImageIO is refused there. Exit
# code 77: not root, or no static libc.
set -u
nook=$1
if [ "$(id -u)" -ne 0 ] || ! command -v chroot >/dev/null || [ ! -e "$(cc -print-file-name=libc.a)" ]; then
	echo "skipped: found no root, chroot or libc.a, expected them to make and to try the bundle"
	exit 77
fi
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/steps.sh"
root="$folder/root"
mkdir -p "$root/levels" "$root/dev" "$folder/here"
cp -a /dev/null "$root/dev/"
case $3 in
*.tar.xz) mkdir "$root/a folder" && step "unpacked" tar xf "$3" -C "$root/a folder" --strip-components 1 || finish ;;
*) step "portable.sh" sh "$2/packaging/portable.sh" --folder "$3" "$root/a folder" || finish ;;
esac
cp "$(dirname "$0")/../docs/pictures/views.png" "$folder/here/mask.png"
printf 'GIF89a\1\0\1\0\0\0\0;' >"$folder/here/mask.gif"
for mask in png gif; do
	printf 'newmtl a\nmap_d mask.%s\n' $mask >"$folder/here/$mask.mtl"
	printf 'mtllib %s.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n' $mask >"$folder/here/$mask.obj"
done
cp "$folder"/here/* "$root/levels/"

# both OUTPUT ARGUMENTS...: the same bytes from the program here and from the bundle there.
both()
{
	output=$1
	shift
	step "here: $*" sh -c 'cd "$1" && shift && exec "$@"' sh "$folder/here" "$nook" "$@" -o "$output"
	step "there: $*" chroot "$root" "/a folder/bin/nook" "$@" -o "/levels/$output"
	same "$folder/here/$output" "$root/levels/$output" "$output differs: $*"
}
both a.json pattern --domain disk --count 9
both a.exr gbuffer builtin:courtyard --size 64x36
both b.glb volumes builtin:courtyard --distance 0.6
step "here: a level with a mask" "$nook" level "$folder/here/png.obj" -o "$folder/here/c.glb"
step "there: a level with a mask" chroot "$root" "/a folder/bin/nook" level /levels/png.obj -o /levels/c.glb
same "$folder/here/c.glb" "$root/levels/c.glb" "the level with a mask differs"
status=0
chroot "$root" "/a folder/bin/nook" info /levels/gif.obj >"$folder/log" 2>&1 || status=$?
[ $status -eq 5 ] && grep -q 'a picture that only OpenImageIO reads' "$folder/log" || problem "a GIF mask: exit code $status, expected 5: $(cat "$folder/log")"
[ -s "$root/a folder/share/man/man1/nook-pattern.1.gz" ] || problem "the bundle has no manual page of nook pattern"

# Masks that nook reads itself have the values that OpenImageIO reads from a TIFF.
if command -v oiiotool >/dev/null; then
	cd "$folder/here" || exit 1
	oiiotool --pattern noise:type=uniform:seed=3:mono=0 37x23 4 -d uint8 -o mask.tif -o mask.tga -o mask.bmp >/dev/null
	oiiotool mask.tif --compression rle -o rle.tga --ch R,G,B -d uint8 -o mask.jpg >/dev/null
	oiiotool mask.tif -d half -o mask.exr >/dev/null
	oiiotool mask.jpg -o jpg.tif >/dev/null
	# maskOf FILE: the level with that mask as values, whatever the file's name.
	maskOf()
	{
		printf 'newmtl a\nmap_d %s\n' "$1" >png.mtl
		"$nook" level png.obj -o m.glb >"$folder/log" 2>&1 || problem "$1: $(cat "$folder/log")"
		LC_ALL=C sed "s/$1/mask/g" m.glb
	}
	for pair in mask.tga/mask.tif rle.tga/mask.tif mask.bmp/mask.tif mask.exr/mask.tif mask.jpg/jpg.tif; do
		maskOf "${pair%/*}" | tail -c +21 | tr -d ' ' >a
		maskOf "${pair#*/}" | tail -c +21 | tr -d ' ' >b
		same a b "a mask, ${pair%/*}, differs from ${pair#*/}"
	done
fi
finish
