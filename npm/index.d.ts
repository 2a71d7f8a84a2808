// SPDX-License-Identifier: GPL-3.0-or-later

export type Domain = 'disk' | 'ball' | 'sphere' | 'hemisphere';
export type Kernel = 'none' | `box:${number}` | `binomial:${number}` | `gauss:${number}` | `bilateral:${number}`;
/** Pictures of patterns are SVG. The program writes exr and png of tiles where it has the component levels; this package refuses them with code 5. */
export type PatternFormat = 'json' | 'h' | 'glsl' | 'hlsl' | 'csv' | 'svg';
export type TileFormat = PatternFormat | 'exr' | 'ktx2' | 'png';
/** The formats whose files are bytes. */
export type BinaryFormat = 'exr' | 'ktx2' | 'png';

/** Thrown with the line that the program prints, and its exit code. */
export class NookError extends Error {
	constructor(message: string, code: number);
	/** 1 usage, 2 file, 3 invalid input, 4 run time, 5 not supported, 7 difference */
	code: number;
}

/** While a call works. */
export interface Watch {
	/** What is done, and a share from 0 to 1. */
	onProgress?: (stage: string, share: number) => void;
	/** While a pattern is made: the number of a start, and x, y, z of its points. */
	onPoints?: (start: number, numbers: Float64Array) => void;
	/** Runs the call in a worker of its own, which the signal ends; the call is then rejected with the signal's reason. */
	signal?: AbortSignal;
}

interface Made<Data, Format extends string> {
	/** What the JSON file is called in commands. */
	name: string;
	/** The JSON file, read: docs/reference/patterns.md */
	data: Data;
	/** The files by their format: json and those that were asked for. */
	files: { json: string } & { [format in Format]?: format extends BinaryFormat ? Uint8Array : string };
}

export interface PatternOptions extends Watch {
	domain: Domain;
	/** 1 to 4096 */
	count: number;
	symmetric?: boolean;
	centre?: boolean;
	method?: 'refine' | 'electro' | 'equal' | 'random' | 'poisson' | 'halton' | 'vogel' | 'lloyd';
	minimise?: 'rms' | 'noise' | 'cliff' | 'window';
	weights?: 'voronoi' | 'equal' | 'fitted';
	order?: 'none' | 'progressive';
	starts?: number;
	/** 0 to 4294967295; 1 where absent. */
	seed?: number;
	exponent?: number;
	name?: string;
	threads?: number;
	/** In addition to json. */
	formats?: readonly PatternFormat[];
	/** The name of the JSON file in commands: pattern.json where absent. */
	file?: string;
}

interface PatternQuality {
	plane: number;
	noise: number;
	bias: number;
	plane_exact: number;
	greatest: number;
	/** disk */
	cliff?: number;
	cliff_greatest?: number;
	crease?: number;
	/** disk and ball */
	centre?: number;
	/** sphere and hemisphere */
	cap?: number;
	spread: number;
	smallest_distance: number;
	/** The text 'infinite' where two points are one. */
	energy: number | 'infinite';
	energy_exponent: number;
}

interface TileQuality {
	/** Absent for slices. */
	window?: number;
	/** Absent for very many samples, as variant_plane and worst_variant. */
	window_exact?: number;
	variant_plane?: number;
	worst_variant?: number;
	base_plane?: number;
}

interface FileHead {
	schema: string;
	command?: string;
	version?: string;
	'SPDX-License-Identifier'?: string;
	base_command?: string;
	count: number;
	recipe?: { [setting: string]: unknown };
}

export interface PatternData extends FileHead {
	domain: Domain;
	points: number[][];
	weights: number[];
	quality: PatternQuality;
}

export interface TileData extends FileHead {
	domain: Domain | 'slice';
	size: number;
	/** Absent for one. */
	frames?: number;
	/** Where the tile moves from frame to frame. */
	moves?: [number, number][];
	/** Row by row, frame after frame. */
	variants: { points: number[][]; weights: number[] }[];
	/** cos, sin, scale and handedness of each variant, or an axis in the ball. */
	transforms?: number[][];
	quality: TileQuality;
}

export type MadePattern = Made<PatternData, PatternFormat>;
export type MadeTile = Made<TileData, TileFormat>;

interface TileSettings extends Watch {
	/** Side of the window, 2 to 128; above 8 with a filter alone. */
	size: number;
	filter?: Kernel | `${Kernel}@${number}` | readonly (Kernel | `${Kernel}@${number}`)[];
	robust?: boolean;
	frames?: number;
	ema?: number;
	moves?: boolean;
	progressive?: boolean;
	lambda?: number;
	starts?: number;
	/** 0 to 4294967295; 1 where absent. */
	seed?: number;
	memory?: string;
	name?: string;
	threads?: number;
	/** In addition to json. */
	formats?: readonly TileFormat[];
	/** The name of the JSON file in commands: tile.json where absent. */
	file?: string;
}

export type TileOptions =
	| (TileSettings & {
		/** What pattern() returned, or the text of its JSON file. */
		pattern: MadePattern | string;
		kind?: 'points' | 'even' | 'random';
		domain?: undefined;
		count?: undefined;
	})
	| (TileSettings & { domain: 'slice'; count?: number; kind?: 'points'; pattern?: undefined });

/** Coordinates, or named columns. */
export type Points = readonly (readonly number[])[] | readonly { x: number; y: number; z?: number; halfLength?: number; weight?: number }[];

export interface MeasureOptions extends Watch {
	/** Of points of your own, which do not say it. */
	domain?: Domain;
	/** The error of a tile behind filters: those that it was made for where absent. */
	filter?: Kernel | readonly Kernel[];
	ema?: number;
	threads?: number;
}

interface Measured {
	schema: string;
	verb: 'info';
	version: string;
	count: number;
	command?: string;
	'made by version'?: string;
}

/** What `nook info --json` says of a pattern. */
export interface PatternMeasures extends Measured {
	kind: 'pattern';
	domain: Domain;
	quality: PatternQuality;
	quality_in_file?: PatternQuality;
}

/** What it says of a tile. */
export interface TileMeasures extends Measured {
	kind: 'tile';
	domain: Domain | 'slice';
	size: number;
	frames: number;
	'base command'?: string;
	quality: TileQuality;
	/** By filter: 'box:3', 'box:3, half', … */
	behind?: { [filter: string]: number };
	quality_in_file?: TileQuality;
}

export type Method = 'vo-line' | 'vo-point' | 'vo-area' | 'alchemy' | 'statvo' | 'slices' | 'aov' | 'aov-mask';

/** Numbers of `nook emit`, whose page says what each does and which method takes it. */
export interface EmitOptions extends Watch {
	methods: Method | `${Method},${string}` | readonly Method[];
	/** One of glsl, hlsl and wgsl. */
	glsl?: '330' | '430' | 'es300' | 'vulkan' | 330 | 430;
	hlsl?: '60' | 60;
	wgsl?: true;
	textures?: 'fixed' | 'macros' | 'separate';
	/** Samples of each method but statvo and slices, in the same order. */
	patterns?: readonly (MadePattern | MadeTile | string)[];
	counts?: number | string | readonly number[];
	tile?: 'texture' | 'array';
	depth?: 'linear' | 'device';
	normals?: 'texture' | 'from-depth';
	block?: 'mixed' | 'floats';
	namespace?: string;
	directions?: number;
	recipe?: 'paper' | 'rays';
	useNormal?: 'yes' | 'no';
	thick?: boolean;
	combine?: 'product' | 'minimum';
	thirdRadius?: boolean;
	falloff?: 'constant' | 'quadratic';
	paired?: boolean;
	cut?: boolean;
	depthLevels?: number;
	bands?: number;
	layers?: number;
	layering?: 'adaptive' | 'uniform';
	quadrants?: boolean;
	tables?: 'full' | 'half' | 'quarter';
	skip?: 'yes' | 'no';
	slices?: number;
	sliceSteps?: number;
	bent?: boolean;
	strength?: number;
	power?: number;
	filter?: 'none' | 'bilateral' | 'window';
	taps?: number;
	resolution?: 'full' | 'half';
	gather?: boolean;
	main?: 'fragment' | 'compute';
	/** The name of the module in its own text: nook.glsl, nook.hlsl or nook.wgsl where absent. */
	file?: string;
}

export interface Answer {
	code: number;
	stdout: string;
	stderr: string;
	/** Those of `take` that are there. Files that end with .exr, .ktx2 or .png are bytes. */
	files: { [name: string]: string } & { [name: `${string}.${BinaryFormat}`]: Uint8Array };
}

export interface RunOptions extends Watch {
	/** Are there before the run. */
	files?: { [name: string]: string | Uint8Array };
	/** Are handed back. */
	take?: readonly string[];
}

type Bytes = ArrayBuffer | ArrayBufferView;
type Source = Bytes | WebAssembly.Module | Response | URL | string;

export function pattern(options: PatternOptions): Promise<MadePattern>;
export function tile(options: TileOptions): Promise<MadeTile>;
/** Measures a sample set again. Points of your own need their domain. */
export function measure(points: Points | MadePattern, options?: MeasureOptions): Promise<PatternMeasures>;
export function measure(tile: MadeTile, options?: MeasureOptions): Promise<TileMeasures>;
export function measure(text: string, options?: MeasureOptions): Promise<PatternMeasures | TileMeasures>;
/** `header`, the C++ that fills the block, and `script`, the JavaScript, are absent for aov and aov-mask. */
export function emit(options: EmitOptions & { glsl: unknown }): Promise<{ glsl: string; header?: string; script?: string }>;
export function emit(options: EmitOptions & { hlsl: unknown }): Promise<{ hlsl: string; header?: string; script?: string }>;
export function emit(options: EmitOptions & { wgsl: true }): Promise<{ wgsl: string; header?: string; script?: string }>;
/** A run of the program with its own words. Throws nothing for an exit code. */
export function nook(command: readonly (string | number)[], io?: RunOptions): Promise<Answer>;
/** Compiles ahead of the first call. `source`: where nook.wasm does not lie beside the module. */
export function load(source?: Source | Promise<Source>): Promise<WebAssembly.Module>;
