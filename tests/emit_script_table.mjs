// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras and settings, listed once for all languages. node emit_script_table.mjs cpp BLOCK, cs or py: a program that prints the result
// of the emitted file (./m.h, m.cs, m.py) for each; node emit_script_table.mjs js: the results of the emitted module (./m.js). One
// line each: the bytes of the block, or "refused: " and the reason; then the texels of the tiles.
const [language, block] = process.argv.slice(2);

const perspective = (x, y, near, far) => [x, 0, 0, 0, 0, y, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0];
const changed = (matrix, changes) => matrix.map((value, i) => changes[i] ?? value);
const transposed = matrix => matrix.map((_, i) => matrix[i % 4 * 4 + (i >> 2)]);
const plain = perspective(0.9361572, 1.66427948235, 0.1, 100);
const flat = [0.31, 0, 0, 0, 0, 0.47, 0, 0, 0, 0, -0.02, 0, 0.25, -0.5, -1.002, 1];
const projections = [
	plain,
	perspective(1.7, 1.7, 0.013, 7000.5),
	changed(plain, { 8: 0.13, 9: -0.07 }), // off-centre, and jittered
	changed(plain, { 5: -1.66427948235 }), // upside down
	plain.map(value => value * 0.37), // scaled
	changed(plain, { 10: 0, 14: 0.1 }), // reversed, infinite, 0 to 1
	changed(plain, { 10: -1, 14: -0.2 }), // infinite
	changed(plain, { 10: 0.0011, 14: 0.11 }), // reversed
	flat,
	changed(flat, { 10: 0.02, 14: 1.002 }), // reversed
	changed(plain, { 4: 0.1 }), // a skew
	changed(plain, { 0: 0 }),
	changed(plain, { 2: 0.2 }), // an oblique near plane
	changed(plain, { 10: NaN }),
	changed(plain, { 3: Infinity }),
	changed(plain, { 8: 0.13, 10: 1.002, 11: 1 }), // left-handed
	changed(flat, { 10: 0.02 }),
	transposed(plain), // row-major
	transposed(flat),
	plain.map(() => 0),
	plain.map(value => -value),
];
const sizes = [{ width: 640, height: 360 }, { width: 321, height: 180, x: 7, y: 3, guard: 16, first_row_ndc_y: 1 }];
const formats = [{}, { device_depth: true }, { device_depth: true, zero_to_one: true, depth_bits: 24 }, { device_depth: true, depth_bits: 16 },
	{ depth_bits: 16, normal_bits: 8 }, { normal_bits: 11 }];
const numbers = [
	{ radius: 0.7, second_radius: 0.3, third_radius: 1.9, thickness: 0.4, second_thickness: 0.1, third_thickness: 3.3 },
	{ most_pixels: 77.7, least_pixels: 1.5, first_band: 11.1, second_band: 22.2 },
	{ sigma: 1.3, contrast: 1.1, beta: 3e-4, epsilon: 2e-4, slice_thickness: 0.123, strength: 0.9, power: 1.7 },
	{ box_height: 0.3, slope: 2.2, largest_pixels: 63 },
	...['radius', 'box_height', 'slope', 'contrast', 'epsilon', 'slice_thickness', 'strength', 'power', 'largest_pixels', 'width', 'height']
		.map(name => ({ [name]: 0 })),
	...['most_pixels', 'least_pixels', 'second_radius', 'third_radius', 'thickness', 'second_thickness', 'third_thickness', 'first_band',
		'second_band', 'sigma', 'beta', 'guard'].map(name => ({ [name]: -1 })),
	{ largest_pixels: 256 }, { least_pixels: 400 }, { depth_bits: 8 }, { normal_bits: 7 }, { first_row_ndc_y: 0 }, { radius: NaN },
];
const tiles = ['nook_vo_line', 'nook_vo_point', 'nook_vo_area', 'nook_alchemy'];
const methods = { voLine: 'nook_vo_line', voPoint: 'nook_vo_point', voArea: 'nook_vo_area', alchemy: 'nook_alchemy', statVo: 'nook_statvo', slices: 'nook_slices' };

const cases = [];
for (const projection of projections) for (const size of sizes) for (const format of formats) cases.push({ projection, settings: { ...size, ...format } });
for (const some of numbers) cases.push({ projection: plain, settings: { ...sizes[0], ...some } });
for (const name of Object.keys(methods)) for (const reach of [0.5, 1.5, 0.0123]) cases.push({ name, reach, projection: plain, settings: sizes[1] });

if (language === 'js') {
	const module = await import(`${process.cwd()}/m.js`);
	const hex = bytes => [...new Uint8Array(bytes)].map(byte => byte.toString(16).padStart(2, '0')).join('');
	for (const { name, reach, projection, settings } of cases) {
		try {
			console.log(hex(module.fill(projection, { ...(name && module[name].settings(reach)), ...settings })));
		} catch (error) {
			if (!(error instanceof RangeError)) throw error;
			console.log(`refused: ${error.message}`);
		}
	}
	for (const name of Object.keys(methods)) {
		const { tile } = module[name];
		if (tile) console.log(`${tile.name} ${tile.width} ${tile.height} ${hex(tile.texels.buffer)}`);
	}
} else if (language === 'cs') {
	const number = value => Number.isNaN(value) ? 'double.NaN' : String(value).replace('Infinity', 'double.PositiveInfinity');
	console.log('using System;\nusing System.Runtime.InteropServices;\nstatic class Table\n{\n'
		+ '\tstatic string Hex(byte[] bytes)\n\t{\n\t\treturn BitConverter.ToString(bytes).Replace("-", "").ToLower();\n\t}\n'
		+ '\tstatic void Show(double[] p, Nook.nook_settings s)\n\t{\n\t\ttry\n\t\t{\n\t\t\tvar bytes = new byte[Marshal.SizeOf(typeof(Nook.Block))];\n'
		+ '\t\t\tvar pin = GCHandle.Alloc(bytes, GCHandleType.Pinned);\n\t\t\tMarshal.StructureToPtr(Nook.Fill(p, s), pin.AddrOfPinnedObject(), false);\n'
		+ '\t\t\tpin.Free();\n\t\t\tConsole.WriteLine(Hex(bytes));\n\t\t}\n\t\tcatch (ArgumentException error)\n\t\t{\n'
		+ '\t\t\tConsole.WriteLine("refused: " + error.Message);\n\t\t}\n\t}\n'
		+ '\tstatic void Tile(string name, int width, int height, float[] texels)\n\t{\n\t\tvar bytes = new byte[4 * texels.Length];\n'
		+ '\t\tBuffer.BlockCopy(texels, 0, bytes, 0, bytes.Length);\n\t\tConsole.WriteLine(name + " " + width + " " + height + " " + Hex(bytes));\n\t}\n'
		+ '\tstatic void Main()\n\t{\n\t\tNook.nook_settings s;\n' + cases.map(({ name, reach, projection, settings }) =>
			`\t\ts = ${name ? `Nook.${methods[name]}_settings(${reach})` : 'new Nook.nook_settings()'};\n`
			+ Object.entries(settings).map(([key, value]) => `\t\ts.${key} = ${number(value)};\n`).join('')
			+ `\t\tShow(new double[] {${projection.map(number).join(', ')}}, s);\n`).join('')
		+ tiles.map(name => `\t\tTile("${name}_tile", Nook.${name}_tile_width, Nook.${name}_tile_height, Nook.${name}_tile);\n`).join('') + '\t}\n}');
} else if (language === 'py') {
	const number = value => Number.isNaN(value) ? 'math.nan' : value === true ? 'True' : value === false ? 'False' : String(value).replace('Infinity', 'math.inf');
	console.log('import math\nimport struct\nimport m\n\ndef show(projection, settings):\n\ttry:\n\t\tprint(m.fill(projection, **settings).hex())\n'
		+ '\texcept ValueError as error:\n\t\tprint(f"refused: {error}")\n\n' + cases.map(({ name, reach, projection, settings }) =>
			`show([${projection.map(number).join(', ')}], {${name ? `**m.${methods[name].slice(5)}_settings(${reach}), ` : ''}`
			+ Object.entries(settings).map(([key, value]) => `"${key}": ${number(value)}`).join(', ') + '})\n').join('')
		+ tiles.map(name => name.slice(5)).map(name => `print("nook_${name}_tile", *m.${name}_tile_size, struct.pack(f"<{len(m.${name}_tile)}f", *m.${name}_tile).hex())\n`).join(''));
} else {
	const number = value => Number.isNaN(value) ? 'std::nan("")' : String(value).replace('Infinity', 'HUGE_VAL');
	const code = ({ name, reach, projection, settings }) => `\t{\n\t\tconst double p[16] = {${projection.map(number).join(', ')}};\n`
		+ `\t\tnook_settings s${name ? ` = ${methods[name]}_settings(${reach})` : ''};\n`
		+ Object.entries(settings).map(([key, value]) => `\t\ts.${key} = ${number(value)};\n`).join('')
		+ `\t\t${block} b{};\n\t\tconst char* const reason = nook_fill(b, p, s);\n\t\tif (reason)\n\t\t\tstd::printf("refused: %s\\n", reason);\n\t\telse\n\t\t\thex(&b, sizeof b);\n\t}\n`;
	console.log('#include "m.h"\n#include <cstdio>\nstatic void hex(const void* bytes, std::size_t size)\n{\n\tfor (std::size_t i = 0; i < size; ++i)\n'
		+ '\t\tstd::printf("%02x", static_cast<const unsigned char*>(bytes)[i]);\n\tstd::printf("\\n");\n}\nint main()\n{\n' + cases.map(code).join('')
		+ tiles.map(name => `\tstd::printf("${name}_tile %d %d ", ${name}_tile_width, `
			+ `${name}_tile_height);\n\thex(${name}_tile, sizeof ${name}_tile);\n`).join('') + '}');
}
