// SPDX-License-Identifier: MIT
export interface Volumes { distance: number }
export interface VolumesView {
	cameraFromWorld: ArrayLike<number>;
	projection: ArrayLike<number>;
	width: number;
	height: number;
	depths: WebGLTexture;
	normals: WebGLTexture;
	zeroToOne?: boolean;
}
/** Throws a RangeError for another file. */
export function readVolumes(buffer: ArrayBuffer | Uint8Array): Volumes;
export class VolumesGl {
	constructor(gl: WebGL2RenderingContext, volumes: Volumes, glsl: string);
	draw(view: VolumesView): WebGLTexture;
	dispose(): void;
}
