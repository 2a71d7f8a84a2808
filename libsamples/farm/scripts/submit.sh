#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: submit.sh [SBATCH_OPTION...]    gives Slurm what is left of the plan in this folder: an array for each group of jobs, which
#                                        begins when those that it waits for have ended well
# Written by nook plan, the same for every plan. Prints the numbers of Slurm's jobs. Give it again after jobs have failed or were killed;
# while Slurm has what was given before, it gives nothing.
# NOOK_PLAN: this folder as the machines of the farm see it, where that is another name. NOOK_ARRAY: the most tasks of an array
# (default 1000, what Slurm takes unless MaxArraySize says more).
set -eu
cd -- "$(dirname -- "$0")"
. ./plan.sh
NOOK_PLAN=${NOOK_PLAN:-$(pwd)}
export NOOK_PLAN
array=${NOOK_ARRAY:-1000}
if ! command -v sbatch >/dev/null; then
	echo "submit.sh: found no sbatch, expected Slurm's commands on this machine" >&2
	exit 5
fi

if [ -s state/slurm ]; then
	queued=$(squeue --noheader --jobs="$(tr '\n' ',' <state/slurm)" --format=%i 2>/dev/null | wc -l)
	if [ "$queued" -gt 0 ]; then
		echo "submit.sh: found $queued jobs of this plan in Slurm, expected none: wait, or scancel $(tr '\n' ' ' <state/slurm)" >&2
		exit 4
	fi
fi
: >state/slurm

# ranges BASE: numbers, a line each → "1-4,7", less BASE.
ranges()
{
	awk -v base="$1" '
		function flush() { if (from != "") { printf "%s%s", comma, from == to ? from : from "-" to; comma = "," } }
		{ number = $1 - base; if (from != "" && number == to + 1) { to = number } else { flush(); from = to = number } }
		END { flush() }'
}

# group NUMBER DEPTH FIRST LAST MINUTES MIB THREADS NAME AFTER...
group()
{
	group=$1 first=$3 last=$4 minutes=$5 memory=$6 threads=$7 name=$8
	shift 8
	after=
	for other in "$@"; do
		eval "after=\$after\$ids_$other"
	done
	ids=
	while [ "$first" -le "$last" ]; do
		to=$((first + array - 1 < last ? first + array - 1 : last))
		NOOK_BASE=$((first - 1))
		export NOOK_BASE
		tasks=$(sh job.sh --left "$first" "$to" | ranges "$NOOK_BASE")
		if [ -n "$tasks" ]; then
			# shellcheck disable=SC2086 # options
			id=$(sbatch --parsable --job-name="$name" --array="$tasks" ${after:+--dependency=afterok$after --kill-on-invalid-dep=yes} \
				--time="$minutes" --mem="${memory}M" --cpus-per-task="$threads" --requeue --open-mode=append --export=ALL \
				--chdir="$NOOK_PLAN" --output="$NOOK_PLAN/log/slurm-%A_%a.out" $options job.sbatch)
			id=${id%%;*}
			echo "$name: job $id, tasks $tasks"
			echo "$id" >>state/slurm
			ids=$ids:$id
		fi
		first=$((to + 1))
	done
	eval "ids_$group=\$ids"
}
options="$*"
. ./groups
