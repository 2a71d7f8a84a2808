# SPDX-License-Identifier: GPL-3.0-or-later
# Shared by command-line tests: commands that should work or fail, and the files they leave in an empty folder. Requires $nook, the
# program; changes to a temporary folder that contains only an empty folder "closed".
. "$(dirname "$0")/table.sh"

# fails CODE 'REGEX' ARGUMENTS: checks the exit code, one line "nook: REGEX" on stderr, nothing on stdout, no new file.
fails()
{
	code=$1
	regex=$2
	shift 2
	checks=$((checks + 1))
	before=$(ls -A . closed)
	"$nook" "$@" >../stdout 2>../stderr </dev/null
	found=$?
	[ "$found" -eq "$code" ] || problem "nook $*: exit code $found, expected $code"
	[ "$(wc -l <../stderr)" -eq 1 ] || problem "nook $*: $(wc -l <../stderr) lines of error, expected 1: $(cat ../stderr)"
	grep -Eq "^nook: $regex" ../stderr || problem "nook $*: found '$(cat ../stderr)', expected '$regex'"
	[ -s ../stdout ] && problem "nook $*: found output besides the error"
	[ "$(ls -A . closed)" = "$before" ] || problem "nook $*: left behind '$(ls -A . closed)', expected '$before'"
}

# works 'REGEX' ARGUMENTS: checks exit code 0, REGEX on stdout, nothing on stderr.
works()
{
	regex=$1
	shift
	checks=$((checks + 1))
	"$nook" "$@" >../stdout 2>../stderr </dev/null
	found=$?
	[ "$found" -eq 0 ] || problem "nook $*: exit code $found: $(cat ../stderr)"
	[ -s ../stderr ] && problem "nook $*: found '$(cat ../stderr)' on stderr, expected nothing"
	[ -z "$regex" ] || grep -Eq -e "$regex" ../stdout || problem "nook $*: found '$(head -c 300 ../stdout)', expected '$regex'"
}

# there FILE...: checks that the folder contains exactly these files, then removes them.
there()
{
	checks=$((checks + 1))
	found=$(ls -A | grep -v -e '^closed$' -e '^kept' | tr '\n' ' ')
	[ "$found" = "$*${*:+ }" ] || problem "found the files '$found', expected '$*'"
	rm -f "$@"
}

cd "$folder" && mkdir work && cd work && mkdir closed
