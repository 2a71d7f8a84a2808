// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: node same.mjs EXPECTED.glb FOUND.glb SHARE. Compares two levels written by nook, independent of order: the number of
// triangles, the area, and the area's first and second moments per material may differ by at most SHARE of their value with all
// area at the rim.
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';

async function momentsOf(path) {
	const document = await new NodeIO().registerExtensions(ALL_EXTENSIONS).read(path);
	const of = new Map();
	for (const mesh of document.getRoot().listMeshes()) {
		for (const primitive of mesh.listPrimitives()) {
			const material = primitive.getMaterial();
			const name = `${material.getName()} ${material.getAlphaMode()} ${material.getBaseColorTexture() !== null}`;
			if (!of.has(name)) of.set(name, { triangles: 0, area: 0, moments: new Array(9).fill(0) });
			const made = of.get(name);
			const position = primitive.getAttribute('POSITION');
			const indices = primitive.getIndices().getArray();
			for (let i = 0; i < indices.length; i += 3) {
				const [a, b, c] = [0, 1, 2].map((k) => position.getElement(indices[i + k], []));
				const u = b.map((x, k) => x - a[k]);
				const v = c.map((x, k) => x - a[k]);
				const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
				const area = 0.5 * Math.hypot(...cross);
				made.triangles += 1;
				made.area += area;
				for (let k = 0; k < 3; ++k) {
					const mean = (a[k] + b[k] + c[k]) / 3;
					made.moments[k] += area * mean;
					made.moments[3 + k] += area * mean * mean;
					made.moments[6 + k] += 0.5 * cross[k]; // direction it faces
				}
			}
		}
	}
	return of;
}

const [expected, found, share] = process.argv.slice(2);
const a = await momentsOf(expected);
const b = await momentsOf(found);
let problems = a.size === b.size ? 0 : 1;
for (const [name, x] of a) {
	const y = b.get(name);
	if (y === undefined || Math.abs(y.triangles - x.triangles) > 0.001 * x.triangles) {
		console.log(`${name}: found ${y?.triangles} triangles, expected ${x.triangles}`);
		problems += 1;
		continue;
	}
	const reach = 100; // metres, extent of the compared levels
	const most = [x.area, ...new Array(3).fill(x.area * reach), ...new Array(3).fill(x.area * reach * reach), ...new Array(3).fill(x.area)];
	[x.area, ...x.moments].forEach((value, i) => {
		const other = [y.area, ...y.moments][i];
		if (!(Math.abs(other - value) <= Number(share) * most[i])) {
			console.log(`${name}: moment ${i}: found ${other}, expected ${value}`);
			problems += 1;
		}
	});
}
process.exit(problems === 0 && a.size > 0 ? 0 : 1);
