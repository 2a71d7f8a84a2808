// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: draw.mjs SOURCE NAME…: draws the complete shaders NAME.wgsl with WebGPU over the G-buffer in g.exr, by the passes in
// NAME.json, or `page` by the script of a page, and compares the last picture with NAME.exr: for each, the greatest difference and the pixels beyond 1/255. Exit code 77:
// no adapter.
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { create, globals } from 'webgpu';

const [source, ...names] = process.argv.slice(2);
const { readExr } = await import(pathToFileURL(`${source}/site/files.mjs`));
Object.assign(globalThis, globals);
const gpu = create([]); // must outlive its adapters
const adapter = await gpu.requestAdapter();
if (!adapter) {
	console.log('found no WebGPU adapter, expected a Vulkan driver');
	process.exit(77);
}
const device = await adapter.requestDevice();

const FORMATS = { scalar: ['r32float', 1], quad: ['rgba32float', 4], counts: ['rgba32uint', 4] };

function pictureOf({ format, width, height, levels = 1, layers = 1 }, texels) {
	const [inside, channels] = FORMATS[format], usage = GPUTextureUsage;
	const texture = device.createTexture({ format: inside, size: [width, height, layers], mipLevelCount: levels,
		usage: usage.COPY_SRC | usage.COPY_DST | usage.TEXTURE_BINDING | usage.RENDER_ATTACHMENT | (levels * layers === 1 ? usage.STORAGE_BINDING : 0) });
	if (texels) device.queue.writeTexture({ texture }, texels, { bytesPerRow: 4 * channels * width }, [width, height]);
	return { format, inside, channels, texture, width, height };
}

function bufferOf(bytes) {
	const buffer = device.createBuffer({ size: bytes.byteLength, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
	device.queue.writeBuffer(buffer, 0, bytes);
	return { buffer };
}

function normalsOf({ width, height, channels }) {
	return pictureOf({ format: 'quad', width, height },
		Float32Array.from({ length: 4 * width * height }, (_, i) => (i % 4 < 3 ? channels[`N.${'XYZ'[i % 4]}`][i >> 2] : 0)));
}

const bytesOf = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));

// Its numbers are floats where the module's are.
function blockOf(plan, wgsl) {
	const bytes = bytesOf(plan.block), values = new DataView(bytes.buffer);
	for (const at of wgsl.includes('first: vec2f') ? [plan.members.first, plan.members.last] : []) {
		for (const place of [at, at + 4]) values.setFloat32(place, values.getInt32(place, true), true);
	}
	return bufferOf(bytes);
}

// The bindings that an entry point reads, itself or through functions: [{binding, name, kind}].
function bindingsOf(wgsl, entry) {
	const functions = new Map([...wgsl.matchAll(/^fn (\w+)\([^]*?^}/gm)].map(([text, name]) => [name, text])), reached = new Set([entry]);
	for (const name of reached) {
		for (const [word] of functions.get(name).matchAll(/\w+/g)) if (functions.has(word)) reached.add(word);
	}
	const words = new Set([...reached].flatMap(name => functions.get(name).match(/\w+/g)));
	return [...wgsl.matchAll(/@binding\((\d+)\) var(?:<uniform>)? (\w+): (\w+)/g)].map(([, binding, name, kind]) => ({ binding: +binding, name, kind }))
		.filter(({ name }) => words.has(name));
}

// A picture that a pass reads: of its own, the levels and layers before the one that it draws.
function viewOf(picture, pass, own, dimension) {
	if (own && pass.level + pass.layer === 0) return pictureOf({ format: picture.format, width: 1, height: 1 }).texture.createView({ dimension });
	return picture.texture.createView({ dimension, ...(own && pass.level > 0 ? { mipLevelCount: pass.level } : own ? { arrayLayerCount: pass.layer } : {}) });
}

// Submits the commands; returns visibility: the last channel, next to bent normals.
async function readPicture({ texture, width, height, channels }, encoder) {
	const row = Math.ceil(width * channels / 64) * 64;
	const read = device.createBuffer({ size: 4 * row * height, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
	encoder.copyTextureToBuffer({ texture }, { buffer: read, bytesPerRow: 4 * row }, [width, height]);
	device.queue.submit([encoder.finish()]);
	await read.mapAsync(GPUMapMode.READ);
	const numbers = new Float32Array(read.getMappedRange());
	return Float32Array.from({ length: width * height }, (_, i) => numbers[Math.floor(i / width) * row + (i % width + 1) * channels - 1]);
}

async function drawn(name, { width, height, channels }) {
	const wgsl = readFileSync(`${name}.wgsl`, 'utf8'), plan = JSON.parse(readFileSync(`${name}.json`, 'utf8')), compute = wgsl.includes('@compute');
	const module = device.createShaderModule({ code: wgsl }), pipelines = new Map();
	const problem = (await module.getCompilationInfo()).messages[0];
	if (problem) throw new Error(`line ${problem.lineNum}: ${problem.message}`);
	const pictures = plan.pictures.map(shape => pictureOf(shape));
	const inputs = {
		nook_depths: pictureOf({ format: 'scalar', width, height }, channels.Z),
		nook_normals: normalsOf({ width, height, channels }),
		tile: plan.tile && pictureOf({ format: 'quad', ...plan.tile }, bytesOf(plan.tile.texels)),
	};
	const block = blockOf(plan, wgsl), encoder = device.createCommandEncoder();
	let picture;
	for (const pass of plan.passes) {
		const whole = pass.call === 'nookUpsample'; // nook…Full draws that pass and the next
		const call = whole ? /fn main_(nook\w+Full)\(/.exec(wgsl)[1] : pass.call;
		const entryPoint = wgsl.includes('fn main(') ? 'main' : `main_${call}`;
		picture = pictures[pass.picture];
		if (!pipelines.has(entryPoint)) {
			pipelines.set(entryPoint, compute ? await device.createComputePipelineAsync({ layout: 'auto', compute: { module, entryPoint } })
				: await device.createRenderPipelineAsync({ layout: 'auto', vertex: { module, entryPoint: 'triangle' },
					fragment: { module, entryPoint, targets: [{ format: picture.inside }] } }));
		}
		const view = picture.texture.createView({ dimension: '2d', baseMipLevel: pass.level, mipLevelCount: 1, baseArrayLayer: pass.layer, arrayLayerCount: 1 });
		const entries = bindingsOf(wgsl, entryPoint).map(({ binding, name: variable, kind }) => {
			const read = pass.reads.find(([slot]) => slot === variable), Kind = kind === 'vec4f' ? Float32Array : Int32Array;
			return { binding, resource: variable === 'nook' ? block : variable === 'nook_pass' ? bufferOf(Kind.from(pass.numbers))
				: variable.startsWith('nook_out_') ? view
				: read ? viewOf(pictures[read[1]], pass, read[1] === pass.picture, kind === 'texture_2d_array' ? '2d-array' : '2d')
				: inputs[variable.endsWith('_tile') ? 'tile' : variable].texture.createView() };
		});
		const work = compute ? encoder.beginComputePass() : encoder.beginRenderPass({ colorAttachments: [{ view, loadOp: 'clear', storeOp: 'store' }] });
		work.setPipeline(pipelines.get(entryPoint));
		work.setBindGroup(0, device.createBindGroup({ layout: pipelines.get(entryPoint).getBindGroupLayout(0), entries }));
		if (compute) work.dispatchWorkgroups(Math.ceil(picture.width / 8), Math.ceil(picture.height / 8));
		else work.draw(3);
		work.end();
		if (whole) break;
	}
	return readPicture(picture, encoder);
}

// The first picture, by the script in docs/reference/modules.md and the module nook_vo.js.
async function drawnByPage({ width, height, channels, attributes }) {
	const script = /## WGSL[^]*?```js\nimport (\{[^}]*\})[^\n]*\n([^]*?)```/.exec(readFileSync(`${source}/docs/reference/modules.md`, 'utf8'));
	const depths = pictureOf({ format: 'scalar', width, height }, channels.Z).texture, normals = normalsOf({ width, height, channels }).texture;
	const [lines, visibility] = [0, 1].map(() => pictureOf({ format: 'scalar', width, height }));
	const projection = attributes.projection64, encoder = device.createCommandEncoder();
	new Function('made', 'device', 'encoder', 'projection', 'width', 'height', 'depths', 'normals', 'lines', 'visibility', `const ${script[1]} = made;${script[2]}`)(
		await import(pathToFileURL('nook_vo.js')), device, encoder, projection, width, height, depths, normals, lines.texture, visibility.texture);
	return readPicture(visibility, encoder);
}

const gbuffer = readExr('g.exr');
for (const name of names) {
	device.pushErrorScope('validation');
	let result;
	try {
		const found = await (name === 'page' ? drawnByPage(gbuffer) : drawn(name, gbuffer)), expected = readExr(`${name}.exr`).channels.visibility;
		const apart = Array.from(found, (value, i) => Math.abs(value - expected[i]));
		result = `${Math.max(...apart)} ${apart.filter(one => !(one <= 1 / 255)).length}`;
	} catch (error) {
		result = `error ${error.message}`;
	}
	const error = await device.popErrorScope();
	console.log(`${name} ${error ? `error ${error.message}` : result}`.replace(/\n[^]*/, ''));
}
process.exit(0);
