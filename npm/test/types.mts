// SPDX-License-Identifier: GPL-3.0-or-later
// What an editor and `tsc --strict` take for right and for wrong; never run.
import { pattern, tile, measure, emit, nook, load, NookError, type Made, type Answer } from 'nook-patterns';

const disk: Made = await pattern({ domain: 'disk', count: 9, symmetric: true, formats: ['h', 'glsl'] });
const header: string | undefined = disk.files.h;
const window: Made = await tile({ pattern: disk, size: 4 });
const errors: { quality: { plane: number } } = await measure([[0.5, 0], [-0.5, 0]], { domain: 'disk' });
const module: { glsl: string; header?: string } = await emit({ methods: 'vo-line', patterns: [window], glsl: 'es300', filter: 'window' });
const answer: Answer = await nook(['info', 'a.json'], { files: { 'a.json': disk.files.json }, take: [],
	onProgress: (stage: string, share: number) => stage.length + share, onPoints: (start, numbers) => numbers[start] });
await load(new Uint8Array(8)).catch((error: unknown) => error instanceof NookError ? error.code : 0);
// @ts-expect-error a domain that there is none of
await pattern({ domain: 'cube', count: 9 });
console.log(header, errors.quality.plane, module.glsl, answer.code);
