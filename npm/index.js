// SPDX-License-Identifier: GPL-3.0-or-later
// The program nook as functions: options in, patterns, tiles, errors and modules out. Each call is a run of the program with a file
// system of its own in memory, so that the bytes and the error lines are those of the command line.
import makeModule from './nook_module.js';

// `code` is the program's exit code: 1 usage, 2 file, 3 invalid input, 4 run time, 5 not supported, 7 difference.
export class NookError extends Error {
	constructor(message, code) {
		super(message);
		this.name = 'NookError';
		this.code = code;
	}
}

let compiled;

async function wasmBytes() {
	const url = new URL('./nook.wasm', import.meta.url);
	if (url.protocol === 'file:') {
		const { readFile } = await import(/* webpackIgnore: true */ 'node:fs/promises');
		return readFile(url);
	}
	const answer = await fetch(url);
	if (!answer.ok) {
		throw new NookError(`${url}: cannot be read: found status ${answer.status}, expected 200`, 2);
	}
	return answer.arrayBuffer();
}

// Compiles the program ahead of the first call. `source`: bytes or a WebAssembly.Module, where nook.wasm does not lie beside this file.
export function load(source) {
	if (typeof WebAssembly !== 'object') {
		throw new NookError('WebAssembly: found none, expected a browser or Node.js that has it', 5);
	}
	if (source !== undefined || compiled === undefined) {
		const made = source instanceof WebAssembly.Module
			? Promise.resolve(source)
			: Promise.resolve(source ?? wasmBytes()).then(bytes => WebAssembly.compile(bytes));
		made.catch(() => { compiled = compiled === made ? undefined : compiled; }); // the next call tries again
		compiled = made;
	}
	return compiled;
}

async function instance(printed, watch) {
	const wasm = await load();
	return makeModule({
		...watch,
		noInitialRun: true,
		print: line => printed.out.push(line),
		printErr: line => printed.err.push(line),
		instantiateWasm(imports, receive) {
			WebAssembly.instantiate(wasm, imports).then(made => receive(made));
			return {};
		},
	});
}

// One run: `files` are there before it, those of `take` are handed back. Nothing is thrown for an exit code. `onProgress` is called with
// the name of what is done and a share from 0 to 1, `onPoints` with the number of a start and x, y, z of its points while they move.
export async function nook(command, { files = {}, take = [], onProgress, onPoints } = {}) {
	const printed = { out: [], err: [] };
	const { FS, callMain } = await instance(printed, { onProgress, onPoints });
	for (const [name, content] of Object.entries(files)) {
		FS.writeFile(name, content);
	}
	const code = callMain(command.map(String)) ?? 0;
	const made = {};
	for (const name of take) {
		if (FS.analyzePath(name).exists) {
			made[name] = FS.readFile(name, { encoding: 'utf8' });
		}
	}
	const text = lines => lines.map(line => `${line}\n`).join('');
	return { code, stdout: text(printed.out), stderr: text(printed.err), files: made };
}

async function succeed(command, io) {
	const answer = await nook(command, io);
	if (answer.code !== 0) {
		throw new NookError(answer.stderr.trim().replace(/^nook: /, ''), answer.code);
	}
	return answer;
}

// { halfLength: 2, symmetric: true, counts: [5, 9] } → --half-length 2 --symmetric --counts 5,9
function words(options) {
	const command = [];
	for (const [name, value] of Object.entries(options)) {
		const option = `--${name.replace(/[A-Z]/g, letter => `-${letter.toLowerCase()}`)}`;
		if (value === true) {
			command.push(option);
		} else if (value !== undefined && value !== null && value !== false) {
			command.push(option, Array.isArray(value) ? value.join(',') : String(value));
		}
	}
	return command;
}

function stemOf(name) {
	return name.replace(/\.[^.]*$/, '');
}

async function make(verb, command, files, formats, name) {
	const endings = [...new Set(['json', ...formats])];
	const names = endings.map(ending => `${stemOf(name)}.${ending}`);
	const answer = await succeed([verb, ...command, ...names.flatMap(file => ['-o', file])], { files, take: names });
	const made = Object.fromEntries(endings.map((ending, i) => [ending, answer.files[names[i]]]));
	return { name: names[0], data: JSON.parse(made.json), files: made };
}

// A sample set that is given: what pattern() or tile() returned, or the text of a file.
function fileOf(given, name) {
	return typeof given === 'string' ? [name, given] : [given.name, given.files.json];
}

export async function pattern({ formats = [], file = 'pattern.json', ...options }) {
	return make('pattern', words(options), {}, formats, file);
}

export async function tile({ pattern: base, formats = [], file = 'tile.json', ...options }) {
	const [name, text] = fileOf(base, 'pattern.json');
	return make('tile', ['--pattern', name, ...words(options)], { [name]: text }, formats, file === name ? `tile_${file}` : file);
}

// Points as a table; numbers are written so that they read back as the same.
function csvOf(points) {
	const columns = Array.isArray(points[0]) ? ['x', 'y', 'z'].slice(0, points[0].length) : Object.keys(points[0] ?? {});
	const title = column => column.replace(/[A-Z]/g, letter => `_${letter.toLowerCase()}`);
	const rows = points.map(point => (Array.isArray(point) ? point : columns.map(column => point[column])).join(','));
	return `${[columns.map(title).join(','), ...rows].join('\n')}\n`;
}

export async function measure(points, options = {}) {
	const [name, text] = Array.isArray(points) ? ['points.csv', csvOf(points)] : fileOf(points, 'pattern.json');
	const answer = await succeed(['info', name, ...words(options), '--json', 'measured.out'],
		{ files: { [name]: text }, take: ['measured.out'] });
	return JSON.parse(answer.files['measured.out']);
}

export async function emit({ patterns = [], file = 'nook.glsl', ...options }) {
	const given = patterns.map((one, i) => fileOf(one, `pattern_${i}.json`));
	const seen = new Map();
	for (const pair of given) { // two of one name are two files all the same
		const count = seen.get(pair[0]) ?? 0;
		seen.set(pair[0], count + 1);
		pair[0] = count === 0 ? pair[0] : `${stemOf(pair[0])}_${count + 1}.json`;
	}
	const header = `${stemOf(file)}.h`;
	const alone = /^aov/.test(String(options.methods)); // its stages have no header
	const outputs = alone ? [file] : [file, header];
	const command = ['emit', ...words({ ...options, patterns: given.length > 0 ? given.map(pair => pair[0]) : undefined })];
	const answer = await succeed([...command, ...outputs.flatMap(output => ['-o', output])],
		{ files: Object.fromEntries(given), take: outputs });
	return { glsl: answer.files[file], header: answer.files[header] };
}
