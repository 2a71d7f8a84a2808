// SPDX-License-Identifier: GPL-3.0-or-later
// Looking around in a picture: mouse, touch, keyboard, and buttons for those who have neither mouse nor keys.
import { button } from 'nook:page';

const TURNS = { ArrowLeft: [0.05, 0], ArrowRight: [-0.05, 0], ArrowUp: [0, 0.05], ArrowDown: [0, -0.05] };
const STEPS = { w: [0, 0, -1], s: [0, 0, 1], a: [-1, 0, 0], d: [1, 0, 0], e: [0, 1, 0], q: [0, -1, 0] };
const PAD = { 'forward': 'w', 'back': 's', 'left': 'a', 'right': 'd', 'up': 'e', 'down': 'q' };
const REPEAT_MS = 120;

// turn(yaw, pitch) in radians; move(right, up, back) in metres, a step at a time; keys: what other keys do.
export function lookAround(canvas, pad, { turn, move, step, keys = {} }) {
	const fingers = new Map();
	const meanOf = index => [...fingers.values()].reduce((sum, at) => sum + at[index], 0) / fingers.size;
	const spread = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
	canvas.addEventListener('pointerdown', event => {
		fingers.set(event.pointerId, [event.clientX, event.clientY]);
		canvas.setPointerCapture(event.pointerId);
	});
	for (const name of ['pointerup', 'pointercancel', 'lostpointercapture']) canvas.addEventListener(name, event => fingers.delete(event.pointerId));
	canvas.addEventListener('pointermove', event => {
		if (!fingers.has(event.pointerId) || event.buttons === 0) return;
		const two = fingers.size === 2, before = [meanOf(0), meanOf(1), two ? spread() : 0];
		fingers.set(event.pointerId, [event.clientX, event.clientY]);
		const x = meanOf(0) - before[0], y = meanOf(1) - before[1];
		if (two) move(-0.02 * step * x, 0.02 * step * y, -0.04 * step * (spread() - before[2])); // two fingers: sideways, and apart to go on
		else if (fingers.size === 1) turn(0.004 * x, 0.004 * y);
	});
	canvas.addEventListener('keydown', event => {
		if (event.ctrlKey || event.metaKey || event.altKey) return;
		const key = event.key.toLowerCase(), steps = STEPS[key];
		if (TURNS[event.key]) turn(...TURNS[event.key]);
		else if (steps) move(...steps.map(part => part * step));
		else if (keys[key]) keys[key]();
		else return;
		event.preventDefault();
	});
	for (const [name, key] of Object.entries(PAD)) {
		const go = () => move(...STEPS[key].map(part => part * step));
		let timer = 0;
		const element = button(pad, name, false, event => { if (event.detail === 0) go(); }, { 'data-move': name }); // by the keyboard
		element.removeAttribute('aria-pressed');
		element.addEventListener('pointerdown', () => { go(); timer = setInterval(go, REPEAT_MS); });
		for (const end of ['pointerup', 'pointerleave', 'pointercancel']) element.addEventListener(end, () => clearInterval(timer));
	}
}
