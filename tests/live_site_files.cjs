// SPDX-License-Identifier: GPL-3.0-or-later
// node live_site_files.cjs FOLDER <SAID: writes what live_site_script.js returns as files: patterns, and pictures as TIFF of 32-bit
// floats.
'use strict';
const { mkdirSync, readFileSync, writeFileSync } = require('node:fs');
const folder = process.argv[2];
const { width, height, patterns, pictures } = JSON.parse(readFileSync(0, 'utf8'));

function tiff(values) {
	const entries = [[256, 4, width], [257, 4, height], [258, 3, 32], [259, 3, 1], [262, 3, 1], [273, 4, 8], [277, 3, 1], [278, 4, height],
		[279, 4, values.length], [339, 3, 3]];
	const head = Buffer.alloc(8), list = Buffer.alloc(2 + 12 * entries.length + 4);
	head.write('II*\0', 'latin1');
	head.writeUInt32LE(8 + values.length, 4);
	list.writeUInt16LE(entries.length, 0);
	entries.forEach(([tag, type, value], i) => {
		list.writeUInt16LE(tag, 2 + 12 * i);
		list.writeUInt16LE(type, 4 + 12 * i);
		list.writeUInt32LE(1, 6 + 12 * i);
		list.writeUInt32LE(value, 10 + 12 * i);
	});
	return Buffer.concat([head, values, list]);
}

mkdirSync(folder);
const lines = list => list.map((one, i) => `${one.name}${i}|${one.words}\n`).join('');
patterns.forEach(({ files, measures }, i) => {
	for (const [name, text] of Object.entries(files)) writeFileSync(`${folder}/p${i}.${name.split('.').pop()}`, text);
	writeFileSync(`${folder}/p${i}.info`, `${measures}\n`);
});
writeFileSync(`${folder}/patterns`, lines(patterns.map(({ words }) => ({ name: 'p', words }))));
pictures.forEach(({ file, text, values }, i) => {
	if (file) writeFileSync(`${folder}/${file}`, text);
	writeFileSync(`${folder}/v${i}.tif`, tiff(Buffer.from(values, 'base64')));
});
writeFileSync(`${folder}/pictures`, lines(pictures.map(({ words }) => ({ name: 'v', words }))));
