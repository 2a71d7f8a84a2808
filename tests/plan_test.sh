#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: plan_test.sh PROGRAM. Plans: what they refuse, what they write for each engine, jobs that fail, are killed and go on; batches.
set -u
nook=$(realpath "$1")
NOOK=$nook
export NOOK
here=$(cd "$(dirname "$0")" && pwd)
. "$(dirname "$0")/command_line.sh"

# run WHAT CODE COMMAND...: its exit code.
run()
{
	what=$1
	code=$2
	shift 2
	checks=$((checks + 1))
	"$@" >../stdout 2>../stderr </dev/null
	found=$?
	[ "$found" -eq "$code" ] || problem "$what: exit code $found, expected $code: $(tail -n 3 ../stderr)"
}

# waits WHAT COMMAND...: until it succeeds.
waits()
{
	what=$1
	shift
	tries=0
	until "$@" >/dev/null 2>&1; do
		tries=$((tries + 1))
		[ $tries -le 300 ] || { problem "$what: waited in vain"; return 1; }
		sleep 0.1
	done
}

works '' gbuffer builtin:cornell --camera main --size 64x36 -o kept_g.exr
printf 'v 0 0 0\nv 1 0 0\nf 1 2 2\n' >kept_bad.obj
reference='reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 16'

# Refused, and nothing is left behind.
for parts in 0 -1 1000000000 x; do
	fails 1 "--parts: found '$parts', expected a whole number from 1 to 10000" plan --parts $parts -o a -- $reference -o a.exr
done
fails 1 'the command: found none' plan -o a
fails 1 '-o: found none' plan -- $reference -o a.exr
fails 1 "--for: found 'pbs', expected shell, make, slurm, snakemake, opencue or openjd" plan --for pbs -o a -- $reference -o a.exr
fails 1 'the command: found no -o FILE' plan -o a -- $reference
fails 1 '-: found standard output' plan -o a -- $reference --json -
fails 1 '--progress: found in the command' plan -o a -- $reference -o a.exr --progress log
fails 1 '--part: found in the command' plan -o a -- $reference -o a.part --part 1/2
fails 1 "--radius: found '-1'" plan -o a -- reference builtin:cornell --gbuffer kept_g.exr --radius -1 -o a.exr
fails 1 'the command: found plan' plan -o a -- plan -o b -- $reference -o a.exr
fails 1 "the command 'nothing'" plan -o a -- nothing
fails 1 '--root: found that ../a is not in ' plan -o ../a -- $reference -o a.exr
fails 1 '/etc/passwd: found a name outside ' plan -o a -- $reference -o a.exr --gbuffer /etc/passwd
fails 2 'gone.glb: cannot be read' plan -o a -- reference gone.glb --gbuffer kept_g.exr --radius 1 -o a.exr
fails 2 '--root: gone: found no such folder' plan --root gone -o a -- $reference -o a.exr
fails 2 'kept_g.exr/a.*: cannot be made' plan -o kept_g.exr/a -- $reference -o a.exr
fails 5 '--parts: found 4 of nook level' plan --parts 4 -o a -- level builtin:cornell -o a.glb
fails 1 '--status: found with --parts' plan --status a --parts 2
fails 2 'a/plan.json: cannot be read' plan --status a

# Parts that are too many for the work.
works 'reference: 16 jobs .* each; together about 1[0-9.]* times one run, expected 1.15 or less: --parts [1-3] at most$' \
	plan --dry-run --parts 16 -o a -- $reference -o a.exr
works 'reference: 8 jobs .* MiB each$' \
	plan --dry-run --parts 8 -o a -- reference builtin:cornell --gbuffer kept_g.exr --radius 1 --rays 16384 -o a.exr

# A dry run says and writes nothing; what somebody asks for is asked for.
works 'reference: 16 jobs of about .* with 1 thread; asks for 7 min and 1000 MiB each' \
	plan --dry-run --parts 16 --minutes 7 --memory 1000 -o a -- $reference -o a.exr
works '"ask_memory_mib": 1000' plan --dry-run --memory 1000 -o a --json - -- $reference -o a.exr
there

# One job, with names that a shell and Make would take apart; run, and not again.
name="it's \$(a) #b.exr"
works '' $reference --threads 1 -o kept_single.exr
works 'sh run.sh' plan -o kept_jobs -- $reference -o "$name"
works ' 1 left, 0 running, 0 done' plan --status kept_jobs
run 'run.sh' 0 sh kept_jobs/run.sh 2
same kept_single.exr "$name" 'run.sh: other bytes than those of the single run'
works ' 0 left, 0 running, 1 done, 0 failed, 0 killed' plan --status kept_jobs
mkdir kept_wrong
sed 's/"memory_bytes": [0-9.e+]*/"memory_bytes": 18446744073709551615/' kept_jobs/plan.json >kept_wrong/plan.json
fails 3 'kept_wrong.plan.json: groups.0..memory_bytes: .*expected a number from 0 to 1e.18' plan --status kept_wrong
cp -p "$name" ../before
run 'run.sh again' 0 sh kept_jobs/run.sh
checks=$((checks + 1))
[ "$name" -nt ../before ] && problem 'run.sh again: made it again'
works 'make -j 8' plan --for make -o kept_jobs -- $reference -o "$name"
run 'make' 0 make -C kept_jobs
fails 1 "kept_jobs: found the plan of .*, expected that of .*, or a new folder" plan -o kept_jobs -- $reference -o b.exr
rm "$name"
works ' 1 left, 0 running, 0 done' plan --status kept_jobs
run 'make, after its output is gone' 0 sh kept_jobs/run.sh
there "$name"

# Two planners.
checks=$((checks + 1))
flock kept_jobs/lock "$nook" plan -o kept_jobs -- $reference -o "$name" 2>../stderr && problem 'two planners: found 0, expected 4'
grep -q 'kept_jobs: found another nook that plans or runs here' ../stderr || problem "two planners: $(cat ../stderr)"

# Parts: the folder may be elsewhere; one part lost and made again; another version of nook.
works '17 jobs' plan --parts 16 -o kept_parts -- $reference -o a.exr
mkdir ../other
mv kept_parts ../other
cp kept_g.exr ../other
run 'parts, in another place' 0 sh ../other/kept_parts/run.sh 2
same kept_single.exr ../other/a.exr 'parts: other bytes than those of the single run'
rm ../other/kept_parts/parts/reference.part07.part
run 'a part that is lost' 0 sh ../other/kept_parts/run.sh 2
sed -i "s/^version=.*/version='0.0.1'/" ../other/kept_parts/plan.sh
rm ../other/a.exr
run 'another version' 5 sh ../other/kept_parts/job.sh 17
checks=$((checks + 1))
grep -q 'expected nook 0.0.1, for which this was planned' ../stderr || problem "another version: $(cat ../stderr)"
run 'a job that is not there' 1 sh ../other/kept_parts/job.sh 18

# A job that fails says so; its input is mended.
works '' plan -o kept_fails -- volumes kept_bad.obj --distance 1 -o a.glb
run 'a job that fails' 4 sh kept_fails/run.sh
works 'volumes: failed with 3: kept_bad.obj: ' plan --status kept_fails
works '"exit_code": 3, "error": "kept_bad.obj: ' plan --status kept_fails --json -
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >kept_bad.obj
works '' plan -o kept_fails -- volumes kept_bad.obj --distance 1 -o a.glb
run 'a job that is mended' 0 sh kept_fails/run.sh
printf 'v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n' >kept_bad.obj
works '' plan -o kept_fails -- volumes kept_bad.obj --distance 1 -o a.glb
works ' 1 left' plan --status kept_fails
there a.glb

# A file that the level's file names changes, however its name is written.
changed()
{
	works '' plan -o kept_names -- level "$1" -o a.glb
	grep '"key"' kept_names/plan.json >../keys
	echo other >"$2"
	works '' plan -o kept_names -- level "$1" -o a.glb
	checks=$((checks + 1))
	grep '"key"' kept_names/plan.json | cmp -s - ../keys && problem "$2, which $1 names, changed: found the plan as before"
	rm -r kept_names
}
echo one | tee 'kept two words.bin' kept_a.mtl kept_b.mtl kept_m.png >kept_c.png
echo '{"asset": {"version": "2.0"}, "buffers": [{"uri": "kept%20two%20words.bin", "byteLength": 4}]}' >kept_names.gltf
changed kept_names.gltf 'kept two words.bin'
printf 'mtllib kept_a.mtl kept_b.mtl\n' >kept_names.obj
changed kept_names.obj kept_a.mtl
printf '\tmap_d -clamp on kept_m.png\r\n map_Kd\tkept_c.png\n' >kept_b.mtl
changed kept_names.obj kept_m.png
changed kept_names.obj kept_c.png

# Killed with its script: seen, and run again.
works '' plan -o kept_killed -- stress --kernel prism --cases 100000000 --json a.json
sh kept_killed/job.sh 1 >../log 2>&1 &
waits 'a job that is to be killed' test -s kept_killed/log/stress.progress
works ' 1 running' plan --status kept_killed
fails 4 'kept_killed: found 1 jobs of the plan there running' plan --parts 2 -o kept_killed -- stress --kernel prism --cases 100000000 --json a.json
child=$(pgrep -f -- '--progress .*/kept_killed/log/stress.progress' | head -n 1)
kill -s KILL "$(ps -o ppid= -p "$child" | tr -d ' ')" "$child"
wait
touch -d '10 minutes ago' kept_killed/state/stress.alive
works ' 1 killed' plan --status kept_killed

# The files of each engine.
for engine in slurm snakemake opencue openjd; do
	works "^kept_$engine: " plan --for $engine --parts 16 -o kept_$engine -- $reference -o a.exr
done
mkdir ../few
for tool in dirname sed grep awk; do ln -s "$(command -v $tool)" ../few; done
run 'a plan without sbatch' 0 env PATH="$PWD/../few" "$nook" plan --for slurm --parts 16 -o kept_slurm -- $reference -o a.exr
checks=$((checks + 1))
grep -q '^sbatch: not found on this machine' ../stdout || problem "a plan without sbatch: found '$(cat ../stdout)'"
run 'submit.sh without sbatch' 5 env PATH="$PWD/../few" /bin/sh kept_slurm/submit.sh
mkdir ../bin
printf '#!/bin/sh\necho "$@" >>"%s"\necho $((100 + $(wc -l <"%s")))\n' "$PWD/../sbatch" "$PWD/../sbatch" >../bin/sbatch
chmod +x ../bin/sbatch
run 'submit.sh' 0 env PATH="$PWD/../bin:$PATH" NOOK_ARRAY=10 sh kept_slurm/submit.sh --partition=p
checks=$((checks + 1))
[ "$(grep -o -e '--array=[0-9,-]*' ../sbatch | tr '\n' ' ')" = '--array=1-10 --array=1-6 --array=1 ' ] ||
	problem "submit.sh: found the arrays $(cat ../sbatch)"
grep -q -e '--dependency=afterok:101:102 --kill-on-invalid-dep=yes .*--partition=p job.sbatch' ../sbatch ||
	problem "submit.sh: found $(cat ../sbatch), expected a merge after jobs 101 and 102"
printf '#!/bin/sh\necho 101_1\n' >../bin/squeue
chmod +x ../bin/squeue
run 'submit.sh again' 4 env PATH="$PWD/../bin:$PATH" sh kept_slurm/submit.sh
grep -q 'found 1 jobs of this plan in Slurm, expected none: wait, or scancel 101 102 103' ../stderr || problem "submit.sh again: found '$(cat ../stderr)'"
rm ../bin/squeue
run 'submit.sh when Slurm has none of it' 0 env PATH="$PWD/../bin:$PATH" sh kept_slurm/submit.sh
# The longest names, and a title that is longer than a description may be.
cat >kept_long.json <<EOT
{"schema": "nook.batch/1", "steps": [
 {"name": "a23456789b23456789c2345", "parts": 2, "command": ["reference", "{level}", "--gbuffer", "../kept_g.exr", "--radius", "1", "-o", "{name}.exr"]}],
 "levels": [{"name": "a23456789b23456789c23456", "level": "builtin:cornell"}, {"name": "a23456789b23456789c2345y", "level": "builtin:cornell"}]}
EOT
works '' batch kept_long.json --for openjd -o kept_long
if command -v python3 >/dev/null; then
	run 'templates of Open Job Description' 0 python3 "$here/openjd.py" kept_openjd/job.template.json $(find kept_long -name job.template.json)
	# A stand-in for pyoutline, with what opencue_job.py uses of it.
	mkdir -p ../python/outline/modules
	cat >../python/outline/__init__.py <<-'EOT'
		class Outline:
		    def __init__(self, name, **args):
		        self.layers = []

		    def add_layer(self, layer):
		        self.layers.append(layer)
	EOT
	: >../python/outline/modules/__init__.py
	cat >../python/outline/modules/shell.py <<-'EOT'
		class Shell:
		    def __init__(self, name, **args):
		        self.name, self.args, self.after = name, args, []

		    def depend_all(self, layer):
		        self.after.append(layer.name)
	EOT
	cat >../python/outline/cuerun.py <<-'EOT'
		def launch(job, use_pycuerun):
		    for layer in job.layers:
		        print(layer.name, layer.args["range"], *layer.after)
	EOT
	run 'opencue_job.py' 0 env PYTHONPATH="$PWD/../python" python3 kept_opencue/opencue_job.py
	checks=$((checks + 1))
	[ "$(cat ../stdout)" = "nook.reference 1-16
nook.reference.merge 17-17 nook.reference" ] || problem "opencue_job.py: found $(cat ../stdout)"
	run 'job.template.json' 0 python3 -c 'import json, sys
job = json.load(open("kept_openjd/job.template.json"))
assert job["specificationVersion"] == "jobtemplate-2023-09"
parts, merge = job["steps"]
assert parts["parameterSpace"]["taskParameterDefinitions"] == [{"name": "Job", "type": "INT", "range": "1-16"}]
assert merge["dependencies"] == [{"dependsOn": "reference"}]
assert parts["script"]["actions"]["onRun"]["args"][1] == "{{Task.Param.Job}}"'
fi

# Many levels: made, up to date, one changed, one wrong.
batch()
{
	cat >kept_list.json <<-EOT
		{"schema": "nook.batch/1", "values": {"rays": "16"},
		 "steps": [
		  {"name": "depth", "command": ["gbuffer", "{level}", "--camera", "main", "--size", "64x36", "-o", "{name}.g.exr"]},
		  {"name": "rays", "parts": 3,
		   "command": ["reference", "{level}", "--gbuffer", "{name}.g.exr", "--radius", "1", "--rays", "{rays}", "-o", "{name}.exr"]}],
		 "levels": [{"name": "one", "level": "builtin:cornell"}, {"name": "two", "level": "$1", "values": {"rays": "$2"}}]}
	EOT
}
batch builtin:suburb 4
works '10 jobs, estimated' batch kept_list.json -o kept_out --dry-run
works '10 jobs: 0 were up to date, 10 are done now, 0 are not' batch kept_list.json -o kept_out
same kept_single.exr kept_out/one.exr 'batch: other bytes than those of the single run'
works '10 jobs: 10 were up to date, 0 are done now, 0 are not' batch kept_list.json -o kept_out
batch builtin:suburb 8
works '10 jobs: 6 were up to date, 4 are done now, 0 are not' batch kept_list.json -o kept_out
batch gone.glb 8
fails 2 'kept_list.json: two.depth: ../gone.glb: cannot be read' batch kept_list.json -o kept_out
batch builtin:suburb -1
fails 3 "kept_list.json: two.rays: --rays: found '-1'" batch kept_list.json -o kept_out
sed -i 's/{rays}/{raise}/' kept_list.json
fails 3 "kept_list.json: steps\[1\].command\[7\]: found '{raise}'" batch kept_list.json -o kept_out
sed -i 's/nook.batch/nook.other/' kept_list.json
fails 3 'kept_list.json: schema: ' batch kept_list.json -o kept_out
batch kept_bad.obj 8
checks=$((checks + 1))
"$nook" batch kept_list.json -o kept_out >../stdout 2>../stderr && problem 'a level without that camera: found 0, expected 4'
grep -q '^nook: batch: found 5 of 10 jobs not done, expected none: two.depth: ' ../stderr || problem "a level without that camera: $(cat ../stderr)"
batch builtin:suburb 8
works 'are done now, 0 are not' batch kept_list.json -o kept_out --jobs 2
works 'sh submit.sh' batch kept_list.json -o kept_out --for slurm
there
finish
