// SPDX-License-Identifier: GPL-3.0-or-later
// Runs in the page of examples/web: returns its projection, the module's depths and their error bounds, and the visibility that it
// drew; rows from the top.
while (document.documentElement.dataset.drawn !== 'yes') await new Promise(later => setTimeout(later, 50));
const THREE = await import('three');
const { FullScreenQuad } = await import('three/addons/postprocessing/Pass.js');
const { glsl } = await import('./made/nook_vo.js');
const page = await import('./main.js');
const { width, height } = page.frame;

// 32-bit floats of an expression at each pixel.
function floatsOf(expression, uniforms) {
	const material = new THREE.RawShaderMaterial({
		glslVersion: THREE.GLSL3,
		vertexShader: 'in vec3 position;\nvoid main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
		fragmentShader: `${glsl}\nout vec4 value;\nvoid main() { ivec2 at = ivec2(gl_FragCoord.xy); value = vec4(${expression}); }`,
		uniforms: Object.fromEntries(Object.entries(uniforms).map(([name, value]) => [name, { value }])),
		depthTest: false,
		depthWrite: false,
	});
	material.uniformsGroups = [page.group];
	const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType, depthBuffer: false });
	page.renderer.setRenderTarget(target);
	new FullScreenQuad(material).render(page.renderer);
	page.renderer.setRenderTarget(null);
	const four = new Float32Array(4 * width * height);
	page.renderer.readRenderTargetPixels(target, 0, 0, width, height, four);
	const one = new Float32Array(width * height);
	for (let i = 0; i < one.length; ++i) one[i] = four[4 * ((height - 1 - Math.floor(i / width)) * width + i % width)];
	let bytes = '';
	for (const byte of new Uint8Array(one.buffer)) bytes += String.fromCharCode(byte);
	return btoa(bytes);
}

const nook_depths = page.frame.depthTexture;
return { width, height, patterns: [], projection: page.camera.projectionMatrix.elements, pictures: [
	{ words: 'depth', values: floatsOf('nookDepth(at)', { nook_depths }) },
	{ words: 'error', values: floatsOf('nookDepth(at) < NOOK_SKY ? 0.5 * nookSlack(nookDepth(at), 0.0) : 0.0', { nook_depths }) },
	{ words: 'visibility', values: floatsOf('nookVisibility(at)', { nook_cells: page.visibility.texture }) },
] };
