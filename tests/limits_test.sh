# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: limits_test.sh PROGRAM. With few addresses or few processes, every verb works, or ends by itself with one line.
set -u
nook=$1
. "$(dirname "$0")/every_verb.sh"
. "$(dirname "$0")/command_line.sh"

# bears WHAT COMMAND...: it works, or ends with exit code 4 and one line, within minutes and without leftovers.
bears()
{
	what=$1
	shift
	checks=$((checks + 1))
	timeout -k 5 300 "$@" >../stdout 2>../stderr </dev/null
	found=$?
	case $found in
	0) ;;
	4)
		failed=$((failed + 1))
		[ "$(wc -l <../stderr)" -eq 1 ] && grep -q '^nook: ' ../stderr || problem "$what: $*: found '$(cat ../stderr)', expected one line"
		[ -z "$(ls | grep '^a\.')" ] || problem "$what: $*: left behind '$(ls)'"
		;;
	*) problem "$what: $*: exit code $found, expected 0 or 4: $(cat ../stderr)" ;;
	esac
	[ -z "$(find . -name '*.tmp*')" ] || problem "$what: $*: left behind '$(find . -name '*.tmp*')'"
	rm -f a.*
}

makeInputs
# Except the report of errors, which reports failures and continues with the rest.
everyVerb | grep -v '^report error' | sed '/^emit/!s/$/ --threads 4/' >../verbs
echo "info kept.obj" >>../verbs
echo "info kept_g.exr" >>../verbs

# Kilobytes of address space. The program itself needs about 150 MB.
failed=0
for most in 200000 500000; do
	while read -r arguments; do
		# shellcheck disable=SC2086
		bears "$most KB of addresses" prlimit --as=$((most * 1024)) "$nook" $arguments
	done <../verbs
done
[ "$failed" -gt 0 ] || problem "addresses: nothing failed, expected some verbs to find too few"

# Processes and threads per user; root has no limit.
if [ "$(id -u)" -ne 0 ]; then
	user=env
else
	user="setpriv --reuid=65534 --clear-groups"
	chmod 755 "$folder"
	chmod -R 777 .
fi
# shellcheck disable=SC2086
if [ "$(id -u)" -eq 0 ] && ! $user "$nook" --version >../stdout 2>&1; then
	echo "limits of processes: skipped: found root and no other user who may run $nook, expected one of them to be otherwise"
	finish
fi
failed=0
for most in 1 3 6; do
	while read -r arguments; do
		# shellcheck disable=SC2086
		bears "$most processes" $user prlimit --nproc=$most "$nook" $arguments
	done <../verbs
done
# OpenGL only with the highest limit: with fewer processes Mesa waits forever for threads that it cannot start, and with few
# addresses it may crash.
# shellcheck disable=SC2086
bears "$most processes" $user prlimit --nproc=$most env LP_NUM_THREADS=1 "$nook" shade kept_g.exr --method vo-line --device gl -o a.exr
[ "$failed" -gt 0 ] || problem "processes: nothing failed, expected some verbs to find too few"
finish
