// SPDX-License-Identifier: GPL-3.0-or-later
// node generate.mjs NOOK FOLDER: writes FOLDER/nook_slices.js, the modules, tiles and block of `nook emit` for every quality, without
// comments, FOLDER/nook_slices_wgsl.js, the modules in WGSL, and FOLDER/nook_aov.js, the stages of volumes. Modules differ from the first by a few lines, so only these are stored
// for the others.
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

// Lines without comments, indentation and the suffix of floats, which no language here needs.
const bare = text => text.split('\n').map(line => line.replace(/\s*\/\/.*/, '').replace(/(\d\.\d+|\de-?\d+)f\b/g, '$1').trim()).filter(line => line);

// A 32-bit float with as few digits as it needs.
const shortest = value => [6, 7, 8, 9].map(digits => +value.toPrecision(digits)).find(short => Math.fround(short) === value);

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

// Lines without what is compiled only with one of `names` defined.
function without(lines, names) {
	const kept = [], open = []; // [is it left out, is it one of ours]
	for (const line of lines) {
		const [, name] = /^#ifdef (\w+)/.exec(line) ?? [];
		if (/^#if/.test(line)) open.push([names.includes(name), names.includes(name)]);
		const own = open.at(-1)?.[1];
		if (own && line === '#else') open.at(-1)[0] = false;
		else if (!(own && /^#(ifdef|endif)/.test(line)) && !open.some(([out]) => out)) kept.push(line);
		if (line.startsWith('#endif')) open.pop();
	}
	return kept;
}

function emit(quality, resolution, depth, language) {
	const [count, steps] = qualities[quality];
	const file = `${quality}_${resolution}_${depth}.${language[0]}`;
	if (!existsSync(join(scratch, `tile_${count}.json`))) {
		run('tile', '--domain', 'slice', '--count', count, '--size', 4, '--filter', 'bilateral:5', '--frames', 16, '--moves', '-o', `tile_${count}.json`);
	}
	run('emit', '--methods', 'slices', '--patterns', `tile_${count}.json`, '--slice-steps', steps, '--filter', 'bilateral', '--resolution', resolution,
		'--depth', depth, '--normals', 'from-depth', '--block', 'floats', ...language.slice(1), '-o', file);
	return join(scratch, file);
}

const emitted = (quality, resolution, depth) => import(pathToFileURL(emit(quality, resolution, depth, ['js', '--glsl', 'es300'])));

// Normals come from a texture, as NOOK_NORMAL has them in GLSL, unless depth is the device's.
function wgslOf(quality, resolution, depth) {
	const text = readFileSync(emit(quality, resolution, depth, ['wgsl', '--wgsl', '--main', 'fragment']), 'utf8')
		.replace(/\blet (\w+): (f32|vec[234]f) = /g, 'let $1 = '); // WGSL infers it
	const computed = /(fn nookNormal\(pixel: vec2i\) -> vec3f\n\{\n)\treturn nookNormalFromDepth\(pixel\);/;
	if (!computed.test(text)) throw new Error(`${quality}: found no nookNormal that computes, expected it in WGSL`);
	return depth === 'device' ? text : text.replace(computed, '@group(0) @binding(2) var nook_normals: texture_2d<f32>;\n$1\treturn normalize(textureLoad(nook_normals, pixel, 0).xyz * 2.0f - 1.0f);');
}

// The modules of every quality as JavaScript: the text of `medium`, and hunks for the others; those at half resolution follow the hunks
// of `half`. of(quality, resolution, depth): a text.
async function stored(of) {
	const lines = bare(await of('medium', 'full', 'linear')), half = bare(await of('medium', 'half', 'linear'));
	const changes = { half: hunksOf(lines, half) };
	const add = (name, from, text) => {
		const wanted = bare(text);
		changes[name] = hunksOf(from, wanted);
		const made = [...from];
		for (const [at, removed, ...inserted] of changes[name]) made.splice(at, removed, ...inserted);
		if (made.join('\n') !== wanted.join('\n')) throw new Error(`${name}: found hunks that make another module`);
	};
	for (const quality of Object.keys(qualities)) {
		add(quality, lines, await of(quality, 'full', 'linear'));
		add(`${quality}_half`, half, await of(quality, 'half', 'linear'));
	}
	add('device', lines, await of('medium', 'full', 'device'));
	const texts = [...lines, ...half, ...Object.values(changes).flat(2).filter(one => typeof one === 'string')];
	return { lines: JSON.stringify(lines.join('\n')), changes: JSON.stringify(changes), texts };
}

// JavaScript of the function that returns a module.
const returning = (name, comment) => `/** ${comment} */
export function ${name}(name) {
	const made = lines.split('\\n');
	for (const change of [name.endsWith('_half') ? changes.half : [], changes[name]]) {
		for (const [at, removed, ...inserted] of change) made.splice(at, removed, ...inserted);
	}
	return made.join('\\n');
}
`;

const base = await emitted('medium', 'full', 'linear');
const tiles = {};
for (const quality of Object.keys(qualities)) {
	const { width, height, texels } = (await emitted(quality, 'full', 'linear')).slices.tile;
	tiles[quality] = { width, height, texels: Array.from(texels, shortest) };
}

// The block's code as nook emits it, up to the first method, without comments and the export of the text; without the check of settings,
// which the package's own options have passed; and without members that no shader of the package reads.
function blockCode(script, texts) {
	const read = new Set([...texts, readFileSync(new URL('ao.js', import.meta.url), 'utf8')].flatMap(text => [...text.matchAll(/\bnook\.(\w+)/g)].map(([, name]) => name)));
	let text = script.replace(/\/\*\*[\s\S]*?\*\//g, '');
	text = text.slice(0, text.search(/^export const slices\b/m)).split('\n').slice(2).map(line => line.replace(/(^|[\s{},;])\/\/ .*$/, '$1').trimEnd()).join('\n');
	const check = /^\tconst wrong_settings[\s\S]*?^\t}\n/m;
	if (!check.test(text) || !read.has('slice_thickness')) throw new Error('nook emit: found other JavaScript than expected');
	text = text.replace(check, '').replace(', completed(settings))', ', { ...defaults, ...settings })').replace(/^\t(?:{ name: '|block\.)(\w+)\b.*\n/gm, (line, name) => read.has(name) ? line : '');
	for (let before = ''; before !== text;) { // functions and defaults that nothing uses now
		before = text;
		text = text.replace(/^function (\w+)\([\s\S]*?^}\n/gm, (whole, name) => text.split(name).length > 2 ? whole : '')
			.replace(/^const (\w+) = \[.*\n/gm, (line, name) => text.split(name).length > 2 ? line : '')
			.replace(/^\t(\w+): [^{\n]*,\n/gm, (line, name) => text.includes(`settings.${name}`) ? line : '');
	}
	return text.split('\n').map(line => line.trim()).filter(line => line).join('\n');
}

const { radius, slice_thickness, strength, power } = base.slices.settings(1);
const glsl = await stored(async (...words) => (await emitted(...words)).glsl), wgsl = await stored(wgslOf);
// The text in GLSL comes first here and the one in WGSL last in the file before it in the package, since similar texts that are close
// to each other compress better.
writeFileSync(join(folder, 'nook_slices.js'), `// Made by nook emit and nook tile (npm/ao/generate.mjs), comments removed.
// SPDX-License-Identifier: MIT
const lines = ${glsl.lines};
const changes = ${glsl.changes};
${returning('glslOf', "The GLSL of a quality, 'low' to 'high', at half resolution with '_half' added; 'device' reads a depth buffer instead of linear depth.")}/** The samples of a quality's tile. */
export const tiles = ${JSON.stringify(tiles)};
/** The settings of the recipe for rays of one metre. */
export const recipe = ${JSON.stringify({ radius, slice_thickness, strength, power })};
${blockCode(readFileSync(join(scratch, 'medium_full_linear.js'), 'utf8'), glsl.texts.concat(wgsl.texts))}
`);
writeFileSync(join(folder, 'nook_slices_wgsl.js'), `// Made by nook emit (npm/ao/generate.mjs), comments removed.
// SPDX-License-Identifier: MIT
const changes = ${wgsl.changes};
${returning('wgslOf', 'The WGSL of a quality, as glslOf() of nook_slices.js, with entry points and normals from a texture.')}const lines = ${wgsl.lines};
`);
run('emit', '--methods', 'aov', '--glsl', 'es300', '-o', 'aov.glsl');
writeFileSync(join(folder, 'nook_aov.js'), `// Made by nook emit (npm/ao/generate.mjs), comments removed.
// SPDX-License-Identifier: MIT
/** The stages that draw volumes. */
export const glsl = ${JSON.stringify(without(bare(readFileSync(join(scratch, 'aov.glsl'), 'utf8')), ['NOOK_SPARSE', 'NOOK_CHOOSE_FACES', 'NOOK_PRISMS']).join('\n'))};
`);
rmSync(scratch, { recursive: true });
