// SPDX-License-Identifier: MIT
// The pass for WebGPURenderer: a node that draws a scene, and its visibility with the emitted WGSL on the renderer's own device.
import { Color, DepthTexture, FloatType, HalfFloatType, Matrix4, MeshBasicMaterial, NearestFilter, PassNode, RedFormat, RenderTarget, Vector2 } from 'three/webgpu';
import { passTexture } from 'three/tsl';
import { excludedOf, hide, hideOthers, show } from './exclude.js';
import { tiles } from './nook_slices.js';
import { wgslOf } from './nook_slices_wgsl.js';
import { blockOf, defineOptions, passRows, views } from './options.js';
import { NookVolumes } from './volumes_webgpu.js';

export { NookVolumes };

const rowsHere = passRows(Color, value => value instanceof NookVolumes);

// now: of this frame. Linear depth and normals, once for all passes after it; 0.5001: a component of 0 becomes 128 of 255, whatever its
// rounding.
const frame = `
struct Now { sky: f32, tint_r: f32, tint_g: f32, tint_b: f32, view: f32, split: f32, range: f32, aged: f32, to_last: mat4x4f }
@group(0) @binding(13) var<uniform> now: Now;
`;
const surface = `${frame}
struct Surface { @location(0) depth: f32, @location(1) normal: vec4f }
@fragment
fn main_surface(@builtin(position) place: vec4f) -> Surface {
	let pixel = vec2i(place.xy);
	let depth = nookDepth(pixel);
	if (depth >= min(now.sky, NOOK_SKY)) { return Surface(NOOK_SKY, vec4f(0.5)); }
	return Surface(depth, vec4f(0.5001 + 0.5 * nookNormalFromDepth(pixel), 1.0));
}`;
// The factor of the colours, the other views, and the mean of frames, which ao.js explains; rows are counted from the top here.
const finish = `${frame}
@group(0) @binding(14) var history: texture_2d<f32>;
@fragment
fn main_factor(@builtin(position) place: vec4f) -> @location(0) vec4f {
	let open = textureLoad(nook_packed, vec2i(place.xy), 0).r;
	return vec4f(mix(vec3f(now.tint_r, now.tint_g, now.tint_b), vec3f(1.0), select(open, 1.0, now.view == 2.0 && place.x < now.split)), 1.0);
}
@fragment
fn main_view(@builtin(position) place: vec4f) -> @location(0) vec4f {
	let pixel = vec2i(place.xy);
	if (now.view == 4.0) { return vec4f(textureLoad(nook_normals, pixel, 0).rgb, 1.0); }
	return vec4f(vec3f(select(textureLoad(nook_packed, pixel, 0).r, min(nookDepth(pixel) / now.range, 1.0), now.view == 5.0)), 1.0);
}
struct Mean { @location(0) history: vec4f, @location(1) open: vec4f }
@fragment
fn main_mean(@builtin(position) at: vec4f) -> Mean {
	let pixel = vec2i(at.xy);
	let depth = nookDepth(pixel);
	let own = textureLoad(nook_packed, pixel, 0).r;
	let w = nook.w_slope * depth + nook.w_start;
	if (depth >= NOOK_SKY) { return Mean(vec4f(1.0, 0.0, 0.0, 1.0), vec4f(1.0)); }
	let then = now.to_last * vec4f(nookPosition(pixel, depth), 1.0);
	let place = (vec2f(then.x, -then.y) / then.w * 0.5 + 0.5) * nook.size - 0.5;
	let base = vec2i(floor(place));
	let part = place - vec2f(base);
	let first = vec2i(nook.first);
	let last = vec2i(nook.last);
	var sum = vec3f(0.0);
	for (var i = 0; i < 4; i++) {
		let there = base + vec2i(i & 1, i >> 1u);
		let old = textureLoad(history, clamp(there, first, last), 0);
		let weight = select(1.0 - part.x, part.x, (i & 1) == 1) * select(1.0 - part.y, part.y, i > 1);
		if (all(there == clamp(there, first, last)) && abs(old.y - then.w) <= 0.02 * then.w) { sum += weight * vec3f(old.x, old.z, 1.0); }
	}
	var least = own;
	var most = own;
	for (var i = 0; i < 9; i++) {
		let one = textureLoad(nook_packed, clamp(pixel + vec2i(i % 3 - 1, i / 3 - 1), first, last), 0).r;
		least = min(least, one);
		most = max(most, one);
	}
	let frames = select(0.0, min(sum.y / sum.z, 31.0), now.aged > 0.0 && sum.z > 0.01);
	let old = select(own, clamp(sum.x / sum.z, least - 0.1, most + 0.1), sum.z > 0.01);
	let open = (old * frames + own) / (frames + 1.0);
	return Mean(vec4f(open, w, frames + 1.0, 1.0), vec4f(open));
}`;
const TEXTURES = { nook_depths: 1, nook_normals: 2, nook_packed: 11, nook_slices_tile: 12, history: 14 }; // bindings

/** Draws the passes of a module on a device. */
class Drawer {
	constructor(device, { quality, halfResolution: half, temporal }, format) {
		const visibility = GPUShaderStage.FRAGMENT;
		this.device = device;
		this.buffers = [192, 96].map(size => device.createBuffer({ size, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST }));
		this.layout = device.createBindGroupLayout({ entries: [
			{ binding: 0, visibility, buffer: {} }, { binding: 13, visibility, buffer: {} },
			...Object.values(TEXTURES).map(binding => ({ binding, visibility, texture: { sampleType: 'unfilterable-float' } })),
		] });
		const layout = device.createPipelineLayout({ bindGroupLayouts: [this.layout] });
		const [first, others] = [wgslOf('device') + surface, wgslOf(`${quality}${half ? '_half' : ''}`) + finish].map(code => device.createShaderModule({ code }));
		// targets: name to format; part: the picture's size over theirs; from: the name of what it reads as nook_packed
		const pass = (module, entry, targets, part, from, blend) => ({ targets, part, from, pipeline: device.createRenderPipeline({ layout,
			vertex: { module, entryPoint: 'triangle' },
			fragment: { module, entryPoint: `main_${entry}`, targets: Object.values(targets).map(format => ({ format, blend })) } }) });
		const times = (srcFactor, dstFactor) => ({ operation: 'add', srcFactor, dstFactor });
		const last = { [temporal ? 'current' : 'output']: 'r16float' }, part = half ? 2 : 1;
		this.passes = [
			pass(first, 'surface', { depths: 'r32float', normals: 'rgba8unorm' }, 1),
			pass(others, 'nookSlicesLinked', { linked: 'rgba8unorm' }, part),
			pass(others, 'nookBilateralX', { rows: 'rgba8unorm' }, part, 'linked'),
			...(half ? [pass(others, 'nookBilateralYOfSurface', { surfaces: 'rgba32float' }, 2, 'rows'), pass(others, 'nookSlicesFull', last, 1, 'surfaces')] :
				[pass(others, 'nookBilateralY', last, 1, 'rows')]),
			...(temporal ? [pass(others, 'mean', { to: 'rgba16float', output: 'r16float' }, 1, 'current')] : []),
		];
		this.factor = pass(others, 'factor', { colours: format }, 1, 'output', { color: times('zero', 'src'), alpha: times('zero', 'one') });
		this.view = pass(others, 'view', { colours: format }, 1, 'output');
		this.empty = this.texture(1, 1, 'rgba8unorm');
		const { width, height, texels } = tiles[quality];
		this.tile = this.texture(width, height, 'rgba32float');
		device.queue.writeTexture({ texture: this.tile }, new Float32Array(texels), { bytesPerRow: 16 * width }, [width, height]);
	}

	texture(width, height, format) {
		return this.device.createTexture({ size: [width, height], format, usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_DST });
	}

	/** Returns whether the size is another, which forgets earlier frames. */
	setSize(width, height) {
		if (this.size === `${width},${height}`) return false;
		this.size = `${width},${height}`;
		for (const one of Object.values(this.own ?? {})) one.destroy();
		this.own = {};
		for (const { targets, part } of this.passes) {
			for (const [name, format] of Object.entries(targets)) if (name !== 'output') this.own[name] = this.texture(Math.ceil(width / part), Math.ceil(height / part), format);
		}
		if (this.own.to) this.own.from = this.texture(width, height, 'rgba16float');
		return true;
	}

	draw(depths, outputs, block, now, view, volumes) {
		const { device, own } = this;
		[block, new Float32Array(now)].forEach((bytes, i) => device.queue.writeBuffer(this.buffers[i], 0, bytes));
		const encoder = device.createCommandEncoder();
		if (own.to) [own.to, own.from] = [own.from, own.to];
		const textures = { ...own, ...outputs };
		const run = ({ pipeline, targets, from }) => {
			const names = Object.keys(targets);
			const read = { nook_depths: textures.depths, nook_normals: textures.normals, nook_packed: textures[from] ?? this.empty, nook_slices_tile: this.tile,
				history: from === 'current' ? textures.from : this.empty };
			if (names[0] === 'depths') Object.assign(read, { nook_depths: null, nook_normals: this.empty });
			const pass = encoder.beginRenderPass({ colorAttachments: names.map(name => ({ view: textures[name].createView(), loadOp: name === 'colours' ? 'load' : 'clear', storeOp: 'store' })) });
			pass.setPipeline(pipeline);
			pass.setBindGroup(0, device.createBindGroup({ layout: this.layout, entries: [
				{ binding: 0, resource: { buffer: this.buffers[0] } }, { binding: 13, resource: { buffer: this.buffers[1] } },
				...Object.entries(TEXTURES).map(([name, binding]) => ({ binding, resource: read[name]?.createView() ?? depths.createView({ aspect: 'depth-only' }) })),
			] }));
			pass.draw(3);
			pass.end();
		};
		this.passes.forEach(run);
		volumes?.(encoder, textures);
		if (view > 2) run(this.view);
		else if (view !== 1) run(this.factor);
		device.queue.submit([encoder.finish()]);
	}

	dispose() {
		for (const one of [...Object.values(this.own ?? {}), ...this.buffers, this.empty, this.tile]) one.destroy();
	}
}

const invisible = [0, 1, 2].map(side => new MeshBasicMaterial({ colorWrite: false, depthWrite: false, side }));

class NookPassNode extends PassNode {
	static get type() {
		return 'NookPassNode';
	}

	constructor(scene, camera, options = {}) {
		super(PassNode.COLOR, scene, camera, { samples: 0, depthTexture: new DepthTexture(1, 1, FloatType) }); // WebGPU resolves no depths
		defineOptions(this, 'nookPass', rowsHere, options);
		this._output = new RenderTarget(1, 1, { type: HalfFloatType, format: RedFormat, depthBuffer: false, minFilter: NearestFilter, magFilter: NearestFilter });
		this._output.texture.name = 'visibility';
		this._drawer = null;
		this._frame = 0;
	}

	/** Visibility, 1 where open, as a node. */
	getVisibilityNode() {
		return passTexture(this, this._output.texture).r;
	}

	/** Forgets earlier frames of temporal: true. Call it after a cut of the camera. */
	reset() {
		this._last = null;
	}

	updateBefore(frame) {
		const { renderer } = frame, { scene } = this;
		if (renderer.backend.isWebGPUBackend !== true) throw new Error('nookPass: found a renderer without WebGPU, expected WebGPU; NookPass of nook-ao is for WebGL 2');
		if (renderer.logarithmicDepthBuffer === true) throw new Error('nookPass: found logarithmicDepthBuffer, expected a linear or reversed depth buffer');
		const { x, y } = renderer.getDrawingBufferSize(new Vector2());
		if (x === 0 || y === 0 || this._isLost(renderer.backend.device)) return;
		if (!this.camera.projectionMatrix.elements.every(Number.isFinite)) throw new RangeError('nookPass: camera: projection: found infinity or NaN, expected 16 finite numbers');
		// Other objects, their obscurance, and excluded objects over it.
		const excluded = excludedOf(this), view = views.indexOf(this.view);
		let hidden = hide(excluded, invisible);
		super.updateBefore(frame);
		show(hidden);
		const { width, height } = this.renderTarget;
		this._output.setSize(width, height);
		renderer.initRenderTarget(this._output);
		this._draw(renderer, width, height, view);
		if (excluded.length === 0 || view > 2) return;
		const { background, backgroundNode } = scene, { autoClear } = this;
		Object.assign(scene, { background: null, backgroundNode: null }); // they would be drawn over the others
		this.autoClear = false;
		hidden = hideOthers(scene, excluded);
		super.updateBefore(frame);
		show(hidden);
		this.autoClear = autoClear;
		Object.assign(scene, { background, backgroundNode });
	}

	// three.js goes on with a device that was destroyed.
	_isLost(device) {
		if (this._device !== device) {
			this._device = device;
			this._lost = false;
			device.lost.then(({ message }) => {
				if (this._device !== device) return;
				this._lost = true;
				console.warn(`nookPass: the device is lost, and the last picture stays: ${message}`);
			});
		}
		return this._lost;
	}

	_draw(renderer, width, height, view) {
		const { device } = renderer.backend, textureOf = one => renderer.backend.get(one).texture, colours = textureOf(this.renderTarget.texture), { camera } = this;
		const key = [this.quality, this.halfResolution, this.temporal, colours.format].join();
		if (this._drawer?.device !== device || this._drawer.key !== key) {
			this._drawer?.dispose();
			this._drawer = Object.assign(new Drawer(device, this, colours.format), { key });
		}
		if (this._drawer.setSize(width, height) || !this.temporal) this.reset();
		const block = blockOf('nookPass', this, camera, { width, height, device_depth: true, zero_to_one: true, first_row_ndc_y: 1, frame: this.temporal ? this._frame++ & 1048575 : 0 });
		const seen = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse), last = this._last;
		this._last = seen;
		const now = [Math.min(this.sky, 1e30), ...this.tint, view, 0.5 * width, 20 * this.radius, last ? 1 : 0, ...new Matrix4().multiplyMatrices(last ?? seen, camera.matrixWorld).elements];
		const volumes = this.volumes && ((encoder, textures) => this.volumes._draw(device, encoder, camera, width, height, textures));
		this._drawer.draw(textureOf(this.renderTarget.depthTexture), { output: textureOf(this._output.texture), colours }, block, now, view, volumes);
	}

	dispose() {
		super.dispose();
		this._output.dispose();
		this._drawer?.dispose();
		this._drawer = this._device = null;
	}
}

/** A node that draws a scene with ambient occlusion, for the RenderPipeline of WebGPURenderer, in place of pass(scene, camera). */
export const nookPass = (scene, camera, options) => new NookPassNode(scene, camera, options);
