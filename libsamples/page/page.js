// SPDX-License-Identifier: GPL-3.0-or-later
// The page's sections, built from the report's JSON.
'use strict';
const report = data;
const METHODS = ['refine', 'electro', 'equal', 'lloyd', 'vogel', 'halton', 'poisson', 'random'];
const VARIANTS = ['free', 'centred', 'symmetric'];
const DOMAINS = { disk: 'Disk (line samples)', ball: 'Ball (point samples)', sphere: 'Sphere (directions)', hemisphere: 'Hemisphere (cosine-weighted directions)' };
const MEASURES = {
	noise: 'What a random rotation of the pattern at every pixel shows: the part of the plane error that changes with the rotation.',
	plane: 'Rms error over half-spaces, as a share of the domain: noise² + bias².',
	bias: 'The part of the plane error that is the same for every rotation: a blur cannot remove it.',
	cliff: 'Rms error over vertical planes (disk): a line is wholly free or wholly occluded.',
	centre: 'Rms error over planes through the centre (disk, ball): what a flat surface shows when no normal is used. Zero for antipodal patterns.',
	crease: 'Rms error over concave corners of two half-spaces (disk).',
	spread: 'Relative standard deviation of the cells’ integrals.',
};
const RELATIVE_DEFAULT = ['refine', 'electro', 'equal', 'lloyd'];
const state = { measure: 'noise', shown: Object.fromEntries(METHODS.map(m => [m, RELATIVE_DEFAULT.includes(m)])) };

for (const series of report.series) {
	series.index = new Map(series.counts.map((n, i) => [n, i]));
	series.planar = series.domain === 'disk' || series.domain === 'hemisphere';
}
const seriesOf = (domain, variant) => METHODS.map(method => report.series.find(s => s.domain === domain && s.variant === variant && s.method === method)).filter(Boolean);
const fitOf = (domain, measure) => report.fits.find(f => f.domain === domain && f.measure === measure);
const groups = Object.keys(DOMAINS).flatMap(domain => VARIANTS.map(variant => ({ domain, variant, list: seriesOf(domain, variant) }))).filter(g => g.list.length > 0);

// ---- Noise against count

function drawPanels() {
	const holder = byId('panels');
	drawn.charts = drawn.paths = drawn.points = drawn.dips = 0;
	if (holder.childElementCount === 0) {
		for (const group of groups) {
			group.panel = make(holder, 'div', { class: 'panel' });
			group.head = make(group.panel, 'h3');
			for (const side of ['plain', 'relative']) {
				const figure = make(group.panel, 'figure');
				group[side] = make(figure, 'div');
				group[`${side}Caption`] = make(figure, 'figcaption');
			}
		}
	}
	const all = Object.fromEntries(METHODS.map(m => [m, true]));
	for (const group of groups) {
		const fit = fitOf(group.domain, state.measure), title = `${DOMAINS[group.domain]}, ${group.variant}`;
		group.head.textContent = title;
		const chart = { list: group.list, measure: state.measure, title };
		drawChart(group.plain, { ...chart, shown: all, relative: null, height: 250 });
		group.plainCaption.textContent = `${state.measure}, every method`;
		if (fit) {
			drawChart(group.relative, { ...chart, shown: state.shown, relative: fit, height: 250 });
			group.relativeCaption.textContent = `${state.measure} ÷ (${fit.factor.toPrecision(3)} · N^−${fit.exponent.toFixed(3)}); 1 is the trend of refine, free`;
		} else {
			group.relative.replaceChildren();
			group.relativeCaption.textContent = 'No trend: this measure is not defined here, is zero, or too few counts were made.';
		}
	}
	publish();
}

function drawBars() {
	const measures = byId('measure-bar');
	make(measures, 'span', { class: 'name' }, 'Measure');
	for (const name of Object.keys(MEASURES)) {
		const button = make(measures, 'button', { type: 'button', 'aria-pressed': name === state.measure }, name);
		button.addEventListener('click', () => {
			state.measure = name;
			for (const other of measures.querySelectorAll('button')) other.setAttribute('aria-pressed', other === button);
			byId('measure-note').textContent = MEASURES[name];
			drawPanels();
		});
	}
	byId('measure-note').textContent = MEASURES[state.measure];
	const methods = byId('method-bar');
	make(methods, 'span', { class: 'name' }, 'Methods (charts on the right)');
	for (const method of METHODS) {
		const button = make(methods, 'button', { type: 'button', class: 'method', 'aria-pressed': state.shown[method], style: `color:${colour(method)}` });
		make(button, 'span', { class: 'swatch', style: `background:${colour(method)}` });
		button.append(method);
		button.addEventListener('click', () => {
			state.shown[method] = !state.shown[method];
			button.setAttribute('aria-pressed', state.shown[method]);
			drawPanels();
		});
	}
}

// ---- Pictures

function addPicture(parent, series, count) {
	const pic = make(parent, 'div', { class: 'pic' });
	drawPattern(pic, series, count);
	const fit = fitOf(series.domain, 'noise'), ratio = fit && localRatio(series, 'noise', count, fit.exponent);
	const line = make(pic, 'div');
	make(line, 'b', {}, `N = ${count}`);
	const noise = series.measures.noise[series.index.get(count)];
	make(pic, 'div', { class: 'soft' }, `noise ${figure3(noise)}${ratio ? ` (${ratio.toFixed(2)})` : ''}`);
	if (ratio && ratio <= DIP && count >= 3) pic.classList.add('dip-pic');
}

function drawWalls() {
	for (const domain of Object.keys(DOMAINS)) {
		const choices = report.series.filter(s => s.domain === domain && s.points);
		if (choices.length === 0) continue;
		make(byId('walls'), 'h3', {}, DOMAINS[domain]);
		const bar = make(byId('walls'), 'div', { class: 'bar' });
		make(bar, 'label', { class: 'name', for: `wall-${domain}` }, 'Series');
		const select = make(bar, 'select', { id: `wall-${domain}` });
		choices.forEach((s, i) => make(select, 'option', { value: i }, `${s.method}, ${s.variant}`));
		const more = make(bar, 'button', { type: 'button', 'aria-pressed': false }, 'every count');
		const wall = make(byId('walls'), 'div', { class: 'wall' });
		const redraw = () => {
			drawn.pictures -= wall.querySelectorAll('svg').length;
			wall.replaceChildren();
			const series = choices[select.value], every = more.getAttribute('aria-pressed') === 'true';
			for (const n of series.counts) if (every || report.selected.includes(n)) addPicture(wall, series, n);
			publish();
		};
		select.addEventListener('change', redraw);
		more.addEventListener('click', () => { more.setAttribute('aria-pressed', more.getAttribute('aria-pressed') !== 'true'); redraw(); });
		redraw();
	}
}

// ---- Tables

function startsText(series) {
	const least = Math.min(...series.starts), most = Math.max(...series.starts);
	return most === 0 ? '' : least === most ? most : `${least}–${most}`;
}

function drawMethods() {
	for (const { domain, variant, list } of groups) {
		if (variant !== 'free') continue;
		const counts = report.compared.filter(n => list.some(s => s.index.has(n)));
		if (counts.length === 0) continue;
		make(byId('method-tables'), 'h3', {}, `${DOMAINS[domain]}: plane / noise`);
		const value = (s, m, n) => s.index.has(n) ? s.measures[m][s.index.get(n)] : undefined;
		const best = n => Math.min(...report.series.filter(s => s.domain === domain).map(s => value(s, 'plane', n) ?? Infinity));
		const rows = [];
		for (const g of groups.filter(g => g.domain === domain)) {
			for (const s of g.list) {
				if (g.variant !== 'free' && s.method !== 'refine' && s.method !== 'electro') continue;
				rows.push([`${s.method}${g.variant === 'free' ? '' : `, ${g.variant}`}`, startsText(s),
					...counts.map(n => ({ text: value(s, 'plane', n) === undefined ? '' : `${figure3(value(s, 'plane', n))} / ${figure3(value(s, 'noise', n))}`, class: value(s, 'plane', n) <= best(n) * 1.000001 ? 'best' : '' }))]);
			}
		}
		table(byId('method-tables'), ['method', 'starts', ...counts.map(n => `N = ${n}`)], rows);
	}
}

function drawText() {
	byId('lead').textContent = report.lead;
	drawMade(byId('made'), report);
	drawReading(report.reading);
}

drawBars();
drawText();
drawPanels();
drawMethods();
drawWalls();
publish();
ready(drawPanels);
