// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: node blocks.js FILE.ktx2 SIZE. Checks that ktx-parse reads a square texture of that size in BC4 blocks with all mipmaps.
// Exit code 1: something differs.
const assert = require('assert');
const fs = require('fs');
const path = require('path');
const { pathToFileURL } = require('url');

async function main() {
	const ktx = await import(pathToFileURL(path.join(process.cwd(), 'node_modules', 'ktx-parse', 'dist', 'index.mjs')));
	const texture = ktx.read(new Uint8Array(fs.readFileSync(process.argv[2])));
	const size = Number(process.argv[3]);
	assert.strictEqual(texture.vkFormat, 139); // VK_FORMAT_BC4_UNORM_BLOCK
	assert.deepStrictEqual(
		[texture.typeSize, texture.pixelWidth, texture.pixelHeight, texture.pixelDepth, texture.layerCount, texture.faceCount],
		[1, size, size, 0, 0, 1]);
	const format = texture.dataFormatDescriptor[0];
	assert.strictEqual(format.colorModel, 131); // KHR_DF_MODEL_BC4
	assert.strictEqual(format.transferFunction, ktx.KHR_DF_TRANSFER_LINEAR);
	assert.deepStrictEqual([...format.texelBlockDimension], [3, 3, 0, 0]);
	assert.deepStrictEqual([...format.bytesPlane], [8, 0, 0, 0, 0, 0, 0, 0]);
	assert.deepStrictEqual(format.samples.map(one => [one.bitOffset, one.bitLength, one.channelType]), [[0, 63, 0]]);
	assert.strictEqual(texture.levels.length, 1 + Math.floor(Math.log2(size)));
	texture.levels.forEach((level, i) => {
		const across = Math.ceil(Math.max(1, size >> i) / 4);
		assert.strictEqual(level.levelData.byteLength, 8 * across * across, `level ${i}`);
		assert.strictEqual(level.levelData.byteOffset % 8, 0, `level ${i}`);
	});
}

main().catch(error => {
	console.error(error.message);
	process.exitCode = 1;
});
