// SPDX-License-Identifier: GPL-3.0-or-later
// In a worker, after the npm package's own script: commands in, their files out, and points while they move.
'use strict';

const FRAME_MS = 8; // of the starts after the first, of which every step is told

function watched(id) {
	let last = 0;
	return {
		onProgress: (stage, share) => postMessage({ id, stage, share }),
		onPoints: (start, numbers) => {
			const now = performance.now();
			if (start > 0 && now - last < FRAME_MS) return;
			last = now;
			postMessage({ id, start, numbers }, [numbers.buffer]);
		},
	};
}

self.onmessage = async ({ data: { id, wasm, command, files, take } }) => {
	try {
		if (wasm) await load(wasm);
		postMessage({ id, answer: command ? await nook(command, { files, take, ...watched(id) }) : null });
	} catch (error) {
		postMessage({ id, failed: String(error && error.message || error) });
	}
};
