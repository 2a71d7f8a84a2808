# SPDX-License-Identifier: GPL-3.0-or-later
# --cache of verbs that keep units: a run that is killed at any moment goes on, with the same bytes; files of no use are said and made anew.
# usage: unit_cache_test.sh NOOK
set -u
nook=$1
here=$(cd "$(dirname "$0")" && pwd)
. "$here/command_line.sh"

# counts: "MADE KEPT" of the last line on stderr.
counts()
{
	sed -n 's/^nook: \([0-9]*\) units made, \([0-9]*\) from the cache$/\1 \2/p' ../stderr
}

# cached 'REGEX' ARGUMENTS: works with a cache; REGEX is what it says before the counts, or empty.
cached()
{
	regex=$1
	shift
	checks=$((checks + 1))
	"$nook" "$@" --cache kept_cache >../stdout 2>../stderr </dev/null || problem "nook $*: $(cat ../stderr)"
	lines=$([ -z "$regex" ] && echo 1 || echo 2)
	[ "$(wc -l <../stderr)" -eq "$lines" ] || problem "nook $*: found '$(cat ../stderr)', expected $lines lines"
	[ -z "$regex" ] || head -n 1 ../stderr | grep -Eq -e "^nook: cache: $regex" || problem "nook $*: found '$(cat ../stderr)', expected '$regex'"
}

# killed ARGUMENTS: ended with -9 as soon as something is kept.
killed()
{
	"$nook" "$@" --cache kept_cache >/dev/null 2>&1 </dev/null &
	pid=$!
	until [ -n "$(ls kept_cache 2>/dev/null | grep 'part$')" ] || ! kill -0 $pid 2>/dev/null; do sleep 0.05; done
	kill -9 $pid 2>/dev/null
	wait $pid 2>/dev/null
}

# goes_on NAME ARGUMENTS: killed and started again it makes the bytes of a run without a cache, from what was done.
goes_on()
{
	file=$1
	shift
	rm -rf kept_cache
	"$nook" "$@" -o "kept_plain_$file" >../stdout 2>../stderr </dev/null || problem "nook $*: $(cat ../stderr)"
	killed "$@" -o "kept_$file"
	[ ! -e "kept_$file" ] || problem "$file: it had ended before it was killed"
	cached '' "$@" -o "kept_$file"
	[ "$(counts | cut -d' ' -f2)" -gt 0 ] || problem "nook $*: found nothing in the cache: $(cat ../stderr)"
	cmp "kept_plain_$file" "kept_$file" || problem "$file: other bytes than without a cache"
	cached '' "$@" --threads 1 -o "kept_$file"
	[ "$(counts | cut -d' ' -f1)" -eq 0 ] || problem "nook $*: found all done and units made: $(cat ../stderr)"
	cmp "kept_plain_$file" "kept_$file" || problem "$file: other bytes from the cache alone"
}

"$nook" level builtin:cornell -o kept_level.glb
goes_on v.glb volumes builtin:cave:6000 --distance 2 --trim 0.15 --detail auto --compensate --drop-hidden
goes_on b.glb bake builtin:courtyard --radius 1 --rays 64
"$nook" gbuffer builtin:suburb --camera auto:1 --size 320x180 -o kept_g.exr
goes_on r.exr reference builtin:suburb --gbuffer kept_g.exr --radius 1 --rays 1024
goes_on s.md stress --cases 2000000
# Units that are few or short: all are kept, and taken.
taken()
{
	ending=$1
	shift
	rm -rf kept_cache
	cached '' "$@" -o "kept_once$ending"
	made=$(counts | cut -d' ' -f1)
	cached '' "$@" -o "kept_twice$ending"
	[ "$made" -gt 0 ] && [ "$(counts)" = "0 $made" ] || problem "nook $*: found '$(counts)' the second time, expected '0 $made'"
	diff -r "kept_once$ending" "kept_twice$ending" || problem "nook $*: other bytes from the cache"
	rm -r "kept_once$ending" "kept_twice$ending"
}
taken .recipes.json fit builtin:cornell --methods statvo,slices --views 1 --size 16x9 --rays 4
taken .html report noise --max-count 2 --starts 1 --seeds 1
taken .patterns catalogue --domain disk --counts 1-3

# Files of no use: cut, changed, of another version, made from other bytes of an input, and no file of ours.
what='volumes kept_level.glb --distance 0.3 --drop-hidden'
rm -rf kept_cache
cached '' $what -o kept_first.glb
part=$(ls kept_cache/*.part)
cp "$part" kept_whole
for size in 0 30 100 $(($(wc -c <kept_whole) - 1)); do
	head -c "$size" kept_whole >"$part"
	cached "$part: found .*: it is made anew" $what -o kept_second.glb
	[ "$(counts | cut -d' ' -f2)" -eq 0 ] || problem "cut to $size bytes: found units in it"
	cmp kept_first.glb kept_second.glb || problem "cut to $size bytes: other bytes"
done
tr '\001' '\002' <kept_whole >"$part"
cached "$part: found a part that was cut short or changed" $what -o kept_second.glb
cmp "$part" kept_whole || problem "a file that was changed is not made anew"
"$nook" level builtin:nulls -o kept_level.glb
cached "$part: found it made from other bytes of kept_level.glb" $what -o kept_second.glb
"$nook" $what -o kept_plain.glb >/dev/null
cmp kept_plain.glb kept_second.glb || problem "another level: other bytes than without a cache"
"$nook" level builtin:cornell -o kept_level.glb

echo text >kept_file
fails 2 'kept_file: found a file, expected a folder' $what --cache kept_file -o v.glb
fails 2 'no_folder/cache: found .*, expected a folder' $what --cache no_folder/cache -o v.glb
fails 1 '--cache: found with --part' $what --cache kept_cache --part 1/2 -o 1.part
there

finish
