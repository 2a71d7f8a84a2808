// SPDX-License-Identifier: GPL-3.0-or-later
// node page_driver.cjs BROWSER PAGE [--width W] [--dark] [--reduced] [--before SCRIPT] [--option BROWSER_OPTION]
// 	[--screenshot FILE.png [--top PIXELS] [--tall PIXELS]] [--wait SECONDS] <SCRIPT
// Opens a page, a file or an address of http, in a headless Chromium, runs SCRIPT in it as the body of an async function, and prints what it returns as JSON.
// Exit code 1 where the page's console has an error or a warning, or the script throws; each is a line on stderr.
'use strict';
const { spawn } = require('node:child_process');
const { mkdtempSync, readFileSync, rmSync, writeFileSync } = require('node:fs');
const { tmpdir } = require('node:os');
const { join, resolve } = require('node:path');

const [browser, page, ...words] = process.argv.slice(2);
const options = { width: '1400', height: '1000', wait: '120', option: [] };
for (let i = 0; i < words.length; ++i) {
	const name = words[i].slice(2);
	if (name === 'dark' || name === 'reduced') options[name] = true;
	else if (name === 'option') options.option.push(words[++i]);
	else options[name] = words[++i];
}
const profile = mkdtempSync(join(tmpdir(), 'nook-page-'));
const child = spawn(browser, ['--headless=new', '--no-sandbox', '--no-first-run', '--hide-scrollbars', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
	`--user-data-dir=${profile}`, '--remote-debugging-pipe', ...options.option, 'about:blank'], { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
const gone = new Promise(done => child.once('exit', done)); // possibly before anyone awaits it
child.stdio[3].on('error', () => {});

// Chromium's protocol: JSON messages, each followed by a zero byte.
const waiting = new Map(), faults = [];
let next = 1, rest = '';
child.stdio[4].setEncoding('utf8');
child.stdio[4].on('data', text => {
	const parts = (rest + text).split('\0');
	rest = parts.pop();
	for (const part of parts) receive(JSON.parse(part));
});

function receive(said) {
	if (said.id) {
		const { done, fail } = waiting.get(said.id);
		waiting.delete(said.id);
		if (said.error) fail(new Error(said.error.message)); else done(said.result);
	} else if (said.method === 'Runtime.consoleAPICalled' && ['error', 'warning'].includes(said.params.type)) {
		faults.push(`console: ${said.params.args.map(arg => arg.value ?? arg.description).join(' ')}`);
	} else if (said.method === 'Log.entryAdded' && ['error', 'warning'].includes(said.params.entry.level)) {
		faults.push(`console: ${said.params.entry.text}`);
	} else if (said.method === 'Runtime.exceptionThrown') {
		const { text, exception } = said.params.exceptionDetails;
		faults.push(`console: ${exception && exception.description || text}`);
	}
}

function ask(method, params = {}, sessionId) {
	const id = next++;
	child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
	return new Promise((done, fail) => waiting.set(id, { done, fail }));
}

async function run(script) {
	const { targetInfos } = await ask('Target.getTargets');
	const { sessionId } = await ask('Target.attachToTarget', { targetId: targetInfos.find(one => one.type === 'page').targetId, flatten: true });
	const tell = (method, params) => ask(method, params, sessionId);
	for (const domain of ['Runtime', 'Log', 'Page']) await tell(`${domain}.enable`);
	await tell('Emulation.setDeviceMetricsOverride', { width: +options.width, height: +options.height, deviceScaleFactor: 1, mobile: false });
	await tell('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: options.dark ? 'dark' : 'light' },
		{ name: 'prefers-reduced-motion', value: options.reduced ? 'reduce' : 'no-preference' }] });
	if (options.before) await tell('Page.addScriptToEvaluateOnNewDocument', { source: options.before });
	await tell('Page.navigate', { url: /^https?:/.test(page) ? page : `file://${encodeURI(resolve(page))}` });
	for (let state = ''; state !== 'complete';) {
		await new Promise(later => setTimeout(later, 20));
		state = (await tell('Runtime.evaluate', { expression: 'location.protocol === "about:" ? "" : document.readyState' })).result.value;
	}
	const { result, exceptionDetails } = await tell('Runtime.evaluate', { expression: `(async () => {${script}\n})()`, awaitPromise: true, returnByValue: true });
	if (exceptionDetails) faults.push(`script: ${exceptionDetails.exception && exceptionDetails.exception.description || exceptionDetails.text}`);
	if (options.screenshot) {
		const { cssContentSize: size } = await tell('Page.getLayoutMetrics');
		const clip = { x: 0, y: +(options.top || 0), width: size.width, height: Math.min(size.height, +(options.tall || 2400)), scale: 1 };
		const { data } = await tell('Page.captureScreenshot', { captureBeyondViewport: true, clip });
		writeFileSync(options.screenshot, Buffer.from(data, 'base64'));
	}
	return result && result.value;
}

let ended = false;
function end(fault) {
	if (ended) return;
	ended = true;
	clearTimeout(late);
	if (fault) faults.push(fault);
	for (const one of faults) console.error(one);
	gone.then(() => { // its other processes may still write to the profile for a moment
		rmSync(profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 100 });
		process.exit(faults.length === 0 ? 0 : 1);
	});
	ask('Browser.close').catch(() => {});
	setTimeout(() => child.kill('SIGKILL'), 5000).unref();
}
const late = setTimeout(() => end(`the page: found no answer in ${options.wait} s`), 1000 * options.wait);
gone.then(() => end('the browser: found it ended, expected an answer'));
run(readFileSync(0, 'utf8')).then(value => {
	console.log(JSON.stringify(value ?? null));
	end();
}, error => end(error.message));
