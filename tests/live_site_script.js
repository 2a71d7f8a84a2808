// SPDX-License-Identifier: GPL-3.0-or-later
// Runs in the live site: makes patterns of every domain, and a picture of every method, samples and filter.
const { byId, chooseMethod, fields, filtersOf, made, methodNamed, patternCommand, program, readScalars, shading, stage, state, update, view, wished } = nookPage;
const later = ms => new Promise(done => setTimeout(done, ms));
const base64 = floats => {
	const bytes = new Uint8Array(floats.buffer);
	let text = '';
	for (let i = 0; i < bytes.length; i += 4096) text += String.fromCharCode(...bytes.subarray(i, i + 4096));
	return btoa(text);
};
while (!document.documentElement.dataset.settled || !document.documentElement.dataset.started) await later(50);

const patterns = [];
for (const [domain, count, variant, method, seed] of [['disk', 9, 'symmetric', 'refine', 1], ['ball', 5, 'free', 'refine', 1], ['sphere', 6, 'free', 'electro', 3],
	['hemisphere', 5, 'free', 'refine', 1], ['disk', 12, 'centred', 'lloyd', 2], ['ball', 7, 'free', 'halton', 1]]) {
	Object.entries({ domain, count, variant, method, seed }).forEach(([name, value]) => { fields[name].value = value; });
	byId('make').click();
	while (program.busy > 0) await later(20);
	const shown = [...byId('pattern-measures').querySelectorAll('tbody tr')].map(row => [...row.children].slice(0, 2).map(cell => cell.textContent).join(' '));
	patterns.push({ words: patternCommand().join(' '), files: made.files, measures: shown.join('\n') });
}

const pictures = [];
wished.right = 'open';
for (const method of shading.methods) {
	for (const { one, filter } of method.modules) {
		for (const samples of one ? ['one'] : method.samples.length > 0 ? ['tile', 'random'] : ['tile']) {
			chooseMethod(method);
			Object.assign(state, { samples, filter });
			await update();
			const of = method.samples.find(known => known.name === samples);
			pictures.push({ words: `--method ${method.name}${of ? ` --pattern ${of.file}` : ''} --radius ${state.numbers.radius} --filter ${filter}`,
				file: of && of.file, text: of && of.text, values: base64(readScalars(stage.gl, stage.picture)) });
		}
	}
}
// Settings stored as numbers in the block, and one that selects another module.
for (const [name, member, option, value] of [['alchemy', 'sigma', '--sigma', 0.5], ['slices', 'slice_thickness', '--slice-thickness', 0.3], ['statvo', 'slope', '--slope', 2],
	['vo-line', 'thickness', '--thickness', 0.25]]) {
	chooseMethod(methodNamed(name));
	Object.assign(state, { samples: 'tile', filter: filtersOf(state.method)[0] });
	state.numbers[member] = value;
	await update();
	const of = state.method.samples.find(known => known.name === 'tile');
	pictures.push({ words: `--method ${name}${of ? ` --pattern ${of.file}` : ''} --radius ${state.numbers.radius} --filter ${state.filter} ${option} ${value}`,
		values: base64(readScalars(stage.gl, stage.picture)) });
}
return { width: view.width, height: view.height, patterns, pictures };
