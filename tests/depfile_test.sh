# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: depfile_test.sh PROGRAM. Difficult file names for GNU Make and Ninja, as inputs and outputs: either both tools depend on
# exactly that file, or nook rejects the name and writes nothing.
set -u
nook=$1
. "$(dirname "$0")/table.sh"
ninja=$(command -v ninja || command -v ninja-build)
if ! command -v make >/dev/null || [ -z "$ninja" ]; then
	echo "SKIPPED: found no make or no ninja"
	exit 77
fi
mkdir "$folder/work" && cd "$folder/work" || exit

# A level that reads $input: as its buffer, or as the level itself if a \ in the buffer's name would become a /.
level()
{
	file=level.gltf
	buffer=$input
	case $input in
	*\\*) file=$input buffer=in.bin ;;
	esac
	uri=$(printf '%s' "$buffer" | od -An -v -tx1 | tr -d ' \n' | sed 's/../%&/g')
	printf '{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"%s"}]}\n' "$uri" >"$file"
	zero='\000\000\000\000'
	one='\000\000\200\077'
	# shellcheck disable=SC2059
	printf "$zero$zero$zero$one$zero$zero$zero$one$zero" >"$buffer"
}

# With $output made and dep.d: Make considers $output outdated once $input is newer.
make_depends()
{
	echo 'include dep.d' >Makefile
	touch -d 2001-01-01T00:00:00 ./*
	touch -d 2002-01-01T00:00:00 "./$output"
	make -q -- "$output" || return
	touch -d 2003-01-01T00:00:00 "./$input"
	make -n --debug=b -- "$output" | grep -qF "Prerequisite '$input' is newer than target '$output'"
}

# Ninja, which reads dep.d when it makes $output: nothing to do, until $input is newer.
ninja_depends()
{
	# shellcheck disable=SC2016
	printf 'rule make\n command = cp dep.d taken.d && touch "./$$output"\n depfile = taken.d\n deps = gcc\nbuild %s: make\n' \
		"$(printf '%s' "$output" | sed 's/[$ :]/$&/g')" >build.ninja
	export output
	touch -d 2001-01-01T00:00:00 ./*
	"$ninja" && "$ninja" -n | grep 'no work to do' || return
	touch -d 2100-01-01T00:00:00 "./$input"
	"$ninja" -n >../rest && ! grep 'no work to do' ../rest
}

# hold INPUT OUTPUT, refuse INPUT OUTPUT: checks nook, and then the tools.
hold()
{
	input=$1
	output=$2
	checks=$((checks + 1))
	rm -rf ./* .ninja*
	level
	"$nook" level "$file" -o "$output" --depfile dep.d 2>../stderr || problem "'$input', '$output': $(cat ../stderr)"
	make_depends >../log 2>&1 || problem "'$input', '$output': Make: $(cat ../log dep.d)"
	ninja_depends >../log 2>&1 || problem "'$input', '$output': Ninja: $(cat ../log dep.d)"
}
refuse()
{
	input=$1
	output=$2
	checks=$((checks + 1))
	rm -rf ./* .ninja*
	level
	before=$(ls -A)
	"$nook" level "$file" -o "$output" --depfile dep.d 2>../stderr
	found=$?
	[ "$found" -eq 5 ] || problem "'$input', '$output': exit code $found, expected 5: $(cat ../stderr dep.d)"
	[ "$(wc -l <../stderr)" -eq 1 ] || problem "'$input', '$output': found '$(cat ../stderr)', expected one line"
	[ "$(ls -A)" = "$before" ] || problem "'$input', '$output': left behind '$(ls -A)'"
	"$nook" level "$file" -o "$output" || problem "'$input', '$output': found it refused without --depfile"
}

odd=$(printf 'a\351\377b')
for name in 'plain' 'a b' ' ab' 'a  b' 'a#b' '#' 'a$b' '$(shell touch made)' '$$' 'a%b' 'a(b' '(' 'a!b' 'a@b' 'a+b,c' 'a]b' 'a{b}' 'a~b' \
	'a:b' 'a\b' 'a\\b' 'a\ b' 'a\\ b' "$odd" 'export x'; do
	hold "$name.gltf" out.glb
	[ "${name#*%}" = "$name" ] && hold in.bin "$name.glb"
done
for name in 'a
b' 'a	b' 'a"b' "a'b" 'a&b' 'a*b' 'a;touch made' 'a<b' 'a=b' 'a!=touch made' 'a>b' 'a?b' 'a[b]' 'a^b' 'a`b' 'a|b' '~' '~root' 'a\#b' 'a\:b' 'a\$b'; do
	refuse "$name.gltf" out.glb
	refuse in.bin "$name.glb"
done
hold '-a.bin' out.glb
refuse in.bin 'a%b.glb'
for name in 'a ' 'a:' 'a(b)' 'a)'; do
	refuse "$name" out.glb
done
finish
