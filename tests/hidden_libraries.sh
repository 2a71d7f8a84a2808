# SPDX-License-Identifier: GPL-3.0-or-later
# Runs commands without some of the system's libraries: each is hidden by an empty file in a mount namespace of the command.

canHide()
{
	[ "$(id -u)" -eq 0 ] && command -v unshare >/dev/null && unshare -m mount --bind /dev/null /dev/null 2>/dev/null
}

# without "LIBRARY..." COMMAND...
without()
{
	hidden=$1
	shift
	unshare -m sh -c 'for library in $1; do
			for file in $(/sbin/ldconfig -p | sed -n "s|^\t$library (.*) => ||p"); do
				mount --bind /dev/null "$(readlink -f "$file")" || exit 99
			done
		done
		shift
		exec "$@"' sh "$hidden" "$@"
}
