// SPDX-License-Identifier: MIT
import type { Camera, Color, ColorRepresentation, Scene, Texture } from 'three';
import type { NookPassOptions } from './index.js';

export interface NookPostPass extends Required<Omit<NookPassOptions, 'tint'>> {
	get tint(): Color;
	set tint(colour: ColorRepresentation);
	get texture(): Texture | null;
	reset(): void;
}

/** Returns the class of a pass to add after a RenderPass; with renderScene: true in place of one. Pass: the class that `postprocessing` exports. */
export function nookPassFor<Base extends object>(
	Pass: abstract new (name?: string, scene?: Scene, camera?: Camera) => Base,
): new (scene: Scene, camera: Camera, options?: NookPassOptions) => Base & NookPostPass;
