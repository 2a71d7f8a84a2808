#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The table "Held out" of docs/reference/recipes.md: for each recipe in a file of nook fit the mean error over the levels it is
# fitted to, over held-out levels, and their ratio; then likewise for errors relative to those of published GTAO on the same level,
# since levels differ in difficulty.
# usage: held_out.sh FILE.json
set -eu
file=${1:?a file of nook fit, expected docs/measurements/rays.json}
awk '
	function value(line) { sub(/^[^:]*: */, "", line); gsub(/[",]/, "", line); return line }
	/^\t\t\t"method"/ { method = value($0); order[++methods] = method }
	/"level"/ { level = value($0) }
	/"held_out"/ { held[method, level] = value($0) == "true" }
	/"paper"/ { paper[method, level] = value($0) }
	/^\t\t\t\t\t"rays"/ { rays[method, level] = value($0); seen[method, ++levels[method]] = level }
	END {
		print "| method | fitted | held out | ratio | fitted, × `gtao` | held out, × `gtao` | ratio |"
		print "| --- | --- | --- | --- | --- | --- | --- |"
		for (m = 1; m <= methods; ++m) {
			name = order[m]
			split("", sum); split("", share); split("", count)
			for (i = 1; i <= levels[name]; ++i) {
				level = seen[name, i]
				out = held[name, level]
				sum[out] += rays[name, level]
				share[out] += rays[name, level] / paper["gtao", level]
				count[out] += 1
			}
			for (out = 0; out < 2; ++out) { sum[out] /= count[out]; share[out] /= count[out] }
			printf "| `%s` | %.3f | %.3f | %.2f | %.2f | %.2f | %.2f |\n", name, sum[0], sum[1], sum[1] / sum[0],
				share[0], share[1], share[1] / share[0]
		}
	}' "$file"
