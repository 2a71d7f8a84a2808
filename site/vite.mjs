// SPDX-License-Identifier: GPL-3.0-or-later
// Vite's build of the page: classic scripts and relative addresses, so that the site works below any address and as a file.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const SHARED = ['byId', 'data', 'make', 'shortNumber', 'button', 'drawMade', 'drawReading', 'bytesOf', 'table', 'publish', 'ready', 'clipHalfPlane', 'pointsAt', 'drawPattern'];
const DATA = "JSON.parse(byId('data').textContent)"; // of pages that hold their data as text

// What all pages of nook share, as the module 'nook:page' and its style.
function sharedParts(source) {
	const page = name => readFileSync(join(source, 'libsamples/page', name), 'utf8');
	const text = page('parts.js') + page('pictures.js');
	if (!text.includes(DATA)) throw new Error(`libsamples/page/parts.js: found no ${DATA}`);
	return {
		name: 'nook:page',
		enforce: 'pre',
		resolveId: name => name === 'nook:page' ? '\0nook:page.js' : null,
		load: name => name === '\0nook:page.js' ? `${text.replace(DATA, 'globalThis.nookData')}\nexport { ${SHARED.join(', ')} };` : null,
		transform: (css, name) => name.endsWith('/site.css') ? css.replace("@import 'nook:page.css';", () => page('page.css')) : null,
	};
}

// Licences of what the script contains, which Vite's build drops.
function noticeOf(modules) {
	const read = name => readFileSync(join(modules, 'three', name), 'utf8').trim();
	const meshopt = read('examples/jsm/libs/meshopt_decoder.module.js').split('\n').filter(line => line.startsWith('// ')).slice(0, 2).map(line => line.slice(3)).join('\n');
	return `/*\nnook: GPL-3.0-or-later. nook-ao: MIT.\n\n${meshopt}\n\nthree.js: ${read('LICENSE')}\n*/\n`;
}

/** The files of the site: {name: text}; `whole`: all of it in index.html. */
export async function bundle({ root, source, modules, npm, ao, data, whole }) {
	const { build } = await import(pathToFileURL(join(modules, 'vite/dist/node/index.js')));
	const alias = [
		{ find: /^nook-patterns\//, replacement: `${npm}/` }, { find: /^nook-ao$/, replacement: join(ao, 'index.js') },
		{ find: /^three$/, replacement: join(modules, 'three/build/three.module.js') }, { find: /^three\/addons\//, replacement: `${join(modules, 'three/examples/jsm')}/` },
	];
	const { output } = await build({
		root, configFile: false, logLevel: 'error', base: './', plugins: [sharedParts(source)], resolve: { alias },
		worker: { format: 'iife' },
		build: {
			write: false, assetsInlineLimit: Number.MAX_SAFE_INTEGER, modulePreload: false, cssCodeSplit: false, chunkSizeWarningLimit: 1e6, target: 'es2022',
			rollupOptions: { output: { format: 'iife', entryFileNames: 'site.js', assetFileNames: 'site[extname]' } },
		},
	});
	const textOf = name => {
		const found = output.find(one => one.fileName === name);
		if (!found) throw new Error(`vite: found ${output.map(one => one.fileName).join(', ')}, expected ${name}`);
		return String(found.code ?? found.source);
	};
	const notice = noticeOf(modules);
	const script = `globalThis.nookData = ${JSON.stringify(data).replaceAll('<', '\\u003c')};\n`, page = textOf('index.html').replace(/^.*<script type="module".*\n?/m, '').replace(/^.*<link rel="stylesheet".*\n?/m, '');
	const into = (end, text) => html => html.replace(end, () => `${text}\n${end}`);
	if (whole) {
		const code = `${notice}${textOf('site.js')}`.replaceAll('</script', '<\\/script');
		return { 'index.html': into('</body>', `<script>\n${script}</script>\n<script>\n${code}</script>`)(into('</head>', `<style>\n${textOf('site.css')}</style>`)(page)) };
	}
	return {
		'index.html': into('</body>', '<script src="./data.js"></script>\n<script src="./site.js"></script>')(into('</head>', '<link rel="stylesheet" href="./site.css">')(page)),
		'data.js': script, 'site.js': notice + textOf('site.js'), 'site.css': textOf('site.css'),
	};
}
