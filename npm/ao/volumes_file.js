// SPDX-License-Identifier: MIT
// Reads a file of `nook volumes` and prepares frames for the shaders of `nook emit --methods aov`: nook_volumes.h and
// nook_volumes_draw.h in JavaScript, with the same bytes. No dependencies.
//
//	const volumes = readVolumes(await (await fetch('level.glb')).arrayBuffer()); // throws RangeError
//	const frame = new VolumesFrame(volumes);
//	frame.set({ cameraFromWorld, projection, width, height }); // matrices column by column
//	upload(frame.block, frame.seen); // 384 bytes; 16 32-bit integers per cluster
//	for (const i of frame.inSight()) draw(volumes.clusters[i]);

const kStrides = [128, 8, 8, 2, 8]; // of clusters, polygons, corners, indices, vertices
const kCompressed = 'compressed arrays, expected a file made without --compress';

function require(holds, what) {
	if (!holds) throw new RangeError(`volumes: found ${what}`);
}

// Returns {distance, rayDistance, planeError, sumRange, occlusion, exactBounds, hasPrisms, clusters, polygons, corners, indices,
// vertices}: arrays as in the file, typed, without copies. Every index of the result is in range. Throws RangeError.
export function readVolumes(buffer) {
	const bytes = buffer instanceof ArrayBuffer ? new Uint8Array(buffer) : new Uint8Array(buffer.buffer, buffer.byteOffset, buffer.byteLength);
	const size = bytes.byteLength, view = new DataView(bytes.buffer, bytes.byteOffset, size), word = at => view.getUint32(at, true);
	require(size >= 20 && word(0) === 0x46546c67 && word(4) === 2, 'no binary glTF 2.0');
	require(word(8) === size, 'another length than the file says');
	const text = word(12);
	require(word(16) === 0x4e4f534a && text <= size - 28, 'no chunk of JSON before a binary one');
	const length = word(20 + text), start = 28 + text;
	require(word(24 + text) === 0x004e4942 && length <= size - start, 'no binary chunk');
	require(length >= 464 && String.fromCharCode(...bytes.subarray(start, start + 8)) === 'NOOKVOLS', 'glTF without volumes of nook');
	require(word(start + 8) === 1, 'another version of the format than 1');
	const flags = word(start + 12), number = at => view.getFloat64(start + at, true);
	require((flags & ~3) === 0, (flags & ~7) === 0 ? kCompressed : 'unknown flags');
	const volumes = { exactBounds: (flags & 1) !== 0, hasPrisms: (flags & 2) !== 0, distance: number(16), rayDistance: number(24),
		planeError: number(64), sumRange: number(72), occlusion: Array.from({ length: 33 }, (_, i) => number(80 + 8 * i)) };
	const { distance, rayDistance, planeError, sumRange, occlusion } = volumes;
	require([distance, sumRange].every(one => one >= 1e-30 && one <= 1e30) && [rayDistance, planeError].every(one => one >= 0 && one <= 1e30) &&
		occlusion.every((one, i) => one >= (i > 0 ? occlusion[i - 1] : 0) && one <= 1), 'numbers out of range in the header');
	const items = kStrides.map((stride, i) => arrayOf(view, start, length, 344 + 24 * i, stride));
	volumes.clusters = clustersOf(items[0]);
	const shorts = ({ bytes: some }) => new Uint16Array(some.buffer, some.byteOffset, some.byteLength / 2);
	volumes.polygons = new Uint32Array(items[1].bytes.buffer, items[1].bytes.byteOffset, 2 * items[1].count);
	[volumes.corners, volumes.indices, volumes.vertices] = items.slice(2).map(shorts);
	checkVolumes(volumes, items.map(({ count }) => count));
	return volumes;
}

function arrayOf(view, start, length, at, stride) {
	const offset = Number(view.getBigUint64(start + at, true)), size = Number(view.getBigUint64(start + at + 8, true));
	const count = view.getUint32(start + at + 16, true);
	require(offset % 16 === 0 && offset <= length && size <= length - offset, 'an array that reaches beyond the file');
	require(view.getUint16(start + at + 20, true) === stride, 'an array with items of another size');
	require(view.getUint16(start + at + 22, true) === 0, kCompressed);
	require(count * stride === size, 'an array with another length than its items');
	const place = view.byteOffset + start + offset;
	return { count, bytes: place % 16 === 0 ? new Uint8Array(view.buffer, place, size) : new Uint8Array(view.buffer.slice(place, place + size)) };
}

function clustersOf({ bytes, count }) {
	const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
	const three = (get, at, step) => [0, 1, 2].map(i => view[get](at + step * i, true));
	return Array.from({ length: count }, (_, i) => {
		const at = 128 * i, words = Array.from({ length: 8 }, (_, k) => view.getUint32(at + 96 + 4 * k, true));
		const [firstPolygon, polygonCount, firstCorner, cornerCount, firstVertex, vertexCount, firstIndex, indexCount] = words;
		return { origin: three('getFloat64', at, 8), vertexOrigin: three('getFloat64', at + 24, 8), step: three('getFloat32', at + 48, 4),
			vertexStep: three('getFloat32', at + 60, 4), least: three('getFloat32', at + 72, 4), most: three('getFloat32', at + 84, 4),
			firstPolygon, polygonCount, firstCorner, cornerCount, firstVertex, vertexCount, firstIndex, indexCount };
	});
}

function checkVolumes({ clusters, polygons, corners, indices, vertices, hasPrisms }, [, polygonCount, cornerCount, indexCount, vertexCount]) {
	const next = { polygon: 0, corner: 0, vertex: 0, index: 0 }, within = (value, least, most) => value >= least && value <= most;
	for (const cluster of clusters) {
		require(cluster.firstPolygon === next.polygon && cluster.firstCorner === next.corner && cluster.firstVertex === next.vertex &&
			cluster.firstIndex === next.index, 'clusters with gaps between them');
		next.polygon += cluster.polygonCount;
		next.corner += cluster.cornerCount;
		next.vertex += cluster.vertexCount;
		next.index += cluster.indexCount;
		require(next.polygon <= polygonCount && next.corner <= cornerCount && next.vertex <= vertexCount && next.index <= indexCount,
			'clusters of more than there is');
		require(within(cluster.polygonCount, 1, 65536) && [0, 1, 2].every(i => within(cluster.origin[i], -1e30, 1e30) &&
			within(cluster.vertexOrigin[i], -1e30, 1e30) && within(cluster.step[i], 1e-30, 1e30) && within(cluster.vertexStep[i], 0, 1e30) &&
			within(cluster.least[i], -1e30, 1e30) && within(cluster.most[i], cluster.least[i], 1e30)), 'numbers out of range in a cluster');
		let corner = cluster.firstCorner;
		for (let i = 0; i < cluster.polygonCount; ++i) {
			const own = polygons[2 * (cluster.firstPolygon + i) + 1], count = own & 31;
			require(polygons[2 * (cluster.firstPolygon + i)] === corner && within(count, 3, 16) && own >>> 16 > 0, 'a polygon that cannot be');
			require(corner + count <= next.corner, 'polygons of more corners than their cluster');
			for (const end = corner + count; corner < end; ++corner) require(corners[4 * corner + 3] === i, 'a corner of another polygon');
		}
		require(corner === next.corner, 'corners without a polygon');
		require(cluster.indexCount % 3 === 0 && (hasPrisms || cluster.vertexCount === 0), 'a cluster with a part of a triangle');
		for (let i = cluster.firstIndex; i < next.index; ++i) {
			require(indices[i] < (hasPrisms ? cluster.vertexCount : cluster.cornerCount), 'an index beyond its cluster');
		}
		for (let i = cluster.firstVertex; i < next.vertex; ++i) require(vertices[4 * i + 3] < cluster.polygonCount, 'a prism of no polygon');
	}
	require(next.polygon === polygonCount && next.corner === cornerCount && next.vertex === vertexCount && next.index === indexCount,
		'clusters of less than there is');
}

const isUsualW = (x, y, z, one) => x === 0 && y === 0 && ((Math.abs(Math.abs(z) - 1) <= 1e-5 && one === 0) || (z === 0 && one !== 0));

// Returns the error in a projection, or nothing.
export function faultOf(p) {
	if (!Array.prototype.every.call(p, Number.isFinite)) return 'found infinity or NaN, expected 16 finite numbers';
	if (!isUsualW(p[3], p[7], p[11], p[15]) && isUsualW(p[12], p[13], p[14], p[15])) return 'looks row-major: transpose it';
	if (p[1] !== 0 || p[4] !== 0 || p[3] !== 0 || p[7] !== 0 || p[0] === 0 || p[5] === 0) return 'found a skew';
	if (p[11] > 0) return 'looks left-handed: w = +z; negate numbers 8 to 11, and z of cameraFromWorld and the normals';
	const behind = p[14] * p[10] <= 0 && (p[14] - p[15]) * (p[10] - p[11]) <= 0 && p[10] !== 0 && p[10] !== p[11];
	return (p[11] === 0 && p[15] <= 0) || (behind && p[2] === 0 && p[6] === 0) ? 'shows what is behind the camera: left-handed?' : '';
}

// One frame's uniform block and clusters. Positions are relative to the eye; they are subtracted in 64 bits.
export class VolumesFrame {
	constructor(volumes) {
		this.volumes = volumes;
		this.block = new ArrayBuffer(384);
		this.seen = new Uint32Array(16 * volumes.clusters.length);
	}

	// cameraFromWorld, projection: column by column; view space looks down -z. width, height: of depths and normals, pixels. Further
	// settings as in nook_volumes::Camera: firstRowNdcY, zeroToOne, facesByRows, nearest, farthest, every, depthStep, depthShare,
	// positionError, bias. Throws RangeError.
	set(camera) {
		const c = camera.cameraFromWorld, p = camera.projection;
		const { width, height, firstRowNdcY = -1, zeroToOne = false, facesByRows = false, nearest = 0, farthest = Infinity, every = 1,
			depthStep = 0, depthShare = 2 ** -22, positionError = 0, bias = 0 } = camera;
		const fault = p.length === 16 ? faultOf(p) : 'expected 16 numbers';
		if (fault) throw new RangeError(`projection: ${fault}`);
		if (c.length !== 16 || !Array.prototype.every.call(c, Number.isFinite)) throw new RangeError('cameraFromWorld: expected 16 finite numbers');
		if (!(width >= 1 && height >= 1 && every >= 1)) throw new RangeError('camera: found a picture without pixels');
		const { volumes } = this, eye = this.eye = [0, 1, 2].map(i => -(c[4 * i] * c[12] + c[4 * i + 1] * c[13] + c[4 * i + 2] * c[14]));
		const clip = this.clip = new Float64Array(16);
		for (let row = 0; row < 4; ++row) {
			for (let column = 0; column < 3; ++column) {
				clip[4 * column + row] = p[row] * c[4 * column] + p[4 + row] * c[4 * column + 1] + p[8 + row] * c[4 * column + 2];
			}
			clip[12 + row] = p[12 + row];
		}
		const planeBias = Math.max(bias > 0 ? bias : 1e-4 * volumes.distance, volumes.planeError);
		this.behind = 1.01 * (planeBias + positionError); // nookBehind() of the shaders
		this.nearest = nearest;
		this.farthest = farthest;
		this.toward = [c[2], c[6], c[10]];
		const turn = c[0] * (c[5] * c[10] - c[9] * c[6]) - c[4] * (c[1] * c[10] - c[9] * c[2]) + c[8] * (c[1] * c[6] - c[5] * c[2]);
		// Are front faces clockwise in the picture?
		this.mirrored = ((turn < 0) !== (p[0] * p[5] < 0)) !== (facesByRows && firstRowNdcY < 0);

		const up = firstRowNdcY > 0 ? 1 : -1; // the shaders count rows from NDC y = 1
		const wx = -p[11], wy = p[15];
		const a = -p[10] + p[2] / p[0] * p[8] + p[6] / p[5] * p[9], b = p[14] - p[2] / p[0] * p[12] - p[6] / p[5] * p[13];
		const reversed = a * wy - b * wx < 0, farEnd = reversed ? 0 : 1, scale = zeroToOne ? 1 : 2;
		const at = scale * farEnd + (zeroToOne ? 0 : -1), sign = reversed ? -1 : 1;
		const lean = axis => (axis === 0 ? 1 : up) * sign * p[4 * axis + 2] / p[5 * axis];
		const own = [width, height, 1 / width, 1 / height, 1 / p[0], p[8] / p[0], up / p[5], p[9] / p[5], -p[12] / p[0], -p[13] / p[5],
			wx, wy, 0, 0, farEnd, 0, sign * (at * wy - b), -scale * wy, sign * (a - at * wx), scale * wx,
			depthStep, depthShare, positionError, volumes.distance];
		const axes = [0, 1, 2].flatMap(row => [c[row], c[4 + row], c[8 + row], 0]);
		const slope = [-lean(0) * wy, -lean(1) * wy, lean(0) * wx, lean(1) * wx];
		new Float32Array(this.block).set([...own, ...this.drawnClip({ width, height, every, firstRowNdcY }), ...axes, ...volumes.occlusion, 0, 0, 0,
			...slope, planeBias, volumes.exactBounds ? 1 : 0, volumes.sumRange]);
		new Int32Array(this.block)[15] = every;

		const floats = new Float32Array(this.seen.buffer);
		volumes.clusters.forEach((cluster, i) => {
			const place = 16 * i;
			for (let axis = 0; axis < 3; ++axis) {
				floats[place + axis] = cluster.origin[axis] - eye[axis];
				floats[place + 4 + axis] = cluster.step[axis];
				floats[place + 8 + axis] = cluster.vertexOrigin[axis] - eye[axis];
				floats[place + 12 + axis] = cluster.vertexStep[axis];
			}
			[this.seen[place + 3], this.seen[place + 7], this.seen[place + 11]] = [cluster.firstPolygon, cluster.firstCorner, cluster.firstVertex];
		});
	}

	// Clip space of the render target: its pixel i is pixel i * every of the whole picture.
	drawnClip({ width, height, every, firstRowNdcY }) {
		const made = Array.from(this.clip);
		for (let axis = 0; axis < 2 && every > 1; ++axis) {
			const pixels = axis === 0 ? width : height, cells = Math.ceil(pixels / every), scale = pixels / (every * cells);
			const shift = (((pixels - 1) / (2 * every) + 0.5) * 2 / cells - 1) * (axis === 1 && firstRowNdcY > 0 ? -1 : 1);
			for (let column = 0; column < 4; ++column) made[4 * column + axis] = scale * this.clip[4 * column + axis] + shift * this.clip[4 * column + 3];
		}
		return made;
	}

	leastOf({ origin, least }, axis) {
		return origin[axis] + least[axis] - this.eye[axis] - this.behind;
	}

	mostOf({ origin, most }, axis) {
		return origin[axis] + most[axis] - this.eye[axis] + this.behind;
	}

	// The numbers of the clusters that can occlude something in the picture.
	inSight() {
		const m = this.clip, depth = [-this.toward[0], -this.toward[1], -this.toward[2]], columns = [0, 1, 2, 3].map(i => 4 * i);
		const planes = [0, 1].flatMap(axis => [1, -1].map(sign => columns.map(at => m[at + 3] + sign * m[at + axis])));
		planes.push([...depth, -this.nearest]);
		if (this.farthest < Infinity) planes.push([-depth[0], -depth[1], -depth[2], this.farthest]);
		const reaches = (cluster, plane) => {
			let most = plane[3], size = Math.abs(most);
			for (let i = 0; i < 3; ++i) {
				const at = plane[i] > 0 ? this.mostOf(cluster, i) : this.leastOf(cluster, i);
				most += plane[i] * at;
				size += Math.abs(plane[i] * at);
			}
			return most >= -1e-6 * size;
		};
		return this.volumes.clusters.flatMap((cluster, i) => (planes.every(plane => reaches(cluster, plane)) ? [i] : []));
	}

	// Is the eye in the box of a cluster? Then draw its back faces, else its front faces.
	holdsEye(cluster) {
		return [0, 1, 2].every(axis => {
			const least = this.leastOf(cluster, axis), most = this.mostOf(cluster, axis), slack = 1e-6 * (Math.abs(least) + Math.abs(most));
			return least <= slack && most >= -slack;
		});
	}
}
