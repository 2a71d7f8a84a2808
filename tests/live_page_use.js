// SPDX-License-Identifier: GPL-3.0-or-later
// In the page of nook report live: what a person does with it.
const later = ms => new Promise(done => setTimeout(done, ms));
const said = {}, idle = async () => { while (program.busy > 0) await later(20); };
const choose = async values => { Object.entries(values).forEach(([name, value]) => { fields[name].value = value; }); byId('make').click(); };
const press = key => byId('stage').dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
const drawings = () => +document.documentElement.dataset.stageDrawn;
const drawnAgain = async act => { const before = drawings(); act(); while (drawings() === before) await later(20); };
while (!document.documentElement.dataset.settled) await later(50);

await choose({ domain: 'disk', count: 400 });
await later(300);
byId('cancel').click();
await idle();
said.cancelled = byId('state').textContent;
await choose({ domain: 'hemisphere', count: 6, variant: 'symmetric' });
await idle();
said.refused = byId('state').textContent;
await choose({ domain: 'disk', count: 5, variant: 'free' });
await idle();
said.after = made.data.command;

// The triangles from where the view was traced: the depths that were cast.
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
await drawnAgain(() => byId('method-bar').querySelector('[data-choice="vo-point"]').click());
await drawnAgain(() => byId('samples-bar').querySelector('[data-choice="made"]').click());
said.yours = byId('left-name').textContent;
return said;
