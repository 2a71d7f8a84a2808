// SPDX-License-Identifier: MIT
// A three.js level with ambient obscurance from a module that nook emitted: the frame with its depth texture, the module's two
// passes, and their product.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { FullScreenQuad } from 'three/addons/postprocessing/Pass.js';
import { fill, glsl, voLine } from './made/nook_vo.js';

const width = 640, height = 360;
const reach = 1.5; // ray length that the method approximates, metres

export const renderer = new THREE.WebGLRenderer();
renderer.setSize(width, height);
document.body.append(renderer.domElement);

// The frame: the module reads its depth texture (emitted with --depth device --normals from-depth).
export const frame = new THREE.WebGLRenderTarget(width, height, {
	type: THREE.HalfFloatType,
	depthTexture: new THREE.DepthTexture(width, height, THREE.FloatType), // settings.depth_bits is 32
});

// The block (emitted with --block floats, since three.js supports no other kind), as a single uniform.
const block = new THREE.Uniform(new Float32Array(48));
export const group = new THREE.UniformsGroup().setName('nook_block').add(block);

const { name, width: columns, height: rows, texels } = voLine.tile;
const tile = new THREE.DataTexture(texels, columns, rows, THREE.RGBAFormat, THREE.FloatType);
tile.needsUpdate = true;

// A full-screen pass of the module: a call from the list in its introduction.
function passOf(call, textures) {
	const material = new THREE.RawShaderMaterial({
		glslVersion: THREE.GLSL3,
		vertexShader: 'in vec3 position;\nvoid main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
		fragmentShader: `${glsl}\nout float visibility;\nvoid main() { visibility = ${call}(ivec2(gl_FragCoord.xy)); }`,
		uniforms: Object.fromEntries(Object.entries(textures).map(([sampler, texture]) => [sampler, { value: texture }])),
		depthTest: false,
		depthWrite: false,
	});
	material.uniformsGroups = [group];
	const target = new THREE.WebGLRenderTarget(width, height, { format: THREE.RedFormat, type: THREE.HalfFloatType, depthBuffer: false });
	return { target, quad: new FullScreenQuad(material) };
}
const depths = frame.depthTexture;
const lines = passOf('nookVoLine', { nook_depths: depths, [name]: tile });
const mean = passOf('nookWindow', { nook_depths: depths, nook_cells: lines.target.texture });
export const visibility = mean.target;

// Ambient light × visibility; there is no other light here.
const product = new FullScreenQuad(new THREE.ShaderMaterial({
	uniforms: { colours: { value: frame.texture }, open: { value: visibility.texture } },
	vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
	fragmentShader: `uniform sampler2D colours, open;
		void main() {
			ivec2 at = ivec2(gl_FragCoord.xy);
			gl_FragColor = vec4(texelFetch(colours, at, 0).rgb * texelFetch(open, at, 0).r, 1.0);
			#include <colorspace_fragment>
		}`,
	depthTest: false,
	depthWrite: false,
}));

const level = await new GLTFLoader().loadAsync('made/level.glb');
level.scene.traverse(node => { if (node.isMesh) node.material = new THREE.MeshLambertMaterial(); });
const scene = new THREE.Scene().add(level.scene, new THREE.HemisphereLight(0xcfe0ff, 0x8a7a68, 2.2));
scene.background = new THREE.Color(0x9db8d8);
export const camera = new THREE.PerspectiveCamera(60, width / height, 0.1, 200);
const controls = new OrbitControls(camera, renderer.domElement);
scene.updateMatrixWorld();
level.cameras[0].matrixWorld.decompose(camera.position, camera.quaternion, camera.scale);
controls.target.copy(camera.position).add(camera.getWorldDirection(new THREE.Vector3()).multiplyScalar(8));

export function draw() {
	renderer.setRenderTarget(frame);
	renderer.render(scene, camera);
	const settings = { ...voLine.settings(reach), width, height };
	block.value = new Float32Array(fill(camera.projectionMatrix.elements, settings));
	for (const { target, quad } of [lines, mean]) {
		renderer.setRenderTarget(target);
		quad.render(renderer);
	}
	renderer.setRenderTarget(null);
	product.render(renderer);
}
controls.addEventListener('change', draw);
controls.update();
draw();
document.documentElement.dataset.drawn = 'yes';
