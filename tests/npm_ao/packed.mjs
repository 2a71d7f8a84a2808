// SPDX-License-Identifier: GPL-3.0-or-later
// node packed.mjs FOLDER NOOK: compressed volumes have the polygons of the others, and broken ones are refused with a RangeError.
import { deepStrictEqual, throws } from 'node:assert';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { readVolumes } from 'nook-ao/volumes_gl.js';

const [folder, nook] = process.argv.slice(2);
await MeshoptDecoder.ready;

// The corners of each polygon, from the least one on.
function polygonsOf({ polygons, corners }) {
	return Array.from({ length: polygons.length / 2 }, (_, i) => {
		const ring = Array.from({ length: polygons[2 * i + 1] & 31 }, (_, k) => [...corners.subarray(4 * (polygons[2 * i] + k), 4 * (polygons[2 * i] + k + 1))].join());
		const first = ring.indexOf([...ring].sort()[0]);
		return [...ring.slice(first), ...ring.slice(0, first)];
	});
}
for (const level of ['cornell', 'courtyard']) {
	for (const layout of ['polygons', 'prisms']) {
		const options = ['volumes', `builtin:${level}`, '--distance', '0.4', '--layout', layout, '-o'];
		execFileSync(nook, [...options, `${folder}/a.glb`]);
		execFileSync(nook, [...options, `${folder}/b.glb`, '--compress']);
		deepStrictEqual(polygonsOf(readVolumes(readFileSync(`${folder}/b.glb`), MeshoptDecoder)), polygonsOf(readVolumes(readFileSync(`${folder}/a.glb`))));
	}
}
const bytes = new Uint8Array(readFileSync(`${folder}/packed.glb`));
throws(() => readVolumes(bytes), /RangeError: volumes: found compressed arrays, and no decoder/);
let refused = 0;
for (let i = 0; i < bytes.length; i += 7) {
	throws(() => readVolumes(bytes.slice(0, i), MeshoptDecoder), RangeError);
	const one = bytes.slice();
	one[i] ^= 0x55;
	try {
		readVolumes(one, MeshoptDecoder);
	} catch (error) {
		if (!(error instanceof RangeError)) throw error;
		++refused;
	}
}
if (refused < 50) throw new Error(`found ${refused} changed files refused, expected more`); // most bytes are of the JSON, which is not read
