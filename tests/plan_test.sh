#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: plan_test.sh PROGRAM. Plans of commands and of lists of levels: what they refuse, jobs that fail, are killed and continue.
set -u
nook=$(realpath "$1")
NOOK=$nook
export NOOK
. "$(dirname "$0")/command_line.sh"

# run WHAT CODE COMMAND...: its exit code.
run()
{
	what=$1
	code=$2
	shift 2
	"$@" >../stdout 2>../stderr </dev/null
	found=$?
	[ "$found" -eq "$code" ] || problem "$what: exit code $found, expected $code: $(tail -n 3 ../stderr)"
}

works '' gbuffer builtin:cornell --camera main --size 64x36 -o kept_g.exr
printf 'v 0 0 0\nv 1 0 0\nf 1 2 2\n' >kept_bad.obj
reference='reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 16'

# Refused, and nothing is left behind.
for shares in 0 -1 1000000000 x; do
	fails 1 "--shares: found '$shares', expected a whole number from 1 to 10000" plan --shares $shares -o a -- $reference -o a.exr
done
fails 1 'the command: found none' plan -o a
fails 1 '-o: found none' plan -- $reference -o a.exr
fails 1 "--for: found 'pbs', expected make, slurm or snakemake" plan --for pbs -o a -- $reference -o a.exr
fails 1 'the command: found no -o FILE' plan -o a -- $reference
fails 1 '-: found standard output' plan -o a -- $reference --json -
fails 1 '--progress: found in the command' plan -o a -- $reference -o a.exr --progress log
fails 1 '--share: found in the command' plan -o a -- $reference -o a.exr --share 1/2
fails 1 "--radius: found '-1'" plan -o a -- reference builtin:cornell --gbuffer kept_g.exr --radius -1 -o a.exr
fails 1 'the command: found plan' plan -o a -- plan -o b -- $reference -o a.exr
fails 1 "the command 'nothing'" plan -o a -- nothing
fails 2 'gone.glb: cannot be read' plan -o a -- reference gone.glb --gbuffer kept_g.exr --radius 1 -o a.exr
fails 2 'kept_g.exr/a.*: cannot be made' plan -o kept_g.exr/a -- $reference -o a.exr
fails 5 '--shares: found 4 of nook level' plan --shares 4 -o a -- level builtin:cornell -o a.glb
fails 1 '--status: found with --shares' plan --status a --shares 2
fails 2 'a/plan.json: cannot be read' plan --status a

# More shares than the work is worth; what somebody asks for is asked for; a dry run writes nothing.
works 'job.share: 16 jobs .* each; together about 1[0-9.]* times one run, expected 1.15 or less: --shares [1-3] at most$' \
	plan --dry-run --shares 16 -o a -- $reference -o a.exr
works 'job.share: 8 jobs .* MiB each$' \
	plan --dry-run --shares 8 -o a -- reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 16384 -o a.exr
works 'job.share: 16 jobs of about .* with 1 thread; asks for 7 min and 1000 MiB each' \
	plan --dry-run --shares 16 --minutes 7 --memory 1000 -o a -- $reference -o a.exr
works '"ask_memory_mib": 1000' plan --dry-run --memory 1000 -o a --json - -- $reference -o a.exr
there

# One job, with a name that a shell and Make would take apart; run, and not again.
name="it's \$(a) #b.exr"
works '' $reference --threads 1 -o kept_single.exr
works 'make -j 8' plan -o kept_jobs -- $reference -o "$name"
works '1 job, 0 done, 1 not done' plan --status kept_jobs
run 'make' 0 make -C kept_jobs
same kept_single.exr "$name" 'make: other bytes than those of the single run'
works '1 job, 1 done, 0 not done' plan --status kept_jobs
works '"done": 1' plan --status kept_jobs --json -
touch ../before
run 'make again' 0 make -C kept_jobs
[ "$name" -nt ../before ] && problem 'make again: made it again'
fails 1 "kept_jobs: found the plan of .*, expected that of .*, or a new folder" plan -o kept_jobs -- $reference -o b.exr
rm "$name"
works '0 done, 1 not done' plan --status kept_jobs
run 'make, after its output is gone' 0 make -C kept_jobs
there "$name"
mkdir kept_wrong
sed 's/"outputs": \[/"outputs": 7, "x": [/' kept_jobs/plan.json >kept_wrong/plan.json
fails 3 'kept_wrong/plan.json: jobs.0..outputs: ' plan --status kept_wrong

# Shares: the folder may be elsewhere; results that were lost are made again; another version of nook; an input that changes.
works '9 jobs' plan --shares 8 -o kept_shares -- $reference -o a.exr
mkdir ../other
mv kept_shares ../other
cp kept_g.exr ../other
run 'shares, in another place' 0 make -C ../other/kept_shares -j 2
same kept_single.exr ../other/a.exr 'shares: other bytes than those of the single run'
works '9 jobs, 9 done' plan --status ../other/kept_shares
rm -r ../other/kept_shares/cache ../other/kept_shares/done
works '9 jobs, 0 done' plan --status ../other/kept_shares
run 'results that are lost' 0 make -C ../other/kept_shares -j 2
works '' gbuffer builtin:cornell --camera main --size 60x36 -o ../other/kept_g.exr
works '9 jobs, 0 done' plan --status ../other/kept_shares
run 'another input' 0 make -C ../other/kept_shares -j 2
works '' reference builtin:cornell --gbuffer ../other/kept_g.exr --radius 1 --rays 16 -o kept_again.exr
same kept_again.exr ../other/a.exr 'another input: other bytes than those of the single run'
sed -i "s/^version=.*/version='0.0.1'/" ../other/kept_shares/job.sh
run 'another version' 5 sh ../other/kept_shares/job.sh 9
grep -q 'expected nook 0.0.1, for which this was planned' ../stderr || problem "another version: $(cat ../stderr)"
works '' plan --shares 8 -o kept_shares -- $reference -o a.exr
run 'a job that is not there' 1 sh kept_shares/job.sh 10

# A job that fails says why; its input is mended, and so is a file that the input names.
works '' plan -o kept_fails -- volumes kept_bad.obj --distance 1 -o a.glb
run 'a job that fails' 2 make -C kept_fails
grep -q '^job.sh: job: nook: kept_bad.obj: ' ../stderr || problem "a job that fails: $(cat ../stderr)"
printf 'mtllib kept_a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >kept_bad.obj
echo 'newmtl a' >kept_a.mtl
works '' plan -o kept_fails -- volumes kept_bad.obj --distance 1 -o a.glb
run 'a job that is mended' 0 make -C kept_fails
touch ../before
sleep 0.01
echo 'newmtl b' >kept_a.mtl
works '0 done' plan --status kept_fails
run 'a material that changed' 0 make -C kept_fails
[ a.glb -nt ../before ] || problem 'a material that changed: nothing was made'
there a.glb

# Lists of levels.
list()
{
	cat >kept_list.json <<-EOT
		{"schema": "nook.levels/1", "values": {"camera": "main", "rays": "16"},
		 "steps": [
		  {"name": "depth", "command": ["gbuffer", "{level}", "--camera", "auto:1", "--size", "64x36", "-o", "{name}.g.exr"]},
		  {"name": "rays", "shares": 3,
		   "command": ["reference", "{level}", "--gbuffer", "{name}.g.exr", "--radius", "1", "--rays", "{rays}", "-o", "{name}.exr"]}],
		 "levels": [{"name": "one", "level": "builtin:cornell"}, {"name": "two", "level": "$1", "values": {"rays": "$2"}}]}
	EOT
}
# made REGEX: files of the output folder that are newer than the mark, one line.
made()
{
	find kept_out -maxdepth 1 -name '*.exr' -newer ../before | sort | tr '\n' ' '
}
list builtin:suburb 4
works '10 jobs, estimated' plan kept_list.json -o kept_out --dry-run
works 'kept_out/plan: make -j 8' plan kept_list.json -o kept_out
run 'a list' 0 make -C kept_out/plan -j 2
works '10 jobs, 10 done' plan --status kept_out/plan
works '' gbuffer builtin:cornell --camera auto:1 --size 64x36 -o kept_one.exr
works '' reference builtin:cornell --gbuffer kept_one.exr --radius 1 --rays 16 -o kept_single.exr
same kept_single.exr kept_out/one.exr 'a list: other bytes than those of the single run'
touch ../before
list builtin:suburb 8
works '' plan kept_list.json -o kept_out
run 'a list that changed' 0 make -C kept_out/plan -j 2
[ "$(made)" = 'kept_out/two.exr ' ] || problem "a list that changed: found '$(made)' made, expected kept_out/two.exr"
list gone.glb 8
fails 2 'kept_list.json: two.depth: ../gone.glb: cannot be read' plan kept_list.json -o kept_out
list builtin:suburb -1
fails 3 "kept_list.json: two.rays: --rays: found '-1'" plan kept_list.json -o kept_out
fails 1 '--shares, --minutes, --memory: found with a list of levels' plan kept_list.json -o kept_out --shares 2
sed -i 's/{rays}/{raise}/' kept_list.json
fails 3 "kept_list.json: steps\[1\].command\[7\]: found '{raise}'" plan kept_list.json -o kept_out
sed -i 's/nook.levels/nook.other/' kept_list.json
fails 3 'kept_list.json: schema: ' plan kept_list.json -o kept_out
list builtin:suburb 8
works 'sh submit.sh' plan kept_list.json -o kept_out --for slurm
works 'snakemake --cores 8' plan kept_list.json -o kept_out --for snakemake
there
finish
