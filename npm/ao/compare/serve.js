// SPDX-License-Identifier: MIT
// node serve.js PORT: serves this folder to a local browser, with imports.html in the head of each page. cpu/N: processor time of process N, milliseconds.
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

const folder = fileURLToPath(new URL('.', import.meta.url));
const types = { '.html': 'text/html', '.js': 'text/javascript', '.json': 'application/json', '.glb': 'model/gltf-binary' };
const server = createServer(async (request, answer) => {
	const path = normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
	try {
		const [, process] = /^\/cpu\/(\d+)$/.exec(path) ?? [];
		if (process) { // fields 14 and 15 of Linux: user and system time, in hundredths of a second
			const fields = (await readFile(`/proc/${process}/stat`, 'utf8')).split(') ')[1].split(' ');
			answer.end(String(10 * (+fields[11] + +fields[12])));
			return;
		}
		let bytes = await readFile(join(folder, path.endsWith('/') ? `${path}index.html` : path));
		if (/(\/|\.html)$/.test(path)) bytes = bytes.toString().replace('<!-- imports.html -->', await readFile(join(folder, 'imports.html')));
		answer.writeHead(200, { 'Content-Type': types[extname(path)] ?? (path.endsWith('/') ? 'text/html' : 'application/octet-stream') });
		answer.end(bytes);
	} catch {
		answer.writeHead(404).end();
	}
});
server.listen(+process.argv[2], '127.0.0.1', () => console.log(`http://127.0.0.1:${server.address().port}/`));
