# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: report_page_test.sh PROGRAM. The report's page in a browser: empty console, everything in its data is drawn, light and
# dark, wide and narrow. Exit code 77: no Chromium.
set -u
nook=$1
claims=$(cd "$(dirname "$0")/../scripts" && pwd)/claims.py
. "$(dirname "$0")/table.sh"
. "$(dirname "$0")/browser.sh"
[ -n "$browser" ] || exit 77
cd "$folder"

"$nook" report noise --max-count 7 --starts 1 --seeds 2 --threads 2 -o page.html --json report.json || problem "report: not made"

# The paper's claims about counts, from the report's JSON.
if command -v python3 >/dev/null; then
	python3 "$claims" report.json | grep -q '^| 5, disk, centred | electro | 0\.' || problem "claims.py: found no row of five lines"
fi

# Counts what there is to draw from the JSON, by a page of the test's own.
cat >count.html <<EOT
<html><script type="application/json" id="json">
$(cat report.json)
</script><script>
const report = JSON.parse(document.getElementById('json').textContent);
const count = { charts: 0, paths: 0, points: 0, pictures: 4 * 5 }; // a wall for each domain: 3 to 7
const groups = new Set();
for (const series of report.series) {
	const values = series.measures.noise.filter(v => v > 2e-5).length;
	if (values === 0) continue;
	const fitted = report.fits.some(f => f.domain === series.domain && f.measure === 'noise');
	const relative = fitted && ['refine', 'electro', 'equal', 'lloyd'].includes(series.method);
	groups.add(series.domain + series.variant + ' plain');
	if (relative) groups.add(series.domain + series.variant + ' relative');
	count.paths += relative ? 2 : 1;
	count.points += relative ? 2 * values : values;
}
count.charts = groups.size;
Object.assign(document.documentElement.dataset, count);
</script></html>
EOT
opened count.html 800
for name in charts paths points pictures; do
	eval "$name=\$(value $name)"
	eval "[ \"\${$name:-0}\" -gt 0 ]" || problem "the figures: no $name to expect"
done

# drawn FILE WIDTH SCHEME OPTIONS…
drawn()
{
	where="$1, $2 wide, $3"
	file=$1
	expected_width=$2
	scheme=$3
	shift 3
	opened "$file" "$expected_width" "$@"
	quiet "$where"
	is ready yes "$where"
	is width "$expected_width" "$where"
	is scheme "$scheme" "$where"
	is overflow false "$where"
	is charts "$charts" "$where"
	is paths "$paths" "$where"
	is points "$points" "$where"
	is pictures "$pictures" "$where"
}

for width in 400 1400; do
	drawn page.html $width light --blink-settings=preferredColorScheme=1
	drawn page.html $width dark --blink-settings=preferredColorScheme=0
done

# Checks that the test itself can fail: a page with a broken script, and one that omits a series.
before=$failures
sed 's/^function drawCells/function drawCell/' page.html >broken.html
sed 's/^drawPanels();/state.shown.lloyd = false; drawPanels();/' page.html >fewer.html
for page in broken.html fewer.html; do
	drawn $page 1400 light --blink-settings=preferredColorScheme=1 >faults
	[ -s faults ] || echo "FAILED: $page: found no fault, expected one" >>missed
done
failures=$before
[ -e missed ] && problem "$(cat missed)"

finish
