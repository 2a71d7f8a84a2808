// SPDX-License-Identifier: GPL-3.0-or-later
// A level, the npm packages and the catalogue → a static site that makes patterns and shades the level in a browser, built with Vite.
// Usage: node site/build.mjs [LEVEL] [OPTIONS] -o FOLDER|PAGE.html [-- OPTIONS OF THE LEVEL], with the options of
// docs/reference/live.md; scripts/site.sh installs what it needs. Its data come from nook's verbs. The same bytes come from the same
// inputs; exit codes are those of nook.
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { readExr, readGlb, writePng } from './files.mjs';
import { bundle } from './vite.mjs';

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
	rays: { type: 'string', default: '256' }, modules: { type: 'string', default: join(source, 'build/site_modules/node_modules') },
	docs: { type: 'string', default: '' },
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
	if (!values.output) throw new Failure(1, "-o: missing, expected a folder or a page, NAME.html");
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
		+ given.map(name => ` --${name} ${shellWord(settings[name])}`).join('') + ' -o site' + (settings.load.length ? ` --${wordsOf(settings.load)}` : '');
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

// ---- What the site is made of

function needFile(folderName, name, option, expected) {
	if (!existsSync(join(folderName, name))) throw new Failure(2, `${option}: found no ${name} in ${folderName}, expected ${expected}`);
	return join(folderName, name);
}

function checkPackage(settings, version) {
	const file = name => needFile(settings.npm, name, '--npm', "the npm package of 'cmake --preset wasm && cmake --build --preset wasm'");
	const wasm = readFileSync(file('nook.wasm')), own = JSON.parse(readFileSync(file('package.json'), 'utf8')).version;
	if (own !== version) throw new Failure(3, `${file('package.json')}: version: found ${own}, expected ${version}, that of the program nook`);
	if (wasm.toString('latin1', 0, 4) !== '\0asm') throw new Failure(3, `${file('nook.wasm')}: found ${wasm.length} bytes, expected WebAssembly`);
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
	const world_from_camera = [0, 1, 2].flatMap(k => [...axis(k), 0]).concat(eye, 1);
	const camera = gbuffer.attributes['nook:camera'];
	return { chosen, camera_option: /^auto/.test(chosen) ? 'auto:1' : camera, view: {
		level: settings.level.startsWith('builtin:') ? settings.level : basename(settings.level), camera, triangle_count: info.triangles,
		width: gbuffer.width, height: gbuffer.height, radius_m: radius, reference_error: JSON.parse(made('rays.json')).rms_standard_error,
		projection: gbuffer.attributes.projection64, world_from_camera,
		depth: base64(gbuffer.channels.Z.map(z => Number.isFinite(z) ? z : 1e30)), normals: normalsOf(gbuffer.channels),
		reference: base64(Uint8Array.from(rays.channels.visibility, v => Math.max(0, Math.min(255, 255 * v + 0.5)))), triangles, masks } };
}

// ---- The level in three.js, with rays of a larger picture

const DECODED = /^(KHR_materials_\w+|KHR_texture_transform|KHR_mesh_quantization|EXT_meshopt_compression|KHR_meshopt_compression|EXT_texture_webp|KHR_lights_punctual)$/;

// The JSON of a binary glTF that is whole in its file; null for other levels.
function wholeGlb(path) {
	if (!/\.glb$/i.test(path)) return null;
	const bytes = readFileSync(path);
	if (bytes.length < 20 || bytes.toString('latin1', 0, 4) !== 'glTF') return null;
	const json = JSON.parse(bytes.toString('utf8', 20, 20 + bytes.readUInt32LE(12)));
	const outside = [...(json.buffers ?? []), ...(json.images ?? [])].some(({ uri }) => uri !== undefined && !uri.startsWith('data:'));
	return outside || !(json.extensionsRequired ?? []).every(name => DECODED.test(name)) ? null : bytes;
}

// The level's own file where the page can read it and the options change nothing in it, or what nook level made of it.
function levelOf(settings, view, camera) {
	const own = settings.level.startsWith('builtin:') || settings.load.length > 0 ? null : wholeGlb(settings.level);
	const [width, height] = settings.size.split('x').map(side => 2 * Number(side));
	run('gbuffer', settings.level, ...settings.load, ...(camera ? ['--camera', camera] : []), '--size', `${width}x${height}`, '-o', 'large.exr');
	run('reference', settings.level, ...settings.load, '--gbuffer', 'large.exr', '--falloff', 'linear', '--radius', String(view.radius_m), '--rays', settings.rays, '-o', 'large_rays.exr');
	const { channels: { Z } } = readExr(join(folder, 'large.exr')), { channels: { visibility } } = readExr(join(folder, 'large_rays.exr'));
	const pixels = Buffer.alloc(3 * width * height); // grey; sky is blue
	visibility.forEach((value, i) => {
		if (Z[i] < 1e10) pixels.fill(Math.max(0, Math.min(255, Math.floor(255 * value + 0.5))), 3 * i, 3 * i + 3);
		else pixels[3 * i + 2] = 255;
	});
	const { level, camera: name, world_from_camera, projection, radius_m } = view;
	return { level, camera: name, width, height, radius_m, rays: Number(settings.rays), world_from_camera, projection, own: own !== null,
		glb: (own ?? readFileSync(join(folder, 'level.glb'))).toString('base64'), png: writePng(width, height, pixels).toString('base64') };
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

// ---- The site

// A folder that is another's is kept.
function checkOutput({ output, docs }) {
	if (!/\.html$/.test(output) && existsSync(output) && !existsSync(join(output, 'site.js')) && readdirSync(output).length > 0) {
		throw new Failure(2, `${output}: found other files in it, expected an empty folder or a site to replace`);
	}
	if (docs && /\.html$/.test(output)) throw new Failure(1, `--docs: found with the page ${output}, expected a folder`);
	if (docs) needFile(docs, 'index.html', '--docs', 'the pages of scripts/docs.sh');
}

function write(settings, files) {
	const { output, docs } = settings, part = `${output}.${process.pid}.part`, whole = /\.html$/.test(output);
	try {
		if (whole) writeFileSync(part, files['index.html']);
		else {
			mkdirSync(part, { recursive: true });
			for (const [name, text] of Object.entries(files)) writeFileSync(join(part, name), text);
			if (docs) cpSync(docs, join(part, 'docs'), { recursive: true });
			rmSync(output, { recursive: true, force: true });
		}
		renameSync(part, output);
	} catch (error) {
		rmSync(part, { recursive: true, force: true });
		throw new Failure(2, `${output}: cannot be written: ${error.code}`);
	}
}

function packAo() {
	const packed = spawnSync('sh', [join(source, 'npm/ao/pack.sh'), nook, join(folder, 'nook-ao')], { encoding: 'utf8' });
	if (packed.status !== 0) {
		const lines = packed.stderr.trim().split('\n');
		throw new Failure(4, `npm/ao/pack.sh: ${(lines.find(line => /^nook: |Error: /.test(line)) ?? lines.pop()).replace(/^nook: /, '')}`);
	}
	return join(folder, 'nook-ao');
}

async function build(settings) {
	nook = settings.nook.includes('/') ? resolve(settings.nook) : settings.nook;
	if (!settings.level.startsWith('builtin:')) settings.level = resolve(settings.level);
	const version = run('--version').split('\n')[0].replace(/^nook /, '');
	checkOutput(settings); // what may be missing comes before long work
	checkPackage(settings, version);
	for (const name of ['vite', 'three']) needFile(settings.modules, join(name, 'package.json'), '--modules', 'the packages of site/package.json (scripts/site.sh installs them)');
	const catalogue = catalogueOf(settings), { view, camera_option, chosen } = viewOf(settings);
	const reading = JSON.parse(readFileSync(join(here, 'reading.json'), 'utf8'));
	const data = { command: commandOf(settings), version, domains: [...DOMAINS, 'slice'],
		methods: ['refine', 'electro', 'equal', 'random', 'poisson', 'halton', 'vogel', 'lloyd'], most: 4096, rays: Number(settings.rays),
		load_options: wordsOf(settings.load), camera_option, catalogue, shading: shadingOf(view.radius_m), view, level: levelOf(settings, view, chosen), reading,
		docs: settings.docs ? 'docs/index.html' : '' };
	const files = await bundle({ root: here, source, modules: resolve(settings.modules), npm: resolve(settings.npm), ao: packAo(), data, whole: /\.html$/.test(settings.output) });
	write(settings, files);
}

try {
	folder = mkdtempSync(join(tmpdir(), 'nook_site.'));
	await build(settingsOf(process.argv.slice(2)));
} catch (error) {
	if (!(error instanceof Failure)) throw error;
	console.error(`site/build.mjs: ${error.message}`);
	process.exitCode = error.code;
} finally {
	rmSync(folder, { recursive: true, force: true });
}
