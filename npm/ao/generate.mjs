// SPDX-License-Identifier: GPL-3.0-or-later
// node generate.mjs NOOK FOLDER: writes FOLDER/nook_slices.js, the modules, tiles and block of `nook emit` for every quality, without
// comments. Modules differ from the first by a few lines, so only these are stored for the others.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const [nook, folder] = process.argv.slice(2);
const scratch = mkdtempSync(join(tmpdir(), 'nook-ao-'));
const qualities = { low: [1, 3], medium: [1, 4], high: [3, 6] }; // slices, and steps on each side of a slice
writeFileSync(join(scratch, 'package.json'), '{"type": "module"}');
const run = (...words) => execFileSync(nook, words, { cwd: scratch, stdio: ['ignore', 'ignore', 'inherit'] });

const bare = text => text.split('\n').map(line => line.replace(/\s*\/\/.*/, '')).filter(line => line.trim());

// The hunks that turn one list of lines into another: [first line, lines to remove, ...lines to insert], the last hunk first.
function hunksOf(from, to) {
	const same = Array.from({ length: from.length + 1 }, () => new Uint16Array(to.length + 1)); // longest common tails
	for (let i = from.length - 1; i >= 0; --i) {
		for (let j = to.length - 1; j >= 0; --j) {
			same[i][j] = from[i] === to[j] ? same[i + 1][j + 1] + 1 : Math.max(same[i + 1][j], same[i][j + 1]);
		}
	}
	const hunks = [];
	for (let i = 0, j = 0; i < from.length || j < to.length;) {
		if (from[i] === to[j]) {
			++i, ++j;
			continue;
		}
		const hunk = [i, 0];
		while (i < from.length && from[i] !== to[j] && same[i + 1][j] >= (same[i][j + 1] ?? 0)) ++i, ++hunk[1];
		while (j < to.length && from[i] !== to[j] && (i === from.length || same[i][j + 1] > same[i + 1][j])) hunk.push(to[j++]);
		hunks.unshift(hunk);
	}
	return hunks;
}

async function emitted(quality, resolution, depth) {
	const [count, steps] = qualities[quality];
	const file = `${quality}_${resolution}_${depth}`;
	if (!existsSync(join(scratch, `tile_${count}.json`))) {
		run('tile', '--domain', 'slice', '--count', count, '--size', 4, '--filter', 'bilateral:5', '--frames', 16, '--moves', '-o', `tile_${count}.json`);
	}
	run('emit', '--methods', 'slices', '--patterns', `tile_${count}.json`, '--slice-steps', steps, '--filter', 'bilateral', '--resolution', resolution,
		'--depth', depth, '--normals', 'from-depth', '--block', 'floats', '--glsl', 'es300', '-o', `${file}.js`);
	return import(pathToFileURL(join(scratch, `${file}.js`)));
}

const base = await emitted('medium', 'full', 'linear');
const lines = bare(base.glsl);
const modules = {}, tiles = {};
const add = (name, { glsl }) => {
	const wanted = bare(glsl);
	const hunks = hunksOf(lines, wanted);
	const made = [...lines];
	for (const [at, removed, ...inserted] of hunks) made.splice(at, removed, ...inserted);
	if (made.join('\n') !== wanted.join('\n')) throw new Error(`${name}: found hunks that make another module`);
	modules[name] = hunks;
};
for (const quality of Object.keys(qualities)) {
	for (const resolution of ['full', 'half']) {
		const module = await emitted(quality, resolution, 'linear');
		add(resolution === 'full' ? quality : `${quality}_half`, module);
		const { width, height, texels } = module.slices.tile;
		tiles[quality] = { width, height, texels: Array.from(texels, value => +value.toPrecision(9)) };
	}
}
add('device', await emitted('medium', 'full', 'device'));

// The block's code as nook emits it, up to the first method, without comments and without the export of the text.
const script = readFileSync(join(scratch, 'medium_full_linear.js'), 'utf8').replace(/\/\*\*[\s\S]*?\*\//g, '');
const code = script.slice(0, script.search(/^export const slices\b/m)).split('\n').slice(2)
	.map(line => line.replace(/(^|[\s{},;])\/\/ .*$/, '$1').trimEnd()).filter(line => line.trim());
const { radius, slice_thickness, strength, power } = base.slices.settings(1);
writeFileSync(join(folder, 'nook_slices.js'), `// Made by nook emit and nook tile (npm/ao/generate.mjs), comments removed.
// SPDX-License-Identifier: MIT
${code.join('\n')}
/** The settings of the recipe for rays of one metre. */
export const recipe = ${JSON.stringify({ radius, slice_thickness, strength, power })};
const lines = ${JSON.stringify(lines.join('\n'))}.split('\\n');
const changes = ${JSON.stringify(modules)};
/** The GLSL of a quality, 'low' to 'high', at half resolution with '_half' added; 'device' reads a depth buffer instead of linear depth. */
export function glslOf(name) {
	const made = [...lines];
	for (const [at, removed, ...inserted] of changes[name]) made.splice(at, removed, ...inserted);
	return made.join('\\n');
}
/** The samples of a quality's tile. */
export const tiles = ${JSON.stringify(tiles)};
`);
rmSync(scratch, { recursive: true });
