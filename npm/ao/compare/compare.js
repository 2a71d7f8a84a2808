// SPDX-License-Identifier: MIT
// Draws each contestant's visibility on each scene, compares it with rays, and times all in turns. Query: rounds=N (timing, default 5,
// 0 for none); gpu=N, see timed(); scale=N, pictures of 1/N the width and height. fit() searches a rival's settings.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { EffectComposer } from 'three/addons/postprocessing/EffectComposer.js';
import { GTAOPass } from 'three/addons/postprocessing/GTAOPass.js';
import { FullScreenQuad } from 'three/addons/postprocessing/Pass.js';
import { RenderPass } from 'three/addons/postprocessing/RenderPass.js';
import { SAOPass } from 'three/addons/postprocessing/SAOPass.js';
import { N8AOPass } from 'n8ao';
import { NookPass } from 'nook-ao';

const query = new URLSearchParams(location.search);
const scale = +(query.get('scale') ?? 1);
const width = 1280 / scale, height = 720 / scale;
const state = document.querySelector('#state');
const renderer = new THREE.WebGLRenderer();
renderer.setSize(width, height);

// A TIFF of 32-bit floats without compression, every `scale`th pixel.
async function floatsOf(address) {
	const bytes = await (await fetch(address)).arrayBuffer();
	const view = new DataView(bytes);
	const small = view.getUint16(0) === 0x4949;
	const list = view.getUint32(4, small);
	const tags = new Map();
	for (let i = 0; i < view.getUint16(list, small); ++i) {
		const at = list + 2 + 12 * i, kind = view.getUint16(at + 2, small), count = view.getUint32(at + 4, small), size = kind === 3 ? 2 : 4;
		const from = count * size > 4 ? view.getUint32(at + 8, small) : at + 8;
		tags.set(view.getUint16(at, small), Array.from({ length: count }, (_, k) => size === 2 ? view.getUint16(from + 2 * k, small) : view.getUint32(from + 4 * k, small)));
	}
	const strips = tags.get(273), counts = tags.get(279);
	const all = new Uint8Array(counts.reduce((sum, one) => sum + one, 0));
	let at = 0;
	strips.forEach((strip, i) => {
		all.set(new Uint8Array(bytes, strip, counts[i]), at);
		at += counts[i];
	});
	const values = new Float32Array(all.buffer);
	return Float32Array.from({ length: width * height }, (_, i) => values[scale * (Math.floor(i / width) * width * scale + i % width)]);
}

async function loaded({ name, file, radius }) {
	const [level, summary, rays, depths] = await Promise.all([new GLTFLoader().loadAsync(`made/${file}`), fetch(`made/${name}.json`).then(one => one.json()),
		floatsOf(`made/${name}_ref.tif`), floatsOf(`made/${name}_z.tif`)]);
	level.scene.traverse(node => {
		if (!node.isMesh) return;
		const { map, alphaTest, side } = node.material;
		node.material = new THREE.MeshLambertMaterial({ map: alphaTest > 0 ? map : null, alphaTest, side });
	});
	const scene = new THREE.Scene().add(level.scene, new THREE.HemisphereLight(0xffffff, 0x888888, 3));
	scene.background = new THREE.Color(0x9db8d8);
	const matrix = which => summary.matrices.find(one => one.name === which).values;
	const fov = 2 * Math.atan(1 / matrix('projection64')[5]) * 180 / Math.PI;
	const camera = new THREE.PerspectiveCamera(fov, width / height, 0.1, 200);
	new THREE.Matrix4().fromArray(matrix('worldToCamera64')).invert().decompose(camera.position, camera.quaternion, camera.scale);
	camera.updateMatrixWorld();
	return { name, radius, scene, camera, rays, depths, counted: null };
}

// Contestants: make() returns the passes, how to set what was fitted to rays, and how to show only the visibility. axes: the
// settings to search, lengths in radii; curve: the last setting, k, which is applied to the visibility and needs no drawing.
const n8 = (quality, half = false) => ({
	make({ scene, camera, radius }) {
		const pass = new N8AOPass(scene, camera, width, height);
		pass.setQualityMode(quality);
		Object.assign(pass.configuration, { halfRes: half, gammaCorrection: false });
		return {
			passes: [pass],
			// The neural denoiser has another radius.
			set: ({ r, falloff, denoising = pass.configuration.denoiseRadius, k }) =>
				Object.assign(pass.configuration, { aoRadius: r * radius, distanceFalloff: falloff, denoiseRadius: denoising, intensity: k }),
			only: () => { pass.configuration.renderMode = 1; },
		};
	},
	axes: { r: [0.25, 0.35, 0.5, 0.7, 1], falloff: [0.125, 0.25, 0.5, 1, 2], ...(quality.startsWith('Neural') ? {} : { denoising: [3, 6, 12] }) },
	start: { r: 0.7, falloff: 0.5, ...(quality.startsWith('Neural') ? {} : { denoising: 6 }) },
	curve: (v, k) => v ** k,
});
const gtao = (samples, denoise) => ({
	make({ scene, camera, radius }) {
		const pass = new GTAOPass(scene, camera, width, height, undefined, { samples }, { samples: denoise });
		return {
			passes: [new RenderPass(scene, camera), pass],
			set: ({ r, thickness, exponent, falloff, denoising, k }) => {
				pass.updateGtaoMaterial({ radius: r * radius, thickness: thickness * radius, distanceExponent: exponent, distanceFallOff: falloff, scale: k });
				pass.updatePdMaterial({ radius: denoising });
			},
			only: () => { pass.output = GTAOPass.OUTPUT.Denoise; },
		};
	},
	axes: { r: [0.35, 0.5, 0.7, 1, 1.4], thickness: [0.25, 0.5, 1, 2, 4], exponent: [1, 1.5, 2], falloff: [0, 0.5, 1], denoising: [4, 8, 12] },
	start: { r: 1, thickness: 1, exponent: 1, falloff: 1, denoising: 8 },
	curve: (v, k) => v ** k,
});
const sao = () => ({
	make({ scene, camera, radius }) {
		const pass = new SAOPass(scene, camera, new THREE.Vector2(width, height));
		return {
			passes: [new RenderPass(scene, camera), pass],
			set: ({ kernel, scale, bias, cutoff, k }) => Object.assign(pass.params,
				{ saoKernelRadius: kernel, saoScale: scale * camera.far / radius, saoBias: bias, saoBlurDepthCutoff: cutoff, saoIntensity: k }),
			only: () => { pass.params.output = SAOPass.OUTPUT.SAO; },
		};
	},
	axes: { kernel: [15, 30, 60, 100, 160], scale: [0.01, 0.03, 0.1, 0.3, 1, 3], bias: [0, 0.1, 0.5, 1], cutoff: [0.0005, 0.002, 0.01] },
	start: { kernel: 60, scale: 0.3, bias: 0.1, cutoff: 0.002 },
	curve: (v, k) => Math.max(0, 1 - k * (1 - v)),
});
const nook = (options) => ({
	make({ scene, camera, radius }) {
		const pass = new NookPass(scene, camera, width, height, { radius, ...options });
		return { passes: [pass], set: () => {}, only: () => { pass.view = 'visibility'; } };
	},
});
export const contestants = {
	'NookPass low, half': nook({ quality: 'low', halfResolution: true }),
	'NookPass medium, half': nook({ quality: 'medium', halfResolution: true }),
	'NookPass low': nook({ quality: 'low' }),
	'NookPass medium': nook({ quality: 'medium' }),
	'NookPass high': nook({ quality: 'high' }),
	'n8ao Performance, half': n8('Performance', true),
	'n8ao Medium, half': n8('Medium', true),
	'n8ao Performance': n8('Performance'),
	'n8ao Medium': n8('Medium'),
	'n8ao Ultra': n8('Ultra'),
	'n8ao Neural-Performance': n8('Neural-Performance'),
	'n8ao Neural-Medium': n8('Neural-Medium'),
	'GTAOPass, 8 samples': gtao(8, 8),
	'GTAOPass, 16 samples': gtao(16, 16),
	'SAOPass': sao(),
};

const half = Float32Array.from({ length: 65536 }, (_, i) => THREE.DataUtils.fromHalfFloat(i));

function composerOf(made) {
	const composer = new EffectComposer(renderer, new THREE.WebGLRenderTarget(width, height, { type: THREE.HalfFloatType }));
	composer.renderToScreen = false;
	for (const pass of made.passes) composer.addPass(pass);
	return composer;
}

function free(made, composer) {
	for (const pass of made.passes) pass.dispose();
	composer.dispose();
}

// Visibility that the composer drew last, rows from the top.
function readBack(composer) {
	const texels = new Uint16Array(4 * width * height);
	renderer.readRenderTargetPixels(composer.readBuffer, 0, 0, width, height, texels);
	const values = new Float32Array(width * height);
	for (let i = 0; i < values.length; ++i) values[i] = half[texels[4 * ((height - 1 - Math.floor(i / width)) * width + i % width)]];
	return values;
}

// A contestant on a scene, set up as fitted, showing only its visibility. They stay, so that their programs are compiled once.
const ready = new Map();
function readyOf(name, scene) {
	const key = `${name}, ${scene.name}`;
	if (!ready.has(key)) {
		const made = contestants[name].make(scene);
		made.set(settings[name]);
		made.only();
		ready.set(key, composerOf(made));
	}
	return ready.get(key);
}

export function drawn(name, scene) {
	const composer = readyOf(name, scene);
	composer.render(0);
	return readBack(composer);
}

// Pixels that show the surface that the rays began at: depth within 1 %.
function agreeing(scene) {
	const pass = new NookPass(scene.scene, scene.camera, width, height);
	const composer = composerOf({ passes: [pass] });
	composer.render(0);
	const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType, depthBuffer: false });
	const quad = new FullScreenQuad(new THREE.ShaderMaterial({ uniforms: { depths: { value: pass._ao.depths } }, vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
		fragmentShader: 'uniform highp sampler2D depths; void main() { gl_FragColor = vec4(texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r); }' }));
	renderer.setRenderTarget(target);
	quad.render(renderer);
	const texels = new Float32Array(4 * width * height);
	renderer.readRenderTargetPixels(target, 0, 0, width, height, texels);
	let count = 0, surfaces = 0;
	const counted = new Uint8Array(width * height);
	for (let i = 0; i < counted.length; ++i) {
		const z = texels[4 * ((height - 1 - Math.floor(i / width)) * width + i % width)];
		if (!(scene.depths[i] < 1e10)) continue;
		++surfaces;
		if (Math.abs(z - scene.depths[i]) < 0.01 * scene.depths[i]) counted[i] = 1, ++count;
	}
	free({ passes: [pass] }, composer);
	target.dispose();
	return { counted, share: count / surfaces };
}

export function rmse({ rays, counted }, values, curve = v => v, step = 1) {
	let sum = 0, count = 0;
	for (let i = 0; i < rays.length; i += step) {
		if (!counted[i]) continue;
		sum += (curve(values[i]) - rays[i]) ** 2;
		++count;
	}
	return Math.sqrt(sum / count);
}

const later = () => new Promise(done => setTimeout(done, 0));
const mean = values => values.reduce((sum, one) => sum + one, 0) / values.length;

// The settings of least mean error over the scenes: one axis after the other, twice; k for each try by golden section.
export async function fit(name, told = () => {}) {
	const contestant = contestants[name];
	const best = { error: Infinity, settings: contestant.start };
	const tried = new Set();
	const made = scenes.map(scene => contestant.make(scene));
	for (const one of made) one.only();
	const composers = made.map(composerOf);
	async function tryOut(settings) {
		const key = JSON.stringify(settings);
		if (tried.has(key)) return;
		tried.add(key);
		const pictures = [];
		for (const [i, composer] of composers.entries()) {
			made[i].set({ ...settings, k: 1 });
			composer.render(0);
			pictures.push(readBack(composer));
			await later();
		}
		const error = k => mean(scenes.map((scene, i) => rmse(scene, pictures[i], v => contestant.curve(v, k), 7)));
		let low = -4, high = 3;
		for (let i = 0; i < 14; ++i) {
			const a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
			if (error(Math.exp(a)) < error(Math.exp(b))) high = b; else low = a;
		}
		const k = +Math.exp((low + high) / 2).toPrecision(3);
		told(`${key} ${error(k)}`);
		if (error(k) < best.error) Object.assign(best, { error: error(k), settings: { ...settings, k } });
	}
	for (let round = 0; round < 2; ++round) {
		for (const [axis, values] of Object.entries(contestant.axes)) {
			const { k, ...around } = best.settings;
			for (const value of values) await tryOut({ ...around, [axis]: value });
		}
	}
	made.forEach((one, i) => free(one, composers[i]));
	return best;
}

// Milliseconds of a frame without those of a RenderPass, as the median of `rounds` in turns, and the least. gpu: number of the
// browser's process that draws, whose processor time is taken in place of the clock, as serve.js tells it; for busy machines.
async function timed(scene, rounds, gpu, frames = 2) {
	const clock = async () => gpu ? +await (await fetch(`cpu/${gpu}`)).text() : performance.now();
	const runs = [{ name: 'scene', composer: composerOf({ passes: [new RenderPass(scene.scene, scene.camera)] }), times: [] }];
	for (const name of Object.keys(contestants)) runs.push({ name, composer: readyOf(name, scene), times: [] });
	const texel = new Uint16Array(4);
	for (let round = -1; round < rounds; ++round) {
		for (const run of runs) {
			const began = await clock();
			for (let i = 0; i < frames; ++i) {
				run.composer.render(0);
				renderer.readRenderTargetPixels(run.composer.readBuffer, 0, 0, 1, 1, texel);
			}
			if (round >= 0) run.times.push((await clock() - began) / frames);
			await later();
		}
	}
	const median = values => [...values].sort((a, b) => a - b)[values.length >> 1];
	const alone = runs[0].times;
	return Object.fromEntries(runs.slice(1).map(({ name, times }) =>
		[name, { median: median(times) - median(alone), least: Math.min(...times) - Math.min(...alone) }]));
}

function picture(values, caption) {
	const canvas = Object.assign(document.createElement('canvas'), { width, height, className: 'picture' });
	const context = canvas.getContext('2d');
	const image = context.createImageData(width, height);
	values.forEach((value, i) => image.data.set([255 * value, 255 * value, 255 * value, 255], 4 * i));
	context.putImageData(image, 0, 0);
	const figure = document.createElement('figure');
	figure.append(canvas, Object.assign(document.createElement('figcaption'), { textContent: caption }));
	return figure;
}

export const listed = await (await fetch('made/scenes.json')).json();
export const scenes = [];
for (const one of listed) {
	const scene = await loaded(one);
	Object.assign(scene, agreeing(scene));
	scenes.push(scene);
}
export const settings = await (await fetch('settings.json')).json();

export async function all(rounds, gpu = 0, picked = scenes) {
	const results = [];
	for (const scene of picked) {
		state.textContent = `Drawing ${scene.name}…`;
		await later();
		const row = { scene: scene.name, radius: scene.radius, share: scene.share, errors: {}, times: {} };
		const box = Object.assign(document.createElement('div'), { className: 'pictures' });
		box.append(picture(scene.rays, 'rays'));
		for (const name of Object.keys(contestants)) {
			const values = drawn(name, scene);
			row.errors[name] = rmse(scene, values);
			box.append(picture(values, `${name}: RMSE ${row.errors[name].toFixed(4)}`));
			await later();
		}
		if (rounds > 0) row.times = await timed(scene, rounds, gpu);
		results.push(row);
		const table = document.createElement('table');
		table.innerHTML = `<caption>${scene.name}, radius ${scene.radius} m</caption><tr><th>pass<th>RMSE<th>ms, median<th>ms, least</tr>`;
		for (const name of Object.keys(contestants)) {
			const cells = [name, row.errors[name].toFixed(4), row.times[name]?.median.toFixed(1) ?? '', row.times[name]?.least.toFixed(1) ?? ''];
			const line = table.insertRow();
			for (const cell of cells) line.insertCell().textContent = cell;
		}
		document.querySelector('#results').append(Object.assign(document.createElement('h2'), { textContent: scene.name }), table, box);
	}
	state.textContent = `${width} x ${height}, ${renderer.getContext().getParameter(renderer.getContext().RENDERER)}`;
	return results;
}
if (query.has('rounds')) await all(+query.get('rounds'), query.get('gpu'));
document.documentElement.dataset.drawn = 'yes';
