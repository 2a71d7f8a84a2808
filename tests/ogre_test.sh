# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: ogre_test.sh PROGRAM SOURCE BUILD. Builds examples/ogre against an installed nook, draws a frame with OGRE, and compares the
# module's picture with that of nook shade for the depths and normals that OGRE drew. Exit code 77: no OGRE 1.12, Xvfb or oiiotool.
set -u
source=$(realpath "$2")
build=$(realpath "$3")
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/steps.sh"
unset DESTDIR NOOK_EXECUTABLE CMAKE_PREFIX_PATH CMAKE_GENERATOR || true
pkg-config --atleast-version=1.12 OGRE 2>/dev/null || { echo "skipped: found no OGRE, expected 1.12 (scripts/setup.sh ogre)"; exit 77; }
for tool in xvfb-run idiff oiiotool; do
	command -v "$tool" >/dev/null || { echo "skipped: found no $tool, expected Debian's packages xvfb and openimageio-tools"; exit 77; }
done

prefix="$folder/pre fix"
out="$folder/the build"
step "install" cmake --install "$build" --prefix "$prefix" || finish
cp -r "$source/examples/ogre" "$folder/ogre"
step "configure" cmake -G Ninja -S "$folder/ogre" -B "$out" "-DCMAKE_PREFIX_PATH=$prefix" -DCMAKE_BUILD_TYPE=Release \
	"-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wshadow -Wconversion -Wsign-conversion -Werror" || finish
step "build" cmake --build "$out" || finish
expect_made 4 "first build: a pattern, its tile, the module and the level"
cd "$folder" || exit 1
step "draw" xvfb-run -a "$out/ogre_example" || finish
grep -E ' (Error|Warning): ' ogre.log && problem "OGRE's log: found complaints, expected none"
[ -z "${NOOK_KEEP:-}" ] || cp frame.png visibility0.tif "$NOOK_KEEP"

step "G-buffer" oiiotool frame1.tif frame2.tif --ch R,G,B --chappend --chnames Z,N.X,N.Y,N.Z -o g.exr
# pictured WHAT OPTIONS…: no pixel differs from that of nook shade by more than 1/255.
pictured()
{
	what=$1
	shift
	step "$what: shade" "$prefix/bin/nook" shade g.exr --sky-depth 1e29 --projection "$(cat projection.txt)" --world-to-camera identity \
		--method vo-line --pattern "$out/nook_patterns/ogre_example/ogre_ao_vo-line_tile.json" --filter window --radius 1.5 "$@" -o shade.exr
	idiff -fail 0.0039216 visibility0.tif shade.exr >difference 2>&1
	[ $? -lt 2 ] || problem "$what: $(grep -E 'Max|pixels' difference)"
}
pictured "on the CPU"
pictured "in OpenGL" --device gl
# The window shows the level no brighter than its visibility, the same way up.
oiiotool frame.png --ch R visibility0.tif --sub --printstats | awk '/Stats Max/ { exit !($3 < 0.003) }' || problem "frame.png: found pixels brighter than their visibility"
# Checks that the test itself can fail.
before=$failures
pictured "another radius" --max-pixels 8 >missed
[ $failures -gt $before ] && failures=$before || problem "another radius: found no difference, expected one"
finish
