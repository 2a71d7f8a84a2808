#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: farm_test.sh PROGRAM SOURCE ENGINE. Two levels on an engine that a script of the repository starts and stops, a task killed on the
# way. Ends with 77, and one line, where that engine cannot run here.
set -u
nook=$1
source=$2
engine=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
sh "$source/scripts/farm.sh" "$engine" "$nook" "$scratch/farm"
