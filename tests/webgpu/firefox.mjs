// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: firefox.mjs BROWSER SCRIPT.mjs SOURCE NAME…: runs draw.mjs or volumes.mjs in headless Firefox, whose WebGPU (wgpu with naga,
// as in Bevy) is another compiler than Dawn's, on Mesa's Vulkan driver. Prints what the script prints and ends with its exit code.
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [browser, script, source, ...names] = process.argv.slice(2);
const { readExr } = await import(`${source}/site/files.mjs`);

// Modules of Node.js that the script imports, and its globals.
const MODULES = {
	'webgpu': 'export const globals = {}; export const create = () => navigator.gpu;',
	'node:url': 'export const pathToFileURL = path => new URL(`/module/${path}`, location.href).href;',
	'node:fs': `export function readFileSync(path, encoding) {
		const request = new XMLHttpRequest();
		request.open('GET', '/file/' + path, false);
		request.overrideMimeType('text/plain; charset=x-user-defined');
		request.send();
		const bytes = Uint8Array.from(request.responseText, c => c.charCodeAt(0) & 255);
		return encoding ? new TextDecoder().decode(bytes) : bytes;
	}`,
	'files': `import { readFileSync } from 'node:fs';
	export function readExr(path) {
		const { channels, ...exr } = JSON.parse(readFileSync('exr/' + path, 'utf8'));
		return { ...exr, channels: Object.fromEntries(Object.entries(channels).map(([name, text]) =>
			[name, new Float32Array(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer)])) };
	}`,
};
const PAGE = `<!doctype html><meta charset="utf-8"><title>nook</title>
<script type="importmap">${JSON.stringify({ imports: Object.fromEntries(Object.keys(MODULES).map(name => [name, `/shim/${name}`])) })}</script>
<script type="module">
let lines = '';
console.log = line => { lines += line + '\\n'; };
const end = exitCode => fetch('/end', { method: 'POST', body: JSON.stringify({ exitCode, lines }) });
window.process = { argv: ${JSON.stringify(['', '', source, ...names])}, exit(code) { end(code); throw 'ended'; } };
import('/script').catch(error => { if (error !== 'ended') { console.log(String(error)); end(1); } });
</script>`;

function exrText(path) {
	const { channels, ...exr } = readExr(path);
	return JSON.stringify({ ...exr, channels: Object.fromEntries(Object.entries(channels).map(([name, values]) => [name, Buffer.from(values.buffer).toString('base64')])) });
}

function answer(url) {
	const [, kind, path] = /^\/(\w*)\/?(.*)/.exec(decodeURIComponent(url));
	switch (kind) {
	case '': return ['text/html', PAGE];
	case 'script': return ['text/javascript', readFileSync(script)];
	case 'shim': return ['text/javascript', MODULES[path]];
	case 'module': return ['text/javascript', path.endsWith('/site/files.mjs') ? MODULES.files : readFileSync(path)];
	case 'file': return ['text/plain', path.startsWith('exr/') ? exrText(path.slice(4)) : readFileSync(path)];
	default: throw new Error(url);
	}
}

const profile = mkdtempSync(join(tmpdir(), 'nook-firefox-'));
let child;
function end(code, lines) {
	process.stdout.write(lines);
	child.once('exit', () => {
		rmSync(profile, { recursive: true, force: true });
		process.exit(code);
	});
	child.kill();
}

const server = createServer((request, response) => {
	if (request.method === 'POST') {
		let body = '';
		request.on('data', part => { body += part; }).on('end', () => {
			response.end();
			const { exitCode, lines } = JSON.parse(body);
			end(exitCode, lines);
		});
		return;
	}
	try {
		const [type, content] = answer(request.url);
		response.setHeader('Content-Type', type);
		response.end(content);
	} catch {
		response.writeHead(404).end();
	}
});
server.listen(0, '127.0.0.1', () => {
	const settings = { 'dom.webgpu.enabled': true, 'gfx.webgpu.ignore-blocklist': true, 'browser.shell.checkDefaultBrowser': false,
		'datareporting.policy.dataSubmissionEnabled': false, 'app.update.auto': false };
	writeFileSync(join(profile, 'user.js'), Object.entries(settings).map(([name, value]) => `user_pref("${name}", ${value});\n`).join(''));
	child = spawn(browser, ['--headless', '--no-remote', '--profile', profile, `http://127.0.0.1:${server.address().port}/`],
		{ stdio: 'ignore', env: { ...process.env, HOME: profile } });
	setTimeout(() => end(1, 'firefox.mjs: found no answer within 200 s\n'), 200000).unref();
});
