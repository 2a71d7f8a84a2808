// SPDX-License-Identifier: GPL-3.0-or-later
// Draws visibility to canvases: a split view of method and reference with a slider, and their difference.
'use strict';

// A round range (1, 2 or 5 × a power of ten) that covers 99 % of the differences, in units of 1/255; at least 5.
function rangeOfDifferences(test, reference) {
	const counts = new Uint32Array(256);
	for (let i = 0; i < test.length; ++i) counts[Math.abs(test[i] - reference[i])] += 1;
	let sum = 0, most = 255;
	for (let d = 0; d < 256; ++d) {
		sum += counts[d];
		if (sum >= 0.99 * test.length) { most = d; break; }
	}
	return [0.02, 0.05, 0.1, 0.2, 0.5, 1].find(r => r * 255 >= most);
}

function canvasOf(parent, view, label) {
	const canvas = make(parent, 'canvas', { width: view.width_px, height: view.height_px, role: 'img', 'aria-label': label });
	drawn.pictures += 1;
	return canvas;
}

// Draws the method left of `share` of the width, the reference to the right, and a line between them.
function paintSplit(canvas, test, reference, share) {
	const context = canvas.getContext('2d'), width = canvas.width, image = context.createImageData(width, canvas.height);
	const edge = Math.round(share * width);
	for (let i = 0; i < test.length; ++i) {
		const column = i % width, value = column < edge ? test[i] : reference[i], line = column === edge && edge > 0 && edge < width;
		image.data.set(line ? [214, 60, 40, 255] : [value, value, value, 255], 4 * i);
	}
	context.putImageData(image, 0, 0);
}

// White: equal; blue: the method is darker; red: lighter.
function paintDifference(canvas, test, reference, range) {
	const context = canvas.getContext('2d'), image = context.createImageData(canvas.width, canvas.height);
	for (let i = 0; i < test.length; ++i) {
		const d = Math.max(-1, Math.min(1, (test[i] - reference[i]) / (255 * range)));
		const pale = 255 * (1 - Math.abs(d));
		image.data.set(d < 0 ? [pale, pale, 255 - 60 * -d, 255] : [255 - 50 * d, pale, pale, 255], 4 * i);
	}
	context.putImageData(image, 0, 0);
}

function drawViewer(holder, view, point) {
	holder.replaceChildren();
	if (!point || !point.picture || !view.picture) {
		make(holder, 'p', { class: 'note' }, point ? `${point.name}: this page has no picture of it (--pictures keeps more).` : 'No pictures here.');
		return;
	}
	const test = bytesOf(point.picture), reference = bytesOf(view.picture), range = rangeOfDifferences(test, reference);
	const box = make(holder, 'div', { class: 'viewer' });
	const left = make(box, 'figure'), right = make(box, 'figure');
	const split = canvasOf(left, view, `${point.name}, and the reference`);
	const slider = make(left, 'input', { type: 'range', min: 0, max: 1000, value: 500, 'aria-label': 'Where the reference begins' });
	make(left, 'figcaption', {}, `${point.name} │ reference · eq. 14 ${shortNumber(point.eq14)}, RMSE ${shortNumber(point.rmse)}, FLIP ${shortNumber(point.flip)}, SSIM ${shortNumber(point.ssim)} · ${shortNumber(point.time.ms)} ms`);
	const difference = canvasOf(right, view, `${point.name}, difference to the reference`);
	make(right, 'figcaption', {}, `Difference; the strongest colours are ±${range}. Mean ${point.mean_error < 0 ? 'too dark' : 'too light'} by ${shortNumber(Math.abs(point.mean_error))}.`);
	const paint = () => paintSplit(split, test, reference, slider.value / 1000);
	slider.addEventListener('input', paint);
	split.addEventListener('pointermove', event => {
		if (event.buttons === 0 && event.pointerType !== 'mouse') return;
		slider.value = 1000 * event.offsetX / split.clientWidth;
		paint();
	});
	paint();
	paintDifference(difference, test, reference, range);
}
