# SPDX-License-Identifier: GPL-3.0-or-later
# Shared by tests of pages: opens a page in a headless browser and reads its record of what it drew. Source after table.sh; $browser
# is empty if there is none.
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)

# browsed PAGE OPTIONS…: writes the resulting DOM to $folder/dom and the console to $folder/console.
browsed()
{
	address=$1
	shift
	"$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$folder/profile" --enable-logging=stderr --virtual-time-budget=20000 \
		--allow-file-access-from-files "$@" --dump-dom "file://$PWD/$address" >"$folder/dom" 2>"$folder/log" </dev/null
	grep 'CONSOLE' "$folder/log" >"$folder/console"
}

# opened PAGE WIDTH OPTIONS…: likewise in a frame, because a browser's window has a minimum width; the page's record goes to
# $folder/root.
opened()
{
	cat >frame.html <<-EOT
		<html><iframe id="frame" src="$1" style="border:0;width:$2px;height:1000px"></iframe><script>
		const frame = document.getElementById('frame');
		frame.onload = () => Object.assign(document.documentElement.dataset, frame.contentDocument.documentElement.dataset);
		</script></html>
	EOT
	shift 2
	browsed frame.html --window-size=1500,1200 "$@"
	grep -o '<html[^>]*>' "$folder/dom" | head -n 1 >"$folder/root"
}

# quiet WHERE: checks that the console is empty.
quiet()
{
	checks=$((checks + 1))
	[ -s "$folder/console" ] && problem "$1: console: $(head -n 3 "$folder/console")"
}

# value NAME: the attribute data-NAME.
value()
{
	sed -n "s/.* data-$1=\"\([^\"]*\)\".*/\1/p" "$folder/root"
}

# is NAME EXPECTED WHERE
is()
{
	checks=$((checks + 1))
	[ "$(value "$1")" = "$2" ] || problem "$3: $1 is '$(value "$1")', expected '$2'"
}
