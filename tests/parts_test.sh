# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: parts_test.sh PROGRAM. Parts of a command, merged in any order, are the single run byte for byte; what is no part of it, missing,
# doubled or changed is refused by name.
set -u
nook=$1
. "$(dirname "$0")/command_line.sh"

# makeParts N ARGUMENTS: kept_1.part to kept_N.part, the last first, one thread and two by turns; every third keeps nothing for the others.
makeParts()
{
	of=$1
	shift
	k=$of
	while [ "$k" -gt 0 ]; do
		folder=../shared
		[ $((k % 3)) -ne 0 ] || folder=
		NOOK_DECODED=$folder "$nook" "$@" --part "$k/$of" --threads $((1 + k % 2)) -o "kept_$k.part" >../stdout 2>../stderr ||
			problem "nook $* --part $k/$of: $(cat ../stderr)"
		k=$((k - 1))
	done
}

# parts N: their names in an order without order, the same each time.
parts()
{
	seq "$1" | shuf --random-source="$nook" | sed 's/.*/kept_&.part/'
}

# divides 'COUNTS' 'ENDINGS' ARGUMENTS: outputs of these endings, and the summary, are those of the single run.
divides()
{
	counts=$1
	endings=$2
	shift 2
	outputs=
	for ending in $endings; do
		outputs="$outputs -o a$ending"
	done
	# shellcheck disable=SC2086 # words
	"$nook" "$@" $outputs --json a.json >../single_stdout 2>../stderr || problem "nook $*: $(cat ../stderr)"
	mkdir ../single && mv a* ../single
	for n in $counts; do
		mkdir ../shared
		makeParts "$n" "$@"
		cp "kept_$n.part" ../again.part
		rm "kept_$n.part" # killed, say
		"$nook" "$@" --part "$n/$n" -o "kept_$n.part" >../stdout 2>../stderr
		same "kept_$n.part" ../again.part "nook $* --part $n/$n: another file the second time"
		# shellcheck disable=SC2086,SC2046
		NOOK_DECODED=../shared "$nook" merge $(parts "$n") $outputs --json a.json --threads 2 >../stdout 2>../stderr ||
			problem "nook merge of $n parts of nook $*: $(cat ../stderr)"
		rm -r ../shared
		same ../stdout ../single_stdout "nook merge of $n parts of nook $*: other lines than in one run"
		for file in $(cd ../single && find . -type f); do
			same "$file" "../single/$file" "nook merge of $n parts of nook $*: $file: other bytes than in one run"
		done
		rm -r a*
		[ "$n" = 3 ] || rm kept_*.part
	done
	rm -r ../single
}

works '' gbuffer builtin:cornell --camera main --size 40x24 -o kept_g.exr
printf '0,1,0,0,1,0\n0.5,1,0,0,1,0\n-0.5,0.5,0.2,0,1,0\n' >kept_points.csv
divides '1 2 7 16' .glb volumes builtin:suburb --distance 1
divides 2 .glb volumes builtin:heightfield:2000 --distance 1 --drop-hidden --compensate --trim 0.1 --verify
divides '1 2 7' .glb bake builtin:suburb --radius 1 --rays 16
divides 2 .glb bake builtin:cornell --radius 1 --rays 16 --fit points --color
divides 2 .glb bake builtin:foliage --radius 0.5 --rays 2 --bent
works '' volumes builtin:cornell --distance 1 -o kept_v.glb
divides 2 .glb bake builtin:cornell --radius 1 --rays 16 --volumes kept_v.glb
divides 3 '.ktx2 .glsl' bake builtin:cornell --radius 1 --probes 0.5 --rays 48
fails 1 '--part: found with --max-error' bake builtin:cornell --radius 1 --max-error 0.1 --part 1/2 -o a.part
divides 2 .recipes.json fit builtin:cornell --methods statvo,vo-line,slices --views 1 --size 16x9 --rays 4
fails 1 '--part: found with --no-drop and without --compensate' volumes builtin:cornell --distance 1 --no-drop --part 1/2 -o a.part
divides '1 2 7' '.exr .png' reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 16
divides 7 .exr reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 64 --max-error 0.05 --falloff linear
divides 2 .csv reference builtin:cornell --points kept_points.csv --radius 1 --rays 16
divides '2 7' '.exr .png' reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 16 --measure bent
divides '1 2 7 16' .md stress --cases 20000
divides '1 2 7' '' report noise --max-count 2 --starts 1 --seeds 1
divides 2 .html report noise --max-count 3 --starts 1 --seeds 1
divides '1 2 7' .patterns catalogue --domain disk --counts 1-4 --tiles

# Times are measured once, in the parts: a merge has theirs, whatever the order, and the errors, limits and flicker of any run. It draws
# nothing itself.
set -- report error builtin:cornell --grid quick --methods statvo,sao,aov,bake,rays --size 16x9 --rays 4 --repetitions 1 --shifts 2 --pictures 8 \
	--device cpu
errors()
{
	grep -E '"(candidate|rmse|eq14|flip|ssim|reference_error|mean_visibility|thickness|strength|power|facing)"' "$1"
}
# flickers JSON JSON: what was moved in both by other amounts; the best of each method is moved whatever the times.
flickers()
{
	awk '/"candidate":/ { name = $2 $3 $4 $5 $6 } /"flicker": [0-9]/ {
			if (name in found) { both++; if (found[name] != $2) print name, found[name], $2 }
			found[name] = $2
		}
		END { if (both < 3) print "found " both + 0 " candidates that were moved in both, expected 3 or more" }' "$@"
}
"$nook" "$@" --json kept_single.json 2>../stderr || problem "nook $*: $(cat ../stderr)"
for n in 2 7; do
	makeParts $n "$@"
	rm -f kept_first.json
	for order in "$(seq -f kept_%g.part $n)" "$(seq -f kept_%g.part $n -1 1)"; do
		# shellcheck disable=SC2086
		"$nook" merge $order -o a.html --json a.json --threads 1 2>../stderr || problem "nook merge $order: $(cat ../stderr)"
		grep -q '^nook: 0 measurements made' ../stderr || problem "nook merge of report error: $(cat ../stderr), expected 0 measurements"
		errors a.json >../errors
		errors kept_single.json | cmp - ../errors || problem "nook merge of report error: other errors than in one run"
		found=$(flickers kept_single.json a.json)
		[ -z "$found" ] || problem "nook merge of report error: flicker: $found"
		[ -f kept_first.json ] || cp a.json kept_first.json
		same a.json kept_first.json "nook merge $order: other bytes than in another order"
		rm a.html a.json
	done
	rm kept_*.part
done

# The order of options is no part of a command; N may be more than there is to do.
"$nook" reference --rays 4 --gbuffer kept_g.exr builtin:cornell --radius 1 --part 1/2 -o kept_1.part
"$nook" reference builtin:cornell --radius 1 --gbuffer=kept_g.exr --rays 4 --part 2/2 -o kept_2.part --threads 1
works '' merge kept_2.part kept_1.part -o a.png
there a.png
works '^part: 2 of 2$' info kept_2.part --json a.json
there a.json
works '' reference builtin:cornell --points kept_points.csv --radius 1 --rays 4 --part 100000/100000 -o a.part
there a.part

# What all parts need is made once where a folder keeps it: the same bytes with it, of parts that begin at once, and where files in it are
# damaged.
kept()
{
	cp kept_suburb.glb kept_level.glb
	mkdir kept_decoded ../plain
	for k in 1 2; do
		"$nook" "$@" --part $k/2 -o ../plain/kept_$k.part
	done
	decodes kept_decoded 'none yet' "$@"
	checks=$((checks + 1))
	[ "$(find kept_decoded -name '*.decoded' | wc -l)" -eq "$files" ] || problem "NOOK_DECODED, $*: found '$(ls kept_decoded)', expected $files"
	before=$(ls -i kept_decoded/*.decoded)
	decodes kept_decoded kept "$@"
	checks=$((checks + 1))
	[ "$(ls -i kept_decoded/*.decoded)" = "$before" ] || problem "NOOK_DECODED, $*: found other files, expected those that were kept to be taken"
	for file in kept_decoded/*.decoded; do
		printf X | dd of="$file" bs=1 seek=100 conv=notrunc 2>../stderr
	done
	decodes kept_decoded damaged "$@"
	for file in kept_decoded/*.decoded; do
		: >"$file"
	done
	decodes kept_decoded empty "$@"
	decodes closed/none 'no folder' "$@"
	cp kept_box.glb kept_level.glb
	for k in 1 2; do
		"$nook" "$@" --part $k/2 -o ../plain/kept_$k.part
	done
	decodes kept_decoded 'another level of that name' "$@"
	rm -r kept_decoded ../plain kept_level.glb
}
decodes()
{
	folder=$1
	what=$2
	shift 2
	for k in 1 2; do
		NOOK_DECODED=$folder "$nook" "$@" --part $k/2 -o kept_$k.part &
	done
	wait
	for k in 1 2; do
		same kept_$k.part ../plain/kept_$k.part "NOOK_DECODED, $what: nook $*: part $k: other bytes"
	done
}
"$nook" level builtin:suburb -o kept_suburb.glb >../stdout
"$nook" level builtin:cornell -o kept_box.glb >../stdout
files=3 # a picture, masks, a level
kept reference kept_level.glb --gbuffer kept_g.exr --radius 1 --rays 4
files=4 # masks, a level, its polygons, its sides
kept volumes kept_level.glb --distance 1
# K and N.
for part in 0/3 4/3 1/0 1/1000000000 -1/3 1/-3 1.5/2 '1 /2' 1/2/3 1 / 1/ /2 x/y ''; do
	fails 1 "--part: found '$part', expected K/N, whole numbers with 1 <= K <= N <= 100000" stress --cases 100 --part "$part" -o a.part
done
fails 1 '--part: found no output, expected -o NAME.part alone' stress --cases 100 --part 1/2
fails 1 '--part: found several outputs, expected -o NAME.part alone' stress --cases 100 --part 1/2 -o a.part -o b.part
fails 1 '--part: found --json, expected -o NAME.part alone' stress --cases 100 --part 1/2 -o a.part --json a.json
fails 1 'a.md: found the ending .md, expected one of .part' stress --cases 100 --part 1/2 -o a.md
fails 1 '--case: found with -o, --json, --progress or --part' stress --kernel prism --case 1 --part 1/2 -o a.part
fails 2 'closed/none/a.part: ' stress --cases 100 --part 1/2 -o closed/none/a.part
fails 1 'The following argument was not expected: --part' level builtin:cornell --part 1/2 -o a.part

# What is missing, doubled, or of something else.
makeParts 4 stress --cases 2000
"$nook" stress --cases 2001 --part 2/4 -o kept_other.part
"$nook" stress --cases 2000 --part 2/5 -o kept_five.part
fails 3 'merge: found 2 of 4 parts, expected all; missing: 1, 3' merge kept_4.part kept_2.part -o a.md
fails 3 'kept_2.part: found part 2/4 again, which kept_2.part is, expected it once' merge kept_[1-4].part kept_2.part -o a.md
fails 3 "kept_other.part: found a part of 'nook stress --cases 2001', expected 'nook stress --cases 2000' as kept_1.part" \
	merge kept_1.part kept_other.part kept_3.part kept_4.part -o a.md
fails 3 'kept_five.part: found part 2/5, expected one of 4 as kept_1.part' merge kept_1.part kept_five.part kept_3.part kept_4.part -o a.md
fails 1 'PARTS is required' merge -o a.md
fails 2 'kept_none.part: ' merge kept_none.part -o a.md
fails 3 'kept_g.exr: found no part of a command' merge kept_g.exr -o a.md
fails 1 'kept_1.part: named twice' merge kept_[1-4].part -o kept_1.part
fails 1 'a.exr: found the ending .exr, expected one of .md' merge kept_[1-4].part -o a.exr

# Cut short, and a byte of another program's version.
size=$(wc -c <kept_2.part)
for cut in 0 1 20 60 $((size / 2)) $((size - 1)); do
	head -c "$cut" kept_2.part >kept_cut.part
	fails 3 'kept_cut.part: found (no part of a command|a part that was cut short or changed)' merge kept_1.part kept_cut.part kept_3.part kept_4.part -o a.md
done
(cat kept_2.part && echo) >kept_cut.part
fails 3 'kept_cut.part: found a part that was cut short or changed' merge kept_1.part kept_cut.part kept_3.part kept_4.part -o a.md

# Inputs that change in between.
makeParts 2 reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 4
cp kept_g.exr kept_before.exr
"$nook" gbuffer builtin:cornell --camera main --size 41x24 -o kept_g.exr
fails 3 'kept_g.exr: found other bytes than kept_1.part was made from' merge kept_1.part kept_2.part -o a.png
"$nook" reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 4 --part 2/2 -o kept_2.part
fails 3 'kept_2.part: found it made from other bytes of kept_g.exr than kept_1.part' merge kept_1.part kept_2.part -o a.png
cp kept_before.exr kept_g.exr
"$nook" reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 4 --part 2/2 -o kept_2.part
works '' merge kept_1.part kept_2.part -o a.png
there a.png
finish
