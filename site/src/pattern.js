// SPDX-License-Identifier: GPL-3.0-or-later
// The upper half: the program in a worker, a pattern while it relaxes, its measures beside the catalogue's, its files.
import { byId, data, drawPattern, make, publish, pointsAt, table } from 'nook:page';
import { drawSection, drawSphere } from './cells.js';
import { cancelProgram, hasWasm, program, succeedProgram } from './program.js';

const SENTENCE_WASM = 'This browser has no WebAssembly (or no workers), so that the program cannot run in it: patterns are made by the command line alone.';
const CELLS_UP_TO = 256; // more would take longer to draw than to make
const REPLAY_FRAMES = 90; // at most still to be shown once the work is done

// ---- What is asked for

export const made = { files: null, domain: '', count: 0, variant: '', data: null, listeners: [] };
export const fields = {};

function field(form, name, element, attributes, text) {
	const label = make(form, 'label', {}, text);
	fields[name] = make(label, element, attributes);
	return fields[name];
}

export function drawRecipe() {
	const form = byId('recipe');
	const choice = (name, text, names, chosen) => {
		const select = field(form, name, 'select', {}, text);
		for (const one of names) make(select, 'option', { value: one, ...(one === chosen ? { selected: '' } : {}) }, one);
	};
	choice('domain', 'Domain', data.domains.filter(name => name !== 'slice'), 'disk'); // slices have tiles alone
	field(form, 'count', 'input', { type: 'number', min: 1, max: data.most, value: 16, required: '' }, 'Samples');
	choice('variant', 'Form', ['free', 'centred', 'symmetric'], 'free');
	choice('method', 'Method', data.methods, 'refine');
	field(form, 'seed', 'input', { type: 'number', min: 0, max: 4294967295, value: 1, required: '' }, 'Seed');
	form.addEventListener('submit', event => { event.preventDefault(); makePattern(); });
	byId('cancel').addEventListener('click', () => cancelProgram());
	form.addEventListener('change', () => { if (!program.busy) byId('state').textContent = 'Not made yet with these choices.'; });
}

export function patternCommand() {
	const { domain, count, variant, method, seed } = fields, words = ['pattern', '--domain', domain.value, '--count', count.value];
	if (variant.value === 'centred') words.push('--centre');
	if (variant.value === 'symmetric') words.push('--symmetric');
	if (method.value !== 'refine') words.push('--method', method.value);
	if (seed.value !== '1') words.push('--seed', seed.value);
	return words;
}

// ---- The picture

const replay = { frames: [], step: 1, running: false, final: null, next: 0 };

// Weights are known for the finished pattern only.
function seriesOf({ domain, numbers, weights, method, variant }, count) {
	const planar = domain === 'disk' || domain === 'hemisphere', points = [];
	for (let i = 0; i < count; ++i) points.push(numbers[3 * i], numbers[3 * i + 1], ...(planar ? [] : [numbers[3 * i + 2]]));
	return { domain, planar, method, variant, index: new Map([[count, 0]]), points: [points],
		weights: [weights || new Array(count).fill(1 / count)] };
}

// The ball has two pictures: its points, and a section through its cells.
function drawCellPictures(holder, series, count) {
	holder.classList.toggle('two', series.domain === 'ball');
	if (series.domain !== 'sphere') drawPattern(holder, series, count);
	if (series.domain === 'sphere') drawSphere(holder, pointsAt(series, count), series.weights[0]);
	if (series.domain === 'ball') drawSection(holder, pointsAt(series, count), series.weights[0]);
}

function drawFrame(frame) {
	const { domain, numbers } = frame, holder = byId('pattern-picture'), count = numbers.length / 3;
	holder.replaceChildren();
	holder.classList.remove('two');
	if (count <= CELLS_UP_TO) { drawCellPictures(holder, seriesOf(frame, count), count); return; }
	const svg = make(holder, 'svg', { viewBox: '-1.06 -1.06 2.12 2.12', role: 'img', 'aria-label': `${domain}, N = ${count}` });
	make(svg, 'circle', { r: 1, style: 'fill:none;stroke:var(--ink);stroke-width:0.02' });
	for (let i = 0; i < count; ++i) make(svg, 'circle', { cx: numbers[3 * i].toFixed(4), cy: (-numbers[3 * i + 1]).toFixed(4), r: 0.008, style: 'fill:var(--ink)' });
}

function stepReplay() {
	const frame = replay.frames.splice(0, replay.step).pop();
	if (frame) drawFrame(frame);
	else if (replay.final) { drawFrame(replay.final); replay.running = false; publish({ settled: 'yes' }); return; }
	replay.running = true;
	replay.next = requestAnimationFrame(stepReplay);
}

function showFrame(frame, final) {
	if (final) Object.assign(replay, { final: frame, step: Math.max(1, Math.ceil(replay.frames.length / REPLAY_FRAMES)) });
	else if (!matchMedia('(prefers-reduced-motion: reduce)').matches) replay.frames.push(frame);
	if (!replay.running) { replay.running = true; stepReplay(); }
}

function clearReplay() {
	cancelAnimationFrame(replay.next);
	Object.assign(replay, { frames: [], step: 1, running: false, final: null });
}

// The pattern whose measures and files are shown.
function showMade() {
	if (made.files) showFrame({ domain: made.domain, method: made.method, variant: made.variant, numbers: numbersOfPattern(made.data), weights: made.data.weights }, true);
	else byId('pattern-picture').replaceChildren();
}

// ---- Making it

// One task more or less.
export function setBusy(change, text, share = change > 0 ? 0 : 1) {
	program.busy += change;
	byId('make').disabled = program.busy > 0;
	byId('cancel').disabled = program.busy === 0;
	byId('progress').value = share;
	byId('state').textContent = text;
}

export function tellProgress(what, share) {
	byId('progress').value = share;
	byId('state').textContent = `${what}: ${Math.round(100 * share)} %`;
}

const numbersOfPattern = pattern => Float64Array.from(pattern.points.flatMap(p => [p[0], p[1], p.length > 2 ? p[2] : 0]));

async function makePattern() {
	if (program.busy || !byId('recipe').reportValidity()) return;
	const domain = fields.domain.value, variant = fields.variant.value, method = fields.method.value, command = patternCommand(), take = ['pattern.json', 'pattern.h', 'pattern.glsl'];
	setBusy(1, 'Starting …');
	clearReplay();
	const began = performance.now();
	try {
		const answer = await succeedProgram([...command, ...take.flatMap(file => ['-o', file])], { take,
			onProgress: tellProgress,
			onPoints: (start, numbers) => showFrame({ domain, method, variant, numbers }, false) });
		const ms = performance.now() - began;
		const info = await succeedProgram(['info', 'pattern.json'], { files: { 'pattern.json': answer.files['pattern.json'] } });
		Object.assign(made, { files: answer.files, domain, variant, method, data: JSON.parse(answer.files['pattern.json']), ms, info: info.stdout });
		made.count = made.data.count;
		setBusy(-1, `Made in ${(ms / 1000).toFixed(2)} s.`);
		showMade();
		drawMeasures();
		for (const listener of made.listeners) listener();
	} catch (error) {
		clearReplay();
		showMade();
		setBusy(-1, error.message === 'cancelled' ? 'Cancelled; nothing was kept of it.' : error.message, 0);
	}
	publish({ patternMade: made.files ? made.data.command : '' });
}

// ---- Its measures and files

// "  plane   0.0175" → [["plane", "0.0175"], …]
const measuresOf = text => text.split('measured:\n')[1].trimEnd().split('\n').map(line => line.trim().split(/\s+/));

function drawMeasures() {
	const key = made.domain + (made.variant === 'free' ? '' : `_${made.variant}`), listed = (data.catalogue[key] || {})[made.count];
	const rows = measuresOf(made.info).map(([name, value]) => [name, { text: value, class: 'measure' },
		listed && listed[name] !== undefined ? { text: listed[name], class: listed[name] === value ? 'same' : 'differs' } : '–']);
	byId('pattern-measures').replaceChildren();
	table(byId('pattern-measures'), ['measure', 'this pattern', 'the catalogue’s'], rows);
	byId('pattern-note').textContent = listed ? `The catalogue’s: ${made.domain}, ${made.count} samples, ${made.variant}.`
		: 'The catalogue has none of this domain, form and count.';
	byId('pattern-caption').replaceChildren('Made again by ');
	make(byId('pattern-caption'), 'code', {}, `${made.data.command} -o pattern.json`);
	byId('pattern-caption').append(made.count > CELLS_UP_TO ? `. Cells are drawn up to ${CELLS_UP_TO} samples.` : '.');
	const bar = byId('downloads'), stem = `${key}_${String(made.count).padStart(3, '0')}`;
	bar.replaceChildren();
	make(bar, 'span', { class: 'name' }, 'Download');
	for (const [ending, text] of [['h', 'C header'], ['glsl', 'GLSL'], ['json', 'JSON']]) {
		downloadButton(bar, text, `${stem}.${ending}`, () => made.files[`pattern.${ending}`]);
	}
}

export function downloadButton(bar, text, name, content) {
	const element = make(bar, 'button', { type: 'button' }, text);
	element.addEventListener('click', () => {
		const url = URL.createObjectURL(new Blob([content()], { type: 'text/plain' }));
		const link = make(document.body, 'a', { href: url, download: name });
		link.click();
		link.remove();
		setTimeout(() => URL.revokeObjectURL(url), 1000);
	});
}

export function startPattern() {
	if (hasWasm()) { makePattern(); return; }
	byId('no-wasm').textContent = SENTENCE_WASM;
	byId('no-wasm').hidden = false;
	for (const element of [byId('recipe'), byId('run-bar')]) element.hidden = true;
	document.querySelector('#pattern .pair').hidden = true;
}
