# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: gl_missing_test.sh PROGRAM. Everything that uses OpenGL, without its libraries: one line and exit code 5. The libraries are
# hidden for a single command by mounting an empty file over each. Exit code 77: no permission to mount.
set -u
nook=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
. "$here/hidden_libraries.sh"
. "$here/command_line.sh"
canHide || { echo "skipped: found no right to mount, expected root and unshare"; exit 77; }

"$nook" gbuffer builtin:cornell --size 32x18 -o kept_g.exr || problem "no G-buffer"
"$nook" volumes builtin:cornell --distance 0.3 -o kept_v.glb >/dev/null || problem "no volumes"
# refuses LIBRARY ARGUMENTS...: the error names the library.
refuses()
{
	library=$1
	shift
	without "$library" "$nook" "$@" >../stdout 2>../stderr </dev/null
	found=$?
	[ "$found" -eq 5 ] && [ "$(wc -l <../stderr)" -eq 1 ] && grep -q "^nook: OpenGL: found no library ${library%% *}" ../stderr ||
		problem "without $library: nook $*: exit code $found, expected 5 and one line: $(cat ../stderr)"
}
small="--size 32x18 --views 1 --rays 4 --repetitions 1"
for library in libEGL.so.1 "libOpenGL.so.0 libGL.so.1"; do
	refuses "$library" shade kept_g.exr --method vo-line --device gl -o v.exr
	refuses "$library" shade kept_g.exr --method aov --volumes kept_v.glb --device gl -o v.exr
	refuses "$library" shade kept_g.exr --method vo-line --device gl --gl-device 0 --timing -o v.exr
	refuses "$library" report error builtin:cornell --quick --size 32x18 -o e.html
	refuses "$library" tune builtin:cornell --budget 20ms $small -o picked
done
# The CPU needs none of it.
without libEGL.so.1 "$nook" shade kept_g.exr --method vo-line -o v.exr 2>../stderr || problem "without libEGL.so.1 on the CPU: $(cat ../stderr)"
there v.exr
finish
