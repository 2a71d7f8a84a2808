// SPDX-License-Identifier: MIT
import type { Camera, Color, ColorRepresentation, Object3D, Scene, Texture, WebGLRenderer, WebGLRenderTarget } from 'three';
import { Pass } from 'three/addons/postprocessing/Pass.js';

export type Quality = 'low' | 'medium' | 'high';
export type View = 'combined' | 'off' | 'split' | 'visibility' | 'normals' | 'depth';

/** All options are properties as well and can be set at any time. A value out of range throws a RangeError. */
export interface NookAOOptions {
	/** How far surfaces occlude each other, in units of the scene. Default 1.5. */
	radius?: number;
	/** Depths per pixel: 6, 8 or 36. Default 'medium'. */
	quality?: Quality;
	/** Exponent of the visibility. 1 is closest to rays, and the default. */
	intensity?: number;
	/** Evaluates every second pixel of both axes and fills in the others. Default false. */
	halfResolution?: boolean;
	/** Averages frames, moving the samples from frame to frame. Default false. */
	temporal?: boolean;
	/** Depth from which on everything is sky, for sky domes. Default Infinity. */
	sky?: number;
}

export interface SharedOptions extends NookAOOptions {
	/** What to show. 'split' leaves out the obscurance in the left half. Default 'combined'. */
	view?: View;
	/** Colour of full obscurance. Default black. */
	tint?: ColorRepresentation;
	/** Draws transparent objects over the obscurance; they neither occlude nor receive any. Default true. */
	excludeTransparent?: boolean;
	/** Layers, 0 to 31, whose objects are treated in the same way. Default none. */
	excludeLayers?: number[];
}

export interface NookPassOptions extends SharedOptions {
	/** 'pass' draws the scene's own normals; 'depth' computes them from depth. Default 'depth'. */
	normals?: 'depth' | 'pass';
	/** With useBakedVisibility: the lower visibility of bake and screen decides. Default false. */
	baked?: boolean;
	/** Static occlusion of the level, drawn with every frame; the lower visibility decides. Default null. */
	volumes?: NookVolumes | null;
	/** false: colours come from the pass before, depth from its depth texture or a separate pass. Default true; false with `postprocessing`. Objects are excluded, and `samples` used, only with true. */
	renderScene?: boolean;
	/** Samples per pixel of the frame, 0 to 16. Default 0. */
	samples?: number;
}

export interface NookPass extends Required<Omit<NookPassOptions, 'tint'>> {}
/** Draws a scene with ambient occlusion, in place of a RenderPass. */
export class NookPass extends Pass {
	constructor(scene: Scene, camera: Camera, width?: number, height?: number, options?: NookPassOptions);
	scene: Scene;
	camera: Camera;
	get tint(): Color;
	set tint(colour: ColorRepresentation);
	/** Visibility of the last frame, 1 where open, in the first channel; null before the first. */
	get texture(): Texture | null;
	/** Forgets earlier frames of `temporal`. Call it after a cut of the camera. */
	reset(): void;
	setSize(width: number, height: number): void;
	render(renderer: WebGLRenderer, writeBuffer: WebGLRenderTarget, readBuffer: WebGLRenderTarget): void;
	/** Frees everything. Further calls do nothing. */
	dispose(): void;
}

export interface NookAO extends Required<NookAOOptions> {}
/** Visibility of a depth texture, for renderers without a composer. */
export class NookAO {
	constructor(camera: Camera, width: number, height: number, options?: NookAOOptions);
	camera: Camera;
	/** Visibility of the last frame, 1 where open, in the first channel; null before the first. */
	get texture(): Texture | null;
	/** Linear depths of the last frame, 1e30 for sky. */
	get depths(): Texture | null;
	/** View-space normals n of the last frame as 0.5 + 0.5 n; null where they were given. */
	get normals(): Texture | null;
	setSize(width: number, height: number): void;
	reset(): void;
	/** Returns false, and draws nothing, where the size is zero or the context is lost. normals: view-space normals as 0.5 + 0.5 n. */
	render(renderer: WebGLRenderer, depthTexture: Texture, normals?: Texture | null): boolean;
	dispose(): void;
}

/** Multiplies ambient light by the visibility that `nook bake` stored at vertices. Returns the number of meshes that have it. */
export function useBakedVisibility(root: Object3D): number;

/** Occlusion from a file of `nook volumes`; decoder: MeshoptDecoder, for files of --compress. Throws a RangeError for another file. */
export class NookVolumes {
	constructor(buffer: ArrayBuffer | Uint8Array, decoder?: object);
	/** Visibility of the last frame, 1 where open, in the first channel; null before the first. */
	get texture(): Texture | null;
	/** Draws over depths and normals of a NookAO. Returns false, and draws nothing, where the context is lost. */
	render(renderer: WebGLRenderer, camera: Camera, depths: Texture, normals: Texture): boolean;
	/** Frees everything. Further calls do nothing. */
	dispose(): void;
}
