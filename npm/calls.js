// SPDX-License-Identifier: GPL-3.0-or-later
// The program nook as functions: options in, patterns, tiles, errors and modules out. Each call is a run of the program with a file
// system of its own in memory, so the bytes and the error lines are those of the command line. index.js (Node.js) and browser.js say
// where nook.wasm lies and how a worker starts.
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
let place;

// { wasm(): bytes of nook.wasm or its URL, startWorker(receive, fail): { post(message), end() } }
export function setPlace(found) {
	place = found;
}

const BINARY = ['exr', 'ktx2', 'png']; // endings; other files are text

function refuse(where, found, expected) {
	throw new NookError(`${where}: found ${found}, expected ${expected}`, 1);
}

function nameOf(value) {
	if (typeof value === 'string') {
		return `'${value}'`;
	}
	if (Array.isArray(value)) {
		return value.length === 0 ? 'an empty array' : 'an array';
	}
	return value === null || ['undefined', 'number', 'boolean', 'bigint'].includes(typeof value) ? String(value)
		: typeof value === 'object' ? 'an object' : `a ${typeof value}`;
}

const isRecord = value => typeof value === 'object' && value !== null && !Array.isArray(value);

function checkRecord(where, value, expected) {
	if (!isRecord(value)) {
		refuse(where, nameOf(value), expected);
	}
}

function checkText(where, value) {
	if (typeof value !== 'string' || value === '') {
		refuse(where, nameOf(value), 'a text that is not empty');
	}
}

async function bytesFrom(source) {
	const isUrl = typeof source === 'string' || source instanceof URL;
	const answer = isUrl ? await fetch(source) : source;
	if (typeof Response !== 'function' || !(answer instanceof Response)) {
		return answer;
	}
	const where = answer.url || String(source);
	if (!answer.ok) {
		throw new NookError(`${where}: cannot be read: found status ${answer.status}, expected 200`, 2);
	}
	const bytes = new Uint8Array(await answer.arrayBuffer());
	if (bytes[0] !== 0 || bytes[1] !== 0x61 || bytes[2] !== 0x73 || bytes[3] !== 0x6d) {
		throw new NookError(`${where}: found ${answer.headers.get('Content-Type') ?? 'other bytes'}, expected WebAssembly; serve nook.wasm there, or call load() first (README: Bundlers)`, 3);
	}
	return bytes;
}

async function compile(source) {
	const bytes = await bytesFrom(await source);
	if (bytes instanceof WebAssembly.Module) {
		return bytes;
	}
	if (!(bytes instanceof ArrayBuffer || ArrayBuffer.isView(bytes))) {
		refuse('load', nameOf(bytes), 'bytes of nook.wasm, their address, a Response or a WebAssembly.Module');
	}
	try {
		return await WebAssembly.compile(bytes);
	} catch (error) {
		throw new NookError(`load: found ${bytes.byteLength} bytes that do not compile, expected nook.wasm: ${error.message}`, 3);
	}
}

// Compiles the program ahead of the first call. `source`: bytes, an address, a Response or a WebAssembly.Module, where nook.wasm does not
// lie beside this file.
export function load(source) {
	if (typeof WebAssembly !== 'object') {
		return Promise.reject(new NookError('WebAssembly: found none, expected a browser or Node.js that has it', 5));
	}
	if (source !== undefined || compiled === undefined) {
		const made = compile(source ?? (source === undefined ? Promise.resolve().then(() => place.wasm()) : source));
		made.catch(() => { compiled = compiled === made ? undefined : compiled; }); // the next call tries again
		compiled = made;
	}
	return compiled;
}

function instance(wasm, printed, watch) {
	return new Promise((resolve, reject) => {
		makeModule({
			...watch,
			noInitialRun: true,
			print: line => printed.out.push(line),
			printErr: line => printed.err.push(line),
			instantiateWasm(imports, receive) {
				WebAssembly.instantiate(wasm, imports).then(made => receive(made)).catch(reject);
				return {};
			},
		}).then(resolve, reject);
	});
}

const endingOf = name => name.replace(/^.*\./, '');

// One run in this thread, which nothing interrupts.
async function runHere(wasm, command, { files = {}, take = [], onProgress, onPoints }) {
	const printed = { out: [], err: [] };
	let thrown; // by a function that is called meanwhile
	const kept = call => call && ((...values) => {
		try {
			call(...values);
		} catch (error) {
			thrown = { error };
			throw error;
		}
	});
	const { FS, callMain } = await instance(wasm, printed, { onProgress: kept(onProgress), onPoints: kept(onPoints) });
	for (const [name, content] of Object.entries(files)) {
		try {
			FS.writeFile(name, content);
		} catch {
			throw new NookError(`files: ${name}: cannot be written, expected a name without folders`, 2);
		}
	}
	let code;
	try {
		code = callMain(command) ?? 0;
	} catch (error) { // the runtime's own: no memory
		throw thrown ? thrown.error : new NookError(`nook: ended by '${error.message ?? error}'`, 4);
	}
	const made = {};
	for (const name of take) {
		if (FS.analyzePath(name).exists) {
			made[name] = FS.readFile(name, BINARY.includes(endingOf(name)) ? {} : { encoding: 'utf8' });
		}
	}
	const text = lines => lines.map(line => `${line}\n`).join('');
	return { code, stdout: text(printed.out), stderr: text(printed.err), files: made };
}

// In a worker: answers one message of runInWorker().
export async function serve({ wasm, command, io, watched }, say) {
	const told = {
		onProgress: watched.progress ? (stage, share) => say({ progress: [stage, share] }) : undefined,
		onPoints: watched.points ? (start, numbers) => say({ points: [start, numbers] }) : undefined,
	};
	try {
		say({ answer: await runHere(wasm, command, { ...io, ...told }) });
	} catch (error) {
		say({ failed: String(error?.message ?? error), code: error?.code });
	}
}

// A run in a worker of its own, which the signal ends at once.
function runInWorker(wasm, command, { files, take, onProgress, onPoints, signal }) {
	return new Promise((resolve, reject) => {
		let worker;
		const finish = (settle, value) => {
			signal.removeEventListener('abort', abort);
			worker?.end();
			settle(value);
		};
		const abort = () => finish(reject, signal.reason);
		const fail = error => finish(reject, new NookError(`worker: ended by '${error?.message ?? error}', expected nook_worker.js beside the package's module`, 4));
		const guarded = (call, values) => {
			try {
				call(...values);
			} catch (error) {
				finish(reject, error);
			}
		};
		const receive = said => {
			if (said.progress) {
				guarded(onProgress, said.progress);
			} else if (said.points) {
				guarded(onPoints, said.points);
			} else if (said.answer) {
				finish(resolve, said.answer);
			} else {
				finish(reject, new NookError(said.failed, said.code ?? 4));
			}
		};
		signal.addEventListener('abort', abort);
		try {
			worker = place.startWorker(receive, fail);
			worker.post({ wasm, command, io: { files, take }, watched: { progress: onProgress !== undefined, points: onPoints !== undefined } });
		} catch (error) {
			fail(error);
		}
	});
}

function checkIo({ files, take, onProgress, onPoints, signal }) {
	if (files !== undefined) {
		checkRecord('files', files, 'an object of texts or bytes by name');
		for (const [name, content] of Object.entries(files)) {
			if (typeof content !== 'string' && !ArrayBuffer.isView(content)) {
				refuse(`files: ${name}`, nameOf(content), 'text or bytes');
			}
		}
	}
	if (take !== undefined && !(Array.isArray(take) && take.every(name => typeof name === 'string'))) {
		refuse('take', nameOf(take), 'an array of names of files');
	}
	for (const [name, call] of Object.entries({ onProgress, onPoints })) {
		if (call !== undefined && typeof call !== 'function') {
			refuse(name, nameOf(call), 'a function');
		}
	}
	if (signal !== undefined && !(typeof signal?.aborted === 'boolean' && typeof signal.addEventListener === 'function')) {
		refuse('signal', nameOf(signal), 'an AbortSignal');
	}
}

const IO = ['files', 'take', 'onProgress', 'onPoints', 'signal'];

// One run: `files` are there before it, those of `take` are handed back, as bytes where they are pictures or textures. Nothing is thrown
// for an exit code. `onProgress` is called with the name of what is done and a share from 0 to 1, `onPoints` with the number of a start
// and x, y, z of its points while they move. With a `signal` the run has a worker of its own, which ends when the signal says so;
// without, it keeps this thread until it is done.
export async function nook(command, io = {}) {
	if (!Array.isArray(command) || !command.every(word => typeof word === 'string' || typeof word === 'number')) {
		refuse('nook', nameOf(command), "an array of words, such as ['info', 'a.json']");
	}
	checkRecord('nook: options', io, 'an object');
	for (const name of Object.keys(io)) {
		if (!IO.includes(name)) {
			refuse('nook: options', `'${name}'`, IO.join(', '));
		}
	}
	checkIo(io);
	io.signal?.throwIfAborted();
	const wasm = await load();
	io.signal?.throwIfAborted();
	const words = command.map(String);
	return io.signal === undefined ? runHere(wasm, words, io) : runInWorker(wasm, words, io);
}

async function succeed(command, io) {
	const answer = await nook(command, io);
	if (answer.code !== 0) {
		throw new NookError(answer.stderr.trim().replace(/^nook: /, ''), answer.code);
	}
	return answer;
}

const optionOf = name => `--${name.replace(/[A-Z]/g, letter => `-${letter.toLowerCase()}`)}`;
const RESERVED = ['depfile', 'help', 'json', 'output', 'progress']; // files and texts of the program, which these functions handle
const REPEATED = ['filter']; // of a tile; other lists have commas

function wordOf(option, value) {
	const text = String(value);
	if ((typeof value !== 'string' && typeof value !== 'number') || /^-[^0-9.]/.test(text)) {
		refuse(option, nameOf(value), 'a text, a number or true');
	}
	return text;
}

// { halfLength: 2, symmetric: true, counts: [5, 9] } → --half-length 2 --symmetric --counts 5,9
function words(options) {
	const command = [];
	for (const [name, value] of Object.entries(options)) {
		const option = optionOf(name);
		if (RESERVED.includes(name) || !/^[a-z][A-Za-z]*$/.test(name)) {
			refuse('options', `'${name}'`, 'an option of the command line in camel case; formats and file say what is made');
		}
		if (value === true) {
			command.push(option);
		} else if (Array.isArray(value) && value.length > 0) {
			const list = value.map(one => wordOf(option, one));
			command.push(...(REPEATED.includes(name) ? list.flatMap(one => [option, one]) : [option, list.join(',')]));
		} else if (value !== undefined && value !== null && value !== false) {
			command.push(option, wordOf(option, value));
		}
	}
	return command;
}

// The options of a function, apart from what is not the command line's.
function split(verb, options, ...own) {
	checkRecord(verb, options, 'an object of options');
	const { onProgress, onPoints, signal, ...others } = options;
	const io = Object.fromEntries(Object.entries({ onProgress, onPoints, signal }).filter(([, value]) => value !== undefined));
	const taken = Object.fromEntries(own.map(name => [name, others[name]]));
	own.forEach(name => delete others[name]);
	return { io, ...taken, words: words(others), others };
}

function stemOf(name) {
	return name.replace(/\.[^.]*$/, '');
}

async function make(verb, command, io, formats = [], name = `${verb}.json`) {
	if (!Array.isArray(formats) || !formats.every(format => typeof format === 'string' && /^[a-z0-9]+$/.test(format))) {
		refuse('formats', nameOf(formats), "an array of endings, such as ['h', 'glsl']");
	}
	checkText('file', name);
	const endings = [...new Set(['json', ...formats])];
	const names = endings.map(ending => `${stemOf(name)}.${ending}`);
	const answer = await succeed([verb, ...command, ...names.flatMap(file => ['-o', file])], { ...io, take: names });
	const made = Object.fromEntries(endings.map((ending, i) => [ending, answer.files[names[i]]]));
	return { name: names[0], data: JSON.parse(made.json), files: made };
}

// A sample set that is given: what pattern() or tile() returned, or the text of a file.
function fileOf(where, given, name) {
	if (typeof given === 'string') {
		return [name, given];
	}
	if (!isRecord(given) || typeof given.name !== 'string' || typeof given.files?.json !== 'string') {
		refuse(where, nameOf(given), 'what pattern() or tile() returned, or the text of a file');
	}
	return [given.name, given.files.json];
}

export async function pattern(options) {
	const { io, formats, file, words: command } = split('pattern', options, 'formats', 'file');
	return make('pattern', command, io, formats, file);
}

export async function tile(options) {
	const { io, pattern: base, formats, file = 'tile.json', words: command } = split('tile', options, 'pattern', 'formats', 'file');
	if (base === undefined) { // slices, or the program's own line
		return make('tile', command, io, formats, file);
	}
	const [name, text] = fileOf('pattern', base, 'pattern.json');
	return make('tile', ['--pattern', name, ...command], { ...io, files: { [name]: text } }, formats, file === name ? `tile_${file}` : file);
}

// Points as a table; numbers are written so that they read back as the same.
function csvOf(points) {
	const listed = Array.isArray(points[0]);
	const columns = listed ? ['x', 'y', 'z'].slice(0, points[0].length) : isRecord(points[0]) ? Object.keys(points[0]) : [];
	const title = column => column.replace(/[A-Z]/g, letter => `_${letter.toLowerCase()}`);
	const rows = points.map((point, i) => {
		const numbers = Array.isArray(point) === listed && (listed || isRecord(point)) ? listed ? point : columns.map(column => point[column]) : [];
		if (numbers.length === 0 || numbers.length !== columns.length || !numbers.every(Number.isFinite)) {
			refuse(`points: ${i}`, Array.isArray(point) ? `[${point}]` : nameOf(point), 'numbers: [x, y] or [x, y, z], or columns by name, in all points alike');
		}
		return numbers.join(',');
	});
	return `${[columns.map(title).join(','), ...rows].join('\n')}\n`;
}

export async function measure(points, options = {}) {
	const { io, words: command } = split('measure', options);
	const [name, text] = Array.isArray(points) ? ['points.csv', csvOf(points)] : fileOf('points', points, 'pattern.json');
	const answer = await succeed(['info', name, ...command, '--json', 'measured.out'], { ...io, files: { [name]: text }, take: ['measured.out'] });
	return JSON.parse(answer.files['measured.out']);
}

export async function emit(options) {
	const language = ['hlsl', 'wgsl'].find(name => options?.[name] !== undefined) ?? 'glsl';
	const { io, patterns = [], file = `nook.${language}`, words: command, others } = split('emit', options, 'patterns', 'file');
	if (!Array.isArray(patterns)) {
		refuse('patterns', nameOf(patterns), 'an array of what pattern() or tile() returned');
	}
	checkText('file', file);
	const given = patterns.map((one, i) => fileOf(`patterns: ${i}`, one, `pattern_${i}.json`));
	const seen = new Map();
	for (const pair of given) { // two of one name are two files all the same
		const count = seen.get(pair[0]) ?? 0;
		seen.set(pair[0], count + 1);
		pair[0] = count === 0 ? pair[0] : `${stemOf(pair[0])}_${count + 1}.json`;
	}
	const header = `${stemOf(file)}.h`;
	const alone = /^aov/.test(String(others.methods)); // its stages have no header
	const script = `${stemOf(file)}.js`;
	const outputs = alone ? [file] : [file, header, script];
	const samples = given.length > 0 ? ['--patterns', given.map(pair => pair[0]).join(',')] : [];
	const answer = await succeed(['emit', ...command, ...samples, ...outputs.flatMap(output => ['-o', output])],
		{ ...io, files: Object.fromEntries(given), take: outputs });
	return { [language]: answer.files[file], header: answer.files[header], script: answer.files[script] };
}
