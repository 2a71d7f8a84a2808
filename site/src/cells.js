// SPDX-License-Identifier: GPL-3.0-or-later
// Cells on the sphere, as it is seen from outside, and a section through those of the ball: what nook pattern -o FILE.svg shows.
import { clipHalfPlane, make } from 'nook:page';

// Rows: right, up, towards the viewer; drawSpace() looks the same way.
const SEEN = [[Math.cos(0.45), Math.sin(0.45), 0], [Math.sin(0.4) * Math.sin(0.45), -Math.sin(0.4) * Math.cos(0.45), Math.cos(0.4)],
	[-Math.cos(0.4) * Math.sin(0.45), Math.cos(0.4) * Math.cos(0.45), Math.sin(0.4)]];
const WIDE = 20; // of the tangent plane that a cell is cut out of: all but three degrees of its half of the sphere

const inner = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unitOf = v => { const length = Math.hypot(...v); return v.map(part => part / length); };
const crossOf = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// The visible part of a direction's cell in the picture, on the tangent plane at the direction, where great circles are lines.
function sphereCell(points, i) {
	const p = points[i], a = unitOf(crossOf(p, Math.abs(p[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0])), b = crossOf(p, a);
	let polygon = [[-WIDE, -WIDE], [WIDE, -WIDE], [WIDE, WIDE], [-WIDE, WIDE]];
	const keep = n => { polygon = clipHalfPlane(polygon, -inner(a, n), -inner(b, n), inner(p, n)); }; // (p + x a + y b) · n ≥ 0
	keep(SEEN[2]);
	points.forEach((q, j) => { if (j !== i) keep(p.map((part, k) => part - q[k])); });
	const at = ([x, y]) => unitOf(p.map((part, k) => part + x * a[k] + y * b[k]));
	return polygon.flatMap((from, k) => {
		const to = polygon[(k + 1) % polygon.length], first = at(from), last = at(to);
		return [0, 1, 2, 3, 4, 5, 6, 7].map(step => unitOf(first.map((part, m) => part + (last[m] - part) * step / 8)));
	}).map(v => [inner(v, SEEN[0]), inner(v, SEEN[1])]);
}

// Where a cell of the ball meets the plane z = 0.
function sectionCell(points, i) {
	const p = points[i];
	let polygon = [[-1.1, -1.1], [1.1, -1.1], [1.1, 1.1], [-1.1, 1.1]];
	points.forEach((q, j) => { if (j !== i) polygon = clipHalfPlane(polygon, q[0] - p[0], q[1] - p[1], (inner(q, q) - inner(p, p)) / 2); });
	return polygon;
}

function drawCellsOf(parent, label, points, weights, cellOf) {
	const svg = make(parent, 'svg', { viewBox: '-1.06 -1.06 2.12 2.12', role: 'img', 'aria-label': label }), clip = `cells${++drawCellsOf.serial}`;
	make(make(make(svg, 'defs'), 'clipPath', { id: clip }), 'circle', { r: 1 });
	const cells = make(svg, 'g', { 'clip-path': `url(#${clip})`, style: 'stroke:var(--ink);stroke-width:0.012;stroke-opacity:0.55' });
	points.forEach((_, i) => {
		const polygon = cellOf(points, i), shade = Math.min(0.75, Math.max(0.04, 0.28 * (weights[i] * points.length) ** 2));
		if (polygon.length > 2) make(cells, 'polygon', { points: polygon.map(v => `${v[0].toFixed(3)},${(-v[1]).toFixed(3)}`).join(' '), style: `fill:rgba(var(--cell),${shade.toFixed(3)})` });
	});
	make(svg, 'circle', { r: 1, style: 'fill:none;stroke:var(--ink);stroke-width:0.02' });
	return svg;
}
drawCellsOf.serial = 0;

export function drawSphere(parent, points, weights) {
	const svg = drawCellsOf(parent, `sphere, the cells of ${points.length} directions`, points, weights, sphereCell);
	for (const p of points.filter(q => inner(q, SEEN[2]) > 0)) {
		make(svg, 'circle', { cx: inner(p, SEEN[0]).toFixed(4), cy: (-inner(p, SEEN[1])).toFixed(4), r: Math.min(0.055, 0.24 / Math.sqrt(points.length)).toFixed(3), style: 'fill:var(--ink)' });
	}
}

export const drawSection = (parent, points, weights) => drawCellsOf(parent, `ball, the cells of ${points.length} points cut at z = 0`, points, weights, sectionCell);
