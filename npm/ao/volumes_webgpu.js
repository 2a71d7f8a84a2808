// SPDX-License-Identifier: MIT
// Static occlusion from a file of `nook volumes`, for nookPass().
import { wgsl } from './nook_aov.js';
import { readVolumes, VolumesFrame } from './volumes_file.js';

/** The occlusion of a level's volumes, drawn over depths and normals of a frame. */
export class NookVolumes {
	constructor(buffer, decoder) {
		this._volumes = readVolumes(buffer, decoder);
		this._frame = new VolumesFrame(this._volumes);
		this._device = null;
		this._disposed = false;
	}

	// Lowers textures.output to the visibility of the volumes, with commands for the encoder. Depths are linear.
	_draw(device, encoder, camera, width, height, textures) {
		if (this._disposed) throw new Error('NookVolumes: found render after dispose, expected a new one');
		const { clusters } = this._volumes, own = this._frame;
		try {
			own.set({ cameraFromWorld: camera.matrixWorldInverse.elements, projection: camera.projectionMatrix.elements, width, height, firstRowNdcY: 1, zeroToOne: true, facesByRows: true });
		} catch (error) {
			throw new RangeError(`NookVolumes: camera: ${error.message}`);
		}
		if (device !== this._device) this._make(device);
		if (this._sums?.width !== width || this._sums.height !== height) {
			this._sums?.destroy();
			this._sums = device.createTexture({ size: [width, height], format: this._format, usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.RENDER_ATTACHMENT });
		}
		const [block, seen] = this._buffers;
		device.queue.writeBuffer(block, 0, own.block);
		device.queue.writeBuffer(seen, 0, own.seen);
		const drawn = (target, loadOp, draws) => {
			const pass = encoder.beginRenderPass({ colorAttachments: [{ view: target.createView(), loadOp, storeOp: 'store' }] });
			draws((pipeline, resources) => {
				pass.setPipeline(pipeline);
				pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries: Object.entries(resources).map(([binding, one]) =>
					({ binding: +binding, resource: one instanceof GPUTexture ? one.createView() : { buffer: one } })) }));
				return pass;
			});
			pass.end();
		};
		const [, , corners, polygons] = this._buffers, sight = own.inSight();
		drawn(this._sums, 'clear', use => {
			for (const within of [false, true]) {
				const cullMode = within ? 'front' : 'back';
				const pass = use(this._pipeline(cullMode, own.mirrored ? 'cw' : 'ccw'), { 0: block, 1: textures.depths, 2: textures.normals, 3: corners, 4: polygons, 5: seen });
				for (const i of sight) {
					const { cornerCount, firstCorner } = clusters[i];
					if (own.holdsEye(clusters[i]) === within) pass.draw(12 * cornerCount, 1, 12 * firstCorner, i);
				}
			}
		});
		drawn(textures.output, 'load', use => use(this._resolve, { 0: block, 13: this._sums }).draw(3));
	}

	_make(device) {
		this._free();
		this._device = device;
		this._format = device.features.has('float32-blendable') ? 'r32float' : 'r16float'; // 16 bits round sums of many volumes, by up to 0.01
		const module = device.createShaderModule({ code: wgsl }), one = operation => ({ operation, srcFactor: 'one', dstFactor: 'one' }), blend = operation => ({ color: one(operation), alpha: one(operation) });
		const made = (entry, into, format, operation, primitive = {}) => device.createRenderPipeline({ layout: 'auto', primitive,
			vertex: { module, entryPoint: entry, constants: entry === 'nook_vertex' ? { nook_any_depth: 1 } : {} }, // no depth test
			fragment: { module, entryPoint: into, targets: [{ format, blend: blend(operation) }] } });
		const pipelines = {};
		this._pipeline = (cullMode, frontFace) => (pipelines[cullMode + frontFace] ??= made('nook_vertex', 'nook_fragment', this._format, 'add', { cullMode, frontFace }));
		this._resolve = made('nook_triangle', 'nook_resolve', 'r16float', 'min');
		const { corners, polygons } = this._volumes;
		this._buffers = [[this._frame.block, GPUBufferUsage.UNIFORM], [this._frame.seen, GPUBufferUsage.STORAGE], [corners, GPUBufferUsage.STORAGE], [polygons, GPUBufferUsage.STORAGE]].map(([items, usage]) => {
			const buffer = device.createBuffer({ size: Math.max(16, items.byteLength), usage: usage | GPUBufferUsage.COPY_DST });
			device.queue.writeBuffer(buffer, 0, items);
			return buffer;
		});
	}

	/** Frees everything. Further calls do nothing. */
	dispose() {
		this._disposed = true;
		this._free();
	}

	_free() {
		for (const one of [...(this._buffers ?? []), this._sums]) one?.destroy();
		this._buffers = this._sums = this._device = null;
	}
}
