#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the pages of the repository as a site with search in build/site/. Fails on a broken link and on a page that mkdocs.yml leaves out.
# usage: docs.sh [serve]     serve: shows the site at http://127.0.0.1:8000/ (run docs.sh again after an edit)
set -eu
cd "$(dirname "$0")/.."
command -v mkdocs >/dev/null || { echo "docs.sh: found no mkdocs, expected Debian's package mkdocs (scripts/setup.sh installs it)" >&2; exit 1; }
rm -rf build/docs build/site
mkdir -p build/docs
for page in README.md CONTRIBUTING.md CHANGELOG.md docs patterns/README.md npm/README.md npm/ao/README.md examples/*/README.md; do
	mkdir -p "build/docs/$(dirname "$page")"
	cp -R "$page" "build/docs/$page"
done
find build/docs -name '*.md' | cut -d / -f 3- >build/pages.txt
while read -r page; do
	grep -q ": $page\$" mkdocs.yml || { echo "docs.sh: found no $page in mkdocs.yml, expected each page in its nav" >&2; exit 1; }
done <build/pages.txt
case ${1-} in
serve) exec mkdocs serve --strict ;;
'') ;;
*) echo "docs.sh: found '$1', expected serve or nothing" >&2; exit 1 ;;
esac
mkdocs build --quiet --strict
python3 - build/site <<'END'
import html.parser, os, sys, urllib.parse

root = sys.argv[1]
ids, links = {}, []


class Page(html.parser.HTMLParser):
    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id":
                ids[path].add(value)
            elif name in ("href", "src") and value:
                links.append((path, value))


for folder, _, names in os.walk(root):
    for name in sorted(names):
        path = os.path.join(folder, name)
        if name.endswith(".html") and name not in ("404.html", "search.html"):
            ids[path] = set()
            Page().feed(open(path, encoding="utf-8").read())

problems = set()
for page, link in links:
    url = urllib.parse.urlsplit(link)
    if url.scheme or url.netloc:
        continue
    target = os.path.normpath(os.path.join(os.path.dirname(page), urllib.parse.unquote(url.path))) if url.path else page
    if os.path.isdir(target):
        target = os.path.join(target, "index.html")
    anchor = urllib.parse.unquote(url.fragment)
    if not os.path.exists(target):
        problems.add(f"{page}: found a link to {link}, expected a file of the site")
    elif anchor and target in ids and anchor not in ids[target]:
        problems.add(f"{page}: found a link to {link}, expected a heading of that page")
for problem in sorted(problems):
    print(problem, file=sys.stderr)
sys.exit(bool(problems))
END
