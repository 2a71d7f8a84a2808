// SPDX-License-Identifier: GPL-3.0-or-later

export type Domain = 'disk' | 'ball' | 'sphere' | 'hemisphere';
export type Format = 'json' | 'h' | 'glsl' | 'hlsl' | 'csv' | 'svg';

/** Thrown with the line that the program prints, and its exit code. */
export class NookError extends Error {
	/** 1 usage, 2 file, 3 invalid input, 4 run time, 5 not supported, 7 difference */
	code: number;
}

/** Any other option of the verb in camel case: `{ readDistance: 2 }` is `--read-distance 2`, `true` is a flag. */
export interface Options {
	[option: string]: unknown;
}

export interface PatternOptions extends Options {
	domain: Domain;
	/** 1 to 4096 */
	count: number;
	symmetric?: boolean;
	centre?: boolean;
	method?: string;
	minimise?: string;
	weights?: string;
	order?: string;
	starts?: number;
	seed?: number;
	exponent?: number;
	name?: string;
	/** Beside json. */
	formats?: Format[];
	/** What the file is called where its name is told: pattern.json where absent. */
	file?: string;
}

/** A pattern or a tile. */
export interface Made {
	name: string;
	/** The JSON file, read: docs/reference/patterns.md */
	data: any;
	/** The text of each format. */
	files: { json: string } & { [format in Format]?: string };
}

export interface TileOptions extends Options {
	/** What pattern() returned, or the text of its JSON file. */
	pattern: Made | string;
	/** Side of the window. */
	size?: number;
	kind?: string;
	seed?: number;
	formats?: Format[];
	file?: string;
}

/** Coordinates, or named columns: x, y, z, halfLength, weight. */
export type Points = number[][] | { x: number; y: number; z?: number; halfLength?: number; weight?: number }[];

export interface EmitOptions extends Options {
	methods: string | string[];
	glsl: '330' | '430' | 'es300' | 'vulkan' | 330 | 430;
	patterns?: (Made | string)[];
	filter?: string;
	file?: string;
}

export interface Answer {
	code: number;
	stdout: string;
	stderr: string;
	files: { [name: string]: string };
}

export function pattern(options: PatternOptions): Promise<Made>;
export function tile(options: TileOptions): Promise<Made>;
/** What `nook info --json` says. Points of your own need their domain. */
export function measure(points: Points | Made | string, options?: { domain?: Domain } & Options): Promise<any>;
/** `header`, the C++ that fills the block, and `script`, the JavaScript, are absent for aov and aov-mask. */
export function emit(options: EmitOptions): Promise<{ glsl: string; header?: string; script?: string }>;
/** A run of the program: `files` are there before it, those of `take` are handed back. Throws nothing for an exit code. */
export function nook(command: (string | number)[], io?: {
	files?: { [name: string]: string | Uint8Array };
	take?: string[];
	/** Called while it runs: what is done, and a share from 0 to 1. */
	onProgress?: (stage: string, share: number) => void;
	/** Called while a pattern is made: the number of a start, and x, y, z of its points. */
	onPoints?: (start: number, numbers: Float64Array) => void;
}): Promise<Answer>;
/** Compiles ahead of the first call; `source` where nook.wasm does not lie beside the module. */
export function load(source?: BufferSource | WebAssembly.Module | Promise<BufferSource>): Promise<WebAssembly.Module>;
