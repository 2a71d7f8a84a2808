# SPDX-License-Identifier: GPL-3.0-or-later
# The installed headers, and the common part of emitted ones, compile as C++17 without warnings under all flags that an engine may
# use, with every available compiler.
# usage: headers_test.sh NOOK SOURCE_FOLDER
set -u
headers=$2/libsamples/volume/runtime
block=$2/libsamples/methods/runtime
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/main.cpp" <<'EOT'
#include "nook_block.h"
#include "nook_volumes.h"
#include "nook_volumes_draw.h"
int main()
{
	nook_volumes::Volumes volumes;
	nook_volumes::Frame frame;
	nook_volumes::Camera camera;
	const bool refused = volumes.open("glTF", 4) != nullptr && frame.set(volumes.header(), camera) != nullptr;
	nook_block block;
	const float projection[16] = {};
	return refused && nook_fill(block, projection, nook_settings()) != nullptr ? 0 : 1;
}
EOT
if grep -nE 'docs/|[a-z]\.md\b|libsamples|[a-z]\.glsl' "$headers"/*.h; then
	echo "FAILED: found a file of nook's repository named in a header that engines get"
	exit 1
fi
compilers=0
failed=0
for compiler in g++ clang++; do
	command -v "$compiler" >/dev/null || continue
	compilers=$((compilers + 1))
	for standard in c++17 c++20; do
		"$compiler" -std=$standard -Werror -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion -Wshadow \
			-Wold-style-cast -Wcast-qual -Wformat=2 -Wnon-virtual-dtor -Wundef -I "$headers" -I "$block" "$folder/main.cpp" -o "$folder/main" &&
			"$folder/main" || { echo "FAILED: $compiler -std=$standard"; failed=1; }
	done
done
[ "$compilers" -gt 0 ] || { echo "FAILED: found no g++ and no clang++, expected one of them"; failed=1; }
exit $failed
