// SPDX-License-Identifier: GPL-3.0-or-later
// A level, the npm package and the catalogue → one page that makes patterns and shades the level in a browser. Usage:
// node site/build.mjs [LEVEL] [OPTIONS] -o PAGE.html [-- OPTIONS OF THE LEVEL], with the options of docs/reference/live.md. Its data come
// from nook's verbs. The same bytes come from the same inputs; exit codes are those of nook.
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { readExr, readGlb } from './files.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const source = resolve(here, '..');

class Failure extends Error {
	constructor(code, text) {
		super(text);
		this.code = code;
	}
}

// ---- Options

const OPTIONS = {
	output: { type: 'string', short: 'o' }, nook: { type: 'string', default: join(source, 'build/release/tools/nook') },
	npm: { type: 'string', default: join(source, 'build/wasm/npm') }, catalogue: { type: 'string', default: join(source, 'patterns') },
	camera: { type: 'string', default: '' }, size: { type: 'string', default: '640x360' }, radius: { type: 'string' },
	rays: { type: 'string', default: '256' },
};

function settingsOf(words) {
	const end = words.indexOf('--'), load = end < 0 ? [] : words.slice(end + 1);
	let parsed;
	try {
		parsed = parseArgs({ args: end < 0 ? words : words.slice(0, end), options: OPTIONS, allowPositionals: true });
	} catch (error) {
		throw new Failure(1, error.message);
	}
	const { values, positionals } = parsed;
	if (positionals.length > 1) throw new Failure(1, `LEVEL: found ${positionals.length} of them, expected one`);
	if (!/\.html$/.test(values.output || '')) throw new Failure(1, `-o: found '${values.output || ''}', expected a page, NAME.html`);
	if (!/^\d+x\d+$/.test(values.size)) throw new Failure(1, `--size: found '${values.size}', expected WIDTHxHEIGHT`);
	if (/^auto:(?!1$)/.test(values.camera)) throw new Failure(1, `--camera: found '${values.camera}', expected a name, or auto:1: the page has one view`);
	return { ...values, level: positionals[0] || 'builtin:suburb', load };
}

const shellWord = text => /^[\w.:/-]+$/.test(text) ? text : `'${text.replace(/'/g, "'\\''")}'`;
const wordsOf = list => list.map(word => ` ${shellWord(word)}`).join('');

// The command that makes the page again: the level by its file's name, without folders.
function commandOf(settings) {
	const level = settings.level.startsWith('builtin:') ? settings.level : basename(settings.level);
	const given = ['camera', 'size', 'radius', 'rays'].filter(name => settings[name] !== (OPTIONS[name].default));
	return `node site/build.mjs${level === 'builtin:suburb' ? '' : ` ${shellWord(level)}`}`
		+ given.map(name => ` --${name} ${shellWord(settings[name])}`).join('') + ' -o live.html' + (settings.load.length ? ` --${wordsOf(settings.load)}` : '');
}

// ---- nook

let folder;
let nook;

function run(...words) {
	const ended = spawnSync(nook, words, { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 28 });
	if (ended.error) throw new Failure(2, `${nook}: found ${ended.error.code}, expected the program nook`);
	if (ended.status !== 0) throw new Failure(ended.status || 4, ended.stderr.trim().split('\n').pop().replace(/^nook: /, ''));
	return ended.stdout;
}

const made = name => readFileSync(join(folder, name), 'utf8');
const base64 = numbers => Buffer.from(numbers.buffer, numbers.byteOffset, numbers.byteLength).toString('base64');

// Six digits, as nook info prints them.
function rounded(value) {
	const short = Number(value.toPrecision(6)), size = Math.abs(short);
	return short !== 0 && (size < 1e-4 || size >= 1e6) ? short.toExponential().replace(/e(.)(\d)$/, 'e$10$2') : String(short);
}

// ---- The program, as a worker of the page

function needFile(folderName, name, option, expected) {
	if (!existsSync(join(folderName, name))) throw new Failure(2, `${option}: found no ${name} in ${folderName}, expected ${expected}`);
	return join(folderName, name);
}

function replaceOnce(path, found, by) {
	const text = readFileSync(path, 'utf8');
	if (!text.includes(found)) throw new Failure(3, `${path}: found no '${found}', expected the npm package of this version`);
	return text.replace(found, () => by);
}

function programOf(settings, version) {
	const file = name => needFile(settings.npm, name, '--npm', "the npm package of 'cmake --preset wasm && cmake --build --preset wasm'");
	const wasm = readFileSync(file('nook.wasm')), own = JSON.parse(readFileSync(file('package.json'), 'utf8')).version;
	if (own !== version) throw new Failure(3, `${file('package.json')}: version: found ${own}, expected ${version}, that of the program nook`);
	if (wasm.toString('latin1', 0, 4) !== '\0asm') throw new Failure(3, `${file('nook.wasm')}: found ${wasm.length} bytes, expected WebAssembly`);
	const module = replaceOnce(file('nook_module.js'), 'export default Module;', ''); // one script of both: a blob imports no file
	const calls = replaceOnce(file('calls.js'), "import makeModule from './nook_module.js';", 'const makeModule = Module;').replaceAll('export ', '');
	return { worker: module + calls + readFileSync(join(here, 'worker.js'), 'utf8'), wasm: wasm.toString('base64') };
}

// ---- The catalogue: measures as nook info prints them

const DOMAINS = ['disk', 'ball', 'sphere', 'hemisphere'];

function catalogueOf(settings) {
	needFile(settings.catalogue, 'disk/disk_009.json', '--catalogue', "nook's catalogue, patterns/ of its sources");
	const all = {};
	for (const domain of DOMAINS) {
		for (const variant of ['', '_centred', '_symmetric']) {
			for (let count = 1; count <= 64; ++count) {
				const path = join(settings.catalogue, domain, `${domain}_${String(count).padStart(3, '0')}${variant}.json`);
				if (!existsSync(path)) continue;
				const { quality } = JSON.parse(readFileSync(path, 'utf8'));
				const text = ([name, value]) => [name, value === null ? 'infinite' : rounded(value)];
				(all[domain + variant] ??= {})[count] = Object.fromEntries(Object.entries(quality || {}).map(text));
			}
		}
	}
	return all;
}

// ---- The level and one view of it

function viewOf(settings) {
	const info = JSON.parse(run('info', settings.level, ...settings.load, '--json', '-'));
	const radius = settings.radius === undefined ? 0.5 * info.suggested_distance_m : Number(settings.radius);
	const chosen = info.cameras.length === 0 ? 'auto:1' : settings.camera;
	run('gbuffer', settings.level, ...settings.load, ...(chosen ? ['--camera', chosen] : []), '--size', settings.size, '-o', 'g.exr');
	run('reference', settings.level, ...settings.load, '--gbuffer', 'g.exr', '--falloff', 'linear', '--radius', String(radius), '--rays', settings.rays,
		'-o', 'rays.exr', '--json', 'rays.json');
	run('level', settings.level, ...settings.load, '-o', 'level.glb');
	const gbuffer = readExr(join(folder, 'g.exr')), rays = readExr(join(folder, 'rays.exr'));
	const matrix = gbuffer.attributes.worldToCamera64, axis = k => [0, 1, 2].map(i => matrix[4 * i + k]);
	const eye = [0, 1, 2].map(k => -[0, 1, 2].reduce((sum, i) => sum + matrix[4 * k + i] * matrix[12 + i], 0));
	const { triangles, masks } = readGlb(join(folder, 'level.glb'), eye);
	const camera = gbuffer.attributes['nook:camera'];
	return { camera_option: /^auto/.test(chosen) ? 'auto:1' : camera, view: {
		level: settings.level.startsWith('builtin:') ? settings.level : basename(settings.level), camera, triangle_count: info.triangles,
		width: gbuffer.width, height: gbuffer.height, radius_m: radius, reference_error: JSON.parse(made('rays.json')).rms_standard_error,
		projection: gbuffer.attributes.projection64, world_from_camera: [0, 1, 2].flatMap(k => [...axis(k), 0]).concat(eye, 1),
		depth: base64(gbuffer.channels.Z.map(z => Number.isFinite(z) ? z : 1e30)), normals: normalsOf(gbuffer.channels),
		reference: base64(Uint8Array.from(rays.channels.visibility, v => Math.max(0, Math.min(255, 255 * v + 0.5)))), triangles, masks } };
}

// Few surfaces have normals of their own: a list of them, and each pixel's place in it.
function normalsOf(channels) {
	const known = new Map(), list = [], indices = new Uint32Array(channels.Z.length);
	for (let i = 0; i < indices.length; ++i) {
		const normal = ['N.X', 'N.Y', 'N.Z'].map(name => channels[name][i]), key = normal.join();
		if (!known.has(key)) {
			known.set(key, known.size);
			list.push(...normal);
		}
		indices[i] = known.get(key);
	}
	const bytes = known.size > 65536 ? 4 : 2;
	return { list: base64(Float32Array.from(list)), indices: base64(bytes === 4 ? indices : Uint16Array.from(indices)), bytes };
}

// ---- Methods: samples, modules in OpenGL ES 3.0 with the passes to draw, and settings

const COUNTS = { disk: 3, ball: 3, hemisphere: 9 }; // lines, points and areas draw each sample at three radii
const LENGTHS = ['radius', 'second_radius', 'third_radius', 'thickness', 'second_thickness', 'third_thickness'];
const EMITTED = { statvo: ['--layers', '4'], slices: ['--slices', '1', '--slice-steps', '4'] };
const SLIDERS = [ // options of nook shade, and members of the block
	{ option: '--thickness', least: 0.05, most: 2, unit: 'm', of: /^vo-/ }, { option: '--sigma', least: 0, most: 3, unit: '', of: /^alchemy$/ },
	{ option: '--contrast', least: 0.25, most: 4, unit: '', of: /^alchemy$/ }, { option: '--slice-thickness', least: 0.1, most: 2, unit: 'radii', of: /^slices$/ },
	{ option: '--strength', least: 0.25, most: 4, unit: '', of: /./ }, { option: '--power', least: 0.25, most: 4, unit: '', of: /./ },
	{ option: '--slope', least: 0.1, most: 4, unit: 'per height', of: /^statvo$/ },
];

// Emitted methods that shade from depth: the rows of nook info --methods with a kernel.
function methodRows() {
	const rows = run('info', '--methods').split('\n').filter(line => line.startsWith('| `')).map(line => line.split('|').map(cell => cell.trim()));
	return rows.filter(row => row[3] && row[6] === 'yes').map(([, name, what, entry, samples, , , , page]) =>
		({ name: name.slice(1, -1), what, page, entry, domain: samples in COUNTS ? samples : '' }));
}

function samplesOf({ domain }, count) {
	const files = ['', '_random', '_tile'].map(ending => `${domain}_${count}${ending}.json`);
	const commands = [['pattern', '--domain', domain, '--count', String(count)], ['tile', '--pattern', files[0], '--size', '4', '--kind', 'random'],
		['tile', '--pattern', files[0], '--size', '4']];
	return ['one', 'random', 'tile'].map((name, i) => {
		if (!existsSync(join(folder, files[i]))) run(...commands[i], '-o', files[i]);
		return { name, file: files[i], command: `nook ${commands[i].join(' ')}`, text: made(files[i]) };
	});
}

function passesOf(method, file, filter) {
	run('shade', 'g.exr', '--method', method.name, ...(file ? ['--pattern', file] : []), '--radius', String(method.radius_m), '--filter', filter, '-o', 'passes.json');
	return JSON.parse(made('passes.json'));
}

function moduleOf(method, file, filter, one) {
	const words = ['emit', '--methods', method.name, ...(file ? ['--patterns', file] : []), ...(EMITTED[method.name] || []),
		...(filter === 'none' ? [] : ['--filter', filter]), ...(filter === 'bilateral' ? ['--taps', '5'] : []), '--glsl', 'es300'];
	run(...words, '-o', 'module.glsl');
	const { pictures, passes } = passesOf(method, file, filter);
	return { one, filter, command: `nook ${words.join(' ')}`, module: made('module.glsl'), plan: { pictures, passes } };
}

function methodOf(row, radius) {
	const method = { ...row, count: COUNTS[row.domain] || 9, radius_m: Number(rounded(radius)) };
	const samples = row.domain ? samplesOf(row, method.count) : [], none = row.name === 'statvo' ? ['none'] : ['window', 'none', 'bilateral'];
	const first = passesOf(method, samples[0] && samples[0].file, 'none'), block = new DataView(Uint8Array.from(Buffer.from(first.block, 'base64')).buffer);
	const valueOf = member => Number(block.getFloat32(first.members[member], true).toPrecision(7));
	const lengths = LENGTHS.map(member => [member, Number((valueOf(member) / method.radius_m).toPrecision(6))]).filter(([, share]) => share > 0);
	const sliders = SLIDERS.filter(({ of }) => of.test(row.name)).map(({ of, ...slider }) => {
		const member = slider.option.slice(2).replace(/-/g, '_');
		return { ...slider, member, value: valueOf(member), nothing: '' };
	});
	for (const one of samples) Object.assign(one, passesOf(method, one.file, 'none').tile);
	const last = samples.length ? samples[2].file : '', modules = none.map(filter => moduleOf(method, last, filter, false)); // any tile's text is that of this one
	if (samples.length) modules.push(...['none', 'bilateral'].map(filter => moduleOf(method, samples[0].file, filter, true)));
	return { members: first.members, method: { ...method, lengths: Object.fromEntries(lengths), sliders, block: first.block, samples, modules } };
}

function shadingOf(radius) {
	const all = methodRows().map(row => methodOf(row, radius));
	return { members: all[0].members, methods: all.map(({ method }) => method) };
}

// ---- The page

// Each slot of the template by its text, in one pass: a text may hold what looks like a slot.
const filled = (page, slots) => page.replace(new RegExp(Object.keys(slots).join('|'), 'g'), slot => slots[slot]);

function pageOf(data) {
	const page = name => readFileSync(join(source, 'libsamples/page', name), 'utf8'), own = name => readFileSync(join(here, name), 'utf8');
	const scripts = ['cells.js', 'gl.js', 'scene.js', 'shade.js', 'pattern.js', 'page.js'].map(own).join('');
	return filled(page('frame.html'), { '@VERSION@': data.version, '@TITLE@': 'patterns and obscurance, live', '@STYLE@': page('page.css') + own('live.css'),
		'@BODY@': own('live.html'), '@DATA@': JSON.stringify(data).replaceAll('<', '\\u003c'), '@SCRIPT@': page('parts.js') + page('pictures.js') + scripts });
}

function build(settings) {
	nook = settings.nook.includes('/') ? resolve(settings.nook) : settings.nook;
	if (!settings.level.startsWith('builtin:')) settings.level = resolve(settings.level);
	const version = run('--version').split('\n')[0].replace(/^nook /, '');
	const program = programOf(settings, version), catalogue = catalogueOf(settings); // what may be missing comes before long work
	const { view, camera_option } = viewOf(settings);
	const reading = JSON.parse(readFileSync(join(here, 'reading.json'), 'utf8'));
	const page = pageOf({ command: commandOf(settings), version, domains: [...DOMAINS, 'slice'],
		methods: ['refine', 'electro', 'equal', 'random', 'poisson', 'halton', 'vogel', 'lloyd'], most: 4096, rays: Number(settings.rays),
		load_options: wordsOf(settings.load), camera_option, catalogue, shading: shadingOf(view.radius_m), view, reading, program });
	const part = `${settings.output}.${process.pid}.part`;
	try {
		writeFileSync(part, page);
		renameSync(part, settings.output);
	} catch (error) {
		rmSync(part, { force: true });
		throw new Failure(2, `${settings.output}: cannot be written: ${error.code}`);
	}
}

try {
	folder = mkdtempSync(join(tmpdir(), 'nook_site.'));
	build(settingsOf(process.argv.slice(2)));
} catch (error) {
	if (!(error instanceof Failure)) throw error;
	console.error(`site/build.mjs: ${error.message}`);
	process.exitCode = error.code;
} finally {
	rmSync(folder, { recursive: true, force: true });
}
