// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: volumes.mjs SOURCE NAME…: draws the volumes NAME.glb with WebGPU over the G-buffer NAME.exr, by the shaders in NAME.wgsl, and
// compares the picture with NAME_expected.exr: for each, the greatest difference and the pixels beyond 1/255. With `clip` in the name
// it uses depth clamp and a depth test, with `faces` also the choice of faces, with `prisms` the vertices of prisms, with
// `device` the depth buffer. Exit code 77: no adapter.
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { create, globals } from 'webgpu';

const [source, ...names] = process.argv.slice(2);
const { readExr } = await import(pathToFileURL(`${source}/site/files.mjs`));
const { readVolumes, VolumesFrame } = await import(pathToFileURL(`${source}/npm/ao/volumes_file.js`));
Object.assign(globalThis, globals);
const gpu = create([]); // must outlive its adapters
const adapter = await gpu.requestAdapter();
if (!adapter) {
	console.log('found no WebGPU adapter, expected a Vulkan driver');
	process.exit(77);
}
const clips = adapter.features.has('depth-clip-control');
const device = await adapter.requestDevice({ requiredFeatures: ['float32-blendable', ...(clips ? ['depth-clip-control'] : [])].filter(one => adapter.features.has(one)) });
const sums_format = device.features.has('float32-blendable') ? 'r32float' : 'r16float';

function bufferOf(values, usage) {
	const buffer = device.createBuffer({ size: Math.ceil(values.byteLength / 4) * 4, usage: usage | GPUBufferUsage.COPY_DST, mappedAtCreation: true });
	new Uint8Array(buffer.getMappedRange()).set(new Uint8Array(values.buffer ?? values, values.byteOffset ?? 0, values.byteLength));
	buffer.unmap();
	return buffer;
}

function textureOf(format, width, height, texels) {
	const { COPY_SRC, COPY_DST, TEXTURE_BINDING, RENDER_ATTACHMENT } = GPUTextureUsage;
	const texture = device.createTexture({ format, size: [width, height], usage: COPY_SRC | COPY_DST | TEXTURE_BINDING | RENDER_ATTACHMENT });
	if (texels) device.queue.writeTexture({ texture }, texels, { bytesPerRow: texels.byteLength / height }, [width, height]);
	return texture;
}

async function drawn(name, { width, height, channels, attributes }) {
	const volumes = readVolumes(readFileSync(`${name}.glb`)), frame = new VolumesFrame(volumes), module = device.createShaderModule({ code: readFileSync(`${name}.wgsl`, 'utf8') });
	const problem = (await module.getCompilationInfo()).messages[0];
	if (problem) throw new Error(`line ${problem.lineNum}: ${problem.message}`);
	const tests = name.includes('clip') || name.includes('faces'), faces = name.includes('faces'), prisms = name.includes('prisms');
	if (tests && !clips) throw new Error('found no depth-clip-control');
	// A projection of z for a depth buffer of 32-bit floats, 0 to 1.
	const projection = [...attributes.projection64], near = 0.1, far = 20;
	[projection[10], projection[14]] = [far / (near - far), far * near / (near - far)];
	frame.set({ cameraFromWorld: attributes.worldToCamera64, projection, width, height, firstRowNdcY: 1, zeroToOne: true, facesByRows: true });
	const depths = textureOf('r32float', width, height, channels.Z.map(one => Math.min(one, 1e30)));
	const normals = textureOf('rgba32float', width, height, Float32Array.from({ length: 4 * width * height }, (_, i) => (i % 4 < 3 ? channels[`N.${'XYZ'[i % 4]}`][i >> 2] : 0)));
	const device_depths = textureOf('depth32float', width, height), sums = textureOf(sums_format, width, height), visibility = textureOf('r32float', width, height);
	const { STORAGE, UNIFORM, VERTEX, INDEX } = GPUBufferUsage, uniform = bufferOf(frame.block, UNIFORM);
	const resources = { nook: { buffer: uniform }, nook_depths: (name.includes('device') ? device_depths : depths).createView(), nook_normals: normals.createView(), nook_sums: sums.createView() };
	for (const [variable, values] of [['nook_corners', volumes.corners], ['nook_polygons', volumes.polygons], ['nook_clusters', frame.seen]]) resources[variable] = { buffer: bufferOf(values, STORAGE) };
	const code = readFileSync(`${name}.wgsl`, 'utf8'), encoder = device.createCommandEncoder();
	const bindings = [...code.matchAll(/@binding\((\d+)\) var(?:<[^>]*>)? (\w+)/g)].map(([, binding, variable]) => ({ binding: +binding, variable }));
	const groupOf = (pipeline, used, own = {}) => device.createBindGroup({ layout: pipeline.getBindGroupLayout(0),
		entries: bindings.filter(({ variable }) => used.includes(variable)).map(({ binding, variable }) => ({ binding, resource: own[variable] ?? resources[variable] })) });

	// The depth buffer, from linear depths.
	const device_values = device.createShaderModule({ code: `@group(0) @binding(0) var depths: texture_2d<f32>;
@vertex fn triangle(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f { return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0); }
@fragment fn depth(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 { let d = textureLoad(depths, vec2i(at.xy), 0).r;
	return clamp((${projection[14]} - ${projection[10]} * d) / d, 0.0, 1.0); }` });
	const to_depth = device.createRenderPipeline({ layout: 'auto', vertex: { module: device_values }, fragment: { module: device_values, targets: [] },
		depthStencil: { format: 'depth32float', depthWriteEnabled: true, depthCompare: 'always' } });
	let pass = encoder.beginRenderPass({ colorAttachments: [], depthStencilAttachment: { view: device_depths.createView(), depthClearValue: 1, depthLoadOp: 'clear', depthStoreOp: 'store' } });
	pass.setPipeline(to_depth);
	pass.setBindGroup(0, device.createBindGroup({ layout: to_depth.getBindGroupLayout(0), entries: [{ binding: 0, resource: depths.createView() }] }));
	pass.draw(3);
	pass.end();

	const add = { srcFactor: 'one', dstFactor: 'one', operation: 'add' };
	const pipelineOf = back => device.createRenderPipelineAsync({ layout: 'auto',
		vertex: { module, entryPoint: prisms ? 'nook_prism_vertex' : 'nook_vertex', constants: { nook_any_depth: tests ? 0 : 1 },
			buffers: prisms ? [{ arrayStride: 8, attributes: [{ shaderLocation: 0, offset: 0, format: 'uint16x4' }] }] : [] },
		fragment: { module, entryPoint: 'nook_fragment', targets: [{ format: sums_format, blend: { color: add, alpha: add } }] },
		primitive: { cullMode: back ? 'front' : 'back', frontFace: frame.mirrored ? 'cw' : 'ccw', unclippedDepth: tests },
		...(tests ? { depthStencil: { format: 'depth32float', depthWriteEnabled: false, depthCompare: back ? 'greater-equal' : 'less-equal' } } : {}) });
	const used = ['nook', 'nook_depths', 'nook_normals', 'nook_corners', 'nook_polygons', 'nook_clusters', 'nook_faces'];
	pass = encoder.beginRenderPass({ colorAttachments: [{ view: sums.createView(), loadOp: 'clear', storeOp: 'store' }],
		...(tests ? { depthStencilAttachment: { view: device_depths.createView(), depthReadOnly: true } } : {}) });
	for (const back of [false, true]) {
		const pipeline = await pipelineOf(back);
		pass.setPipeline(pipeline);
		pass.setBindGroup(0, groupOf(pipeline, used, { nook_faces: { buffer: bufferOf(Int32Array.of(faces ? 1 + back : 0, 0, 0, 0), UNIFORM) } }));
		if (prisms) {
			pass.setVertexBuffer(0, bufferOf(volumes.vertices, VERTEX));
			pass.setIndexBuffer(bufferOf(volumes.indices, INDEX), 'uint16');
		}
		for (const i of frame.inSight()) {
			const cluster = volumes.clusters[i];
			if (!faces && frame.holdsEye(cluster) !== back) continue;
			if (prisms) pass.drawIndexed(cluster.indexCount, 1, cluster.firstIndex, cluster.firstVertex, i);
			else pass.draw(12 * cluster.cornerCount, 1, 12 * cluster.firstCorner, i);
		}
	}
	pass.end();
	const resolve = await device.createRenderPipelineAsync({ layout: 'auto', vertex: { module, entryPoint: 'nook_triangle' },
		fragment: { module, entryPoint: 'nook_resolve', targets: [{ format: 'r32float' }] } });
	pass = encoder.beginRenderPass({ colorAttachments: [{ view: visibility.createView(), loadOp: 'clear', storeOp: 'store' }] });
	pass.setPipeline(resolve);
	pass.setBindGroup(0, groupOf(resolve, ['nook', 'nook_sums']));
	pass.draw(3);
	pass.end();

	const row = Math.ceil(width / 64) * 64, read = device.createBuffer({ size: 4 * row * height, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
	encoder.copyTextureToBuffer({ texture: visibility }, { buffer: read, bytesPerRow: 4 * row }, [width, height]);
	device.queue.submit([encoder.finish()]);
	await read.mapAsync(GPUMapMode.READ);
	const numbers = new Float32Array(read.getMappedRange());
	return Float32Array.from({ length: width * height }, (_, i) => numbers[Math.floor(i / width) * row + i % width]);
}

for (const name of names) {
	device.pushErrorScope('validation');
	let result;
	try {
		const found = await drawn(name, readExr(`${name}.exr`)), expected = readExr(`${name}_expected.exr`).channels.visibility;
		const apart = Array.from(found, (value, i) => Math.abs(value - expected[i]));
		result = `${Math.max(...apart)} ${apart.filter(one => !(one <= 1 / 255)).length}${Math.min(...expected) < 0.8 ? '' : ' nothing dark'}`;
	} catch (error) {
		result = `error ${error.message}`;
	}
	const error = await device.popErrorScope();
	console.log(`${name} ${error ? `error ${error.message}` : result}`.replace(/\n[^]*/, ''));
}
process.exit(0);
