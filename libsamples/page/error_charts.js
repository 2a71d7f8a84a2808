// SPDX-License-Identifier: GPL-3.0-or-later
// Log-log charts of error against time for the candidates of one view and renderer, with the front.
'use strict';

const SHAPES = {
	ours: r => `M${-r},0a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0`,
	paper: r => `M0,${-1.25 * r}L${1.25 * r},0L0,${1.25 * r}L${-1.25 * r},0Z`,
	coarse: r => SHAPES.ours(r), // measured with reduced effort
	rays: r => `M${-r},${-r}L${r},${r}M${-r},${r}L${r},${-r}`,
};

// Lowest error for its time among candidates with both values; ignores rays and coarse measurements.
function frontOf(points, metric) {
	const order = points.filter(p => p.origin !== 'rays' && p.origin !== 'coarse' && p.time.ms > 0 && metric.of(p) > 0).sort((a, b) => a.time.ms - b.time.ms || metric.of(a) - metric.of(b));
	const front = [];
	let least = Infinity;
	for (const point of order) {
		if (metric.of(point) < least) { front.push(point); least = metric.of(point); }
	}
	return front;
}

const FINE_STEPS = [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8];

function rangeOf(values) {
	const low = Math.min(...values), high = Math.max(...values);
	return [low / 1.25, high * 1.25];
}

// chart: {title, points, metric, unit (of times, if not milliseconds), times: [low, high], errors: [low, high], chosen (name), limits: [[errors or none, text]], goal ({ms} or {error}, or none), height, choose(point), tell(point, mark), hush()}
function drawScatter(holder, chart) {
	const width = Math.max(280, Math.floor(holder.clientWidth)), height = chart.height;
	const left = 52, right = 14, top = 14, bottom = 40;
	holder.replaceChildren();
	const svg = make(holder, 'svg', { class: 'chart', viewBox: `0 0 ${width} ${height}`, width, height, role: 'img', 'aria-label': chart.title });
	drawn.charts += 1;
	const points = chart.points.filter(p => p.time.ms > 0 && chart.metric.of(p) > 0);
	if (points.length === 0) {
		make(svg, 'text', { x: left, y: height / 2, class: 'unit' }, 'Nothing to draw: no candidate is shown, or the error is not defined here.');
		return;
	}
	const [t0, t1] = chart.times, [e0, e1] = chart.errors;
	const x = t => left + (width - left - right) * Math.log(t / t0) / Math.log(t1 / t0);
	const y = e => top + (height - top - bottom) * Math.log(e1 / e) / Math.log(e1 / e0);
	const axis = make(svg, 'g', { class: 'axis' });
	// Intermediate ticks for short ranges; only powers of ten if space is tight.
	const ticks = (low, high, most) => [...(high / low < 8 ? [FINE_STEPS] : []), [1, 2, 5]].map(steps => logTicks(low, high, steps)).find(t => t.length <= most) || logTicks(low, high, [1]);
	for (const t of ticks(e0, e1, 12)) {
		make(axis, 'line', { class: 'grid', x1: left, x2: width - right, y1: y(t), y2: y(t) });
		make(axis, 'text', { x: left - 6, y: y(t) + 4, 'text-anchor': 'end' }, shortNumber(t));
	}
	for (const t of ticks(t0, t1, width / 45)) {
		make(axis, 'line', { class: 'grid', x1: x(t), x2: x(t), y1: top, y2: height - bottom + 4 });
		make(axis, 'text', { x: x(t), y: height - bottom + 17, 'text-anchor': 'middle' }, shortNumber(t));
	}
	make(axis, 'text', { x: width - right, y: height - 5, 'text-anchor': 'end' }, chart.unit || 'milliseconds');
	make(axis, 'text', { x: left + 4, y: top + 2 }, chart.metric.name);

	const goal = chart.goal || {};
	if (goal.ms) make(svg, 'line', { class: 'goal', x1: x(goal.ms), x2: x(goal.ms), y1: top, y2: height - bottom });
	if (goal.error) make(svg, 'line', { class: 'goal', x1: left, x2: width - right, y1: y(goal.error), y2: y(goal.error) });
	for (const [errors, text] of chart.limits || []) {
		const limit = errors && chart.metric.of(errors);
		if (!(limit > e0 && limit < e1)) continue;
		make(svg, 'line', { class: 'limit', x1: left, x2: width - right, y1: y(limit), y2: y(limit) });
		make(svg, 'text', { class: 'unit', x: left + 4, y: y(limit) - 5 }, text);
	}
	const front = frontOf(points, chart.metric);
	if (front.length > 0) {
		let path = `M${x(front[0].time.ms)},${top}V${y(chart.metric.of(front[0]))}`;
		for (const p of front.slice(1)) path += `H${x(p.time.ms)}V${y(chart.metric.of(p))}`;
		make(svg, 'path', { class: 'front', d: `${path}H${width - right}` });
		drawn.fronts += front.length;
	}
	const onFront = new Set(front.map(p => p.name));
	const marks = make(svg, 'g');
	for (const p of [...points].sort((a, b) => onFront.has(a.name) - onFront.has(b.name))) {
		const stroke = colour(p.method), px = x(p.time.ms), py = y(chart.metric.of(p));
		if (onFront.has(p.name) && p.time.low_ms > 0) {
			make(marks, 'line', { class: 'spread', stroke, x1: x(p.time.low_ms), x2: x(p.time.high_ms), y1: py, y2: py });
		}
		const mark = make(marks, 'path', { class: `mark ${p.origin}${p.name === chart.chosen ? ' chosen' : ''}`, d: SHAPES[p.origin](onFront.has(p.name) ? 5.2 : 3.6),
			transform: `translate(${px.toFixed(1)},${py.toFixed(1)})`, stroke, tabindex: onFront.has(p.name) ? 0 : -1, role: 'button', 'aria-label': `${p.name}: ${shortNumber(p.time.ms)} ${chart.unit || 'ms'}, ${chart.metric.name} ${shortNumber(chart.metric.of(p))}` });
		if (p.origin === 'ours') mark.setAttribute('fill', stroke);
		mark.addEventListener('pointerenter', () => chart.tell(p, mark));
		mark.addEventListener('focus', () => chart.tell(p, mark));
		mark.addEventListener('pointerleave', chart.hush);
		mark.addEventListener('blur', chart.hush);
		mark.addEventListener('click', () => chart.choose(p));
		mark.addEventListener('keydown', event => { if (event.key === 'Enter' || event.key === ' ') { event.preventDefault(); chart.choose(p); } });
		drawn.points += 1;
	}
	nameFront(svg, chart, front, x, y, { left, right: width - right, low: height - bottom });
}

// Labels the front where there is space; the selected candidate has priority.
function nameFront(svg, chart, front, x, y, { left, right, low }) {
	const placed = [];
	for (const p of [...front].sort((a, b) => (b.name === chart.chosen) - (a.name === chart.chosen))) {
		const px = x(p.time.ms), py = y(chart.metric.of(p));
		const room = right - px, text = p.name;
		if (placed.some(q => Math.abs(px - q[0]) < 150 && Math.abs(py - q[1]) < 14) || py > low - 8) continue;
		const end = room < 6.2 * text.length;
		if (end && px - left < 6.2 * text.length) continue;
		make(svg, 'text', { class: `front-label${p.name === chart.chosen ? ' chosen' : ''}`, x: end ? px - 8 : px + 8, y: py - 8, 'text-anchor': end ? 'end' : 'start' }, text);
		placed.push([px, py]);
	}
}
