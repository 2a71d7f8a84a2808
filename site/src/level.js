// SPDX-License-Identifier: GPL-3.0-or-later
// The level in three.js with its materials and the pass of nook-ao, beside rays of the same view or beside nothing.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { EffectComposer } from 'three/addons/postprocessing/EffectComposer.js';
import { FullScreenQuad, Pass } from 'three/addons/postprocessing/Pass.js';
import { NookPass } from 'nook-ao';
import { byId, bytesOf, data, publish, shortNumber, table } from 'nook:page';
import { choiceBar } from './choices.js';
import { lookAround } from './look.js';
import { dress } from './materials.js';

const SENTENCE = 'This browser has no WebGL 2 that draws 32-bit floats (EXT_color_buffer_float), which the pass needs: the level cannot be drawn in it.';
const SHOWN = { materials: 'materials', visibility: 'visibility alone' };
const RIGHT = { rays: 'rays', none: 'no ambient occlusion' };
const CHOICES = { quality: ['low', 'medium', 'high'], normals: ['depth', 'pass'], halfResolution: [false, true], temporal: [false, true] };
const NAMES = { quality: 'Quality', normals: 'Normals', halfResolution: 'Half resolution', temporal: 'Average frames' };
const MOVING = 0.5; // size of the picture while the camera moves
const STILL_MS = 200;
const FRAMES = 32; // that are averaged

const shown = data.level;
export const live = { pass: null, renderer: null, camera: null, moved: false, on: true, show: 'materials', right: 'rays', drawings: 0, errors: null };
let scene, composer, split, unshaded, rays, counted, size = 1, wanted = 0, still = 0;

// ---- The two pictures, and the line between them

class Split extends Pass {
	constructor() {
		super();
		this.material = new THREE.ShaderMaterial({
			glslVersion: THREE.GLSL3, depthTest: false, depthWrite: false,
			uniforms: Object.fromEntries(['occluded', 'plain', 'rays', 'share', 'right', 'visibility'].map(name => [name, { value: null }])),
			vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
			fragmentShader: `uniform sampler2D occluded, plain, rays;
uniform float share;
uniform int right;
uniform bool visibility;
out vec4 result;
void main() {
	vec2 size = vec2(textureSize(occluded, 0)), at = gl_FragCoord.xy / size;
	float edge = floor(share * size.x + 0.5), x = floor(gl_FragCoord.x);
	vec3 traced = texture(rays, at).rgb;
	float open = right == 1 ? (traced.r < 0.5 / 255.0 && traced.b > 0.99 ? 1.0 : traced.r) : 1.0;
	vec3 colour = x < edge ? texture(occluded, at).rgb : visibility ? vec3(open) : texture(plain, at).rgb * open;
	colour = visibility ? colour : mix(1.055 * pow(colour, vec3(1.0 / 2.4)) - 0.055, 12.92 * colour, lessThan(colour, vec3(0.0031308)));
	result = x == edge && edge > 0.0 && edge < size.x ? vec4(0.84, 0.24, 0.16, 1.0) : vec4(colour, 1.0);
}`,
		});
		this.quad = new FullScreenQuad(this.material);
	}

	render(renderer, writeBuffer, readBuffer) {
		const { uniforms } = this.material, visibility = live.show === 'visibility';
		Object.entries({ occluded: readBuffer.texture, plain: unshaded.texture, rays, share: live.on ? byId('split').value / 1000 : 0, visibility, right: live.right === 'rays' && !live.moved ? 1 : 0 })
			.forEach(([name, value]) => { uniforms[name].value = value; });
		renderer.setRenderTarget(null);
		this.quad.render(renderer);
	}
}

const beside = () => live.show === 'materials' && (!live.on || byId('split').value < 1000);

function draw() {
	const { renderer, camera, pass } = live;
	pass.view = live.show === 'visibility' ? 'visibility' : 'combined';
	if (beside()) {
		renderer.setRenderTarget(unshaded);
		renderer.clear();
		renderer.render(scene, camera);
	}
	composer.render(0);
}

function resize(share) {
	if (size === share) return;
	size = share;
	const width = Math.round(shown.width * size), height = Math.round(shown.height * size);
	live.renderer.setSize(width, height, false);
	composer.setSize(width, height);
	unshaded.setSize(width, height);
}

function frame(left = live.pass.temporal ? FRAMES : 1) {
	wanted = requestAnimationFrame(() => {
		draw();
		if (size < 1) { clearTimeout(still); still = setTimeout(() => { resize(1); frame(); }, STILL_MS); return; }
		if (left > 1) { frame(left - 1); return; }
		live.errors = live.moved ? null : errorsOf();
		drawFigures();
		publish({ levelDrawn: ++live.drawings });
	});
}

// Draws as soon as the browser shows a picture; moving: at the size for it.
export function redraw(moving = false) {
	if (!live.renderer) return;
	cancelAnimationFrame(wanted);
	clearTimeout(still);
	resize(moving ? MOVING : 1);
	drawBars();
	frame();
}

// ---- Errors: of the pass and of no occlusion, over pixels with a surface

function valuesOf(texture) {
	const target = new THREE.WebGLRenderTarget(shown.width, shown.height, { type: THREE.FloatType, depthBuffer: false });
	const material = new THREE.ShaderMaterial({
		depthTest: false, depthWrite: false, uniforms: { from: { value: texture } }, vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
		fragmentShader: 'uniform highp sampler2D from; void main() { gl_FragColor = texelFetch(from, ivec2(gl_FragCoord.xy), 0); }',
	});
	const quad = new FullScreenQuad(material), four = new Float32Array(4 * shown.width * shown.height);
	live.renderer.setRenderTarget(target);
	quad.render(live.renderer);
	live.renderer.readRenderTargetPixels(target, 0, 0, shown.width, shown.height, four);
	live.renderer.setRenderTarget(null);
	for (const one of [target, material, quad]) one.dispose();
	return Float32Array.from({ length: shown.width * shown.height }, (_, i) => four[4 * i]);
}

function errorsOf() {
	const open = valuesOf(live.pass.texture), sums = [0, 0];
	let count = 0;
	for (let i = 0; i < counted.length; ++i) {
		if (counted[i] < 0) continue;
		sums[0] += (open[i] - counted[i]) ** 2;
		sums[1] += (1 - counted[i]) ** 2;
		++count;
	}
	return sums.map(sum => Math.sqrt(sum / Math.max(1, count)));
}

// ---- What can be chosen

function drawBars() {
	const { pass } = live;
	choiceBar('ao-bar', 'Ambient occlusion', { on: 'on', off: 'off' }, live.on ? 'on' : 'off', key => { live.on = key === 'on'; redraw(); });
	choiceBar('beside-bar', 'Right of the slider', RIGHT, live.moved ? 'none' : live.right, key => { live.right = key; redraw(); }, key => key !== 'rays' || !live.moved);
	choiceBar('shown-bar', 'Show', SHOWN, live.show, key => { live.show = key; redraw(); });
	for (const [option, values] of Object.entries(CHOICES)) {
		const texts = values.map(value => [String(value), typeof value === 'boolean' ? value ? 'yes' : 'no' : value === 'pass' ? 'smooth, drawn' : option === 'normals' ? 'from depth' : value]);
		choiceBar(`${option}-bar`, NAMES[option], Object.fromEntries(texts), String(pass[option]), key => { pass[option] = values.find(value => String(value) === key); redraw(); });
	}
	const cameras = Object.fromEntries(live.cameras.map(({ name }) => [name, name === shown.camera ? `${name}, traced` : name]));
	choiceBar('camera-bar', 'Camera', cameras, live.at, name => goTo(name));
	byId('level-back').hidden = !live.moved || live.at !== null;
	byId('split').disabled = !live.on;
}

function drawFigures() {
	const { pass, errors } = live, name = `nook-ao, ${pass.quality}`, right = live.right === 'rays' && !live.moved ? `${shown.rays} rays per pixel` : 'no ambient occlusion';
	byId('split-left').textContent = live.on ? name : '';
	byId('split-right').textContent = right;
	byId('level-figures').replaceChildren();
	const same = pass.radius === shown.radius_m;
	if (errors && same) table(byId('level-figures'), ['picture', 'RMSE to the rays'], [[name, shortNumber(errors[0])], ['no ambient occlusion', shortNumber(errors[1])]]);
	byId('level-caption').textContent = `${shown.level}, ${live.moved ? `camera ${live.at ?? 'moved'}` : `camera ${shown.camera}`}, ${shown.width} × ${shown.height}. `
		+ (live.moved ? 'Rays were traced for the first view alone. ' : same ? '' : `The rays were traced for a radius of ${shortNumber(shown.radius_m)} m. `)
		+ (shown.own ? 'The level has its own materials.' : shown.level.startsWith('builtin:') ? 'Its materials are computed by the page.' : 'Its materials are masks alone, since nook level wrote it.');
}

// ---- The camera

function place(matrix) {
	const { camera } = live;
	matrix.decompose(camera.position, camera.quaternion, camera.scale);
	camera.updateMatrixWorld();
}

export function goTo(name) {
	live.at = name;
	live.moved = name !== shown.camera;
	const found = live.cameras.find(one => one.name === name);
	live.camera.fov = found.fov;
	live.camera.updateProjectionMatrix();
	place(found.matrix);
	live.pass.reset();
	redraw();
}

const angles = new THREE.Euler(0, 0, 0, 'YXZ');

function turn(yaw, pitch) {
	const { camera } = live;
	angles.setFromQuaternion(camera.quaternion);
	angles.y += yaw;
	angles.x = Math.max(-1.5, Math.min(1.5, angles.x + pitch));
	camera.quaternion.setFromEuler(angles);
	moved();
}

function move(right, up, back) {
	live.camera.position.add(new THREE.Vector3(right, up, back).applyQuaternion(live.camera.quaternion));
	moved();
}

function moved() {
	live.camera.updateMatrixWorld();
	Object.assign(live, { moved: true, at: null });
	redraw(true);
}

// ---- The level

async function loadLevel() {
	const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);
	const { scene: level, cameras } = await loader.parseAsync(bytesOf(shown.glb).buffer, '');
	if (!shown.own) dress(level);
	level.updateMatrixWorld(true);
	const box = new THREE.Box3().setFromObject(level), extent = box.getSize(new THREE.Vector3()).length(), centre = box.getCenter(new THREE.Vector3());
	const light = shown.level.startsWith('builtin:') ? 1 : 0.65; // white surfaces of other levels stay below white
	scene = new THREE.Scene().add(level, new THREE.HemisphereLight(0xd5e4f7, 0x8a7a62, 2.1 * light));
	scene.background = new THREE.Color(0x9fbfe0);
	const traced = new THREE.Matrix4().fromArray(shown.world_from_camera), eye = new THREE.Vector3().setFromMatrixPosition(traced);
	const reach = Math.min(extent / 2, 40 * shown.radius_m), sun = new THREE.DirectionalLight(0xfff0d8, 2.4 * light);
	// The sun lights what is in front of the traced view.
	sun.target.position.copy(eye).add(new THREE.Vector3(0, 0, -0.3 * reach).transformDirection(traced).multiplyScalar(0.3 * reach));
	sun.target.position.y = Math.min(sun.target.position.y, eye.y);
	sun.position.copy(sun.target.position).add(new THREE.Vector3(0.55, 1, 0.65).normalize().multiplyScalar(extent));
	Object.assign(sun.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.01 * extent, far: 2 * extent });
	sun.shadow.mapSize.set(2048, 2048);
	sun.shadow.normalBias = reach / 700;
	sun.castShadow = true;
	scene.add(sun, sun.target);
	level.traverse(object => {
		if (object.isLight) object.visible = false;
		if (object.isMesh) Object.assign(object, { castShadow: true, receiveShadow: true });
	});
	const fovOf = y => 2 * Math.atan(1 / y) * 180 / Math.PI, tracedFov = fovOf(shown.projection[5]);
	live.camera = new THREE.PerspectiveCamera(tracedFov, shown.width / shown.height, Math.min(0.1, shown.radius_m / 10), 2 * extent + centre.distanceTo(eye));
	live.cameras = [{ name: shown.camera, matrix: traced, fov: tracedFov }];
	const nameOf = ({ name, userData }) => userData.name ?? name; // three.js renames what has the name of another object
	for (const camera of cameras) {
		if (camera.isPerspectiveCamera && nameOf(camera) !== shown.camera) live.cameras.push({ name: nameOf(camera), matrix: camera.matrixWorld.clone(), fov: camera.fov });
	}
	scene.updateMatrixWorld(true);
}

async function loadRays() {
	const picture = new Image();
	picture.src = `data:image/png;base64,${shown.png}`;
	await picture.decode();
	const canvas = Object.assign(document.createElement('canvas'), { width: shown.width, height: shown.height }), context = canvas.getContext('2d', { willReadFrequently: true });
	context.drawImage(picture, 0, 0);
	const { data: texels } = context.getImageData(0, 0, shown.width, shown.height);
	rays = new THREE.DataTexture(new Uint8Array(texels.buffer), shown.width, shown.height);
	// Rows from the bottom, as they are drawn; blue pixels are sky.
	const row = 4 * shown.width, rows = Array.from({ length: shown.height }, (_, y) => texels.slice(y * row, y * row + row)).reverse();
	rows.forEach((values, y) => rays.image.data.set(values, y * row));
	Object.assign(rays, { minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter, needsUpdate: true });
	counted = Float32Array.from({ length: shown.width * shown.height }, (_, i) => rays.image.data[4 * i] === 0 && rays.image.data[4 * i + 2] === 255 ? -1 : rays.image.data[4 * i] / 255);
}

function rendererOf(canvas) {
	const gl = canvas.getContext('webgl2', { antialias: false, depth: false, alpha: false, preserveDrawingBuffer: true });
	if (!gl || !gl.getExtension('EXT_color_buffer_float')) return null;
	const renderer = new THREE.WebGLRenderer({ canvas, context: gl });
	renderer.shadowMap.enabled = true;
	renderer.shadowMap.autoUpdate = false;
	renderer.shadowMap.needsUpdate = true;
	return renderer;
}

export async function startLevel() {
	const canvas = byId('level-canvas'), renderer = rendererOf(canvas);
	canvas.setAttribute('aria-label', `${shown.level} in three.js: left of the slider with ambient occlusion, right of it what it is compared with`);
	if (!renderer) {
		byId('no-three').textContent = SENTENCE;
		byId('no-three').hidden = false;
		byId('three-stage').hidden = true;
		return;
	}
	await Promise.all([loadLevel(), loadRays()]);
	const { width, height } = shown;
	renderer.setSize(width, height, false);
	composer = new EffectComposer(renderer, new THREE.WebGLRenderTarget(width, height, { type: THREE.HalfFloatType }));
	unshaded = new THREE.WebGLRenderTarget(width, height, { type: THREE.HalfFloatType });
	Object.assign(live, { renderer, pass: new NookPass(scene, live.camera, width, height, { radius: shown.radius_m }), at: shown.camera });
	split = new Split();
	composer.addPass(live.pass);
	composer.addPass(split);
	place(live.cameras[0].matrix);
	const radius = byId('level-radius');
	Object.assign(radius, { min: 10, max: 200, step: 5, value: 100 }); // % of that of the rays
	const tellRadius = () => { byId('level-radius-value').textContent = `${shortNumber(live.pass.radius)} m`; };
	radius.addEventListener('input', () => {
		live.pass.radius = radius.value / 100 * shown.radius_m;
		tellRadius();
		redraw();
	});
	tellRadius();
	byId('split').addEventListener('input', () => redraw());
	byId('level-back').addEventListener('click', () => goTo(shown.camera));
	canvas.addEventListener('webglcontextrestored', () => redraw());
	lookAround(canvas, byId('level-pad'), { turn, move, step: shown.radius_m / 3, keys: { o: () => { live.on = !live.on; redraw(); }, r: () => { live.right = live.right === 'rays' ? 'none' : 'rays'; redraw(); },
		v: () => { live.show = live.show === 'materials' ? 'visibility' : 'materials'; redraw(); } } });
	redraw();
	while (live.drawings === 0) await new Promise(later => setTimeout(later, 20));
}
