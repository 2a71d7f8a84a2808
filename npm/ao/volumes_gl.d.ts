// SPDX-License-Identifier: MIT
export interface Volumes { distance: number }
/** Throws a RangeError for another file. */
export function readVolumes(buffer: ArrayBuffer | Uint8Array, decoder?: object): Volumes;
export class VolumesGl {
	constructor(gl: WebGL2RenderingContext, volumes: Volumes, glsl: string);
	draw(view: { cameraFromWorld: ArrayLike<number>, projection: ArrayLike<number>, width: number, height: number,
		depths: WebGLTexture, normals: WebGLTexture, zeroToOne?: boolean }): WebGLTexture;
	dispose(): void;
}
