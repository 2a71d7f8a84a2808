// SPDX-License-Identifier: GPL-3.0-or-later
// node generate.mjs NOOK FOLDER: writes FOLDER/nook_slices.js, the modules, tiles and block of `nook emit` for every quality,
// FOLDER/nook_slices_wgsl.js, the modules in WGSL, and FOLDER/nook_aov.js, the stages of volumes in both languages. Texts have no
// comments, few spaces and short names. Modules differ from the first by a few lines, so only these are stored for the others.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const [nook, folder] = process.argv.slice(2);
const scratch = mkdtempSync(join(tmpdir(), 'nook-ao-'));
const qualities = { low: [1, 3], medium: [1, 4], high: [3, 6] }; // slices, and steps on each side of a slice
writeFileSync(join(scratch, 'package.json'), '{"type": "module"}');
const run = (...words) => execFileSync(nook, words, { cwd: scratch, stdio: ['ignore', 'ignore', 'inherit'] });

// Lines without comments, indentation, the suffix of floats, the precision and the check of the version, which nothing here needs.
const bare = text => text.replace(/^#if !defined\(GL_ES\)[^]*?^#endif\n/m, '').replace(/^precision .*\n/gm, '').split('\n').map(line => line.replace(/\s*\/\/.*/, '').replace(/(\d\.\d+|\de-?\d+)f\b/g, '$1').trim()).filter(line => line);

// Lines without functions that nothing calls. A function whose name is in `script` is called, and so is an entry point main_NAME of it.
function withoutUnused(lines, script) {
	const uses = (text, name) => new RegExp(`\\b${name}\\b`).test(text);
	for (let at = 0; at < lines.length; ++at) {
		const [, name] = /^(?:fn|void|float|int|uint|bool|[iu]?vec[234]) (\w+)\(/.exec(lines[at]) ?? [];
		let end = at + 1, depth = lines[end] === '{' ? 1 : 0;
		if (!name || depth === 0) continue;
		while (depth > 0) depth += (lines[++end].match(/{/g) ?? []).length - (lines[end].match(/}/g) ?? []).length;
		const begin = at > 0 && lines[at - 1].startsWith('@') ? at - 1 : at, others = [...lines.slice(0, begin), ...lines.slice(end + 1)];
		if (!uses(script, name.replace(/^main_/, '')) && !others.some(line => uses(line, name))) return withoutUnused(others, script);
	}
	return lines;
}

// Spaces that nothing needs.
const dense = line => /^`?#/.test(line) ? line : line.replace(/ ?([*/%=<>!&|?:;,(){}[\]]) ?/g, '$1').replace(/ ?([-+]=?) ?(?![-+])/g, '$1');

// A script without comments and regular expressions likewise. Texts of one line keep their spaces, others are shaders, with ${} in them.
const denseScript = script => script.replace(/(`(?:[^`\\]|\\.)*`|'(?:[^'\\]|\\.)*')|[^`']+/g, (part, text) => {
	if (!text && part.includes('//')) throw new Error(`found a comment in ${part.slice(part.indexOf('//'), 80)}, expected none`);
	if (!text) return part.split('\n').map(dense).join('\n');
	if (!part.includes('\n')) return part;
	return part.split('\n').map(line => dense(line.replaceAll('}', '}\0').replaceAll('${', '\0${')).replaceAll('\0', '')).join('\n');
});

// Short names, the same in all texts, for functions and variables that no script names, and for members that nothing reads.
function shortening(texts, script) {
	const all = texts.flat().join('\n'), weights = new Map();
	const words = new Set(`${all}\n${script}`.match(/\b\w+\b/g)), members = new Set([...all.matchAll(/\.(\w+)/g)].map(([, name]) => name));
	const declared = new Set([/\b(?:let|var)(?:<\w+>)? (\w+)/g, /\b(?:float|int|uint|bool|[iu]?vec[234]) (\w+)(?=\s*[=;,)])/g, /(?:[(,] ?|^)(\w+): (?:f32|i32|u32|bool|vec)/gm, /\b(nook[A-Z]\w*)/g]
		.flatMap(kind => [...all.matchAll(kind)].map(([, name]) => name)));
	for (const name of declared) {
		const isOurs = /^nook/.test(name), isCalled = new RegExp(`\\b${name}\\(`).test(all);
		if (name.length < 2 || (isOurs ? new RegExp(`\\b${name}\\b`).test(script) : isCalled)) continue;
		weights.set(name, all.match(new RegExp(`\\b${name}\\b`, 'g')).length * name.length);
	}
	const letters = [...'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'];
	const free = [...letters, ...letters.flatMap(one => [...'0123456789'].map(digit => one + digit))].filter(name => !words.has(name));
	const short = new Map([...weights].sort((one, other) => other[1] - one[1] || (one[0] < other[0] ? -1 : 1)).map(([name], i) => [name, free[i]]));
	if (short.size > free.length) throw new Error(`found ${short.size} names to shorten, expected at most ${free.length}`);
	return lines => {
		let inBlock = false; // of members
		return lines.map(line => {
			inBlock = /^(?:struct|layout\(std140\))/.test(line) || (inBlock && !line.startsWith('}'));
			return dense(line.replace(/(?<!\.|@|@builtin\()\b\w+\b/g, word => inBlock && members.has(word) ? word : short.get(word) ?? word));
		});
	};
}

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

// Replaces a text that has to be there.
function replaced(text, from, to) {
	if (!(from instanceof RegExp ? from.test(text) : text.includes(from))) throw new Error(`nook emit: found no ${from}, expected it`);
	return text.replace(from, to);
}

const source = name => readFileSync(new URL(name, import.meta.url), 'utf8');
const untyped = text => text.replace(/\blet (\w+): (?:f32|i32|bool|vec[234][fiu]) = /g, 'let $1 = '); // WGSL infers it

// GLSL with the sine of WGSL in place of the driver's: directions that differ by a millionth move samples to other pixels.
const glslOf = async (...words) => withoutUnused(bare(replaced(replaced((await emitted(...words)).glsl, 'vec2(cos(angle), sin(angle))', 'vec2(nookSin(angle + 1.57079633), nookSin(angle))'),
	'float nookDepth(', `float nookSin(float angle)
{
	float half_turns = round(angle * 0.318309886);
	float rest = (angle - half_turns * 3.140625) - half_turns * 9.67653589793e-4;
	float z = rest * rest;
	float series = -1.6666667e-1 + z * (8.3333333e-3 + z * (-1.9841270e-4 + z * (2.7557319e-6 - z * 2.5052108e-8)));
	float sine = rest + rest * z * series;
	return mod(abs(half_turns), 2.0) > 0.5 ? -sine : sine;
}
float nookDepth(`)), source('ao.js'));

// Normals come from a texture, as NOOK_NORMAL has them in GLSL, unless depth is the device's.
function wgslOf(quality, resolution, depth) {
	const text = untyped(readFileSync(emit(quality, resolution, depth, ['wgsl', '--wgsl', '--main', 'fragment']), 'utf8'));
	return withoutUnused(bare(depth === 'device' ? text : replaced(text, /(fn nookNormal\(pixel: vec2i\) -> vec3f\n\{\n)\treturn nookNormalFromDepth\(pixel\);/,
		'@group(0) @binding(2) var nook_normals: texture_2d<f32>;\n$1\treturn normalize(textureLoad(nook_normals, pixel, 0).xyz * 2.0f - 1.0f);')), source('webgpu.js'));
}

// The stages that draw volumes of the layout polygons, with all faces; normals as above.
function volumeStages() {
	const files = ['glsl --glsl es300', 'wgsl --wgsl'].map(language => {
		const [ending, ...words] = language.split(' ');
		run('emit', '--methods', 'aov', ...words, '-o', `aov.${ending}`);
		return readFileSync(join(scratch, `aov.${ending}`), 'utf8');
	});
	const wgsl = replaced(replaced(untyped(files[1]), /return nook_faces == 0.*/, 'return true;'), 'return textureLoad(nook_normals, pixel, 0).xyz;', 'return normalize(textureLoad(nook_normals, pixel, 0).xyz * 2.0 - 1.0);');
	return [withoutUnused(without(bare(files[0]), ['NOOK_SPARSE', 'NOOK_CHOOSE_FACES', 'NOOK_PRISMS']), 'main'),
		withoutUnused(bare(wgsl.replace(/.*\bvar(?:<uniform>)? nook_(?:faces|cells)\b.*\n/g, '')), 'nook_vertex nook_fragment nook_resolve nook_triangle')];
}

// The modules of every quality, name to lines: those at half resolution end in _half.
async function modulesOf(of) {
	const made = { lines: await of('medium', 'full', 'linear'), half: await of('medium', 'half', 'linear'), device: await of('medium', 'full', 'device') };
	for (const quality of Object.keys(qualities)) {
		made[quality] = await of(quality, 'full', 'linear');
		made[`${quality}_half`] = await of(quality, 'half', 'linear');
	}
	return made;
}

// The modules as JavaScript: the text of `medium`, and hunks for the others; those at half resolution follow the hunks of `half`.
function stored({ lines, half, ...modules }) {
	const changes = { half: hunksOf(lines, half) };
	for (const [name, wanted] of Object.entries(modules)) {
		const from = name.endsWith('_half') ? half : lines, made = [...from];
		changes[name] = hunksOf(from, wanted);
		for (const [at, removed, ...inserted] of changes[name]) made.splice(at, removed, ...inserted);
		if (made.join('\n') !== wanted.join('\n')) throw new Error(`${name}: found hunks that make another module`);
	}
	return { lines: JSON.stringify(lines.join('\n')), changes: JSON.stringify(changes) };
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
const tileOf = name => JSON.stringify(tiles[name]);
if (tileOf('low') !== tileOf('medium')) throw new Error('found another tile for low than for medium');

// The block's code as nook emits it, up to the first method, without comments and the export of the text; without the check of settings,
// which the package's own options have passed; without members that no shader of the package reads. Members are elements of an array.
function blockCode(script, members, shaders) {
	const places = Object.fromEntries(members.filter(({ name }) => shaders.includes(`nook.${name}`)).map(({ name, offset }) => [name, offset / 4]));
	let text = script.replace(/\/\*\*[\s\S]*?\*\//g, '');
	text = text.slice(0, text.search(/^export const slices\b/m)).split('\n').slice(2).map(line => line.replace(/(^|[\s{},;])\/\/(?: .*)?$/, '$1').trimEnd()).join('\n');
	text = text.replace(/^\t(?:const (?:steps|sums|longer)\b|depth\.(?:half_step|rounding) =).*\n/gm, ''); // errors of depth, which slices do not read
	text = replaced(text, /^\tconst wrong_projection[^]*?\t}\n/m, "\tconst fault = faultOf(p);\n\tif (fault) return `projection: ${fault}`;\n");
	text = replaced(replaced(text, /^\tconst wrong_settings[\s\S]*?^\t}\n/m, ''), /^export const members[\s\S]*?^\];\n/m, '').replace(/^export const blockBytes.*\n/m, '');
	text = text.replace(/^\tblock\.(\w+)\b.*\n/gm, (line, name) => name in places ? line : '')
		.replace(/\bblock\.(\w+)\[(\w+)\]/g, (member, name, index) => `block[${/\d/.test(index) ? places[name] + +index : `${places[name]} + ${index}`}]`)
		.replace(/\bblock\.(\w+) = /g, (member, name) => `block[${places[name]}] = `).replace(/\bblock\.(\w+)\b/g, (member, name) => `block.subarray(${places[name]})`);
	text = replaced(text, /^export function fill[\s\S]*?^}\n/m, `export function fill(owner, projection, settings) {
const block = new Float32Array(48), reason = nook_fill(block, projection, { ...defaults, ...settings });
if (reason) throw new RangeError(\`\${owner}: camera: \${reason}\`);
return block;
}
`);
	for (let before = ''; before !== text;) { // functions and defaults that nothing uses now
		before = text;
		text = text.replace(/^function (\w+)\([\s\S]*?^}\n/gm, (whole, name) => text.split(name).length > 2 ? whole : '')
			.replace(/^const (\w+) = \[.*\n/gm, (line, name) => text.split(name).length > 2 ? line : '')
			.replace(/^\t(\w+): [^{\n]*,\n/gm, (line, name) => text.includes(`settings.${name}`) ? line : '');
	}
	return text.split('\n').map(line => line.trim()).filter(line => line).join('\n');
}

const { radius, slice_thickness, strength, power } = base.slices.settings(1);
const glsl = await modulesOf(glslOf), wgsl = await modulesOf(wgslOf), volumes = volumeStages();
const scripts = ['ao.js', 'webgpu.js', 'volumes.js', 'volumes_gl.js'].map(source).join('\n');
const short = shortening([...Object.values(glsl), ...Object.values(wgsl), ...volumes], `${scripts} nook_vertex`);
const shortened = modules => Object.fromEntries(Object.entries(modules).map(([name, lines]) => [name, short(lines)]));
const [glslCode, wgslCode] = [glsl, wgsl].map(modules => stored(shortened(modules)));
const head = '// SPDX-License-Identifier: MIT\n// Made by nook emit; names are shortened.\n';
const shaders = [...Object.values(glsl), ...Object.values(wgsl)].flat().join('\n') + scripts;
// The text in GLSL comes first here and the one in WGSL last in the file before it in the package, since similar texts that are close
// to each other compress better.
writeFileSync(join(folder, 'nook_slices.js'), `${head}import { faultOf } from './volumes_file.js';
const lines = ${glslCode.lines};
const changes = ${glslCode.changes};
${returning('glslOf', "The GLSL of a quality, 'low' to 'high', at half resolution with '_half' added; 'device' reads a depth buffer instead of linear depth.")}/** The samples of a quality's tile. */
const tile = ${tileOf('medium')};
export const tiles = { low: tile, medium: tile, high: ${tileOf('high')} };
/** The settings of the recipe for rays of one metre. */
export const recipe = ${JSON.stringify({ radius, slice_thickness, strength, power })};
${denseScript(blockCode(readFileSync(join(scratch, 'medium_full_linear.js'), 'utf8'), base.members, shaders))}
`);
writeFileSync(join(folder, 'nook_slices_wgsl.js'), `${head}const changes = ${wgslCode.changes};
${returning('wgslOf', 'The WGSL of a quality, as glslOf() of nook_slices.js, with entry points and normals from a texture.')}const lines = ${wgslCode.lines};
`);
const [glslStages, wgslStages] = volumes.map(lines => JSON.stringify(short(lines).join('\n')));
writeFileSync(join(folder, 'nook_aov.js'), `${head}/** The stages that draw volumes. */
export const glsl = ${glslStages};
export const wgsl = ${wgslStages};
`);
for (const name of readdirSync(folder).filter(one => /^(?!nook_).*\.js$/.test(one))) {
	const [licence, ...lines] = readFileSync(join(folder, name), 'utf8').split('\n');
	writeFileSync(join(folder, name), [licence, denseScript(lines.join('\n'))].join('\n'));
}
rmSync(scratch, { recursive: true });
