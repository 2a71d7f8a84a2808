// SPDX-License-Identifier: GPL-3.0-or-later
// The package in Node.js.
import { readFile } from 'node:fs/promises';
import { Worker } from 'node:worker_threads';

import { setPlace } from './calls.js';

setPlace({
	wasm: () => readFile(new URL('./nook.wasm', import.meta.url)),
	startWorker(receive, fail) {
		const worker = new Worker(new URL('./node_worker.js', import.meta.url));
		worker.on('message', receive).on('error', fail);
		return { post: message => worker.postMessage(message), end: () => worker.terminate() };
	},
});

export { NookError, emit, load, measure, nook, pattern, tile } from './calls.js';
