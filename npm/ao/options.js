// SPDX-License-Identifier: MIT
// Options as properties that check what is set.
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
