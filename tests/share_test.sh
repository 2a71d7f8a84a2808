# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: share_test.sh PROGRAM. A command in shares, in any order, killed or not, and then without --share: the bytes of a run without a
# cache. Results that are damaged, or of other inputs, are made again.
set -u
nook=$1
. "$(dirname "$0")/command_line.sh"

# counts: "MADE FOUND" of the last line on stderr.
counts()
{
	sed -n 's/^nook: \([0-9]*\) results made, \([0-9]*\) from the cache$/\1 \2/p' ../stderr
}

# cached ARGUMENTS: works with a cache.
cached()
{
	"$nook" "$@" --cache kept_cache >../stdout 2>../stderr </dev/null || problem "nook $*: $(cat ../stderr)"
}

# shares 'COUNTS' 'ENDINGS' ARGUMENTS: outputs of these endings, the summary and what is printed are those of a run without a cache.
shares()
{
	numbers=$1
	endings=$2
	shift 2
	outputs=
	for ending in $endings; do
		outputs="$outputs -o a$ending"
	done
	# shellcheck disable=SC2086 # words
	"$nook" "$@" $outputs --json a.json >../single_stdout 2>../stderr || problem "nook $*: $(cat ../stderr)"
	mkdir ../single && mv a* ../single
	for n in $numbers; do
		rm -rf kept_cache
		for k in $(seq "$n" -1 1); do
			# shellcheck disable=SC2086
			cached "$@" $outputs --json a.json --share "$k/$n" --threads $((1 + k % 2))
			[ ! -s ../stdout ] || problem "nook $* --share $k/$n: found '$(cat ../stdout)' printed, expected nothing"
			there
		done
		# shellcheck disable=SC2086
		cached "$@" $outputs --json a.json --threads 2
		same ../stdout ../single_stdout "nook $*, $n shares: other lines than in one run"
		for file in $(cd ../single && find . -type f); do
			same "$file" "../single/$file" "nook $*, $n shares: $file: other bytes than in one run"
		done
		rm -r a*
		# shellcheck disable=SC2086
		cached "$@" $outputs --json a.json --threads 1
		[ "$(counts | cut -d' ' -f1)" = 0 ] || problem "nook $*, again: found '$(counts)', expected no results made"
		diff -r ../single . >../diff 2>&1
		grep -q -e differ -e 'Only in ../single' ../diff && problem "nook $*, from the cache alone: $(cat ../diff)"
		rm -r a*
	done
	rm -r ../single
}

works '' gbuffer builtin:cornell --camera main --size 40x24 -o kept_g.exr
printf '0,1,0,0,1,0\n0.5,1,0,0,1,0\n-0.5,0.5,0.2,0,1,0\n' >kept_points.csv
shares '1 7' .glb volumes builtin:suburb --distance 1
shares 2 .glb volumes builtin:heightfield:150 --distance 1 --compensate --trim 0.1 --verify --detail auto
shares '2 7' .glb bake builtin:suburb --radius 1 --rays 16
shares 2 .glb bake builtin:cornell --radius 1 --rays 16 --fit points --color
shares 2 .glb bake builtin:foliage --radius 0.5 --rays 2 --bent
works '' volumes builtin:cornell --distance 1 -o kept_v.glb
shares 2 .glb bake builtin:cornell --radius 1 --rays 16 --volumes kept_v.glb
shares 3 '.ktx2 .glsl' bake builtin:cornell --radius 1 --probes 0.5 --rays 48
shares 2 .recipes.json fit builtin:cornell --methods statvo,vo-line,slices --views 1 --size 16x9 --rays 4
shares '2 7' '.exr .png' reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 16
shares 7 .exr reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 64 --max-error 0.05 --falloff linear
shares 2 .csv reference builtin:cornell --points kept_points.csv --radius 1 --rays 16
shares '2 7' '.exr .png' reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 16 --measure bent
shares 2 .html report noise --max-count 3 --starts 1 --seeds 1
shares '2 7' .patterns catalogue --domain disk --counts 1-4 --tiles

# Times are measured once, in the shares: the report has theirs, and the errors, limits and flicker of any run.
set -- report error builtin:cornell --grid quick --methods statvo,sao,bake,rays --size 16x9 --rays 4 --repetitions 1 --shifts 2 --pictures 2 \
	--device cpu
errors()
{
	grep -E '"(candidate|rmse|eq14|flip|ssim|reference_error|mean_visibility|thickness|strength|power|facing)"' "$1"
}
"$nook" "$@" --json kept_single.json 2>../stderr || problem "nook $*: $(cat ../stderr)"
n=3
rm -rf kept_cache
for k in $(seq "$n"); do
	cached "$@" --json a.json --share "$k/$n"
	there
done
cached "$@" -o a.html --json a.json --threads 1
errors a.json >../errors
errors kept_single.json | cmp - ../errors || problem "report error, $n shares: other errors than in one run"
cached "$@" --json b.json --threads 1
[ "$(counts | cut -d' ' -f1)" = 0 ] || problem "report error, again: found '$(counts)', expected no results made"
same a.json b.json "report error, again: other bytes from the same results"
there a.html a.json b.json

# killed ARGUMENTS: ended with -9 as soon as something is kept.
killed()
{
	"$nook" "$@" --cache kept_cache >/dev/null 2>&1 </dev/null &
	pid=$!
	until [ "$(find kept_cache -type f 2>/dev/null | head -n 3 | wc -l)" -eq 3 ] || ! kill -0 $pid 2>/dev/null; do sleep 0.02; done
	kill -9 $pid 2>/dev/null
	wait $pid 2>/dev/null
}

# continues NAME ARGUMENTS: killed and started again it makes the bytes of a run without a cache, from what was done.
continues()
{
	file=$1
	shift
	rm -rf kept_cache
	"$nook" "$@" -o "../plain_$file" >../stdout 2>../stderr </dev/null || problem "nook $*: $(cat ../stderr)"
	killed "$@" -o "$file"
	[ ! -e "$file" ] || problem "$file: it had ended before it was killed"
	cached "$@" -o "$file"
	[ "$(counts | cut -d' ' -f2)" -gt 0 ] || problem "nook $*: found nothing in the cache: $(cat ../stderr)"
	same "../plain_$file" "$file" "$file: other bytes than without a cache"
	there "$file"
}
continues v.glb volumes builtin:cave:1000 --distance 2 --trim 0.15 --detail auto --compensate
continues b.glb bake builtin:courtyard --radius 1 --rays 64
"$nook" gbuffer builtin:suburb --camera auto:1 --size 240x136 -o kept_h.exr
continues r.exr reference builtin:suburb --gbuffer kept_h.exr --radius 1 --rays 512

# Two writers at once; the order of options is no part of a command; more shares than there is to do.
rm -rf kept_cache
reference='reference builtin:cornell --radius 1 --rays 16'
"$nook" $reference --gbuffer kept_g.exr -o ../single.exr
for k in 1 2; do
	"$nook" $reference --gbuffer kept_g.exr --cache kept_cache -o a$k.exr 2>../stderr$k &
done
wait
same a1.exr ../single.exr 'two writers: other bytes'
same a2.exr ../single.exr 'two writers: other bytes'
rm a1.exr a2.exr
cached reference --gbuffer=kept_g.exr --rays 16 builtin:cornell --radius 1 -o a.exr
[ "$(counts | cut -d' ' -f1)" = 0 ] || problem "options in another order: found '$(counts)', expected no results made"
cached reference builtin:cornell --points kept_points.csv --radius 1 --rays 4 -o b.csv --share 100000/100000
there a.exr

# Results that are damaged are made again, in one line; those of other inputs are not seen.
"$nook" level builtin:cornell -o kept_level.glb >../stdout
what='volumes kept_level.glb --distance 0.3'
rm -rf kept_cache
cached $what -o kept_first.glb
for change in 'head -c 40' 'tr \000 \001' 'head -c 0'; do
	find kept_cache -type f ! -name '*.lock' | while read -r file; do
		$change <"$file" >../changed
		cp ../changed "$file"
	done
	cached $what -o kept_second.glb
	grep -q '^nook: cache: kept_cache/.*: found a value that was cut short or changed' ../stderr || problem "$change: $(cat ../stderr)"
	[ "$(wc -l <../stderr)" -eq 2 ] || problem "$change: found '$(cat ../stderr)', expected two lines"
	same kept_first.glb kept_second.glb "$change: other bytes"
done
"$nook" level builtin:nulls -o kept_level.glb >../stdout
"$nook" $what -o ../plain.glb >../stdout 2>../stderr
cached $what -o a.glb
same a.glb ../plain.glb 'another level of that name: other bytes than without a cache'
there a.glb

# A store that cannot be written: a share fails, a run that has all it needs does not.
"$nook" $reference --gbuffer kept_g.exr -o a.exr --cache kept_cache 2>../stderr
if [ "$(id -u)" != 0 ]; then
	chmod -R a-w kept_cache
	cached $reference --gbuffer kept_g.exr -o a.exr
	fails 2 'kept_cache/.*' $reference --gbuffer kept_g.exr --rays 17 -o b.exr --cache kept_cache --share 1/2
	chmod -R u+w kept_cache
fi
same a.exr ../single.exr 'a store that cannot be written: other bytes'
there a.exr
echo text >kept_file
fails 2 'kept_file: found a file, expected a folder' $what --cache kept_file -o v.glb
fails 2 'kept_file/cache: found .*, expected a folder' $what --cache kept_file/cache -o v.glb
for share in 0/3 4/3 1/0 1/1000000000 -1/3 1/-3 1.5/2 '1 /2' 1/2/3 1 / 1/ /2 x/y ''; do
	fails 1 "--share: found '$share', expected K/N, whole numbers with 1 <= K <= N <= 100000" $reference --gbuffer kept_g.exr -o a.exr \
		--cache kept_new --share "$share"
done
fails 1 '--share: found without --cache' $reference --gbuffer kept_g.exr -o a.exr --share 1/2
fails 1 '--share: found with --max-error' bake builtin:cornell --radius 1 --max-error 0.1 --cache kept_new --share 1/2 -o a.glb
fails 1 '--share: found with --no-drop and without --compensate' volumes builtin:cornell --distance 1 --no-drop --cache kept_new --share 1/2 \
	-o a.glb
fails 1 'The following argument was not expected: --share' level builtin:cornell --share 1/2 -o a.glb
finish
