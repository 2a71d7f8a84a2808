# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: interrupted_test.sh PROGRAM. Signals, closed pipes and full disks: no temporary file, incomplete output or process remains.
set -u
nook=$1
. "$(dirname "$0")/every_verb.sh"
. "$(dirname "$0")/command_line.sh"

number()
{
	case $1 in HUP) echo 1 ;; INT) echo 2 ;; KILL) echo 9 ;; TERM) echo 15 ;; esac
}

# children PROCESS: its live child processes.
children()
{
	awk -v parent="$1" 'FNR == 1 { state = process = "" } /^State:/ { state = $2 } /^Pid:/ { process = $2 }
		/^PPid:/ && $2 == parent && state != "Z" { print process }' /proc/[0-9]*/status 2>/dev/null
}

areGone()
{
	for process in $1; do
		[ -d "/proc/$process" ] && ! grep -q '^State:.*Z' "/proc/$process/status" 2>/dev/null && return 1
	done
	return 0
}

temporaries()
{
	find . -name '*.tmp*'
}

hasTemporary()
{
	[ -n "$(temporaries)" ]
}

# waits WHAT COMMAND...: retries until it succeeds.
waits()
{
	what=$1
	shift
	tries=0
	until "$@"; do
		tries=$((tries + 1))
		if [ "$tries" -gt 1200 ]; then
			problem "$what: waited in vain"
			return 1
		fi
		sleep 0.1
	done
}

# interrupted SIGNAL ARGUMENTS: all outputs are written except one, a pipe that nobody reads. Then sends the signal.
interrupted()
{
	signal=$1
	shift
	before=$(find . | sort)
	# A shell starts background processes with SIGINT ignored.
	env --default-signal=INT "$nook" "$@" --json kept_pipe >../stdout 2>../stderr </dev/null &
	process=$!
	waits "nook $*" hasTemporary || cat ../stderr
	workers=$(children $process)
	kill -s "$signal" $process
	wait $process 2>/dev/null
	found=$?
	[ "$found" -eq $((128 + $(number "$signal"))) ] || problem "nook $*, SIG$signal: status $found, expected $((128 + $(number "$signal")))"
	waits "nook $*, SIG$signal: its workers" areGone "$workers"
	[ -s ../stderr ] && problem "nook $*, SIG$signal: found '$(cat ../stderr)' on stderr, expected nothing"
	[ "$signal" = KILL ] && rm -f $(temporaries)
	[ "$(find . | sort)" = "$before" ] || problem "nook $*, SIG$signal: left behind '$(temporaries)'"
	find . -name '*.tmp*' -exec rm {} +
}

makeInputs
mkfifo kept_pipe
everyVerb >../verbs
while read -r arguments; do
	# shellcheck disable=SC2086
	interrupted TERM $arguments
done <../verbs
for signal in INT HUP KILL; do
	# shellcheck disable=SC2046
	interrupted $signal $(grep '^gbuffer' ../verbs)
done

# At any time while pictures are made, read and written: all of the outputs, or none.
for moment in 0 0.05 0.1 0.2 0.4 0.8 1.6; do
	"$nook" reference builtin:suburb --gbuffer kept_g.exr --radius 1 --rays 4 -o a.exr -o b.exr -o c.png >../stdout 2>../stderr &
	process=$!
	sleep $moment
	kill -s TERM $process 2>/dev/null
	wait $process 2>/dev/null
	hasTemporary && problem "SIGTERM after $moment s: left behind '$(temporaries)'"
	case $(echo ?.*) in '?.*' | 'a.exr b.exr c.png') ;; *) problem "SIGTERM after $moment s: found '$(echo ?.*)', expected all or none" ;; esac
	rm -f a.exr b.exr c.png
done

# A signal that the parent set to be ignored.
(
	trap '' HUP
	exec "$nook" pattern --domain disk --count 3 --method vogel -o a.json --json kept_pipe
) >../stdout 2>../stderr &
process=$!
waits "ignored SIGHUP" hasTemporary
kill -s HUP $process
cat kept_pipe >../read
wait $process || problem "ignored SIGHUP: status $?, expected 0"
there a.json

# A file size limit acts like a full disk.
printf '#!/bin/sh\nulimit -f 1\nexec "%s" "$@"\n' "$nook" >../limited
chmod +x ../limited
program=$nook
nook=../limited
fails 2 'a.exr: cannot be written: File too large' gbuffer builtin:cornell --camera main --size 64x64 -o a.exr
fails 2 'b.svg: cannot be written: File too large' pattern --domain disk --count 9 --method vogel -o b.svg -o a.csv
fails 2 'a.glb: cannot be written: File too large' level builtin:cornell -o a.glb
nook=$program

# A pipe whose reader has closed it.
cat kept_pipe >../read &
reader=$!
exec 5>kept_pipe
kill $reader
wait $reader 2>/dev/null
for arguments in "pattern --domain disk --count 3 --method vogel --json -" "info kept_g.exr" "--help"; do
	# shellcheck disable=SC2086
	"$nook" $arguments >&5 2>../stderr
	found=$?
	[ "$found" -eq 2 ] || problem "nook $arguments to a closed pipe: exit code $found, expected 2"
	[ "$(cat ../stderr)" = "nook: standard output: cannot be written: Broken pipe" ] || problem "nook $arguments to a closed pipe: '$(cat ../stderr)'"
done
exec 5>&-
there
finish
