// SPDX-License-Identifier: GPL-3.0-or-later
// The level: depth and normals of the traced view as the program cast them, or of any other by drawing the triangles.
import { bytesOf } from 'nook:page';
import { bindPictures, pictureOf, programOf } from './gl.js';

export const SKY = 1e30;
const SCENE_VERTICES = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
uniform mat4 view, projection;
out vec3 seen;
out vec2 at;
void main() { vec4 p = view * vec4(position, 1.0); seen = p.xyz; at = uv; gl_Position = projection * p; gl_Position.y = -gl_Position.y; }`;
const SCENE_FRAGMENTS = `#version 300 es
precision highp float;
uniform sampler2D mask;
uniform float factor, cutoff;
in vec3 seen;
in vec2 at;
layout(location = 0) out vec4 depth;
layout(location = 1) out vec4 normal;
void main()
{
	vec3 n = cross(dFdx(seen), dFdy(seen));
	float alpha = texture(mask, at).r * factor;
	if (alpha < cutoff) { discard; }
	n = normalize(n);
	depth = vec4(-seen.z);
	normal = vec4(dot(n, seen) > 0.0 ? -n : n, 0.0);
}`;

export function numbersOf(text, Kind) {
	const bytes = bytesOf(text);
	return new Kind(bytes.buffer, 0, bytes.length / Kind.BYTES_PER_ELEMENT);
}

// Four numbers a pixel.
function normalsOf({ list, indices, bytes }) {
	const unit = numbersOf(list, Float32Array), which = numbersOf(indices, bytes === 2 ? Uint16Array : Uint32Array);
	const four = new Float32Array(4 * which.length);
	for (let i = 0; i < which.length; ++i) for (let k = 0; k < 3; ++k) four[4 * i + k] = unit[3 * which[i] + k];
	return four;
}

export function castScene(gl, view) {
	const shape = { width: view.width, height: view.height }, depths = numbersOf(view.depth, Float32Array);
	return { values: depths, depths: pictureOf(gl, { ...shape, format: 'scalar' }, depths),
		normals: pictureOf(gl, { ...shape, format: 'quad' }, normalsOf(view.normals)) };
}

function maskPicture(gl, mask) {
	const texture = gl.createTexture(), wraps = [gl.REPEAT, gl.MIRRORED_REPEAT, gl.CLAMP_TO_EDGE];
	gl.bindTexture(gl.TEXTURE_2D, texture);
	gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
	gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, mask.width, mask.height, 0, gl.RED, gl.UNSIGNED_BYTE, mask.alpha);
	gl.generateMipmap(gl.TEXTURE_2D);
	gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
	gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wraps[mask.wrap_u]);
	gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wraps[mask.wrap_v]);
	return { target: gl.TEXTURE_2D, texture };
}

// Made when the camera first moves: the page's first picture needs none of it.
export function triangleScene(gl, view) {
	const buffer = (kind, numbers) => { const made = gl.createBuffer(); gl.bindBuffer(kind, made); gl.bufferData(kind, numbers, gl.STATIC_DRAW); return made; };
	const vertices = gl.createVertexArray();
	gl.bindVertexArray(vertices);
	[['positions', 3], ['uvs', 2]].forEach(([name, size], place) => {
		buffer(gl.ARRAY_BUFFER, numbersOf(view.triangles[name], Float32Array));
		gl.enableVertexAttribArray(place);
		gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, 0);
	});
	const groups = view.triangles.groups.map(group => {
		const indices = numbersOf(group.indices, Uint32Array);
		return { ...group, buffer: buffer(gl.ELEMENT_ARRAY_BUFFER, indices), count: indices.length };
	});
	gl.bindVertexArray(null);
	const masks = view.masks.map(mask => maskPicture(gl, { ...mask, alpha: bytesOf(mask.alpha) }));
	masks.push(maskPicture(gl, { width: 1, height: 1, wrap_u: 0, wrap_v: 0, alpha: new Uint8Array([255]) }));
	const shape = { width: view.width, height: view.height };
	const scene = { depths: pictureOf(gl, { ...shape, format: 'scalar' }), normals: pictureOf(gl, { ...shape, format: 'quad' }) };
	const framebuffer = gl.createFramebuffer(), zs = gl.createRenderbuffer();
	gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
	gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, scene.depths.texture, 0);
	gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT1, gl.TEXTURE_2D, scene.normals.texture, 0);
	gl.bindRenderbuffer(gl.RENDERBUFFER, zs);
	gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, view.width, view.height);
	gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, zs);
	gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
	scene.draw = matrix => drawTriangles(gl, { view, vertices, groups, masks, framebuffer }, matrix);
	return scene;
}

function drawTriangles(gl, { view, vertices, groups, masks, framebuffer }, matrix) {
	const program = programOf(gl, SCENE_FRAGMENTS, SCENE_VERTICES), place = name => gl.getUniformLocation(program, name);
	gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
	gl.viewport(0, 0, view.width, view.height);
	gl.clearBufferfv(gl.COLOR, 0, [SKY, SKY, SKY, SKY]);
	gl.clearBufferfv(gl.COLOR, 1, [0, 0, 0, 0]);
	gl.clearBufferfv(gl.DEPTH, 0, [1]);
	gl.enable(gl.DEPTH_TEST);
	gl.useProgram(program);
	gl.uniformMatrix4fv(place('view'), false, matrix);
	gl.uniformMatrix4fv(place('projection'), false, view.projection);
	gl.bindVertexArray(vertices);
	for (const group of groups) {
		bindPictures(gl, program, { mask: masks[group.mask === undefined || group.mask < 0 ? masks.length - 1 : group.mask] });
		gl.uniform1f(place('factor'), group.alpha === undefined ? 1 : group.alpha);
		gl.uniform1f(place('cutoff'), group.cutoff === undefined ? 0 : group.cutoff);
		gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, group.buffer);
		gl.drawElements(gl.TRIANGLES, group.count, gl.UNSIGNED_INT, 0);
	}
	gl.bindVertexArray(null);
	gl.disable(gl.DEPTH_TEST);
}

// ---- The camera: where it was traced from, turned and moved.

export const eye = { yaw: 0, pitch: 0, at: [0, 0, 0], moved: false };

// Columns of the camera's axes in the world, before it was turned: right, up, back.
const axesOf = view => [0, 1, 2].map(k => view.world_from_camera.slice(4 * k, 4 * k + 3));
const dot3 = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const turned = (v, axis, angle) => {
	const c = Math.cos(angle), s = Math.sin(angle), d = dot3(v, axis) * (1 - c);
	const x = [axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2], axis[0] * v[1] - axis[1] * v[0]];
	return v.map((part, i) => part * c + x[i] * s + axis[i] * d);
};

export function eyeAxes(view) {
	const axes = axesOf(view), yawed = axes.map(v => turned(v, [0, 1, 0], eye.yaw));
	return yawed.map(v => turned(v, yawed[0], eye.pitch));
}

// Column by column; positions are from where the view was traced.
export function eyeMatrix(view) {
	const axes = eyeAxes(view);
	return [0, 1, 2].flatMap(k => [...axes.map(v => v[k]), 0]).concat(axes.map(v => -dot3(v, eye.at)), 1);
}

export function turnEye(view, yaw, pitch) {
	const up = Math.asin(Math.max(-1, Math.min(1, -axesOf(view)[2][1])));
	eye.yaw += yaw;
	eye.pitch = Math.max(-1.5 - up, Math.min(1.5 - up, eye.pitch + pitch));
	eye.moved = true;
}

export function moveEye(view, right, up, back) {
	const axes = eyeAxes(view);
	eye.at = eye.at.map((part, i) => part + right * axes[0][i] + up * axes[1][i] + back * axes[2][i]);
	eye.moved = true;
}

export function resetEye() { Object.assign(eye, { yaw: 0, pitch: 0, at: [0, 0, 0], moved: false }); }
