// SPDX-License-Identifier: MIT
// Visibility from a depth texture, without a composer: the passes of the emitted module, and accumulation over frames.
import {
	DataTexture, FloatType, GLSL3, HalfFloatType, LessDepth, Matrix4, NearestFilter, RawShaderMaterial, RedFormat, RGBAFormat, Uniform, UniformsGroup,
	UnsignedByteType, UnsignedShortType, Vector2, WebGLRenderTarget,
} from 'three';
import { FullScreenQuad } from 'three/addons/postprocessing/Pass.js';
import { glslOf, tiles } from './nook_slices.js';
import { blockOf, defineOptions, rows } from './options.js';

const vertexShader = 'in vec3 position;\nvoid main() { gl_Position = vec4(position.xy, 0.5, 1.0); }'; // z is in front of a cleared buffer, reversed or not

/** A full-screen material. `uniforms`: name to value. */
export function screenMaterial(fragmentShader, uniforms, state = {}) {
	return new RawShaderMaterial({
		glslVersion: GLSL3, vertexShader, fragmentShader: `precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n${fragmentShader}`,
		uniforms: Object.fromEntries(Object.entries(uniforms).map(([name, value]) => [name, { value }])), depthTest: false, depthWrite: false, ...state,
	});
}

export const targetOf = (type, format = RGBAFormat, options = {}) =>
	new WebGLRenderTarget(1, 1, { type, format, depthBuffer: false, minFilter: NearestFilter, magFilter: NearestFilter, ...options });

const bitsOf = { [FloatType]: 32, [UnsignedShortType]: 16 }; // of types of depth textures; others have 24

/** Returns whether a renderer can draw now, which it cannot while its context is lost. Throws where it never can. */
export function isReady(renderer, owner) {
	if (renderer.isWebGPURenderer) throw new Error(`${owner}: found a WebGPURenderer, expected a WebGLRenderer; nook-ao/webgpu is for the other`);
	const gl = renderer.getContext();
	if (gl.isContextLost()) return false;
	if (!(gl instanceof WebGL2RenderingContext)) throw new Error(`${owner}: found no WebGL 2, expected it`);
	if (!renderer.extensions.has('EXT_color_buffer_float')) throw new Error(`${owner}: found no EXT_color_buffer_float, expected it to draw linear depth`);
	return true;
}

/** Ambient obscurance of a depth texture. */
export class NookAO {
	constructor(camera, width, height, options = {}) {
		defineOptions(this, 'NookAO', rows, options);
		this.camera = camera;
		this._block = new Uniform(new Float32Array(48));
		this._group = new UniformsGroup().setName('nook_block').add(this._block);
		this._quad = new FullScreenQuad();
		this._frame = 0;
		this._disposed = false;
		this._size = new Vector2();
		this._made = null; // [key, passes] of the settings that the passes were made for
		this._restored = () => this.reset();
		this.setSize(width, height);
	}

	/** The visibility of the last frame, 1 where open, in the first channel. */
	get texture() {
		return this._made?.shown?.texture ?? null;
	}

	/** Linear depths of the last frame, 1e30 for sky. */
	get depths() {
		return this._made?.surface.target.textures[0] ?? null;
	}

	/** View-space normals of the last frame, 0.5 + 0.5 n. */
	get normals() {
		return this._made?.surface.target.textures[1] ?? null;
	}

	setSize(width, height) {
		if (!Number.isFinite(width) || !Number.isFinite(height)) throw new RangeError(`NookAO: found a size of ${width} x ${height}, expected two numbers`);
		this._size.set(Math.max(0, Math.floor(width)), Math.max(0, Math.floor(height)));
	}

	/** Forgets earlier frames. Call it after a cut of the camera. */
	reset() {
		this._age = 0;
	}

	/**
	 * Draws the visibility of a frame. Returns false, and draws nothing, where the size is zero or the context is lost.
	 * normals: a texture of view-space normals, 0.5 + 0.5 n, in place of those computed from depth.
	 */
	render(renderer, depthTexture, normals = null) {
		if (this._disposed) throw new Error('NookAO: found render after dispose, expected a new one');
		if (this._size.x === 0 || this._size.y === 0 || !isReady(renderer, 'NookAO')) return false;
		const logarithmic = renderer.capabilities.logarithmicDepthBuffer === true && this.camera.isOrthographicCamera !== true;
		const reversed = renderer.state.buffers.depth.getReversed?.() === true;
		if (renderer !== this._renderer) {
			this._renderer?.domElement.removeEventListener('webglcontextrestored', this._restored);
			renderer.domElement.addEventListener('webglcontextrestored', this._restored);
			this._renderer = renderer;
		}
		this._prepare(`${this.quality}${this.halfResolution ? '_half' : ''}`, logarithmic, normals !== null);
		this._fill(logarithmic, reversed, bitsOf[depthTexture.type] ?? 24);
		const { surface, passes, upsampling, output } = this._made;
		const { uniforms } = surface.material;
		uniforms.nook_depths.value = depthTexture;
		uniforms.sky.value = Math.min(this.sky, 1e30);
		uniforms.log_far.value = Math.log2(this.camera.far + 1);
		const kept = [renderer.getRenderTarget(), renderer.autoClear, renderer.xr.enabled];
		renderer.autoClear = false;
		renderer.xr.enabled = false;
		for (const { material, target } of [surface, ...passes]) {
			if (normals && material.uniforms.nook_normals) material.uniforms.nook_normals.value = normals;
			renderer.setRenderTarget(target);
			if (upsampling === material) renderer.clear(false, true, false);
			this._quad.material = material;
			this._quad.render(renderer);
		}
		this._made.shown = this.temporal ? this._accumulate(renderer, output) : output;
		if (!this.temporal) this.reset();
		renderer.setRenderTarget(kept[0]);
		[, renderer.autoClear, renderer.xr.enabled] = kept;
		return true;
	}

	dispose() {
		if (this._disposed) return;
		this._disposed = true;
		this._drop();
		this._quad.dispose();
		this._group.dispose();
		this._renderer?.domElement.removeEventListener('webglcontextrestored', this._restored);
		this._renderer = null;
	}

	_drop() {
		for (const one of this._made?.owned ?? []) one.dispose();
		this._made = null;
		this._age = 0;
	}

	_fill(logarithmic, reversed, bits) {
		const { x: width, y: height } = this._size;
		this._block.value = blockOf('NookAO', this, this.camera, {
			width, height, device_depth: !logarithmic, zero_to_one: reversed, depth_bits: bits, frame: this.temporal ? this._frame++ & 1048575 : 0,
		});
	}

	// Passes and targets for the current settings.
	_prepare(name, logarithmic, given) {
		const { x: width, y: height } = this._size;
		const key = [name, logarithmic, given].join();
		if (this._made?.key !== key) {
			this._drop();
			this._made = this._make(name, logarithmic, given);
			this._made.key = key;
		}
		const { targets, halves } = this._made;
		if (targets[0].width !== width || targets[0].height !== height) this.reset();
		for (const target of targets) target.setSize(width, height);
		for (const target of halves) target.setSize((width + 1) >> 1, (height + 1) >> 1);
	}

	_make(name, logarithmic, given) {
		const owned = [], targets = [], halves = [];
		const half = name.endsWith('_half');
		const own = (list, target) => {
			list.push(target);
			owned.push(target);
			return target;
		};
		const material = (head, glsl, body, textures, state) => {
			const one = screenMaterial(`${head}\n${glsl}\n${body}`, textures, state);
			one.uniformsGroups = [this._group];
			owned.push(one);
			return one;
		};
		// Linear depth and normals, once for all passes after it. 0.5001: a component of 0 becomes 128 of 255, whatever its rounding.
		const surfaces = own(targets, targetOf(FloatType, RedFormat, { count: given ? 1 : 2 }));
		if (!given) Object.assign(surfaces.textures[1], { type: UnsignedByteType, format: RGBAFormat });
		const surface = {
			target: surfaces,
			material: material(logarithmic ? `uniform sampler2D nook_depths;
uniform float log_far;
float nookLogDepth(ivec2 pixel) { float t = texelFetch(nook_depths, pixel, 0).r; return t >= 1.0 ? 1e30 : exp2(t * log_far) - 1.0; }
#define NOOK_DEPTH(pixel) nookLogDepth(pixel)` : '', glslOf(logarithmic ? 'medium' : 'device'), `layout(location = 0) out float depth;
${given ? '' : 'layout(location = 1) out vec4 normal;'}
uniform float sky;
void main() {
	ivec2 pixel = ivec2(gl_FragCoord.xy);
	depth = nookDepth(pixel);
	depth = depth < sky ? depth : NOOK_SKY;
	${given ? '' : 'normal = depth < NOOK_SKY ? vec4(0.5001 + 0.5 * nookNormalFromDepth(pixel), 1.0) : vec4(0.5);'}
}`, { nook_depths: null, sky: 1e30, log_far: 1 }),
		};
		const { width, height, texels } = tiles[this.quality];
		const tile = new DataTexture(new Float32Array(texels), width, height, RGBAFormat, FloatType);
		tile.needsUpdate = true;
		owned.push(tile);
		const head = `uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) normalize(texelFetch(nook_normals, pixel, 0).xyz * 2.0 - 1.0)`;
		const glsl = glslOf(name);
		const nook_depths = surfaces.textures[0], nook_normals = surfaces.textures[1] ?? null;
		const passes = [];
		const pass = (type, call, target, state, from = passes.at(-1)?.target.texture ?? null) => {
			const made = material(head, glsl, `out ${type} result;\nvoid main() { ${call} }`, { nook_depths, nook_normals, nook_slices_tile: tile, nook_packed: from }, state);
			passes.push({ material: made, target });
			return made;
		};
		const called = name => `result = ${name}(ivec2(gl_FragCoord.xy));`;
		const cells = half ? halves : targets;
		pass('vec4', called('nookSlicesLinked'), own(cells, targetOf(UnsignedByteType)));
		pass('vec4', called('nookBilateralX'), own(cells, targetOf(UnsignedByteType)));
		let upsampling = null;
		const output = own(targets, targetOf(HalfFloatType, RedFormat, { depthBuffer: half }));
		if (half) {
			pass('vec4', called('nookBilateralYOfSurface'), own(halves, targetOf(FloatType)));
			const { texture } = passes.at(-1).target;
			const state = { depthTest: true, depthWrite: true, depthFunc: LessDepth };
			upsampling = pass('float', `${called('nookUpsample')} if (result < 0.0) discard;`, output, state, texture);
			pass('float', called('nookSlicesLeft'), output, { ...state, depthWrite: false }, texture);
		} else {
			pass('float', called('nookBilateralY'), output);
		}
		const accumulation = material('', glslOf('medium'), accumulate, { nook_depths, current: output.texture, history: null, to_last: new Matrix4(), aged: 0 });
		return { owned, targets, halves, surface, passes, upsampling, output, history: null, accumulation };
	}

	// Mean with earlier frames: history is read where the surface was then, and only where its depth agrees.
	_accumulate(renderer, output) {
		const made = this._made;
		const { camera } = this;
		if (!made.history) {
			made.history = [0, 1].map(() => targetOf(HalfFloatType));
			made.owned.push(...made.history);
			made.targets.push(...made.history);
			for (const target of made.history) target.setSize(this._size.x, this._size.y);
		}
		const [from, to] = made.history;
		made.history.reverse();
		const { uniforms } = made.accumulation;
		const view = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
		uniforms.to_last.value.multiplyMatrices(this._last ?? view, camera.matrixWorld);
		uniforms.history.value = from.texture;
		uniforms.aged.value = Math.min(this._age++, 1);
		this._last = view;
		renderer.setRenderTarget(to);
		this._quad.material = made.accumulation;
		this._quad.render(renderer);
		return to;
	}
}

// history: visibility, clip-space w, number of frames. The four texels around the old place count by their distance, and only
// where w agrees to 2 %. History is kept near the range of the neighbourhood, so that moving objects leave no trail.
const accumulate = `uniform sampler2D current, history;
uniform mat4 to_last;
uniform float aged;
out vec4 result;
void main() {
	ivec2 pixel = ivec2(gl_FragCoord.xy);
	float depth = nookDepth(pixel);
	float own = texelFetch(current, pixel, 0).r;
	float w = nook.w_slope * depth + nook.w_start;
	if (depth >= NOOK_SKY) { result = vec4(1.0, 0.0, 0.0, 1.0); return; }
	vec4 then = to_last * vec4(nookPosition(pixel, depth), 1.0);
	vec2 place = (then.xy / then.w * 0.5 + 0.5) * nook.size - 0.5;
	ivec2 base = ivec2(floor(place));
	vec2 part = place - vec2(base);
	vec3 sum = vec3(0.0);
	for (int i = 0; i < 4; ++i) {
		ivec2 there = base + ivec2(i & 1, i >> 1);
		vec4 old = texelFetch(history, clamp(there, ivec2(nook.first), ivec2(nook.last)), 0);
		float weight = ((i & 1) == 1 ? part.x : 1.0 - part.x) * (i > 1 ? part.y : 1.0 - part.y);
		if (there != clamp(there, ivec2(nook.first), ivec2(nook.last)) || abs(old.y - then.w) > 0.02 * then.w) weight = 0.0;
		sum += weight * vec3(old.x, old.z, 1.0);
	}
	float least = own, most = own;
	for (int i = 0; i < 9; ++i) {
		float one = texelFetch(current, clamp(pixel + ivec2(i % 3 - 1, i / 3 - 1), ivec2(nook.first), ivec2(nook.last)), 0).r;
		least = min(least, one);
		most = max(most, one);
	}
	float frames = aged > 0.0 && sum.z > 0.01 ? min(sum.y / sum.z, 31.0) : 0.0;
	float old = sum.z > 0.01 ? clamp(sum.x / sum.z, least - 0.1, most + 0.1) : own;
	result = vec4((old * frames + own) / (frames + 1.0), w, frames + 1.0, 1.0);
}`;
