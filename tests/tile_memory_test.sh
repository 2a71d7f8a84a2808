# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: tile_memory_test.sh PROGRAM PEAK. The memory estimate of nook tile is at least the actual peak, and at most 1.6 times that,
# or twice that of a tile so small that most is the program's own.
# PEAK: the program of peak.c.
set -u
nook=$1
peak=$2
. "$(dirname "$0")/table.sh"
cd "$folder" || exit 1

# near COUNT OPTIONS: for a tile with that many lines.
near()
{
	checks=$((checks + 2))
	count=$1
	shift
	"$nook" pattern --domain disk --count "$count" --method vogel -o "disk$count.json" || problem "disk $count"
	"$nook" tile --pattern "disk$count.json" "$@" --threads 2 --memory 1 -o tile.json >log 2>&1
	said=$(sed -n 's/.*found a need of about \([0-9]*\) MiB.*/\1/p' log)
	[ -n "$said" ] || problem "$*: found '$(cat log)', expected a need in MiB"
	taken=$("$peak" "$nook" tile --pattern "disk$count.json" "$@" --threads 2 -o tile.json) || problem "$*: not made"
	echo "$*: said $said MiB, taken $((taken / 1024)) MiB"
	[ $((said * 1024)) -ge "$taken" ] || problem "$*: said $said MiB, found $taken KiB taken, expected no more"
	[ $((said * 1024)) -le $((taken * tenths / 10)) ] || problem "$*: said $said MiB, found $taken KiB taken, expected $tenths tenths at most"
}

tenths=16
near 9 --size 64 --filter none                    # pair by pair
near 1 --size 128 --filter binomial:3             # the finished tile and its text
tenths=20
near 200 --size 3 --filter binomial:3 --frames 4  # by moments
finish
