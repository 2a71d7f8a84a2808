// SPDX-License-Identifier: GPL-3.0-or-later
// Uses the package as an application would: with and without its own worker, cancelled, rejected, bytes.
import { pattern, tile } from 'nook-patterns';

const refusal = error => `${error.name}, ${error.message}`;
const disk = await pattern({ domain: 'disk', count: 4 });
let told = 0;
const watched = await pattern({ domain: 'disk', count: 5, signal: new AbortController().signal, onProgress: () => { told += 1; } });
const texture = (await tile({ pattern: disk, size: 2, starts: 1, formats: ['ktx2'] })).files.ktx2;
const stop = new AbortController();
const began = performance.now();
const cancelled = pattern({ domain: 'disk', count: 2000, signal: stop.signal, onProgress: () => stop.abort() });
globalThis.said = {
	disk: disk.files.json,
	watched: watched.files.json,
	told: told > 0,
	texture: texture instanceof Uint8Array && String.fromCharCode(...texture.subarray(1, 7)),
	cancelled: await cancelled.catch(error => error.name),
	at_once: performance.now() - began < 20000,
	before: await pattern({ domain: 'disk', count: 4, signal: AbortSignal.abort() }).catch(error => error.name),
	refused: await pattern({ domain: 'cube', count: 4, signal: new AbortController().signal }).catch(refusal),
};
