// SPDX-License-Identifier: GPL-3.0-or-later
// The page's state, and everything that depends on it.
'use strict';

const reports = data.reports;

// In candidate order.
const METHODS = [...new Set(reports.flatMap(r => r.levels.flatMap(l => l.views.flatMap(v => v.points.map(p => p.method)))))];
const METRICS = [
	{ id: 'eq14', name: 'eq. 14', of: p => p.eq14, note: 'AOV’s perceptual error: differences of log(8-bit visibility + 1) and of its slopes. The front of the report’s JSON is that of this error.' },
	{ id: 'rmse', name: 'RMSE', of: p => p.rmse, note: 'Root of the mean squared difference of visibility (0 to 1).' },
	{ id: 'best', name: 'RMSE, best strength', of: p => p.best_rmse, note: 'RMSE once the obscurance is multiplied by the factor that brings it nearest to the reference: what a strength slider could do.' },
	{ id: 'flip', name: 'FLIP', of: p => p.flip, note: 'Mean FLIP (Andersson et al. 2020), visibility as a display value.' },
	{ id: 'ssim', name: '1 − SSIM', of: p => p.ssim === null ? null : 1 - p.ssim, note: 'One minus the mean structural similarity (Wang et al. 2004).' },
	{ id: 'own', name: 'noise', of: p => p.own_rmse, note: 'Difference to what the method itself draws with as many samples as it takes and no filter: noise and what filters blur, whatever the method leaves out.' },
];

// Level and camera pairs in any report.
const views = [];
for (const [r, report] of reports.entries()) {
	for (const level of report.levels) {
		for (const view of level.views) {
			let place = views.find(v => v.level === level.name && v.camera === view.camera);
			if (!place) views.push(place = { level: level.name, camera: view.camera, of: [] });
			place.of[r] = view;
			view.radius_m = level.radius_m;
		}
	}
}
Object.assign(drawn, { fronts: 0, rows: 0, reports: reports.length, views: views.length,
	failures: reports.flatMap(r => r.levels).filter(l => l.failure !== '').length });
const state = { view: 0, metric: METRICS[0], shown: new Set(METHODS), chosen: null, all: false };
const rendererName = report => report.machine.renderer;
const title = place => `${place.level}, ${place.camera}`;
const first = () => views[state.view].of.find(Boolean);

const form = p => p.origin === 'ours' ? 'nook' : p.origin;

// ---- Head

function drawHead() {
	const held = reports.map(report => {
		const shares = report.levels.flatMap(l => l.views.map(v => v.front.held));
		return shares.length ? shares.reduce((a, b) => a + b, 0) / shares.length : 0;
	});
	const count = new Set(views.map(v => v.level)).size;
	byId('lead').textContent = `${views.length} ${views.length === 1 ? 'view' : 'views'} of ${count} ${count === 1 ? 'level' : 'levels'}: what each method costs and how wrong it is. `
		+ reports.map((report, i) => `${i ? 'on' : 'On'} ${rendererName(report)} the least error within a budget of time is that of one of nook’s forms over ${Math.round(100 * held[i])} % of the budgets`).join('; ') + '.';
	for (const report of reports) {
		drawMade(byId('made'), report, rendererName(report), `${report.machine.threads} threads`);
		if (report.machine.software) make(byId('made'), 'p', { class: 'warn' }, `${rendererName(report)} draws on a CPU: its times say how much work a method is there, not what it takes on a GPU. Run the same command where there is one.`);
		for (const level of report.levels) for (const view of level.views) for (const one of view.stopped ?? [])
			make(byId('made'), 'p', { class: 'warn stopped' }, `Stopped: ${one.candidate} on ${level.name}, ${view.camera}: a picture would take about ${shortNumber(one.expected_s)} s.`);
		for (const level of report.levels.filter(l => l.failure !== '')) {
			const box = make(byId('failures'), 'div', { class: 'failure' });
			make(box, 'strong', {}, level.views.length > 0 ? `${level.name} is incomplete` : `${level.name} failed`);
			box.append(`: ${level.failure}`);
		}
	}
}

// ---- Time against error

function tellPoint(point, mark) {
	tell(mark, point.name, [['form', form(point)], ['time', `${shortNumber(point.time.ms)} ms (${shortNumber(point.time.low_ms)} to ${shortNumber(point.time.high_ms)})`],
		...METRICS.map(metric => [metric.name, shortNumber(metric.of(point))]),
		...(point.flicker !== null ? [['flicker', shortNumber(point.flicker)]] : []), ...(point.bytes > 0 ? [['bytes of the level’s asset', shortNumber(point.bytes)]] : []), ...(point.volumes > 0 ? [['fragments', shortNumber(point.fragments)]] : [])]);
}

function choose(point) {
	state.chosen = point.name;
	drawCharts();
	drawPictures();
}

function drawCharts() {
	const holder = byId('charts'), place = views[state.view];
	holder.replaceChildren();
	drawn.charts = drawn.points = drawn.fronts = 0;
	const shown = place.of.map(view => view ? view.points.filter(p => state.shown.has(p.method)) : []);
	const drawnPoints = shown.flat().filter(p => p.time.ms > 0 && state.metric.of(p) > 0);
	const times = drawnPoints.length ? rangeOf(drawnPoints.map(p => p.time.ms)) : [1, 10];
	const errors = drawnPoints.length ? rangeOf(drawnPoints.map(p => state.metric.of(p))) : [0.1, 1];
	const figures = place.of.map(view => view && make(holder, 'figure')); // create all first, so that each has its width
	place.of.forEach((view, r) => {
		if (!view) return;
		const figure = figures[r];
		make(figure, 'h3', {}, rendererName(reports[r]));
		drawScatter(make(figure, 'div'), { title: `${title(place)} on ${rendererName(reports[r])}`, points: shown[r], metric: state.metric, times, errors, chosen: state.chosen, limits: [[view.screen_space_limit, 'screen-space limit']],
			height: innerWidth < 700 ? 340 : 470, choose, tell: tellPoint, hush });
		drawBytes(figure, place, view, r, shown[r]);
		const share = view.front;
		make(figure, 'figcaption', {}, `${view.width_px} × ${view.height_px}, ${Math.round(100 * view.surface_share)} % of it surfaces; reference: radius ${shortNumber(view.radius_m)} m, standard error ${shortNumber(view.reference_error)}. `
			+ `By eq. 14 nook’s forms hold ${Math.round(100 * share.held)} % of the budgets. `
			+ (share.papers.length ? `Papers’ recipes on the front: ${share.papers.join(', ')}. ` : 'No paper’s recipe is on the front. ')
			+ (view.screen_space_limit && state.metric.of(view.screen_space_limit) > 0 ? `One layer of depth leaves ${state.metric.name} ${shortNumber(state.metric.of(view.screen_space_limit))} at best. ` : '')
			+ (share.worst_ratio ? `At worst ours err ${shortNumber(share.worst_ratio)} times what ${share.worst_paper} does at its budget.` : ''));
	});
	publish();
}

// Bytes that the level needs for it, against error: volumes and bakes.
function drawBytes(figure, place, view, r, shown) {
	const points = shown.filter(p => p.bytes > 0).map(p => ({ ...p, time: { ms: p.bytes / 1e3, low_ms: 0, high_ms: 0 } })).filter(p => state.metric.of(p) > 0);
	if (points.length === 0) return;
	make(figure, 'h3', {}, 'Bytes against error');
	drawScatter(make(figure, 'div', { class: 'bytes' }), { title: `${title(place)}: bytes against error`, points, metric: state.metric, unit: 'kilobytes', times: rangeOf(points.map(p => p.time.ms)),
		errors: rangeOf(points.map(p => state.metric.of(p))), chosen: state.chosen, height: innerWidth < 700 ? 260 : 300,
		choose: p => choose(view.points.find(q => q.name === p.name)), tell: (p, mark) => tellPoint(view.points.find(q => q.name === p.name), mark), hush });
}

function drawBars() {
	const bar = byId('view-bar');
	make(bar, 'span', { class: 'name' }, 'View');
	const select = make(bar, 'select', { 'aria-label': 'View' });
	views.forEach((place, i) => make(select, 'option', { value: i }, title(place)));
	select.addEventListener('change', () => { state.view = +select.value; state.chosen = null; drawView(); });
	const metrics = byId('metric-bar');
	make(metrics, 'span', { class: 'name' }, 'Error');
	for (const metric of METRICS) {
		button(metrics, metric.name, metric === state.metric, event => {
			state.metric = metric;
			for (const other of metrics.querySelectorAll('button')) other.setAttribute('aria-pressed', other === event.target);
			byId('metric-note').textContent = metric.note;
			drawCharts();
			drawLevels();
		});
	}
	byId('metric-note').textContent = state.metric.note;
	const methods = byId('method-bar');
	make(methods, 'span', { class: 'name' }, 'Methods');
	for (const method of METHODS) {
		const toggle = button(methods, method, true, () => {
			if (!state.shown.delete(method)) state.shown.add(method);
			toggle.setAttribute('aria-pressed', state.shown.has(method));
			drawCharts();
		}, { class: 'method', style: `color:var(--${method})` });
		toggle.prepend(swatch(method));
	}
	const rows = byId('rows-bar');
	make(rows, 'span', { class: 'name' }, 'Rows');
	for (const [text, all] of [['the front, and each paper’s best', false], ['all', true]]) {
		button(rows, text, all === state.all, event => {
			state.all = all;
			for (const other of rows.querySelectorAll('button')) other.setAttribute('aria-pressed', other === event.target);
			drawTable();
		});
	}
}

// ---- Tables

// The front, and the best paper form of each method.
function notable(view) {
	const best = {};
	for (const p of view.points.filter(p => p.origin !== 'ours')) {
		if (!best[p.method] || p.eq14 < best[p.method].eq14) best[p.method] = p;
	}
	return view.points.filter(p => p.front || Object.values(best).includes(p));
}

// AOV, figure 9: time and error of every view, one row per candidate.
function drawLevels() {
	const holder = byId('level-table'), places = views.flatMap(place => place.of.map((view, r) => view && { place, view, r }).filter(Boolean));
	holder.replaceChildren();
	drawn.rows = 0;
	const names = new Map();
	for (const { view } of places) for (const p of notable(view)) names.set(p.name, p);
	const of = (place, name) => place.view.points.find(p => p.name === name);
	const limits = places.map(place => {
		const errors = [...names.keys()].map(n => of(place, n)).filter(Boolean).map(p => state.metric.of(p)).filter(e => e !== null).sort((a, b) => a - b);
		return errors[Math.floor((errors.length - 1) / 4)];
	});
	const head = [{ text: 'candidate', class: 'text' }, { text: 'form', class: 'text' }];
	for (const { place, r } of places) {
		const name = title(place) + (reports.length > 1 ? ` (${r + 1})` : '');
		head.push(`${name}: ms`, state.metric.name);
	}
	const rows = [...names.values()].sort((a, b) => METHODS.indexOf(a.method) - METHODS.indexOf(b.method) || a.name.localeCompare(b.name, 'en', { numeric: true })).map(p => ({ cells: [
		{ text: p.name, class: 'name', colour: p.method }, { text: form(p), class: 'text' },
		...places.flatMap((place, i) => {
			const found = of(place, p.name);
			return found ? [number(found.time.ms), { ...number(state.metric.of(found)), class: state.metric.of(found) <= limits[i] ? 'best' : '' }] : ['–', '–'];
		})] }));
	sortedTable(holder, head, rows, true);
	if (reports.length > 1) make(holder, 'p', { class: 'note' }, reports.map((r, i) => `(${i + 1}) ${rendererName(r)}`).join(' · '));
	publish();
}

function drawTable() {
	const holder = byId('view-table'), place = views[state.view];
	holder.replaceChildren();
	place.of.forEach((view, r) => {
		if (!view) return;
		make(holder, 'h3', {}, `${title(place)}: ${rendererName(reports[r])}`);
		const rows = (state.all ? view.points : notable(view)).map(p => ({ class: p.front ? 'front' : '', click: () => choose(p), cells: [
			{ text: p.name, class: 'name', colour: p.method }, { text: form(p), class: 'text' }, { text: p.front ? 'front' : '', class: 'text' },
			number(p.time.ms), number((p.time.high_ms - p.time.low_ms) / 2), ...METRICS.map(m => number(m.of(p))), number(p.mean_error), number(p.best_factor),
			{ text: p.passes.map(s => `${s.pass} ${shortNumber(s.ms)}`).join(', '), class: 'passes' }] }));
		sortedTable(holder, [{ text: 'candidate', class: 'text' }, { text: 'form', class: 'text' }, { text: 'by eq. 14', class: 'text' }, 'ms', '± quartiles',
			...METRICS.map(m => m.name), 'mean error', 'best strength', { text: 'passes, ms', class: 'text' }], rows, true);
	});
	publish();
}

function drawStability() {
	const holder = byId('stability-table'), place = views[state.view];
	holder.replaceChildren();
	place.of.forEach((view, r) => {
		if (!view) return;
		const rows = view.points.filter(p => p.flicker !== null).sort((a, b) => a.flicker - b.flicker).map(p => ({ cells: [
			{ text: p.name, class: 'name', colour: p.method }, { text: form(p), class: 'text' }, number(p.own_rmse), number(p.flicker), number(p.eq14), number(p.time.ms)] }));
		if (rows.length === 0) { make(holder, 'p', { class: 'note' }, 'Flicker was not measured (--shifts).'); return; }
		if (reports.length > 1) make(holder, 'h3', {}, rendererName(reports[r]));
		sortedTable(holder, [{ text: 'candidate', class: 'text' }, { text: 'form', class: 'text' }, 'noise', 'flicker', 'eq. 14', 'ms'], rows);
	});
	publish();
}

// ---- Pictures

function drawPictures() {
	const bar = byId('picture-bar'), view = first();
	bar.replaceChildren();
	const pictured = view.points.filter(p => p.picture !== null);
	const asked = state.chosen && views[state.view].of.filter(Boolean).flatMap(v => v.points).find(p => p.name === state.chosen && p.picture !== null);
	const current = asked || view.points.find(p => p.name === state.chosen) || pictured.find(p => p.front) || pictured[0];
	make(bar, 'span', { class: 'name' }, title(views[state.view]));
	for (const p of pictured) {
		const entry = button(bar, p.name, p === current, () => choose(p), { class: 'method' });
		entry.prepend(swatch(p.method));
	}
	drawn.pictures = 0;
	drawViewer(byId('viewer'), view, current);
	drawn.pictured = pictured.length;
	publish();
}

function drawView() {
	drawCharts();
	drawTable();
	drawStability();
	drawPictures();
}

drawHead();
drawReading(data.reading);
if (views.length > 0) {
	drawBars();
	drawLevels();
	drawView();
}
ready(() => { if (views.length > 0) drawCharts(); });
