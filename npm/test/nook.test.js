// SPDX-License-Identifier: GPL-3.0-or-later
// node --test, in a folder where the package is installed. NOOK_PATTERNS: the catalogue's folder.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, readdir, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { Worker } from 'node:worker_threads';

import { NookError, emit, load, measure, nook, pattern, tile } from 'nook-patterns';

const catalogue = name => readFile(join(process.env.NOOK_PATTERNS, name), 'utf8');

function run(...words) {
	return new Promise(resolve => {
		execFile(process.execPath, ['node_modules/nook-patterns/cli.cjs', ...words], (error, stdout, stderr) => {
			resolve({ code: error?.code ?? 0, stdout, stderr });
		});
	});
}

test('pattern: the bytes of the catalogue', async () => {
	const made = await pattern({ domain: 'disk', count: 9, symmetric: true });
	assert.equal(made.files.json, await catalogue('disk/disk_009_symmetric.json'));
	assert.equal(made.data.points.length, 9);
	assert.equal((await pattern({ domain: 'ball', count: 5 })).files.json, await catalogue('ball/ball_005.json'));
});

test('pattern: several formats of one call', async () => {
	const made = await pattern({ domain: 'disk', count: 4, starts: 2, formats: ['h', 'glsl', 'svg'] });
	assert.match(made.files.h, /NOOK_DISK_?4_COUNT/);
	assert.match(made.files.glsl, /const/);
	assert.match(made.files.svg, /^<svg/);
});

test('tile and emit: from what pattern returned', async () => {
	const base = await pattern({ domain: 'disk', count: 4, file: 'disk_004.json' });
	const made = await tile({ pattern: base, size: 4 });
	assert.equal(made.files.json, await catalogue('disk/disk_004_tile4.json'));
	const module = await emit({ methods: 'vo-line', patterns: [made], glsl: 'es300', filter: 'window' });
	assert.match(module.glsl, /nookVoLine\(ivec2 pixel\)/);
	assert.match(module.header, /nook_block/);
	const script = await import(`data:text/javascript,${encodeURIComponent(module.script)}`);
	assert.equal(script.glsl, module.glsl);
	assert.equal(script.fill([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -1, 0], { width: 640, height: 360 }).byteLength, script.blockBytes);
	assert.match((await emit({ methods: 'slices', wgsl: true })).wgsl, /fn nookSlices\(/);
	assert.match((await emit({ methods: 'slices', hlsl: 60 })).hlsl, /float nookSlices\(/);
	const volumes = await emit({ methods: 'aov', glsl: 330 });
	assert.match(volumes.glsl, /void main/);
	assert.equal(volumes.header, undefined);
});

test('measure: a pattern again, and points of one\'s own', async () => {
	const made = await pattern({ domain: 'disk', count: 9, symmetric: true });
	const said = await measure(made);
	assert.deepEqual(said.quality, said.quality_in_file);
	const two = await measure([[0.5, 0], [-0.5, 0]], { domain: 'disk' });
	const named = await measure([{ x: 0.5, y: 0 }, { x: -0.5, y: 0 }], { domain: 'disk' });
	assert.equal(two.count, 2);
	assert.deepEqual(two.quality, named.quality);
});

test('errors: the line and the exit code of the command line', async () => {
	await assert.rejects(pattern({ domain: 'cube', count: 9 }), error => error instanceof NookError && error.code === 1 &&
		error.message === "--domain: found 'cube', expected disk, ball, sphere or hemisphere");
	await assert.rejects(pattern({ domain: 'disk', count: 0 }), { code: 1, message: /^--count: found '0'/ });
	await assert.rejects(pattern({ domain: 'disk', count: 9, wrong: 3 }), { code: 1 });
	await assert.rejects(measure('{', {}), { code: 3 });
	await assert.rejects(pattern({ domain: 'disk', count: 4, starts: 1, formats: ['png'] }), { code: 1 });
	const same = await run('pattern', '--domain', 'cube', '--count', '9');
	assert.equal(same.code, 1);
	assert.equal(same.stderr, "nook: --domain: found 'cube', expected disk, ball, sphere or hemisphere\n");
});

test('files of bytes: as they are on a disk', async () => {
	const folder = await mkdtemp(join(tmpdir(), 'nook-'));
	const base = await pattern({ domain: 'disk', count: 4, file: 'disk_004.json' });
	const made = await tile({ pattern: base, size: 2, filter: ['box:2', 'none'], formats: ['ktx2', 'h'] });
	await writeFile(join(folder, 'disk_004.json'), base.files.json);
	const file = join(folder, 'tile.ktx2');
	const words = ['tile', '--pattern', join(folder, 'disk_004.json'), '--size', '2', '--filter', 'box:2', '--filter', 'none', '-o', file];
	assert.deepEqual(await run(...words), { code: 0, stdout: '', stderr: '' });
	assert.ok(made.files.ktx2 instanceof Uint8Array);
	assert.deepEqual(Buffer.from(made.files.ktx2), await readFile(file));
	assert.equal(typeof made.files.h, 'string');
	await rm(folder, { recursive: true });
});

test('slices: a tile without a pattern', async () => {
	const made = await tile({ domain: 'slice', size: 2, count: 2 });
	assert.equal(made.data.command, 'nook tile --domain slice --count 2 --size 2');
	assert.equal((await measure(made)).kind, 'tile');
});

test('signal: a worker of its own, ended at once', async () => {
	let told = 0;
	const { signal } = new AbortController();
	const made = await pattern({ domain: 'disk', count: 9, symmetric: true, signal, onProgress: () => { told += 1; }, onPoints: () => { told += 1; } });
	assert.equal(made.files.json, await catalogue('disk/disk_009_symmetric.json'));
	assert.ok(told > 2);
	await assert.rejects(pattern({ domain: 'cube', count: 9, signal }), error => error instanceof NookError && error.code === 1);
	const stop = new AbortController();
	await assert.rejects(pattern({ domain: 'disk', count: 4096, signal: stop.signal, onProgress: () => stop.abort() }), { name: 'AbortError' });
	await assert.rejects(pattern({ domain: 'disk', count: 4, signal: AbortSignal.abort() }), { name: 'AbortError' });
	await assert.rejects(measure(made, { signal: AbortSignal.abort(new Error('enough')) }), { message: 'enough' });
	const own = new Error('mine');
	const fail = () => { throw own; };
	await assert.rejects(pattern({ domain: 'disk', count: 9, signal, onProgress: fail }), own);
	await assert.rejects(pattern({ domain: 'disk', count: 9, onProgress: fail }), own);
});

test('bad input: one line of the library', async () => {
	const disk = { domain: 'disk', count: 3 };
	for (const [call, message] of [
		[() => pattern(), 'pattern: found undefined, expected an object of options'],
		[() => pattern(null), 'pattern: found null, expected an object of options'],
		[() => pattern({ ...disk, formats: 'h' }), "formats: found 'h', expected an array of endings, such as ['h', 'glsl']"],
		[() => pattern({ ...disk, formats: ['xyz'] }), 'pattern.xyz: found the ending .xyz, expected one of .json, .h, .glsl, .hlsl, .csv, .svg'],
		[() => pattern({ ...disk, file: 5 }), 'file: found 5, expected a text that is not empty'],
		[() => pattern({ ...disk, count: {} }), '--count: found an object, expected a text, a number or true'],
		[() => pattern({ ...disk, name: '--help' }), "--name: found '--help', expected a text, a number or true"],
		[() => pattern({ ...disk, help: true }), "options: found 'help', expected an option of the command line in camel case; formats and file say what is made"],
		[() => pattern({ ...disk, symetric: true }), "The following argument was not expected: --symetric, expected what 'nook pattern --help' lists"],
		[() => pattern({ ...disk, signal: 5 }), 'signal: found 5, expected an AbortSignal'],
		[() => pattern({ ...disk, onProgress: 5 }), 'onProgress: found 5, expected a function'],
		[() => tile({ size: 4 }), '--pattern: missing without --domain slice, expected one of them'],
		[() => tile({ domain: 'slice', size: 0 }), "--size: found '0', expected a whole number from 2 to 128"],
		[() => tile({ pattern: {}, size: 4 }), 'pattern: found an object, expected what pattern() or tile() returned, or the text of a file'],
		[() => measure(), 'points: found undefined, expected what pattern() or tile() returned, or the text of a file'],
		[() => measure([[0, 0], [NaN, 1]], { domain: 'disk' }), 'points: 1: found [NaN,1], expected numbers: [x, y] or [x, y, z], or columns by name, in all points alike'],
		[() => measure([{ x: 0, y: 0 }, [1, 2]]), 'points: 1: found [1,2], expected numbers: [x, y] or [x, y, z], or columns by name, in all points alike'],
		[() => emit({ methods: 'vo-line', glsl: 330, patterns: 'x' }), "patterns: found 'x', expected an array of what pattern() or tile() returned"],
		[() => nook('info'), "nook: found 'info', expected an array of words, such as ['info', 'a.json']"],
		[() => nook(['info'], { fles: {} }), "nook: options: found 'fles', expected files, take, onProgress, onPoints, signal"],
		[() => nook(['info'], { files: { a: 5 } }), 'files: a: found 5, expected text or bytes'],
		[() => load(5), 'load: found 5, expected bytes of nook.wasm, their address, a Response or a WebAssembly.Module'],
	]) {
		await assert.rejects(call, error => {
			assert.deepEqual([error instanceof NookError, error.message, error.code], [true, message, 1]);
			return true;
		});
	}
	await assert.rejects(measure([], { domain: 'disk' }), error => error instanceof NookError && error.code === 3);
	await assert.rejects(nook(['info', 'a/b.json'], { files: { 'a/b.json': '' } }), error => error instanceof NookError && error.code === 2);
});

test('types: every option of the command line', async () => {
	const types = await readFile('node_modules/nook-patterns/index.d.ts', 'utf8');
	const own = ['help', 'output', 'json', 'depfile', 'progress', 'pattern', 'patterns'];
	for (const [verb, name] of [['pattern', 'PatternOptions'], ['tile', 'TileSettings'], ['emit', 'EmitOptions']]) {
		const { stdout } = await nook([verb, '--help']);
		const listed = [...stdout.matchAll(/^ {2}(?:-\w,)?--([a-z-]+)/gm)].map(([, option]) => option.replace(/-./g, part => part[1].toUpperCase()));
		const block = types.slice(types.indexOf(`interface ${name}`), types.indexOf('\n}', types.indexOf(`interface ${name}`)) + (verb === 'tile' ? 500 : 0));
		assert.ok(listed.length > 10);
		assert.deepEqual(listed.filter(option => !own.includes(option) && !new RegExp(`\\b${option}\\??:`).test(block)), [], verb);
	}
});

test('nook: any command, nothing thrown', async () => {
	const answer = await nook(['info', 'a.json'], { files: { 'a.json': await catalogue('disk/disk_004.json') } });
	assert.equal(answer.code, 0);
	assert.match(answer.stdout, /^pattern: disk, 4 samples/);
	assert.equal((await nook(['shade', 'x.exr'])).code, 5);
});

test('load: bytes from elsewhere; a failure does not stay', async () => {
	await assert.rejects(load(new Uint8Array(8)));
	assert.ok(await load(readFile('node_modules/nook-patterns/nook.wasm')) instanceof WebAssembly.Module);
	assert.equal((await nook(['--version'])).code, 0);
});

test('a worker', async () => {
	const worker = new Worker(`import('nook-patterns').then(async ({ pattern }) => {
		const made = await pattern({ domain: 'disk', count: 5 });
		(await import('node:worker_threads')).parentPort.postMessage(made.files.json); });`, { eval: true });
	const text = await new Promise((resolve, reject) => worker.once('message', resolve).once('error', reject));
	assert.equal(text, await catalogue('disk/disk_005.json'));
});

test('command line: files of the machine, whole or not at all', async () => {
	const folder = await mkdtemp(join(tmpdir(), 'nook ü '));
	const file = join(folder, 'ä b.json');
	for (const time of ['first', 'over an existing file']) {
		const said = await run('pattern', '--domain', 'disk', '--count', '5', '-o', file);
		assert.deepEqual({ time, ...said }, { time, code: 0, stdout: '', stderr: '' });
	}
	assert.equal(await readFile(file, 'utf8'), await catalogue('disk/disk_005.json'));
	assert.equal((await run('pattern', '--domain', 'disk', '--count', '5', '-o', join(folder, 'none', 'a.json'))).code, 2);
	assert.deepEqual(await readdir(folder), ['ä b.json']);
	assert.match((await run('info', file)).stdout, /^pattern: disk, 5 samples/);
	await rm(folder, { recursive: true });
});
