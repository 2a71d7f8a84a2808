# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: threads_test.sh PROGRAM. The same bytes with 1 and 4 threads. For many volumes with 1 and 3 see volumes_cli_test.sh.
set -u
nook=$1
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/samples.sh"

for threads in 1 4; do
	mkdir "$folder/$threads"
	makeSamples "$nook" "$folder/$threads" $threads
done
for file in "$folder"/1/*; do
	name=$(basename "$file")
	same "$file" "$folder/4/$name" "$name: 4 threads, expected the bytes of one"
done
finish
