// SPDX-License-Identifier: GPL-3.0-or-later
// Runs in the live site: uses its controls as a person would.
const { byId, eye, fields, made, program, readScalars, settle, SKY, stage, state, update } = nookPage;
const later = ms => new Promise(done => setTimeout(done, ms));
const said = {}, idle = async () => { while (program.busy > 0) await later(20); };
const choose = async values => { Object.entries(values).forEach(([name, value]) => { fields[name].value = value; }); byId('make').click(); };
const press = key => byId('stage').dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
const drawings = () => +document.documentElement.dataset.stageDrawn;
const drawnAgain = async act => { const before = drawings(); act(); while (drawings() === before) await later(20); };
while (!document.documentElement.dataset.settled || !document.documentElement.dataset.started) await later(50);

said.domains = [...fields.domain.options].map(one => one.value).join(' ');
const shown = () => byId('pattern-picture').innerHTML.replace(/(cells|disk)\d+/g, '');
const before = shown();
await choose({ domain: 'disk', count: 400 });
while (shown() === before) await later(20);
byId('cancel').click();
await idle();
said.cancelled = byId('state').textContent;
await later(300);
said.restored = shown() === before && made.data.command === 'nook pattern --domain disk --count 16';
await choose({ domain: 'hemisphere', count: 6, variant: 'symmetric' });
await idle();
said.refused = byId('state').textContent;
await choose({ domain: 'disk', count: 5, variant: 'free' });
await idle();
said.after = made.data.command;

// Triangles drawn from the traced view: same depths as the ray-traced ones.
await drawnAgain(() => { eye.moved = true; settle(); update(); });
const depths = readScalars(stage.gl, stage.scene.depths), off = depths.filter((d, i) => Math.abs(d - stage.cast.values[i]) > 1e-3 * stage.cast.values[i]).length;
said.near = off < 0.03 * depths.length; // edges
await drawnAgain(() => press('d'));
await drawnAgain(() => press('ArrowLeft'));
said.moved = byId('stage-caption').textContent.split(', ').slice(1).join(', ');
said.covered = readScalars(stage.gl, stage.scene.depths).filter(d => d < SKY).length > depths.length / 4;
await drawnAgain(() => byId('back').click());
said.back = byId('stage-caption').textContent.split(', ').slice(1).join(', ');

await drawnAgain(() => { const slider = [...byId('setting-bar').querySelectorAll('label')].find(label => label.textContent.startsWith('thickness')).querySelector('input'); slider.value = 0.5; slider.dispatchEvent(new Event('input')); });
said.thick = stage.left.chosen.command;
await choose({ domain: 'ball', count: 4 });
await idle();
const press_choice = (bar, choice) => byId(bar).querySelector(`[data-choice="${choice}"]`).click();
await drawnAgain(() => press_choice('method-bar', 'vo-point'));
const commands = [byId('pattern-caption').querySelector('code').textContent, byId('commands').textContent];
press_choice('samples-bar', 'made');
said.busy = !byId('stage-work').hidden && byId('stage-state').textContent;
const drawn = drawings();
while (drawings() === drawn) await later(20);
said.yours = byId('left-name').textContent;
said.idle = byId('stage-work').hidden;
commands.push(byId('commands').textContent);

// A choice is kept, even after a method that does not have it.
await drawnAgain(() => press_choice('samples-bar', 'random'));
await drawnAgain(() => press_choice('filter-bar', 'bilateral'));
for (const name of ['statvo', 'alchemy', 'slices', 'vo-line']) {
	await drawnAgain(() => press_choice('method-bar', name));
	commands.push(byId('commands').textContent);
}
said.kept = `${state.samples} ${state.filter}`;

// Rays of another radius than the picture's.
said.silent = byId('radius-note').hidden;
await drawnAgain(() => { const slider = byId('setting-bar').querySelector('input'); slider.value = slider.max; slider.dispatchEvent(new Event('input')); });
said.warned = !byId('radius-note').hidden && byId('radius-note').textContent;
said.figures = byId('stage-figures').innerText;
commands.push(byId('commands').textContent);
said.commands = commands;
return said;
