// SPDX-License-Identifier: MIT
import type { Camera, Color, ColorRepresentation, Node, PassNode, Scene } from 'three/webgpu';
import type { SharedOptions } from './index.js';

/** All options are properties as well and can be set at any time. A value out of range throws a RangeError. */
export interface NookNodeOptions extends SharedOptions {
	/** Static occlusion of the level, drawn with every frame; the lower visibility decides. Default null. */
	volumes?: NookVolumes | null;
}

/** Draws a scene with ambient occlusion; a PassNode, whose colours are darkened. */
export interface NookPassNode extends PassNode, Required<Omit<NookNodeOptions, 'tint'>> {
	get tint(): Color;
	set tint(colour: ColorRepresentation);
	/** Visibility, 1 where open. */
	getVisibilityNode(): Node;
	/** Forgets earlier frames of `temporal`. Call it after a cut of the camera. */
	reset(): void;
	/** Frees everything. Further calls do nothing. */
	dispose(): void;
}

/** For the RenderPipeline of WebGPURenderer, in place of pass(scene, camera). Throws where the renderer has no WebGPU. */
export function nookPass(scene: Scene, camera: Camera, options?: NookNodeOptions): NookPassNode;

/** Occlusion from a file of `nook volumes`; decoder: MeshoptDecoder, for files of --compress. Throws a RangeError for another file. */
export class NookVolumes {
	constructor(buffer: ArrayBuffer | Uint8Array, decoder?: object);
	/** Frees everything. Further calls do nothing. */
	dispose(): void;
}
