// SPDX-License-Identifier: MIT
import type { Camera, Color, ColorRepresentation, Scene, Texture } from 'three';
import type { CompositeOptions } from './index.js';

export interface NookPostPass extends Required<Omit<CompositeOptions, 'tint'>> {
	get tint(): Color;
	set tint(colour: ColorRepresentation);
	get texture(): Texture | null;
	reset(): void;
}

/** Returns the class of a pass to add after a RenderPass. Pass: the class that `postprocessing` exports. */
export function nookPassFor<Base extends object>(
	Pass: abstract new (name?: string, scene?: Scene, camera?: Camera) => Base,
): new (scene: Scene, camera: Camera, options?: CompositeOptions) => Base & NookPostPass;
