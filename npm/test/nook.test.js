// SPDX-License-Identifier: GPL-3.0-or-later
// node --test, in a folder where the package is installed. NOOK_PATTERNS: the catalogue's folder.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, readdir, rm } from 'node:fs/promises';
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
	await assert.rejects(pattern({ domain: 'disk', count: 4, starts: 1, formats: ['png'] }), { code: 5 });
	const same = await run('pattern', '--domain', 'cube', '--count', '9');
	assert.equal(same.code, 1);
	assert.equal(same.stderr, "nook: --domain: found 'cube', expected disk, ball, sphere or hemisphere\n");
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
