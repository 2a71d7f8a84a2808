// SPDX-License-Identifier: GPL-3.0-or-later
// Uses the package as an application would, in every configuration. globalThis.said: pictures for `nook shade`, what the package
// refuses, and differences between pictures that should agree.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { EffectComposer } from 'three/addons/postprocessing/EffectComposer.js';
import { OutputPass } from 'three/addons/postprocessing/OutputPass.js';
import { FullScreenQuad } from 'three/addons/postprocessing/Pass.js';
import { RenderPass } from 'three/addons/postprocessing/RenderPass.js';
import * as POST from 'postprocessing';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { NookAO, NookPass, NookVolumes, useBakedVisibility } from 'nook-ao';
import { nookPassFor } from 'nook-ao/postprocessing';
import { cameraOf, sceneOf } from './scene.js';

const width = 192, height = 108;
const rendererOf = options => {
	const renderer = new THREE.WebGLRenderer(options);
	renderer.setSize(width, height);
	return renderer;
};
const renderer = rendererOf();
document.body.append(renderer.domElement);

const NookPostPass = nookPassFor(POST.Pass);
const { scene, grey, box, ball } = sceneOf();
const camera = cameraOf(new THREE.PerspectiveCamera(50, width / height, 0.1, 100));

// The first channel of a texture, rows from the top.
function read(texture, renderer, channel = 0) {
	const { width, height } = texture.image;
	const material = new THREE.RawShaderMaterial({
		glslVersion: THREE.GLSL3, depthTest: false, depthWrite: false, uniforms: { from: { value: texture } },
		vertexShader: 'in vec3 position;\nvoid main() { gl_Position = vec4(position.xy, 0.5, 1.0); }',
		fragmentShader: `precision highp float;\nuniform highp sampler2D from;\nout vec4 value;\nvoid main() { value = vec4(texelFetch(from, ivec2(gl_FragCoord.xy), 0)[${channel}]); }`,
	});
	const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType, depthBuffer: false });
	renderer.setRenderTarget(target);
	const quad = new FullScreenQuad(material);
	quad.render(renderer);
	renderer.setRenderTarget(null);
	const four = new Float32Array(4 * width * height);
	renderer.readRenderTargetPixels(target, 0, 0, width, height, four);
	for (const one of [target, material, quad]) one.dispose();
	return Float32Array.from({ length: width * height }, (_, i) => four[4 * ((height - 1 - Math.floor(i / width)) * width + i % width)]);
}

// Pictures of a three.js composer: the pass's own and, in `colours`, the composer's.
function drawn(options = {}, { on = renderer, from = camera, frames = 1, before = [], after = [], channel = 0, of = scene } = {}) {
	const pass = new NookPass(of, from, width, height, options);
	const composer = new EffectComposer(on, new THREE.WebGLRenderTarget(width, height, { type: THREE.HalfFloatType }));
	composer.renderToScreen = false;
	for (const one of [...before, pass, ...after]) composer.addPass(one);
	for (let i = 0; i < frames; ++i) composer.render(0);
	const result = { open: read(pass.texture, on), colours: read(composer.readBuffer.texture, on, channel), depths: read(pass._ao.depths, on) };
	pass.dispose();
	composer.dispose();
	return result;
}
// Likewise with the composer of `postprocessing`. then: called after the first frame, before another.
async function posted(optionsOf, { renderPass = true, then } = {}) {
	const composer = new POST.EffectComposer(renderer, { frameBufferType: THREE.HalfFloatType });
	composer.setSize(width, height);
	composer.autoRenderToScreen = false;
	const passes = optionsOf.map(options => new NookPostPass(scene, camera, options));
	for (const one of [...renderPass ? [new POST.RenderPass(scene, camera)] : [], ...passes]) composer.addPass(one);
	composer.render(0);
	if (then) {
		await then(composer, passes[0]);
		composer.render(0);
	}
	const result = { open: read(passes[0].texture, renderer), colours: read(composer[passes.length % 2 ? 'outputBuffer' : 'inputBuffer'].texture, renderer) };
	for (const one of passes) one.dispose();
	composer.dispose();
	result.refused = refusal(() => passes[0].render(renderer, composer.inputBuffer, composer.outputBuffer));
	return result;
}
async function loseContext(between) {
	const context = renderer.getContext().getExtension('WEBGL_lose_context');
	const event = name => new Promise(done => renderer.domElement.addEventListener(name, done, { once: true }));
	const lost = event('webglcontextlost'), restored = event('webglcontextrestored');
	context.loseContext();
	await lost;
	between();
	await new Promise(done => setTimeout(done, 0));
	context.restoreContext();
	await restored;
}
const rmse = (a, b) => Math.sqrt(a.reduce((sum, one, i) => sum + (one - b[i]) ** 2, 0) / a.length);
const mean = a => a.reduce((sum, one) => sum + one, 0) / a.length;
const refusal = call => {
	try {
		call();
		return 'nothing refused';
	} catch (error) {
		return `${error.name}: ${error.message}`;
	}
};
const bytes = values => {
	let text = '';
	for (const byte of new Uint8Array(values.buffer)) text += String.fromCharCode(byte);
	return btoa(text);
};

// Two passes that stay keep their programs, which the others share.
const keepers = [false, true].map(halfResolution => new NookPass(scene, camera, width, height, { halfResolution }));
for (const keeper of keepers) {
	const target = new THREE.WebGLRenderTarget(width, height);
	keeper.render(renderer, target, target);
	target.dispose();
}
const base = drawn();
const high = drawn({ quality: 'high' });
const pictures = [{ words: 'depth', values: bytes(base.depths) }, { words: 'medium', values: bytes(base.open) }, { words: 'high', values: bytes(high.open) }];
const differences = {};
const flat = drawn({ view: 'off' });

// ---- Cameras and depth buffers that show the same picture.
const infinite = cameraOf(new THREE.PerspectiveCamera(50, width / height, 0.1, 100));
Object.assign(infinite.projectionMatrix.elements, { 10: -1, 14: -0.2 });
infinite.projectionMatrixInverse.copy(infinite.projectionMatrix).invert();
differences.infinite = rmse(drawn({}, { from: infinite }).open, base.open);
for (const name of ['logarithmicDepthBuffer', 'reversedDepthBuffer']) {
	const other = rendererOf({ [name]: true });
	differences[name] = other.capabilities[name] ? rmse(drawn({}, { on: other, from: cameraOf(new THREE.PerspectiveCamera(50, width / height, 0.1, 100)) }).open, base.open) : -1;
	if (name === 'reversedDepthBuffer' && other.capabilities[name]) {
		differences.reversedHalf = rmse(drawn({ halfResolution: true }, { on: other, from: cameraOf(new THREE.PerspectiveCamera(50, width / height, 0.1, 100)) }).open, base.open);
	}
	other.dispose();
}
const parallel = () => cameraOf(new THREE.OrthographicCamera(-4, 4, 2.25, -2.25, 0.1, 100));
const shallow = parallel();
const deep = parallel();
deep.far = 1000;
deep.updateProjectionMatrix();
const ortho = drawn({}, { from: shallow });
differences.orthographic = rmse(ortho.open, drawn({}, { from: deep }).open);

// ---- Options.
const half = drawn({ halfResolution: true });
differences.half = rmse(half.open, base.open);
differences.normals = rmse(drawn({ normals: 'pass' }).open, base.open);
// The picture of normals: angles in degrees to those of the ball, where it is seen.
const normalsOf = options => [0, 1, 2].map(channel => drawn({ view: 'normals', ...options }, { channel }).colours.map(one => 2 * one - 1));
{
	const centre = ball.position.clone().applyMatrix4(camera.matrixWorldInverse), inverse = camera.projectionMatrixInverse;
	const anglesOf = normals => Array.from(base.depths, (depth, i) => {
		const at = new THREE.Vector3((i % width + 0.5) / width * 2 - 1, 1 - (Math.floor(i / width) + 0.5) / height * 2, 0.5).applyMatrix4(inverse);
		const seen = at.multiplyScalar(depth / -at.z).sub(centre);
		if (Math.abs(seen.length() - 0.5) > 0.005) return -1;
		return seen.angleTo(new THREE.Vector3(...normals.map(axis => axis[i]))) * 180 / Math.PI;
	}).filter(angle => angle >= 0);
	[differences.smooth, differences.facets] = ['pass', 'depth'].map(normals => mean(anglesOf(normalsOf({ normals }))));
}
// The next frame changes the mean of many by less than the first two frames differ.
const [once, next, many, more] = [1, 2, 32, 33].map(frames => drawn({ temporal: true }, { frames }).open);
differences.temporal = [rmse(once, base.open), rmse(many, more) / rmse(once, next)];
differences.multisampled = rmse(drawn({ samples: 4 }).colours, base.colours);
const strong = drawn({ intensity: 2 });
differences.intensity = rmse(strong.open, base.open.map(one => one ** 2));
const red = drawn({ tint: 0xff0000 });
differences.tint = rmse(red.colours, flat.colours);
differences.tinted = rmse(drawn({ tint: 0xff0000 }, { channel: 1 }).colours, drawn({}, { channel: 1 }).colours);
differences.product = rmse(base.colours, flat.colours.map((one, i) => one * base.open[i]));
differences.view = rmse(drawn({ view: 'visibility' }).colours, base.open);
const split = drawn({ view: 'split' }).colours;
differences.split = [flat, base].map(({ colours }, side) => Math.max(...split.map((one, i) => (i % width < width / 2) === (side === 0) ? Math.abs(one - colours[i]) : 0)));
const near = drawn({ sky: 5 });
differences.sky = Math.min(...near.open.filter((_, i) => base.depths[i] > 5));

// ---- Passes before and after.
differences.afterRender = rmse(drawn({ renderScene: false }, { before: [new RenderPass(scene, camera)] }).colours, base.colours);
const second = new NookPass(scene, camera, width, height);
differences.twice = rmse(drawn({}, { before: [second], frames: 3 }).colours, flat.colours.map((one, i) => one * base.open[i] ** 2));
second.dispose();
{
	const { open, colours, refused } = await posted([{}]);
	differences.postprocessing = Math.max(rmse(open, base.open), rmse(colours, base.colours));
	differences.postDisposed = refused;
	differences.postTwice = rmse((await posted([{}, {}])).colours, flat.colours.map((one, i) => one * base.open[i] ** 2));
	differences.postScene = rmse((await posted([{ renderScene: true }], { renderPass: false })).colours, base.colours);
	differences.postMultisampled = rmse((await posted([{ renderScene: true, samples: 4 }], { renderPass: false })).colours, drawn({ samples: 4 }).colours);
	const sizes = await posted([{}], { then: (composer, pass) => {
		pass.setSize(0, 0);
		composer.render(0);
		for (let i = 0; i < 6; ++i) {
			composer.setSize(width - 31 * i, height - 17 * i);
			composer.render(0);
		}
		composer.setSize(width, height);
	} });
	differences.postResized = rmse(sizes.colours, base.colours);
}

// ---- Transparent objects and layers are drawn over the obscurance, and do not occlude.
const glass = box(0, 1, 1, 2, 2, 0.02, new THREE.MeshBasicMaterial({ color: 0xffffff, transparent: true, opacity: 0.5 }));
const behind = drawn();
differences.transparent = rmse(behind.open, base.open);
const inside = i => base.colours[i] !== behind.colours[i];
differences.over = Math.max(...behind.colours.map((one, i) => inside(i) ? Math.abs(one - (0.5 + 0.5 * base.colours[i])) : 0));
differences.covered = behind.colours.filter((_, i) => inside(i)).length / behind.colours.length;
const post_glass = await posted([{ renderScene: true }], { renderPass: false });
differences.postTransparent = Math.max(rmse(post_glass.open, base.open), rmse(post_glass.colours, behind.colours));
differences.included = rmse(drawn({ excludeTransparent: false }).open, base.open);
glass.material = grey;
glass.layers.enable(3);
const layers = drawn({ excludeLayers: [3] });
differences.layers = rmse(layers.open, base.open);
differences.postLayers = rmse((await posted([{ renderScene: true, excludeLayers: [3] }], { renderPass: false })).colours, layers.colours);
glass.castShadow = true;
differences.casting = rmse(drawn({ excludeLayers: [3] }).open, base.open);
const [smooth, clear] = [[], [3]].map(excludeLayers => {
	scene[excludeLayers.length ? 'add' : 'remove'](glass);
	return drawn({ normals: 'pass', excludeLayers }).open;
});
differences.castingNormals = rmse(smooth, clear);
differences.restored = [glass.layers.mask, glass.material === grey, scene.background.getHex()];
scene.remove(glass);

// ---- Normals of a card that is seen from its back, has holes and a normal map: those of a flat one, and of the surface behind it.
{
	const texels = (...values) => Object.assign(new THREE.DataTexture(Uint8Array.from(values), 2, 1), { needsUpdate: true });
	const leaf = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, alphaTest: 0.5, map: texels(255, 255, 255, 255, 255, 255, 255, 0) });
	const card = new THREE.Mesh(new THREE.PlaneGeometry(2, 1.2), leaf);
	card.position.set(0, 1, 0.5);
	card.rotation.y = Math.PI + 0.3;
	scene.add(card);
	const points = new THREE.Points(new THREE.PlaneGeometry(1, 1), new THREE.PointsMaterial({ size: 2, depthWrite: false }));
	points.position.set(0, 1, 2);
	scene.add(points);
	// Away from edges, where depth has normals of neighbours: in most pixels.
	const apart = normals => [0, 1, 2].map(axis => normals[0][axis].map((one, i) => Math.abs(one - normals[1][axis][i]))).reduce((most, axis) => most.map((one, i) => Math.max(one, axis[i])));
	const both = normalsOf({ normals: 'pass' });
	differences.card = mean(apart([both, normalsOf()]).map(one => one > 0.02 ? 1 : 0));
	differences.points = rmse(both[0], (scene.remove(points), normalsOf({ normals: 'pass' }))[0]);
	leaf.normalMap = texels(128, 255, 128, 255, 128, 255, 128, 255);
	leaf.needsUpdate = true;
	differences.mapped = mean(apart([both, normalsOf({ normals: 'pass' })]).map(one => one > 0.1 ? 1 : 0));
	differences.kept = card.material === leaf && scene.overrideMaterial === null;
	scene.remove(card);
	for (const one of [leaf.map, leaf.normalMap, leaf, card.geometry, points.geometry, points.material]) one.dispose();
}

// ---- Baked visibility: where it is lower than that of the screen, the screen changes nothing.
const dark = new Float32Array(ball.geometry.attributes.position.count).fill(0.1);
ball.geometry.setAttribute('_visibility', new THREE.BufferAttribute(dark, 1));
differences.meshes = useBakedVisibility(scene);
const baked = drawn({ baked: true }), unshadowed = drawn({ baked: true, view: 'off' });
differences.baked = Math.min(...baked.colours) / mean(flat.colours);
differences.bakedOnly = rmse(baked.colours, base.colours.map((one, i) => Math.min(one, unshadowed.colours[i])));
ball.material = grey;
const level = await new GLTFLoader().loadAsync('baked.glb');
differences.level = useBakedVisibility(level.scene) > 0 && useBakedVisibility(scene) === 1;
ball.material = grey;
ball.geometry.deleteAttribute('_visibility');

// ---- Volumes of the level: with the screen's visibility, the lower of both.
const room = new THREE.Scene().add(level.scene, new THREE.HemisphereLight(0xffffff, 0xffffff, Math.PI));
room.updateMatrixWorld(true);
const inside_room = new THREE.PerspectiveCamera(level.cameras[0].fov, width / height, 0.1, 100);
level.cameras[0].matrixWorld.decompose(inside_room.position, inside_room.quaternion, inside_room.scale);
inside_room.updateMatrixWorld();
const file = await (await fetch('volumes.glb')).arrayBuffer();
{
	const volumes = new NookVolumes(file), at = { of: room, from: inside_room };
	differences.noVolumes = volumes.texture;
	const pass = new NookPass(room, inside_room, width, height, { volumes, normals: 'depth' });
	const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.HalfFloatType });
	pass.render(renderer, target, target);
	const open = read(volumes.texture, renderer), screen = read(pass.texture, renderer);
	pictures.push({ words: 'room', values: bytes(read(pass._ao.depths, renderer)) }, { words: 'volumes', values: bytes(open) });
	differences.lower = rmse(drawn({ volumes, view: 'visibility' }, at).colours, open.map((one, i) => Math.min(one, screen[i])));
	const dark = drawn({ volumes, halfResolution: true, normals: 'pass', quality: 'low' }, at).colours, light = drawn({ halfResolution: true, normals: 'pass', quality: 'low' }, at).colours;
	differences.volumesDarken = [dark.filter((one, i) => one > light[i] + 1e-3).length, mean(light) - mean(dark)];
	const other = rendererOf({ reversedDepthBuffer: true });
	differences.volumesReversed = rmse(drawn({ volumes, view: 'visibility' }, { ...at, on: other, from: inside_room.clone() }).colours, drawn({ volumes, view: 'visibility' }, at).colours);
	other.dispose();
	pass.dispose();
	target.dispose();
	await MeshoptDecoder.ready;
	const packed = new NookVolumes(await (await fetch('packed.glb')).arrayBuffer(), MeshoptDecoder);
	differences.volumesPacked = rmse(drawn({ volumes: packed, view: 'visibility' }, at).colours, drawn({ volumes, view: 'visibility' }, at).colours);
	packed.dispose();
	volumes.dispose();
	volumes.dispose();
	differences.volumesDisposed = refusal(() => volumes.render(renderer, inside_room, null, null));
}

// ---- Sizes, disposal, lost context.
{
	const pass = new NookPass(scene, camera, 0, 0);
	const composer = new EffectComposer(renderer, new THREE.WebGLRenderTarget(width, height, { type: THREE.HalfFloatType }));
	composer.renderToScreen = false;
	composer.addPass(pass);
	composer.addPass(new OutputPass());
	pass.setSize(0, 0);
	composer.render(0);
	differences.nothing = pass.texture;
	for (let i = 0; i < 6; ++i) {
		composer.setSize(width - 31 * i, height - 17 * i);
		composer.render(0);
	}
	composer.setSize(width, height);
	composer.render(0);
	differences.resized = rmse(read(pass.texture, renderer), base.open);
	pass.quality = 'high';
	composer.render(0);
	differences.changed = rmse(read(pass.texture, renderer), high.open);
	pass.temporal = true;
	composer.render(0);
	await loseContext(() => composer.render(0));
	pass.temporal = false;
	composer.render(0);
	differences.restoredContext = rmse(read(pass.texture, renderer), high.open);
	pass.dispose();
	pass.dispose();
	differences.disposed = refusal(() => pass.render(renderer, composer.writeBuffer, composer.readBuffer));
	composer.dispose();
	differences.postRestored = rmse((await posted([{}], { then: composer => loseContext(() => composer.render(0)) })).open, base.open);
	for (const keeper of keepers) keeper.dispose();
	differences.memory = renderer.info.memory.textures;
}

// Contexts of older devices.
const contextOf = (version, without) => {
	const context = document.createElement('canvas').getContext(version);
	const get = context.getExtension.bind(context);
	context.getExtension = name => name === without ? null : get(name);
	return context;
};
const halves = contextOf('webgl2', 'EXT_color_buffer_float');
const unlimited = new THREE.PerspectiveCamera(50, 1, 0.1, Infinity);
const refused = [
	refusal(() => new NookVolumes(file.slice(0, 4000))),
	refusal(() => new NookPass(scene, camera, width, height, { volumes: 'volumes.glb' })),
	refusal(() => new NookPass(scene, camera, width, height, { radius: -1 })),
	refusal(() => new NookPass(scene, camera, width, height, { quality: 'ultra' })),
	refusal(() => new NookPass(scene, camera, width, height, { radious: 1 })),
	refusal(() => new NookPass(scene, camera, width, height, { excludeLayers: 3 })),
	refusal(() => new NookPass(scene, camera, NaN, height)),
	refusal(() => { new NookPass(scene, camera).intensity = NaN; }),
	refusal(() => drawn({}, { from: unlimited })),
	refusal(() => drawn({}, { on: new THREE.WebGLRenderer({ canvas: halves.canvas, context: halves }) })),
	refusal(() => new NookAO(camera, 8, 8).render({ getContext: () => contextOf('webgl') }, null)),
	refusal(() => new NookAO(camera, 8, 8).render({ isWebGPURenderer: true, getContext: () => ({ isContextLost: () => false }) }, null)),
];
globalThis.said = { width, height, patterns: [], projection: camera.projectionMatrix.elements,
	room: [inside_room.projectionMatrix.elements, inside_room.matrixWorldInverse.elements], pictures, differences, refused, shadowed: mean(base.open) };
