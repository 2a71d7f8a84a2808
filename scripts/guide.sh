#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs every command of a page of docs/guide/ in order, with nook on the PATH; stops at the first failure.
# usage: guide.sh NOOK PAGE FOLDER     PAGE: for example level; FOLDER: an empty one
set -eu
nook=$(realpath "${1:?nook, expected the program}")
page=$(cd "$(dirname "$0")/.." && pwd)/docs/guide/${2:?page, expected engine_header, level, choose_a_method or farm}.md
cd "${3:?folder, expected an empty one}"
mkdir .path
trap 'rm -rf .path' EXIT
ln -s "$nook" .path/nook
awk '/^```/ { shell = $0 == "```sh"; next } shell' "$page" >.path/commands
PATH=$PWD/.path:$PATH sh -eu .path/commands
