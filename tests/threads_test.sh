# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: threads_test.sh PROGRAM. The same bytes with 1 and 4 threads.
set -u
nook=$1
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/samples.sh"

for threads in 1 4; do
	mkdir "$folder/$threads"
	makeSamples "$nook" "$folder/$threads" $threads
done
# Enough of them for more than one thread.
for threads in 1 4; do
	"$nook" volumes builtin:suburb --distance 1 --compensate --trim 0.05 --threads $threads -o "$folder/$threads.glb" ||
		problem "volumes of the suburb: no file"
done
same "$folder/1.glb" "$folder/4.glb" "volumes of the suburb: 4 threads, expected the bytes of one"
for file in "$folder"/1/*; do
	name=$(basename "$file")
	same "$file" "$folder/4/$name" "$name: 4 threads, expected the bytes of one"
done
finish
