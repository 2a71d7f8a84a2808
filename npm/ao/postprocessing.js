// SPDX-License-Identifier: MIT
// The pass for the composer of the package `postprocessing`, without depending on it.
import { isReady, NookAO } from './ao.js';
import { defineOptions } from './options.js';
import { Composite, obscure, passRows, Prepass } from './pass.js';

/** Returns the class of a pass to add after a RenderPass. Pass: the class that `postprocessing` exports. */
export function nookPassFor(Pass) {
	return class NookPostPass extends Pass {
		constructor(scene, camera, options = {}) {
			super('NookPass', scene, camera);
			defineOptions(this, 'NookPass', passRows, options);
			this.needsDepthTexture = true;
			this._ao = new NookAO(camera, 0, 0);
			this._composite = new Composite();
			this._prepass = null;
			this._depths = null;
			this._disposed = false;
		}

		get texture() {
			return this._ao.texture;
		}

		reset() {
			this._ao.reset();
		}

		setDepthTexture(depthTexture) {
			this._depths = depthTexture;
		}

		getDepthTexture() {
			return this._depths;
		}

		setSize(width, height) {
			this._ao.setSize(width, height);
		}

		render(renderer, inputBuffer, outputBuffer) {
			if (this._disposed) throw new Error('NookPass: found render after dispose, expected a new pass');
			const ao = this._ao, composite = this._composite;
			const { x: width, y: height } = ao._size;
			if (width === 0 || height === 0 || !isReady(renderer, 'NookPass')) return;
			let normals = null;
			if (this.normals === 'pass') {
				this._prepass ??= new Prepass();
				this._prepass.render(renderer, this.scene, this.camera, width, height);
				normals = this._prepass.target.texture;
			}
			if (obscure(this, ao, renderer, this._depths, normals)) {
				composite.draw(renderer, composite.whole, this.renderToScreen ? null : outputBuffer, Composite.valuesOf(this, ao, inputBuffer.texture, normals));
			}
		}

		dispose() {
			if (this._disposed) return;
			this._disposed = true;
			this._ao.dispose();
			this._composite.dispose();
			this._prepass?.dispose();
		}
	};
}
