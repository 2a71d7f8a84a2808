// SPDX-License-Identifier: GPL-3.0-or-later
// Draws with nook-ao/webgpu and with NookPass in WebGL 2. globalThis.said: differences of their pictures, and what is refused.
import * as THREE from 'three';
import * as GPU from 'three/webgpu';
import { vec4 } from 'three/tsl';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { EffectComposer } from 'three/addons/postprocessing/EffectComposer.js';
import { NookPass, NookVolumes as GlVolumes } from 'nook-ao';
import { nookPass, NookVolumes } from 'nook-ao/webgpu';
import { cameraOf, sceneOf } from './scene.js';

// With an odd height, every second row from the top is every second from the bottom: both half resolutions take the same pixels.
const width = 192, height = 109;
const said = { refused: [] }, refusedLast = [];
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

// Pictures as numbers, rows from the top. moves: called before each frame after the first.
function withGl(options, camera = perspective(), scene = sceneOf().scene, moves = []) {
	const pass = new NookPass(scene, camera, width, height, options);
	const composer = new EffectComposer(gl, new THREE.WebGLRenderTarget(width, height, { type: THREE.HalfFloatType }));
	composer.renderToScreen = false;
	composer.addPass(pass);
	composer.render(0);
	for (const move of moves) {
		move(camera);
		composer.render(0);
	}
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

async function withGpu(options, { camera = perspective(), renderer = three, visibility = true, scene = sceneOf().scene, moves = [] } = {}) {
	const node = nookPass(scene, camera, options), pipeline = pipelineOf(renderer, node, visibility);
	let picture = await pictureOf(renderer, pipeline);
	for (const move of moves) {
		move(camera);
		picture = await pictureOf(renderer, pipeline);
	}
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
// The other views, and a half of the picture without obscurance.
for (const view of ['off', 'split', 'visibility', 'normals', 'depth']) said[view] = apart(withGl({ view }), await withGpu({ view }, { visibility: false }));
said.half = apart(await withGpu({ view: 'split' }, { visibility: false }), await withGpu({}, { visibility: false }));
// Objects of layer 3, one of which casts a shadow: drawn over the obscurance, or with it.
const layered = () => {
	const { scene, box } = sceneOf();
	for (const one of [box(-0.4, 0.6, 0.6, 0.6, 1.2, 0.6), box(1.5, 0.3, 1.2, 0.6, 0.6, 0.6)]) one.layers.set(3);
	scene.children.at(-1).castShadow = true;
	return scene;
};
const both = () => {
	const camera = perspective();
	camera.layers.enable(3);
	return camera;
};
const over = await withGpu({ excludeLayers: [3] }, { visibility: false, scene: layered(), camera: both() });
said.layers = apart(withGl({ excludeLayers: [3] }, both(), layered()), over);
said.included = apart(await withGpu({}, { visibility: false, scene: layered(), camera: both() }), over);
// Means of frames: of a still camera, and of one that moves and turns.
const still = Array.from({ length: 7 }, () => () => {});
const moves = still.map(() => camera => {
	camera.position.x += 0.04;
	camera.rotation.y += 0.01;
	camera.updateMatrixWorld();
});
const mean = await withGpu({ temporal: true }, { moves: still });
said.temporal = apart(withGl({ temporal: true, ...seen }, perspective(), sceneOf().scene, still), mean);
said.averaged = apart(base, mean);
said.moved = apart(withGl({ temporal: true, halfResolution: true, ...seen }, perspective(), sceneOf().scene, moves), await withGpu({ temporal: true, halfResolution: true }, { moves }));
// Volumes: as in WebGL, by a depth buffer of either direction, and darker than the screen alone.
const reversed = await rendererOf({ reversedDepthBuffer: true });
{
	const { scene: level, cameras } = await new GLTFLoader().loadAsync('baked.glb'), room = new THREE.Scene().add(level, new THREE.HemisphereLight());
	room.updateMatrixWorld(true);
	const inside = () => {
		const camera = new THREE.PerspectiveCamera(cameras[0].fov, width / height, 0.1, 100);
		cameras[0].matrixWorld.decompose(camera.position, camera.quaternion, camera.scale);
		camera.updateMatrixWorld();
		return camera;
	};
	const file = await (await fetch('volumes.glb')).arrayBuffer(), volumes = new NookVolumes(file);
	const lower = await withGpu({ volumes }, { scene: room, camera: inside() });
	const known = new GlVolumes(file);
	said.volumes = apart(withGl({ volumes: known, ...seen }, inside(), room), lower);
	said.volumesReversed = apart(lower, await withGpu({ volumes }, { scene: room, camera: inside(), renderer: reversed }));
	said.screen = apart(await withGpu({}, { scene: room, camera: inside() }), lower);
	said.refused.push(refusal(() => nookPass(room, inside(), { volumes: known })));
	volumes.dispose();
	volumes.dispose();
	refusedLast.push(() => nookPass(room, inside(), { volumes }));
}
said.reversed = apart(base, await withGpu({}, { renderer: reversed }));

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
said.refused.push(refusal(() => nookPass(scene, perspective(), { radius: 0 })), refusal(() => nookPass(scene, perspective(), { samples: 4 })));
const other = new GPU.WebGPURenderer({ forceWebGL: true });
await other.init();
said.refused.push(refusal(() => pipelineOf(other, nookPass(scene, perspective()), true).render()));
const logarithmic = await rendererOf({ logarithmicDepthBuffer: true });
said.refused.push(refusal(() => pipelineOf(logarithmic, nookPass(scene, perspective()), true).render()));
// Last: after an error in a frame of a canvas, Chromium draws no more.
const unlimited = cameraOf(new THREE.PerspectiveCamera(50, width / height, 0.1, Infinity));
refusedLast.push(() => nookPass(scene, unlimited));
for (const make of refusedLast) {
	const node = make();
	said.refused.push(refusal(() => pipelineOf(three, node, true).render()));
	node.dispose();
}
// A lost device draws nothing and says so once. In headless Chromium the page's other contexts are lost with it.
const node = nookPass(sceneOf().scene, perspective()), { device } = reversed.backend;
reversed.setRenderTarget(new GPU.RenderTarget(width, height)); // not a canvas, for which Chromium would wait
pipelineOf(reversed, node, true).render();
said.texts = [];
console.error = () => {};
console.warn = text => said.texts.push(text);
device.destroy();
await device.lost;
for (let i = 0; i < 3; ++i) said.refused.push(refusal(() => node.updateBefore({ renderer: reversed })));
said.refused.push(refusal(() => node.dispose()), refusal(() => node.dispose()));
globalThis.said = said;
