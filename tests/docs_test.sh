#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: docs_test.sh PROGRAM SOURCE. Checks the pages: relative links and their anchors, verbs and options in commands. Pages
# referenced by code, and files referenced by pages, exist. Each page links a short name of the glossary at its first use.
set -eu
nook=$1
source=$2
. "$(dirname "$0")/table.sh"
LC_ALL=C
export LC_ALL

cd "$source"
find . \( -name .git -o -path ./build -o -path ./out \) -prune -o -print | sed 's|^\./||' >"$folder/files"
grep '\.md$' "$folder/files" >"$folder/pages"

# Shared awk functions: whether a line is code, and the line without code spans.
cat >"$folder/common.awk" <<'AWK'
FNR == 1 { fenced = 0; page = FILENAME }
/^```/ { fenced = !fenced; language = substr($0, 4); next }
function plain(line) { gsub(/`[^`]*`/, "", line); return line }
AWK

# Anchors as GitHub derives them from headings: "docs/reference/vo.md#known-failures".
cat "$folder/common.awk" - >"$folder/anchors.awk" <<'AWK'
!fenced && /^#+ / {
	sub(/^#+ +/, "")
	while (match($0, /\]\([^)]*\)/)) $0 = substr($0, 1, RSTART - 1) substr($0, RSTART + RLENGTH)
	slug = tolower($0)
	gsub(/[^a-z0-9 _\200-\377-]/, "", slug)
	gsub(/ /, "-", slug)
	name = page "#" slug
	print seen[name]++ ? name "-" (seen[name] - 1) : name
}
AWK
xargs awk -f "$folder/anchors.awk" <"$folder/pages" >"$folder/anchors"

# Links: "page target".
cat "$folder/common.awk" - >"$folder/links.awk" <<'AWK'
!fenced {
	line = plain($0)
	while (match(line, /(\]\(|src=")[^)" ]+/)) {
		target = substr(line, RSTART, RLENGTH)
		sub(/^(\]\(|src=")/, "", target)
		if (target !~ /^[a-z]+:/) print page, target
		line = substr(line, RSTART + RLENGTH)
	}
}
AWK
xargs awk -f "$folder/links.awk" <"$folder/pages" >"$folder/links"

awk -v files="$folder/files" -v anchors="$folder/anchors" '
	BEGIN {
		while ((getline line < files) > 0) there[line] = 1
		while ((getline line < anchors) > 0) there[line] = 1
	}
	{
		path = $2
		anchor = ""
		if (match(path, /#.*/)) { anchor = substr(path, RSTART); path = substr(path, 1, RSTART - 1) }
		if (path == "") path = $1
		else {
			from = $1
			if (!sub(/[^\/]*$/, "", from)) from = ""
			path = from path
			sub(/\/$/, "", path)
			while (match(path, /[^\/]+\/\.\.\//)) path = substr(path, 1, RSTART - 1) substr(path, RSTART + RLENGTH)
		}
		if (!(path in there)) print $1 ": found a link to " $2 ", expected a file that is there"
		else if (anchor != "" && !((path anchor) in there)) print $1 ": found a link to " $2 ", expected a heading of " path
	}' "$folder/links" >"$folder/dead"

# Pages that comments, scripts, messages and types refer to, in all text files: by path from the root, or by file name alone where
# no such files are written.
{
	tr '\n' '\0' <"$folder/files" | xargs -0 grep -s -I -o -H '\<docs/[A-Za-z0-9_/-]*[.]md\>'
	grep -v -e '[.]md$' -e '^tests/' "$folder/files" | tr '\n' '\0' | xargs -0 grep -s -I -o -H '[A-Za-z0-9_/-]*[A-Za-z0-9_-][.]md\>'
} | sort -u >"$folder/named"
while IFS=: read -r file page; do
	grep -q "\(^\|/\)$page\$" "$folder/pages" || echo "$file: found the name $page, expected a page that is there"
done <"$folder/named" >>"$folder/dead"

# Source files that pages refer to, as shell patterns.
cat "$folder/common.awk" - >"$folder/paths.awk" <<'AWK'
!fenced {
	line = $0
	while (match(line, /`(libsamples|tools|tests|scripts|cmake|examples|patterns|shaders_generated)\/[A-Za-z0-9_.*\/-]*`/)) {
		print page, substr(line, RSTART + 1, RLENGTH - 2)
		line = substr(line, RSTART + RLENGTH)
	}
}
AWK
xargs awk -f "$folder/paths.awk" <"$folder/pages" | grep -v -e '^CHANGELOG' -e '/NAME' | sort -u >"$folder/paths"
while read -r page path; do
	# shellcheck disable=SC2086 # a pattern
	ls -d $path >"$folder/log" 2>&1 || echo "$page: found the name $path, expected a file that is there"
done <"$folder/paths" >>"$folder/dead"

# Commands: "page verb option", "page verb -" for the verb alone; "page * option" for an option without a verb.
cat "$folder/common.awk" - >"$folder/commands.awk" <<'AWK'
function options(verb, text) {
	while (match(text, /(^|[ (\[])--[a-z][a-z0-9-]*/)) {
		option = substr(text, RSTART, RLENGTH)
		sub(/^[ (\[]/, "", option)
		print page, verb, option
		text = substr(text, RSTART + RLENGTH)
	}
}
function command(text,  words, verb) {
	sub(/[ \t]#.*/, "", text)
	if (text ~ /\.sh / || !match(text, /(^|[ \/;&])nook [a-z]+/)) return 0
	text = substr(text, RSTART)
	sub(/^[ \/;&]*nook /, "", text)
	sub(/ (&&|;|\|) .*/, "", text)
	split(text, words, " ")
	verb = words[1]
	if (verb == "plan" && match(text, / -- [a-z]/)) { # the command that a farm runs also counts
		command("nook " substr(text, RSTART + 4))
		text = substr(text, 1, RSTART)
	}
	if (verb == "report" && words[2] ~ /^[a-z]+$/) verb = verb "," words[2]
	print page, verb, "-"
	options(verb, text)
	return 1
}
fenced && language == "sh" {
	whole = whole $0
	if (sub(/\\$/, " ", whole)) next
	command(whole)
	whole = ""
}
!fenced {
	line = $0
	while (match(line, /`[^`]+`/)) {
		span = substr(line, RSTART + 1, RLENGTH - 2)
		line = substr(line, RSTART + RLENGTH)
		if (!command(span) && span !~ /^(snakemake|sbatch|squeue|sacct|parallel|cmake|ctest|git|spirv-opt|clang|ninja|viewer|build\/viewer)/) options("*", span)
	}
}
AWK
xargs awk -f "$folder/commands.awk" <"$folder/pages" | grep -v '^CHANGELOG' | sort -u >"$folder/commands"

# Options in each verb's --help: "verb option", and "verb -" if the verb exists.
for verb in $(cut -d ' ' -f 2 "$folder/commands" | grep -v '\*' | sort -u); do
	words=$(echo "$verb" | tr ',' ' ')
	# shellcheck disable=SC2086 # a verb may be two words
	"$nook" $words --help >"$folder/help" 2>"$folder/log" || true
	grep -q "^Usage: nook $words " "$folder/help" || continue
	echo "$verb -"
	grep -o -e '--[a-z][a-z0-9-]*' "$folder/help" | sort -u | sed "s/^/$verb /"
done >"$folder/known"
"$nook" --help | grep -o -e '--[a-z][a-z0-9-]*' | sed 's/^/nook /' >>"$folder/known"
# Options of programs that are not nook, from their sources.
{
	sed -n 's/.*add_option("\(--[a-z]*\)".*/nook_stress \1/p' tests/stress/nook_stress.cpp
	sed -n '/^const OPTIONS/,/^};/p' site/build.mjs | grep -o '[a-z]*: { type' | sed 's/:.*//; s/^/build.mjs --/'
} >>"$folder/known"
awk -v known="$folder/known" '
	BEGIN { while ((getline line < known) > 0) { split(line, part, " "); there[line] = 1; any[part[2]] = 1 } }
	$2 == "*" && !($3 in any) { print $1 ": found the option " $3 ", expected one that some nook VERB --help lists" }
	$2 != "*" && !(($2 " " $3) in there) {
		verb = $2
		sub(",", " ", verb)
		print $1 ": found nook " verb ($3 == "-" ? ", expected a verb of nook --help" : " " $3 ", expected an option that its --help lists")
	}' "$folder/commands" >>"$folder/dead"

# Words of the glossary, except those that pages also use in their everyday sense: each page's first use must be a link. Ignores
# quoted titles, other links and tables of options, which may be generated.
everyday=' plane noise bias centre crease spread cell window recipe kernel module thickness paired bands layer volume cluster mask level
	finding reference share front claim rung twin distance radius candidate symmetric pattern domain trimming compensation occlusion moments
	slack flicker tile fragment '
sed -n 's/^### //p' docs/glossary.md | while read -r name; do
	case $(echo "$everyday" | tr '\n\t' '  ') in *" $name "*) ;; *) echo "$name" ;; esac
done >"$folder/names"
cat "$folder/common.awk" - >"$folder/first.awk" <<'AWK'
function check(page, text, i, name, word, before, after, seen) {
	while (match(text, /!?\[[^][]*\]\([^)]*\)/)) {
		word = substr(text, RSTART, RLENGTH)
		name = word ~ /glossary\.md#/ ? "\001" substr(word, 2, index(word, "](") - 2) "\001" : " "
		text = substr(text, 1, RSTART - 1) name substr(text, RSTART + RLENGTH)
	}
	gsub(/"[^"]*"/, " ", text)
	for (i = 1; i <= names; ++i) {
		name = list[i]
		seen = 0
		before = " "
		word = text
		while (!seen && match(word, "[" toupper(substr(name, 1, 1)) substr(name, 1, 1) "]" substr(name, 2) "s?")) {
			if (RSTART > 1) before = substr(word, RSTART - 1, 1)
			after = substr(word, RSTART + RLENGTH, 1)
			if (before !~ /[A-Za-z0-9_\/-]/ && after !~ /[A-Za-z0-9_]/) {
				seen = 1
				if (before != "\001") print page ": found '" name "' without a link where it is used first, expected one to docs/glossary.md"
			}
			before = substr(word, RSTART + RLENGTH - 1, 1)
			word = substr(word, RSTART + RLENGTH)
		}
	}
}
BEGIN { while ((getline line < file) > 0) { gsub(/\./, "[.]", line); list[++names] = line } }
FNR == 1 { if (last != "") check(last, all); all = ""; last = FILENAME; table = 0 }
/<!-- options:/ { table = 1 }
!fenced && !table && !/^(#|<|    )/ { all = all plain($0) " " }
/<!-- \/options/ { table = 0 }
END { check(last, all) }
AWK
grep -v -e CHANGELOG -e docs/glossary.md -e '^patterns' -e '^tests' "$folder/pages" | xargs awk -v file="$folder/names" -f "$folder/first.awk" >>"$folder/dead"

# Lines of the examples in docs/guide/engines.md; in examples/ogre also those for nook: a line with a comment `nook`, or after one down
# to an empty line.
for example in ogre godot godot4; do
	lines=$(cat $(grep "^examples/$example/.*[.]" "$folder/files") | wc -l)
	grep -q "^| \[.examples/$example.\](.*| $lines |" docs/guide/engines.md || echo "docs/guide/engines.md: found another count of lines of examples/$example, expected $lines" >>"$folder/dead"
done
sum=0
for file in CMakeLists.txt main.cpp media/nook.material media/nook.compositor; do
	lines=$(awk '/^[ \t]*$/ { on = 0 } /^[ \t]*(\/\/|#) nook: / { on = 1 }
		file ~ /material/ { on = 1 } /(\/\/|#) nook/ && !/^[ \t]*(\/\/|#) / { ++count; next } on && !/^[ \t]*((\/\/|#) .*|[{}]*)$/ { ++count } END { print count }' \
		file=$file "examples/ogre/$file")
	sum=$((sum + lines))
	grep -q "^| .$file. |.*| $lines |" docs/guide/engines.md || echo "docs/guide/engines.md: found another count of lines for nook in $file, expected $lines" >>"$folder/dead"
done
[ $sum -le 60 ] && grep -q "^| \[.examples/ogre.\](.*| $sum |" docs/guide/engines.md || echo "docs/guide/engines.md: found another count of lines for nook in OGRE, expected $sum, at most 60" >>"$folder/dead"

checks=$(cat "$folder/links" "$folder/named" "$folder/paths" "$folder/commands" "$folder/names" | wc -l)
while read -r line; do
	problem "$line"
done <"$folder/dead"
finish
