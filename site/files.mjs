// SPDX-License-Identifier: GPL-3.0-or-later
// Files that nook writes, read: OpenEXR pictures, levels as binary glTF with masks as PNG. Other files are not expected here.
import { readFileSync } from 'node:fs';
import { deflateSync, inflateSync } from 'node:zlib';

const base64 = numbers => Buffer.from(numbers.buffer, numbers.byteOffset, numbers.byteLength).toString('base64');

function attributeOf(type, bytes) {
	switch (type) {
	case 'string': return bytes.toString('utf8');
	case 'm44d': return Array.from({ length: 16 }, (_, i) => bytes.readDoubleLE(8 * i));
	case 'm44f': return Array.from({ length: 16 }, (_, i) => bytes.readFloatLE(4 * i));
	default: return bytes;
	}
}

function headerOf(bytes) {
	let at = 8;
	const text = () => { const end = bytes.indexOf(0, at), found = bytes.toString('latin1', at, end); at = end + 1; return found; };
	const attributes = {};
	for (let name = text(); name; name = text()) {
		const type = text(), size = bytes.readInt32LE(at);
		attributes[name] = attributeOf(type, bytes.subarray(at + 4, at + 4 + size));
		at += 4 + size;
	}
	return { attributes, end: at };
}

// Chunks are deflated, as differences of bytes of which every second comes first.
function chunkOf(bytes, size) {
	if (bytes.length === size) return bytes;
	const mixed = inflateSync(bytes), chunk = Buffer.alloc(size), half = (size + 1) >> 1;
	for (let i = 1; i < size; ++i) mixed[i] = mixed[i - 1] + mixed[i] - 128;
	for (let i = 0; i < size; ++i) chunk[i] = mixed[(i >> 1) + (i & 1) * half];
	return chunk;
}

// {width, height, attributes, channels: {name: Float32Array}} of 32-bit channels.
export function readExr(path) {
	const bytes = readFileSync(path), { attributes, end } = headerOf(bytes), names = [];
	const [left, upper, right, lower] = [0, 4, 8, 12].map(i => attributes.dataWindow.readInt32LE(i));
	const width = right - left + 1, height = lower - upper + 1, rows = attributes.compression[0] === 3 ? 16 : 1;
	for (let at = 0; attributes.channels[at]; at = attributes.channels.indexOf(0, at) + 17) {
		names.push(attributes.channels.toString('latin1', at, attributes.channels.indexOf(0, at)));
	}
	const channels = Object.fromEntries(names.map(name => [name, new Float32Array(width * height)]));
	for (let first = 0; first < height; first += rows) {
		const at = Number(bytes.readBigUInt64LE(end + 8 * (first / rows))), count = Math.min(rows, height - first);
		const chunk = chunkOf(bytes.subarray(at + 8, at + 8 + bytes.readInt32LE(at + 4)), 4 * width * count * names.length);
		for (let i = 0, y = 0; y < count; ++y) {
			for (const name of names) for (let x = 0; x < width; ++x, i += 4) channels[name][(first + y) * width + x] = chunk.readFloatLE(i);
		}
	}
	return { width, height, attributes, channels };
}

// The alpha of a PNG of 8 bits a channel.
function alphaOf(png) {
	const width = png.readUInt32BE(16), height = png.readUInt32BE(20), size = { 0: 1, 2: 3, 4: 2, 6: 4 }[png[25]], parts = [];
	for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
		if (png.toString('latin1', at + 4, at + 8) === 'IDAT') parts.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
	}
	const raw = inflateSync(Buffer.concat(parts)), row = width * size, pixels = Buffer.alloc(row * height);
	for (let i = 0, y = 0; y < height; ++y) {
		const filter = raw[i++];
		for (let x = 0; x < row; ++x, ++i) {
			const at = y * row + x, a = x < size ? 0 : pixels[at - size], b = y ? pixels[at - row] : 0, c = y && x >= size ? pixels[at - row - size] : 0;
			const [da, db, dc] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
			pixels[at] = raw[i] + [0, a, b, (a + b) >> 1, da <= db && da <= dc ? a : db <= dc ? b : c][filter];
		}
	}
	return { width, height, alpha: Uint8Array.from({ length: width * height }, (_, i) => pixels[(i + 1) * size - 1]) };
}

function crcOf(bytes) {
	let crc = ~0;
	for (const byte of bytes) {
		crc ^= byte;
		for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
	}
	return ~crc >>> 0;
}

// A PNG of three bytes per pixel; each row holds differences to the row above.
export function writePng(width, height, pixels) {
	const row = 3 * width, raw = Buffer.alloc((row + 1) * height);
	for (let y = 0; y < height; ++y) {
		raw[y * (row + 1)] = 2;
		for (let x = 0; x < row; ++x) raw[y * (row + 1) + 1 + x] = pixels[y * row + x] - (y > 0 ? pixels[(y - 1) * row + x] : 0);
	}
	const chunk = (name, body) => {
		const bytes = Buffer.alloc(12 + body.length);
		bytes.writeUInt32BE(body.length, 0);
		bytes.write(name, 4, 'latin1');
		body.copy(bytes, 8);
		bytes.writeUInt32BE(crcOf(bytes.subarray(4, 8 + body.length)), 8 + body.length);
		return bytes;
	};
	const head = Buffer.alloc(13);
	head.writeUInt32BE(width, 0);
	head.writeUInt32BE(height, 4);
	head.set([8, 2, 0, 0, 0], 8);
	return Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), chunk('IHDR', head), chunk('IDAT', deflateSync(raw, { level: 9 })), chunk('IEND', Buffer.alloc(0))]);
}

const KINDS = { 5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };
const WRAPS = { 10497: 0, 33648: 1, 33071: 2 };

// Triangles by material with positions relative to `eye`, and the masks of materials.
export function readGlb(path, eye) {
	const bytes = readFileSync(path), length = bytes.readUInt32LE(12), json = JSON.parse(bytes.toString('utf8', 20, 20 + length)), body = 28 + length;
	const viewOf = (view, offset = 0) => { const { byteOffset = 0, byteLength } = json.bufferViews[view]; return bytes.subarray(body + byteOffset + offset, body + byteOffset + byteLength); };
	const numbersOf = index => {
		const { bufferView, byteOffset, componentType, count, type } = json.accessors[index], Kind = KINDS[componentType];
		const size = count * { SCALAR: 1, VEC2: 2, VEC3: 3 }[type], view = viewOf(bufferView, byteOffset);
		return new Kind(Uint8Array.from(view.subarray(0, size * Kind.BYTES_PER_ELEMENT)).buffer);
	};
	const positions = [], uvs = [], groups = new Map();
	for (const { mesh, translation = [0, 0, 0] } of json.nodes.filter(node => node.mesh !== undefined)) {
		for (const { attributes, indices, material } of json.meshes[mesh].primitives) {
			const first = positions.length / 3, own = numbersOf(attributes.POSITION), { alphaMode = 'OPAQUE' } = json.materials[material];
			const key = alphaMode === 'OPAQUE' ? -1 : material;
			own.forEach((value, i) => positions.push(value + translation[i % 3] - eye[i % 3]));
			if (attributes.TEXCOORD_0 === undefined) for (let i = 0; i < 2 * own.length / 3; ++i) uvs.push(0);
			else numbersOf(attributes.TEXCOORD_0).forEach(value => uvs.push(value));
			if (!groups.has(key)) groups.set(key, []);
			numbersOf(indices).forEach(index => groups.get(key).push(first + index));
		}
	}
	const masks = (json.textures || []).map(({ source, sampler }) => {
		const { width, height, alpha } = alphaOf(viewOf(json.images[source].bufferView)), { wrapS = 10497, wrapT = 10497 } = json.samplers[sampler];
		return { width, height, wrap_u: WRAPS[wrapS], wrap_v: WRAPS[wrapT], alpha: base64(alpha) };
	});
	const groupOf = ([key, indices]) => {
		const { pbrMetallicRoughness: { baseColorFactor = [1, 1, 1, 1], baseColorTexture } = {}, alphaCutoff = 0.5 } = json.materials[key] || {};
		const masked = key < 0 ? {} : { mask: baseColorTexture ? baseColorTexture.index : -1, alpha: baseColorFactor[3], cutoff: alphaCutoff };
		return { indices: base64(Uint32Array.from(indices)), ...masked };
	};
	const sorted = [...groups].sort(([a], [b]) => a - b).map(groupOf);
	return { masks, triangles: { positions: base64(Float32Array.from(positions)), uvs: base64(Float32Array.from(uvs)), groups: sorted } };
}
