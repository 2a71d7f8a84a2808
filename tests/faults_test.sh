# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: faults_test.sh PROGRAM [RUNS [CALLS [SECONDS]]]. Every verb that writes, RUNS times (3) each: ended by a signal at a random
# time, on a disk that is full after each number of blocks and names, with each write call failing (CALLS: the library of
# fault_calls.c), concurrently with another run that writes the same file, and without things that a machine usually has. Expects
# all of the outputs, complete, or none; no temporary file; no remaining process.
set -u
nook=$1
runs=${2:-3}
calls=${3:-}
seconds=${4:-1000000} # no further round of signals starts after that
. "$(dirname "$0")/every_verb.sh"
. "$(dirname "$0")/command_line.sh"

# outputsOf ARGUMENTS: the output files that they name, in order.
outputsOf()
{
	echo "$*" | grep -o ' a\.[a-z0-9]*' | sort | tr -d '\n' | sed 's/^ //; s/$/ /'
}

# isWhole WHAT ARGUMENTS: either no file exists, or all files ($outputs) do, each with the bytes of an undisturbed run (only their
# ends if they contain times); no temporary file, except after a signal that cannot be handled.
isWhole()
{
	what=$1
	shift
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

# isWholeFolder NAME ARGUMENTS: likewise for each file of a folder; only the names if its contents change from run to run.
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

# whole ARGUMENTS: records the outputs of an undisturbed run, and which of them change from run to run.
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

# orphans: processes of this folder whose parent has ended. Others may run tests at the same time.
orphans()
{
	for link in $(find /proc/[0-9]*/cwd -maxdepth 0 -lname "$PWD" 2>/dev/null); do
		process=${link%/cwd}
		case $(readlink "$process/exe" 2>/dev/null) in */nook | */nook_*_worker) echo "${process#/proc/}" ;; esac
	done
}

random=1
# moment MILLISECONDS: a random time below that, in seconds.
moment()
{
	random=$(((random * 1103515245 + 12345) % 2147483648))
	awk "BEGIN { print $random % $1 / 1000 }"
}

# signalled RUN ARGUMENTS: once with each signal.
signalled()
{
	run=$1
	shift
	for signal in TERM KILL; do
		"$nook" "$@" >../stdout 2>../stderr </dev/null &
		process=$!
		# For long runs, four of five signals are in the first seconds.
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

# bears WHAT CODES COMMAND...: one of the exit codes, and one line for each but 0.
bears()
{
	what=$1
	codes=$2
	shift 2
	"$@" >../stdout 2>../stderr </dev/null
	found=$?
	case " $codes " in *" $found "*) ;; *) problem "$what: $*: exit code $found, expected one of $codes: $(cat ../stderr)" ;; esac
	[ "$found" -eq 0 ] || { [ "$(wc -l <../stderr)" -eq 1 ] && grep -q '^nook: ' ../stderr; } || problem "$what: $*: found '$(cat ../stderr)', expected one line"
}

# Prefix that runs a program with permission to mount.
if [ "$(id -u)" -eq 0 ]; then
	own="unshare -m"
else
	own="unshare -rm"
fi
mounts()
{
	$own sh -c 'mount -t tmpfs -o size=4k none "$1"' sh "$folder" 2>../stderr
}

# isLong ARGUMENTS: true for verbs that take half a minute on a busy machine, such as a report on error: they would take hours here.
isLong()
{
	[ "$(cat "$whole.lasts")" -ge 30000 ] && echo "nook $*: takes $(cat "$whole.lasts") ms: signals alone"
}

# A disk with that many blocks and names.
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

# Each write call fails in turn, until there are no more; with few runs, every third after the first seven.
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
# A report on error and a search take long; they are only in the long run.
everyVerb | sed 's/kept_patterns$/a.patterns/' >../verbs
cat >>../verbs <<-EOT
	reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 4 --cache kept_cache -o a.exr
	plan --shares 2 --for slurm -o kept_plan --json a.json -- reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 4 -o b.exr
EOT
if [ "$runs" -gt 3 ]; then
	echo 'tune builtin:cornell --budget 10s --methods statvo --grid quick --size 16x9 --views 1 --rays 4 --repetitions 1 -o a.tune' >>../verbs
else
	sed -i '/^report error/d' ../verbs
fi
# eachVerb COMMAND...: runs it with the arguments of each verb, and its expected outputs in $whole.
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

# Two runs write the same file: it is one of theirs.
works '' level kept.obj -o kept_one.glb
works '' level builtin:cornell -o kept_two.glb
for run in $(seq $((4 * runs))); do
	"$nook" level kept.obj -o a.glb >../stdout 2>../stderr &
	first=$!
	"$nook" level builtin:cornell -o a.glb >../stdout.two 2>../stderr.two || problem "two on one output: $(cat ../stderr.two)"
	wait $first || problem "two on one output: $(cat ../stderr)"
	cmp -s a.glb kept_one.glb || cmp -s a.glb kept_two.glb || problem "two on one output: found neither, run $run"
	rm a.glb
done

# A cache with eight damaged files (changed, truncated, or something else): these are computed again, and all errors stay the same.
# tests/test_store.cpp changes every byte of one.
# Without shifts, which are measured for candidates on the front, and that depends on times.
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
find kept_cache -type f ! -name '*.lock' | sort >../entries
for run in $(seq $((runs > 3 ? 40 : 2))); do
	rm -rf kept_cache
	cp -r ../cache kept_cache
	for file in $(awk -v seed="$run" 'BEGIN { srand(seed) } { print rand(), $0 }' ../entries | sort | head -n 8 | cut -d ' ' -f 2); do
		size=$(wc -c <"$file")
		moment 10 >../stdout
		place=$((random / 65536 % size))
		case $((random / 256 % 6)) in
		0) truncate -s $place "$file" ;;
		1) tail -c +$((place + 1)) "$file" | head -c 1 | tr '\000-\377' '\001-\377\000' | dd of="$file" bs=1 seek=$place conv=notrunc 2>../stderr ;;
		2) head -c "$size" /dev/urandom >"$file" ;;
		3) echo >>"$file" ;;
		4) rm "$file" && mkdir "$file" ;;
		5) echo 'nook.value/1 00000000000000000000000000000000' >"$file" ;;
		esac
	done
	# shellcheck disable=SC2086
	"$nook" $error --json a.json >../stdout 2>../stderr </dev/null || problem "a cache that is damaged: exit code $?: $(cat ../stderr)"
	grep -q '^nook: cache: kept_cache/' ../stderr || problem "a cache that is damaged: found '$(cat ../stderr)', expected a line about it"
	errorsOf a.json | cmp -s - ../errors || problem "a cache that is damaged: found other errors than before, run $run"
	[ -z "$(find . -name '*.tmp*')" ] || problem "a cache that is damaged: left behind '$(find . -name '*.tmp*')'"
	rm -f a.json
done

# nook does not load a library from its working folder.
for library in libembree3.so.3 libtbb.so.12 libpng16.so.16 libOpenImageIO.so.2.4; do
	echo "no library" >$library
done
works '' gbuffer kept.obj --camera auto:1 --size 4x4 -o a.exr
rm -f lib*
there a.exr
finish
