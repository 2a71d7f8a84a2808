// SPDX-License-Identifier: MIT
// The pass for WebGPURenderer: a node that draws a scene, and its visibility with the emitted WGSL on the renderer's own device.
import { Color, DepthTexture, FloatType, HalfFloatType, NearestFilter, PassNode, RedFormat, RenderTarget, Vector2 } from 'three/webgpu';
import { passTexture } from 'three/tsl';
import { fill, recipe, tiles } from './nook_slices.js';
import { wgslOf } from './nook_slices_wgsl.js';
import { defineOptions, rows, truth } from './options.js';

const { temporal, ...shared } = rows; // frames are not averaged here
const passRows = {
	...shared,
	tint: { fallback: 0x000000, valid: value => value !== undefined && value !== null, expected: 'a colour', stored: value => new Color(value) },
	excludeTransparent: truth(true),
};

// Linear depth and normals, once for all passes after it; and the factor of the colours. limits: depth of the sky, and the tint.
const surface = `
@group(0) @binding(13) var<uniform> limits: vec4f;
struct Surface { @location(0) depth: f32, @location(1) normal: vec4f }
@fragment
fn main_surface(@builtin(position) place: vec4f) -> Surface {
	let pixel = vec2i(place.xy);
	var depth = nookDepth(pixel);
	if (depth >= limits.x) { depth = NOOK_SKY; }
	if (depth >= NOOK_SKY) { return Surface(NOOK_SKY, vec4f(0.5)); }
	return Surface(depth, vec4f(0.5 + 0.5 * nookNormalFromDepth(pixel), 1.0));
}
@fragment
fn main_factor(@builtin(position) place: vec4f) -> @location(0) vec4f {
	return vec4f(mix(limits.yzw, vec3f(1.0), textureLoad(nook_packed, vec2i(place.xy), 0).r), 1.0);
}`;
const TEXTURES = { nook_depths: 1, nook_normals: 2, nook_packed: 11, nook_slices_tile: 12 }; // bindings

/** Draws the passes of a module on a device. */
class Drawer {
	constructor(device, name, quality, format) {
		const visibility = GPUShaderStage.FRAGMENT;
		const half = name.endsWith('_half');
		this.device = device;
		this.format = format;
		this.buffers = [192, 16].map(size => device.createBuffer({ size, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST }));
		this.layout = device.createBindGroupLayout({ entries: [
			{ binding: 0, visibility, buffer: {} }, { binding: 13, visibility, buffer: {} },
			...Object.values(TEXTURES).map(binding => ({ binding, visibility, texture: { sampleType: 'unfilterable-float' } })),
		] });
		const layout = device.createPipelineLayout({ bindGroupLayouts: [this.layout] });
		const [first, others] = [wgslOf('device') + surface, wgslOf(name)].map(code => device.createShaderModule({ code }));
		const pipelineOf = (module, entry, targets) => device.createRenderPipeline({ layout, vertex: { module, entryPoint: 'triangle' },
			fragment: { module, entryPoint: `main_${entry}`, targets } });
		const pipeline = (module, entry, ...formats) => pipelineOf(module, entry, formats.map(format => ({ format })));
		const times = (srcFactor, dstFactor) => ({ operation: 'add', srcFactor, dstFactor });
		// [pipeline, names of its targets, size of them, name of what it reads as nook_packed]
		this.passes = [
			[pipeline(first, 'surface', 'r32float', 'rgba8unorm'), ['depths', 'normals'], 1],
			[pipeline(others, 'nookSlicesLinked', 'rgba8unorm'), ['linked'], half ? 2 : 1],
			[pipeline(others, 'nookBilateralX', 'rgba8unorm'), ['rows'], half ? 2 : 1, 'linked'],
			...(half ? [
				[pipeline(others, 'nookBilateralYOfSurface', 'rgba32float'), ['surfaces'], 2, 'rows'], [pipeline(others, 'nookSlicesFull', 'r16float'), ['output'], 1, 'surfaces'],
			] : [[pipeline(others, 'nookBilateralY', 'r16float'), ['output'], 1, 'rows']]),
			[pipelineOf(first, 'factor', [{ format, blend: { color: times('zero', 'src'), alpha: times('zero', 'one') } }]), ['colours'], 1, 'output'],
		];
		this.formats = { depths: 'r32float', normals: 'rgba8unorm', linked: 'rgba8unorm', rows: 'rgba8unorm', surfaces: 'rgba32float' };
		this.empty = this.texture(1, 1, 'rgba8unorm');
		const { width, height, texels } = tiles[quality];
		this.tile = this.texture(width, height, 'rgba32float');
		device.queue.writeTexture({ texture: this.tile }, new Float32Array(texels), { bytesPerRow: 16 * width }, [width, height]);
	}

	texture(width, height, format) {
		return this.device.createTexture({ size: [width, height], format, usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_DST });
	}

	setSize(width, height) {
		if (this.size === `${width},${height}`) return;
		this.size = `${width},${height}`;
		for (const one of Object.values(this.own ?? {})) one.destroy();
		this.own = {};
		for (const [, names, part] of this.passes) {
			for (const name of names.filter(one => this.formats[one])) this.own[name] = this.texture(Math.ceil(width / part), Math.ceil(height / part), this.formats[name]);
		}
	}

	draw(depths, outputs, block, limits) {
		const { device } = this;
		[block, new Float32Array(limits)].forEach((bytes, i) => device.queue.writeBuffer(this.buffers[i], 0, bytes));
		const encoder = device.createCommandEncoder();
		const textures = { ...this.own, ...outputs };
		for (const [pipeline, names, , from] of this.passes) {
			const read = { nook_depths: textures.depths, nook_normals: textures.normals, nook_packed: textures[from] ?? this.empty, nook_slices_tile: this.tile };
			if (names[0] === 'depths') Object.assign(read, { nook_depths: null, nook_normals: this.empty });
			const pass = encoder.beginRenderPass({ colorAttachments: names.map(name => ({ view: textures[name].createView(), loadOp: name === 'colours' ? 'load' : 'clear', storeOp: 'store' })) });
			pass.setPipeline(pipeline);
			pass.setBindGroup(0, device.createBindGroup({ layout: this.layout, entries: [
				{ binding: 0, resource: { buffer: this.buffers[0] } }, { binding: 13, resource: { buffer: this.buffers[1] } },
				...Object.entries(TEXTURES).map(([name, binding]) => ({ binding, resource: read[name]?.createView() ?? depths.createView({ aspect: 'depth-only' }) })),
			] }));
			pass.draw(3);
			pass.end();
		}
		device.queue.submit([encoder.finish()]);
	}

	dispose() {
		for (const one of [...Object.values(this.own ?? {}), ...this.buffers, this.empty, this.tile]) one.destroy();
	}
}

class NookPassNode extends PassNode {
	static get type() {
		return 'NookPassNode';
	}

	constructor(scene, camera, options = {}) {
		super(PassNode.COLOR, scene, camera, { samples: 0, depthTexture: new DepthTexture(1, 1, FloatType) }); // WebGPU resolves no depths
		defineOptions(this, 'nookPass', passRows, options);
		this._output = new RenderTarget(1, 1, { type: HalfFloatType, format: RedFormat, depthBuffer: false, minFilter: NearestFilter, magFilter: NearestFilter });
		this._output.texture.name = 'visibility';
		this._drawer = null;
	}

	/** Visibility, 1 where open, as a node. */
	getVisibilityNode() {
		return passTexture(this, this._output.texture).r;
	}

	updateBefore(frame) {
		const { renderer } = frame;
		if (renderer.backend.isWebGPUBackend !== true) throw new Error('nookPass: found a renderer without WebGPU, expected WebGPU; NookPass of nook-ao is for WebGL 2');
		if (renderer.logarithmicDepthBuffer === true) throw new Error('nookPass: found logarithmicDepthBuffer, expected a linear or reversed depth buffer');
		const { x, y } = renderer.getDrawingBufferSize(new Vector2());
		if (x === 0 || y === 0) return;
		if (!this.camera.projectionMatrix.elements.every(Number.isFinite)) throw new RangeError('nookPass: camera: projection: found infinity or NaN, expected 16 finite numbers');
		// Opaque objects, their obscurance, and transparent objects over it.
		let later = false;
		if (this.excludeTransparent) this.scene.traverseVisible(({ material }) => { later ||= [material ?? []].flat().some(one => one.transparent); });
		const kept = [this.opaque, this.transparent, this.autoClear];
		if (later) this.transparent = false;
		super.updateBefore(frame);
		const { width, height } = this.renderTarget;
		this._output.setSize(width, height);
		renderer.initRenderTarget(this._output);
		this._draw(renderer, width, height);
		if (later) {
			const { background } = this.scene;
			this.scene.background = null; // a colour would clear what was drawn
			Object.assign(this, { opaque: false, transparent: kept[1], autoClear: false });
			super.updateBefore(frame);
			this.scene.background = background;
		}
		[this.opaque, this.transparent, this.autoClear] = kept;
	}

	_draw(renderer, width, height) {
		const { device } = renderer.backend, textureOf = one => renderer.backend.get(one).texture, colours = textureOf(this.renderTarget.texture);
		const name = `${this.quality}${this.halfResolution ? '_half' : ''}`;
		if (this._drawer?.device !== device || this._drawer.name !== name || this._drawer.format !== colours.format) {
			this._drawer?.dispose();
			this._drawer = Object.assign(new Drawer(device, name, this.quality, colours.format), { name });
		}
		this._drawer.setSize(width, height);
		const { radius, slice_thickness, strength, power } = recipe;
		let block;
		try {
			block = fill(this.camera.projectionMatrix.elements, {
				width, height, radius: radius * this.radius, slice_thickness, strength, power: power * this.intensity, device_depth: true, zero_to_one: true, depth_bits: 32,
				first_row_ndc_y: 1,
			});
		} catch (error) {
			throw new RangeError(`nookPass: camera: ${error.message}`);
		}
		this._drawer.draw(textureOf(this.renderTarget.depthTexture), { output: textureOf(this._output.texture), colours }, block, [Math.min(this.sky, 1e30), ...this.tint]);
	}

	dispose() {
		super.dispose();
		this._output.dispose();
		this._drawer?.dispose();
		this._drawer = null;
	}
}

/** A node that draws a scene with ambient occlusion, for the RenderPipeline of WebGPURenderer, in place of pass(scene, camera). */
export const nookPass = (scene, camera, options) => new NookPassNode(scene, camera, options);
