#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: farm.sh ENGINE PROGRAM SCRATCH    ENGINE: slurm, snakemake or make
#        farm.sh speed PROGRAM SCRATCH     Slurm's two slots against one process of one thread, by turns ROUNDS times (a reference twice, a report
#                                          once): seconds of each, and the ratio of their sums
# Traces two levels in shares on an engine that it starts by itself, kills a task on the way and starts it again, and compares the results
# with single runs, byte for byte. Slurm is a controller and one machine of two slots, with keys, sockets and logs in the folder SCRATCH, and
# is stopped again. `speed` bakes LEVEL (builtin:courtyard) at SIZE (1280x720), RAYS (256) and HOW (--radius 1.5), and reports on LEVELS. Packages:
# scripts/setup.sh farm. Ends with 77 where the engine cannot run here, and says why in one line.
set -u
engine=${1-}
program=$(realpath -- "${2-}") && [ -x "$program" ] && [ -n "${3-}" ] || {
	echo "farm.sh: expected ENGINE PROGRAM SCRATCH" >&2
	exit 1
}
mkdir -p -- "$3" && scratch=$(realpath -- "$3") || exit 1
NOOK=$program
PATH=$PATH:/usr/sbin:/sbin
export NOOK PATH
shares=${SHARES:-4}
level=${LEVEL:-builtin:courtyard}
levels=${LEVELS:-builtin:courtyard builtin:suburb builtin:cornell builtin:heightfield:20000}
size=${SIZE:-320x180}
rays=${RAYS:-256}

skip()
{
	echo "farm.sh: skipped: $engine: $*"
	exit 77
}

problem()
{
	echo "farm.sh: FAILED: $engine: $*" >&2
	stopSlurm
	exit 1
}

# waitsFor SECONDS COMMAND...: retries until it succeeds.
waitsFor()
{
	tries=$(($1 * 5))
	shift
	until "$@" >/dev/null 2>&1; do
		tries=$((tries - 1))
		[ $tries -gt 0 ] || return 1
		sleep 0.2
	done
}

# --- A private Slurm.

pids=
stopSlurm()
{
	[ -n "$pids" ] || return
	scontrol shutdown >/dev/null 2>&1
	for pid in $pids; do
		waitsFor 5 eval "! kill -0 $pid" || kill -s KILL "$pid" 2>/dev/null
	done
	pids=
	[ ! -e "$scratch/munge/pid" ] || kill "$(cat "$scratch/munge/pid")" 2>/dev/null
}

startMunge()
{
	mkdir -p "$scratch/munge" && chmod 700 "$scratch/munge"
	dd if=/dev/urandom of="$scratch/munge/key" bs=128 count=1 2>/dev/null
	chmod 400 "$scratch/munge/key"
	munged --force --key-file="$scratch/munge/key" --socket="$scratch/munge/socket" --pid-file="$scratch/munge/pid" \
		--log-file="$scratch/munge/log" --seed-file="$scratch/munge/seed" --num-threads=1 2>"$scratch/munge/err" ||
		skip "munged does not start: $(head -n 1 "$scratch/munge/err")"
}

# Without cgroups, since a container lacks the permissions.
slurmConfiguration()
{
	port=$((20000 + $$ % 20000))
	cat <<-EOT
		ClusterName=nook
		SlurmctldHost=$(hostname -s)(127.0.0.1)
		SlurmctldPort=$port
		SlurmdPort=$((port + 1))
		SlurmUser=$(id -un)
		SlurmdUser=$(id -un)
		AuthType=auth/munge
		AuthInfo=socket=$scratch/munge/socket
		CryptoType=crypto/munge
		StateSaveLocation=$scratch/slurm/state
		SlurmdSpoolDir=$scratch/slurm/spool
		SlurmctldPidFile=$scratch/slurm/slurmctld.pid
		SlurmdPidFile=$scratch/slurm/slurmd.pid
		SlurmctldLogFile=$scratch/slurm/slurmctld.log
		SlurmdLogFile=$scratch/slurm/slurmd.log
		ProctrackType=proctrack/linuxproc
		TaskPlugin=task/none
		SelectType=select/cons_tres
		SelectTypeParameters=CR_Core
		JobAcctGatherType=jobacct_gather/none
		MpiDefault=none
		SchedulerParameters=sched_interval=1,batch_sched_delay=0,sched_min_interval=0
		InactiveLimit=0
		KillWait=2
		ReturnToService=2
		SlurmctldParameters=enable_configless
		NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=2 Boards=1 SocketsPerBoard=1 CoresPerSocket=2 ThreadsPerCore=1 RealMemory=4000 State=UNKNOWN
		PartitionName=bake Nodes=ALL Default=YES MaxTime=INFINITE State=UP
	EOT
}

startSlurm()
{
	for command in munged slurmctld slurmd sbatch squeue scancel scontrol; do
		command -v $command >/dev/null || skip "found no $command, expected Debian's slurm-wlm and munge (scripts/setup.sh farm)"
	done
	startMunge
	mkdir -p "$scratch/slurm/state" "$scratch/slurm/spool"
	SLURM_CONF=$scratch/slurm/slurm.conf
	export SLURM_CONF
	slurmConfiguration >"$SLURM_CONF"
	slurmctld -D -i -f "$SLURM_CONF" >"$scratch/slurm/out" 2>&1 &
	pids=$!
	slurmd -D -f "$SLURM_CONF" -N "$(hostname -s)" >>"$scratch/slurm/out" 2>&1 &
	pids="$pids $!"
	trap stopSlurm EXIT
	trap 'exit 1' HUP INT TERM
	waitsFor 30 eval 'sinfo -h -o %T | grep -q idle' || {
		why=$(grep -h -i -E 'fatal|error' "$scratch/slurm/out" "$scratch"/slurm/*.log 2>/dev/null | head -n 1)
		stopSlurm
		skip "no machine is idle after 30 s: $why"
	}
}

# Requeued jobs would wait two minutes.
queueIsEmpty()
{
	for task in $(squeue -h -r -t PENDING -o '%i %r' | sed -n 's/ BeginTime$//p'); do
		scontrol update JobId="$task" StartTime=now
	done
	[ -z "$(squeue -h)" ]
}

# --- What is baked.

plan()
{
	"$program" plan --for "$1" --shares "$shares" -o "jobs_$2" --memory 300 -- reference "builtin:$2" --gbuffer "$2.g.exr" --radius 1 \
		--rays "$rays" -o "$2.exr" >"plan_$2.txt" || problem "nook plan: $(cat "plan_$2.txt")"
}

singleRuns()
{
	for level in cornell courtyard; do
		"$program" gbuffer "builtin:$level" --camera auto:1 --size "$size" -o "$level.g.exr" &&
			"$program" reference "builtin:$level" --gbuffer "$level.g.exr" --radius 1 --rays "$rays" -o "$level.single.exr" ||
			problem "$level: no single run"
	done
}

# runningJob FOLDER: the process of a share of that plan. Other plans with the same names may be under way elsewhere.
runningJob()
{
	for pid in $(pgrep -f -- "--cache .*$1/cache .*--share"); do
		[ "$(readlink "/proc/$pid/cwd")" != "$scratch" ] || { echo "$pid" && return; }
	done
	return 1
}

# isFinished FOLDER: whether its result is there.
isFinished()
{
	[ -e "${1#jobs_}.exr" ]
}

# killOne FOLDER: sends SIGKILL to the nook of a running job, unless all jobs are finished before.
killOne()
{
	waitsFor 60 eval "runningJob $1 || isFinished $1" || problem "found no job that runs in $1"
	found=$(runningJob "$1") && kill -s KILL "$found" 2>/dev/null || return 1
	echo "killed a share of $1"
}

compareAll()
{
	for level in cornell courtyard; do
		cmp "$level.single.exr" "$level.exr" || problem "$level: found other bytes than those of the single run"
		"$program" plan --status "jobs_$level" | head -n 1 | grep -q ' 0 not done' ||
			problem "$level: found $("$program" plan --status "jobs_$level" | head -n 3)"
	done
}

# Runs a level's engine with COMMAND until everything is done, the first time with a job killed on the way.
withOneKilled()
{
	level=$1
	shift
	( "$@" ) >"log_$level" 2>&1 &
	running=$!
	killOne "jobs_$level" || echo "the job had ended before it was to be killed"
	wait $running
	( "$@" ) >>"log_$level" 2>&1 || problem "$level: not done after a second start: $(tail -n 3 "log_$level")"
}

bake()
{
	for level in cornell courtyard; do
		case $engine in
		make)
			plan make $level
			withOneKilled $level make -C "jobs_$level" -j 2
			;;
		snakemake)
			plan snakemake $level
			withOneKilled $level snakemake --directory "jobs_$level" --snakefile "jobs_$level/Snakefile" --cores 2 --quiet --rerun-incomplete \
				--nolock
			;;
		slurm)
			plan slurm $level
			sh "jobs_$level/submit.sh" --partition=bake >"log_$level" 2>&1 || problem "$(cat "log_$level")"
			;;
		esac
	done
	[ "$engine" = slurm ] || return
	killOne jobs_cornell || killOne jobs_courtyard || echo "no job was killed"
	waitsFor 300 queueIsEmpty || problem "jobs still wait after 300 s: $(squeue)"
	for level in cornell courtyard; do # killed jobs, and those waiting for them
		sh "jobs_$level/submit.sh" --partition=bake >>"log_$level" 2>&1 || problem "$(cat "log_$level")"
	done
	waitsFor 300 queueIsEmpty || problem "jobs still wait after 300 s: $(squeue)"
}

# --- Speed-up.

now()
{
	date +%s.%N
}

# since BEGIN: elapsed seconds.
since()
{
	echo "$1 $(now)" | awk '{ printf "%.2f\n", $2 - $1 }'
}

# oneProcess NAME OUTPUT VERB...: seconds of one process with one thread.
oneProcess()
{
	output=single_$2
	shift 2
	begin=$(now)
	"$program" "$@" --threads 1 -o "$output" 2>err || problem "nook $*: $(cat err)"
	since "$begin" >>one
}

# twoSlots NAME OUTPUT VERB...: seconds of two shares, from the plan to the last byte.
twoSlots()
{
	what=$1
	output=$2
	shift 2
	rm -rf "jobs_$what" "$output"
	begin=$(now)
	"$program" plan --for slurm --shares 2 -o "jobs_$what" --memory 1500 -- "$@" -o "$output" >plan.txt || problem "nook plan: $(cat plan.txt)"
	sh "jobs_$what/submit.sh" --partition=bake >log 2>&1 || problem "$(cat log)"
	waitsFor 3000 queueIsEmpty || problem "jobs still wait: $(squeue)"
	since "$begin" >>two
	[ -s "$output" ] || problem "$what: not made: $("$program" plan --status "jobs_$what")"
}

# speedOf ROUNDS NAME OUTPUT VERB...: runs both alternately, each first in every other round.
speedOf()
{
	rounds=$1
	shift
	rm -f one two
	for round in $(seq "$rounds"); do
		[ $((round % 2)) -eq 0 ] || oneProcess "$@"
		twoSlots "$@"
		[ $((round % 2)) -eq 1 ] || oneProcess "$@"
	done
	[ "$1" != reference ] || cmp "single_$2" "$2" || problem "$1: found other bytes than those of the single run"
	paste one two | awk -v what="$1" '
		{ one = one " " $1; two = two " " $2; a += $1; b += $2 }
		END { printf "%s: one process%s s, two slots of Slurm%s s: %.2f x\n", what, one, two, a / b }'
}

speed()
{
	[ ! -f "$level" ] || { cp -- "$level" . && level=$(basename -- "$level"); } # as the farm would mount it
	"$program" gbuffer "$level" --camera auto:1 --size "${SIZE:-1280x720}" -o speed.exr || problem "$level: no depth"
	# shellcheck disable=SC2086 # words
	speedOf "${ROUNDS:-2}" reference reference.exr reference "$level" --gbuffer speed.exr ${HOW:---radius 1.5} --rays "$rays"
	# shellcheck disable=SC2086 # a list
	speedOf "${ROUNDS:-1}" report report.html report error $levels --quick
}

[ ! -f "$level" ] || level=$(realpath -- "$level")
cd -- "$scratch" || exit 1
rm -rf jobs_* ./*.exr log_*
case $engine in
slurm | speed) startSlurm ;;
snakemake) command -v snakemake >/dev/null || skip "found no snakemake, expected Debian's package (scripts/setup.sh farm)" ;;
make) command -v make >/dev/null || skip "found no make" ;;
*)
	echo "farm.sh: found '$engine', expected slurm, snakemake, make or speed" >&2
	exit 1
	;;
esac
if [ "$engine" = speed ]; then
	speed
	stopSlurm
	exit
fi
singleRuns
bake
compareAll
stopSlurm
echo "farm.sh: $engine: two levels in $shares shares each, one task killed: the bytes of the single runs"
