// SPDX-License-Identifier: MIT
// Reads a file of `nook volumes` and prepares frames for the shaders of `nook emit --methods aov`: nook_volumes.h and
// nook_volumes_draw.h in JavaScript, with the same bytes. No dependencies.
//
//	const volumes = readVolumes(await (await fetch('level.glb')).arrayBuffer()); // throws RangeError; files of --compress: MeshoptDecoder
//	const frame = new VolumesFrame(volumes);
//	frame.set({ cameraFromWorld, projection, width, height }); // matrices column by column
//	upload(frame.block, frame.seen); // 384 bytes; 16 32-bit integers per cluster
//	for (const i of frame.inSight()) draw(volumes.clusters[i]);

const kStrides = [128, 8, 8, 2, 8]; // of clusters, polygons, corners, indices, vertices

function require(holds, what = 'broken bytes') {
	if (!holds) throw new RangeError(`volumes: found ${what}`);
}

// Returns {distance, rayDistance, planeError, sumRange, occlusion, exactBounds, hasPrisms, clusters, polygons, corners, indices,
// vertices}: arrays as in the file, typed; only those of compressed files are copies. Every index of the result is in range. decoder:
// MeshoptDecoder of meshoptimizer, after its `ready`, for files of --compress. Throws RangeError.
export function readVolumes(buffer, decoder) {
	const bytes = buffer instanceof ArrayBuffer ? new Uint8Array(buffer) : new Uint8Array(buffer.buffer, buffer.byteOffset, buffer.byteLength);
	const size = bytes.byteLength, view = new DataView(bytes.buffer, bytes.byteOffset, size), word = at => view.getUint32(at, true);
	require(size >= 20 && word(0) === 0x46546c67 && word(4) === 2, 'no binary glTF 2.0');
	require(word(8) === size, 'another length than the file says');
	const text = word(12);
	require(word(16) === 0x4e4f534a && text <= size - 28);
	const length = word(20 + text), start = 28 + text;
	require(word(24 + text) === 0x004e4942 && length <= size - start);
	require(length >= 464 && String.fromCharCode(...bytes.subarray(start, start + 8)) === 'NOOKVOLS', 'glTF without volumes of nook');
	require(word(start + 8) === 1, 'another version of the format than 1');
	const flags = word(start + 12), number = at => view.getFloat64(start + at, true);
	require((flags & ~7) === 0 && (flags & 6) !== 6);
	const volumes = { exactBounds: (flags & 1) !== 0, hasPrisms: (flags & 2) !== 0, distance: number(16), rayDistance: number(24),
		planeError: number(64), sumRange: number(72), occlusion: Array.from({ length: 33 }, (_, i) => number(80 + 8 * i)) };
	const { distance, rayDistance, planeError, sumRange, occlusion } = volumes;
	require([distance, sumRange].every(one => one >= 1e-30 && one <= 1e30) && [rayDistance, planeError].every(one => one >= 0 && one <= 1e30) &&
		occlusion.every((one, i) => one >= (i > 0 ? occlusion[i - 1] : 0) && one <= 1));
	const items = kStrides.map((stride, i) => arrayOf(view, start, length, 344 + 24 * i, stride, decoder));
	volumes.clusters = clustersOf(items[0]);
	const shorts = ({ bytes: some }) => new Uint16Array(some.buffer, some.byteOffset, some.byteLength / 2);
	volumes.polygons = new Uint32Array(items[1].bytes.buffer, items[1].bytes.byteOffset, 2 * items[1].count);
	[volumes.corners, volumes.indices, volumes.vertices] = items.slice(2).map(shorts);
	const counts = [1, 2, 4, 3].map(i => items[i].count);
	if ((flags & 4) !== 0) counts[1] = (volumes.corners = cornersOf(volumes, counts)).length / 4;
	checkVolumes(volumes, (flags & 6) !== 0, counts);
	return volumes;
}

function arrayOf(view, start, length, at, stride, decoder) {
	const offset = Number(view.getBigUint64(start + at, true)), size = Number(view.getBigUint64(start + at + 8, true));
	const count = view.getUint32(start + at + 16, true);
	require(offset % 16 === 0 && offset <= length && size <= length - offset);
	require(view.getUint16(start + at + 20, true) === stride);
	const encoding = view.getUint16(start + at + 22, true), place = view.byteOffset + start + offset;
	if (encoding === (stride === 2 ? 2 : 1)) {
		require(decoder, 'compressed arrays, and no decoder');
		require(count * stride <= 64 * size && (stride > 2 || count % 3 === 0));
		const bytes = new Uint8Array(count * stride), source = new Uint8Array(view.buffer, place, size);
		try {
			decoder[stride === 2 ? 'decodeIndexBuffer' : 'decodeVertexBuffer'](bytes, count, stride, source);
		} catch {
			require(false);
		}
		return { count, bytes };
	}
	require(encoding === 0 && count * stride === size);
	return { count, bytes: place % 16 === 0 ? new Uint8Array(view.buffer, place, size) : new Uint8Array(view.buffer.slice(place, place + size)) };
}

// The corners of polygons, from the triangles of a file that stores shared corners as vertices. A polygon of n corners has n - 2
// triangles; each after its first adds a corner behind the one before it in the triangle.
function cornersOf({ clusters, polygons, indices, vertices }, [polygonCount, cornerCount, vertexCount, indexCount]) {
	let sum = 0, at = 0, to = 0, polygon = 0;
	for (let i = 1; i < polygons.length; i += 2) {
		require((polygons[i] & 31) >= 3 && (polygons[i] & 31) <= 16);
		sum += polygons[i] & 31;
	}
	require(cornerCount === 0 && indexCount === 3 * (sum - 2 * polygonCount));
	const corners = new Uint16Array(4 * sum);
	for (const { polygonCount: own, firstVertex, vertexCount: size } of clusters) {
		require(polygon + own <= polygonCount && firstVertex + size <= vertexCount);
		for (let i = 0; i < own; ++i, ++polygon) {
			const ring = [...indices.subarray(at, at + 3)], count = polygons[2 * polygon + 1] & 31;
			while (ring.length < count) {
				const next = indices.subarray(at += 3, at + 3), own = next.findIndex(one => !ring.includes(one));
				const before = ring.indexOf(next[(own + 2) % 3]);
				require(own >= 0 && before >= 0);
				ring.splice(before + 1, 0, next[own]);
			}
			at += 3;
			for (const one of ring) {
				require(one < size);
				corners.set(vertices.subarray(4 * (firstVertex + one), 4 * (firstVertex + one) + 3), to);
				corners[to + 3] = i;
				to += 4;
			}
		}
	}
	return corners;
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

// counts: the numbers of polygons, corners, vertices and indices.
function checkVolumes({ clusters, polygons, corners, indices, vertices }, hasVertices, counts) {
	const ends = [0, 0, 0, 0], within = (value, least, most) => value >= least && value <= most;
	for (const { origin, vertexOrigin, step, vertexStep, least, most, firstPolygon, polygonCount, firstCorner, cornerCount, firstVertex, vertexCount,
		firstIndex, indexCount } of clusters) {
		[firstPolygon, firstCorner, firstVertex, firstIndex].forEach((first, i) => require(first === ends[i]));
		[polygonCount, cornerCount, vertexCount, indexCount].forEach((count, i) => require((ends[i] += count) <= counts[i]));
		require(within(polygonCount, 1, 65536) && [0, 1, 2].every(i => within(origin[i], -1e30, 1e30) && within(vertexOrigin[i], -1e30, 1e30) &&
			within(step[i], 1e-30, 1e30) && within(vertexStep[i], 0, 1e30) && within(least[i], -1e30, 1e30) && within(most[i], least[i], 1e30)));
		let corner = firstCorner;
		for (let i = 0; i < polygonCount; ++i) {
			const own = polygons[2 * (firstPolygon + i) + 1], count = own & 31;
			require(polygons[2 * (firstPolygon + i)] === corner && within(count, 3, 16) && own >>> 16 > 0 && corner + count <= ends[1]);
			for (const end = corner + count; corner < end; ++corner) require(corners[4 * corner + 3] === i);
		}
		require(corner === ends[1] && indexCount % 3 === 0 && (hasVertices || vertexCount === 0));
		for (let i = firstIndex; i < ends[3]; ++i) require(indices[i] < (hasVertices ? vertexCount : cornerCount));
		for (let i = firstVertex; i < ends[2]; ++i) require(vertices[4 * i + 3] < polygonCount);
	}
	require(ends.every((end, i) => end === counts[i]));
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
