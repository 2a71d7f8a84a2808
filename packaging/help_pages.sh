#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes man pages and completions of what --help prints, which comes from the rows that the parser uses: nook.1.gz, nook-VERB.1.gz, and the
# completions nook (bash), _nook (zsh) and nook.fish.
# usage: help_pages.sh NOOK FOLDER   e.g. help_pages.sh "qemu-aarch64-static build/aarch64/tools/nook" man
set -eu
[ $# -eq 2 ] || { echo "help_pages.sh: found '$*', expected NOOK FOLDER" >&2; exit 1; }
nook=$1
out=$2
mkdir -p "$out"
rows=$(mktemp)
trap 'rm -f "$rows"' EXIT
version=$($nook --version | sed -n 's/^nook //p')

# rowsOf VERB...: lines of that help, with a bar between fields: VERB|head|description|usage, VERB|verb|name|help, and
# VERB|option|names|value|help, or positional in place of option.
rowsOf()
{
	$nook "$@" --help | awk -v verb="$*" '
		function flush()
		{
			if (kind == "") return
			if (kind == "verb") print verb "|verb|" names "|" help
			else print verb "|" kind "|" names "|" value "|" help
			kind = ""
		}
		NR == 1 { description = $0; next }
		/^Usage: / { print verb "|head|" description "|" substr($0, 8); next }
		/^[A-Z][a-z]*:$/ { flush(); section = $0; next }
		/^$/ { flush(); if (section != "") blank = 1; next }
		/^[^ ]/ { flush(); section = ""; next }
		/^  [^ ]/ && section != "" {
			flush()
			kind = section == "Subcommands:" ? "verb" : section == "Positionals:" ? "positional" : "option"
			line = substr($0, 3)
			gap = match(line, /  +/)
			# A value that fills the column, up to the 29th character, has one blank before the help.
			if (!gap && substr(line, 28, 1) == " " && substr(line, 29) !~ /^[A-Z.:]+( |$)/) { gap = 28; RLENGTH = 1 }
			left = gap ? substr(line, 1, gap - 1) : line
			help = gap ? substr(line, gap + RLENGTH) : ""
			blankAt = index(left, " ")
			names = blankAt ? substr(left, 1, blankAt - 1) : left
			value = blankAt ? substr(left, blankAt + 1) : ""
			next
		}
		/^   / && kind != "" { sub(/^ +/, ""); help = help (help == "" ? "" : " ") $0 }
		END { flush() }'
}

rowsOf >"$rows"
for verb in $(sed -n 's/^|verb|\([^|]*\)|.*/\1/p' "$rows"); do
	rowsOf "$verb" >"$rows.one"
	cat "$rows.one" >>"$rows"
	for below in $(sed -n "s/^$verb|verb|\([^|]*\)|.*/\1/p" "$rows.one"); do
		rowsOf "$verb" "$below" >>"$rows"
	done
	rm "$rows.one"
done

# A choice, "a|b|c" as a value, contains bars: of an option the last field is the help, and the value what is between.
common='
	function parse(  n, i, part)
	{
		n = split($0, part, "|")
		verb = part[1]; kind = part[2]; name = part[3]; help = part[n]; value = ""
		for (i = 4; i < n; ++i) value = value (i == 4 ? "" : "|") part[i]
		required = sub(/ ?REQUIRED/, "", value)
		many = sub(/ ?\.\.\./, "", value)
		choices = value ~ /^[a-z0-9._-]+(\|[a-z0-9._-]+)+$/ ? value : ""
		gsub(/\|/, " ", choices)
	}'

for page in "" $(sed -n 's/^|verb|\([^|]*\)|.*/\1/p' "$rows"); do
	awk -v page="$page" -v version="$version" "$common"'
		function roff(text) { gsub(/\\/, "\\e", text); gsub(/-/, "\\-", text); sub(/^[.\x27]/, "\\\\\\&&", text); return text }
		{ parse() }
		verb != page && index(verb, page " ") != 1 { next }
		page == "" && verb != "" { next }
		kind == "head" && verb == page {
			title = page == "" ? "nook" : "nook-" page
			print ".\\\" Made by packaging/help_pages.sh of what nook " page " --help prints.\n.TH " toupper(title) " 1 \"\" \"nook " version "\" \"User Commands\""
			print ".SH NAME\n" roff(title) " \\- " roff(tolower(substr(name, 1, 1)) substr(name, 2))
			print ".SH SYNOPSIS\n.B " roff(help)
			next
		}
		kind == "head" { print ".SH " toupper(roff("nook " verb)) "\n" roff(name) ".\n.PP\n.B " roff(help); section = "options"; next }
		kind != section { print ".SH " (kind == "verb" ? "COMMANDS" : kind == "positional" ? "ARGUMENTS" : "OPTIONS"); section = kind }
		{
			gsub(/,/, ", ", name)
			if (kind == "positional") value = ""
			print ".TP\n.B " roff(name) (value == "" ? "" : " \\fI" roff(value) "\\fP") (many ? " ..." : "")
			print roff(help) (required && kind == "option" ? " (required)" : "")
		}
		END {
			print ".SH EXIT STATUS\n0 ok, 1 usage, 2 file cannot be read or written, 3 invalid input, 4 failed at run time, 5 not supported, 7 difference found."
			print ".SH SEE ALSO\n" (page == "" ? "One page for each command, such as\n.BR nook\\-pattern (1)" : ".BR nook (1)")
		}' "$rows" | gzip -9n >"$out/nook${page:+-$page}.1.gz"
done

awk "$common"'
	{ parse() }
	kind == "verb" { verbs[verb] = verbs[verb] " " name }
	kind == "option" {
		n = split(name, each, ",")
		for (i = 1; i <= n; ++i) {
			options[verb] = options[verb] " " each[i]
			if (choices != "") cases = cases "\t\"" verb " " each[i] "\") words=\"" choices "\" ;;\n"
			else if (value != "") files = files (files == "" ? "" : " | ") "\"" verb " " each[i] "\""
		}
	}
	END {
		print "# Completion of nook for bash, made by packaging/help_pages.sh of what --help prints.\n_nook()\n{\n\tlocal words= word=${COMP_WORDS[COMP_CWORD]} verb=${COMP_WORDS[1]}"
		print "\t((COMP_CWORD > 1)) || verb="
		for (v in verbs) if (v != "") print "\t[[ $verb != " v " ]] || ((COMP_CWORD < 3)) || verb=\"" v " ${COMP_WORDS[2]}\""
		printf "\tcase \"$verb ${COMP_WORDS[COMP_CWORD - 1]}\" in\n%s\t%s) ;;\n\t*)\n\t\tcase $verb in\n", cases, files
		for (v in options) printf "\t\t\"%s\") words=\"%s\" ;;\n", v, substr(options[v] verbs[v], 2)
		print "\t\tesac\n\t\t;;\n\tesac"
		print "\tmapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n}\ncomplete -o default -F _nook nook"
	}' "$rows" >"$out/nook"

awk "$common"'
	function quoted(text) { gsub(/[\[\]:\\]/, "\\\\&", text); gsub(/\x27/, "\x27\\\x27\x27", text); return text }
	{ parse() }
	kind == "verb" { verbs[verb] = verbs[verb] " \x27" name ":" quoted(help) "\x27" }
	kind == "option" {
		n = split(name, each, ",")
		for (i = 1; i <= n; ++i)
			options[verb] = options[verb] " \\\n\t\t\t\x27" (many ? "*" : "") each[i] "[" quoted(help) "]" (value == "" ? "" : ":" quoted(value) ":" (choices == "" ? "_files" : "(" choices ")")) "\x27"
	}
	END {
		print "#compdef nook\n# Completion of nook for zsh, made by packaging/help_pages.sh of what --help prints."
		print "local verb=$words[2] verbs"
		print "(( CURRENT > 2 )) || verb="
		for (v in verbs) if (v != "") print "[[ $verb != " v " ]] || (( CURRENT < 4 )) || verb=\"" v " $words[3]\""
		for (v in verbs) print "if [[ $verb = \"" v "\" && $words[CURRENT] != -* ]]; then\n\tverbs=(" substr(verbs[v], 2) ")\n\t_describe command verbs\n\treturn\nfi"
		print "case $verb in"
		for (v in options) print "\"" v "\") _arguments" options[v] " \\\n\t\t\t\x27*:file:_files\x27 ;;"
		print "esac"
	}' "$rows" >"$out/_nook"

awk "$common"'
	function quoted(text) { gsub(/[\\\x27]/, "\\\\&", text); return text }
	BEGIN { print "# Completion of nook for fish, made by packaging/help_pages.sh of what --help prints." }
	{ parse() }
	kind != "verb" && kind != "option" { next }
	{
		n = split(verb, part, " ")
		when = n == 0 ? "__fish_use_subcommand" : "__fish_seen_subcommand_from " part[n]
		if (n == 2) when = "__fish_seen_subcommand_from " part[1] "; and " when
	}
	kind == "verb" { print "complete -c nook -f -n \x27" when "\x27 -a " name " -d \x27" quoted(help) "\x27"; next }
	{
		n = split(name, each, ",")
		line = ""
		for (i = 1; i <= n; ++i) line = line (each[i] ~ /^--/ ? " -l " substr(each[i], 3) : " -s " substr(each[i], 2))
		print "complete -c nook -n \x27" when "\x27" line (choices != "" ? " -x -a \x27" choices "\x27" : value != "" ? " -r" : "") " -d \x27" quoted(help) "\x27"
	}' "$rows" >"$out/nook.fish"
