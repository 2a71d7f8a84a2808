#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: submit.sh [SBATCH_OPTION...]    gives Slurm the plan in this folder: an array for each group of jobs, which begins when the jobs
#                                        that it waits for have ended well
# Written by nook plan. Prints the numbers of Slurm's jobs. Run it again after jobs have failed or were killed: jobs that are up to date
# end at once. NOOK_ARRAY: the largest array (default 1000, Slurm's own limit unless MaxArraySize says more).
set -eu
cd -- "$(dirname -- "$0")"
array=${NOOK_ARRAY:-1000}
if ! command -v sbatch >/dev/null; then
	echo "submit.sh: found no sbatch, expected Slurm's commands on this machine" >&2
	exit 5
fi
if [ -s slurm ] && [ -n "$(squeue --noheader --jobs="$(tr '\n' ',' <slurm)" --format=%i 2>/dev/null)" ]; then
	echo "submit.sh: found jobs of this plan in Slurm, expected none: wait, or scancel $(tr '\n' ' ' <slurm)" >&2
	exit 4
fi
: >slurm
mkdir -p log

# group NUMBER FIRST LAST MINUTES MIB THREADS NAME AFTER...
group()
{
	group=$1 first=$2 last=$3 minutes=$4 memory=$5 threads=$6 name=$7
	shift 7
	after=
	for other in "$@"; do
		eval "after=\$after\$ids_$other"
	done
	ids=
	while [ "$first" -le "$last" ]; do
		to=$((first + array - 1 < last ? first + array - 1 : last))
		# shellcheck disable=SC2086 # options
		id=$(sbatch --parsable --job-name="$name" --array="1-$((to - first + 1))" ${after:+--dependency=afterok$after --kill-on-invalid-dep=yes} \
			--time="$minutes" --mem="${memory}M" --cpus-per-task="$threads" --requeue --open-mode=append --chdir="$PWD" \
			--output="log/slurm-%A_%a" $options --wrap="sh job.sh \$(($first - 1 + SLURM_ARRAY_TASK_ID))")
		id=${id%%;*}
		echo "$name: job $id, tasks 1-$((to - first + 1))"
		echo "$id" >>slurm
		ids=$ids:$id
		first=$((to + 1))
	done
	eval "ids_$group=\$ids"
}
options="$*"
. ./groups
