// SPDX-License-Identifier: GPL-3.0-or-later
// Small SVG pictures of a pattern's points and weights.
'use strict';

// The part of a convex polygon where a·x + b·y ≤ c.
function clipHalfPlane(polygon, a, b, c) {
	const out = [];
	for (let i = 0; i < polygon.length; ++i) {
		const p = polygon[i], q = polygon[(i + 1) % polygon.length];
		const dp = a * p[0] + b * p[1] - c, dq = a * q[0] + b * q[1] - c;
		if (dp <= 0) out.push(p);
		if (dp < 0 !== dq < 0 && dp !== dq) {
			const t = dp / (dp - dq);
			out.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
		}
	}
	return out;
}

function pointsAt(series, count) {
	const flat = series.points[series.index.get(count)], step = series.planar ? 2 : 3, points = [];
	for (let i = 0; i < flat.length; i += step) points.push([flat[i], flat[i + 1], step === 3 ? flat[i + 2] : 0]);
	return points;
}

function drawPattern(parent, series, count) {
	const points = pointsAt(series, count), weights = series.weights[series.index.get(count)];
	const svg = make(parent, 'svg', { viewBox: '-1.06 -1.06 2.12 2.12', role: 'img', 'aria-label': `${series.domain}, ${series.method}, ${series.variant}, N = ${count}` });
	if (series.planar) drawCells(svg, series, count, points, weights);
	else drawSpace(svg, points, weights);
	drawn.pictures += 1;
	return svg;
}

// The disk's cells: a square clipped by the (power) bisectors, inside a circular clip path.
function drawCells(svg, series, count, points, weights) {
	const powers = series.powers && series.powers[series.index.get(count)];
	const clip = `disk${++drawCells.serial}`;
	make(make(make(svg, 'defs'), 'clipPath', { id: clip }), 'circle', { r: 1 });
	const cells = make(svg, 'g', { 'clip-path': `url(#${clip})`, style: 'stroke:var(--ink);stroke-width:0.012;stroke-opacity:0.55' });
	points.forEach((p, i) => {
		let polygon = [[-1.1, -1.1], [1.1, -1.1], [1.1, 1.1], [-1.1, 1.1]];
		points.forEach((q, j) => {
			if (j === i) return;
			const shift = powers ? powers[i] - powers[j] : 0;
			polygon = clipHalfPlane(polygon, q[0] - p[0], q[1] - p[1], (q[0] * q[0] + q[1] * q[1] - p[0] * p[0] - p[1] * p[1] + shift) / 2);
		});
		const shade = Math.min(0.75, Math.max(0.04, 0.28 * (weights[i] * points.length) ** 2));
		if (polygon.length > 2) make(cells, 'polygon', { points: polygon.map(v => `${v[0].toFixed(3)},${(-v[1]).toFixed(3)}`).join(' '), style: `fill:rgba(var(--cell),${shade.toFixed(3)})` });
	});
	make(svg, 'circle', { r: 1, style: 'fill:none;stroke:var(--ink);stroke-width:0.02' });
	const size = Math.min(0.055, 0.17 / Math.sqrt(points.length));
	for (const p of points) make(svg, 'circle', { cx: p[0], cy: -p[1], r: size.toFixed(3), style: 'fill:var(--ink)' });
}
drawCells.serial = 0;

// Viewed slightly from above and from the side, so that poles and axes do not coincide.
function drawSpace(svg, points, weights) {
	const cy = Math.cos(0.45), sy = Math.sin(0.45), cx = Math.cos(0.4), sx = Math.sin(0.4);
	const seen = points.map(p => {
		const x = cy * p[0] + sy * p[1], d = -sy * p[0] + cy * p[1];
		return [x, cx * p[2] - sx * d, sx * p[2] + cx * d]; // right, up, towards the viewer
	});
	const radius = points.map(p => Math.hypot(...p));
	const distance = (i, j) => Math.hypot(points[i][0] - points[j][0], points[i][1] - points[j][1], points[i][2] - points[j][2]);
	make(svg, 'circle', { r: 1, style: 'fill:rgba(var(--cell),0.07);stroke:var(--soft);stroke-width:0.014' });
	const nearest = points.map((_, i) => Math.min(...points.map((_, j) => j === i ? 9 : distance(i, j))));
	for (let i = 0; i < points.length; ++i) {
		for (let j = i + 1; j < points.length; ++j) {
			const joined = Math.abs(radius[i] - radius[j]) < 0.12 && distance(i, j) < 1.28 * Math.max(nearest[i], nearest[j]) && distance(i, j) < 1.7;
			if (!joined) continue;
			const near = (seen[i][2] + seen[j][2]) / 4 + 0.5;
			make(svg, 'line', { x1: seen[i][0].toFixed(3), y1: (-seen[i][1]).toFixed(3), x2: seen[j][0].toFixed(3), y2: (-seen[j][1]).toFixed(3),
				style: `stroke:var(--ink);stroke-width:${(0.006 + 0.014 * near).toFixed(4)};stroke-opacity:${(0.12 + 0.5 * near).toFixed(3)}` });
		}
	}
	const order = points.map((_, i) => i).sort((a, b) => seen[a][2] - seen[b][2]);
	const base = Math.min(0.1, 0.3 / Math.cbrt(points.length) ** 1.4);
	for (const i of order) {
		const near = seen[i][2] / 2 + 0.5;
		const inner = radius[i] < 0.45;
		make(svg, 'circle', { cx: seen[i][0].toFixed(3), cy: (-seen[i][1]).toFixed(3), r: (base * (0.6 + 0.6 * near) * Math.cbrt(weights[i] * points.length)).toFixed(3),
			style: `fill:${inner ? 'var(--electro)' : 'var(--refine)'};fill-opacity:${(0.3 + 0.7 * near).toFixed(3)};stroke:var(--paper);stroke-width:0.012` });
	}
}
