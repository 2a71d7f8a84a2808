// SPDX-License-Identifier: MIT
// Static occlusion from a file of `nook volumes`, for NookPass and NookAO.
import { ExternalTexture } from 'three';
import { isReady } from './ao.js';
import { glsl } from './nook_aov.js';
import { readVolumes, VolumesGl } from './volumes_gl.js';

// Normals are encoded as those of NookAO.
const normals = `precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) normalize(texelFetch(nook_normals, pixel, 0).xyz * 2.0 - 1.0)
`;

/** The occlusion of a level's volumes, drawn over depths and normals of a frame. */
export class NookVolumes {
	constructor(buffer, decoder) {
		this._volumes = readVolumes(buffer, decoder);
		this._texture = new ExternalTexture(null);
		this._disposed = false;
		this._lost = () => { this._gl = null; };
	}

	/** The visibility of the last frame, 1 where open, in the first channel; null before the first. */
	get texture() {
		return this._gl ? this._texture : null;
	}

	/**
	 * Draws the visibility of a frame. depths: linear, 1e30 for sky; normals: view-space, 0.5 + 0.5 n; both as NookAO has them. Returns
	 * false, and draws nothing, where the context is lost.
	 */
	render(renderer, camera, depths, normalsTexture) {
		if (this._disposed) throw new Error('NookVolumes: found render after dispose, expected a new one');
		if (!isReady(renderer, 'NookVolumes')) return false;
		if (renderer !== this._renderer) {
			this._free();
			renderer.domElement.addEventListener('webglcontextlost', this._lost);
			this._renderer = renderer;
		}
		const gl = renderer.getContext(), kept = renderer.getRenderTarget(), { width, height } = depths.image;
		const handleOf = texture => renderer.properties.get(texture).__webglTexture;
		this._gl ??= new VolumesGl(gl, this._volumes, `${normals}${glsl}\n`);
		this._texture.image = { width, height };
		try {
			this._texture.sourceTexture = this._gl.draw({
				cameraFromWorld: camera.matrixWorldInverse.elements, projection: camera.projectionMatrix.elements, width, height,
				depths: handleOf(depths), normals: handleOf(normalsTexture), zeroToOne: renderer.state.buffers.depth.getReversed?.() === true,
			});
		} catch (error) {
			throw new RangeError(`NookVolumes: camera: ${error.message}`);
		} finally {
			renderer.resetState();
			renderer.setRenderTarget(kept);
		}
		return true;
	}

	/** Frees everything. Further calls do nothing. */
	dispose() {
		if (this._disposed) return;
		this._disposed = true;
		this._free();
		this._texture.dispose();
	}

	_free() {
		this._renderer?.domElement.removeEventListener('webglcontextlost', this._lost);
		this._gl?.dispose();
		this._gl = this._renderer = null;
	}
}
