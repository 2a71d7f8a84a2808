// SPDX-License-Identifier: GPL-3.0-or-later
// The program of the package nook-patterns. Worker and WebAssembly are parts of the script, because a page that was opened from a file
// may fetch neither.
import { nook, setPlace } from 'nook-patterns/calls.js';
import NookWorker from 'nook-patterns/nook_worker.js?worker&inline';
import wasm from 'nook-patterns/nook.wasm?url';

const FRAME_MS = 8; // between points of the starts after the first, which is shown step by step

export const program = { busy: 0, ends: new AbortController() };

export const hasWasm = () => typeof WebAssembly === 'object' && typeof Worker === 'function';

setPlace({
	wasm: () => wasm,
	startWorker(receive, fail) {
		const worker = new NookWorker();
		worker.onmessage = ({ data }) => receive(data);
		worker.onerror = fail;
		return { post: message => worker.postMessage(message), end: () => worker.terminate() };
	},
});

function thinned(onPoints) {
	let last = 0;
	return (start, numbers) => {
		const now = performance.now();
		if (start > 0 && now - last < FRAME_MS) return;
		last = now;
		onPoints(start, numbers);
	};
}

// One command: {code, stdout, stderr, files}. Throws the program's own line where it fails, and 'cancelled' after cancelProgram().
export async function succeedProgram(command, { onPoints, ...io } = {}) {
	const answer = await nook(command, { ...io, ...(onPoints ? { onPoints: thinned(onPoints) } : {}), signal: program.ends.signal });
	if (answer.code !== 0) throw new Error(answer.stderr.trim().replace(/^nook: /, ''));
	return answer;
}

export function cancelProgram() {
	program.ends.abort(new Error('cancelled'));
	program.ends = new AbortController();
}
