# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: faults_test.sh PROGRAM [RUNS [CALLS [SECONDS]]]. Every verb that writes, RUNS times (3) each: ended by a signal at a random moment, on a disk
# that is full at each block and each name in turn, and at each call that writes (CALLS: the library of fault_calls.c), beside another one that writes the same file, and where things are missing that a
# machine usually has. All of the outputs and all of each, or none; no temporary file; no process of ours.
set -u
nook=$1
runs=${2:-3}
calls=${3:-}
seconds=${4:-1000000} # after that, no further round of signals begins
. "$(dirname "$0")/every_verb.sh"
. "$(dirname "$0")/command_line.sh"

# outputsOf ARGUMENTS: the files that they name, in order.
outputsOf()
{
	echo "$*" | grep -o ' a\.[a-z0-9]*' | sort | tr -d '\n' | sed 's/^ //; s/$/ /'
}

# isWhole WHAT ARGUMENTS: nothing is there, or all files ($outputs), each with the bytes of a run that nobody disturbed (by their ends
# where times of the run are in them); no temporary file, but after a signal that cannot be answered.
isWhole()
{
	what=$1
	shift
	checks=$((checks + 1))
	found=
	for file in a.*; do
		case $file in *.tmp*) ;; *) [ ! -e "$file" ] || found="$found$file " ;; esac
	done
	[ -z "$found" ] || [ "$found" = "$outputs" ] || [ "${what#KILL}" != "$what" ] ||
		problem "$what: nook $*: found '$found', expected all of '$outputs' or none"
	for file in $found; do
		if [ -d "$file" ]; then
			isWholeFolder "$file" "$@"
			continue
		fi
		cmp -s "$file" "$whole/$file" || { grep -q "^$file$" "$whole.changing" && [ "$(tail -c 8 "$file")" = "$(tail -c 8 "$whole/$file")" ]; } ||
			problem "$what: nook $*: found a part of $file, expected all of it"
	done
	left=$(find . -name '*.tmp*')
	[ -z "$left" ] || [ "${what#KILL}" != "$what" ] || problem "$what: nook $*: left behind '$left'"
	[ -z "$left" ] || find . -name '*.tmp*' -exec rm {} +
	[ -z "$found" ] || rm -rf a.*
}

# isWholeFolder NAME ARGUMENTS: each file of it, as above; of a folder that changes from run to run, the names alone.
isWholeFolder()
{
	name=$1
	shift
	(cd "$name" && find . -type f ! -name '*.tmp*' | sort) >../names
	(cd "$whole/$name" && find . -type f | sort) >../names.whole
	[ "${what#KILL}" != "$what" ] || cmp -s ../names ../names.whole || problem "$what: nook $*: found '$(cat ../names)' in $name, expected '$(cat ../names.whole)'"
	grep -q "^$name$" "$whole.changing" || while read -r file; do
		cmp -s "$name/$file" "$whole/$name/$file" || problem "$what: nook $*: found a part of $name/$file, expected all of it"
	done <../names
}

# whole ARGUMENTS: what a run that nobody disturbs makes, and which of it changes from run to run.
whole()
{
	mkdir -p "$whole"
	: >"$whole.changing"
	"$nook" "$@" >../stdout 2>../stderr || problem "nook $*: $(cat ../stderr)"
	mv a.* "$whole"
	begin=$(date +%s%N)
	"$nook" "$@" >../stdout 2>../stderr || problem "nook $*: $(cat ../stderr)"
	echo $((($(date +%s%N) - begin) / 1000000 + 20)) >"$whole.lasts"
	for file in a.*; do
		[ ! -e "$file" ] || diff -rq "$file" "$whole/$file" >../difference || echo "$file" >>"$whole.changing"
	done
	rm -rf a.*
}

# orphans: processes of ours whose parent has gone. Only this folder's: others may run tests, too.
orphans()
{
	for link in $(find /proc/[0-9]*/cwd -maxdepth 0 -lname "$PWD" 2>/dev/null); do
		process=${link%/cwd}
		case $(readlink "$process/exe" 2>/dev/null) in */nook | */nook_*_worker) echo "${process#/proc/}" ;; esac
	done
}

random=1
# moment MILLISECONDS: one below that, in seconds.
moment()
{
	random=$(((random * 1103515245 + 12345) % 2147483648))
	awk "BEGIN { print $random % $1 / 1000 }"
}

# signalled RUN ARGUMENTS: once by each signal.
signalled()
{
	run=$1
	shift
	for signal in TERM KILL; do
		"$nook" "$@" >../stdout 2>../stderr </dev/null &
		process=$!
		# Of what lasts long, four of five within the first seconds.
		lasts=$(cat "$whole.lasts")
		[ $((run % 5)) -eq 0 ] || [ "$lasts" -lt 3000 ] || lasts=3000
		sleep "$(moment "$lasts")"
		kill -s $signal $process 2>/dev/null
		wait $process 2>/dev/null
		for wait in $(seq 50); do
			[ -z "$(orphans)" ] && break
			sleep 0.1
		done
		[ -z "$(orphans)" ] || problem "$signal: nook $*: left the processes $(orphans)"
		isWhole "$signal, run $run" "$@"
	done
}

# bears WHAT CODES COMMAND...: one of the exit codes, and a line for each but 0.
bears()
{
	what=$1
	codes=$2
	shift 2
	checks=$((checks + 1))
	"$@" >../stdout 2>../stderr </dev/null
	found=$?
	case " $codes " in *" $found "*) ;; *) problem "$what: $*: exit code $found, expected one of $codes: $(cat ../stderr)" ;; esac
	[ "$found" -eq 0 ] || { [ "$(wc -l <../stderr)" -eq 1 ] && grep -q '^nook: ' ../stderr; } || problem "$what: $*: found '$(cat ../stderr)', expected one line"
}

# What runs a program where it may mount.
if [ "$(id -u)" -eq 0 ]; then
	own="unshare -m"
else
	own="unshare -rm"
fi
mounts()
{
	$own sh -c 'mount -t tmpfs -o size=4k none "$1"' sh "$folder" 2>../stderr
}

# isLong ARGUMENTS: a verb that takes half a minute, as a report on error does on a busy machine, would take hours for all that follows.
isLong()
{
	[ "$(cat "$whole.lasts")" -ge 30000 ] && echo "nook $*: takes $(cat "$whole.lasts") ms: signals alone"
}

# On a disk of so many blocks and names.
full()
{
	! isLong "$@" || return
	mkdir -p disk
	limits="nr_inodes=1 nr_inodes=3 size=4k size=16k"
	[ "$runs" -le 3 ] || limits="$limits nr_inodes=2 nr_inodes=4 size=8k size=32k size=64k"
	for limit in $limits; do
		# shellcheck disable=SC2086
		bears "a disk of $limit" '0 2' $own sh -c 'mount -t tmpfs -o "$1" none disk || exit 99
			shift
			"$@"
			code=$?
			[ -z "$(find disk -name "*.tmp*")" ] || exit 98
			[ $code -eq 0 ] || [ -z "$(find disk -type f)" ] || exit 97
			exit $code' sh $limit "$nook" $(echo "$*" | sed 's| a\.| disk/a.|g')
	done
	rmdir disk
}

# Each call that writes fails in turn, until there is no further one; with few runs, one in three after the first seven.
failing()
{
	! isLong "$@" || return
	call=1
	good=0
	while [ $good -lt 2 ] && [ $call -lt 300 ]; do
		bears "call $call that writes" '0 2' env LD_PRELOAD="$calls" NOOK_TEST_FAIL=$call "$nook" "$@"
		[ "$found" -eq 0 ] && good=$((good + 1)) || good=0
		[ "$found" -eq 0 ] || ! ls -d a.* >../stdout 2>&1 || problem "call $call that writes: nook $*: found '$(ls -d a.*)', expected nothing"
		isWhole "call $call that writes" "$@"
		call=$((call + (runs > 3 || call < 7 ? 1 : 3)))
	done
	[ $call -gt 4 ] || problem "nook $*: found no call that writes, expected some"
}

missing()
{
	! isLong "$@" || return
	bears 'no HOME, no TMPDIR, no PATH' 0 env -i "$nook" "$@"
	isWhole 'no HOME' "$@"
	bears '20 files' '0 2 4' prlimit --nofile=20 "$nook" "$@"
	isWhole '20 files' "$@"
	bears '9 files' '0 2 4' prlimit --nofile=9 "$nook" "$@"
	isWhole '9 files' "$@"
	if [ -d ../locale ]; then
		bears 'a decimal comma' 0 env LOCPATH="$folder/locale" LC_ALL=de_DE.UTF-8 "$nook" "$@"
		isWhole 'a decimal comma' "$@"
	fi
	if [ -n "$own" ]; then
		# shellcheck disable=SC2016,SC2086
		bears 'no /proc' '0 2 4' $own sh -c 'mount -t tmpfs none /proc && exec "$@"' sh "$nook" "$@"
		isWhole 'no /proc' "$@"
	fi
}

if ! mounts; then
	echo "full disks, no /proc: skipped: found nobody who may mount, expected unshare to allow it"
	own=
fi
if ! localedef -i de_DE -f UTF-8 --no-archive ../de_DE.UTF-8 >../stdout 2>&1; then
	echo "decimal commas: skipped: found no localedef that makes de_DE, expected one (scripts/setup.sh)"
else
	mkdir ../locale
	mv ../de_DE.UTF-8 ../locale
	[ "$(LOCPATH="$folder/locale" LC_ALL=de_DE.UTF-8 locale decimal_point)" = , ] || problem "the locale of decimal commas: found none"
fi

makeInputs
# A report on error and a search take long, and have their turn in the long run.
everyVerb | sed 's/kept_patterns$/a.patterns/' >../verbs
cat >>../verbs <<-EOT
	stress --cases 1000 --kernel prism --part 1/2 -o a.part
	plan --parts 2 --for slurm -o kept_plan --json a.json -- stress --cases 1000 --kernel prism --json b.json
EOT
if [ "$runs" -gt 3 ]; then
	echo 'tune builtin:cornell --budget 10s --methods statvo --grid quick --size 16x9 --views 1 --rays 4 --repetitions 1 -o a.tune' >>../verbs
else
	sed -i '/^report error/d' ../verbs
fi
# eachVerb COMMAND...: with the arguments of each, and its whole outputs in $whole.
eachVerb()
{
	number=0
	while read -r arguments; do
		number=$((number + 1))
		whole=$folder/whole$number
		outputs=$(outputsOf "$arguments")
		# shellcheck disable=SC2086
		"$@" $arguments
	done <../verbs
}
eachVerb whole
eachVerb missing
[ -z "$own" ] || eachVerb full
[ -z "$calls" ] || eachVerb failing
begin=$(date +%s)
for run in $(seq "$runs"); do
	[ $(($(date +%s) - begin)) -lt "$seconds" ] || break
	eachVerb signalled "$run"
	rounds=$run
done
[ "$runs" -le 3 ] || echo "signals: $rounds of each of two kinds for each of $number verbs"

# Two that write the same file: it is one of theirs.
works '' level kept.obj -o kept_one.glb
works '' level builtin:cornell -o kept_two.glb
for run in $(seq $((4 * runs))); do
	checks=$((checks + 1))
	"$nook" level kept.obj -o a.glb >../stdout 2>../stderr &
	first=$!
	"$nook" level builtin:cornell -o a.glb >../stdout.two 2>../stderr.two || problem "two on one output: $(cat ../stderr.two)"
	wait $first || problem "two on one output: $(cat ../stderr)"
	cmp -s a.glb kept_one.glb || cmp -s a.glb kept_two.glb || problem "two on one output: found neither, run $run"
	rm a.glb
done

# A cache with bytes changed, cut, another's or of something else in eight files: these are measured again, the others are not, and all
# errors are those of before. tests/test_error_report.cpp changes every bit of one.
# Without shifts: these are measured of the candidates of the front, which times decide.
error='report error builtin:cornell --grid quick --methods statvo,alchemy,rays --size 16x9 --rays 4 --repetitions 1 --shifts 0 --pictures 0 --device cpu --cache kept_cache'
errorsOf()
{
	grep -oE '"(eq14|rmse|own_rmse|best_rmse|best_factor|flip|flicker|ssim|mean_error)":[^,}]*' "$1"
}
# shellcheck disable=SC2086
"$nook" $error --json kept_report.json >../stdout 2>../stderr || problem "a cache: $(cat ../stderr)"
errorsOf kept_report.json >../errors
[ "$(wc -l <../errors)" -gt 100 ] || problem "a cache: found $(wc -l <../errors) errors in the report, expected more than 100"
cp -r kept_cache ../cache
find kept_cache -type f | sort >../entries
for run in $(seq $((runs > 3 ? 40 : 2))); do
	rm -rf kept_cache
	cp -r ../cache kept_cache
	expected=8
	for file in $(awk -v seed="$run" 'BEGIN { srand(seed) } { print rand(), $0 }' ../entries | sort | head -n 8 | cut -d ' ' -f 2); do
		size=$(wc -c <"$file")
		grep -q '"entry":{"measurement"' "$file" || expected=$((expected - 1)) # rays, which are no measurement
		moment 10 >../stdout
		place=$((random / 65536 % size))
		case $((random / 256 % 6)) in
		0) truncate -s $place "$file" ;;
		1) tail -c +$((place + 1)) "$file" | head -c 1 | tr '\000-\377' '\001-\377\000' | dd of="$file" bs=1 seek=$place conv=notrunc 2>../stderr ;;
		2) head -c "$size" /dev/urandom >"$file" ;;
		3) echo >>"$file" ;;
		4) rm "$file" && mkdir "$file" ;;
		5) echo '{"schema":"nook.measurement/2","checksum":"00000000000000000000000000000000","entry":{"number":0.5}}' >"$file" ;;
		esac
	done
	# What cannot be replaced, a folder, is a failure to write; all else is measured again.
	folders=$(find kept_cache -mindepth 1 -type d | wc -l)
	checks=$((checks + 1))
	# shellcheck disable=SC2086
	"$nook" $error --json a.json >../stdout 2>../stderr </dev/null
	found=$?
	if [ "$folders" -gt 0 ]; then
		[ $found -eq 2 ] || [ $found -eq 0 ] || problem "a cache that is damaged: exit code $found, expected 0 or 2: $(cat ../stderr)"
	else
		[ $found -eq 0 ] || problem "a cache that is damaged: exit code $found, expected 0: $(cat ../stderr)"
		grep -q "^nook: $expected measurements made" ../stderr ../stdout ||
			problem "a cache that is damaged: found '$(cat ../stderr)', expected $expected measurements"
	fi
	[ $found -ne 0 ] || errorsOf a.json | cmp -s - ../errors || problem "a cache that is damaged: found other errors than before, run $run"
	[ -z "$(find . -name '*.tmp*')" ] || problem "a cache that is damaged: left behind '$(find . -name '*.tmp*')'"
	rm -f a.json
done

# A library of the folder that nook runs in is no library of nook's.
for library in libembree3.so.3 libtbb.so.12 libpng16.so.16 libOpenImageIO.so.2.4 libassimp.so.5; do
	echo "no library" >$library
done
works '' gbuffer kept.obj --camera auto:1 --size 4x4 -o a.exr
rm -f lib*
there a.exr
finish
