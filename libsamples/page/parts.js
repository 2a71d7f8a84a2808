// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by all pages: elements, numbers, sortable tables, tooltips, and a record of what was drawn.
'use strict';
const NS = 'http://www.w3.org/2000/svg';
const drawn = { charts: 0, points: 0, pictures: 0 };
const byId = id => document.getElementById(id);
const data = JSON.parse(byId('data').textContent);

function make(parent, name, attributes = {}, text) {
	const element = parent instanceof SVGElement || name === 'svg'
		? document.createElementNS(NS, name) : document.createElement(name);
	for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
	if (text !== undefined) element.textContent = text;
	parent.append(element);
	return element;
}

const colour = method => `var(--${method}, currentColor)`; // defined in error.css
const shortNumber = value => value === null || value === undefined ? '–' : value === 0 ? '0' : Math.abs(value) >= 1000 ? value.toFixed(0)
	: Math.abs(value) < 1e-3 ? value.toExponential(1) : String(+value.toPrecision(3));
const number = value => ({ text: shortNumber(value), value });

function swatch(method) {
	const mark = document.createElement('span');
	mark.className = 'swatch';
	mark.style.background = colour(method);
	return mark;
}

function button(parent, text, pressed, action, attributes = {}) {
	const element = make(parent, 'button', { type: 'button', 'aria-pressed': pressed, ...attributes }, text);
	element.addEventListener('click', action);
	return element;
}

// A short text with `code` spans.
function prose(parent, name, text) {
	const element = make(parent, name);
	text.split('`').forEach((part, i) => i % 2 ? make(element, 'code', {}, part) : element.append(part));
	return element;
}

// The line with the command and version that made the report.
function drawMade(parent, report, ...more) {
	const line = make(parent, 'p', { class: 'made' }, 'Made by ');
	make(line, 'code', {}, report.command);
	line.append(['', `nook ${report.version}`, ...more].join(' · '));
}

function drawReading(pairs) {
	const list = make(byId('reading-text'), 'dl');
	for (const [term, text] of pairs) { make(list, 'dt', {}, term); prose(list, 'dd', text); }
}

// Decodes base64.
function bytesOf(text) {
	const raw = atob(text), bytes = new Uint8ClampedArray(raw.length);
	for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
	return bytes;
}

// Rows are {cells, class, click}; a cell is a text or {text, value (sort key), class, colour (a method)}.
function addRow(body, row) {
	const tr = make(body, 'tr', row.class ? { class: row.class } : {});
	for (const cell of row.cells) {
		const td = make(tr, 'td', cell && cell.class ? { class: cell.class } : {}, cell && cell.text !== undefined ? cell.text : cell);
		if (cell && cell.colour) td.prepend(swatch(cell.colour));
	}
	if (row.click) { tr.style.cursor = 'pointer'; tr.addEventListener('click', row.click); }
}

function table(parent, head, rows) {
	const element = make(make(parent, 'div', { class: 'scroll' }), 'table');
	const first = make(make(element, 'thead'), 'tr'), body = make(element, 'tbody');
	for (const cell of head) make(first, 'th', {}, cell);
	for (const cells of rows) addRow(body, { cells });
	return element;
}

function sortedTable(parent, head, rows, tall) {
	const element = make(make(parent, 'div', { class: tall ? 'scroll tall' : 'scroll', tabindex: 0 }), 'table');
	const line = make(make(element, 'thead'), 'tr'), body = make(element, 'tbody');
	const valueOf = cell => cell && typeof cell === 'object' ? cell.value !== undefined ? cell.value : cell.text : cell;
	const fill = () => { body.replaceChildren(); for (const row of rows) addRow(body, row); };
	head.forEach((cell, column) => {
		const th = make(line, 'th', { class: cell.class || '', scope: 'col' });
		const sorter = make(th, 'button', { type: 'button' }, typeof cell === 'object' ? cell.text : cell);
		sorter.addEventListener('click', () => {
			const down = th.getAttribute('aria-sort') === 'ascending';
			for (const other of line.children) other.removeAttribute('aria-sort');
			th.setAttribute('aria-sort', down ? 'descending' : 'ascending');
			const missing = v => v === null || v === undefined || v === '–' || v === '';
			rows = [...rows].sort((a, b) => {
				const p = valueOf(a.cells[column]), q = valueOf(b.cells[column]);
				if (missing(p) || missing(q)) return missing(p) - missing(q);
				return (typeof p === 'number' && typeof q === 'number' ? p - q : String(p).localeCompare(String(q), 'en', { numeric: true })) * (down ? -1 : 1);
			});
			fill();
		});
	});
	fill();
	drawn.rows += rows.length;
	return element;
}

// Shows a tooltip with a name and values next to a mark.
function tell(mark, name, figures) {
	const tip = byId('tip'), box = mark.getBoundingClientRect();
	tip.replaceChildren();
	make(tip, 'strong', {}, name);
	const body = make(make(tip, 'table'), 'tbody');
	for (const [what, value] of figures) { const tr = make(body, 'tr'); make(tr, 'th', {}, what); make(tr, 'td', {}, value); }
	tip.hidden = false;
	tip.style.left = `${Math.max(4, Math.min(innerWidth - tip.offsetWidth - 8, box.left + 14))}px`;
	tip.style.top = `${box.top - tip.offsetHeight - 10 > 0 ? box.top - tip.offsetHeight - 10 : box.bottom + 10}px`;
}
const hush = () => { byId('tip').hidden = true; };

// Records what was drawn, for tests.
function publish(more = {}) {
	Object.assign(document.documentElement.dataset, { ...drawn, ...more, width: innerWidth,
		scheme: matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light',
		overflow: document.documentElement.scrollWidth > document.documentElement.clientWidth });
}

// Call once the page is complete; redraws charts when the width changes.
function ready(redraw) {
	publish();
	document.documentElement.dataset.ready = 'yes';
	let width = innerWidth;
	addEventListener('resize', () => { if (innerWidth !== width) { width = innerWidth; redraw(); } });
}
