// SPDX-License-Identifier: GPL-3.0-or-later
// WebGL2 in few words: programs, pictures, passes over a whole picture, and the time that a GPU took.
export const PICTURES = {
	scalar: gl => ({ inside: gl.R32F, format: gl.RED, type: gl.FLOAT, glsl: 'float', channels: 1 }),
	quad: gl => ({ inside: gl.RGBA32F, format: gl.RGBA, type: gl.FLOAT, glsl: 'vec4', channels: 4 }),
	counts: gl => ({ inside: gl.RGBA32UI, format: gl.RGBA_INTEGER, type: gl.UNSIGNED_INT, glsl: 'uvec4', channels: 4 }),
	bytes: gl => ({ inside: gl.R8, format: gl.RED, type: gl.UNSIGNED_BYTE, glsl: 'float', channels: 1 }),
};
const VERTICES = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0), 0.0, 1.0); }`;

// Null where the browser has no WebGL2, or draws no floats.
export function openGl(canvas) {
	const gl = canvas.getContext('webgl2', { antialias: false, depth: false, alpha: false, preserveDrawingBuffer: true });
	return gl && gl.getExtension('EXT_color_buffer_float') ? gl : null;
}

function compiledShader(gl, kind, text) {
	const shader = gl.createShader(kind);
	gl.shaderSource(shader, text);
	gl.compileShader(shader);
	return shader;
}

const programs = new Map();

// Programs are compiled once per text.
export function programOf(gl, fragments, vertices = VERTICES) {
	const key = vertices + fragments;
	if (programs.has(key)) return programs.get(key);
	const program = gl.createProgram();
	for (const [kind, text] of [[gl.VERTEX_SHADER, vertices], [gl.FRAGMENT_SHADER, fragments]]) {
		const shader = compiledShader(gl, kind, text);
		gl.attachShader(program, shader);
	}
	gl.linkProgram(program);
	if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
		const logs = gl.getAttachedShaders(program).map(shader => gl.getShaderInfoLog(shader));
		throw new Error(`shader: found ${[gl.getProgramInfoLog(program), ...logs].filter(Boolean).join(' ').trim()}, expected one that links`);
	}
	const block = gl.getUniformBlockIndex(program, 'nook_block');
	if (block !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, block, 0);
	programs.set(key, program);
	return program;
}

// shape: {format, width, height, levels, layers}; the first level is filled where there are numbers.
export function pictureOf(gl, shape, numbers) {
	const { inside, format, type } = PICTURES[shape.format](gl), levels = shape.levels || 1;
	const target = shape.format === 'counts' ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D;
	const texture = gl.createTexture();
	gl.bindTexture(target, texture);
	if (target === gl.TEXTURE_2D_ARRAY) gl.texStorage3D(target, levels, inside, shape.width, shape.height, shape.layers || 1);
	else gl.texStorage2D(target, levels, inside, shape.width, shape.height);
	gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, levels > 1 ? gl.NEAREST_MIPMAP_NEAREST : gl.NEAREST);
	gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
	gl.texParameteri(target, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
	gl.texParameteri(target, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
	gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
	if (numbers) gl.texSubImage2D(target, 0, 0, 0, shape.width, shape.height, format, type, numbers);
	return { ...shape, levels, target, texture };
}

const framebuffers = new WeakMap();

export function aim(gl, picture, level = 0, layer = 0) {
	if (!framebuffers.has(gl)) framebuffers.set(gl, gl.createFramebuffer());
	gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffers.get(gl));
	if (picture.target === gl.TEXTURE_2D_ARRAY) gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, picture.texture, level, layer);
	else gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, picture.texture, level);
	gl.viewport(0, 0, Math.max(1, picture.width >> level), Math.max(1, picture.height >> level));
}

// Textures by the names of their samplers; those that the program does not read are left out.
export function bindPictures(gl, program, pictures) {
	Object.entries(pictures).forEach(([name, picture], unit) => {
		const place = gl.getUniformLocation(program, name);
		if (!place) return;
		gl.activeTexture(gl.TEXTURE0 + unit);
		gl.bindTexture(picture.target, picture.texture);
		gl.uniform1i(place, unit);
	});
}

export function readScalars(gl, picture) {
	const four = new Float32Array(4 * picture.width * picture.height), one = new Float32Array(picture.width * picture.height);
	aim(gl, picture);
	gl.readPixels(0, 0, picture.width, picture.height, gl.RGBA, gl.FLOAT, four);
	for (let i = 0; i < one.length; ++i) one[i] = four[4 * i];
	return one;
}

// Calls `tell` with milliseconds once they are known; false where the browser does not tell.
export function timed(gl, draw, tell) {
	const timer = gl.getExtension('EXT_disjoint_timer_query_webgl2');
	if (!timer) { draw(); return false; }
	const query = gl.createQuery();
	gl.beginQuery(timer.TIME_ELAPSED_EXT, query);
	draw();
	gl.endQuery(timer.TIME_ELAPSED_EXT);
	const look = () => {
		if (!gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE)) { setTimeout(look, 20); return; }
		if (!gl.getParameter(timer.GPU_DISJOINT_EXT)) tell(gl.getQueryParameter(query, gl.QUERY_RESULT) / 1e6);
		gl.deleteQuery(query);
	};
	setTimeout(look, 0);
	return true;
}
