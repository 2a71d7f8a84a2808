// SPDX-License-Identifier: GPL-3.0-or-later
// Draws with nook-ao/webgpu and with NookPass in WebGL 2. globalThis.said: differences of their pictures, and what is refused.
import * as THREE from 'three';
import * as GPU from 'three/webgpu';
import { vec4 } from 'three/tsl';
import { EffectComposer } from 'three/addons/postprocessing/EffectComposer.js';
import { NookPass } from 'nook-ao';
import { nookPass } from 'nook-ao/webgpu';
import { cameraOf, sceneOf } from './scene.js';

// With an odd height, every second row from the top is every second from the bottom: both half resolutions take the same pixels.
const width = 192, height = 109;
const said = { refused: [] };
const refusal = call => {
	try {
		call();
		return 'nothing refused';
	} catch (error) {
		return `${error.name}: ${error.message}`;
	}
};
const rendererOf = async options => {
	const renderer = new GPU.WebGPURenderer(options);
	renderer.setSize(width, height);
	await renderer.init();
	return renderer;
};
const perspective = () => cameraOf(new THREE.PerspectiveCamera(50, width / height, 0.1, 100));
const parallel = () => cameraOf(new THREE.OrthographicCamera(-4, 4, 2.27, -2.27, 0.1, 100));
const gl = new THREE.WebGLRenderer(), three = await rendererOf();
gl.setSize(width, height);
said.webgpu = three.backend.isWebGPUBackend === true;

// Pictures as numbers, rows from the top.
function withGl(options, camera = perspective(), scene = sceneOf().scene) {
	const pass = new NookPass(scene, camera, width, height, options);
	const composer = new EffectComposer(gl, new THREE.WebGLRenderTarget(width, height, { type: THREE.HalfFloatType }));
	composer.renderToScreen = false;
	composer.addPass(pass);
	composer.render(0);
	const texels = new Uint16Array(4 * width * height);
	gl.readRenderTargetPixels(composer.readBuffer, 0, 0, width, height, texels);
	pass.dispose();
	composer.dispose();
	return Float32Array.from({ length: width * height }, (_, i) => THREE.DataUtils.fromHalfFloat(texels[4 * ((height - 1 - Math.floor(i / width)) * width + i % width)]));
}

async function pictureOf(renderer, pipeline) {
	await new Promise(requestAnimationFrame); // three.js updates nodes once per frame of the browser
	const target = new GPU.RenderTarget(width, height, { type: GPU.FloatType });
	renderer.setRenderTarget(target);
	pipeline.render();
	renderer.setRenderTarget(null);
	const texels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height);
	target.dispose();
	return Float32Array.from({ length: width * height }, (_, i) => texels[4 * i]);
}

function pipelineOf(renderer, node, visibility) {
	const pipeline = new GPU.RenderPipeline(renderer, visibility ? vec4(node.getVisibilityNode()) : node);
	pipeline.outputColorTransform = false;
	return pipeline;
}

async function withGpu(options, { camera = perspective(), renderer = three, visibility = true, scene = sceneOf().scene } = {}) {
	const node = nookPass(scene, camera, options);
	const picture = await pictureOf(renderer, pipelineOf(renderer, node, visibility));
	node.dispose();
	node.dispose();
	return picture;
}

// The greatest difference, and the share of pixels beyond 2/255.
function apart(a, b) {
	const differences = Array.from(a, (one, i) => Math.abs(one - b[i]));
	return [Math.max(...differences), differences.filter(one => !(one <= 2 / 255)).length / differences.length];
}

const seen = { view: 'visibility' };
for (const quality of ['low', 'medium', 'high']) {
	for (const halfResolution of [false, true]) {
		said[`${quality}${halfResolution ? 'Half' : ''}`] = apart(withGl({ quality, halfResolution, ...seen }), await withGpu({ quality, halfResolution }));
	}
}
const base = await withGpu();
said.shadowed = base.reduce((sum, one) => sum + one, 0) / base.length;
said.colours = apart(withGl({}), await withGpu({}, { visibility: false }));
said.tint = apart(withGl({ tint: 0x408000 }), await withGpu({ tint: 0x408000 }, { visibility: false }));
said.radius = apart(withGl({ radius: 0.5, intensity: 2, ...seen }), await withGpu({ radius: 0.5, intensity: 2 }));
said.sky = apart(withGl({ sky: 5, ...seen }), await withGpu({ sky: 5 }));
said.orthographic = apart(withGl(seen, parallel()), await withGpu({}, { camera: parallel() }));
// Glass in front of everything: over the obscurance, or darkened with it.
const withGlass = () => {
	const { scene, box } = sceneOf();
	box(0, 1, 1, 2, 2, 0.02, new THREE.MeshBasicMaterial({ color: 0xffffff, transparent: true, opacity: 0.5, depthWrite: false }));
	return scene;
};
const glass = await withGpu({}, { visibility: false, scene: withGlass() });
said.transparent = apart(withGl({}, perspective(), withGlass()), glass);
said.darkened = apart(await withGpu({ excludeTransparent: false }, { visibility: false, scene: withGlass() }), glass);
const reversed = await rendererOf({ reversedDepthBuffer: true });
said.reversed = apart(base, await withGpu({}, { renderer: reversed }));
reversed.dispose();

// Options of a node that is in use, other sizes.
{
	const node = nookPass(sceneOf().scene, perspective());
	const pipeline = pipelineOf(three, node, true);
	await pictureOf(three, pipeline);
	node.quality = 'high';
	said.changed = apart(await withGpu({ quality: 'high' }), await pictureOf(three, pipeline));
	node.quality = 'medium';
	three.setSize(64, 48);
	three.setRenderTarget(new GPU.RenderTarget(64, 48));
	pipeline.render();
	three.setRenderTarget(null);
	three.setSize(width, height);
	said.resized = apart(base, await pictureOf(three, pipeline));
	three.setSize(0, 0);
	said.empty = apart(base, await pictureOf(three, pipeline)); // the last picture stays
	three.setSize(width, height);
	said.filled = apart(base, await pictureOf(three, pipeline));
	node.dispose();
	const second = nookPass(sceneOf().scene, perspective()), started = pipelineOf(three, second, true);
	three.setSize(0, 0);
	await pictureOf(three, started);
	three.setSize(width, height);
	said.started = apart(base, await pictureOf(three, started));
	second.dispose();
}
// Two nodes in one pipeline, whose visibilities multiply.
{
	const { scene } = sceneOf(), camera = perspective();
	const nodes = [0.5, 2].map(radius => nookPass(scene, camera, { radius }));
	const [near, far] = nodes.map(node => node.getVisibilityNode());
	const pipeline = new GPU.RenderPipeline(three, vec4(near.mul(far)));
	pipeline.outputColorTransform = false;
	const both = await pictureOf(three, pipeline), second = await withGpu({ radius: 2 });
	said.both = apart((await withGpu({ radius: 0.5 })).map((one, i) => one * second[i]), both);
	for (const node of nodes) node.dispose();
}
// A projection without a far plane that was set by hand; the renderer would compute it again for another coordinate system.
{
	const camera = perspective();
	camera.coordinateSystem = THREE.WebGPUCoordinateSystem;
	Object.assign(camera.projectionMatrix.elements, { 10: -1, 14: -0.1 });
	camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
	said.infinite = apart(base, await withGpu({}, { camera }));
}
const { scene } = sceneOf();
said.refused.push(refusal(() => nookPass(scene, perspective(), { radius: 0 })), refusal(() => nookPass(scene, perspective(), { temporal: true })));
const other = new GPU.WebGPURenderer({ forceWebGL: true });
await other.init();
said.refused.push(refusal(() => pipelineOf(other, nookPass(scene, perspective()), true).render()));
const logarithmic = await rendererOf({ logarithmicDepthBuffer: true });
said.refused.push(refusal(() => pipelineOf(logarithmic, nookPass(scene, perspective()), true).render()));
// Last: after an error in a frame of a canvas, Chromium draws no more.
const unlimited = cameraOf(new THREE.PerspectiveCamera(50, width / height, 0.1, Infinity));
said.refused.push(refusal(() => pipelineOf(three, nookPass(scene, unlimited), true).render()));
globalThis.said = said;
