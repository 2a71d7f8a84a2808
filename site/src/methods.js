// SPDX-License-Identifier: GPL-3.0-or-later
// Every method: what is chosen, the two pictures on either side of the slider, and their figures.
import { button, byId, bytesOf, data, make, publish, shortNumber, table } from 'nook:page';
import { choiceBar } from './choices.js';
import { lookAround } from './look.js';
import { openGl, pictureOf, readScalars, timed } from './gl.js';
import { downloadButton, made, setBusy, tellProgress } from './pattern.js';
import { cancelProgram, succeedProgram } from './program.js';
import { castScene, eye, eyeAxes, eyeMatrix, moveEye, numbersOf, resetEye, SKY, triangleScene, turnEye } from './scene.js';
import { drawSplit, makeShader, methodNamed, shading, tileOfHeader } from './shade.js';

const SENTENCE_GL = 'This browser has no WebGL2 that draws 32-bit floats (EXT_color_buffer_float), so that the level cannot be shaded in it.';
const SAMPLES = { tile: 'a tile, made together', random: 'one pattern, turned at random', one: 'one pattern, everywhere the same', made: 'yours, from above, as a tile' };
const FILTERS = { window: 'window', bilateral: 'bilateral', none: 'none' };
const RIGHT = { rays: 'rays', random: 'the same, turned at random', raw: 'the same, unfiltered', open: 'nothing' };
export const view = data.view;
export const state = { method: shading.methods[0], samples: 'tile', filter: 'window', right: 'rays', lit: false, numbers: {}, modules: new Map() };
export const wished = { samples: 'tile', filter: 'window', right: 'rays' }; // by whoever looks, kept where a method has none of it
export const stage = { gl: null, cast: null, triangles: null, rays: null, open: null, left: null, right: null, serial: 0, gpu: null };

// ---- Modules: those of the page, or one that the program emits now

const moduleOfPage = (method, samples, filter) => method.modules.find(m => m.one === (samples === 'one') && m.filter === filter);

function samplesOf(method, name) {
	const found = method.samples.find(one => one.name === name);
	return found && { ...found, texels: numbersOf(found.texels, Float32Array) };
}

async function madeTile() {
	if (!made.tile || made.tile.of !== made.files) {
		const of = made.files;
		setBusy(1, 'Making a tile of your pattern …');
		tellWork('Making a tile of your pattern …', 0);
		try {
			const answer = await succeedProgram(['tile', '--pattern', 'pattern.json', '--size', '4', '-o', 'tile.json'],
				{ files: { 'pattern.json': of['pattern.json'] }, take: ['tile.json'],
					onProgress: (what, share) => { tellProgress(what, share); tellWork(`Making a tile of your pattern, ${what}: ${Math.round(100 * share)} %`, share); } });
			made.tile = { of, text: answer.files['tile.json'] };
			setBusy(-1, 'The tile of your pattern is made.');
		} catch (error) {
			setBusy(-1, error.message === 'cancelled' ? 'Cancelled; there is no tile of your pattern.' : error.message, 0);
			throw error;
		} finally { byId('stage-work').hidden = true; }
	}
	return { file: 'tile.json', text: made.tile.text };
}

// Work beside the level, shown there at once.
function tellWork(text, share) {
	byId('stage-work').hidden = false;
	byId('stage-progress').value = share;
	byId('stage-state').textContent = text;
}

function emitWords(method, file, filter) {
	return ['emit', '--methods', method.name, '--patterns', file, ...(filter === 'none' ? [] : ['--filter', filter]),
		...(filter === 'bilateral' ? ['--taps', '5'] : []), '--glsl', 'es300'];
}

async function emittedModule(method, source, filter, page) {
	const words = emitWords(method, source.file, filter);
	const answer = await succeedProgram([...words, '-o', 'nook_ao.glsl', '-o', 'nook_ao.h'], { files: { [source.file]: source.text }, take: ['nook_ao.glsl', 'nook_ao.h'] });
	return { ...page, command: `nook ${words.join(' ')}`, module: answer.files['nook_ao.glsl'], samples: page.one ? undefined : tileOfHeader(answer.files['nook_ao.h']) };
}

// {module, plan, samples, command} of what is chosen; the same object for the same choice.
async function moduleFor(method, samples, filter) {
	const page = moduleOfPage(method, samples, filter), now = samples === 'made';
	const source = samples === 'made' ? await madeTile() : method.samples.find(one => one.name === samples);
	const key = [method.name, filter, samples, now ? source.text : ''].join('|');
	if (!state.modules.has(key)) {
		state.modules.set(key, now ? await emittedModule(method, source, filter, page) : { ...page, samples: page.one ? undefined : samplesOf(method, samples) });
	}
	return state.modules.get(key);
}

// ---- What may be chosen

export const filtersOf = method => [...new Set(method.modules.filter(m => m.one === (state.samples === 'one')).map(m => m.filter))];

const pick = (names, keys) => Object.fromEntries(keys.filter(key => key in names).map(key => [key, names[key]]));

function drawChoices() {
	const method = state.method, all = method.samples.length > 0;
	choiceBar('method-bar', 'Method', Object.fromEntries(shading.methods.map(m => [m.name, m.name])), method.name, name => { chooseMethod(methodNamed(name)); update(); });
	for (const element of byId('method-bar').querySelectorAll('button')) element.title = methodNamed(element.dataset.choice).what;
	choiceBar('samples-bar', 'Samples', all ? SAMPLES : {}, state.samples, name => { wished.samples = name; settle(); update(); },
		name => name !== 'made' || (made.files !== null && made.domain === method.domain));
	choiceBar('filter-bar', 'Filter', pick(FILTERS, filtersOf(method)), state.filter, name => { wished.filter = name; settle(); update(); });
	const rights = pick(RIGHT, ['rays', ...(all ? ['random'] : []), ...(filtersOf(method).length > 1 ? ['raw'] : []), 'open']);
	choiceBar('right-bar', 'Right of the slider', rights, state.right, name => { wished.right = name; settle(); update(); }, name => name !== 'rays' || !eye.moved);
	choiceBar('show-bar', 'Show', { grey: 'visibility', lit: 'ambient light' }, state.lit ? 'lit' : 'grey', name => { state.lit = name === 'lit'; update(); });
}

// A setting that does not go with the method is replaced by one that does, and returns with a method that takes it.
export function settle() {
	Object.assign(state, wished);
	if (state.samples === 'made' && (!made.files || made.domain !== state.method.domain)) state.samples = 'tile';
	if (!filtersOf(state.method).includes(state.filter)) state.filter = filtersOf(state.method)[0];
	if (state.right === 'random' && state.method.samples.length === 0) state.right = 'rays';
	if (state.right === 'raw' && filtersOf(state.method).length < 2) state.right = 'rays';
	if (state.right === 'rays' && eye.moved) state.right = state.method.samples.length > 0 ? 'random' : filtersOf(state.method).length > 1 ? 'raw' : 'open';
}

function slider(bar, text, { least, most, value, unit, nothing }, take) {
	const label = make(bar, 'label', {}, text), step = text === 'radius' ? least / 2 : least > 0 ? Math.min(least, 0.05) : 0.05;
	const input = make(label, 'input', { type: 'range', min: nothing ? 0 : least, max: most, step, value });
	const output = make(label, 'output'), show = () => { output.textContent = nothing && +input.value === 0 ? nothing : `${shortNumber(+input.value)} ${unit}`.trim(); };
	show();
	input.addEventListener('input', () => { show(); take(+input.value); update(); });
	return input;
}

export function chooseMethod(method) {
	const bar = byId('setting-bar');
	state.method = method;
	state.numbers = { radius: method.radius_m };
	settle();
	bar.replaceChildren();
	make(bar, 'span', { class: 'name' }, 'Settings');
	slider(bar, 'radius', { least: +(0.1 * method.radius_m).toPrecision(6), most: +(2 * method.radius_m).toPrecision(6), value: method.radius_m, unit: 'm' }, value => { state.numbers.radius = value; });
	for (const one of method.sliders) {
		slider(bar, one.option.slice(2).replace(/-/g, ' '), one, value => { state.numbers[one.member] = value; });
	}
}

// ---- The pictures

const tellStage = (text, bad = false) => { byId('stage-caption').textContent = text; byId('stage-caption').classList.toggle('bad', bad); };

function sceneNow() {
	if (!eye.moved) return stage.cast;
	if (!stage.triangles) stage.triangles = triangleScene(stage.gl, view);
	stage.triangles.draw(eyeMatrix(view));
	return stage.triangles;
}

async function shaderOf(side, samples, filter) {
	const chosen = await moduleFor(state.method, samples, filter), old = stage[side];
	if (old && old.chosen === chosen) return old;
	const shader = { chosen, samples, filter, ...makeShader(stage.gl, state.method, chosen, chosen.samples) };
	if (old) old.free();
	stage[side] = shader;
	return shader;
}

// Samples and filter of the picture on the right where it is one of the method's own.
const rightWords = () => state.right === 'random' ? ['random', state.filter] : state.right === 'raw' ? [state.samples, 'none'] : null;

// Resolved once it is drawn, or an error is told.
export async function update() {
	const serial = ++stage.serial;
	if (!stage.gl) return;
	drawChoices();
	try {
		const left = await shaderOf('left', state.samples, state.filter), words = rightWords();
		const right = words && await shaderOf('right', ...words);
		if (serial === stage.serial) draw(left, right);
	} catch (error) {
		if (serial !== stage.serial) return;
		if (error.message === 'cancelled') { wished.samples = 'tile'; settle(); await update(); return; }
		tellStage(error.message, true);
	}
}

function draw(left, right) {
	const gl = stage.gl, scene = sceneNow();
	let picture;
	stage.gpu = null;
	const told = timed(gl, () => { picture = left.draw(scene, state.numbers); }, ms => { stage.gpu = ms; drawFigures(); });
	const other = right ? right.draw(scene, state.numbers) : state.right === 'rays' ? stage.rays : stage.open;
	Object.assign(stage, { scene, picture, other, told, rightShader: right });
	drawStage();
	stage.errors = eye.moved ? null : [picture, other].map(errorToRays);
	drawFigures();
	publish({ stageDrawn: (+document.documentElement.dataset.stageDrawn || 0) + 1, firstPicture: document.documentElement.dataset.firstPicture || Math.round(performance.now()) });
}

function drawStage() {
	const up = eyeAxes(view).map(axis => axis[1]); // of the world, in the camera's axes
	drawSplit(stage.gl, stage.scene, stage.picture, stage.other, { share: byId('share').value / 1000, lit: state.lit, up });
}

// Root of the mean squared difference over pixels with a surface.
function errorToRays(picture) {
	if (picture === stage.rays || picture === stage.open) return picture === stage.rays ? 0 : errorOf(() => 1);
	const values = readScalars(stage.gl, picture);
	return errorOf(i => values[i]);
}

function errorOf(valueAt) {
	let sum = 0, count = 0;
	for (let i = 0; i < stage.seen.length; ++i) {
		if (stage.cast.values[i] >= SKY) continue;
		sum += (valueAt(i) - stage.seen[i] / 255) ** 2;
		count += 1;
	}
	return Math.sqrt(sum / Math.max(1, count));
}

// ---- Figures

const otherRadius = () => state.numbers.radius !== state.method.radius_m;
const errorText = error => shortNumber(error) + (otherRadius() && error !== null ? ', rays of another radius' : '');

function drawFigures() {
	const words = rightWords(), method = state.method;
	const nameOf = (samples, filter) => [method.name, method.samples.length ? SAMPLES[samples] : '', filter === 'none' ? 'no filter' : `filter ${filter}`].filter(Boolean).join(', ');
	const names = [nameOf(state.samples, state.filter), words ? nameOf(...words) : state.right === 'rays' ? `rays, ${data.rays} per pixel` : 'nothing occludes'];
	byId('left-name').textContent = names[0];
	byId('right-name').textContent = names[1];
	const errors = stage.errors || [null, null], gpu = stage.told ? stage.gpu === null ? '…' : `${stage.gpu.toFixed(2)} ms` : 'not told';
	byId('stage-figures').replaceChildren();
	table(byId('stage-figures'), ['picture', 'RMSE to the rays', 'GPU time'], [['left', errorText(errors[0]), gpu], ['right', words ? errorText(errors[1]) : shortNumber(errors[1]), '–']]);
	byId('radius-note').hidden = !otherRadius() || eye.moved;
	byId('radius-note').textContent = `The rays were traced for a radius of ${shortNumber(method.radius_m)} m, the picture has ${shortNumber(state.numbers.radius)} m: its RMSE is not the method’s error. `
		+ 'The commands below trace rays of its radius.';
	tellStage(`${view.level}, ${eye.moved ? 'another view, drawn from its triangles' : `camera ${view.camera}`}, ${view.width} × ${view.height}. `
		+ (eye.moved ? 'Rays were traced for the first view alone. ' : `The rays’ own standard error is ${shortNumber(view.reference_error)}. `)
		+ (stage.told ? '' : 'This browser does not tell GPU times (EXT_disjoint_timer_query_webgl2). ')
		+ '');
	byId('back').hidden = !eye.moved;
	byId('commands').textContent = commandLines();
}

// Quotes a text as one word of a shell.
const shellWord = text => /^[\w.:/-]+$/.test(text) ? text : `'${text.replace(/'/g, "'\\''")}'`;

// A setting's option of nook shade, where it is not the default.
function settingWords() {
	const words = [`--radius ${state.numbers.radius}`];
	for (const one of state.method.sliders) if ((state.numbers[one.member] || one.value) !== one.value) words.push(`${one.option} ${state.numbers[one.member]}`);
	return words.join(' ');
}

function commandLines() {
	const method = state.method, sampled = method.samples.find(one => one.name === state.samples), lines = [];
	const one = method.samples.find(other => other.name === 'one');
	if (state.samples === 'made') lines.push(`${made.data.command} -o pattern.json`, 'nook tile --pattern pattern.json --size 4 -o tile.json');
	else if (sampled) lines.push(`${one.command} -o ${one.file}`, ...(sampled === one ? [] : [`${sampled.command} -o ${sampled.file}`]));
	const file = state.samples === 'made' ? 'tile.json' : sampled && sampled.file;
	lines.push(`nook gbuffer ${shellWord(view.level)}${data.load_options} --camera ${shellWord(data.camera_option)} --size ${view.width}x${view.height} -o g.exr`,
		`nook shade g.exr --method ${method.name}${file ? ` --pattern ${file}` : ''} ${settingWords()} --filter ${state.filter} -o v.exr`,
		`nook reference ${shellWord(view.level)}${data.load_options} --gbuffer g.exr --falloff linear --radius ${otherRadius() ? state.numbers.radius : view.radius_m} --rays ${data.rays} -o rays.exr`);
	if (stage.left) lines.push(`${stage.left.chosen.command.replace(/--patterns \S+/, `--patterns ${file}`)} -o nook_ao.glsl -o nook_ao.h`);
	return `${eye.moved ? '# The traced view; there are no options for the one that is shown.\n' : ''}${lines.join('\n')}`;
}

// ---- The stage's own controls

function stepView(change) {
	change();
	settle();
	update();
}

export function startStage() {
	const canvas = byId('stage');
	Object.assign(canvas, { width: view.width, height: view.height });
	canvas.setAttribute('aria-label', `${view.level}: left of the slider the method, right of it what it is compared with`);
	const gl = stage.gl = openGl(canvas);
	if (!gl) {
		byId('no-gl').textContent = SENTENCE_GL;
		byId('no-gl').hidden = false;
		byId('shading').hidden = true;
		return;
	}
	stage.cast = castScene(gl, view);
	stage.seen = bytesOf(view.reference);
	stage.rays = pictureOf(gl, { format: 'bytes', width: view.width, height: view.height }, new Uint8Array(stage.seen.buffer));
	stage.open = pictureOf(gl, { format: 'bytes', width: view.width, height: view.height }, new Uint8Array(stage.seen.length).fill(255));
	byId('share').addEventListener('input', () => { if (stage.picture) drawStage(); });
	button(byId('stage-bar'), 'Back to the traced view', false, () => { resetEye(); wished.right = 'rays'; settle(); update(); }, { id: 'back' }).removeAttribute('aria-pressed');
	downloadButton(byId('stage-bar'), 'Download this module', 'nook_ao.glsl', () => stage.left.chosen.module);
	byId('back').hidden = true;
	byId('stage-cancel').addEventListener('click', () => cancelProgram());
	lookAround(canvas, byId('stage-pad'), { step: view.radius_m / 4, turn: (yaw, pitch) => stepView(() => turnEye(view, yaw, pitch)),
		move: (right, up, back) => stepView(() => moveEye(view, right, up, back)) });
	made.listeners.push(() => { settle(); if (state.samples === 'made') update(); else drawChoices(); });
	chooseMethod(state.method);
	return update();
}
