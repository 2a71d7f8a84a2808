// SPDX-License-Identifier: GPL-3.0-or-later
// SVG charts of a measure against the count, with a read-out.
'use strict';
Object.assign(drawn, { paths: 0, dips: 0 });

const figure3 = value => value === undefined || value === null ? '–' : value === 0 ? '0'
	: value < 2e-5 ? '0' : value >= 0.01 ? value.toFixed(4) : value.toPrecision(2);

// ---- Trends, defined as in the table of claims.

// Values below this are zero up to rounding; their logarithm is meaningless.
const ZERO = 2e-5;

function valueAt(series, measure, count) {
	const i = series.index.get(count);
	const value = i === undefined || !series.measures[measure] ? undefined : series.measures[measure][i];
	return value === null || value === undefined || value <= ZERO ? undefined : value;
}

// Ratio to the geometric mean of up to two neighbours on each side, each extrapolated to this count along N^−p.
function localRatio(series, measure, count, exponent) {
	const value = valueAt(series, measure, count);
	if (value === undefined) return undefined;
	let sum = 0, found = 0, sides = 0;
	for (const side of [-1, 1]) {
		let here = 0;
		for (let k = count + side; Math.abs(k - count) <= 4 && k > 0 && here < 2; k += side) {
			const other = valueAt(series, measure, k);
			if (other !== undefined) { sum += Math.log(other) + exponent * Math.log(k / count); here += 1; }
		}
		found += here;
		sides += here > 0;
	}
	return sides === 2 ? value / Math.exp(sum / found) : undefined;
}

const DIP = 0.95;

// ---- One chart.

function niceTicks(low, high, wanted) {
	const rough = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(rough));
	const step = power * [1, 2, 5, 10].find(m => m * power >= rough);
	const ticks = [];
	for (let t = Math.ceil(low / step) * step; t <= high + 1e-9; t += step) ticks.push(+t.toFixed(10));
	return ticks;
}

function logTicks(low, high, steps = [1, 2, 5]) {
	const ticks = [];
	for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e) {
		for (const m of steps) {
			const t = +(m * 10 ** e).toPrecision(3);
			if (t >= low && t <= high) ticks.push(t);
		}
	}
	return ticks;
}

// chart: {list (series), measure, relative (the domain's fit, or null), shown (method → bool), height, title}
function drawChart(holder, chart) {
	const width = Math.max(260, Math.floor(holder.clientWidth)), height = chart.height;
	const left = 46, right = 14, top = 12, bottom = 38;
	holder.replaceChildren();
	const svg = make(holder, 'svg', { class: 'chart', viewBox: `0 0 ${width} ${height}`, width, height, role: 'img', tabindex: 0, 'aria-label': chart.title });
	const fit = chart.relative;
	const scaled = (series, n) => {
		const value = valueAt(series, chart.measure, n);
		return value === undefined || !fit ? value : value * n ** fit.exponent / fit.factor;
	};
	const list = chart.list.filter(series => chart.shown[series.method] && series.counts.some(n => scaled(series, n) !== undefined));
	if (list.length === 0) {
		make(svg, 'text', { x: left, y: height / 2, class: 'unit' }, chart.empty || 'Nothing to draw: this measure is not defined here, or is zero everywhere.');
		return;
	}
	const counts = [...new Set(list.flatMap(series => series.counts))].sort((a, b) => a - b);
	const first = fit ? 1 : Math.max(1, counts[0]), last = counts[counts.length - 1];
	const values = list.flatMap(series => series.counts.filter(n => !fit || n >= 3).map(n => scaled(series, n))).filter(v => v !== undefined);
	let low = Math.min(...values), high = Math.max(...values);
	if (fit) { low = Math.max(0, Math.min(0.9, low - 0.06)); high = Math.min(2, Math.max(1.15, high + 0.04)); }
	const logX = !fit && last > 1;
	const x = n => left + (width - left - right) * (logX ? Math.log(n / first) / Math.log(last / first) : (n - first + 0.6) / (last - first + 1.2));
	const y = v => fit ? top + (height - top - bottom) * (high - v) / (high - low)
		: top + (height - top - bottom) * Math.log(high / v) / Math.log(high / low || 2);

	const axis = make(svg, 'g', { class: 'axis' });
	const ticks = fit ? niceTicks(low, high, 5) : logTicks(low, high);
	const digits = ticks.some(t => Math.abs(t * 10 - Math.round(t * 10)) > 1e-6) ? 2 : 1;
	for (const t of ticks) {
		make(axis, 'line', { class: fit && Math.abs(t - 1) < 1e-9 ? 'one' : 'grid', x1: left, x2: width - right, y1: y(t), y2: y(t) });
		make(axis, 'text', { x: left - 6, y: y(t) + 4, 'text-anchor': 'end' }, fit ? t.toFixed(digits) : String(t));
	}
	const roomy = width > 620;
	const marks = logX ? [1, 2, 4, 8, 16, 32, 64, 128] : Array.from({ length: last }, (_, i) => i + 1).filter(n => n % (roomy ? 4 : 8) === 0);
	for (const n of marks.filter(n => n >= first && n <= last)) {
		make(axis, 'line', { class: 'grid', x1: x(n), x2: x(n), y1: height - bottom, y2: height - bottom + 4 });
		make(axis, 'text', { x: x(n), y: height - bottom + 16, 'text-anchor': 'middle' }, n);
	}
	make(axis, 'text', { x: width - right, y: height - 4, 'text-anchor': 'end' }, 'samples N');

	const clip = `clip${++drawChart.serial}`;
	make(make(make(svg, 'defs'), 'clipPath', { id: clip }), 'rect', { x: left - 2, y: top - 6, width: width - left - right + 8, height: height - top - bottom + 8 });
	const curves = make(svg, 'g', { 'clip-path': `url(#${clip})` });
	const labels = [];
	for (const series of [...list].reverse()) {
		const chief = series.method === 'refine' || series.method === 'electro';
		const group = make(curves, 'g', { stroke: colour(series.method), fill: colour(series.method) });
		const points = series.counts.map(n => [n, scaled(series, n)]).filter(p => p[1] !== undefined);
		make(group, 'path', { class: chief || !fit ? 'curve' : 'curve faint', d: points.map((p, i) => `${i ? 'L' : 'M'}${x(p[0]).toFixed(1)} ${y(p[1]).toFixed(1)}`).join('') });
		drawn.paths += 1;
		for (const [n, v] of points) {
			drawn.points += 1;
			const ratio = fit && chief ? localRatio(series, chart.measure, n, fit.exponent) : undefined;
			const dip = n >= 3 && ratio !== undefined && ratio <= DIP;
			make(group, 'circle', { cx: x(n).toFixed(1), cy: y(v).toFixed(1), r: dip ? 4 : fit ? 1.9 : 1.5, ...(dip ? { class: 'dip' } : { stroke: 'none' }) });
			if (dip) labels.push({ n, x: x(n), y: y(v) + 17, fill: colour(series.method), chief: series.method === 'refine' });
		}
	}
	// One number per count, below the lowest of its rings.
	const byCount = new Map();
	for (const label of labels) if (!byCount.has(label.n) || label.y > byCount.get(label.n).y) byCount.set(label.n, label);
	for (const label of byCount.values()) {
		make(svg, 'text', { class: 'dip-label', x: label.x.toFixed(1), y: Math.min(label.y, height - bottom - 2).toFixed(1), style: `fill:${label.fill}` }, label.n);
		drawn.dips += 1;
	}
	drawn.charts += 1;
	addReadout(svg, { ...chart, list, counts, x, first, last, top, bottom: height - bottom, scaled });
}
drawChart.serial = 0;

// ---- The read-out: every visible series at the count under the pointer, and the pattern of the main one.

function addReadout(svg, chart) {
	const cursor = make(svg, 'line', { class: 'cursor', y1: chart.top, y2: chart.bottom, visibility: 'hidden' });
	const tip = document.getElementById('tip');
	let current = chart.counts[0];
	const show = (n, clientX, clientY) => {
		current = n;
		cursor.setAttribute('x1', chart.x(n));
		cursor.setAttribute('x2', chart.x(n));
		cursor.setAttribute('visibility', 'visible');
		tip.replaceChildren();
		make(tip, 'h4', {}, `${chart.title}, N = ${n}`);
		const table = make(tip, 'table');
		const head = make(table, 'tr');
		for (const cell of ['', chart.measure, ...(chart.relative ? ['× N^p', 'to neighbours'] : [])]) make(head, 'th', {}, cell);
		for (const series of chart.list) {
			if (!series.index.has(n)) continue;
			const row = make(table, 'tr'), name = make(row, 'td');
			make(name, 'span', { class: 'swatch', style: `background:${colour(series.method)}` });
			name.append(series.method);
			make(row, 'td', {}, figure3(series.measures[chart.measure] && series.measures[chart.measure][series.index.get(n)]));
			if (chart.relative) {
				const scaled = chart.scaled(series, n), ratio = localRatio(series, chart.measure, n, chart.relative.exponent);
				make(row, 'td', {}, scaled === undefined ? '–' : scaled.toFixed(3));
				make(row, 'td', {}, ratio === undefined ? '–' : ratio.toFixed(3));
			}
		}
		const pictured = chart.list.find(series => series.points && series.index.has(n));
		if (pictured) {
			drawPattern(tip, pictured, n);
			make(tip, 'div', { class: 'note' }, pictured.method);
		}
		tip.hidden = false;
		const box = tip.getBoundingClientRect();
		const x = clientX + 18 + box.width > innerWidth ? clientX - 18 - box.width : clientX + 18;
		tip.style.left = `${Math.max(4, x)}px`;
		tip.style.top = `${Math.max(4, Math.min(clientY - 30, innerHeight - box.height - 8))}px`;
	};
	const hide = () => { tip.hidden = true; cursor.setAttribute('visibility', 'hidden'); };
	svg.addEventListener('pointermove', event => {
		const at = event.clientX - svg.getBoundingClientRect().left;
		show(chart.counts.reduce((a, b) => Math.abs(chart.x(a) - at) <= Math.abs(chart.x(b) - at) ? a : b), event.clientX, event.clientY);
	});
	svg.addEventListener('pointerleave', hide);
	svg.addEventListener('blur', hide);
	svg.addEventListener('keydown', event => {
		const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
		if (event.key === 'Escape') hide();
		if (step === undefined) return;
		event.preventDefault();
		const i = Math.min(Math.max(chart.counts.indexOf(current) + step, 0), chart.counts.length - 1);
		const box = svg.getBoundingClientRect();
		show(chart.counts[i], box.left + chart.x(chart.counts[i]), box.top + chart.top);
	});
}
