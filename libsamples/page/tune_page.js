// SPDX-License-Identifier: GPL-3.0-or-later
// The page: the chosen candidate, its alternatives, and its files.
'use strict';

Object.assign(drawn, { fronts: 0, rows: 0 });
const METRIC = { name: data.measure, of: p => p.error };
const GOAL = { ms: data.goal.budget_ms, error: data.goal.max_error };
const onAllViews = p => p.rung >= data.rungs.length - 2 && p.views.length > 0;
const points = data.candidates.filter(p => !p.failed && p.views.length > 0).map(p => ({ name: p.candidate,
	method: p.method, origin: onAllViews(p) ? 'ours' : 'coarse', time: { ms: p.time_ms }, error: p.error, bytes: p.bytes }));
const taken = data.pick ?? data.nearest; // null: nothing could be drawn
let chosen = taken?.candidate;

function choose(name) {
	chosen = name;
	drawFigures();
}

// Half the interquartile range of the drawing times relative to the median, maximum over views; undefined for a single drawing.
function spreadOf(p) {
	if (p.time_ms === 0) return { text: 'none', value: null };
	if (data.rungs[p.rung].repetitions < 2) return { text: 'once', value: null };
	const most = Math.max(...p.views.map(v => v.time_ms > 0 ? 0.5 * (v.high_ms - v.low_ms) / v.time_ms : 0));
	return { text: `± ${(100 * most).toFixed(0)} %`, value: most };
}

// Standard error of the mean error over views.
function errorOfMean(p) {
	const n = p.views.length, mean = p.views.reduce((sum, v) => sum + v.error / n, 0);
	return n > 1 ? Math.sqrt(p.views.reduce((sum, v) => sum + (v.error - mean) ** 2, 0) / (n - 1) / n) : 0;
}

function drawTable() {
	const left = text => ({ text, class: 'text' });
	const rows = data.candidates.filter(p => !p.failed && onAllViews(p)).sort((a, b) => a.time_ms - b.time_ms).map(p => {
		const picked = p.candidate === taken?.candidate, over = errorOfMean(p);
		return { class: [picked && 'pick', p.candidate === chosen && 'chosen'].filter(Boolean).join(' '), click: () => choose(p.candidate), cells: [
			{ text: p.candidate, class: 'name', colour: p.method }, number(p.time_ms), spreadOf(p), { text: p.error.toFixed(4), value: p.error },
			{ text: `± ${over.toFixed(4)}`, value: over }, p.bytes > 0 ? number(p.bytes / 1e6) : { text: '', value: 0 }, left(picked ? (data.pick ? 'pick' : 'nearest') : data.front.includes(p.candidate) ? 'front' : '')] };
	});
	byId('table').replaceChildren();
	drawn.rows = 0;
	sortedTable(byId('table'), [left('candidate'), 'ms', 'spread', data.measure, 'over views', 'MB a level', left('')], rows, true);
}

function drawChart() {
	const values = of => [...points.map(of), of({ time: GOAL, error: GOAL.error })].filter(v => v > 0);
	drawn.charts = drawn.points = drawn.fronts = 0;
	drawScatter(byId('chart'), { title: 'time against error', points, metric: METRIC, times: rangeOf(values(p => p.time.ms)), errors: rangeOf(values(METRIC.of)),
		goal: GOAL, chosen, height: innerWidth < 700 ? 340 : 440, choose: p => choose(p.name), hush, tell: (p, mark) => tell(mark, p.name, [
			['time', `${shortNumber(p.time.ms)} ms`], [data.measure, shortNumber(p.error)], ['measured', p.origin === 'ours' ? 'at full size on all views' : 'coarsely']]) });
}

// Candidates that need an asset, volumes or bakes, which take no time of their own.
function drawBytes() {
	const needing = points.filter(p => p.bytes > 0).map(p => ({ ...p, time: { ms: p.bytes / 1e6 } }));
	byId('bytes-section').hidden = needing.length === 0;
	if (needing.length === 0) return;
	drawScatter(byId('bytes'), { title: 'bytes against error', points: needing, metric: METRIC, unit: 'megabytes a level', times: rangeOf([...needing.map(p => p.time.ms), data.max_bytes / 1e6].filter(v => v > 0)),
		errors: rangeOf([...needing.map(METRIC.of), GOAL.error].filter(v => v > 0)), goal: { error: GOAL.error, ms: data.max_bytes / 1e6 }, chosen, height: innerWidth < 700 ? 260 : 320,
		choose: p => choose(p.name), hush, tell: (p, mark) => tell(mark, p.name, [['bytes', `${shortNumber(p.time.ms)} MB`], [data.measure, shortNumber(p.error)]]) });
}

function drawFigures() {
	drawTable();
	drawChart();
	drawBytes();
	publish();
}

function drawText() {
	const { goal, pick, measured, search, failures } = data.texts;
	document.title = `nook: what to take for ${goal}`;
	byId('title').replaceChildren(data.pick ? 'Take ' : `Nothing reaches ${goal}`);
	if (taken) make(byId('title'), 'em', {}, data.pick ? taken.candidate : `; the nearest is ${taken.candidate}`);
	if (data.pick) byId('title').append(` for ${goal}`);
	byId('lead').textContent = `${taken ? `${pick}. ` : ''}Measured: ${measured}.`;
	drawMade(byId('made'), data, data.renderer);
	for (const line of failures) make(byId('failures'), 'div', { class: 'failure' }, line);
	byId('confidence').textContent = data.confidence;
	make(byId('search'), 'p', {}, `${search}.`);
}

function drawEmitted() {
	byId('command').textContent = data.command;
	if (!data.emitted) {
		for (const name of ['files', 'left-out', 'commands']) make(byId(name), 'p', {}, 'None: nothing could be drawn.');
		return;
	}
	const { files, holds, use, left_out, commands } = data.emitted;
	table(byId('files'), ['file', 'what it holds'], files.map((name, i) => [{ text: name, class: 'name' }, holds[i]]));
	for (const line of use) make(byId('files'), 'p', {}, line);
	if (left_out.length === 0) make(byId('left-out'), 'p', {}, 'Nothing of what was searched: the pick has all of it.');
	else {
		make(byId('left-out'), 'p', {}, files.some(name => name.endsWith('.glsl')) ? 'The shader has constants in place of options, and nothing of these:' : 'A bake needs no shader of nook’s. What else was searched:');
		table(byId('left-out'), ['feature', 'why'], left_out.map(left => [left.feature, left.why]));
	}
	byId('commands').textContent = commands.join('\n');
}

drawText();
drawEmitted();
drawFigures();
ready(drawFigures);
