#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: run.sh NOOK FOLDER [NAME LEVEL RADIUS]... Compares nook-ao, n8ao and the passes of three.js with rays: writes the page and its
# scenes to FOLDER, by default builtin:courtyard with a radius of 1.5 m, and serves it. ?rounds=5 draws, measures and times all of them.
set -eu
nook=$(realpath "$(command -v "$1")")
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$2/made"
cd "$2"
shift 2
[ $# -gt 0 ] || set -- courtyard builtin:courtyard 1.5
cp "$here"/*.html "$here"/*.js "$here/settings.json" .
echo '{"private": true, "type": "module"}' >package.json
list=
while [ $# -ge 3 ]; do
	camera=auto:1
	[ "$2" = builtin:courtyard ] && camera=main
	if ! [ -s "made/$1_ref.tif" ]; then
		"$nook" gbuffer "$2" --camera $camera --size 1280x720 -o "made/$1.exr"
		"$nook" info "made/$1.exr" --json "made/$1.json" >made/log
		"$nook" reference "$2" --gbuffer "made/$1.exr" --radius "$3" --falloff linear --rays 128 -o made/rays.exr
		"$nook" level "$2" -o "made/$1.glb"
		oiiotool "made/$1.exr" --ch Z -d float --compression none -o "made/$1_z.tif"
		oiiotool made/rays.exr --ch visibility -d float --compression none -o "made/$1_ref.tif"
	fi
	list="$list${list:+, }{ \"name\": \"$1\", \"file\": \"$1.glb\", \"radius\": $3 }"
	shift 3
done
echo "[$list]" >made/scenes.json
sh "$here/../pack.sh" "$nook" nook-ao
npm install --no-audit --no-fund --silent --install-links three@0.187.0 n8ao@2.1.0 postprocessing@6.39.6 ./nook-ao
exec node serve.js "${PORT:-8000}"
