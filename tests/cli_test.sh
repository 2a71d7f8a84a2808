# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: cli_test.sh PROGRAM. Command lines, exit codes, one-line errors, and the files left in the folder.
set -u
nook=$1
. "$(dirname "$0")/command_line.sh"

disk="pattern --domain disk --count 3 --method vogel"

# Help and version.
works '^nook [0-9]+\.[0-9]+\.[0-9]+$' --version
works 'catalogue' --help
works 'Exit codes' -h
for verb in pattern tile catalogue compare info report 'report noise'; do
	works '(Usage|report|-o)' $verb --help
done
works 'Thomson' pattern --help
works 'disk\|ball\|sphere\|hemisphere' pattern --help
"$nook" --help >/dev/full 2>../stderr
[ $? -eq 2 ] || problem "nook --help to a full device: expected exit code 2"

# Unknown verbs and options.
fails 1 "no verb, expected pattern, tile, catalogue, "
fails 1 "verb: found 'nothing', expected pattern, tile" nothing
fails 1 "verb: found '--frobnicate', expected pattern, tile" --frobnicate
fails 1 '.*--frobnicate.*nook pattern --help' $disk --frobnicate -o a.json
fails 1 '.*extra' $disk extra -o a.json
fails 1 '.*-x' $disk -x -o a.json
fails 1 '.*' pattern
fails 1 '.*--count' pattern --domain disk -o a.json
fails 1 '.*--domain' pattern --count 3 -o a.json
fails 1 "no verb, expected noise" report
fails 1 "verb: found 'errors', expected noise, error or times" report errors

# Numbers.
for count in 0 -1 4097 1000000000 99999999999999999999 nine 9.5 1e1 0x10 '' ' 9' 9x nan; do
	fails 1 "--count: found '$count', expected a whole number from 1 to 4096" pattern --domain disk --count "$count" -o a.json
done
fails 1 "--count: found '-o'" pattern --domain disk --count -o a.json
fails 1 '.*--count' pattern --domain disk --count 3 --count 4 -o a.json
fails 1 '.*--domain' pattern --domain disk --domain ball --count 4 -o a.json
fails 1 '--seed' $disk --seed -1 -o a.json
fails 1 '--seed' $disk --seed 4294967296 -o a.json
fails 1 '--starts' pattern --domain disk --count 3 --starts 0 -o a.json
fails 1 '--starts' pattern --domain disk --count 3 --starts 100001 -o a.json
fails 1 '--threads' $disk --threads 0 -o a.json
fails 1 '--threads' $disk --threads -2 -o a.json
fails 1 '--exponent' pattern --domain sphere --count 4 --exponent 0 -o a.json
fails 1 '--exponent' pattern --domain sphere --count 4 --exponent nan -o a.json
fails 1 '--exponent' pattern --domain sphere --count 4 --exponent inf -o a.json
fails 1 '--exponent' pattern --domain sphere --count 4 --exponent -1 -o a.json

# Names.
fails 1 "--domain: found 'square', expected disk, ball, sphere or hemisphere" pattern --domain square --count 3 -o a.json
fails 1 "--domain: found 'Disk'" pattern --domain Disk --count 3 -o a.json
fails 1 "--method: found 'magic'" pattern --domain disk --count 3 --method magic -o a.json
fails 1 "--minimise: found 'all'" pattern --domain disk --count 3 --minimise all -o a.json
fails 1 "--weights: found 'x'" $disk --weights x -o a.json
fails 1 "--order: found 'x'" $disk --order x -o a.json
fails 1 "--name: found '9lives'" $disk --name 9lives -o a.h
fails 1 "--name: found 'a b'" $disk --name 'a b' -o a.h

# Options that exclude each other.
fails 1 '--centre' pattern --domain sphere --count 4 --centre -o a.json
fails 1 '--centre' pattern --domain hemisphere --count 4 --centre -o a.json
fails 1 '--symmetric' pattern --domain hemisphere --count 4 --symmetric -o a.json
fails 1 '--symmetric' pattern --domain sphere --count 5 --symmetric -o a.json
fails 1 '--symmetric --centre' pattern --domain disk --count 4 --symmetric --centre -o a.json
fails 1 '--minimise' pattern --domain disk --count 4 --method lloyd --minimise noise -o a.json
fails 1 '--minimise cliff' pattern --domain ball --count 4 --minimise cliff -o a.json
fails 1 '--weights fitted' pattern --domain disk --count 4 --method equal --weights fitted -o a.json
fails 1 '--exponent' pattern --domain disk --count 4 --exponent 2 -o a.json
fails 1 '--starts' $disk --starts 3 -o a.json

# Outputs.
fails 1 '-o: nothing to write' $disk
fails 1 'a.txt: found the ending .txt' $disk -o a.json -o a.txt
fails 1 'a: found no ending' $disk -o a
fails 1 "-o: found '--json'" $disk -o --json
fails 1 './a.json: found the same file as a.json' $disk -o a.json -o ./a.json
fails 1 '.*named twice' $disk -o a.json --json a.json
fails 1 '--depfile' $disk --json b.json --depfile a.d
fails 2 'none/a.json: cannot be written: No such file' $disk -o none/a.json
fails 2 'none/s.json: cannot be written' $disk -o a.json --json none/s.json
fails 2 'none/a.d: cannot be written' $disk -o a.json --depfile none/a.d
fails 2 '/dev/full: cannot be written: No space left' $disk -o a.json -o b.svg --json /dev/full
fails 2 '/dev/full: cannot be written: No space left' $disk -o /dev/full -o a.h
mkdir folder.json
fails 2 'folder.json: cannot be written: Is a directory' $disk -o folder.json -o a.h
rmdir folder.json
ln -s /dev/full full.svg
fails 2 'full.svg: cannot be written: No space left' $disk -o a.json -o full.svg
rm full.svg
if [ "$(id -u)" -ne 0 ]; then
	chmod 555 closed
	fails 2 'closed/a.json: cannot be written: Permission denied' $disk -o closed/a.json
	chmod 755 closed
fi
"$nook" $disk -o a.json --json - >/dev/full 2>../stderr
[ $? -eq 2 ] || problem "--json - to a full device: expected exit code 2"
there

# Valid commands.
works '' $disk -o a.json -o a.h -o a.glsl -o a.hlsl -o a.csv -o a.svg
there a.csv a.glsl a.h a.hlsl a.json a.svg
fails 1 'a.png: found the ending .png, expected one of .json, .h, .glsl, .hlsl, .csv, .svg' $disk -o a.png
works '"plane"' $disk --json -
works '"schema": "nook.pattern/1"' $disk -o -
works '' $disk -o 'a b#$.json' --depfile 'a b.d'
[ "$(cat 'a b.d')" = 'a\ b\#$$.json:' ] || problem "depfile: found '$(cat 'a b.d')'"
there 'a b#$.json' 'a b.d'
works '' pattern --domain sphere --count 4 --exponent 1 -o kept_thomson.json
grep -q 'method electro --exponent 1' kept_thomson.json || problem "--exponent alone: expected --method electro in the command"
works '' $disk --name lines -o a.h
grep -q 'lines_points' a.h || problem "--name: expected lines_points in a.h"
there a.h

# Reading.
works '' pattern --domain disk --count 4 --method lloyd -o kept.json
works 'pattern: disk, 4 samples' info kept.json
works '"quality_in_file"' info kept.json --json -
works '' tile --pattern kept.json --size 2 --kind even -o kept_tile.json -o a.png --depfile a.d
grep -q 'kept.json$' a.d || problem "tile --depfile: expected the pattern in it"
there a.d a.png
works 'tile: disk, 4 samples in each of 2 x 2 variants' info kept_tile.json
printf '0,0\n0.5,0\n-0.5,0\n' >kept.csv
works 'recipes: of [0-9]* methods' info "$(dirname "$0")/../docs/measurements/rays.json"
works 'pattern: disk, 3 samples' info kept.csv
works 'weights: none in the file' info kept.csv
works '' tile --pattern kept.csv --size 3 --kind random -o a.json
there a.json
fails 1 '.*FILE' info
fails 2 'none.json: cannot be read: No such file' info none.json
fails 2 'closed: cannot be read' info closed
fails 2 'none.json: cannot be read' tile --pattern none.json --size 4 -o a.json
works '' tile --domain slice --size 2 -o kept_slices.json -o a.h -o a.glsl -o a.csv -o a.exr -o kept_slices.png -o kept_slices.svg
works 'tile: slice, 1 sample in each of 2 x 2 variants' info kept_slices.json
works '"bilateral:3, frames": ' tile --domain slice --count 2 --size 3 --filter bilateral:3 --frames 4 --moves -o a.json --json -
grep -q '"command": "nook tile --domain slice --count 2 --size 3 --filter bilateral:3 --frames 4 --ema 0.1 --moves"' a.json || problem "tile of slices: expected its command"
fails 1 '--pattern: found with --domain slice' tile --domain slice --pattern kept.json --size 2 -o a.json
fails 1 '--pattern: missing without --domain slice' tile --size 2 -o a.json
fails 1 '--count: found with --pattern' tile --pattern kept.json --count 2 --size 2 -o a.json
fails 1 "--count: found '17'" tile --domain slice --count 17 --size 2 -o a.json
fails 1 "--domain: found 'disk', expected slice" tile --domain disk --size 2 -o a.json
fails 1 "--domain: found 'slice'" pattern --domain slice --count 4 -o a.json
fails 5 '--kind even: slices have azimuths and jitters of their own' tile --domain slice --size 2 --kind even -o a.json
sed 's/"size": 2,/"size": 2, /; s/0\.[0-9]*,$/1.5,/' kept_slices.json | sed '0,/\[0\./s/\[0\./[1./' >kept_outside.json
fails 3 'kept_outside.json: variants.*, expected an azimuth and a jitter from 0 to below 1' info kept_outside.json
fails 1 "--size: found 9, expected at most 8, or a filter" tile --pattern kept.json --size 9 -o a.json
fails 1 "--size: found '129'" tile --pattern kept.json --size 129 -o a.json
# Tiles for filters and frames.
printf '{"taps": [[0, 1, 0], [1, 4, 1], [0, 1, 0]]}' >kept_cross.json
printf '{"taps": [[0.25, 0.5, 0.25]]}' >kept_row.json
printf '{"taps": [[1, -1]]}' >kept_none.json
works '' tile --pattern kept.json --size 3 --filter binomial:3@2 --filter file:kept_row.json --robust --starts 1 -o a.json -o a.exr -o a.csv -o a.h -o a.glsl
works 'binomial:3, half' info a.json
works 'box:3 ' info a.json --filter box:3
there a.csv a.exr a.glsl a.h a.json
works '"binomial:3, frames": ' tile --pattern kept.json --size 2 --filter binomial:3 --frames 3 --ema 0.2 --starts 1 -o kept_frames.json -o a.h --json -
grep -q '_FRAMES = 3' a.h || grep -q '_FRAMES 3' a.h || problem "--frames: expected 3 in a.h"
works 'for each of 3 frames' info kept_frames.json
works 'none, frames, panned' info kept_frames.json --filter none --ema 0.5
there a.h
works '' tile --pattern kept.json --size 2 --filter none --frames 4 --moves --starts 1 -o kept_moves.json -o a.h
grep -q '_moves' a.h || problem "--moves: expected an array of moves in a.h"
works 'that move in 4 frames' info kept_moves.json
there a.h
"$nook" tile --pattern kept.json --size 2 --filter file:kept_cross.json --starts 1 -o a.json 2>../stderr
grep -qx 'nook: warning: kept_cross.json: taps: found the sum 8, divided by it' ../stderr || problem "a kernel of sum 8: found '$(cat ../stderr)'"
there a.json
for kernel in box box:0 median:3 gauss:0 bilateral:4 box:4@0 box:4@; do
	fails 1 "--filter: found '$kernel'" tile --pattern kept.json --size 2 --filter $kernel -o a.json
done
fails 3 'kept_none.json: taps: found taps with the sum 0, -1 of it negative' tile --pattern kept.json --size 2 --filter file:kept_none.json -o a.json
fails 2 'none.json: cannot be read' tile --pattern kept.json --size 2 --filter file:none.json -o a.json
fails 1 'kept_row.json' tile --pattern kept.json --size 2 --filter file:kept_row.json -o kept_row.json
fails 1 '--robust --frames: found without a filter' tile --pattern kept.json --size 2 --frames 4 -o a.json
fails 1 '--robust --frames: found without a filter' tile --pattern kept.json --size 2 --robust -o a.json
fails 1 "--frames: found '0'" tile --pattern kept.json --size 2 --filter none --frames 0 -o a.json
fails 1 "--frames: found '1000000'" tile --pattern kept.json --size 2 --filter none --frames 1000000 -o a.json
fails 1 "--ema: found '0'" tile --pattern kept.json --size 2 --filter none --frames 4 --ema 0 -o a.json
fails 1 "--ema: found '1.5'" tile --pattern kept.json --size 2 --filter none --frames 4 --ema 1.5 -o a.json
fails 1 '--ema: found without --frames' tile --pattern kept.json --size 2 --filter none --ema 0.5 -o a.json
fails 1 '--moves: found 5 frames, expected from 2 to 4' tile --pattern kept.json --size 2 --filter none --frames 5 --moves -o a.json
fails 1 '--filter: found with the kind even' tile --pattern kept.json --size 2 --filter none --kind even -o a.json
fails 4 '--memory: found a need of about [0-9]* MiB for 4194304 samples, expected at most 4096 MiB; or a tile that moves' tile --pattern kept.json --size 128 --filter none --frames 64 -o a.json
fails 4 '--memory: found a need of about [0-9]* MiB for 16 samples, expected at most 1 MiB$' tile --pattern kept.json --size 2 --memory 1MiB -o a.json
for size in 0 -1 4GB 2TiB nan; do
	fails 1 "--memory: found '$size', expected a number of bytes, KiB, MiB or GiB" tile --pattern kept.json --size 2 --memory $size -o a.json
done
fails 1 '--progressive: found with the kind even' tile --pattern kept.json --size 2 --kind even --progressive -o a.json
fails 1 '--filter: found with another kind of file, expected a tile' info kept.json --filter box:3
fails 1 '--ema: found with a tile of one frame' info kept_tile.json --filter box:3 --ema 0.5
fails 1 "--kind: found 'odd'" tile --pattern kept.json --size 4 --kind odd -o a.json
fails 1 '--lambda' tile --pattern kept.json --size 4 --lambda -1 -o a.json
fails 1 '.*named twice' tile --pattern kept.json --size 4 -o kept.json
fails 3 'kept_tile.json' tile --pattern kept_tile.json --size 4 -o a.json
fails 3 'kept.json.*found' info kept.json --domain ball

# Levels.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >kept.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 2\n' >kept_odd.obj
works 'level: kept.obj, 1 triangle of 3 vertices in 1 mesh' info kept.obj
works 'findings: none' info kept.obj --strict
works '"most_m": \[2.5, 0.0, 0.0\]|"most_m": \[2.5,' info kept.obj --unit 2.5 --json -
works 'degenerate-triangles: 1 dropped, first mesh .*, triangle 1' info kept_odd.obj
works '"id": "degenerate-triangles", "count": 1' info kept_odd.obj --json -
fails 3 'kept_odd.obj: mesh .* found degenerate-triangles \(1\), expected none \(--strict\)' info kept_odd.obj --strict
fails 2 'none.obj: cannot be read: No such file' info none.obj
works '"area_m2": 0.5' info kept.obj --json -
"$nook" info kept.obj <&- >../stdout 2>&- || problem 'info kept.obj: found a failure without standard input and error, expected none'
echo OFF >kept.off
fails 3 "kept.off: found the ending '.off', expected .*a level \(.gltf" info kept.off
fails 2 'none.off: cannot be read' info none.off
# Whatever the file contains, the error is a single line of limited length without control characters.
printf '{"asset": {"version": "\\n\\u001b[31m%05000d"}}' 1 >kept_loud.gltf
fails 3 'kept_loud.gltf: asset.version: found .* expected' info kept_loud.gltf
[ "$(wc -c <../stderr)" -lt 2100 ] || problem "kept_loud.gltf: found $(wc -c <../stderr) bytes, expected a line that is cut"
! grep -q "$(printf '\033')" ../stderr || problem 'kept_loud.gltf: found an escape, expected a line to be read'
fails 1 "--unit: found '0'" info kept.obj --unit 0
fails 1 "--up: found 'w'" info kept.obj --up w
fails 1 '--domain' info kept.obj --domain disk
fails 1 '--strict' info kept.json --strict
printf 'v 0 0 0\nf 1 2 3\n' >kept_bad.obj
fails 3 'kept_bad.obj: line 2: found ' info kept_bad.obj

# Invalid files: every one is rejected with its name, and none ends with a signal.
bad()
{
	printf "$1" >kept_bad.json
	fails 3 'kept_bad.json: ' info kept_bad.json
}
bad ''
bad '{'
bad '[]'
bad '{}'
bad 'null'
bad '\377\376'
bad '{"domain": "disk"}'
bad '{"domain": "square", "points": [[0, 0]]}'
bad '{"domain": "disk", "points": []}'
bad '{"domain": "disk", "points": [[0]]}'
bad '{"domain": "disk", "points": [[0, 0, 0]]}'
bad '{"domain": "disk", "points": [[NaN, 0]]}'
bad '{"domain": "disk", "points": [[null, 0]]}'
bad '{"domain": "disk", "points": [["0", 0]]}'
bad '{"domain": "disk", "points": [[1e999, 0]]}'
bad '{"domain": "disk", "points": [[1.01, 0]]}'
bad '{"domain": "sphere", "points": [[0.5, 0, 0]]}'
bad '{"domain": "disk", "points": [[0, 0]], "weights": [0.5]}'
bad '{"domain": "disk", "points": [[0, 0]], "weights": [1, 0]}'
bad '{"domain": "disk", "points": [[0, 0], [0.1, 0]], "weights": [-0.5, 1.5]}'
bad '{"schema": "nook.pattern/2", "domain": "disk", "points": [[0, 0]]}'
bad '{"schema": "nook.tile/1"}'
bad '{"asset": {"version": "2.0"}}'
bytes=$(wc -c <kept.json)
cut=1
while [ "$cut" -lt "$((bytes - 2))" ]; do
	head -c "$cut" kept.json >kept_cut.json
	fails 3 'kept_cut.json: ' info kept_cut.json
	cut=$((cut + 41))
done
for csv in '' 'x,y\n' 'x,y\n0\n' 'x,y\nnan,0\n' 'x,y\n2,0\n' '\0\0\0' 'a,b\n0,0\n'; do
	printf "$csv" >kept_bad.csv
	fails 3 'kept_bad.csv: ' info kept_bad.csv
done
rm -f kept_bad.json kept_cut.json kept_bad.csv

# The catalogue, a small part of it.
works '' catalogue --domain disk --counts 1-3 -o catalogue
[ "$(find catalogue -type f | wc -l)" -eq 9 ] || problem "catalogue: found $(find catalogue -type f | wc -l) files, expected 9"
works '' catalogue --domain disk --counts 1-3 -o catalogue --check
echo >>catalogue/disk/disk_002_centred.json
fails 7 'catalogue/disk/disk_002_centred.json: ' catalogue --domain disk --counts 1-3 -o catalogue --check
rm catalogue/disk/disk_001.json catalogue/disk/disk_002_centred.json
fails 7 'catalogue/disk/disk_001.json: .* 2 of 9' catalogue --domain disk --counts 1-3 -o catalogue --check
rm -r catalogue
for counts in 0-3 3-1 1-65 x 1- -1 1-3-5 ''; do
	fails 1 '--counts' catalogue --domain disk --counts "$counts" -o c
done
fails 1 '--counts' catalogue --counts 1-3 -o c
fails 1 '--counts' catalogue --domain sphere --counts 1 -o c
fails 1 '--tiles' catalogue --domain ball --counts 1 --tiles -o c
echo >plain
fails 2 'plain/disk: cannot be made' catalogue --domain disk --counts 1 -o plain
rm plain

# The report.
fails 1 'a.json: found the ending .json' report noise -o a.json
fails 1 '--max-count' report noise --max-count 0 -o a.html
fails 2 'none/a.html: cannot be written' report noise -o none/a.html

# Comparing. Pictures of differences are images as good as any; tiles have four channels of floats.
works '' gbuffer builtin:cornell --camera main --size 64x36 -o kept_view.exr
for rays in 1 2 4; do
	works '' reference builtin:cornell --gbuffer kept_view.exr --radius 1 --rays $rays -o kept_rays$rays.exr
done
works '' compare kept_rays1.exr kept_rays4.exr --diff kept_a.png
works '' compare kept_rays2.exr kept_rays4.exr --diff kept_b.png
works '' tile --pattern kept.json --size 2 --kind even -o kept_tile.exr -o kept_tile.png
compare="compare kept_a.png kept_b.png --channel R"
works '^rmse +0\.[0-9]+ ' $compare
works '^ssim +1 ' compare kept_a.png kept_a.png --channel R --max-error 0
works '"verdict": "within"' $compare --max-error 1 --json -
works '' $compare --diff d.png --json d.json
works '^image: ' info d.png
there d.json d.png
works '"name": "R"' info kept_tile.exr --json -
fails 1 '--domain' info kept_tile.exr --domain ball
"$nook" $compare --max-error 0.01 --diff d.png >../stdout 2>../stderr
[ $? -eq 7 ] || problem "compare --max-error: expected exit code 7"
grep -q '^nook: kept_a.png: rmse: found 0\.[0-9]*, expected at most 0.01$' ../stderr || problem "compare: found '$(cat ../stderr)'"
there d.png
for metric in mae p95 max ssim flip eq14; do
	"$nook" $compare --max-error 0.0001 --metric $metric >../stdout 2>../stderr
	[ $? -eq 7 ] || problem "compare --metric $metric: expected exit code 7"
	grep -q "kept_a.png: $metric: found" ../stderr || problem "compare --metric $metric: found '$(cat ../stderr)'"
done
for threads in 1 2 5; do
	"$nook" $compare --threads $threads --json - --diff kept_d$threads.png >kept_$threads.json || problem "compare --threads $threads"
	same kept_1.json kept_$threads.json "compare --threads $threads: other numbers"
	same kept_d1.png kept_d$threads.png "compare --threads $threads: another picture"
done
fails 1 '.*TEST' compare
fails 1 '.*REFERENCE' compare kept_a.png
fails 1 "--metric: found 'psnr', expected rmse" $compare --metric psnr
fails 1 '--metric: .*expected --max-error' $compare --metric mae
fails 1 '--diff-range: .*expected --diff' $compare --diff-range 0.1
fails 1 '--max-error' $compare --max-error -1
fails 1 "--diff-range: found '0'" $compare --diff d.png --diff-range 0
fails 1 '--ppd' $compare --ppd 3
fails 1 'd.jpg: found the ending .jpg' $compare --diff d.jpg
fails 1 '.*named twice' $compare --diff kept_a.png
fails 1 '.*named twice' $compare --diff kept_b.png
fails 2 'none/d.png: cannot be written' $compare --diff none/d.png
fails 2 'none.png: cannot be read: No such file' compare none.png kept_b.png
fails 2 'none.png: cannot be read: No such file' compare kept_a.png none.png --channel R
fails 3 'kept_a.png: channels: found R, G, B, expected visibility' compare kept_a.png kept_b.png
fails 3 'kept_a.png: channels: found R, G, B, expected Q among them' compare kept_a.png kept_b.png --channel Q
fails 3 'kept_a.png: size: found .* pixels, expected 2x2 pixels as kept_tile.png' compare kept_a.png kept_tile.png --channel R
fails 3 'kept_tile.exr: size: found no window of 11x11' compare kept_tile.exr kept_tile.exr --channel R --max-error 0 --metric ssim
fails 3 'kept_tile.exr: channels: found R, G, B, A, expected one that is depth' $compare --mask kept_tile.exr
fails 3 'kept.csv: ' compare kept.csv kept_a.png
works '' gbuffer builtin:nulls --size 16x12 -o kept_g.exr
works '^G-buffer: 16 x 12 pixels' info kept_g.exr
works 'worldToCamera64' info kept_g.exr --json -
works '^pixels .* of 16 x 12, the others are sky' compare kept_g.exr kept_g.exr --channel N.X --mask kept_g.exr --max-error 0
fails 3 'kept_g.exr: size: found 16x12 pixels, expected .* as kept_b.png' $compare --mask kept_g.exr
fails 3 'kept_g.exr: channel Z, pixel [0-9]+,[0-9]+: found infinity' compare kept_g.exr kept_g.exr --channel Z
for image in kept_b.png kept_tile.exr; do
	bytes=$(wc -c <$image)
	for share in 0 1 7 20 50 80 99; do
		head -c $((bytes * share / 100)) $image >"kept_cut.${image##*.}"
		fails 3 'kept_cut\..*: found' compare "kept_cut.${image##*.}" $image --channel R --diff d.png
		fails 3 'kept_cut\..*: found' info "kept_cut.${image##*.}"
	done
done

finish
