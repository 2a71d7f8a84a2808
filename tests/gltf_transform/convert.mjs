// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: node convert.mjs IN.glb FOLDER. Writes the level with every compression that other programs use, by glTF-Transform.
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { dedup, draco, instance, meshopt, quantize, textureCompress, weld } from '@gltf-transform/functions';
import draco3d from 'draco3dgltf';
import { MeshoptDecoder, MeshoptEncoder } from 'meshoptimizer';
import sharp from 'sharp';

const [input, folder] = process.argv.slice(2);
await MeshoptEncoder.ready;
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({
	'draco3d.encoder': await draco3d.createEncoderModule(),
	'draco3d.decoder': await draco3d.createDecoderModule(),
	'meshopt.encoder': MeshoptEncoder,
	'meshopt.decoder': MeshoptDecoder,
});

const ways = {
	'draco.glb': [weld(), draco({ quantizePosition: 16, quantizeTexcoord: 14 })],
	'draco_sequential.glb': [draco({ method: 'sequential', quantizePosition: 16, quantizeTexcoord: 14 })],
	'meshopt.glb': [meshopt({ encoder: MeshoptEncoder, level: 'medium', quantizePosition: 16, quantizeTexcoord: 16 })],
	'meshopt_filters.glb': [meshopt({ encoder: MeshoptEncoder, level: 'high', quantizePosition: 16, quantizeTexcoord: 16 })],
	'meshopt.gltf': [meshopt({ encoder: MeshoptEncoder, level: 'medium', quantizePosition: 16, quantizeTexcoord: 16 })],
	'quantized.glb': [quantize({ quantizePosition: 16, quantizeTexcoord: 16 })],
	'webp.glb': [textureCompress({ encoder: sharp, targetFormat: 'webp', lossless: true })],
};
for (const [name, steps] of Object.entries(ways)) {
	const document = await io.read(input);
	await document.transform(...steps);
	await io.write(`${folder}/${name}`, document);
}

// Decompressed again by the tool that error messages recommend.
await io.write(`${folder}/again.glb`, await (async () => {
	const document = await io.read(`${folder}/draco.glb`);
	for (const extension of document.getRoot().listExtensionsUsed()) {
		if (extension.extensionName === 'KHR_draco_mesh_compression') extension.dispose();
	}
	return document;
})());

// Three instances of the level's first mesh, placed by EXT_mesh_gpu_instancing, and likewise by nodes.
const placed = await io.read(input);
const scene = placed.getRoot().getDefaultScene() ?? placed.getRoot().listScenes()[0];
const mesh = placed.getRoot().listMeshes()[0];
for (const node of scene.listChildren()) node.dispose();
for (let i = 0; i < 3; ++i) {
	const half = 0.3 * i;
	scene.addChild(placed.createNode(`tree ${i}`).setMesh(mesh).setTranslation([10 * i, -i, 2]).setScale([1, 1 + 0.5 * i, 1])
		.setRotation([0, Math.sin(half), 0, Math.cos(half)]));
}
await io.write(`${folder}/nodes.glb`, placed);
await placed.transform(dedup(), instance({ min: 2 }));
await io.write(`${folder}/instanced.glb`, placed);
