// SPDX-License-Identifier: GPL-3.0-or-later
// The package in a worker of a page: the bytes of the catalogue, and the error as it is thrown. Skipped where there is no Chromium.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm } from 'node:fs/promises';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { promisify } from 'node:util';

const types = { js: 'text/javascript', wasm: 'application/wasm', html: 'text/html' };
const page = `<!doctype html><title>waiting</title><script type="module">
const worker = new Worker('/worker.js', { type: 'module' });
worker.onmessage = ({ data }) => fetch('/done', { method: 'POST', body: JSON.stringify(data) });
worker.onerror = error => fetch('/done', { method: 'POST', body: JSON.stringify({ failed: error.message }) });
</script>`;
const worker = `import { pattern } from '/browser.js';
const made = await pattern({ domain: 'disk', count: 5 });
const error = await pattern({ domain: 'cube', count: 5 }).catch(thrown => ({ message: thrown.message, code: thrown.code }));
postMessage({ json: made.files.json, error });`;

async function answer(request, response, done) {
	if (request.url === '/done') {
		let body = '';
		for await (const part of request) {
			body += part;
		}
		response.end();
		done(JSON.parse(body));
		return;
	}
	const own = { '/': ['html', page], '/worker.js': ['js', worker] }[request.url];
	const name = request.url.slice(1);
	try {
		response.setHeader('Content-Type', own ? types[own[0]] : types[name.split('.').pop()] ?? 'text/plain');
		response.end(own ? own[1] : await readFile(join('node_modules/nook-patterns', name)));
	} catch {
		response.writeHead(404).end();
	}
}

test('a worker in a browser', async context => {
	const found = await promisify(execFile)('chromium', ['--version']).catch(() => undefined);
	if (found === undefined) {
		context.skip('found no chromium, expected Debian\'s package chromium');
		return;
	}
	let server;
	const said = new Promise(done => { server = createServer((request, response) => answer(request, response, done)); });
	await new Promise(listening => server.listen(0, '127.0.0.1', listening));
	const profile = await mkdtemp(join(tmpdir(), 'nook-browser-'));
	const browser = execFile('chromium', ['--headless=new', '--no-sandbox', '--disable-gpu', '--no-first-run', `--user-data-dir=${profile}`,
		`http://127.0.0.1:${server.address().port}/`]);
	const ended = new Promise(resolve => browser.once('exit', resolve));
	const late = setTimeout(() => browser.kill(), 90000);
	const made = await Promise.race([said, ended.then(() => ({ failed: 'the browser ended without an answer' }))]);
	clearTimeout(late);
	browser.kill();
	await ended;
	server.closeAllConnections?.();
	server.close();
	await rm(profile, { recursive: true, force: true, maxRetries: 5 });
	assert.equal(made.failed, undefined);
	assert.equal(made.json, await readFile(join(process.env.NOOK_PATTERNS, 'disk/disk_005.json'), 'utf8'));
	assert.deepEqual(made.error, { message: "--domain: found 'cube', expected disk, ball, sphere or hemisphere", code: 1 });
});
