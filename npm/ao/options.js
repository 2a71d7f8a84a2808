// SPDX-License-Identifier: MIT
// Options as properties that check what is set, and the settings of the module's block.
import { fill, recipe } from './nook_slices.js';

const shown = value => typeof value === 'string' ? `'${value}'` : Array.isArray(value) ? JSON.stringify(value) : String(value);
const isPositive = value => Number.isFinite(value) && value > 0;
const isTruth = value => typeof value === 'boolean';
export const positive = fallback => ({ fallback, valid: isPositive, expected: 'a number above 0' });
export const truth = fallback => ({ fallback, valid: isTruth, expected: 'true or false' });
export const oneOf = (...values) => ({ fallback: values[0], valid: value => values.includes(value), expected: values.map(shown).join(', ') });

/** Defines an object's options as properties that check what is set, and sets them. rows: name to { fallback, valid, expected }. */
export function defineOptions(object, owner, rows, given) {
	const unknown = Object.keys(given).find(name => !Object.hasOwn(rows, name));
	if (unknown !== undefined) throw new TypeError(`${owner}: found the option ${unknown}, expected ${Object.keys(rows).join(', ')}`);
	for (const [name, { fallback, valid, expected, stored = value => value }] of Object.entries(rows)) {
		let held;
		Object.defineProperty(object, name, {
			enumerable: true,
			get: () => held,
			set: value => {
				if (!valid(value)) throw new RangeError(`${owner}: ${name}: found ${shown(value)}, expected ${expected}`);
				held = stored(value);
			},
		});
		object[name] = given[name] === undefined ? fallback : given[name];
	}
}

/** The options of the obscurance itself. */
export const rows = {
	radius: positive(1.5),
	quality: { ...oneOf('low', 'medium', 'high'), fallback: 'medium' },
	intensity: positive(1),
	halfResolution: truth(false),
	temporal: truth(false),
	sky: { fallback: Infinity, valid: value => value > 0, expected: 'a number above 0 or Infinity' },
};

export const views = ['combined', 'off', 'split', 'visibility', 'normals', 'depth'];
const isLayers = value => Array.isArray(value) && value.every(layer => Number.isInteger(layer) && layer >= 0 && layer < 32);

/** The options of both passes. Color: the class of three.js; isVolumes: whether volumes are those of the pass. */
export const passRows = (Color, isVolumes) => ({
	...rows,
	view: oneOf(...views),
	tint: { fallback: 0x000000, valid: value => value !== undefined && value !== null, expected: 'a colour', stored: value => new Color(value) },
	excludeTransparent: truth(true),
	excludeLayers: { fallback: [], valid: isLayers, expected: 'an array of layers, 0 to 31' },
	volumes: { fallback: null, valid: value => value === null || isVolumes(value), expected: 'a NookVolumes or null' },
});

/** The module's block for a camera and the options of a pass, as 48 floats. others: further settings. */
export const blockOf = (owner, pass, camera, others) => fill(owner, camera.projectionMatrix.elements,
	{ ...recipe, radius: recipe.radius * pass.radius, power: recipe.power * pass.intensity, ...others });
