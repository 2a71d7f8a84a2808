// SPDX-License-Identifier: MIT
// The pass for the composer of the package `postprocessing`, without depending on it.
import { passOn } from './pass.js';

/** Returns the class of a pass to add after a RenderPass; with renderScene: true in place of one. Pass: the class that `postprocessing` exports. */
export const nookPassFor = Pass => class NookPostPass extends passOn(Pass) {
	constructor(scene, camera, options = {}) {
		super(scene, camera, 0, 0, { renderScene: false, ...options });
		this.needsDepthTexture = true;
	}

	setDepthTexture(depthTexture) {
		this._depths = depthTexture;
	}

	getDepthTexture() {
		return this._depths;
	}

	render(renderer, inputBuffer, outputBuffer) {
		super.render(renderer, outputBuffer, inputBuffer);
	}
};
