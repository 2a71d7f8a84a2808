// SPDX-License-Identifier: GPL-3.0-or-later
// Emitted modules in OpenGL ES 3.0, their block and their passes → visibility, and two of them on either side of a line.
import { bytesOf, data } from 'nook:page';
import { aim, bindPictures, pictureOf, PICTURES, programOf } from './gl.js';

const LAST_FRAGMENTS = `#version 300 es
precision highp float;
precision highp int;
uniform sampler2D left, right, depths, normals;
uniform float share;
uniform bool lit;
uniform vec3 up;
layout(location = 0) out vec4 colour;
void main()
{
	ivec2 size = textureSize(left, 0);
	ivec2 at = ivec2(gl_FragCoord.xy);
	at.y = size.y - 1 - at.y;
	int edge = int(floor(share * float(size.x) + 0.5));
	float v = at.x < edge ? texelFetch(left, at, 0).r : texelFetch(right, at, 0).r;
	vec3 shown = vec3(v);
	if (lit)
	{
		float sky = 0.5 + 0.5 * dot(texelFetch(normals, at, 0).xyz, up);
		shown = sqrt(v * mix(vec3(0.30, 0.26, 0.22), vec3(0.62, 0.68, 0.78), sky));
		shown = texelFetch(depths, at, 0).r >= 1e30 ? vec3(0.72, 0.80, 0.90) : shown;
	}
	colour = at.x == edge && edge > 0 && edge < size.x ? vec4(0.84, 0.24, 0.16, 1.0) : vec4(shown, 1.0);
}`;

export const shading = data.shading;
export const methodNamed = name => shading.methods.find(method => method.name === name);

// How an engine would call a pass of the list in a module's head.
function passShader(gl, module, call, format) {
	return `#version 300 es\n${module}layout(location = 0) out highp ${PICTURES[format](gl).glsl} colour;\n`
		+ `void main()\n{\n\tcolour = ${call}(ivec2(gl_FragCoord.xy));\n}\n`;
}

// The block with what a person has set: {member: number}.
function fillBlock(gl, buffer, method, numbers) {
	const bytes = bytesOf(method.block), values = new DataView(bytes.buffer);
	const { radius, ...others } = numbers, set = (member, value) => values.setFloat32(shading.members[member], value, true);
	for (const [member, share] of Object.entries(method.lengths)) set(member, share * radius); // the recipe's, of the reach
	for (const [member, value] of Object.entries(others)) set(member, value);
	gl.bindBuffer(gl.UNIFORM_BUFFER, buffer);
	gl.bufferData(gl.UNIFORM_BUFFER, bytes, gl.DYNAMIC_DRAW);
	gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, buffer);
}

// One way of shading: a method, its module and its samples. Draws into pictures of its own.
export function makeShader(gl, method, { module, plan }, samples) {
	const pictures = plan.pictures.map(shape => pictureOf(gl, shape)), buffer = gl.createBuffer();
	const tile = samples && pictureOf(gl, { format: 'quad', width: samples.width, height: samples.height }, samples.texels);
	const programsOf = plan.passes.map(pass => programOf(gl, passShader(gl, module, pass.call, pictures[pass.picture].format)));
	const draw = (scene, numbers) => {
		fillBlock(gl, buffer, method, numbers);
		plan.passes.forEach((pass, i) => drawPass(gl, programsOf[i], pass, pictures, { nook_depths: scene.depths, nook_normals: scene.normals,
			...(tile ? { [`nook_${method.name.replace('-', '_')}_tile`]: tile } : {}) }));
		return pictures[plan.passes[plan.passes.length - 1].picture];
	};
	const free = () => { for (const picture of [...pictures, tile]) if (picture) gl.deleteTexture(picture.texture); gl.deleteBuffer(buffer); };
	return { draw, free };
}

function drawPass(gl, program, pass, pictures, inputs) {
	const target = pictures[pass.picture], bound = { ...inputs };
	for (const [name, picture] of pass.reads) bound[name] = pictures[picture];
	const own = pass.reads.some(([, picture]) => picture === pass.picture); // reads the levels before the one that it draws
	const limit = level => { gl.bindTexture(target.target, target.texture); gl.texParameteri(target.target, gl.TEXTURE_MAX_LEVEL, level); };
	if (own) limit(Math.max(0, pass.level - 1));
	gl.useProgram(program);
	bindPictures(gl, program, bound);
	const numbers = gl.getUniformLocation(program, 'nook_pass');
	if (numbers) gl.uniform4iv(numbers, pass.numbers);
	aim(gl, target, pass.level, pass.layer);
	if (!own || pass.level > 0) gl.drawArrays(gl.TRIANGLES, 0, 3);
	else drawFirstLevel(gl, program, pass, bound);
	if (own) limit(1000);
}

// The first level comes from the depths: nothing of the picture itself may be bound.
function drawFirstLevel(gl, program, pass, bound) {
	const others = Object.fromEntries(Object.entries(bound).filter(([name]) => !pass.reads.some(([read]) => read === name)));
	const unit = Object.keys(bound).length;
	for (const [name] of pass.reads) {
		const place = gl.getUniformLocation(program, name);
		gl.activeTexture(gl.TEXTURE0 + unit);
		gl.bindTexture(gl.TEXTURE_2D, null);
		if (place) gl.uniform1i(place, unit);
	}
	bindPictures(gl, program, others);
	gl.drawArrays(gl.TRIANGLES, 0, 3);
}

export function drawSplit(gl, scene, left, right, { share, lit, up }) {
	const program = programOf(gl, LAST_FRAGMENTS), place = name => gl.getUniformLocation(program, name);
	gl.useProgram(program);
	bindPictures(gl, program, { left, right, depths: scene.depths, normals: scene.normals });
	gl.uniform1f(place('share'), share);
	gl.uniform1i(place('lit'), lit);
	gl.uniform3fv(place('up'), up);
	gl.bindFramebuffer(gl.FRAMEBUFFER, null);
	gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
	gl.drawArrays(gl.TRIANGLES, 0, 3);
}

// The tile that an emitted header holds: {width, height, texels}.
export function tileOfHeader(header) {
	const sides = /_tile_width = (\d+);[^]*_tile_height = (\d+);/.exec(header);
	const rows = /_tile\[\d+\]\[4\] = \{\n([^]*?)\n\};/.exec(header)[1];
	return { width: +sides[1], height: +sides[2], texels: Float32Array.from(rows.replace(/[{}f\s]/g, '').split(',').filter(Boolean), Number) };
}
