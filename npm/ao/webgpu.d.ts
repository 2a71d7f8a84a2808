// SPDX-License-Identifier: MIT
import type { Camera, Color, ColorRepresentation, Node, PassNode, Scene } from 'three/webgpu';
import type { NookAOOptions, Quality } from './index.js';

/** All options are properties as well and can be set at any time. A value out of range throws a RangeError. */
export interface NookNodeOptions extends Omit<NookAOOptions, 'temporal'> {
	/** Colour of full obscurance. Default black. */
	tint?: ColorRepresentation;
	/** Draws transparent objects over the obscurance. Default true. */
	excludeTransparent?: boolean;
}

/** Draws a scene with ambient occlusion; a PassNode, whose colours are darkened. */
export interface NookPassNode extends PassNode {
	radius: number;
	quality: Quality;
	intensity: number;
	halfResolution: boolean;
	sky: number;
	get tint(): Color;
	set tint(colour: ColorRepresentation);
	excludeTransparent: boolean;
	/** Visibility, 1 where open. */
	getVisibilityNode(): Node;
	/** Frees everything. Further calls do nothing. */
	dispose(): void;
}

/** For the RenderPipeline of WebGPURenderer, in place of pass(scene, camera). Throws where the renderer has no WebGPU. */
export function nookPass(scene: Scene, camera: Camera, options?: NookNodeOptions): NookPassNode;
