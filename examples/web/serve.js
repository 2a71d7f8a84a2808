// SPDX-License-Identifier: MIT
// node serve.js PORT: serves this folder to a local browser. Port 0 selects any free one; the address is printed.
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

const folder = fileURLToPath(new URL('.', import.meta.url));
const types = { '.html': 'text/html', '.js': 'text/javascript', '.glb': 'model/gltf-binary' };
const server = createServer(async (request, answer) => {
	const path = normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
	try {
		const bytes = await readFile(join(folder, path.endsWith('/') ? `${path}index.html` : path));
		answer.writeHead(200, { 'Content-Type': types[extname(path)] ?? (path.endsWith('/') ? 'text/html' : 'application/octet-stream') });
		answer.end(bytes);
	} catch {
		answer.writeHead(404).end();
	}
});
server.listen(+process.argv[2], '127.0.0.1', () => console.log(`http://127.0.0.1:${server.address().port}/`));
