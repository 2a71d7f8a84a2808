# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: progress_test.sh PROGRAM. Progress logs are JSON lines that grow while a verb works and do not affect its output; a
# terminal shows one line that disappears.
set -u
nook=$1
. "$(dirname "$0")/every_verb.sh"
. "$(dirname "$0")/command_line.sh"

# Checks every line of a log: its format; stages begin at 0, increase, and end at 1, each inside the stage that it names; time never
# decreases.
cat >../log.awk <<'AWK'
function bad(text) { print FILENAME ":" FNR ": " text ": " $0; failed = 1 }
function field(name, value) {
	if (!match($0, "\"" name "\": (\"([^\"\\\\]|\\\\.)*\"|[0-9.e-]+)")) return ""
	value = substr($0, RSTART, RLENGTH)
	sub("\"" name "\": ", "", value)
	return value
}
FNR == 1 {
	if ($0 !~ /^{"schema": "nook.progress\/1", "verb": "[a-z ]+", "version": "[0-9.]+"}$/) bad("no first line")
	next
}
ended { bad("a line behind the last one") }
/^{"end": true, "exit_code": [0-7], "elapsed_s": [0-9]+\.[0-9]+(, "error": ".*")?}$/ {
	ended = 1
	if (field("exit_code") == 0 && depth > 0) bad("a stage that does not end")
	if (field("elapsed_s") + 0 < before) bad("time goes back")
	next
}
!/^{"stage": ".*"(, "within": ".*")?, "done": [0-9.e-]+, "elapsed_s": [0-9]+\.[0-9]+(, "remaining_s": [0-9]+\.[0-9]+)?}$/ { bad("no stage"); next }
{
	stage = field("stage")
	done = field("done") + 0
	elapsed = field("elapsed_s") + 0
	if (elapsed < before) bad("time goes back")
	before = elapsed
	if (done == 0) { depth += 1; name[depth] = stage; last[depth] = 0; stages += 1 }
	if (name[depth] != stage) { bad("another stage than the last that began"); next }
	if (field("within") != (depth > 1 ? name[depth - 1] : "")) bad("within another stage")
	if (done < last[depth] || done > 1) bad("less than before")
	last[depth] = done
	if (done == 1) depth -= 1
}
END {
	if (ended != ends) { print FILENAME ": found " (ended ? "an" : "no") " end, expected " (ends ? "one" : "none"); failed = 1 }
	if (stages < least) { print FILENAME ": found " stages + 0 " stages, expected " least " or more"; failed = 1 }
	exit failed
}
AWK

# isLog FILE ENDS LEAST: checks a log, whether it has an end, and the minimum number of stages.
isLog()
{
	awk -v ends="$2" -v least="$3" -f ../log.awk "$1" >../problems || problem "$1: $(head -n 3 ../problems) in $(head -c 1000 "$1")"
}

# Every verb with and without progress.
makeInputs
everyVerb | grep -v '^emit' >../verbs
cat >>../verbs <<'EOT'
info kept_p.json --json a.json
EOT
while read -r arguments; do
	least=1
	# Samples by formula, a tile of even turns, and a comparison of few pixels take no noticeable time.
	case $arguments in pattern* | tile* | info* | merge*) least=0 ;; esac
	rm -rf a.* kept_patterns ../plain
	mkdir ../plain
	# shellcheck disable=SC2086
	"$nook" $arguments >../stdout 2>../stderr </dev/null || problem "nook $arguments: $(cat ../stderr)"
	cp -r a.* kept_patterns ../plain 2>/dev/null
	mv ../stdout ../plain_stdout
	rm -rf a.* kept_patterns
	# shellcheck disable=SC2086
	"$nook" $arguments --progress kept_log >../stdout 2>../stderr </dev/null || problem "nook $arguments --progress: $(cat ../stderr)"
	isLog kept_log 1 $least
	grep -q '"exit_code": 0, ' kept_log || problem "nook $arguments: found the log's end '$(tail -n 1 kept_log)', expected exit code 0"
	case $arguments in "report error"*) continue ;; esac # its output contains times
	same ../plain_stdout ../stdout "nook $arguments: other words with --progress"
	for file in ../plain/*; do
		[ -d "$file" ] || same "$file" "${file##*/}" "nook $arguments: other bytes with --progress"
	done
	diff -r ../plain . 2>&1 | grep -v '^Only in \.' >../problems && problem "nook $arguments: other files with --progress: $(cat ../problems)"
done <../verbs
rm -rf a.* kept_patterns

# Names of the stages that take time.
stages()
{
	expected=$1
	shift
	works '' "$@" --progress kept_log
	isLog kept_log 1 1
	for stage in $expected; do
		grep -q "^{\"stage\": \"$stage\", .*\"done\": 1," kept_log || problem "nook $*: found no end of the stage '$stage' in $(cat kept_log)"
	done
	rm -f a.*
}
works '' volumes builtin:cornell --distance 0.5 -o kept_v.glb
works '' bake builtin:cornell --radius 0.5 --rays 4 -o kept_b.glb
stages 'starts' pattern --domain disk --count 3 --starts 2 -o a.json
stages 'starts' tile --pattern kept_p.json --size 2 -o a.json
stages 'level tree depth' gbuffer builtin:cornell --camera main --size 16x9 -o a.exr
stages 'level tree cameras' level builtin:cornell --cameras 2 -o a.glb
stages 'level tree rays' reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 4 -o a.exr
stages 'level polygons tree receivers insides trimming sums rays file' volumes builtin:cornell --distance 0.5 --trim 0.05 --compensate --verify --json a.json -o a.glb
stages 'level tree rays fit check' bake builtin:cornell --radius 0.5 --rays 4 -o a.glb
stages 'level tree probes' bake builtin:cornell --radius 0.5 --rays 6 --probes 0.5 -o a.ktx2
stages 'level tree rays fit check' bake builtin:cornell --radius 0.5 --rays 128 --falloff linear --volumes kept_v.glb -o a.glb
stages 'level triangles advice' info builtin:cornell
stages 'level cells' level builtin:cornell --cells 2x2 --around 0.5 -o a.glb
rm a-*.glb
stages 'level tree depth' shade kept_g.exr --method slices --radius 0.5 --bake kept_b.glb -o a.exr

# Errors: the last line has the exit code and the line of stderr.
printf 'v 0 0 0\nv 1 0 0\nf 1 2 2\n' >kept_bad.obj
fails 3 'kept_bad.obj: ' volumes kept_bad.obj --distance 1 -o a.glb --progress kept_log
isLog kept_log 1 1
sed -n 's/^{"end": true, "exit_code": 3, .*"error": "\(.*\)"}$/nook: \1/p' kept_log | cmp -s - ../stderr ||
	problem "found '$(tail -n 1 kept_log)', expected the line '$(cat ../stderr)'"
"$nook" compare kept_r.exr kept_g.exr --channel Z --max-error 0 --progress kept_log >../stdout 2>../stderr
[ $? -eq 3 ] && isLog kept_log 1 0

# Standard output: JSON lines replace the verb's own output, and conflict with another output.
works '"end": true' fit builtin:cornell --methods statvo --views 1 --size 16x9 --rays 4 -o a.json --progress -
isLog ../stdout 1 1
works '"end": true' volumes builtin:cornell --distance 0.5 -o a.glb --progress -
isLog ../stdout 1 1
there a.glb a.json
fails 1 '-: named twice' level builtin:cornell -o a.glb --json - --progress -
fails 1 '-: named twice' level builtin:cornell -o - --progress -
fails 1 '-: named twice' info kept_p.json --json - --progress -
fails 1 '--timing: found with --progress -' shade kept_g.exr --method vo-line --timing -o a.exr --progress -
fails 1 '--progress: found with --methods' info --methods --progress kept_log

# Names: of an input, of an output, of a file that a level reads, of a file that is not a log, in a missing folder.
cp kept_p.json ../kept_p.json
fails 1 'kept_p.json: named twice' tile --pattern kept_p.json --size 2 -o a.json --progress kept_p.json
fails 1 './a.json: found the same file as a.json' pattern --domain disk --count 3 -o a.json --progress ./a.json
fails 1 'c/disk/disk_004.json: named twice' catalogue --domain disk --counts 4 -o c --progress c/disk/disk_004.json
fails 1 'kept_p.json: --progress: found a file that is no log' pattern --domain disk --count 3 -o a.json --progress kept_p.json
fails 2 'no_folder/log: cannot be written' pattern --domain disk --count 3 -o a.json --progress no_folder/log
fails 1 '--progress: found .--threads.' pattern --domain disk --count 3 -o a.json --progress --threads 1
same kept_p.json ../kept_p.json 'kept_p.json: found other bytes after refusals'

# A log on stderr, one whose reader closes it, and one on a full disk: one line, and the work continues.
pattern='pattern --domain disk --count 5 --starts 40 -o a.json'
# shellcheck disable=SC2086
"$nook" $pattern && mv a.json ../plain.json
echo before >../stderr
# shellcheck disable=SC2086
"$nook" $pattern --progress /dev/stderr 2>>../stderr
[ "$(head -n 1 ../stderr)" = before ] || problem "--progress /dev/stderr: what stood there is gone"
tail -n +2 ../stderr >kept_log
isLog kept_log 1 1
mkfifo kept_pipe
goesOn()
{
	reason=$1
	shift
	[ "$(wc -l <../stderr)" -eq 1 ] && grep -q "^nook: warning: .*: cannot be written: $reason, the work goes on" ../stderr ||
		problem "$*: found '$(cat ../stderr)', expected one line of warning"
	same a.json ../plain.json "$*: other bytes"
	rm -f a.json
}
head -n 2 kept_pipe >../read &
# shellcheck disable=SC2086
"$nook" $pattern --progress kept_pipe 2>../stderr || problem "a reader that goes away: exit code $?"
wait $!
goesOn 'Broken pipe' 'a reader that goes away'
cat kept_pipe >kept_log &
# shellcheck disable=SC2086
"$nook" $pattern --progress kept_pipe 2>../stderr || problem "a reader: exit code $?"
wait $!
isLog kept_log 1 1
rm -f a.json
# shellcheck disable=SC2086
"$nook" $pattern --progress /dev/full 2>../stderr || problem "a full disk: exit code $?"
goesOn 'No space left on device' 'a full disk'

# Killed while working: complete lines, and no end.
for signal in TERM KILL; do
	: >kept_log
	"$nook" bake builtin:courtyard --radius 1 --rays 16384 -o a.glb --progress kept_log >../stdout 2>../stderr &
	process=$!
	tries=0
	until [ "$(wc -l <kept_log)" -ge 12 ] || [ $((tries += 1)) -gt 600 ]; do sleep 0.1; done
	kill -s $signal $process
	wait $process 2>/dev/null
	isLog kept_log 0 1
done

# A terminal. Work is increased until it takes long enough to show the remaining time.
if ! script -qec true /dev/null >../typed 2>&1 </dev/null; then
	problem "script: found '$(cat ../typed)', expected the program of util-linux that makes a terminal"
fi
onTerminal()
{
	script -qec "'$nook' $*" /dev/null >../typed 2>&1 </dev/null || problem "nook $* on a terminal: $(cat ../typed)"
}
escape=$(printf '\033')
for rays in 64 256 1024 4096 16384; do
	onTerminal bake builtin:courtyard --radius 1 --rays $rays -o kept_b.glb
	grep -q ' left' ../typed && break
done
grep -Eq "[a-z]+ \[#+\.+\] [0-9]+ %, ([0-9]+ min )?[0-9]+ s left" ../typed || problem "a terminal: found '$(tail -c 300 ../typed)', expected a bar and the time left"
# The final terminal contents, after the last time the line was cleared: nothing but the verb's own output.
tr '\r' '\n' <../typed | sed -n "/^$escape\[K/h; /^$escape\[K/!H; \${x; p}" | grep -q '%' && problem "a terminal: found '$(tail -c 300 ../typed)', expected the line to go"
tr '\r' '\n' <../typed | grep -q "^$escape\[K" || problem "a terminal: found '$(tail -c 300 ../typed)', expected the line to be cleared"
# Also cleared before an error; with JSON lines there is no progress line.
script -qec "'$nook' volumes kept_bad.obj --distance 1 -o a.glb" /dev/null >../typed 2>&1 </dev/null
tr '\r' '\n' <../typed | grep -q "^$escape\[Knook: kept_bad.obj: " || problem "a terminal: found '$(cat ../typed)', expected an error in a line of its own"
onTerminal gbuffer builtin:cornell --camera main --size 16x9 -o a.exr --progress -
tr -d '\r' <../typed >kept_log
isLog kept_log 1 1
rm -f a.exr kept_json
there
finish
