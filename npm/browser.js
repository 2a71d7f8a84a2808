// SPDX-License-Identifier: GPL-3.0-or-later
// The package in a browser. Both addresses are in the form that bundlers look for.
import { setPlace } from './calls.js';

setPlace({
	wasm: () => new URL('./nook.wasm', import.meta.url),
	startWorker(receive, fail) {
		const worker = new Worker(new URL('./nook_worker.js', import.meta.url), { type: 'module' });
		worker.onmessage = ({ data }) => receive(data);
		worker.onerror = fail;
		return { post: message => worker.postMessage(message), end: () => worker.terminate() };
	},
});

export { NookError, emit, load, measure, nook, pattern, tile } from './calls.js';
