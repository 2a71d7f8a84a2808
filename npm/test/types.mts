// SPDX-License-Identifier: GPL-3.0-or-later
// What an editor and `tsc --strict` take for right and for wrong; never run.
import { pattern, tile, measure, emit, nook, load, NookError, type MadePattern, type MadeTile, type Answer } from 'nook-patterns';

const disk: MadePattern = await pattern({ domain: 'disk', count: 9, symmetric: true, formats: ['h', 'glsl'] });
const header: string | undefined = disk.files.h;
const window: MadeTile = await tile({ pattern: disk, size: 4, filter: ['box:3', 'gauss:1.5@2'], formats: ['ktx2'], signal: new AbortController().signal });
const texture: Uint8Array | undefined = window.files.ktx2;
const slices: number[][][] = (await tile({ domain: 'slice', size: 4 })).data.variants.map(variant => variant.points);
const errors: { quality: { plane: number } } = await measure([[0.5, 0], [-0.5, 0]], { domain: 'disk' });
const mean: number | undefined = (await measure(window)).quality.window;
const either: 'pattern' | 'tile' = (await measure(disk.files.json)).kind;
const module: { glsl: string; header?: string } = await emit({ methods: 'vo-line', patterns: [window], glsl: 'es300', filter: 'window' });
const answer: Answer = await nook(['info', 'a.json'], { files: { 'a.json': disk.files.json }, take: [],
	onProgress: (stage: string, share: number) => stage.length + share, onPoints: (start, numbers) => numbers[start] });
await load(new Uint8Array(8)).catch((error: unknown) => error instanceof NookError ? error.code : 0);
// @ts-expect-error a domain that there is none of
await pattern({ domain: 'cube', count: 9 });
// @ts-expect-error an option that is misspelt
await pattern({ domain: 'disk', count: 9, symetric: true });
// @ts-expect-error an option of another function
await tile({ pattern: disk, size: 4, symmetric: true });
// @ts-expect-error a format that tiles alone have
await pattern({ domain: 'disk', count: 9, formats: ['ktx2'] });
// @ts-expect-error neither a pattern nor slices
await tile({ size: 4 });
// @ts-expect-error misspelt
await emit({ methods: 'vo-line', glsl: 330, fliter: 'window' });
// @ts-expect-error misspelt
await nook(['info'], { fles: {} });
// @ts-expect-error not any
disk.data.pionts;
// @ts-expect-error not any
(await measure(disk)).qaulity;
// @ts-expect-error bytes are no text
disk.files.png?.toUpperCase();
console.log(texture?.length, slices.length, mean, either);
console.log(header, errors.quality.plane, module.glsl, answer.code);
