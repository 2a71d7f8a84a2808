// SPDX-License-Identifier: GPL-3.0-or-later
// The page: its three parts one after the other, so that each has the processor for its first picture.
import './site.css';
import { byId, data, drawMade, drawReading, make, publish, ready } from 'nook:page';
import { readScalars } from './gl.js';
import * as level from './level.js';
import * as methods from './methods.js';
import * as pattern from './pattern.js';
import { program } from './program.js';
import { eye, SKY } from './scene.js';
import { methodNamed, shading } from './shade.js';

drawMade(byId('made'), data, `${data.view.level}, ${data.view.triangle_count} triangles`);
drawReading(Object.entries(data.reading));
pattern.drawRecipe();
if (data.docs) make(byId('links'), 'a', { href: data.docs }, 'Documentation');

async function start() {
	await methods.startStage();
	pattern.startPattern();
	await level.startLevel();
}

start().catch(error => {
	byId('no-three').textContent = error.message;
	byId('no-three').hidden = false;
	console.error(error);
}).finally(() => publish({ started: 'yes' }));
ready(() => {});

globalThis.nookPage = { ...pattern, ...methods, ...level, byId, publish, program, eye, SKY, methodNamed, shading, readScalars }; // for the console, and tests
