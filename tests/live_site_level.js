// SPDX-License-Identifier: GPL-3.0-or-later
// Runs in the live site: uses the level in three.js with buttons, keys, fingers and the slider.
const { byId, live } = nookPage, said = {};
const later = ms => new Promise(done => setTimeout(done, ms));
while (!document.documentElement.dataset.levelDrawn) await later(50);
const canvas = byId('level-canvas'), gl = canvas.getContext('webgl2');
const drawnAgain = async act => { const before = live.drawings; act(); while (live.drawings === before) await later(20); };
const press = (bar, choice) => drawnAgain(() => byId(bar).querySelector(`[data-choice="${choice}"]`).click());
const key = name => canvas.dispatchEvent(new KeyboardEvent('keydown', { key: name, bubbles: true, cancelable: true }));
const slide = share => drawnAgain(() => { byId('split').value = share; byId('split').dispatchEvent(new Event('input')); });
const pixels = () => { const bytes = new Uint8Array(4 * canvas.width * canvas.height); gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes); return bytes; };
const most = (a, b, counts = () => true) => a.reduce((worst, one, i) => i % 4 < 3 && counts((i >> 2) % canvas.width) ? Math.max(worst, Math.abs(one - b[i])) : worst, 0);

// Materials: colours, darker with ambient occlusion.
await slide(1000);
const lit = pixels();
said.colourful = lit.filter((one, i) => i % 4 === 0 && Math.abs(one - lit[i + 2]) > 30).length / (lit.length / 4);
await drawnAgain(() => key('o'));
const plain = pixels();
said.off = !live.on && byId('ao-bar').querySelector('[data-choice="off"]').getAttribute('aria-pressed') === 'true';
const raysLit = plain; // right of the slider are rays
await press('beside-bar', 'none');
const none = pixels();
said.rayed = most(raysLit, none);
said.darker = [lit, raysLit].map(one => one.reduce((sum, value, i) => sum + (i % 4 < 3 ? value - none[i] : 0), 0) / (0.75 * one.length));
said.lighter = lit.some((one, i) => i % 4 < 3 && one > none[i] + 2);
await press('ao-bar', 'on');
// Both pictures on either side of the line.
await slide(250);
const both = pixels(), line = Math.round(0.25 * canvas.width);
said.sides = [most(both, lit, x => x < line), most(both, none, x => x > line)];

// Visibility alone: on the right the traced picture itself.
await press('beside-bar', 'rays');
await drawnAgain(() => key('v'));
await slide(0);
const rays = pixels(), png = new Image();
png.src = `data:image/png;base64,${nookData.level.png}`;
await png.decode();
const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height }).getContext('2d');
copy.drawImage(png, 0, 0);
const traced = copy.getImageData(0, 0, canvas.width, canvas.height).data;
said.traced = traced.reduce((worst, one, i) => {
	const x = (i >> 2) % canvas.width, y = canvas.height - 1 - Math.floor((i >> 2) / canvas.width);
	const expected = i % 4 || (one === 0 && traced[i + 2] === 255) ? 255 : one;
	return i % 4 ? worst : Math.max(worst, Math.abs(rays[4 * (y * canvas.width + x)] - expected));
}, 0);
said.errors = live.errors;
await press('quality-bar', 'high');
said.high = live.errors[0];
await press('quality-bar', 'medium');
for (const [bar, choice] of [['normals-bar', 'pass'], ['halfResolution-bar', 'true'], ['temporal-bar', 'true']]) await press(bar, choice);
said.options = [live.pass.normals, live.pass.halfResolution, live.pass.temporal, live.errors[0] < live.errors[1]];
for (const [bar, choice] of [['normals-bar', 'depth'], ['halfResolution-bar', 'false'], ['temporal-bar', 'false']]) await press(bar, choice);
await drawnAgain(() => { byId('level-radius').value = byId('level-radius').max; byId('level-radius').dispatchEvent(new Event('input')); });
said.radius = [live.pass.radius / nookData.level.radius_m, byId('level-figures').innerText === ''];

// The camera, by keys, a finger, two fingers, buttons and its list.
const at = () => [...live.camera.position.toArray(), ...live.camera.quaternion.toArray()].map(one => +one.toFixed(4)).join();
const places = [at()];
const moves = async act => { await drawnAgain(act); places.push(at()); };
await moves(() => key('ArrowLeft'));
said.moved = live.moved && byId('beside-bar').querySelector('[data-choice="rays"]').disabled && !byId('level-back').hidden && byId('level-caption').textContent;
await moves(() => key('w'));
canvas.setPointerCapture = () => {}; // for fingers that are none
const finger = (type, id, x, y) => canvas.dispatchEvent(new PointerEvent(type, { pointerId: id, clientX: x, clientY: y, buttons: type === 'pointerup' ? 0 : 1, bubbles: true, pointerType: 'touch' }));
await moves(() => { finger('pointerdown', 7, 100, 100); finger('pointermove', 7, 140, 110); });
await moves(() => { finger('pointerdown', 8, 200, 100); finger('pointermove', 8, 240, 100); });
finger('pointerup', 7, 0, 0);
finger('pointerup', 8, 0, 0);
await moves(() => byId('level-pad').querySelector('[data-move="up"]').click());
const others = [...byId('camera-bar').querySelectorAll('button')].map(one => one.dataset.choice);
said.cameras = others.join(' ');
await moves(() => byId('camera-bar').querySelectorAll('button')[1].click());
said.places = new Set(places).size === places.length;
said.size = [canvas.width, canvas.height];
await press('camera-bar', others[0]);
said.back = !live.moved && at() === places[0];

// A lost context draws the same picture afterwards.
byId('level-radius').value = 100;
await drawnAgain(() => byId('level-radius').dispatchEvent(new Event('input')));
await slide(1000);
const before = pixels(), context = gl.getExtension('WEBGL_lose_context'), restored = new Promise(done => canvas.addEventListener('webglcontextrestored', done, { once: true }));
context.loseContext();
await later(200);
const count = live.drawings;
context.restoreContext();
await restored;
while (live.drawings === count) await later(20);
said.restored = most(before, pixels());
said.network = performance.getEntriesByType('resource').map(({ name }) => name).filter(name => !/^(file|data|blob):|^http:\/\/127\.0\.0\.1/.test(name));
return said;
