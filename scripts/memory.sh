#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Peak memory and processor time of each verb that reads a level, by default with five million triangles
# (builtin:heightfield:5000000, 2 m): a row per verb of the table in docs/measurements/volumes.md. Needs GNU time. Runs one verb at
# a time; VERBS="info volumes" measures only these.
# usage: memory.sh PROGRAM [LEVEL [DISTANCE]]
set -euo pipefail
nook=$1
level=${2:-builtin:heightfield:5000000}
distance=${3:-2}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

echo "| verb | peak memory, GiB | processor, s |"
echo "| --- | --- | --- |"
# row NAME WORDS...: words of the nook command.
row()
{
	name=$1
	shift
	case " ${VERBS:-$name} " in *" ${name%% *} "*) ;; *) return ;; esac
	code=0
	/usr/bin/time -o time -f '%M %U %S' "$nook" "$@" >log 2>&1 || code=$?
	[ "$code" -eq 0 ] || echo "$name: exit code $code: $(tail -n 1 log)" >&2
	tail -n 1 time | awk -v name="$name" '{ printf "| `%s` | %.2f | %.0f |\n", name, $1 / 1048576, $2 + $3 }'
}

"$nook" gbuffer "$level" --size 320x180 -o g.exr >/dev/null 2>&1
row 'info' info "$level"
row 'level' level "$level" -o level.glb
row 'gbuffer' gbuffer "$level" --size 320x180 -o other.exr
row 'reference' reference "$level" --gbuffer g.exr --radius "$distance" --rays 64 -o r.exr
row 'bake' bake "$level" --radius "$distance" --rays 16 -o b.glb
row 'volumes' volumes "$level" --distance "$distance" --compress -o v.glb
row 'shade --method aov' shade g.exr --method aov --volumes v.glb -o aov.exr
row 'volumes, every option' volumes "$level" --distance "$distance" --exact-bounds --trim 0.15 --compensate --compress -o all.glb
row 'tune' tune "$level" --budget 1s --methods vo-line --grid quick --size 128x72 --views 1 --rays 16 --repetitions 1
row 'report error' report error "$level" --quick -o r.html
