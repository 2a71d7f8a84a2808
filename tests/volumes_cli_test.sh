# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: volumes_cli_test.sh PROGRAM. nook volumes, and what nook info reports about its files.
set -u
nook=$1
. "$(dirname "$0")/command_line.sh"

works '--distance' volumes --help
works '"polygons": ' volumes builtin:cornell --distance 0.5 --json -
works '' volumes builtin:cornell --distance 0.5 -o v.glb --json v.json
works '^volumes: polygons$' info v.glb
works '^distance: 0[.]5 m' info v.glb
works '"level": "builtin:cornell"' info v.glb --json -
# The summary when a file is made agrees with nook info.
for field in polygons clusters corners bytes quantisation_error_m plane_error_m distance_m ray_distance_m file_triangles; do
	made=$(grep "^	\"$field\":" v.json)
	found=$("$nook" info v.glb --json - | grep "^	\"$field\":")
	[ -n "$made" ] && [ "${made%,}" = "${found%,}" ] || problem "$field: found '$found' in the file, expected '$made'"
done
there v.glb v.json
works '^volumes: [0-9]' volumes builtin:cornell --distance 0.5 -o v.glb
works '^volumes: polygons' info v.glb
there v.glb

# field NAME: its value in ../stdout, a summary.
field()
{
	sed -n "s/^\t\"$1\": \(.*[^,]\),*\$/\1/p" ../stdout
}
# more NAME THAN BY WHAT: of two numbers, the first is at least BY times the second.
more()
{
	awk -v a="$1" -v b="$2" -v by="$3" 'BEGIN { exit !(a >= by * b && b > 0) }' || problem "$4: found $1 against $2, expected $3 times as much"
}

# Layouts and compression.
size()
{
	works '' volumes builtin:foliage --distance 0.5 "$@" --no-drop --json - -o v.glb
	bytes=$(wc -c <v.glb)
	rm -f v.glb
}
size --layout polygons; plain=$bytes
size --layout polygons --compress; more "$plain" "$bytes" 1.05 "polygons, compressed"
size --layout prisms; prisms=$bytes; more "$prisms" "$plain" 1.5 "prisms"
size --layout prisms --compress; more "$prisms" "$bytes" 1.1 "prisms, compressed"

# Each option has an effect.
works '' volumes builtin:suburb --distance 1.5 --no-drop --json -
cut=$(field polygons)
works '' volumes builtin:suburb --distance 1.5 --no-drop --extent none --json -
uncut=$(field polygons)
more "$cut" "$uncut" 1.1 "cutting at twice the distance, against --extent none"
works '' volumes builtin:cornell --distance 0.5 --no-drop --json -
all=$(field polygons)
works '' volumes builtin:cornell --distance 0.5 --no-drop --no-merge --json -
more "$(field polygons)" "$all" 1.5 "--no-merge"
works '' volumes builtin:cornell --distance 0.5 --json -
more "$all" "$(field polygons)" 1.05 "dropping"
works '' volumes builtin:cornell --distance 0.5 --no-drop --sides two-sided --json -
two_sided=$(field polygons_two_sided)
more "$two_sided" "$all" 1 "--sides two-sided"
works '' volumes builtin:cornell --distance 0.5 --no-drop --sides oriented --json -
[ "$(field polygons_two_sided)" = 0 ] || problem "--sides oriented: found $(field polygons_two_sided) two-sided, expected 0"
works '' volumes builtin:cornell --distance 0.5 --compensate --verify --json -
more "$(field verify_receivers)" 1 1000 "--verify"
more "$(field compensate_receivers)" 1 1000 "--compensate"
works '"detail_trials": ' volumes builtin:cave:2000 --distance 2 --detail auto:0.2 --json -
works '"detail_trials": ' volumes builtin:cave:20000 --distance 2 --masks --detail auto --json -
# rmse DETAIL: the error of that trial.
rmse()
{
	sed -n "s/.*\"detail\": $1, .*\"rmse_fitted\": \([0-9.e-]*\) .*/\1/p" ../stdout
}
awk "BEGIN { all = $(rmse 0.0); chosen = $(rmse "$(field detail)"); exit !(chosen > 0 && (chosen <= 1.25 * all || chosen <= 0.012)) }" ||
	problem "--masks --detail auto: found an RMSE of $(rmse "$(field detail)"), expected at most a quarter above $(rmse 0.0), or 0.012"
works '"ray_distance_m": 0.5' volumes builtin:cornell --distance 0.5 --masks -o v.glb --json -
rm v.glb
fails 1 '--masks: found' volumes builtin:cornell --distance 0.5 --masks --compensate
works '"compensate_refused": 0' volumes builtin:cornell --distance 0.5 --compensate --compensate-measure rmse --json -
works '^in [0-9]+ views kept out of the fit: RMSE ' volumes builtin:cornell --distance 0.5 --compensate -o k.glb
rm k.glb
fails 1 '--compensate-measure: found without --compensate' volumes builtin:cornell --distance 0.5 --compensate-measure rmse
works '' volumes builtin:cornell --distance 0.5 --ray-distance 0.7 -o v.glb
works '"ray_distance_m": 0.7$|"ray_distance_m": 0.7,' info v.glb --json -
rm v.glb
works '' volumes builtin:cornell --distance 0.5 --exact-bounds --layout prisms --compress -o v.glb --json -
works '"exact_bounds": 1' info v.glb --json -
works '^volumes: prisms, compressed' info v.glb
rm v.glb

# Level files in the depfile; the same bytes for any number of threads.
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n' >kept.obj
works '' volumes kept.obj --distance 1 --no-drop -o v.glb --depfile v.d --threads 1
grep -q 'kept.obj$' v.d || problem "v.d: found '$(cat v.d)', expected kept.obj in it"
mv v.glb kept_v.glb
works '' volumes kept.obj --distance 1 --no-drop -o v.glb --threads 3
same v.glb kept_v.glb "threads: different bytes"
there v.d v.glb
for threads in 1 3; do
	works '' volumes builtin:suburb --distance 1 --compensate --drop-below 1/512 --trim 0.05 --verify --threads $threads -o s$threads.glb --json s$threads.json
done
same s1.glb s3.glb "threads: different bytes of the suburb"
same s1.json s3.json "threads: different figures of the suburb"
rm s1.glb s3.glb s1.json s3.json
works '"quantisation_error_m": 0' volumes kept.obj --distance 1 --no-drop --json -

# Bad input.
fails 1 '--distance' volumes builtin:cornell -o v.glb
for distance in 0 -1 nan inf 1e999 x ''; do
	fails 1 "--distance: found '" volumes builtin:cornell --distance "$distance" -o v.glb
done
fails 1 '--layout: found .cubes., expected polygons or prisms' volumes builtin:cornell --distance 1 --layout cubes -o v.glb
for share in 0 -1 1/0 0/1 2 1/x nan 1/512/2; do
	fails 1 "--drop-below: found '" volumes builtin:cornell --distance 1 --drop-below $share -o v.glb
done
fails 1 '--detail: found .0., expected a share above 0' volumes builtin:cornell --distance 1 --detail auto:0 -o v.glb
fails 1 '--detail: found .automatic., expected a share above 0' volumes builtin:cornell --distance 1 --detail automatic -o v.glb
fails 1 '--detail: found .1., expected a share above 0, below 1' volumes builtin:cornell --distance 1 --detail 1 -o v.glb
fails 1 '--flat: found .1., expected a share from 1e-6 to 0.05' volumes builtin:cornell --distance 1 --flat 1 -o v.glb
fails 1 '--extent: found .0., expected 0.1 or more' volumes builtin:cornell --distance 1 --extent 0 -o v.glb
fails 1 '--no-merge: found with --flat or --extent, expected one or the other' volumes builtin:cornell --distance 1 --flat 1e-3 --no-merge -o v.glb
fails 1 '--no-merge: found with --flat or --extent, expected one or the other' volumes builtin:cornell --distance 1 --extent 4 --no-merge -o v.glb
fails 1 '--sides: found' volumes builtin:cornell --distance 1 --sides none -o v.glb
fails 1 '--no-drop: found with' volumes builtin:cornell --distance 1 --no-drop --drop-below 1/512 -o v.glb
for box in 1 Outside outside,1 1,2,3,4,5 1,2,3,0,5,6 1,2,3,4,5,nan a,b,c,d,e,f 1,2,3,4,5,6,7; do
	fails 1 "--visible-from: found '$box'" volumes builtin:cornell --distance 1 --visible-from $box -o v.glb
done
for size in 0 -1 1TB x 9999999999GiB; do
	fails 1 "--memory: found '$size'" volumes builtin:cornell --distance 1 --memory $size -o v.glb
done
fails 4 '.*memory.*expected at most 300 MiB: about [0-9]* MiB without trim, which --degrade leaves out$' volumes builtin:suburb --distance 1 --compensate --trim 0.1 --memory 300MiB -o v.glb
fails 1 '--degrade: found without --memory, expected both' volumes builtin:cornell --distance 1 --degrade -o v.glb
"$nook" volumes builtin:suburb --distance 1 --trim 0.1 --memory 300MiB --degrade -o left.glb --json - >../stdout 2>../stderr ||
	problem "--degrade: exit code $?, expected the remaining steps to be made"
grep -q '"left_out": "trim"' ../stdout || problem "--degrade: found no left_out in the statement"
grep -q '^nook: warning: builtin:suburb: memory: .*expected at most 300 MiB: left out trim, which leaves about [0-9]* MiB$' ../stderr ||
	problem "--degrade: found no warning of what was left out"
there left.glb
fails 4 '.*memory.*expected at most 100 bytes' volumes builtin:suburb --distance 1 --memory 100 -o v.glb
fails 4 '.*memory.*MiB for [0-9]* polygons that an extent cuts to, expected at most 200 MiB' volumes builtin:cornell --distance 0.01 --extent 0.1 --memory 200MiB --degrade -o v.glb
fails 4 '.*memory.*expected at most 1 MiB: nook level --cells cuts it into parts' volumes builtin:suburb --distance 1 --memory 1MiB --degrade -o v.glb
fails 1 '.*v.obj: found the ending' volumes builtin:cornell --distance 1 -o v.obj
fails 1 '.*nothing to write' volumes builtin:cornell --distance 1
fails 1 'builtin: found .nothing.' volumes builtin:nothing --distance 1 -o v.glb
fails 2 'missing.obj' volumes missing.obj --distance 1 -o v.glb
printf 'v 0 0 0\n' >kept_none.obj
fails 3 'kept_none.obj' volumes kept_none.obj --distance 1 -o v.glb
"$nook" volumes kept.obj --distance 50 --no-drop -o v.glb >/dev/null 2>../stderr || problem "--distance 50: refused"
grep -q "^nook: warning: kept.obj: distance: found 50 m" ../stderr || problem "--distance 50: found '$(cat ../stderr)', expected a warning"

# A level whose volumes darken nothing gives an empty file and a warning.
rm -f v.glb
printf 'v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 4 3 2\n' >kept_plain.obj
"$nook" volumes kept_plain.obj --distance 1 --compensate --verify -o v.glb >/dev/null 2>../stderr || problem "a plain: refused: $(cat ../stderr)"
grep -q '^nook: warning: kept_plain.obj: volumes: found none' ../stderr || problem "a plain: found '$(cat ../stderr)', expected a warning"
works '^volumes: 0$' info v.glb
works '' gbuffer kept_plain.obj --eye 0.5,2,0.5 --target 0.5,0,0.6 --fov 40 --size 8x8 -o kept_g.exr
works '' shade kept_g.exr --method aov --volumes v.glb -o s.exr
works '' shade kept_g.exr --method aov-mask --volumes v.glb -o s.exr
rm -f v.glb s.exr
head -c 1000 kept_v.glb >kept_short.glb
fails 3 'kept_short.glb' info kept_short.glb
fails 1 '--unit: found with another' info kept_v.glb --unit 2

# Parts: only occluders get volumes, and those that darken no receiver go.
{
	printf 'o Floor\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\nf 1 2 3 4\no Wall\nv -2 0 -1\nv 2 0 -1\nv 2 2 -1\nv -2 2 -1\nf 5 6 7 8\n'
	printf 'o Shelf\nv 8 0 0\nv 9 0 0\nv 9 1 0\nv 8 1 0\nv 8 0 0.1\nv 9 0 0.1\nv 9 1 0.1\nv 8 1 0.1\nf 9 10 11 12\nf 13 14 15 16\n'
} >kept_parts.obj
# polygons EXPECTED ARGUMENTS: of the file.
polygons()
{
	expected=$1
	shift
	works '' volumes kept_parts.obj --distance 1 --extent none --json - "$@"
	[ "$(field polygons)" = "$expected" ] || problem "volumes $*: found $(field polygons) polygons, expected $expected"
}
polygons 3
polygons 1 --occluders Wall
polygons 2 --occluders Floor,Wall
polygons 1 --receivers Shelf
polygons 2 --receivers Floor,Wall
polygons 1 --occluders Wall --receivers Floor
polygons 2 --ignore Shelf
fails 1 '--receivers: found with --keep-unlit' volumes kept_parts.obj --distance 1 --receivers Wall --keep-unlit -o v.glb
fails 1 "--receivers: found 'Wal'" volumes kept_parts.obj --distance 1 --receivers Wal -o v.glb

# Cameras outside do not see into a hut without doors.
{
	printf 'v -4 0 4\nv 4 0 4\nv 4 0 -4\nv -4 0 -4\nf 1 2 3 4\n'
	for r in 1 0.9; do
		printf "v -$r 0 $r\nv $r 0 $r\nv $r 0 -$r\nv -$r 0 -$r\nv -$r 2 $r\nv $r 2 $r\nv $r 2 -$r\nv -$r 2 -$r\n"
	done
	printf 'f 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\nf 9 10 11 12\n'
	printf 'f 17 18 14 13\nf 18 19 15 14\nf 19 20 16 15\nf 20 17 13 16\nf 20 19 18 17\n'
} >kept_parts.obj
polygons 11
polygons 9 --visible-from outside
polygons 11 --visible-from outside --visible-from=-0.5,0.2,-0.4,0.5,1.8,0.4
finish
