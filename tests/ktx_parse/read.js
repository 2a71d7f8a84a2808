// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: node read.js FILE.ktx2 TILE.json. Checks that the texture read by ktx-parse equals the tile's file, float by float: one
// layer per frame, one column per variant, one row per sample. Prints its metadata. Exit code 1: something differs.
const assert = require('assert');
const fs = require('fs');
const path = require('path');
const { pathToFileURL } = require('url');

async function main() {
	const module = path.join(process.cwd(), 'node_modules', 'ktx-parse', 'dist', 'index.mjs');
	const ktx = await import(pathToFileURL(module));
	const bytes = new Uint8Array(fs.readFileSync(process.argv[2]));
	const texture = ktx.read(bytes);
	const tile = JSON.parse(fs.readFileSync(process.argv[3], 'utf8'));
	const layers = tile.moves ? 1 : tile.frames || 1;
	const transforms = tile.transforms !== undefined;
	const width = transforms ? tile.size : tile.size * tile.size;
	const height = transforms ? tile.size : tile.count;

	assert.strictEqual(texture.vkFormat, ktx.VK_FORMAT_R32G32B32A32_SFLOAT);
	assert.deepStrictEqual(
		[texture.typeSize, texture.pixelWidth, texture.pixelHeight, texture.pixelDepth, texture.layerCount, texture.faceCount],
		[4, width, height, 0, layers > 1 ? layers : 0, 1]);
	assert.strictEqual(texture.supercompressionScheme, ktx.KHR_SUPERCOMPRESSION_NONE);
	const format = texture.dataFormatDescriptor[0];
	assert.strictEqual(format.colorModel, ktx.KHR_DF_MODEL_RGBSDA);
	assert.strictEqual(format.transferFunction, ktx.KHR_DF_TRANSFER_LINEAR);
	assert.deepStrictEqual(format.bytesPlane, [16, 0, 0, 0, 0, 0, 0, 0]);
	const signedFloat = ktx.KHR_DF_SAMPLE_DATATYPE_FLOAT | ktx.KHR_DF_SAMPLE_DATATYPE_SIGNED;
	assert.deepStrictEqual(format.samples.map(one => [one.bitOffset, one.bitLength, one.channelType - signedFloat]),
		[[0, 31, 0], [32, 31, 1], [64, 31, 2], [96, 31, 15]]);

	assert.strictEqual(texture.levels.length, 1);
	const data = texture.levels[0].levelData;
	assert.strictEqual(data.byteOffset % 16, 0);
	assert.strictEqual(data.byteOffset + data.byteLength, bytes.length);
	const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
	assert.strictEqual(data.byteLength, 16 * width * height * layers);
	const near = (at, value) => assert.strictEqual(view.getFloat32(4 * at, true), Math.fround(value), `float ${at}`);
	let floats = 0;
	if (transforms) {
		tile.transforms.flat().forEach((value, i) => { near(i, value); floats += 1; });
	} else {
		tile.variants.forEach((variant, v) => variant.points.forEach((point, row) => {
			const texel = (Math.floor(v / width) * height + row) * width + v % width;
			point.forEach((value, channel) => { near(4 * texel + channel, value); floats += 1; });
			near(4 * texel + 3, variant.weights[row]);
		}));
	}
	assert(floats > 0);
	const words = Object.keys(texture.keyValue);
	assert.deepStrictEqual(words, [...words].sort());
	const textOf = key => Buffer.from(texture.keyValue[key]).toString('utf8').replace(/\0$/, ''); // some values are bytes
	assert(/^nook [0-9.]+$/.test(textOf('KTXwriter')));
	// Rewritten by ktx-parse, to check that reading lost nothing.
	const again = ktx.read(ktx.write(texture, { keepWriter: true }));
	assert.deepStrictEqual(again.levels[0].levelData, texture.levels[0].levelData);
	console.log(`${width} x ${height} x ${layers}, ${floats} floats; ${textOf('Layout')}`);
}

main().catch(error => {
	console.error(error.message);
	process.exitCode = 1;
});
