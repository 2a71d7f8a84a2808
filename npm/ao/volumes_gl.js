// SPDX-License-Identifier: MIT
// Draws a file of `nook volumes` with WebGL 2 and the module of `nook emit --methods aov --glsl es300`.
//
//	const volumes = new VolumesGl(gl, readVolumes(bytes), glsl);
//	const texture = volumes.draw({ cameraFromWorld, projection, width, height, depths, normals }); // R8, 1 where open
//
// It changes GL's state: the program, the framebuffer, the viewport, textures, buffers, blending and culling.
import { readVolumes, VolumesFrame } from './volumes_file.js';

export { readVolumes };

const kTriangle = '#version 300 es\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n';

function programOf(gl, ...sources) {
	const program = gl.createProgram();
	for (const [i, source] of sources.entries()) {
		const shader = gl.createShader(i === 0 ? gl.VERTEX_SHADER : gl.FRAGMENT_SHADER);
		gl.shaderSource(shader, source);
		gl.compileShader(shader);
		gl.attachShader(program, shader);
		gl.deleteShader(shader);
		if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(gl.getShaderInfoLog(shader));
	}
	gl.linkProgram(program);
	if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(program));
	return program;
}

// A texture of integers, filled row by row.
function arrayOf(gl, inside, format, type, items, channels) {
	const texels = items.length / channels, width = Math.min(gl.getParameter(gl.MAX_TEXTURE_SIZE), 4096), height = Math.max(1, Math.ceil(texels / width));
	if (height > gl.getParameter(gl.MAX_TEXTURE_SIZE)) throw new RangeError(`volumes: found ${texels} texels, more than a texture has`);
	const padded = new items.constructor(width * height * channels);
	padded.set(items);
	return textureOf(gl, inside, width, height, format, type, padded);
}

function textureOf(gl, inside, width, height, format, type, texels = null) {
	const texture = gl.createTexture();
	gl.bindTexture(gl.TEXTURE_2D, texture);
	for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
	gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
	gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
	gl.texImage2D(gl.TEXTURE_2D, 0, inside, width, height, 0, format, type, texels);
	return texture;
}

export class VolumesGl {
	constructor(gl, volumes, glsl) {
		if (!gl.getExtension('EXT_color_buffer_float') && !gl.getExtension('EXT_color_buffer_half_float')) {
			throw new Error('volumes: found no float textures to draw into, expected EXT_color_buffer_float');
		}
		const floats = gl.getExtension('EXT_color_buffer_float') && gl.getExtension('EXT_float_blend');
		this.gl = gl;
		this.sums = floats ? [gl.R32F, gl.FLOAT] : [gl.R16F, gl.HALF_FLOAT]; // 16 bits round sums of many volumes, by up to 0.01
		this.volumes = volumes;
		this.frame = new VolumesFrame(volumes);
		const stage = (...names) => `#version 300 es\n${names.map(name => `#define ${name}\n`).join('')}${glsl}`;
		this.program = programOf(gl, stage('NOOK_VERTEX', 'NOOK_ANY_DEPTH'), stage('NOOK_FRAGMENT'));
		this.resolve = programOf(gl, kTriangle, stage('NOOK_RESOLVE'));
		this.vertices = gl.createVertexArray(); // without arrays: the shader reads textures
		this.block = gl.createBuffer();
		gl.activeTexture(gl.TEXTURE0);
		this.corners = arrayOf(gl, gl.RGBA16UI, gl.RGBA_INTEGER, gl.UNSIGNED_SHORT, volumes.corners, 4);
		this.polygons = arrayOf(gl, gl.RG32UI, gl.RG_INTEGER, gl.UNSIGNED_INT, volumes.polygons, 2);
		this.seen = arrayOf(gl, gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, this.frame.seen, 4);
		this.targets = [];
	}

	resize(width, height) {
		if (this.width === width && this.height === height) return;
		const { gl } = this;
		this.freeTargets();
		[this.width, this.height] = [width, height];
		this.targets = [this.sums, [gl.R8, gl.UNSIGNED_BYTE]].map(([inside, type]) => {
			const texture = textureOf(gl, inside, width, height, gl.RED, type), frame = gl.createFramebuffer();
			gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
			gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
			return { texture, frame };
		});
	}

	// depths, normals: textures of width x height texels, as the module reads them. Other members: the camera, as VolumesFrame.set
	// takes it. Returns a texture of visibility, R8, 1 where open.
	draw(view) {
		const { gl, frame, volumes } = this;
		frame.set(view);
		gl.activeTexture(gl.TEXTURE0);
		this.resize(view.width, view.height);
		gl.bindTexture(gl.TEXTURE_2D, this.seen);
		const width = Math.min(gl.getParameter(gl.MAX_TEXTURE_SIZE), 4096), whole = Math.floor(frame.seen.length / 4 / width);
		if (whole > 0) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, whole, gl.RGBA_INTEGER, gl.UNSIGNED_INT, frame.seen);
		const rest = frame.seen.length / 4 - whole * width;
		if (rest > 0) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, whole, rest, 1, gl.RGBA_INTEGER, gl.UNSIGNED_INT, frame.seen, 4 * whole * width);
		gl.bindBuffer(gl.UNIFORM_BUFFER, this.block);
		gl.bufferData(gl.UNIFORM_BUFFER, frame.block, gl.STREAM_DRAW);
		gl.bindVertexArray(this.vertices);
		gl.viewport(0, 0, view.width, view.height);
		for (const state of [gl.DEPTH_TEST, gl.STENCIL_TEST, gl.SCISSOR_TEST]) gl.disable(state);
		gl.colorMask(true, true, true, true);

		gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets[0].frame);
		gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
		this.use(this.program, { nook_corners: this.corners, nook_polygons: this.polygons, nook_clusters: this.seen,
			nook_depths: view.depths, nook_normals: view.normals });
		gl.enable(gl.BLEND);
		gl.blendEquation(gl.FUNC_ADD);
		gl.blendFunc(gl.ONE, gl.ONE);
		gl.enable(gl.CULL_FACE);
		gl.frontFace(frame.mirrored ? gl.CW : gl.CCW);
		for (const i of frame.inSight()) {
			const cluster = volumes.clusters[i];
			gl.cullFace(frame.holdsEye(cluster) ? gl.FRONT : gl.BACK);
			gl.vertexAttribI4i(0, i, 0, 0, 0); // nook_cluster
			gl.drawArrays(gl.TRIANGLES, 12 * cluster.firstCorner, 12 * cluster.cornerCount);
		}
		gl.disable(gl.BLEND);
		gl.disable(gl.CULL_FACE);
		gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets[1].frame);
		this.use(this.resolve, { nook_sums: this.targets[0].texture });
		gl.drawArrays(gl.TRIANGLES, 0, 3);
		return this.targets[1].texture;
	}

	use(program, textures) {
		const { gl } = this;
		gl.useProgram(program);
		gl.uniformBlockBinding(program, gl.getUniformBlockIndex(program, 'NookVolumes'), 0);
		gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.block);
		Object.entries(textures).forEach(([name, texture], unit) => {
			gl.activeTexture(gl.TEXTURE0 + unit);
			gl.bindTexture(gl.TEXTURE_2D, texture);
			gl.uniform1i(gl.getUniformLocation(program, name), unit);
		});
	}

	freeTargets() {
		for (const { texture, frame } of this.targets) {
			this.gl.deleteTexture(texture);
			this.gl.deleteFramebuffer(frame);
		}
		this.targets = [];
		[this.width, this.height] = [0, 0];
	}

	dispose() {
		this.freeTargets();
		for (const texture of [this.corners, this.polygons, this.seen]) this.gl.deleteTexture(texture);
		for (const program of [this.program, this.resolve]) this.gl.deleteProgram(program);
		this.gl.deleteBuffer(this.block);
		this.gl.deleteVertexArray(this.vertices);
	}
}
