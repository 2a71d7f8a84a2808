#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: site_test.sh SOURCE. scripts/docs.sh builds the site: no link is broken, and its search knows the pages.
set -eu
cd "$1"
command -v mkdocs >/dev/null || { echo "found no mkdocs, expected Debian's package mkdocs: skipped"; exit 77; }
scripts/docs.sh
for page in index docs/glossary docs/reference/vo docs/measurements/index; do
	[ -s "build/site/$page.html" ] || { echo "build/site: found no $page.html, expected it" >&2; exit 1; }
done
grep -q '"location":"docs/glossary.html#halo"' build/site/search/search_index.json || { echo "search: found no halo, expected the glossary's" >&2; exit 1; }
